//! Property that every finite input gives finite results that are not negative.

use crate::cases::inputs::Inputs;
use crate::cases::{Property, Trial};
use crate::erased::{ErasedSubject, Which};
use crate::failure::{Failure, Outcome};
use crate::probe::{packet, triples};
use hairis::model::LobeEval;
use hairis::simd::{Level, f32x8};
use hairis::{Eval, Lobe, LobeMask, Sample8};

const NAME: &str = "results are finite and not negative";

/// Number of packets of eight materials.
const CASES: usize = 12_000;

/// Returns true if a number is finite and not negative, as values, densities and weights have to be.
fn sound(x: f32) -> bool {
    x.is_finite() && x >= 0.0
}

fn sound_eval(e: &Eval) -> bool {
    e.value.iter().all(|x| sound(*x)) && sound(e.pdf)
}

fn sound_lobe(lobe: &LobeEval) -> bool {
    [&lobe.color[..], &[lobe.value, lobe.pdf]]
        .concat()
        .into_iter()
        .all(sound)
}

/// Returns the reason why a lane of a sample is not valid.
fn fault(
    s: &Sample8,
    lane: usize,
    mask: LobeMask,
    subject: &dyn ErasedSubject,
) -> Option<&'static str> {
    let at = |x: &f32x8| x.as_array()[lane];
    let (value, pdf, weight, slot) = (
        s.value.each_ref().map(at),
        at(&s.pdf),
        s.weight.each_ref().map(at),
        at(&s.slot),
    );
    let wi = [at(&s.wi.x), at(&s.wi.y), at(&s.wi.z)];
    let lobe = subject.slots().find(|lobe| lobe.index() as f32 == slot);
    if !value.iter().chain(&weight).chain([&pdf]).all(|x| sound(*x)) {
        return Some("a value, density or weight is negative or not finite");
    }
    if !wi.iter().all(|x| x.is_finite()) {
        return Some("the direction is not finite");
    }
    let zero = value == [0.0; 3] && weight == [0.0; 3] && pdf == 0.0;
    let live = s.live() >> lane & 1 == 1;
    match lobe {
        None if slot != -1.0 => Some("the slot is none of the model's and not -1"),
        None if !zero || live || s.lane(lane).is_some() => {
            Some("a discarded sample has a value, density or weight")
        }
        None => None,
        Some(_) if !live || s.lane(lane).is_none() => Some("a sample has a slot, but no density"),
        Some(lobe) if !mask.contains(lobe) => Some("the lobe is masked"),
        Some(_) => {
            let length = wi
                .into_iter()
                .map(|x| f64::from(x).powi(2))
                .sum::<f64>()
                .sqrt();
            ((length - 1.0).abs() > 1e-5).then_some("the direction is not a unit vector")
        }
    }
}

/// Checks that values, densities, weights, colours and albedos are finite and not negative for every finite input, with all lobes and
/// some, on one lane and eight. Sampled directions are unit vectors. Discarded samples have neither value, density nor weight, and are
/// `None` in scalar.
///
/// # Errors
///
/// Returns a failure if a result is none of these.
pub fn results_are_finite(subject: &dyn ErasedSubject) -> Outcome {
    let property = Property {
        name: NAME,
        path: "totality::results_are_finite",
        subject,
        which: Which::WithExtremes,
        inputs: Inputs::Finite,
        tolerances: true,
        cases: CASES,
    };
    property.check([], |trial, []| is_sound(subject, trial))
}

/// Checks that every result of a case is finite and not negative.
pub(crate) fn is_sound(subject: &dyn ErasedSubject, trial: &Trial<'_>) -> Outcome {
    let (hits, wi, xi, mask) = (trial.hits, trial.wi, trial.xi, trial.lobes);
    let fail = |what: &str, lane: usize, how: &str, got: String| {
        let message = format!(
            "{what}: {}, {}: {got}",
            subject.lobes(mask),
            trial.at(lane, how)
        );
        Err(Failure::new(NAME, message))
    };
    let (wi8, xi8) = (packet(&wi), triples(&xi));
    for level in Level::available() {
        let each = trial
            .prepare(level, [0, 1, 2, 3, 4, 5, 6, 7])
            .with_lobes(mask);
        let one = trial.material(0).prepare(hits[0]).with_lobes(mask);
        let evals = [
            each.with_level(level).eval_pdf8(&wi8),
            one.with_level(level).eval_pdf8(&wi8),
        ];
        let samples = [
            each.with_level(level).sample8(&xi8),
            one.with_level(level).sample8(&xi8),
        ];
        let lobes = each.lobes8(&wi8).0;
        for lane in 0..8 {
            for lobe in &lobes {
                let at = |x: f32x8| x.as_array()[lane];
                let lobe = LobeEval::new(at(lobe.value), lobe.color.map(at), at(lobe.pdf));
                if !sound_lobe(&lobe) {
                    let got = format!("{lobe:?}");
                    return fail("a lobe", lane, &format!("eight hits {level}"), got);
                }
            }
            for (e, of) in evals.iter().zip(["eight hits", "one hit (that of lane 0)"]) {
                if !sound_eval(&e.lane(lane)) {
                    return fail(
                        "a value or density",
                        lane,
                        &format!("{of} {level}"),
                        format!("{:?}", e.lane(lane)),
                    );
                }
            }
            for (s, of) in samples
                .iter()
                .zip(["eight hits", "one hit (that of lane 0)"])
            {
                // Beyond the range of uniform numbers any lobe may be drawn.
                let within = xi[lane].iter().all(|xi| *xi < 1.0);
                if let Some(why) =
                    fault(s, lane, if within { mask } else { LobeMask::ALL }, subject)
                {
                    return fail(why, lane, &format!("{of} {level}"), format!("{s:?}"));
                }
            }
        }
    }
    for lane in 0..8 {
        let bsdf = trial.material(lane).prepare(hits[lane]).with_lobes(mask);
        let e = bsdf.eval_pdf(wi[lane]);
        if !sound_eval(&e) || (mask == LobeMask::NONE && (e.pdf != 0.0 || e.value != [0.0; 3])) {
            return fail("a value or density", lane, "scalar", format!("{e:?}"));
        }
        let lobes = bsdf.lobes(wi[lane]);
        let named = subject.lobe_count();
        for lobe in Lobe::ALL {
            let beyond =
                lobe.index() >= named && (lobes[lobe].value != 0.0 || lobes[lobe].pdf != 0.0);
            if !sound_lobe(&lobes[lobe]) || beyond {
                return fail(
                    "a lobe's value, color or density",
                    lane,
                    "scalar",
                    format!("{lobes:?}"),
                );
            }
        }
        // One lane gives the same bits again, because there is no state.
        let sample = bsdf.sample(xi[lane]);
        if let Some(s) = sample {
            let numbers = [s.value, s.weight].concat();
            let length = f64::from(s.wi.x)
                .hypot(f64::from(s.wi.y))
                .hypot(f64::from(s.wi.z));
            let unit = (length - 1.0).abs() <= 1e-5;
            let masked = !mask.contains(s.lobe) && xi[lane].iter().all(|xi| *xi < 1.0);
            if !numbers.into_iter().all(sound) || !sound(s.pdf) || s.pdf == 0.0 || !unit || masked {
                return fail("a sample", lane, "scalar", format!("{s:?}"));
            }
        }
        if sample != bsdf.sample(xi[lane]) {
            return fail(
                "a sample differs when it is drawn again",
                lane,
                "scalar",
                format!("{sample:?}"),
            );
        }
        // Albedos are integrals, and take as long as everything else of a case.
        for conserving in if lane == 0 { &[false, true][..] } else { &[] } {
            let bsdf = if *conserving {
                &bsdf.conserving()
            } else {
                &bsdf
            };
            let albedo = bsdf.albedo().0;
            if !albedo.as_flattened().iter().all(|x| sound(*x)) {
                let what = format!("an albedo (conserving: {conserving})");
                return fail(&what, lane, "scalar", format!("{albedo:?}"));
            }
        }
    }
    Ok(())
}
