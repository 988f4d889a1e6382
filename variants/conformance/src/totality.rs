//! Every finite input gives finite results that are not negative.

use crate::erased::{Direction, ErasedSubject, NamedMaterial, Which};
use crate::failure::{Failure, Outcome};
use crate::probe::{Draws, LAST, direction, hits8, masks, packet, triples};
use hairis::model::LobeEval;
use hairis::simd::Level;
use hairis::{Eval, Hit, Lobe, LobeMask, Sample8};

const NAME: &str = "results are finite and not negative";

/// Packets per material.
const ROUNDS: usize = 2000;

/// Components that arithmetic trips over.
const COMPONENTS: [f32; 22] = [
    0.0,
    -0.0,
    1e-45,
    -1e-40,
    f32::MIN_POSITIVE,
    -1e-30,
    1e-20,
    -1e-19,
    1e-10,
    9.9e-6,
    -1.01e-5,
    1e-3,
    0.6,
    -0.8,
    LAST,
    1.0,
    -1.0,
    1.0 + f32::EPSILON,
    2.0,
    -1e19,
    1e30,
    f32::MAX,
];

/// Uniform numbers at the ends and the middle of their range; 1 is beyond it, and what rounding makes of others.
const NUMBERS: [f32; 12] = [
    0.0,
    1e-45,
    1e-30,
    f32::EPSILON / 2.0,
    1e-4,
    0.25,
    0.5 - f32::EPSILON / 4.0,
    0.5,
    0.5 + f32::EPSILON / 2.0,
    0.9999,
    LAST,
    1.0,
];

/// A vector of odd components, or a direction next to the axis, or any direction.
fn vector(draws: &mut Draws) -> Direction {
    match draws.pick(&[0, 0, 1, 2, 3]) {
        0 => Direction::new(
            *draws.pick(&COMPONENTS),
            *draws.pick(&COMPONENTS),
            *draws.pick(&COMPONENTS),
        ),
        1 => {
            let off = *draws.pick(&[1e-38, 1e-20, 1e-12, 1e-7, 0.99e-5, 1.01e-5, 1e-4_f32]);
            Direction::new(
                *draws.pick(&[1.0, -1.0, LAST]),
                off * *draws.pick(&[1.0, -1.0]),
                off * *draws.pick(&[0.0, 1.0]),
            )
        }
        2 => direction(
            draws.between(-1.6, 1.6),
            *draws.pick(&[0.0, 0.5, 1.0]) * core::f64::consts::PI,
        ),
        _ => draws.direction(),
    }
}

fn number(draws: &mut Draws) -> f32 {
    if *draws.pick(&[true, false]) {
        *draws.pick(&NUMBERS)
    } else {
        draws.xi()
    }
}

/// Whether a number is what values, densities and weights have to be.
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

/// Reason why a lane of a sample is not valid.
fn fault(
    s: &Sample8,
    lane: usize,
    mask: LobeMask,
    subject: &dyn ErasedSubject,
) -> Option<&'static str> {
    let at = |x: &hairis::simd::f32x8| x.as_array()[lane];
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

/// Values, densities, weights, colours and albedos are finite and not negative for every finite input, with all lobes and
/// some, on one lane and eight; sampled directions are unit vectors; discarded samples have neither value, density nor
/// weight, and are `None` in scalar.
///
/// # Errors
///
/// At the first input where something is not.
pub fn results_are_finite(subject: &dyn ErasedSubject) -> Outcome {
    sweep(subject, ROUNDS, vector)
}

/// Checks so many packets per material, of these directions.
pub(crate) fn sweep(
    subject: &dyn ErasedSubject,
    rounds: usize,
    vector: fn(&mut Draws) -> Direction,
) -> Outcome {
    let mut draws = Draws(0x0707);
    let masks = masks();
    for material in subject.set(Which::WithExtremes).iter() {
        let name = material.name();
        for round in 0..rounds {
            let hits: [Hit; 8] = core::array::from_fn(|_| {
                let h = *draws.pick(&[0.0, -0.0, 1.0, -1.0, 1e-40, 0.3, LAST, -1.5, 1e30]);
                Hit {
                    wo: vector(&mut draws).into(),
                    h,
                }
            });
            let wi: [Direction; 8] = core::array::from_fn(|_| vector(&mut draws));
            let xi: [[f32; 3]; 8] =
                core::array::from_fn(|_| core::array::from_fn(|_| number(&mut draws)));
            let mask = if round % 2 == 0 {
                LobeMask::ALL
            } else {
                *draws.pick(&masks)
            };
            let fail = |what: &str, lane: usize, how: &str, got: String| {
                let (hit, wi, xi) = (hits[lane], wi[lane], xi[lane]);
                let message = format!(
                    "{what}: {name} {mask:?} lane {lane} {how} {hit:?} {wi:?} xi {xi:?}: {got}"
                );
                Err(Failure::new(NAME, message))
            };
            let (wi8, xi8) = (packet(&wi), triples(&xi));
            for level in Level::available() {
                let each = NamedMaterial::prepare_packed([material; 8], level, hits8(&hits));
                let each = each.with_lobes(mask);
                let one = material.prepare(hits[0]).with_lobes(mask);
                let evals = [
                    each.with_level(level).eval_pdf8(&wi8),
                    one.with_level(level).eval_pdf8(&wi8),
                ];
                let samples = [
                    each.with_level(level).sample8(&xi8),
                    one.with_level(level).sample8(&xi8),
                ];
                for lane in 0..8 {
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
            let lane = round % 8;
            let bsdf = material.prepare(hits[lane]).with_lobes(mask);
            let e = bsdf.eval_pdf(wi[lane]);
            if !sound_eval(&e) || (mask == LobeMask::NONE && (e.pdf != 0.0 || e.value != [0.0; 3]))
            {
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
            // One lane repeats, bit for bit: there is no state.
            let sample = bsdf.sample(xi[lane]);
            if let Some(s) = sample {
                let numbers = [s.value, s.weight].concat();
                let length = f64::from(s.wi.x)
                    .hypot(f64::from(s.wi.y))
                    .hypot(f64::from(s.wi.z));
                let unit = (length - 1.0).abs() <= 1e-5;
                let masked = !mask.contains(s.lobe) && xi[lane].iter().all(|xi| *xi < 1.0);
                if !numbers.into_iter().all(sound)
                    || !sound(s.pdf)
                    || s.pdf == 0.0
                    || !unit
                    || masked
                {
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
            if round % 16 == 0 {
                for (bsdf, what) in [
                    (&bsdf, "an albedo"),
                    (&bsdf.conserving(), "an albedo of conserving hair"),
                ] {
                    let albedo = bsdf.albedo().0;
                    if !albedo.as_flattened().iter().all(|x| sound(*x)) {
                        return fail(what, lane, "scalar", format!("{albedo:?}"));
                    }
                }
            }
        }
    }
    Ok(())
}
