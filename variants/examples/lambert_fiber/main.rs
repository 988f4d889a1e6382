//! Runs the model of [`lambert_fiber`](LambertFiber) and checks its results against each other.
//!
//! `cargo run --release -p hairis-variants --example lambert_fiber`

mod lambert_fiber;

use glam::Vec3;
use hairis::model::Model;
use hairis::simd::{Level, f32x8};
use hairis::{Lobe, LobeMask, Material, Material8, Vec3x8};
pub(crate) use lambert_fiber::{Fiber, LambertFiber};

/// The specular cone.
pub(crate) const CONE: Lobe = Lobe::slot(1);

/// The integral of a shading point's density over the sphere, by midpoints in `sin theta` (it does
/// not see `phi`).
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

/// Evaluates and samples eight different fibres seen from eight directions, one lane and eight
/// lanes at a time.
pub(crate) fn main() {
    let fibers: [_; 8] = core::array::from_fn(|i| {
        let t = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7][i];
        Material::new(
            &LambertFiber,
            &Fiber {
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
