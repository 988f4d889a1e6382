//! One ray for many candidates: the variance of direct light from a ray that [`hairis::resample`] chooses, against rays by sampling the
//! BSDF, by sampling the light, and by one-sample MIS; with visibility, and in equal time.
//!
//! # What is measured
//!
//! Measured is the estimate of direct light as one number (the mean of its RGB), of every model with each of its samplers, under five
//! lights, seen from [`THETA_O_DEG`](crate::efficiency::THETA_O_DEG). V is the relative variance of an estimate.
//!
//! - **One-sample MIS** draws a direction from the BSDF or from the light, each with probability 1/2, and divides by the mean of both
//!   densities (the balance heuristic of Veach and Guibas 1995). V of the three plain estimators is the mean of `(f/p - I)^2 p/m` over
//!   candidates of the mixture m of both techniques, with the reference I. This mean has a small error even if the BSDF's sampler hits a
//!   small light once in a million samples.
//! - **Pools** hold as many candidates of the BSDF as of the light, [`SIZES`] of each. [`choose`](hairis::resample::choose) selects
//!   [`RAYS`] of them. V is that of their estimates.
//! - **Visibility** is drawn for each candidate on its own: the ray passes with probability v. For one ray V becomes `(V + 1)/v - 1`. This
//!   is exact, as visibility is independent of the estimate, for a plain ray and for a chosen one (test
//!   `one_ray_obeys_the_law_of_visibility`). With several rays from a pool, V is measured, at v = 1/2.
//! - **Equal time**: a ray's price is a parameter, see [`equal_time`]. Times are those of this machine; all else depends on the seed alone.
//!
//! Means are compared with references: those of [`efficiency`](crate::efficiency) for the two bells, and stratified runs over the formulas
//! in double precision for the others. [`Check`] collects the scores.

mod candidates;
pub mod equal_time;
mod measure;
mod result;
mod run;
mod subject;
mod times;

pub use candidates::{LightBlocks, Lit, numbers};
pub use equal_time::{EqualTime, PRICES_US};
pub use measure::{Unoccluded, pose, unoccluded};
pub use result::occluded;
pub use result::{OneRay, PoolFigures, RayFigures, RayPose, RayRow};
pub use run::{RaysConfig, RaysResult, check, rows, run};
pub use subject::RaySubject;
pub use times::{RayTimes, measure as measure_times};

#[cfg(doc)]
use crate::efficiency::Check;

/// Numbers of candidates of each technique in the pools that are measured.
pub const SIZES: [u32; 5] = [2, 4, 8, 16, 32];

/// Numbers of rays that are chosen from a pool.
pub const RAYS: [u32; 5] = [1, 2, 4, 8, 16];

/// Shares of the directions that are visible, for which V is reported.
pub const VISIBLE: [f64; 3] = [0.25, 0.5, 0.75];

/// Share of visible directions at which pools of several rays are measured, and at which times are compared.
pub const HALF: f64 = 0.5;

/// Number of candidates of each technique that are drawn at once, which is that of the largest pool.
pub const MOST: usize = 32;

/// Returns every pool with each number of rays from it, by place in [`SIZES`] and [`RAYS`], with no more rays than candidates.
pub fn pools() -> impl Iterator<Item = (usize, usize)> {
    let pairs = (0..SIZES.len()).flat_map(|size| (0..RAYS.len()).map(move |rays| (size, rays)));
    pairs.filter(|&(size, rays)| RAYS[rays] <= 2 * SIZES[size])
}
