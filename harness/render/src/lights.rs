//! Lights: rectangles in any frame, and light from infinitely far away.

mod rectangle;
mod table;

pub use rectangle::{Rectangle, RectangleSampling, View};
pub use table::{Table, Tables};

use core::f32::consts::{PI, TAU};
use glam::Vec3;
use hairis::Vec3x8;
use hairis::simd::f32x8;
use hairis_instruments::light::{self, Environment, Light as _, Seen8, rounded};

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

/// Eight directions towards lights, one per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample8 {
    /// Unit directions; any where the density is 0.
    pub direction: Vec3x8,
    /// Distance to the light, infinite for a sky.
    pub distance: f32x8,
    /// Radiance from there, linear RGB.
    pub radiance: [f32x8; 3],
    /// Density per steradian; 0 where there is no light.
    pub pdf: f32x8,
}

impl LightSample8 {
    /// The sample of a lane, drawn with a share of the density.
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
                Some(LightSample {
                    direction,
                    distance: f32::INFINITY,
                    radiance: Vec3::ONE,
                    pdf: 0.25 / PI,
                })
            }
            Self::Map(map) => towards(&map.sample(xi.map(f64::from))),
        }
    }

    /// Eight directions, as [`sample`](Self::sample) draws them.
    #[must_use]
    pub fn sample8(&self, xi: &[[f32; 8]; 2]) -> LightSample8 {
        let pairs: [[f32; 2]; 8] = core::array::from_fn(|lane| [xi[0][lane], xi[1][lane]]);
        LightSample8::from(match self {
            Self::Map(map) => map
                .sample8(pairs.map(|xi| xi.map(f64::from)))
                .each_ref()
                .map(towards),
            Self::Black | Self::White => pairs.map(|xi| self.sample(xi)),
        })
    }

    /// Radiance along a ray that meets nothing, and the density of its direction.
    #[must_use]
    pub fn see(&self, direction: Vec3) -> Seen {
        match self {
            Self::Black => Seen {
                radiance: Vec3::ZERO,
                pdf: 0.0,
            },
            Self::White => Seen {
                radiance: Vec3::ONE,
                pdf: 0.25 / PI,
            },
            Self::Map(map) => {
                let direction = direction.as_dvec3();
                let radiance = Vec3::from_array(map.radiance(direction).map(rounded));
                Seen {
                    radiance,
                    pdf: rounded(map.pdf(direction)),
                }
            }
        }
    }

    /// Looks along eight rays.
    #[must_use]
    pub fn see8(&self, directions: &Vec3x8) -> Seen8 {
        let Self::Map(map) = self else {
            let seen = self.see(Vec3::Y);
            return Seen8 {
                radiance: seen.radiance.to_array().map(f32x8::splat),
                pdf: f32x8::splat(seen.pdf),
            };
        };
        map.see8(directions)
    }
}

/// A direction of a map, in single precision.
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

/// A direction uniform on the sphere; the first number is along x.
#[inline]
#[must_use]
pub fn uniform_direction([xi_x, xi_phi]: [f32; 2]) -> Vec3 {
    let x = 1.0 - 2.0 * xi_x;
    let across = (4.0 * xi_x * (1.0 - xi_x)).max(0.0).sqrt();
    let (sin, cos) = (TAU * xi_phi).sin_cos();
    Vec3::new(x, across * cos, across * sin)
}
