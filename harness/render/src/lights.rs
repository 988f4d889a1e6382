//! Lights: rectangles in any frame, and skies, whose light comes from infinitely far away.

mod rectangle;
mod table;

pub use rectangle::{Rectangle, RectangleSampling, View};
pub use table::{TABLES, Table, Tables};

use core::f32::consts::TAU;
use glam::Vec3;
use hairis::Vec3x8;
use hairis::simd::f32x8;
use hairis_instruments::light::{self, Light, Seen8, rounded};
use std::sync::Arc;

/// Light from infinitely far away: any of the lights under which models are compared, or none.
///
/// ```
/// use hairis_instruments::light::Constant;
/// use hairis_render::lights::Sky;
/// assert!(Sky::BLACK.is_black() && !Sky::from(Constant).is_black());
/// ```
#[derive(Clone, Debug)]
pub struct Sky(Option<Arc<dyn Light>>);

impl<L: Light + 'static> From<L> for Sky {
    fn from(light: L) -> Self {
        Self(Some(Arc::new(light)))
    }
}

/// Direction towards a light that was drawn by one of its samplers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit direction.
    pub direction: Vec3,
    /// Distance to the light, infinite for a sky.
    pub distance: f32,
    /// Radiance from the direction, linear RGB.
    pub radiance: Vec3,
    /// Density per steradian, above 0.
    pub pdf: f32,
}

/// Eight directions towards lights, one per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample8 {
    /// Unit directions, which are arbitrary where the density is 0.
    pub direction: Vec3x8,
    /// Distances to the light, infinite for a sky.
    pub distance: f32x8,
    /// Radiance from the directions, linear RGB.
    pub radiance: [f32x8; 3],
    /// Densities per steradian, 0 where there is no light.
    pub pdf: f32x8,
}

impl LightSample8 {
    /// Returns the sample of a lane, drawn with a share of the density, or `None` if the density is 0.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize, share: f32) -> Option<LightSample> {
        let at = |lanes: &f32x8| lanes.as_array()[lane];
        let pdf = at(&self.pdf) * share;
        let radiance = Vec3::from_array(self.radiance.each_ref().map(at));
        let direction = self.direction.lane(lane);
        (pdf > 0.0).then_some(LightSample {
            direction,
            distance: at(&self.distance),
            radiance,
            pdf,
        })
    }
}

impl From<[Option<LightSample>; 8]> for LightSample8 {
    fn from(samples: [Option<LightSample>; 8]) -> Self {
        const NONE: LightSample = LightSample {
            direction: Vec3::Y,
            distance: 0.0,
            radiance: Vec3::ZERO,
            pdf: 0.0,
        };
        let samples = samples.map(|sample| sample.unwrap_or(NONE));
        let lanes = |of: fn(&LightSample) -> f32| f32x8::new(samples.each_ref().map(of));
        Self {
            direction: samples.map(|sample| sample.direction).into(),
            distance: lanes(|sample| sample.distance),
            radiance: [
                lanes(|one| one.radiance.x),
                lanes(|one| one.radiance.y),
                lanes(|one| one.radiance.z),
            ],
            pdf: lanes(|sample| sample.pdf),
        }
    }
}

/// Light that a ray meets: its radiance, and the density with which the direction is drawn from the lights, per steradian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Radiance, linear RGB.
    pub radiance: Vec3,
    /// Density of the direction, per steradian.
    pub pdf: f32,
}

impl Sky {
    /// Sky without light, which draws no directions.
    pub const BLACK: Self = Self(None);

    /// Returns true if the sky gives no light.
    #[must_use]
    pub const fn is_black(&self) -> bool {
        self.0.is_none()
    }

    /// Draws a direction towards the sky from two uniform numbers, or returns `None` without light.
    #[must_use]
    pub fn sample(&self, xi: [f32; 2]) -> Option<LightSample> {
        let light = self.0.as_ref()?;
        towards(&light.sample(xi.map(f64::from)))
    }

    /// Draws eight directions, as [`sample`](Self::sample) draws one, from the numbers of eight lanes.
    #[must_use]
    pub fn sample8(&self, xi: &[[f32; 8]; 2]) -> LightSample8 {
        let pairs = core::array::from_fn(|lane| [xi[0][lane], xi[1][lane]].map(f64::from));
        let draw = |light: &Arc<dyn Light>| light.sample8(pairs).each_ref().map(towards);
        LightSample8::from(self.0.as_ref().map_or([None; 8], draw))
    }

    /// Returns the radiance along a ray that meets nothing, and the density of its direction.
    #[must_use]
    pub fn see(&self, direction: Vec3) -> Seen {
        let look = |light: &Arc<dyn Light>| light.see(direction.as_dvec3());
        let (radiance, pdf) = self.0.as_ref().map_or(([0.0; 3], 0.0), look);
        Seen {
            radiance: Vec3::from_array(radiance.map(rounded)),
            pdf: rounded(pdf),
        }
    }

    /// Returns radiance and densities along eight rays that meet nothing, one per lane.
    #[must_use]
    pub fn see8(&self, directions: &Vec3x8) -> Seen8 {
        const DARK: Seen8 = Seen8 {
            radiance: [f32x8::ZERO; 3],
            pdf: f32x8::ZERO,
        };
        self.0.as_ref().map_or(DARK, |light| light.see8(directions))
    }
}

/// Converts a direction of a light to single precision, or returns `None` if it has no density.
fn towards(sample: &light::LightSample) -> Option<LightSample> {
    let pdf = rounded(sample.pdf);
    let radiance = Vec3::from_array(sample.radiance.map(rounded));
    let direction = sample.dir.as_vec3();
    (pdf > 0.0).then_some(LightSample {
        direction,
        distance: f32::INFINITY,
        radiance,
        pdf,
    })
}

/// Returns a direction that is uniform on the sphere. The first number is along x.
#[inline]
#[must_use]
pub fn uniform_direction([xi_x, xi_phi]: [f32; 2]) -> Vec3 {
    let x = 1.0 - 2.0 * xi_x;
    let across = (4.0 * xi_x * (1.0 - xi_x)).max(0.0).sqrt();
    let (sin, cos) = (TAU * xi_phi).sin_cos();
    Vec3::new(x, across * cos, across * sin)
}
