//! Times of a sample, set-up included, and of a look-up of the light in its direction. They turn variances into
//! efficiencies.
//!
//! Measured on one thread, with nothing else at work, on the default hair and eight shading points at a time, one per
//! lane. Contenders alternate within a round, as in [`speed`](crate::speed).
//!
//! A look-up is [`Light::see8`] in directions of the published sampler, the light's density of them included, as multiple
//! importance sampling needs it. They are so many, and spread so far, that an environment is read as by a render: from
//! whatever cache holds all of it.

use super::columns::Columns;
use crate::light::{Light, Seen8};
use crate::sampler::{Sampler, bsdf, uniform_sample8, uniform8};
use crate::sequence::{Independent, stream_id};
use crate::speed::{median_error, quartiles, stretch, task};
use crate::stats::Estimate;
use crate::subject::ModelKind;
use crate::subject::uniform_direction;
use core::hint::black_box;
use hairis::{HairParams, Sample8, Vec3x8};
use hairis_benches::task::{Answer, Output, Pass};
use wide::f32x8;

/// Samples of a shading point over which its set-up is spread: a path tracer's, and two of direct lighting.
pub(super) const PER_POINT: [usize; 3] = [1, 4, 16];

/// Packets of eight shading points a pass.
const PACKETS: usize = 64;

/// Packets of eight shading points whose sixteen samples each are the directions of the look-ups, 2^16 in all.
const LOOK_UP_PACKETS: usize = 512;

/// Timed operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Timed {
    /// A sample.
    Sample {
        model: ModelKind,
        sampler: Sampler,
        /// Samples of a shading point.
        per_point: usize,
    },
    /// A look-up of the light at this place.
    LookUp(usize),
}

/// Time of one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Time {
    pub(super) of: Timed,
    /// First quartile, median and third quartile over the rounds, in ns.
    pub(super) quartiles: [f64; 3],
    /// Standard error of the median, in ns: that of a normal spread of the same quartiles.
    pub(super) standard_error: f64,
}

/// Median time in ns; not a number if it was not measured.
fn median(times: &[Time], of: Timed) -> Estimate {
    let found = |time: &Time| Estimate { value: time.quartiles[1], standard_error: time.standard_error };
    times.iter().find(|time| time.of == of).map_or(Estimate::UNKNOWN, found)
}

/// Time of a sample.
pub(super) fn ns(times: &[Time], model: ModelKind, sampler: Sampler, per_point: usize) -> Estimate {
    median(times, Timed::Sample { model, sampler, per_point })
}

/// Time of a look-up of the light at this place.
pub(super) fn look_up(times: &[Time], light: usize) -> Estimate {
    median(times, Timed::LookUp(light))
}

/// Something that is timed, and its times so far.
struct TimedSampler<'a> {
    of: Timed,
    pass: Box<dyn Pass + 'a>,
    /// Directions of a pass.
    directions: usize,
    /// Passes of a stretch.
    passes: u32,
    ns: Vec<f64>,
}

/// Measures every sampler of every model, and every light.
pub(super) fn measure(seed: u64, rounds: usize, lights: &[&dyn Light]) -> Vec<Time> {
    let mut from = Independent::new(seed, stream_id(&[0x71e5]));
    let points: Vec<Points> = (0..PACKETS).map(|_| Points::draw(&mut from)).collect();
    let mut contenders = Vec::new();
    for model in ModelKind::ALL {
        for sampler in Sampler::ALL {
            for per_point in PER_POINT {
                contenders.push(TimedSampler {
                    of: Timed::Sample { model, sampler, per_point },
                    pass: pass(model, sampler, &points, per_point),
                    directions: 8 * PACKETS * per_point,
                    passes: 16 / u32::try_from(per_point).unwrap_or(16),
                    ns: Vec::with_capacity(rounds),
                });
            }
        }
    }
    let seen = directions(&mut from);
    for (place, light) in lights.iter().enumerate() {
        contenders.push(TimedSampler {
            of: Timed::LookUp(place),
            pass: task(&seen, |wi| light.see8(wi)),
            directions: 8 * seen.len(),
            passes: 2,
            ns: Vec::with_capacity(rounds),
        });
    }
    for round in 0..rounds {
        let count = contenders.len();
        for k in 0..count {
            let TimedSampler { pass, directions, passes, ns, .. } = &mut contenders[(k + round) % count];
            // One stretch untimed, for the caches; short ones are repeated.
            stretch(&mut **pass, 1);
            ns.push(stretch(&mut **pass, *passes) / (f64::from(*passes) * *directions as f64));
        }
    }
    let time = |TimedSampler { of, ns, .. }: TimedSampler<'_>| {
        let quartiles = quartiles(&ns);
        Time { of, quartiles, standard_error: median_error(quartiles, rounds) }
    };
    contenders.into_iter().map(time).collect()
}

/// Directions of the published sampler on the default hair, sixteen per shading point.
fn directions(from: &mut Independent) -> Vec<Vec3x8> {
    let bsdf = bsdf(ModelKind::Gaussian, Sampler::Published, &HairParams::default());
    let of_packet = |_| {
        let points = Points::draw(from);
        let gather = bsdf.prepare8(&points.wo);
        points.xi.map(|xi| gather.sample8(&xi).wi)
    };
    (0..LOOK_UP_PACKETS).flat_map(of_packet).collect()
}

/// Eight shading points and the numbers of their samples.
#[derive(Clone)]
struct Points {
    wo: Vec3x8,
    xi: [[f32x8; 3]; 16],
}

impl Points {
    fn draw(from: &mut Independent) -> Self {
        Self {
            wo: core::array::from_fn(|_| uniform_direction(from)).into(),
            xi: core::array::from_fn(|_| {
                core::array::from_fn(|_| f32x8::new(core::array::from_fn(|_| from.next_f32())))
            }),
        }
    }
}

/// A pass over `points`, `per_point` samples each.
fn pass<'a>(model: ModelKind, sampler: Sampler, points: &[Points], per_point: usize) -> Box<dyn Pass + 'a> {
    let bsdf = bsdf(model, sampler, &HairParams::default());
    if sampler == Sampler::Uniform {
        task(points, move |points| {
            let gather = bsdf.prepare8(&points.wo);
            each(&points.xi[..per_point], |xi| {
                let wi = uniform8(xi);
                uniform_sample8(wi, gather.eval_pdf8(&wi))
            })
        })
    } else {
        task(points, move |points| {
            let gather = bsdf.prepare8(&points.wo);
            each(&points.xi[..per_point], |xi| gather.sample8(xi))
        })
    }
}

/// A look-up has neither a direction of its own nor a reference: it is timed, not checked.
impl Output for Seen8 {
    fn answers(&self, _: &mut Vec<Answer>) {}
}

/// Draws every sample and keeps the last.
#[inline(always)]
fn each(xi: &[[f32x8; 3]], sample: impl Fn(&[f32x8; 3]) -> Sample8) -> Sample8 {
    let mut last = sample(&xi[0]);
    for xi in &xi[1..] {
        last = sample(black_box(xi));
        black_box(&last);
    }
    last
}

/// The table of times; what does not apply to a row is empty.
pub(super) fn columns(times: &[Time], lights: &[String]) -> Columns {
    let quartile = |k: usize| times.iter().map(move |time| time.quartiles[k]);
    let words = |time: &Time| match time.of {
        Timed::Sample { model, sampler, per_point } => {
            [model.name().to_owned(), sampler.name().to_owned(), per_point.to_string(), String::new()]
        }
        Timed::LookUp(light) => [String::new(), String::new(), String::new(), lights[light].clone()],
    };
    let word = |k: usize| times.iter().map(move |time| words(time)[k].clone());
    Columns::new()
        .text("model", word(0))
        .text("sampler", word(1))
        .text("samples_per_point", word(2))
        .text("look_up", word(3))
        .number("ns", quartile(1))
        .number("ns_se", times.iter().map(|time| time.standard_error))
        .number("ns_q1", quartile(0))
        .number("ns_q3", quartile(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::{Constant, Smooth};

    #[test]
    fn every_sampler_and_light_is_timed() {
        let (constant, smooth) = (Constant::white(), Smooth::new());
        let times = measure(1, 3, &[&constant, &smooth]);
        assert_eq!(times.len(), ModelKind::ALL.len() * Sampler::ALL.len() * PER_POINT.len() + 2);
        for time in &times {
            let [q1, median, q3] = time.quartiles;
            assert!(q1 > 0.0 && q1 <= median && median <= q3 && time.standard_error >= 0.0, "{time:?}");
            let found = match time.of {
                Timed::Sample { model, sampler, per_point } => ns(&times, model, sampler, per_point),
                Timed::LookUp(light) => look_up(&times, light),
            };
            assert_eq!(found, Estimate { value: median, standard_error: time.standard_error });
        }
        assert!(ns(&times, ModelKind::Gaussian, Sampler::Published, 2).value.is_nan(), "not measured");
        assert!(look_up(&times, 2).value.is_nan(), "no such light");
    }

    #[test]
    fn look_ups_are_in_many_directions_all_over_the_sphere() {
        let seen = directions(&mut Independent::new(1, 0));
        assert_eq!(seen.len() * 8, 1 << 16);
        // Patches of one size: steps along the axis, and of 10 degrees around it.
        let mut cells = std::collections::BTreeSet::new();
        for wi in seen.iter().flat_map(|wi| (0..8).map(|lane| wi.lane(lane))) {
            assert!((wi.length() - 1.0).abs() < 1e-5, "{wi}");
            let patch = [10.0 * wi.x, wi.z.atan2(wi.y).to_degrees() / 10.0];
            cells.insert(patch.map(|place| place.floor().to_string()));
        }
        assert!(cells.len() > 700, "{} of 720 patches", cells.len());
    }
}
