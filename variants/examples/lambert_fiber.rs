//! Example of a model given by its lobes: a fibre with a diffuse lobe and a specular cone.
//!
//! `S = kd / pi^2 + ks c(sin theta_i + sin theta_o) / (2 pi)`, with `c` the Cauchy density of width `w`. The first term
//! returns `kd` of the light; the second peaks on the cone of mirror directions and returns at most `ks`. The diffuse
//! lobe is sampled uniformly, the cone by inverting its own density, cut to the sphere: weights are bounded.
//!
//! Run it with `cargo run --release -p hairis-variants --example lambert_fiber`.

use core::f32::consts::FRAC_1_PI;
use glam::Vec3;
use hairis::model::math::{atan2_upper, sin_cos_half_turn};
use hairis::model::{Direction, LobeEval, LobeModel, Model};
use hairis::simd::{Broadcast, Lanes, Level, Scalar, f32x8, lane_struct, lanes3};
use hairis::{Hit, Lobe, LobeMask, Material, Material8, PerLobe, Vec3x8};

/// The marker that the trait is implemented on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LambertFiber;

/// The lobes, by name.
pub(crate) const DIFFUSE: Lobe = Lobe::slot(0);
pub(crate) const CONE: Lobe = Lobe::slot(1);

/// Parameters of a fibre. A real model would check them, as `HairParams` does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Params {
    pub(crate) kd: [f32; 3],
    pub(crate) ks: [f32; 3],
    /// Width of the cone in `sin theta`.
    pub(crate) width: f32,
}

lane_struct! {
    /// Constants of a material.
    pub(crate) struct Constants {
        /// Colours, linear RGB: of the diffuse lobe and of the cone.
        kd: [C; 3],
        ks: [C; 3],
        width: C,
        /// Sampling weight of each lobe, to any common scale.
        weights: [C; 2],
    }
}

lane_struct! {
    /// Constants of a shading point.
    pub(crate) struct Point {
        material: (Constants<C>),
        sin_theta_o: C,
        /// Angle that the cone's density is uniform over.
        span: C,
    }
}

impl LobeModel for LambertFiber {
    type Params = Params;
    type Material<C: Scalar> = Constants<C>;
    type Prepared<C: Scalar> = Point<C>;

    const LOBES: &'static [&'static str] = &["diffuse", "cone"];

    fn material(&self, params: &Params) -> Constants<f32> {
        let Params { kd, ks, width } = *params;
        Constants {
            kd,
            ks,
            width,
            weights: [kd.iter().sum(), ks.iter().sum()],
        }
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &Constants<C>,
        hit: Hit<L>,
    ) -> Point<L::Stored> {
        let sin = Direction::normalized(hit.wo).sin_theta;
        let width = material.width.lanes();
        let span = atan2_upper(
            width + width,
            width.mul_add(width, sin.mul_add(sin, -L::splat(1.0))),
        );
        Point {
            material: material.spread::<L>(),
            sin_theta_o: sin.store(),
            span: span.store(),
        }
    }

    #[inline(always)]
    fn weights<L: Lanes, C: Broadcast<L>>(point: &Point<C>) -> PerLobe<L> {
        let [diffuse, cone] = &point.material.weights;
        PerLobe::padded([diffuse.lanes(), cone.lanes()], L::splat(0.0))
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        point: &Point<C>,
        wi: &Direction<L>,
    ) -> PerLobe<LobeEval<L>> {
        let c = L::splat;
        let width = point.material.width.lanes();
        let off = wi.sin_theta + point.sin_theta_o.lanes();
        let bell = L::quotient(width, off.mul_add(off, width * width)) * c(0.5 * FRAC_1_PI);
        let (kd, ks) = (lanes3(&point.material.kd), lanes3(&point.material.ks));
        let diffuse = LobeEval {
            value: c(FRAC_1_PI * FRAC_1_PI),
            color: kd,
            pdf: c(0.25 * FRAC_1_PI),
        };
        let cone = LobeEval {
            value: bell * c(FRAC_1_PI),
            color: ks,
            pdf: L::quotient(bell, point.span.lanes()),
        };
        PerLobe::padded([diffuse, cone], LobeEval::none())
    }

    #[inline(always)]
    fn sample_lobe<L: Lanes, C: Broadcast<L>>(
        point: &Point<C>,
        lobe: L::Index,
        xi: [L; 3],
    ) -> Direction<L> {
        let one = L::splat(1.0);
        let (width, sin_theta_o) = (point.material.width.lanes(), point.sin_theta_o.lanes());
        // The cone: width tan(lo + xi span) - sin theta_o, without a tangent.
        let (s, c) = sin_cos_half_turn(xi[1] * point.span.lanes() * L::splat(0.5));
        let (sin, cos) = ((s + s) * c, c * c - s * s);
        let lo = sin_theta_o - one;
        let x = L::quotient(
            width * lo.mul_add(cos, width * sin),
            width.mul_add(cos, -(lo * sin)),
        );
        let cone = (-one).max(one.min(x - sin_theta_o));
        let sin = L::select(
            L::is_index(lobe, DIFFUSE.index()),
            xi[1] + xi[1] - one,
            cone,
        );
        Direction::with_uniform_azimuth([sin, ((one - sin) * (one + sin)).sqrt()], xi[2])
    }
}

/// The integral of a shading point's density over the sphere, by midpoints in `sin theta` (it does not see `phi`).
pub(crate) fn pdf_integral(prepared: &hairis::Bsdf<LambertFiber>) -> f64 {
    const STEPS: u16 = 20_000;
    let mut sum = 0.0;
    for step in 0..STEPS {
        let sin = (f32::from(step) + 0.5) * 2.0 / f32::from(STEPS) - 1.0;
        let wi = Vec3::new(sin, ((1.0 - sin) * (1.0 + sin)).sqrt(), 0.0);
        sum += f64::from(prepared.pdf(wi));
    }
    sum * 4.0 * core::f64::consts::PI / f64::from(STEPS)
}

/// Evaluates and samples eight different fibres seen from eight directions, one lane and eight lanes at a time.
pub(crate) fn main() {
    let fibers: [_; 8] = core::array::from_fn(|i| {
        let t = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7][i];
        Material::new(
            &LambertFiber,
            &Params {
                kd: [t, 0.3, 0.2],
                ks: [0.5 - 0.5 * t; 3],
                width: 0.02 + 0.2 * t,
            },
        )
    });
    let wo: [Vec3; 8] = core::array::from_fn(|i| {
        let sin = [-0.99, -0.7, -0.3, 0.0, 0.2, 0.5, 0.8, 0.999][i];
        Vec3::new(sin, (1.0_f32 - sin * sin).sqrt(), 0.0)
    });
    let wi = wo.map(|wo| Vec3::new(0.05 - 0.9 * wo.x, 0.6, 0.4).normalize());
    let xi = [
        [0.1, 0.9, 0.3, 0.7, 0.2, 0.8, 0.5, 0.6],
        [0.5, 0.1, 0.9, 0.3, 0.7, 0.4, 0.6, 0.2],
        [0.25; 8],
    ];

    for level in Level::available() {
        let prepared = Material8::pack(fibers.each_ref())
            .with_level(level)
            .prepare8(&Vec3x8::from(wo));
        let eval = prepared.with_level(level).eval_pdf8(&wi.into());
        let samples = prepared.with_level(level).sample8(&xi.map(f32x8::new));
        println!("eight fibres on {level}: S (red), pdf, sampled wi, weight (red)");
        for lane in 0..8 {
            let one = fibers[lane].prepare(wo[lane]);
            let (e, scalar) = (eval.lane(lane), one.eval_pdf(wi[lane]));
            let xi = [xi[0][lane], xi[1][lane], xi[2][lane]];
            let (s, single) = (
                samples.lane(lane).expect("off the axis"),
                one.sample(xi).expect("off the axis"),
            );
            println!(
                "  {:.5} {:.5} {:.4} {:.4} {}",
                e.value[0],
                e.pdf,
                s.wi,
                s.weight[0],
                <LambertFiber as Model>::LOBES[s.lobe.index()]
            );
            let close = |a: f32, b: f32| (a - b).abs() <= 2e-5 * a.abs().max(1e-3);
            assert!(
                close(e.value[0], scalar.value[0]) && close(e.pdf, scalar.pdf),
                "lane {lane}: {e:?} {scalar:?}"
            );
            assert!(
                close(s.pdf, single.pdf) && s.lobe == single.lobe,
                "lane {lane}: {s:?} {single:?}"
            );
            assert!(
                (s.wi - single.wi).length() < 1e-5,
                "lane {lane}: {s:?} {single:?}"
            );
            assert!(
                close(one.pdf(s.wi), s.pdf),
                "lane {lane}: the density of a sample is that of its direction"
            );
        }
    }
    for (fiber, wo) in fibers.iter().zip(wo) {
        let integral = pdf_integral(&fiber.prepare(wo));
        println!("integral of the pdf: {integral:.6}");
        assert!(
            (integral - 1.0).abs() < 1e-4,
            "the density integrates to {integral}"
        );
    }
    let cone = fibers[3].prepare(wo[3]).with_lobes(LobeMask::of(&[CONE]));
    println!(
        "the cone alone: {:?}, albedo {:?}",
        cone.eval(wi[3]),
        cone.albedo()[CONE]
    );
}
