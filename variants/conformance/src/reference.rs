//! Property that the model agrees with its reference in double precision.

use crate::cases::Property;
use crate::cases::inputs::Inputs;
use crate::comparison::{over, relative};
use crate::erased::{ErasedSubject, Which};
use crate::failure::{Failure, Outcome, Worst, not_claimed};
use crate::probe::{Direction, cos_theta, double, packet, rounded, triples};
use crate::subject::{Expected, Tolerance};
use core::cell::Cell;
use hairis::simd::Level;
use hairis::{Eval, Lobe, Sample};
use hairis_reference::{Reference, ReferenceSample};

const NAME: &str = "the model agrees with its reference";

/// Number of packets of eight hits.
const CASES: usize = 1600;

/// Returns the error of `got` divided by the tolerance, less the change that moving the direction by the tolerated rounding causes.
fn excess(
    got: f64,
    at: impl Fn([f64; 3]) -> f64,
    wi: Direction,
    relative_to: f64,
    tolerance: &Tolerance,
) -> f64 {
    let want = at(double(wi));
    let plain = relative(got, want, tolerance.floor) / relative_to;
    if plain <= 1.0 || plain.is_nan() {
        return plain;
    }
    let by = rounded(wi, tolerance.rounding)
        .map(|wi| (at(double(wi)) - want).abs())
        .into_iter()
        .fold(0.0, f64::max);
    ((got - want).abs() - by).max(0.0) / (want.abs().max(tolerance.floor) * relative_to)
}

/// Checks that values, densities, lobes and samples are those of the [`Reference`], if the subject has one: on one lane and on every
/// level, on its named materials and on its random ones. Where the reference bounds errors by argument, that is the tolerance.
///
/// # Errors
///
/// Returns a failure if a result differs by more than [`Tolerance`] allows.
pub fn agrees_with_reference(subject: &dyn ErasedSubject) -> Outcome {
    let compared = Cell::new(0_usize);
    let property = Property {
        name: NAME,
        path: "reference::agrees_with_reference",
        subject,
        which: Which::WithRandom,
        inputs: Inputs::Everyday,
        tolerances: true,
        cases: CASES,
    };
    let quantities = ["S", "density", "lobe"].map(|what| (what, 1.0));
    property.check(quantities, |trial, worst| {
        let levels = Level::available().map(|level| {
            let each = trial.prepare(level, [0, 1, 2, 3, 4, 5, 6, 7]);
            let (e, s) = (
                each.with_level(level).eval_pdf8(&packet(&trial.wi)),
                each.with_level(level).sample8(&triples(&trial.xi)),
            );
            (e, s, level.name())
        });
        let levels: Vec<_> = levels.collect();
        for lane in (0..8).filter(|lane| cos_theta(trial.wi[*lane]) > 1e-3) {
            let (hit, wi, xi) = (trial.hits[lane], trial.wi[lane], trial.xi[lane]);
            let Some(Expected {
                reference,
                tolerance,
            }) = trial.material(lane).reference(&hit)
            else {
                return Ok(());
            };
            let bsdf = trial.material(lane).prepare(hit);
            let allowed = reference.error_bound(double(wi));
            let lanes = levels
                .iter()
                .map(|(e, s, level)| (e.lane(lane), s.lane(lane), *level));
            let one = (bsdf.eval_pdf(wi), bsdf.sample(xi), "one lane");
            for (e, s, level) in lanes.chain([one]) {
                let at = || trial.at(lane, level);
                see_eval(worst, &*reference, e, (wi, allowed), &tolerance, &at);
                compare_sample(&*reference, s, xi, &tolerance, &at)?;
                compared.set(compared.get() + 1);
            }
            let Some(bound) = tolerance.lobes else {
                continue;
            };
            let values = reference.lobe_values(double(wi)).0;
            if values[..subject.lobe_count()]
                .iter()
                .any(|value| *value < tolerance.lobe_floor)
            {
                continue;
            }
            let (lobes, of_lobes) = (bsdf.lobes(wi), reference.lobe_errors(double(wi)));
            for lobe in Lobe::ALL {
                let (value, pdf) = (lobes[lobe].value, lobes[lobe].pdf);
                let wants = [
                    &(|d| reference.lobe_values(d)[lobe]) as &dyn Fn([f64; 3]) -> f64,
                    &|d| reference.lobe_pdfs(d)[lobe],
                ];
                for (k, (got, at)) in [value, pdf].into_iter().zip(wants).enumerate() {
                    let error = match of_lobes {
                        Some(errors) => {
                            let want = at(double(wi));
                            over(got, want, want * errors[lobe][k], tolerance.floor)
                        }
                        None => excess(f64::from(got), at, wi, bound, &tolerance),
                    };
                    worst[2].see(error, || {
                        let lobe = subject.lobe(lobe);
                        format!("{lobe} {lobes:?}: {}", trial.at(lane, "one lane"))
                    });
                }
            }
        }
        Ok(())
    })?;
    if compared.get() == 0 {
        return not_claimed(NAME, "Subject::reference");
    }
    println!(
        "{NAME}: {} results, errors over their tolerance",
        compared.get()
    );
    Ok(())
}

fn see_eval(
    [value, pdf, _]: &mut [Worst; 3],
    reference: &dyn Reference<f64>,
    got: Eval,
    (wi, allowed): (Direction, Option<([f64; 3], f64)>),
    tolerance: &Tolerance,
    at: &impl Fn() -> String,
) {
    let want = || {
        format!(
            "{got:?}, reference {:?} {}: {}",
            reference.eval(double(wi)),
            reference.pdf(double(wi)),
            at()
        )
    };
    if let Some((allowed, allowed_pdf)) = allowed {
        let s = reference.eval(double(wi));
        for (c, x) in got.value.into_iter().enumerate() {
            value.see(over(x, s[c], allowed[c], tolerance.floor), want);
        }
        let density = reference.pdf(double(wi));
        let error = over(got.pdf, density, allowed_pdf, tolerance.floor);
        pdf.see(error, want);
        return;
    }
    for (c, x) in got.value.into_iter().enumerate() {
        value.see(
            excess(
                f64::from(x),
                |d| reference.eval(d)[c],
                wi,
                tolerance.value,
                tolerance,
            ),
            want,
        );
    }
    pdf.see(
        excess(
            f64::from(got.pdf),
            |d| reference.pdf(d),
            wi,
            tolerance.pdf,
            tolerance,
        ),
        want,
    );
}

/// Errors that a few roundings may cause in the numbers of a sample, and thus in the shares of its lobes.
const NUMBERS: [f64; 11] = [
    -4e-7, -2e-7, -1e-7, -5e-8, -2e-8, 0.0, 2e-8, 5e-8, 1e-7, 2e-7, 4e-7,
];

/// Checks that the sample has the lobe of the reference's sample, and its direction to the tolerance and to the change that rounding the
/// numbers causes: it lies between the samples of numbers on both sides. At the boundary of two lobes, and next to the axis, either
/// sample is accepted.
fn compare_sample(
    reference: &dyn Reference<f64>,
    got: Option<Sample>,
    xi: [f32; 3],
    tolerance: &Tolerance,
    at: &impl Fn() -> String,
) -> Outcome {
    let Some(bound) = tolerance.direction else {
        return Ok(());
    };
    let xi = xi.map(f64::from);
    // Distance of the sample from a sample of the reference, if both are of one lobe.
    let distance = |want: &ReferenceSample<f64>| match (want.lobe, got) {
        (None, None) => Some(0.0),
        (None, Some(s)) => (cos_theta(s.wi) < 1e-3).then_some(0.0),
        (Some(_), None) => (want.wi[1].hypot(want.wi[2]) < 1e-3).then_some(0.0),
        (Some(lobe), Some(s)) => (lobe == s.lobe).then(|| apart(double(s.wi), want.wi)),
    };
    let near = |want: &ReferenceSample<f64>| distance(want).is_some_and(|off| off <= bound);
    if near(&reference.sample(xi)) {
        return Ok(());
    }
    for axis in 0..3 {
        let path = path(reference, xi, axis);
        let is_between = |pair: &[ReferenceSample<f64>]| {
            let drawn = pair.iter().all(|want| want.lobe.is_some());
            match (distance(&pair[0]), distance(&pair[1])) {
                (Some(from), Some(to)) if drawn => {
                    from.max(to) <= 1.1 * apart(pair[0].wi, pair[1].wi) + bound
                }
                _ => false,
            }
        };
        if path.iter().any(near) || path.windows(2).any(is_between) {
            return Ok(());
        }
    }
    Err(Failure::new(
        NAME,
        format!(
            "sample {got:?}, reference {:?}: {}",
            reference.sample(xi),
            at()
        ),
    ))
}

/// Returns the samples of one of the numbers and of its neighbours. Between two lobes it also contains the samples on both sides of the
/// boundary, where azimuths may change fast.
fn path(reference: &dyn Reference<f64>, xi: [f64; 3], axis: usize) -> Vec<ReferenceSample<f64>> {
    let sample = |by: f64| {
        let mut xi = xi;
        xi[axis] = (xi[axis] + by).clamp(0.0, 1.0 - 1e-9);
        reference.sample(xi)
    };
    let mut path = vec![sample(NUMBERS[0])];
    for ends in NUMBERS.windows(2) {
        let [mut from, mut to] = [ends[0], ends[1]];
        let last = sample(to);
        let (mut before, mut after) = (path[path.len() - 1], last);
        let lobe = before.lobe;
        if lobe != last.lobe {
            // Down to the rounding of the number.
            for _ in 0..40 {
                let middle = 0.5 * (from + to);
                let found = sample(middle);
                if found.lobe == lobe {
                    (from, before) = (middle, found);
                } else {
                    (to, after) = (middle, found);
                }
            }
            path.extend([before, after]);
        }
        path.push(last);
    }
    path
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.into_iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}
