//! How long a sample takes, set-up included: what turns variances into efficiencies.
//!
//! Measured on one thread, with nothing else at work, on the default hair and eight gather points at a time, one a
//! lane. Contenders take turns within a round, as in [`speed`](crate::speed).

use super::columns::Columns;
use crate::efficiency::ModelKind;
use crate::sampler::{Directions, Sampler, Visit, uniform_sample8, uniform8, visit};
use crate::sequence::{Independent, stream_id};
use crate::speed::task::{Pass, task};
use crate::speed::{quartiles, stretch};
use crate::stats::Estimate;
use crate::subject::uniform_direction;
use core::hint::black_box;
use hairis::{Bsdf, HairParams, Model, Sample8, Vec3x8};
use wide::f32x8;

/// Samples of a gather point over which its set-up is spread: a path tracer's, and two of direct lighting.
pub(super) const PER_POINT: [usize; 3] = [1, 4, 16];

/// Packets of eight gather points a pass.
const PACKETS: usize = 64;

/// Time of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Time {
    pub(super) model: ModelKind,
    pub(super) sampler: Sampler,
    /// Samples of a gather point.
    pub(super) per_point: usize,
    /// First quartile, median and third quartile over the rounds, in ns.
    pub(super) quartiles: [f64; 3],
    /// Standard error of the median, in ns: that of a normal spread of the same quartiles.
    pub(super) standard_error: f64,
}

/// Median time of a sample, in ns; not a number if it was not measured.
pub(super) fn ns(times: &[Time], model: ModelKind, sampler: Sampler, per_point: usize) -> Estimate {
    let is = |time: &&Time| (time.model, time.sampler, time.per_point) == (model, sampler, per_point);
    let none = Estimate { value: f64::NAN, standard_error: f64::NAN };
    let of = |time: &Time| Estimate { value: time.quartiles[1], standard_error: time.standard_error };
    times.iter().find(is).map_or(none, of)
}

/// Measures every sampler of every model.
pub(super) fn measure(seed: u64, rounds: usize) -> Vec<Time> {
    let mut from = Independent::new(seed, stream_id(&[0x71e5]));
    let mut packet = || Points {
        wo: core::array::from_fn(|_| uniform_direction(&mut from)).into(),
        xi: core::array::from_fn(|_| core::array::from_fn(|_| f32x8::new(core::array::from_fn(|_| from.next_f32())))),
    };
    let points: Vec<Points> = (0..PACKETS).map(|_| packet()).collect();
    let mut contenders = Vec::new();
    for model in ModelKind::ALL {
        for sampler in Sampler::ALL {
            for per_point in PER_POINT {
                let pass = visit(model, sampler, MakePass { points: &points, per_point });
                contenders.push((model, sampler, per_point, pass, Vec::with_capacity(rounds)));
            }
        }
    }
    for round in 0..rounds {
        let count = contenders.len();
        for k in 0..count {
            let (.., per_point, pass, ns) = &mut contenders[(k + round) % count];
            // One stretch untimed, for the caches; short ones are repeated.
            let passes = 16 / u32::try_from(*per_point).unwrap_or(16);
            stretch(&**pass, 1);
            let samples = (8 * PACKETS * *per_point) as f64;
            ns.push(stretch(&**pass, passes) / (f64::from(passes) * samples));
        }
    }
    let time = |(model, sampler, per_point, _, ns): (_, _, _, _, Vec<f64>)| {
        let quartiles = quartiles(&ns);
        // A normal deviation is 1/1.349 of the distance of its quartiles, and a median's error 1.2533 of a mean's.
        let standard_error = 1.2533 / 1.349 * (quartiles[2] - quartiles[0]) / (rounds as f64).sqrt();
        Time { model, sampler, per_point, quartiles, standard_error }
    };
    contenders.into_iter().map(time).collect()
}

/// Eight gather points and the numbers of their samples.
#[derive(Clone)]
struct Points {
    wo: Vec3x8,
    xi: [[f32x8; 3]; 16],
}

struct MakePass<'a> {
    points: &'a [Points],
    per_point: usize,
}

impl Visit for MakePass<'_> {
    type Output = Box<dyn Pass>;

    fn visit<M>(self, model: M, directions: Directions) -> Box<dyn Pass>
    where
        M: Model<Params = HairParams> + 'static,
        M::Gather<f32>: Send + Sync,
    {
        let (bsdf, per_point) = (Bsdf::new(&model, &HairParams::default()), self.per_point);
        match directions {
            Directions::Sampled => task(self.points, move |points| {
                let gather = bsdf.prepare8(&points.wo);
                each(&points.xi[..per_point], |xi| gather.sample8(xi))
            }),
            Directions::Uniform => task(self.points, move |points| {
                let gather = bsdf.prepare8(&points.wo);
                each(&points.xi[..per_point], |xi| {
                    let wi = uniform8(xi);
                    uniform_sample8(wi, gather.eval_pdf8(&wi))
                })
            }),
        }
    }
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

/// The table of times.
pub(super) fn columns(times: &[Time]) -> Columns {
    let quartile = |k: usize| times.iter().map(move |time| time.quartiles[k]);
    Columns::new()
        .text("model", times.iter().map(|time| time.model.name()))
        .text("sampler", times.iter().map(|time| time.sampler.name()))
        .whole("samples_per_point", times.iter().map(|time| time.per_point))
        .number("ns", quartile(1))
        .number("ns_se", times.iter().map(|time| time.standard_error))
        .number("ns_q1", quartile(0))
        .number("ns_q3", quartile(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sampler_is_timed() {
        let times = measure(1, 3);
        assert_eq!(times.len(), ModelKind::ALL.len() * Sampler::ALL.len() * PER_POINT.len());
        for time in &times {
            let [q1, median, q3] = time.quartiles;
            assert!(q1 > 0.0 && q1 <= median && median <= q3 && time.standard_error >= 0.0, "{time:?}");
            assert_eq!(ns(&times, time.model, time.sampler, time.per_point).value, median);
        }
        assert!(ns(&times, ModelKind::Gaussian, Sampler::Ou, 2).value.is_nan(), "not measured");
    }
}
