//! Property that a sample reports the value and the density of its direction.

use crate::cases::Property;
use crate::cases::case::Source;
use crate::cases::inputs::Inputs;
use crate::erased::{ErasedSubject, Which};
use crate::failure::{Failure, Outcome};
use crate::near::Nearby;
use crate::probe::{cos_theta, triples};
use core::cell::Cell;
use hairis::Eval;
use hairis::simd::Level;

/// Number of packets of eight hits.
const CASES: usize = 3000;

/// Checks samples on one lane and on every level: a sample's value and density are those that evaluation gives at its direction, its
/// weight is `value cos theta_i / pdf`, and its own lobe has a density there.
///
/// # Errors
///
/// Returns a failure if a sample reports other numbers, or if no sample is kept.
pub fn samples_agree_with_eval(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "samples agree with evaluation";
    let claims = subject.claims();
    let quantities = [
        (
            "value or density of a sample (`Claims::sample_eval`)",
            claims.sample_eval,
        ),
        ("weight of a sample (`Claims::weight`)", claims.weight),
    ];
    let live = Cell::new(0_usize);
    let property = Property {
        name: NAME,
        path: "sampling::samples_agree_with_eval",
        subject,
        which: Which::Everyday,
        inputs: Inputs::Everyday,
        tolerances: true,
        cases: CASES,
    };
    property.check(quantities, |trial, [worst, weights]| {
        let nearby: [Nearby<'_>; 8] = core::array::from_fn(|lane| {
            Nearby::new(trial.material(lane), trial.hits[lane], claims.near_field)
        });
        let scalar =
            (0..8).map(|lane| (nearby[lane].bsdf().sample(trial.xi[lane]), lane, "one lane"));
        let packets = Level::available().flat_map(|level| {
            let each = trial.prepare(level, [0, 1, 2, 3, 4, 5, 6, 7]);
            let eight = each.with_level(level).sample8(&triples(&trial.xi));
            (0..8).map(move |lane| (eight.lane(lane), lane, level.name()))
        });
        for (sample, lane, level) in packets.chain(scalar) {
            let Some(s) = sample else { continue };
            live.set(live.get() + 1);
            let (wi, cos) = (s.wi, cos_theta(s.wi));
            // A tiny cosine is less accurate than the tolerance.
            if cos < 1e-3 {
                continue;
            }
            let at = || format!("{s:?} {}", trial.at(lane, level));
            for (value, weight) in s.value.into_iter().zip(s.weight) {
                let want = f64::from(value) * cos / f64::from(s.pdf);
                weights.see((f64::from(weight) - want).abs() / want.max(1e-12), at);
            }
            let bsdf = nearby[lane].bsdf();
            let e = bsdf.eval_pdf(wi);
            let reported = Eval {
                value: s.value,
                pdf: s.pdf,
            };
            let error = nearby[lane].error(reported, e, wi);
            worst.see(error, || format!("evaluation gives {e:?}: {}", at()));
            if bsdf.lobes(wi)[s.lobe].pdf <= 0.0 {
                let lobe = subject.lobe(s.lobe);
                let message = format!("its own lobe, {lobe}, has no density there: {}", at());
                return Err(Failure::new(NAME, message));
            }
        }
        Ok(())
    })?;
    if live.get() == 0 && matches!(subject.source(), Source::Fresh | Source::Kept(_)) {
        return Err(Failure::new(NAME, "no sample was kept at all"));
    }
    Ok(())
}
