//! Times of a sample, set-up included, and of a look-up of the light in its direction, which turn variances into efficiencies.
//!
//! Times are measured on one thread, with nothing else at work, on the default hair and eight shading points at a time, one per lane.
//! Contenders alternate within a round, as in [`speed`](crate::speed).
//!
//! A look-up is [`Light::see8`] in directions of the published sampler. It includes the light's density of the direction, which multiple
//! importance sampling needs. The directions are so many, and spread so far, that an environment is read as by a render, from the cache
//! level that holds all of it.

use crate::lights::Lights;
use crate::rays::{RaySubject, RayTimes, measure_times, numbers};
use crate::sampler::{Sampler, material, uniform_sample8, uniform8};
use crate::subject::ModelKind;
use crate::timer::{TimeSpread, in_turns, stretch};
use core::hint::black_box;
use hairis::{Eval8, HairParams, Sample8, Vec3x8};
use hairis_benches::task::{Pass, task};
use hairis_instruments::columns::Columns;
use hairis_instruments::direction::uniform_direction;
use hairis_instruments::light::{Environment, Light, Seen8};
use hairis_instruments::sequence::{Independent, stream_id};
use hairis_instruments::stats::Estimate;
use wide::f32x8;

/// Numbers of samples per shading point that share its set-up: a path tracer's, and two of direct lighting.
pub const PER_POINT: [usize; 3] = [1, 4, 16];

/// Passes of a stretch of samples, in the order of [`PER_POINT`]: sixteen samples of each point.
const PASSES: [u32; PER_POINT.len()] = [16, 4, 1];

/// Number of packets of eight shading points per pass.
const PACKETS: usize = 64;

/// Number of packets of eight shading points whose sixteen samples each are the directions of the look-ups, 2^16 in all.
const LOOK_UP_PACKETS: usize = 512;

/// Timed operation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Timed {
    /// Sample of a model by a sampler, with so many per shading point.
    Sample(ModelKind, Sampler, usize),
    /// Look-up of the light of this name.
    LookUp(String),
}

/// Numbers of rounds in which times are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rounds {
    /// Rounds of samples and look-ups.
    pub of_samples: usize,
    /// Rounds of rays.
    pub of_rays: usize,
}

impl Rounds {
    /// Rounds of the whole run.
    pub const FULL: Self = Self {
        of_samples: 75,
        of_rays: 75,
    };

    /// Rounds of the short run.
    pub const QUICK: Self = Self {
        of_samples: 15,
        of_rays: 9,
    };

    /// Returns the rounds of the short run, or of the whole one.
    #[must_use]
    pub const fn of(quick: bool) -> Self {
        if quick { Self::QUICK } else { Self::FULL }
    }
}

/// Times of a sample, of a look-up of the light and, on request, of a ray without its tracing, measured on this machine.
#[derive(Clone, Debug, Default)]
pub struct Times {
    /// Times of samples and look-ups.
    pub of_samples: Vec<(Timed, TimeSpread)>,
    /// Times of rays without their tracing; empty unless [`with_rays`](Self::with_rays) has measured them.
    pub of_rays: Vec<RayTimes>,
}

impl Times {
    /// Measures the times of samples and look-ups, with nothing else at work, in about three seconds, or less than one if quick. Without
    /// an environment, the time of its look-up stays unknown.
    #[must_use]
    pub fn measure(seed: u64, rounds: Rounds, environment: Option<&Environment>) -> Self {
        let of_samples = measure(seed, rounds.of_samples, &Lights::from(environment).all());
        Self {
            of_samples,
            of_rays: Vec::new(),
        }
    }

    /// Measures the times of rays as well, in about five seconds, or one if quick.
    #[must_use]
    pub fn with_rays(self, seed: u64, rounds: Rounds, environment: Option<&Environment>) -> Self {
        let is_measured = |of: &RaySubject| {
            ModelKind::ALL
                .iter()
                .any(|model| model.name() == of.model())
        };
        let subjects: Vec<RaySubject> = RaySubject::all().filter(is_measured).collect();
        let of_rays = measure_times(
            &subjects,
            &Lights::from(environment).all(),
            seed,
            rounds.of_rays,
            |_| (),
        );
        Self { of_rays, ..self }
    }

    /// Returns the median in ns, or NaN if the operation was not measured.
    fn median(&self, of: &Timed) -> Estimate {
        self.of_samples
            .iter()
            .find(|(timed, _)| timed == of)
            .map_or(Estimate::UNKNOWN, |(_, time)| time.median())
    }

    /// Returns the median time of a sample in ns, for 1, 4 or 16 samples per shading point, or NaN for other numbers.
    #[must_use]
    pub fn ns(&self, model: ModelKind, sampler: Sampler, per_point: usize) -> Estimate {
        self.median(&Timed::Sample(model, sampler, per_point))
    }

    /// Returns the median time of a look-up of the light of this name in ns, or NaN if it was not measured.
    #[must_use]
    pub fn look_up(&self, light: &str) -> Estimate {
        self.median(&Timed::LookUp(light.to_owned()))
    }

    /// Returns the times of samples and look-ups as columns. Fields that do not apply to a row are empty.
    #[must_use]
    pub fn columns(&self) -> Columns {
        let words = |(of, _): &(Timed, TimeSpread)| match of {
            Timed::Sample(model, sampler, per_point) => [
                model.name().to_owned(),
                sampler.name().to_owned(),
                per_point.to_string(),
                String::new(),
            ],
            Timed::LookUp(light) => [String::new(), String::new(), String::new(), light.clone()],
        };
        let word = |k: usize| {
            self.of_samples
                .iter()
                .map(move |time| words(time)[k].clone())
        };
        let quartile = |k: usize| {
            self.of_samples
                .iter()
                .map(move |(_, time)| time.quartiles[k])
        };
        Columns::default()
            .text("model", word(0))
            .text("sampler", word(1))
            .text("samples_per_point", word(2))
            .text("look_up", word(3))
            .estimate("ns", self.of_samples.iter().map(|(_, time)| time.median()))
            .number("ns_q1", quartile(0))
            .number("ns_q3", quartile(2))
    }
}

/// Measures every sampler of every model, and every light.
pub fn measure(seed: u64, rounds: usize, lights: &[&dyn Light]) -> Vec<(Timed, TimeSpread)> {
    let mut from = Independent::new(seed, stream_id(&[0x71e5]));
    let points: Vec<Points> = (0..PACKETS).map(|_| Points::draw(&mut from)).collect();
    // Each entry has the operation, a pass of it, and the passes of a stretch, because short passes are repeated.
    let mut contenders: Vec<(Timed, Box<dyn Pass + '_>, u32)> = Vec::new();
    for model in ModelKind::ALL {
        for sampler in Sampler::ALL {
            contenders.extend(
                PER_POINT
                    .into_iter()
                    .zip(PASSES)
                    .map(|(per_point, passes)| {
                        (
                            Timed::Sample(model, sampler, per_point),
                            pass(model, sampler, &points, per_point),
                            passes,
                        )
                    }),
            );
        }
    }
    let seen = directions(&mut from);
    contenders.extend(lights.iter().map(|light| {
        let pass: Box<dyn Pass + '_> = task(&seen, |wi| {
            let Seen8 {
                radiance: value,
                pdf,
            } = light.see8(wi);
            Eval8 { value, pdf }
        });
        (Timed::LookUp(light.name().to_owned()), pass, 2)
    }));
    let times = in_turns(&mut contenders, rounds, |(of, pass, passes)| {
        let directions = match of {
            Timed::Sample(_, _, per_point) => PACKETS * *per_point,
            Timed::LookUp(_) => seen.len(),
        };
        // The first stretch is not timed; it fills the caches.
        stretch(&mut **pass, 1);
        stretch(&mut **pass, *passes) / (f64::from(*passes) * (8 * directions) as f64)
    });
    contenders
        .into_iter()
        .map(|(of, ..)| of)
        .zip(times)
        .collect()
}

/// Draws directions of the published sampler on the default hair, sixteen per shading point.
pub fn directions(from: &mut Independent) -> Vec<Vec3x8> {
    let material = material(
        ModelKind::Gaussian,
        Sampler::Published,
        &HairParams::bright(),
    );
    let of_packet = |_| {
        let points = Points::draw(from);
        let bsdf = material.prepare8(&points.wo);
        points.xi.map(|xi| bsdf.sample8(&xi).wi)
    };
    (0..LOOK_UP_PACKETS).flat_map(of_packet).collect()
}

/// Eight shading points, with the numbers of their samples.
#[derive(Clone)]
struct Points {
    wo: Vec3x8,
    xi: [[f32x8; 3]; 16],
}

impl Points {
    fn draw(from: &mut Independent) -> Self {
        Self {
            wo: core::array::from_fn(|_| uniform_direction(from)).into(),
            xi: core::array::from_fn(|_| numbers(from)),
        }
    }
}

/// Returns a pass over `points`, with `per_point` samples each.
fn pass<'a>(
    model: ModelKind,
    sampler: Sampler,
    points: &[Points],
    per_point: usize,
) -> Box<dyn Pass + 'a> {
    let material = material(model, sampler, &HairParams::bright());
    task(points, move |points| {
        let bsdf = material.prepare8(&points.wo);
        let uniform = |xi: &[f32x8; 3]| {
            let wi = uniform8(xi);
            uniform_sample8(wi, bsdf.eval_pdf8(&wi))
        };
        let xi = &points.xi[..per_point];
        if sampler == Sampler::Uniform {
            each(xi, uniform)
        } else {
            each(xi, |xi| bsdf.sample8(xi))
        }
    })
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
