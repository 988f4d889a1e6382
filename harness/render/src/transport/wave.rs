//! Paths of a tile that are followed side by side.

use super::{Settings, key};
use crate::numbers::Numbers;
use crate::scene::{Met, Scene};
use crate::tree::{self, Ray};
use glam::Vec3;

/// Largest number of paths into which a camera ray is split.
pub(super) const MOST_PARTS: u32 = 64;

/// Path on its way through the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    pub(super) ray: Ray,
    /// Change of the sample per unit of radiance along the ray.
    pub(super) throughput: Vec3,
    /// Density with which the ray's direction was drawn, per steradian.
    pub(super) pdf: f32,
    /// Index of the sample in the wave.
    pub(super) slot: u32,
    pub(super) numbers: Numbers,
    /// Whether the ray comes from hair.
    pub(super) from_hair: bool,
    /// Number that decides whether the path goes on.
    pub(super) roulette: f32,
    pub(super) alive: bool,
    /// Largest number of paths into which this path may be split.
    pub(super) parts: u32,
}

/// Ray to a light, and the radiance that the light adds to a sample if nothing is between.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shadow {
    pub(super) ray: Ray,
    pub(super) radiance: Vec3,
    pub(super) slot: u32,
}

/// Paths and queues of a tile; reused from wave to wave.
#[derive(Debug, Default)]
pub(super) struct Wave {
    pub(super) paths: Vec<Path>,
    pub(super) met: Vec<Met>,
    /// Paths that met hair, with their hits.
    pub(super) hits: Vec<(u32, tree::Hit)>,
    pub(super) shadows: Vec<Shadow>,
    /// Parts of paths that were split, before they join the paths.
    pub(super) parts: Vec<Path>,
    radiances: Vec<Vec3>,
}

impl Wave {
    /// Starts the paths with camera rays, each for a sample of a pixel.
    pub(super) fn start(
        &mut self,
        scene: &Scene,
        settings: &Settings,
        samples: impl Iterator<Item = ([u32; 2], u32)>,
    ) {
        self.paths.clear();
        for (slot, (pixel, sample)) in (0..).zip(samples) {
            let mut numbers = Numbers::new(settings.sequence, settings.seed, key(pixel), sample);
            let [x, y, ..] = numbers.four();
            let ray = scene.camera.ray(pixel[0] as f32 + x, pixel[1] as f32 + y);
            self.paths.push(Path {
                ray,
                throughput: Vec3::ONE,
                pdf: 0.0,
                slot,
                numbers,
                from_hair: false,
                roulette: 0.0,
                alive: true,
                parts: MOST_PARTS,
            });
        }
        self.radiances.clear();
        self.radiances.resize(self.paths.len(), Vec3::ZERO);
    }

    /// Sets all radiances to 0.
    pub(super) fn forget(&mut self) {
        self.radiances.fill(Vec3::ZERO);
    }

    /// Adds light to a sample.
    #[inline]
    pub(super) fn add(&mut self, slot: u32, radiance: Vec3) {
        self.radiances[slot as usize] += radiance;
    }

    /// Returns the radiance of the samples, in the order of the camera rays.
    pub(super) fn radiances(&self) -> &[Vec3] {
        &self.radiances
    }
}
