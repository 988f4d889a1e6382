//! Lights: rectangles in any frame, and light from infinitely far away.

mod rectangle;

pub use rectangle::Rectangle;

use core::f32::consts::{PI, TAU};
use glam::Vec3;
use hairis_harness::light::{Environment, Light as _};

/// Light from infinitely far away.
#[derive(Clone, Debug)]
pub enum Sky {
    /// No light.
    Black,
    /// Radiance 1 from everywhere.
    White,
    /// A latitude-longitude map.
    Map(Box<Environment>),
}

/// A direction towards a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit direction.
    pub direction: Vec3,
    /// Distance to the light, infinite for a sky.
    pub distance: f32,
    /// Radiance from there, linear RGB.
    pub radiance: Vec3,
    /// Density per steradian, above 0.
    pub pdf: f32,
}

/// A light met by a ray: its radiance, and the density of drawing that direction from the lights, per steradian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Radiance, linear RGB.
    pub radiance: Vec3,
    /// Density per steradian.
    pub pdf: f32,
}

impl Sky {
    /// Whether it gives no light.
    #[must_use]
    pub fn is_black(&self) -> bool {
        matches!(self, Self::Black)
    }

    /// A direction drawn from two uniform numbers.
    #[must_use]
    pub fn sample(&self, xi: [f32; 2]) -> Option<LightSample> {
        match self {
            Self::Black => None,
            Self::White => {
                let direction = uniform_direction(xi);
                Some(LightSample { direction, distance: f32::INFINITY, radiance: Vec3::ONE, pdf: 0.25 / PI })
            }
            Self::Map(map) => {
                let sample = map.sample(xi.map(f64::from));
                let pdf = rounded(sample.pdf);
                let radiance = Vec3::from_array(sample.radiance.map(rounded));
                let direction = sample.dir.as_vec3();
                (pdf > 0.0).then_some(LightSample { direction, distance: f32::INFINITY, radiance, pdf })
            }
        }
    }

    /// Radiance along a ray that meets nothing, and the density of its direction.
    #[must_use]
    pub fn see(&self, direction: Vec3) -> Seen {
        match self {
            Self::Black => Seen { radiance: Vec3::ZERO, pdf: 0.0 },
            Self::White => Seen { radiance: Vec3::ONE, pdf: 0.25 / PI },
            Self::Map(map) => {
                let direction = direction.as_dvec3();
                let radiance = Vec3::from_array(map.radiance(direction).map(rounded));
                Seen { radiance, pdf: rounded(map.pdf(direction)) }
            }
        }
    }
}

/// A direction uniform on the sphere; the first number is along x.
#[inline]
#[must_use]
pub fn uniform_direction([xi_x, xi_phi]: [f32; 2]) -> Vec3 {
    let x = 1.0 - 2.0 * xi_x;
    let across = (4.0 * xi_x * (1.0 - xi_x)).max(0.0).sqrt();
    let (sin, cos) = (TAU * xi_phi).sin_cos();
    Vec3::new(x, across * cos, across * sin)
}

/// The nearest number of single precision.
#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is the purpose")]
const fn rounded(x: f64) -> f32 {
    x as f32
}
