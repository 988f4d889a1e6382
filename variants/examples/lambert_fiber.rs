//! A model of one's own, on the public traits alone: a fibre with a diffuse lobe and a specular cone.
//!
//! `S = kd / pi^2 + ks c(sin theta_i + sin theta_o) / (2 pi)`, with `c` the Cauchy density of width `w`. The first term
//! returns `kd` of the light; the second peaks on the cone of mirror directions and returns at most `ks`. The diffuse
//! lobe is sampled uniformly, the cone by inverting its own density, cut to the sphere: weights are bounded.
//!
//! Run it with `cargo run --release -p hairis-variants --example lambert_fiber`.

use core::f32::consts::{FRAC_1_PI, PI};
use core::fmt::Debug;
use glam::Vec3;
use hairis::math::{atan2_upper, sin_cos_half_turn};
use hairis::wide::f32x8;
use hairis::{
    Broadcast, Bsdf, Bsdf8, Drawn, Eval, GRAZING, Hit, Lanes, Level, Lobe, LobeEval, LobeMask, Model, PerLobe, Vec3x,
    Vec3x8, lanes3, store3,
};

/// The marker that the traits are implemented on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LambertFiber;

/// The lobes, by name.
pub(crate) const DIFFUSE: Lobe = Lobe::slot(0);
pub(crate) const CONE: Lobe = Lobe::slot(1);

/// What a user describes a fibre with. A real model would check it, as `HairParams` does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Params {
    pub(crate) kd: [f32; 3],
    pub(crate) ks: [f32; 3],
    /// Width of the cone in `sin theta`.
    pub(crate) width: f32,
}

hairis::lane_struct! {
    /// What is constant for a material.
    pub struct Material {
        /// Colours, linear RGB.
        pub kd: [C; 3],
        /// As `kd`, of the cone.
        pub ks: [C; 3],
        /// Width of the cone.
        pub width: C,
        /// Probability of each lobe.
        pub selection: [C; 2],
    }
}

hairis::lane_struct! {
    /// What is constant for a gather point.
    pub struct Point {
        /// As in the material.
        pub kd: [C; 3],
        /// As in the material.
        pub ks: [C; 3],
        /// As in the material.
        pub width: C,
        /// As in the material.
        pub selection: [C; 2],
        /// Sine of `theta_o`.
        pub sin_theta_o: C,
        /// Angle under which a bell of this width sees the sphere, rad.
        pub span: C,
    }
}

/// The lobes at a direction: their value and density, neither with its colour, and where there are any.
#[inline(always)]
fn shapes<L: Lanes, C: Broadcast<L>>(gather: &Point<C>, wi: Vec3x<L>) -> ([LobeEval<L>; 2], L, L::Mask) {
    let c = L::splat;
    let width: L = gather.width.lanes();
    let cos_sq = wi.y.mul_add(wi.y, wi.z * wi.z);
    let cos = cos_sq.sqrt();
    let sound = L::and(c(GRAZING).lt(cos), wi.x.mul_add(wi.x, cos_sq).lt(c(4.0)));
    let off = wi.x + gather.sin_theta_o.lanes();
    let bell = width / off.mul_add(off, width * width);
    let diffuse = LobeEval { value: c(FRAC_1_PI * FRAC_1_PI), color: lanes3(&gather.kd), pdf: c(0.25 * FRAC_1_PI) };
    let cone = LobeEval {
        value: bell * c(0.5 * FRAC_1_PI * FRAC_1_PI),
        color: lanes3(&gather.ks),
        pdf: bell * c(0.5 * FRAC_1_PI) / gather.span.lanes(),
    };
    ([diffuse, cone], cos, sound)
}

/// The sums over both lobes; 0 where a lane is not sound.
#[inline(always)]
fn total<L: Lanes, C: Broadcast<L>>(gather: &Point<C>, lobes: [LobeEval<L>; 2], sound: L::Mask) -> Eval<L> {
    let [diffuse, cone] = lobes;
    let limit = L::select(sound, L::splat(f32::MAX), L::splat(0.0));
    let mut value = [limit; 3];
    let mut channel = 0;
    while channel < 3 {
        let sum = diffuse.value.mul_add(diffuse.color[channel], cone.value * cone.color[channel]);
        value[channel] = sum.min(limit);
        channel += 1;
    }
    let [p_diffuse, p_cone] = [gather.selection[0].lanes(), gather.selection[1].lanes()];
    Eval { value, pdf: diffuse.pdf.mul_add(p_diffuse, cone.pdf * p_cone).min(limit) }
}

/// `sin theta_i` at which the cone's cdf is `xi`: `w tan(lo + xi span) - sin theta_o`, without a tangent.
#[inline(always)]
fn cone_sine<L: Lanes, C: Broadcast<L>>(gather: &Point<C>, xi: L) -> L {
    let (one, width, sin_theta_o) = (L::splat(1.0), gather.width.lanes(), gather.sin_theta_o.lanes());
    let (s, c) = sin_cos_half_turn(xi * gather.span.lanes() * L::splat(0.5));
    let (sin, cos) = ((s + s) * c, c * c - s * s);
    let lo = sin_theta_o - one;
    let x = width * lo.mul_add(cos, width * sin) / width.mul_add(cos, -(lo * sin));
    (-one).max(one.min(x - sin_theta_o))
}

impl Model for LambertFiber {
    type Params = Params;
    type Material<C: Copy + Debug> = Material<C>;
    type Gather<C: Copy + Debug> = Point<C>;

    const LOBES: &'static [&'static str] = &["diffuse", "cone"];

    fn material(&self, params: &Params) -> Material<f32> {
        let (d, s) = (params.kd.iter().sum::<f32>(), params.ks.iter().sum::<f32>());
        let share = |x: f32| if d + s > 0.0 { x / (d + s) } else { 0.0 };
        Material { kd: params.kd, ks: params.ks, width: params.width, selection: [share(d), share(s)] }
    }

    fn pack(materials: [&Material<f32>; 8]) -> Material<f32x8> {
        Material::pack(materials)
    }

    fn lane(gather: &Point<f32x8>, lane: usize) -> Point<f32> {
        gather.lane(lane)
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L> + Debug>(material: &Material<C>, hit: Hit<L>) -> Point<L::Stored>
    where
        L::Stored: Debug,
    {
        let (zero, one, tiny) = (L::splat(0.0), L::splat(1.0), L::splat(1e-30));
        // Scaled first, so that no finite wo overflows; zero counts as one in the normal plane.
        let largest = hit.wo.x.abs().max(hit.wo.y.abs().max(hit.wo.z.abs())).max(tiny);
        let wo = Vec3x::new(hit.wo.x / largest, hit.wo.y / largest, hit.wo.z / largest);
        let length = wo.dot(wo).sqrt();
        let sin_theta_o = L::select(tiny.lt(length), wo.x / length, zero);
        let width = material.width.lanes();
        let span = atan2_upper(width + width, width.mul_add(width, sin_theta_o.mul_add(sin_theta_o, -one)));
        Point {
            kd: store3(lanes3(&material.kd)),
            ks: store3(lanes3(&material.ks)),
            width: width.store(),
            selection: [material.selection[0].lanes().store(), material.selection[1].lanes().store()],
            sin_theta_o: sin_theta_o.store(),
            span: span.store(),
        }
    }

    #[inline(always)]
    fn restrict<C: Lanes + Debug>(gather: &Point<C>, lobes: LobeMask) -> Point<C> {
        let (d, s) = (C::splat(lobes.factor(DIFFUSE)), C::splat(lobes.factor(CONE)));
        let [p_d, p_s] = [gather.selection[0] * d, gather.selection[1] * s];
        let by = C::splat(1.0) / (p_d + p_s).max(C::splat(f32::MIN_POSITIVE));
        let times = |x: [C; 3], by: C| [x[0] * by, x[1] * by, x[2] * by];
        Point { kd: times(gather.kd, d), ks: times(gather.ks, s), selection: [p_d * by, p_s * by], ..*gather }
    }

    #[inline(always)]
    fn eval<L: Lanes, C: Broadcast<L> + Debug>(gather: &Point<C>, wi: Vec3x<L>) -> Eval<L> {
        let (lobes, _, sound) = shapes(gather, wi);
        total(gather, lobes, sound)
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L> + Debug>(gather: &Point<C>, wi: Vec3x<L>) -> PerLobe<LobeEval<L>> {
        let ([diffuse, cone], _, sound) = shapes(gather, wi);
        let zero = L::splat(0.0);
        let limit = L::select(sound, L::splat(f32::MAX), zero);
        let none = LobeEval { value: zero, color: [zero; 3], pdf: zero };
        let diffuse = LobeEval { value: diffuse.value.min(limit), pdf: diffuse.pdf.min(limit), ..diffuse };
        let cone = LobeEval { value: cone.value.min(limit), pdf: cone.pdf.min(limit), ..cone };
        PerLobe([diffuse, cone, none, none])
    }

    #[inline(always)]
    fn sample<L: Lanes, C: Broadcast<L> + Debug>(gather: &Point<C>, xi: [L; 3]) -> Drawn<L> {
        let c = L::splat;
        let (zero, one) = (c(0.0), c(1.0));
        let is_diffuse = xi[0].lt(gather.selection[0].lanes());
        let sin = L::select(is_diffuse, xi[1] + xi[1] - one, cone_sine(gather, xi[1]));
        let cos = ((one - sin) * (one + sin)).sqrt();
        // The azimuth is uniform: the double of an angle in [-pi/2, pi/2].
        let (s, k) = sin_cos_half_turn((xi[2] - c(0.5)) * c(PI));
        let wi = Vec3x::new(sin, cos * (k * k - s * s), cos * ((s + s) * k));
        let (lobes, _, sound) = shapes(gather, wi);
        let Eval { value, pdf } = total(gather, lobes, sound);
        let sound = L::and(sound, zero.lt(pdf));
        let by = L::select(sound, cos / pdf, zero);
        let slot = L::select(is_diffuse, zero, one);
        let weight = [value[0] * by, value[1] * by, value[2] * by];
        Drawn { wi, value, pdf, weight, slot: L::select(sound, slot, -one) }
    }

    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L> + Debug>(gather: &Point<C>) -> PerLobe<[L; 3]> {
        const STEPS: u16 = 256;
        let (kd, ks) = (lanes3(&gather.kd), lanes3(&gather.ks));
        let zero = L::splat(0.0);
        let mut sum = zero;
        let mut step = 0;
        while step < STEPS {
            let sin = cone_sine(gather, L::splat((f32::from(step) + 0.5) / f32::from(STEPS)));
            sum = sum + ((L::splat(1.0) - sin) * (L::splat(1.0) + sin)).sqrt();
            step += 1;
        }
        let by = sum * gather.span.lanes() * L::splat(FRAC_1_PI / f32::from(STEPS));
        PerLobe([kd, [ks[0] * by, ks[1] * by, ks[2] * by], [zero; 3], [zero; 3]])
    }
}

/// The integral of a gather point's density over the sphere, by midpoints in `sin theta` (it does not see `phi`).
pub(crate) fn pdf_integral(gather: &hairis::Gather<LambertFiber>) -> f64 {
    const STEPS: u16 = 20_000;
    let mut sum = 0.0;
    for step in 0..STEPS {
        let sin = (f32::from(step) + 0.5) * 2.0 / f32::from(STEPS) - 1.0;
        let wi = Vec3::new(sin, ((1.0 - sin) * (1.0 + sin)).sqrt(), 0.0);
        sum += f64::from(gather.pdf(wi));
    }
    sum * 4.0 * core::f64::consts::PI / f64::from(STEPS)
}

/// Evaluates and samples eight different fibres seen from eight directions, one lane and eight lanes at a time.
pub(crate) fn main() {
    let fibers: [_; 8] = core::array::from_fn(|i| {
        let t = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7][i];
        Bsdf::new(&LambertFiber, &Params { kd: [t, 0.3, 0.2], ks: [0.5 - 0.5 * t; 3], width: 0.02 + 0.2 * t })
    });
    let wo: [Vec3; 8] = core::array::from_fn(|i| {
        let sin = [-0.99, -0.7, -0.3, 0.0, 0.2, 0.5, 0.8, 0.999][i];
        Vec3::new(sin, (1.0_f32 - sin * sin).sqrt(), 0.0)
    });
    let wi = wo.map(|wo| Vec3::new(0.05 - 0.9 * wo.x, 0.6, 0.4).normalize());
    let xi = [[0.1, 0.9, 0.3, 0.7, 0.2, 0.8, 0.5, 0.6], [0.5, 0.1, 0.9, 0.3, 0.7, 0.4, 0.6, 0.2], [0.25; 8]];

    for level in Level::available() {
        let gather = Bsdf8::pack(fibers.each_ref()).prepare8_at(level, &Vec3x8::from(wo));
        let eval = gather.eval_pdf8_at(level, &wi.into());
        let samples = gather.sample8_at(level, &xi.map(f32x8::new));
        println!("eight fibres on {level}: S (red), pdf, sampled wi, weight (red)");
        for lane in 0..8 {
            let one = fibers[lane].prepare(wo[lane]);
            let (e, scalar) = (eval.lane(lane), one.eval_pdf(wi[lane]));
            let xi = [xi[0][lane], xi[1][lane], xi[2][lane]];
            let (s, single) = (samples.lane(lane).expect("off the axis"), one.sample(xi).expect("off the axis"));
            println!(
                "  {:.5} {:.5} {:.4} {:.4} {}",
                e.value[0],
                e.pdf,
                s.wi,
                s.weight[0],
                LambertFiber::LOBES[s.lobe.index()]
            );
            let close = |a: f32, b: f32| (a - b).abs() <= 2e-5 * a.abs().max(1e-3);
            assert!(close(e.value[0], scalar.value[0]) && close(e.pdf, scalar.pdf), "lane {lane}: {e:?} {scalar:?}");
            assert!(close(s.pdf, single.pdf) && s.lobe == single.lobe, "lane {lane}: {s:?} {single:?}");
            assert!((s.wi - single.wi).length() < 1e-5, "lane {lane}: {s:?} {single:?}");
            assert!(close(one.pdf(s.wi), s.pdf), "lane {lane}: the density of a sample is that of its direction");
        }
    }
    for (fiber, wo) in fibers.iter().zip(wo) {
        let integral = pdf_integral(&fiber.prepare(wo));
        println!("integral of the pdf: {integral:.6}");
        assert!((integral - 1.0).abs() < 1e-4, "the density integrates to {integral}");
    }
    let cone = fibers[3].prepare(wo[3]).with_lobes(LobeMask::of(&[CONE]));
    println!("the cone alone: {:?}, albedo {:?}", cone.eval(wi[3]), cone.albedo()[CONE]);
}
