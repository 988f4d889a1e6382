//! Times of rays without their tracing: candidates, weights, look-ups of the light and the choice.
//!
//! Times are measured on one thread with nothing else at work. One-sample MIS and pools of every size alternate within a round, on the same
//! shading point and light. Numbers and the light's directions are drawn beforehand, the latter into blocks that are read in a row. The
//! preparation of the shading point is shared by all and left out.

use super::candidates::{Candidates8, LightBlock, Lit, numbers};
use super::{MOST, RAYS, RaySubject, SIZES};
use crate::timer::in_turns;
use core::hint::black_box;
use hairis::resample::choose;
use hairis_instruments::light::Light;
use hairis_instruments::sequence::{Independent, stream_id};
use hairis_instruments::stats::Estimate;
use serde::Serialize;
use std::time::Instant;
use wide::f32x8;

/// Number of packets of numbers, and of blocks of the light's directions.
const PACKETS: usize = 256;

/// Number of candidates that are timed at a stretch: some 30 to 60 µs.
const CANDIDATES: usize = 2048;

/// Index in [`THETA_O_DEG`](crate::efficiency::THETA_O_DEG) of the shading point.
const POSE: usize = 1;

/// Room for the largest pool, and for the rest of the last packet.
const ROOM: usize = 2 * MOST + 8;

/// Times of one model and sampler under one light: medians over the rounds, in ns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RayTimes {
    /// Name of the model.
    pub model: &'static str,
    /// Name of the sampler.
    pub sampler: &'static str,
    /// Name of the light.
    pub light: String,
    /// Time of a ray by one-sample MIS, eight of each technique at a time.
    pub mis_ns: f64,
    /// Standard error of that time.
    pub mis_ns_error: f64,
    /// Times of pools, by [`SIZES`]: with one ray chosen, and with the most of [`RAYS`] that do not exceed the candidates.
    pub pool_ns: [[f64; 2]; SIZES.len()],
    /// Standard errors of the times with one ray chosen.
    pub pool_ns_error: [f64; SIZES.len()],
}

/// Returns the largest number of rays that are chosen from a pool.
fn most_rays(count: u32) -> u32 {
    RAYS[RAYS.len() - 1].min(2 * count)
}

impl RayTimes {
    /// Returns the time of a pool and of the choice of `rays` of its candidates, in ns, interpolated linearly between the measured times.
    #[must_use]
    pub fn pool_ns(&self, candidates_each: u32, rays: u32) -> f64 {
        let Some(size) = SIZES.iter().position(|count| *count == candidates_each) else {
            return f64::NAN;
        };
        let [one, most] = self.pool_ns[size];
        one + (most - one) * f64::from(rays - 1) / f64::from(most_rays(candidates_each) - 1)
    }

    /// Returns the time per candidate of a pool of 16 + 16, one ray chosen, in ns.
    #[must_use]
    pub fn candidate_ns(&self) -> f64 {
        self.pool_ns(16, 1) / 32.0
    }

    /// Returns the time per candidate of a pool of 32 + 32, sixteen rays chosen, in ns.
    #[must_use]
    pub fn shared_candidate_ns(&self) -> f64 {
        self.pool_ns(32, 16) / 64.0
    }

    /// Returns the time of one ray with its standard error, in ns: by one-sample MIS, or from a pool of so many candidates of each
    /// technique. The time is NaN if no such pool is measured.
    #[must_use]
    pub fn ray(&self, candidates_each: Option<u32>) -> Estimate {
        let Some(count) = candidates_each else {
            return Estimate {
                value: self.mis_ns,
                standard_error: self.mis_ns_error,
            };
        };
        let size = SIZES.iter().position(|of| *of == count);
        let of = |size: usize| Estimate {
            value: self.pool_ns[size][0],
            standard_error: self.pool_ns_error[size],
        };
        size.map_or(Estimate::UNKNOWN, of)
    }
}

/// Measures every model and sampler under every light; `progress` is called with the number of those done.
pub fn measure(
    subjects: &[RaySubject],
    lights: &[&dyn Light],
    seed: u64,
    rounds: usize,
    mut progress: impl FnMut(usize),
) -> Vec<RayTimes> {
    let mut source = Independent::new(seed, stream_id(&[0x4a75]));
    let xi: Vec<[f32x8; 3]> = (0..PACKETS).map(|_| numbers(&mut source)).collect();
    let tables: Vec<Vec<LightBlock>> = lights
        .iter()
        .map(|light| {
            (0..PACKETS)
                .map(|_| LightBlock::draw(*light, &mut source))
                .collect()
        })
        .collect();
    let mut times = Vec::new();
    for subject in subjects {
        let scatter = subject.scatter(POSE);
        for (light, blocks) in lights.iter().zip(&tables) {
            let at = Shading {
                lit: Lit {
                    scatter: &scatter,
                    light: *light,
                },
                xi: &xi,
                blocks,
            };
            times.push(row(*subject, &at, rounds));
            progress(times.len());
        }
    }
    times
}

fn row(subject: RaySubject, at: &Shading<'_>, rounds: usize) -> RayTimes {
    // One-sample MIS comes first, then each pool with one ray and with the most.
    let pools = SIZES
        .iter()
        .flat_map(|count| [1, most_rays(*count)].map(|rays| Some((*count, rays))));
    let mut contenders: Vec<Option<(u32, u32)>> = [None].into_iter().chain(pools).collect();
    let found = in_turns(&mut contenders, rounds, |contender| {
        let work = || contender.map_or_else(|| at.mis(), |(count, rays)| at.pools(count, rays));
        // The first pass is not timed; it fills the caches.
        work();
        let start = Instant::now();
        let units = work();
        start.elapsed().as_secs_f64() * 1e9 / units as f64
    });
    let median = |contender: usize| found[contender].median();
    RayTimes {
        model: subject.model(),
        sampler: subject.sampler(),
        light: at.lit.light.name().to_owned(),
        mis_ns: median(0).value,
        mis_ns_error: median(0).standard_error,
        pool_ns: core::array::from_fn(|size| [1, 2].map(|rays| median(2 * size + rays).value)),
        pool_ns_error: core::array::from_fn(|size| median(2 * size + 1).standard_error),
    }
}

/// Shading point under a light, with numbers and directions that are drawn beforehand.
struct Shading<'a> {
    lit: Lit<'a>,
    xi: &'a [[f32x8; 3]],
    blocks: &'a [LightBlock],
}

impl Shading<'_> {
    fn of_bsdf(&self, packet: usize) -> Candidates8 {
        self.lit.of_bsdf(black_box(&self.xi[packet % PACKETS]))
    }

    fn of_light(&self, packet: usize) -> Candidates8 {
        self.lit.of_light(black_box(&self.blocks[packet % PACKETS]))
    }

    /// Computes rays by one-sample MIS, as many of each technique, and returns their number.
    #[inline(never)]
    fn mis(&self) -> usize {
        for packet in 0..CANDIDATES / 16 {
            black_box(self.of_bsdf(packet).one_sample_mis());
            black_box(self.of_light(packet).one_sample_mis());
        }
        CANDIDATES
    }

    /// Computes pools of `count` candidates of each technique and the choice of `rays` of them, and returns the number of pools.
    #[inline(never)]
    fn pools(&self, count: u32, rays: u32) -> usize {
        let each = count as usize;
        let (packets, pools) = (each.div_ceil(8), CANDIDATES / (2 * each));
        let mut columns = PoolColumns {
            contribution: [[0.0; ROOM]; 3],
            weight: [0.0; ROOM],
        };
        for pool in 0..pools {
            for packet in 0..packets {
                columns.store(8 * packet, &self.of_bsdf(pool * packets + packet), count);
            }
            // The light's candidates overwrite the unused lanes of the last packet.
            for packet in 0..packets {
                columns.store(
                    each + 8 * packet,
                    &self.of_light(pool * packets + packet),
                    count,
                );
            }
            let contribution = columns
                .contribution
                .each_ref()
                .map(|column| &column[..2 * each]);
            let u = (pool as f32 + 0.5) / pools as f32;
            for choice in choose(contribution, &columns.weight[..2 * each], rays, u) {
                black_box(&choice);
            }
        }
        pools
    }
}

/// Candidates of a pool, by column.
struct PoolColumns {
    contribution: [[f32; ROOM]; 3],
    weight: [f32; ROOM],
}

impl PoolColumns {
    #[inline]
    fn store(&mut self, from: usize, candidates: &Candidates8, count: u32) {
        let weighed = candidates.weigh(count);
        for (column, channel) in self.contribution.iter_mut().zip(&weighed.contribution) {
            column[from..from + 8].copy_from_slice(channel.as_array());
        }
        self.weight[from..from + 8].copy_from_slice(weighed.weight.as_array());
    }
}
