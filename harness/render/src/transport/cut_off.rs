//! Estimate of the light that paths of a finite depth leave out.

use super::path;
use super::wave::Wave;
use super::{Integrator, Settings, resampled};
use crate::film::Film;
use crate::lights::Tables;
use crate::scene::Scene;
use core::fmt;
use glam::Vec3;
use hairis_instruments::sequence::Independent;
use hairis_instruments::stats::{Estimate, Moments};
use rayon::prelude::*;

/// Largest number of paths that are followed beyond the depth.
const PATHS: usize = 1 << 14;
/// Number of paths in a wave.
const WAVE: usize = 1 << 10;
/// Largest share of the light that may be missing without a remark.
const NEGLIGIBLE: f64 = 1e-3;

/// Shares of the red, green and blue light of a picture that lie beyond a depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutOff {
    depth: u32,
    shares: [Estimate; 3],
}

impl CutOff {
    /// Returns the shares of red, green and blue light, with standard errors.
    #[must_use]
    pub fn shares(&self) -> [Estimate; 3] {
        self.shares
    }

    /// Returns true if a share is too large to be passed over, or is not known.
    #[must_use]
    pub fn is_notable(&self) -> bool {
        let is_small = |share: &Estimate| share.value <= NEGLIGIBLE;
        !self.shares.iter().all(is_small)
    }
}

impl fmt::Display for CutOff {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { depth, shares } = self;
        write!(f, "--depth {depth} leaves out ")?;
        if shares.iter().any(|share| !share.value.is_finite()) {
            return f.write_str("light without bound: use --energy per-wo");
        }
        for (share, separator) in shares.iter().zip([", ", ", ", ""]) {
            let [value, error] = [share.value, share.standard_error].map(|part| 100.0 * part);
            write!(f, "{value:.2}% ± {error:.2}%{separator}")?;
        }
        f.write_str(" of the red, green and blue light: without --depth, paths have any length")
    }
}

/// Estimates the light that the depth of a film's paths has left out. Returns `None` if no depth limits
/// paths, or if the film has no samples.
///
/// Some of the film's paths, evenly chosen, are followed to their ends, and the light that they find
/// beyond the depth counts.
#[must_use]
pub fn cut_off(scene: &Scene, settings: &Settings, film: &Film) -> Option<CutOff> {
    let depth = settings.depth?;
    let samples = film.samples();
    if settings.integrator != Integrator::Path || samples == 0 {
        return None;
    }
    let pixels = || film.tiles.iter().flat_map(|tile| tile.place.pixels());
    let count = pixels().count();
    let mut paths: Vec<([u32; 2], u32)> = Vec::new();
    let per_pixel = samples.min(u32::try_from(PATHS / count).unwrap_or(u32::MAX));
    if per_pixel > 0 {
        let of_pixel = |pixel| (0..per_pixel).map(move |sample| (pixel, sample));
        paths.extend(pixels().flat_map(of_pixel));
    } else {
        // Choose one pixel at random from each of `PATHS` equal shares.
        let all: Vec<[u32; 2]> = pixels().collect();
        let mut xi = Independent::new(settings.seed, 0);
        let edge = |place: usize| place * count / PATHS;
        for place in 0..PATHS {
            let (first, end) = (edge(place), edge(place + 1));
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a place below a count"
            )]
            let offset = (xi.next_f64() * (end - first) as f64) as usize;
            paths.push((all[first + offset], 0));
        }
    }
    let length = resampled::length(settings.integrator);
    let tables = Tables::new(&scene.sky, settings.seed, length);
    let beyond = |paths: &[([u32; 2], u32)]| {
        let mut wave = Wave::default();
        wave.start(scene, settings, paths.iter().copied());
        path::run(scene, &tables, settings, &mut wave);
        path::run_beyond(scene, &tables, settings, &mut wave, depth);
        wave.radiances().to_vec()
    };
    let radiances: Vec<Vec3> = paths.par_chunks(WAVE).flat_map_iter(beyond).collect();
    // A shard's picture is black outside of its tiles.
    let covered = count as f64 / film.crop().len() as f64;
    let within = film.picture().mean().map(|mean| mean / covered);
    let shares = core::array::from_fn(|c| {
        let channel = radiances.iter().map(|radiance| f64::from(radiance[c]));
        let missing = channel.collect::<Moments>().mean_estimate();
        let whole = within[c] + missing.value;
        missing.scale(if whole == 0.0 { 0.0 } else { 1.0 / whole })
    });
    Some(CutOff { depth, shares })
}
