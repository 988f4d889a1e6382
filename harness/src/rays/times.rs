//! Times of rays without their tracing: candidates, weights, look-ups of the light and the choice.
//!
//! Measured on one thread with nothing else at work. One-sample MIS and pools of every size alternate within a round, on the
//! same shading point and light. Numbers and the light's directions are drawn beforehand, the latter into blocks that are read
//! in a row; the preparation of the shading point is shared by all and left out.

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

/// Packets of numbers, and blocks of the light's directions.
const PACKETS: usize = 256;

/// Candidates of a stretch: some 30 to 60 µs.
const CANDIDATES: usize = 2048;

/// Place in [`THETA_O_DEG`](crate::efficiency::THETA_O_DEG) of the shading point.
const POSE: usize = 1;

/// Room for the largest pool, and for the rest of the last packet.
const ROOM: usize = 2 * MOST + 8;

/// Times of one model and sampler under one light: medians over the rounds, in ns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RayTimes {
    /// The model.
    pub model: &'static str,
    /// The sampler.
    pub sampler: &'static str,
    /// Name of the light.
    pub light: String,
    /// A ray by one-sample MIS, eight of each technique at a time.
    pub mis_ns: f64,
    /// Its standard error.
    pub mis_ns_error: f64,
    /// Pools, by [`SIZES`]: one ray chosen, and the most of [`RAYS`] that are no more than the candidates.
    pub pool_ns: [[f64; 2]; SIZES.len()],
    /// Standard errors of pools of which one ray is chosen.
    pub pool_ns_error: [f64; SIZES.len()],
}

/// Most rays from a pool.
fn most_rays(count: u32) -> u32 {
    RAYS[RAYS.len() - 1].min(2 * count)
}

impl RayTimes {
    /// Time of a pool and of the choice of `rays` of its candidates, in ns: linear between those that were measured.
    #[must_use]
    pub fn pool_ns(&self, candidates_each: u32, rays: u32) -> f64 {
        let Some(size) = SIZES.iter().position(|count| *count == candidates_each) else {
            return f64::NAN;
        };
        let [one, most] = self.pool_ns[size];
        one + (most - one) * f64::from(rays - 1) / f64::from(most_rays(candidates_each) - 1)
    }

    /// Time per candidate of a pool of 16 + 16, one ray chosen, in ns.
    #[must_use]
    pub fn candidate_ns(&self) -> f64 {
        self.pool_ns(16, 1) / 32.0
    }

    /// Time per candidate of a pool of 32 + 32, sixteen rays chosen, in ns.
    #[must_use]
    pub fn shared_candidate_ns(&self) -> f64 {
        self.pool_ns(32, 16) / 64.0
    }

    /// Time of one ray with its standard error, in ns: by one-sample MIS, or from a pool of so many candidates of each
    /// technique; not a number for a pool that there is not.
    pub(crate) fn ray(&self, candidates_each: Option<u32>) -> Estimate {
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

/// Measures every model and sampler under every light; `progress` is called with the number of those done and of all.
pub(crate) fn measure(
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
    // One-sample MIS first, then each pool with one ray and with the most.
    let pools = SIZES
        .iter()
        .flat_map(|count| [1, most_rays(*count)].map(|rays| Some((*count, rays))));
    let mut contenders: Vec<Option<(u32, u32)>> = [None].into_iter().chain(pools).collect();
    let found = in_turns(&mut contenders, rounds, |contender| {
        let work = || contender.map_or_else(|| at.mis(), |(count, rays)| at.pools(count, rays));
        // Untimed, for the caches.
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

/// A shading point under a light, with what is drawn beforehand.
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

    /// Rays by one-sample MIS, as many of each technique; returns their number.
    #[inline(never)]
    fn mis(&self) -> usize {
        for packet in 0..CANDIDATES / 16 {
            black_box(self.of_bsdf(packet).one_sample_mis());
            black_box(self.of_light(packet).one_sample_mis());
        }
        CANDIDATES
    }

    /// Pools of `count` candidates of each technique and the choice of `rays` of them; returns the number of pools.
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
            // Over what is left of the last packet.
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

/// The candidates of a pool.
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
