//! Efficiency in equal time, with the price of a ray as a parameter.
//!
//! An estimate takes the time of its candidates and of its choice, and the price of a ray for each ray that is traced. Its efficiency is
//! `1 / (V time)`, with half of the directions visible; gains are over one-sample MIS at the same price. The preparation of the shading
//! point is left out of both.

use super::result::PoolFigures;
use super::{HALF, RAYS, RayRow, RayTimes, VISIBLE};
use serde::Serialize;

/// Prices of a ray at which efficiencies are compared, in µs.
pub const PRICES_US: [f64; 4] = [0.1, 0.3, 1.0, 3.0];

/// Efficiencies of a model and sampler under one light, in equal time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EqualTime {
    /// Name of the model.
    pub model: &'static str,
    /// Name of the sampler.
    pub sampler: &'static str,
    /// Name of the light.
    pub light: String,
    /// Estimates by one-sample MIS, by number of rays.
    pub mis: Vec<Point>,
    /// Estimates from pools, by candidates and rays.
    pub pools: Vec<Point>,
}

/// Estimate of direct light at one shading point, with its time and its error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// Number of candidates of the BSDF, and of the light; 0 for one-sample MIS.
    pub candidates_each: u32,
    /// Number of choices, or of samples for one-sample MIS.
    pub rays: u32,
    /// Number of rays that are traced, on average.
    pub traced: f64,
    /// Relative variance, with half of the directions visible.
    pub v: f64,
    /// Time without the rays, in ns.
    pub ns: f64,
    /// Efficiency over that of one-sample MIS, one for each of [`PRICES_US`].
    pub gain: [f64; 4],
    /// Price in µs above which the estimate is more efficient than one-sample MIS: 0 if it is at any price, none if it never is.
    pub break_even_us: Option<f64>,
    /// Whether no other estimate of less time has a lesser V, one for each of [`PRICES_US`].
    pub on_front: [bool; 4],
}

impl Point {
    fn new(candidates_each: u32, rays: u32, [traced, v, ns]: [f64; 3]) -> Self {
        Self {
            candidates_each,
            rays,
            traced,
            v,
            ns,
            gain: [1.0; 4],
            break_even_us: None,
            on_front: [false; 4],
        }
    }

    /// Returns the time at this price of a ray, in ns.
    #[must_use]
    pub fn time_ns(&self, price_us: f64) -> f64 {
        self.ns + 1e3 * price_us * self.traced
    }

    /// Returns the efficiency over that of `other` at this price of a ray.
    #[must_use]
    pub fn gain_over(&self, other: &Self, price_us: f64) -> f64 {
        other.v * other.time_ns(price_us) / (self.v * self.time_ns(price_us))
    }

    /// Returns the price above which `self` is more efficient than `other`. `V time` of both is linear in the price.
    fn break_even(&self, other: &Self) -> Option<f64> {
        let at_nothing = other.v * other.ns - self.v * self.ns;
        let per_ns = other.v * other.traced - self.v * self.traced;
        (per_ns > 0.0).then(|| (-at_nothing / per_ns).max(0.0) * 1e-3)
    }
}

impl EqualTime {
    /// Joins the figures of a row with its times.
    #[must_use]
    pub fn new(row: &RayRow, times: &RayTimes) -> Self {
        let half = VISIBLE
            .iter()
            .position(|share| *share == HALF)
            .unwrap_or_default();
        let v = row.mean.mis.visible[half].value;
        let mis = RAYS.map(|rays| {
            let count = f64::from(rays);
            Point::new(0, rays, [count, v / count, times.mis_ns * count])
        });
        let pool = |pool: &PoolFigures| {
            let ns = times.pool_ns(pool.candidates_each, pool.rays);
            let point = Point::new(
                pool.candidates_each,
                pool.rays,
                [pool.traced, pool.v.value, ns],
            );
            let gain = PRICES_US.map(|price| point.gain_over(&mis[0], price));
            Point {
                gain,
                break_even_us: point.break_even(&mis[0]),
                ..point
            }
        };
        let mut all: Vec<Point> = mis
            .iter()
            .cloned()
            .chain(row.mean.half.iter().map(pool))
            .collect();
        for (place, price) in PRICES_US.into_iter().enumerate() {
            let at: Vec<[f64; 2]> = all
                .iter()
                .map(|point| [point.time_ns(price), point.v])
                .collect();
            for (point, [time, v]) in all.iter_mut().zip(&at) {
                point.on_front[place] = !at
                    .iter()
                    .any(|[t, w]| t <= time && w <= v && (t < time || w < v));
            }
        }
        let pools = all.split_off(mis.len());
        Self {
            model: row.model,
            sampler: row.sampler,
            light: row.light.clone(),
            mis: all,
            pools,
        }
    }

    /// Returns the estimate from a pool of this size with this number of rays.
    #[must_use]
    pub fn pool(&self, candidates_each: u32, rays: u32) -> Option<&Point> {
        self.pools
            .iter()
            .find(|point| (point.candidates_each, point.rays) == (candidates_each, rays))
    }

    /// Returns the most efficient pool at a price of a ray, in µs.
    #[must_use]
    pub fn best(&self, price_us: f64) -> Option<&Point> {
        let gain = |point: &Point| point.gain_over(&self.mis[0], price_us);
        self.pools.iter().max_by(|a, b| gain(a).total_cmp(&gain(b)))
    }
}
