//! The model agrees with its reference in double precision.

use crate::erased::{Direction, ErasedSubject, Which};
use crate::failure::{Failure, Outcome, Worst};
use crate::probe::{Draws, cos_theta, double, hits_and, packet, relative, rounded, triples};
use crate::subject::{Reference, ReferenceSample, Tolerance};
use hairis::simd::Level;
use hairis::{Eval, Lobe, Sample};

const NAME: &str = "the model agrees with its reference";

/// Hits per material, and packets per hit.
const HITS: usize = 40;
const PACKETS: usize = 4;

/// Error of `got`, less what moving the direction by the tolerated rounding changes, over the tolerance.
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

/// Values, densities, lobes and samples are those of the [`Reference`], where the subject has one: on one lane and on every
/// level, on its materials and on its random ones.
///
/// # Errors
///
/// At the first result that differs.
pub fn agrees_with_reference(subject: &dyn ErasedSubject) -> Outcome {
    let mut draws = Draws(0x4ef5);
    let mut worst = ["S", "density", "lobe"].map(|what| Worst::new(NAME, what, 1.0));
    let mut compared = 0_usize;
    for material in subject.set(Which::WithRandom).iter() {
        let name = material.name();
        for hit in hits_and(HITS, &mut draws) {
            let Some(reference) = material.reference(&hit) else {
                return Ok(());
            };
            let tolerance = reference.tolerance();
            let bsdf = material.prepare(hit);
            for n in 0..PACKETS {
                let xi: [[f32; 3]; 8] = core::array::from_fn(|_| draws.xi3());
                let wi: [Direction; 8] = core::array::from_fn(|lane| {
                    let any = draws.direction();
                    let drawn = bsdf.sample(draws.xi3()).map_or(any, |s| s.wi.into());
                    if (lane + n) % 2 == 0 { any } else { drawn }
                });
                let levels = Level::available().map(|level| {
                    let (e, s) = (
                        bsdf.with_level(level).eval_pdf8(&packet(&wi)),
                        bsdf.with_level(level).sample8(&triples(&xi)),
                    );
                    (e, s, level.name())
                });
                let levels: Vec<_> = levels.collect();
                for lane in (0..8).filter(|lane| cos_theta(wi[*lane]) > 1e-3) {
                    let lanes = levels
                        .iter()
                        .map(|(e, s, level)| (e.lane(lane), s.lane(lane), *level));
                    let one = (bsdf.eval_pdf(wi[lane]), bsdf.sample(xi[lane]), "one lane");
                    for (e, s, level) in lanes.chain([one]) {
                        let at = || {
                            format!("{name} {hit:?} {:?} xi {:?} on {level}", wi[lane], xi[lane])
                        };
                        see_eval(&mut worst, &*reference, e, wi[lane], &tolerance, &at)?;
                        compare_sample(&*reference, s, xi[lane], &tolerance, &at)?;
                        compared += 1;
                    }
                    let lobes = bsdf.lobes(wi[lane]);
                    if reference.lobes(double(wi[lane])).is_none() {
                        continue;
                    }
                    for lobe in Lobe::ALL {
                        for (part, got) in
                            [lobes[lobe].value, lobes[lobe].pdf].into_iter().enumerate()
                        {
                            let of = |d| {
                                reference
                                    .lobes(d)
                                    .map_or(0.0, |all| all[lobe.index()][part])
                            };
                            let error =
                                excess(f64::from(got), of, wi[lane], tolerance.lobes, &tolerance);
                            worst[2].see(error, || {
                                format!("{lobe:?} {lobes:?}: {name} {hit:?} {:?}", wi[lane])
                            })?;
                        }
                    }
                }
            }
        }
    }
    println!("{NAME}: {compared} results, errors over their tolerance:");
    worst.into_iter().try_for_each(Worst::report)
}

fn see_eval(
    [value, pdf, _]: &mut [Worst; 3],
    reference: &dyn Reference,
    got: Eval,
    wi: Direction,
    tolerance: &Tolerance,
    at: &impl Fn() -> String,
) -> Outcome {
    let want = || {
        format!(
            "{got:?}, reference {:?} {}: {}",
            reference.eval(double(wi)),
            reference.pdf(double(wi)),
            at()
        )
    };
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
        )?;
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
    )
}

/// How far the numbers of a sample, and with them the shares of its lobes, may be off: a few roundings.
const NUMBERS: [f64; 11] = [
    -4e-7, -2e-7, -1e-7, -5e-8, -2e-8, 0.0, 2e-8, 5e-8, 1e-7, 2e-7, 4e-7,
];

/// The sample has the lobe of the reference's, and its direction to the tolerance and to what rounding the numbers moves it:
/// it lies between the samples of numbers on both sides. At the boundary of two lobes, and next to the axis, either is right.
fn compare_sample(
    reference: &dyn Reference,
    got: Option<Sample>,
    xi: [f32; 3],
    tolerance: &Tolerance,
    at: &impl Fn() -> String,
) -> Outcome {
    let xi = xi.map(f64::from);
    // Distance of the sample from one of the reference's, if they are of one lobe.
    let distance = |want: ReferenceSample| match (want, got) {
        (ReferenceSample::Unknown, _) | (ReferenceSample::Discarded, None) => Some(0.0),
        (ReferenceSample::Discarded, Some(s)) => (cos_theta(s.wi.into()) < 1e-3).then_some(0.0),
        (ReferenceSample::SampleLanes(_, [_, v, w]), None) => (v.hypot(w) < 1e-3).then_some(0.0),
        (ReferenceSample::SampleLanes(slot, wi), Some(s)) => {
            (slot == s.lobe.index()).then(|| apart(double(s.wi.into()), wi))
        }
    };
    let near = |want| distance(want).is_some_and(|off| off <= tolerance.direction);
    if near(reference.sample(xi)) {
        return Ok(());
    }
    for axis in 0..3 {
        let path = NUMBERS.map(|by| {
            let mut xi = xi;
            xi[axis] = (xi[axis] + by).clamp(0.0, 1.0 - 1e-9);
            reference.sample(xi)
        });
        let is_between = |pair: &[ReferenceSample]| match (
            pair[0],
            pair[1],
            distance(pair[0]),
            distance(pair[1]),
        ) {
            (
                ReferenceSample::SampleLanes(_, a),
                ReferenceSample::SampleLanes(_, b),
                Some(from),
                Some(to),
            ) => from.max(to) <= 1.1 * apart(a, b) + tolerance.direction,
            _ => false,
        };
        if path.into_iter().any(near) || path.windows(2).any(is_between) {
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

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.into_iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}
