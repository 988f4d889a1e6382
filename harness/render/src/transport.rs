//! Light transport, which turns a scene into the sums of a film.

mod clock;
mod cut_off;
mod dual;
mod gather;
mod path;
pub mod profile;
mod recorded;
pub mod resampled;
mod wave;

pub use clock::seconds_of_thread;
pub use cut_off::{CutOff, cut_off};
pub use profile::{Phase, Profile};
pub use recorded::{Recorded, Term, record};

use crate::film::{Crop, Film, Tile};
use crate::lights::Tables;
use crate::numbers::Sequence;
use crate::scene::Scene;
use crate::tree::Ray;
use clap::ValueEnum;
use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use rayon::prelude::*;
use std::sync::Mutex;

/// How light is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Integrator {
    /// Direct light, with samples of light and BSDF at a fixed shading point per camera ray
    Gather,
    /// Direct light, one light and one BSDF sample per camera ray
    Direct,
    /// Paths
    Path,
    /// Direct light through the hair that it crosses, and what comes back from the hair behind: dual scattering
    Dual,
}

impl Integrator {
    /// Returns the word that selects the integrator on the command line.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Gather => "gather",
            Self::Direct => "direct",
            Self::Path => "path",
            Self::Dual => "dual",
        }
    }

    /// Returns the samples of a pass over a picture that grows. With [`Gather`](Self::Gather), each pass finds its shading points again.
    #[must_use]
    pub fn pass(self) -> u32 {
        if self == Self::Gather {
            resampled::POOL
        } else {
            PASS
        }
    }
}

/// Which samples count where light and BSDF samples both find a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Mis {
    /// Samples of the lights alone
    Light,
    /// Samples of the BSDF alone
    Bsdf,
    /// Both, weighted by the power heuristic
    Both,
    /// Rays chosen from six candidates each, of lights and BSDF; in paths from eight of the lights, by the power heuristic
    Resampled,
}

impl Mis {
    /// Returns the weight of a sample of density `pdf` that the other strategy would have drawn with density `other`: the square
    /// of `pdf` over the sum of both squares.
    #[inline]
    fn power(pdf: f32, other: f32) -> f32 {
        let ratio = f64::from(other) / f64::from(pdf);
        #[expect(clippy::cast_possible_truncation, reason = "a weight between 0 and 1")]
        let weight = (1.0 / (1.0 + ratio * ratio)) as f32;
        weight
    }

    /// Returns the weight of a sample of a light.
    #[inline]
    fn of_light(self, pdf: f32, bsdf: f32) -> f32 {
        match self {
            Self::Light => 1.0,
            Self::Bsdf => 0.0,
            Self::Both | Self::Resampled => Self::power(pdf, bsdf),
        }
    }

    /// Returns the weight of a sample of the BSDF that met a light.
    #[inline]
    fn of_bsdf(self, pdf: f32, light: f32) -> f32 {
        match self {
            Self::Light => 0.0,
            Self::Bsdf => 1.0,
            Self::Both | Self::Resampled => Self::power(pdf, light),
        }
    }
}

/// Settings by which a picture is rendered from a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Integrator that estimates the light.
    pub integrator: Integrator,
    /// Source of uniform numbers.
    pub sequence: Sequence,
    /// Seed of the samples.
    pub seed: u64,
    /// Samples that count where light and BSDF samples both find a light.
    pub mis: Mis,
    /// Largest number of scatterings of a path; `None` for paths of any length.
    pub depth: Option<u32>,
    /// Whether paths that have lost throughput end at random, with their survivors weighted.
    pub roulette: bool,
    /// Whether a path that comes from hair goes on where it meets hair.
    pub multiple: bool,
    /// Camera rays per pixel for [`Integrator::Gather`].
    pub rays: u32,
    /// Whether the time of each part of the work is measured: [`Film::profile`].
    pub profile: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            integrator: Integrator::Path,
            sequence: Sequence::Sobol,
            seed: 1,
            mis: Mis::Both,
            depth: None,
            roulette: true,
            multiple: true,
            rays: 1,
            profile: false,
        }
    }
}

/// Samples per pixel in one wave.
const PASS: u32 = 4;

/// Adds samples to a film until every pixel has `samples`. Calls `progress` with the share that is done.
///
/// The film has the same bits for any number of threads, and for samples that are added at once or bit by bit.
pub fn render(
    scene: &Scene,
    settings: &Settings,
    film: &mut Film,
    samples: u32,
    progress: &(dyn Fn(f64) + Sync),
) {
    render_until(scene, settings, film, samples, progress, &|| false);
}

/// Adds samples as [`render`] does, until `stop` returns true. `stop` is called after each tile, so
/// that at least one tile gets its samples.
pub fn render_until(
    scene: &Scene,
    settings: &Settings,
    film: &mut Film,
    samples: u32,
    progress: &(dyn Fn(f64) + Sync),
    stop: &Stop<'_>,
) {
    let tables = tables(scene, settings);
    render_by_tables(scene, &tables, settings, film, samples, progress, stop);
}

/// Returns the tables of the sky that a picture reads. They are not drawn yet.
#[must_use]
pub fn tables<'a>(scene: &'a Scene, settings: &Settings) -> Tables<'a> {
    let length = resampled::length(settings.integrator);
    Tables::new(&scene.sky, settings.seed, length)
}

/// Adds samples as [`render_until`] does, from tables of the sky that the caller has made.
pub fn render_by_tables(
    scene: &Scene,
    tables: &Tables<'_>,
    settings: &Settings,
    film: &mut Film,
    samples: u32,
    progress: &(dyn Fn(f64) + Sync),
    stop: &Stop<'_>,
) {
    let total = film.tiles.len().max(1);
    let todo: Vec<&mut Tile> = film
        .tiles
        .iter_mut()
        .filter(|tile| tile.samples < samples)
        .collect();
    let done = AtomicUsize::new(total - todo.len());
    let materials = dual::Materials::new(scene, settings.integrator);
    let whole = Mutex::new(Profile::default());
    each_until(todo, stop, |tile| {
        let start = seconds_of_thread();
        if settings.profile {
            profile::start();
        }
        match settings.integrator {
            Integrator::Gather => gather::tile(scene, tables, settings, tile, samples),
            Integrator::Direct | Integrator::Path => paths(scene, tables, settings, tile, samples),
            Integrator::Dual => dual::tile(scene, &materials, settings, tile, samples),
        }
        tile.seconds += seconds_of_thread() - start;
        if settings.profile
            && let Ok(mut whole) = whole.lock()
        {
            whole.add(profile::stop());
        }
        let done = 1 + done.fetch_add(1, Ordering::Relaxed);
        progress(done as f64 / total as f64);
    });
    film.profile.add(whole.into_inner().unwrap_or_default());
}

/// Function that returns true if no further tile is to be begun.
pub type Stop<'a> = dyn Fn() -> bool + Sync + 'a;

/// Works on tiles on all threads, until `stop` returns true after one of them.
pub(crate) fn each_until(
    tiles: Vec<&mut Tile>,
    stop: &Stop<'_>,
    work: impl Fn(&mut Tile) + Sync + Send,
) {
    let stopped = AtomicBool::new(false);
    tiles.into_par_iter().for_each(|tile| {
        if !stopped.load(Ordering::Relaxed) {
            work(tile);
            stopped.fetch_or(stop(), Ordering::Relaxed);
        }
    });
}

/// Renders a part of the picture of a scene, and returns its film.
#[must_use]
pub fn film(scene: &Scene, settings: &Settings, crop: Crop, samples: u32) -> Film {
    let mut film = Film::new(crop);
    render(scene, settings, &mut film, samples, &|_| ());
    film
}

/// Adds paths to a tile, a few samples of all its pixels at a time.
fn paths(scene: &Scene, tables: &Tables<'_>, settings: &Settings, tile: &mut Tile, samples: u32) {
    let mut wave = wave::Wave::default();
    while tile.samples < samples {
        let pass = PASS.min(samples - tile.samples);
        let samples = tile.samples..tile.samples + pass;
        let of_pixel = |pixel| samples.clone().map(move |sample| (pixel, sample));
        wave.start(scene, settings, tile.place.pixels().flat_map(of_pixel));
        path::run(scene, tables, settings, &mut wave);
        for (sums, radiances) in tile
            .sums
            .iter_mut()
            .zip(wave.radiances().chunks_exact(pass as usize))
        {
            radiances.iter().for_each(|radiance| sums.add(*radiance));
        }
        profile::lap(Phase::Rest);
        tile.samples += pass;
    }
}

/// Returns true if a ray towards a light reaches it, and counts the ray.
#[inline]
fn sees(scene: &Scene, ray: &Ray) -> bool {
    let reached = !scene.blocked(ray);
    profile::count_ray(reached);
    reached
}

/// Returns the key of a pixel for uniform numbers, which is the same in every crop.
fn key([x, y]: [u32; 2]) -> u64 {
    u64::from(y) << 32 | u64::from(x)
}
