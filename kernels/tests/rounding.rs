//! Any direction of rounding, and denormals taken for 0: results stay finite and not negative.
//!
//! Hosts change the floating-point environment of their threads. The compiler takes it for the default one, which it is again
//! before anything is compared.
#![cfg(target_arch = "x86_64")]
#![expect(unsafe_code, reason = "the control register of the vector unit has no safe access")]
#![expect(deprecated, reason = "as above; what replaces it is inline assembly")]

use crate::support::{Draws, direction, lanes_of, packet};
use core::arch::x86_64::{_mm_getcsr, _mm_setcsr};
use core::hint::black_box;
use glam::Vec3;
use hairis::wide::f32x8;
use hairis::{Bsdf, Bsdf8, Gaussian, Hair, HairParams, Level, Matched, Model};

/// Rounding to nearest, down, up and towards 0, each with denormals and without.
const MODES: [u32; 8] = [0x0000, 0x2000, 0x4000, 0x6000, 0x8040, 0xa040, 0xc040, 0xe040];

/// Runs `f` with these bits of the register set.
fn with_mode<T>(mode: u32, f: impl FnOnce() -> T) -> T {
    // SAFETY: every x86-64 CPU has the register; it is restored, and exceptions stay masked.
    let before = unsafe { _mm_getcsr() };
    // SAFETY: as above.
    unsafe { _mm_setcsr(before & !0xe040 | mode) };
    let result = black_box(f());
    // SAFETY: as above.
    unsafe { _mm_setcsr(before) };
    result
}

/// Every number of every entry point, for one hit, direction and triple.
#[inline(never)]
fn numbers<M: Model<Params = HairParams>>(bsdf: &Bsdf<M>, wo: Vec3, wi: Vec3, xi: [f32; 3]) -> Vec<f32> {
    let gather = bsdf.prepare(wo);
    let e = gather.eval_pdf(wi);
    let mut all = vec![e.value[0], e.value[1], e.value[2], e.pdf];
    for lobe in gather.lobes(wi).0 {
        all.extend([lobe.value, lobe.pdf]);
    }
    all.extend(gather.albedo().0.as_flattened());
    all.extend(gather.conserving().albedo().0.as_flattened());
    if let Some(s) = gather.sample(xi) {
        all.extend(s.value.iter().chain(&s.weight).chain([&s.pdf]));
        all.extend(s.wi.to_array().map(|x| x.abs()));
    }
    let first = |x: &f32x8| x.as_array()[0];
    for level in Level::available() {
        let each = Bsdf8::pack([bsdf; 8]).prepare8_at(level, &packet(&[wo]));
        for e in [gather.eval_pdf8_at(level, &packet(&[wi])), each.eval_pdf8_at(level, &packet(&[wi]))] {
            all.extend(e.value.iter().chain([&e.pdf]).map(first));
        }
        for s in [gather.sample8_at(level, &lanes_of(&[xi; 8])), each.sample8_at(level, &lanes_of(&[xi; 8]))] {
            all.extend(s.value.iter().chain(&s.weight).chain([&s.pdf]).map(first));
            all.extend([s.wi.x, s.wi.y, s.wi.z].iter().map(|x| first(x).abs()));
        }
        all.extend(each.albedo8_at(level).0.as_flattened().iter().map(first));
        all.extend(each.conserving_at(level).albedo8_at(level).0.as_flattened().iter().map(first));
    }
    all
}

fn stays_finite<M: Model<Params = HairParams>>(model: M) {
    let mut draws = Draws(81);
    let brown = Bsdf::new(&model, &HairParams::brown());
    let mut cases = vec![(brown, Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.28, -0.96, 0.0), [0.3, 0.6, 0.9])];
    let axes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.6, -0.8, 0.0)];
    let ends = [0.0, f32::EPSILON / 2.0, 0.25, 0.5, 1.0 - f32::EPSILON / 2.0];
    for round in 0..3000 {
        let params = if round % 4 == 0 { HairParams::default() } else { draws.params(10.0) };
        let mut any = || {
            if draws.below(3) == 0 {
                axes[draws.below(axes.len())]
            } else {
                direction(draws.between(-1.57, 1.57), draws.between(-3.1, 3.1))
            }
        };
        let (wo, wi) = (any(), any());
        let mut number = || if draws.below(3) == 0 { ends[draws.below(ends.len())] } else { draws.xi() };
        cases.push((Bsdf::new(&model, &params), wo, wi, [number(), number(), number()]));
    }
    for mode in MODES {
        for (bsdf, wo, wi, xi) in &cases {
            let all = with_mode(mode, || numbers(bsdf, *wo, *wi, *xi));
            let sound = all.iter().all(|x| x.is_finite() && *x >= 0.0);
            assert!(sound, "mode {mode:#x} wo {wo} wi {wi} xi {xi:?} {bsdf:?}: {all:?}");
        }
    }
}

#[test]
fn results_stay_finite_whichever_way_they_are_rounded() {
    stays_finite(Hair(Gaussian));
    stays_finite::<Matched<Gaussian>>(Matched(Gaussian));
}
