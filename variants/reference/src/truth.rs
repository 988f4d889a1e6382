//! The truth under the models: light traced through a rough, tilted, elliptic dielectric cylinder, in double precision.
//!
//! [`Fiber::trace`] follows one path from the viewer through the fibre, and a [`Histogram`] collects paths into the light by direction and
//! by lobe, with standard errors. Nothing is fitted or cut: a clear fibre returns all light to rounding.
//!
//! - Geometry: an endless straight cylinder, whose section is an ellipse of area pi. The offset is uniform over the projected width, which
//!   makes the far field. Lengths are in units of the mean radius.
//! - Scales: facets tilted by [`tilt`](Fiber::tilt), and between them risers across the axis, as the two facets of Schüssler et al. 2017.
//!   Both are the same surface seen from inside. A ray that a facet shadows hits the other facet.
//! - Roughness: the random walk of Heitz et al. 2016 over the Smith microsurface of GGX, of any number of bounces, with the visible normals
//!   of Dupuy and Benyoub 2023. Light therefore is neither lost nor gained at any roughness.
//! - Interior: absorption along each path, and a concentric medulla of the same refractive index that absorbs and scatters (Henyey and
//!   Greenstein 1941).
//! - Left out: polarisation, interference, diffraction and the layers of the cuticle.
//!
//! The scattering is reciprocal: `D_o cos theta_o p(wi | wo)` is symmetric, with `p` the density of paths and `D` the projected width. Tests
//! compare the smooth circular cylinder with closed forms, R of a rough one with its integral, and the medulla with quadrature.
//!
//! ```
//! use hairis_reference::truth::{Fiber, Histogram, Lobe};
//! let mut xi = (1..).map(|n| (0.618_033_988_749_895 * f64::from(n)).fract()); // a random source in earnest
//! let mut light = Histogram::new([18, 36]);
//! let mut path = || Fiber::default().trace([0.0, 1.0, 0.0], &mut || xi.next().unwrap_or(0.0));
//! for _batch in 0..2 {
//!     light.add(100, &mut path);
//! }
//! let [mean, _error] = light.estimate(0, |_, lobe| f64::from(lobe == Lobe::Tt));
//! assert!(mean > 0.1 && mean < 1.0);
//! ```

mod histogram;
mod surface;
mod vector;

pub use histogram::Histogram;
pub use surface::Surface;

use core::f64::consts::{PI, TAU};
use vector::{Vector, along, around, dot};

/// Legs within the fibre after which a path is given up.
const LEGS: u32 = 100_000;
/// Largest weight below which a path survives by chance.
const FAINT: f64 = 1e-3;

/// Fibre that light is traced through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fiber {
    /// Index of refraction, above 0; 1 leaves the medulla alone.
    pub eta: f64,
    /// Width `alpha` of GGX, 0 or above; 0 is smooth.
    pub roughness: f64,
    /// Inclination of the scales' normals to the normal plane, towards `-u` if positive, rad, within (-pi/2, pi/2). The first reflection
    /// is centred at `theta_i + theta_o = -2 tilt`.
    pub tilt: f64,
    /// Minor axis of the section over its major axis, (0, 1].
    pub aspect: f64,
    /// Azimuth of the major axis, rad. `None` draws one per path, as in hair that is twisted, by the light that it meets.
    pub rotation: Option<f64>,
    /// Absorption of the cortex, linear RGB, per mean radius.
    pub sigma_a: [f64; 3],
    /// Medulla, of which the ratio 0 leaves nothing.
    pub medulla: Medulla,
}

/// Scattering core of a fibre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Medulla {
    /// Size of the medulla relative to the fibre, [0, 1].
    pub ratio: f64,
    /// Absorption, linear RGB, per mean radius of the fibre.
    pub sigma_a: [f64; 3],
    /// Scattering, per mean radius of the fibre.
    pub sigma_s: f64,
    /// Mean cosine of the angle of scattering, (-1, 1).
    pub g: f64,
}

/// Part of the light, by its path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lobe {
    /// Light that was reflected at the outside.
    R,
    /// Light after one passage through the fibre.
    Tt,
    /// Light after two passages.
    Trt,
    /// Light after three passages and more.
    Rest,
    /// Light that was scattered in the medulla, after any number of passages.
    Scattered,
}

impl Lobe {
    /// Number of parts.
    pub const COUNT: usize = 5;
    /// Parts in the order of their numbers.
    pub const ALL: [Self; Self::COUNT] =
        [Self::R, Self::Tt, Self::Trt, Self::Rest, Self::Scattered];
}

/// End of a path outside the fibre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exit {
    /// Direction towards the light, unit.
    pub wi: [f64; 3],
    /// Part that the path belongs to.
    pub lobe: Lobe,
    /// Share of the light that is left, linear RGB: its mean over the paths is the albedo.
    pub weight: [f64; 3],
}

impl Default for Fiber {
    /// Returns a smooth, clear, circular fibre without a tilt, of the index 1.55.
    fn default() -> Self {
        Self {
            eta: 1.55,
            roughness: 0.0,
            tilt: 0.0,
            aspect: 1.0,
            rotation: None,
            sigma_a: [0.0; 3],
            medulla: Medulla::default(),
        }
    }
}

/// Ellipse `x^2 / a^2 + y^2 / b^2 = 1` in the normal plane, as the matrix of its form: those of `v^2`, `v w` and `w^2`.
#[derive(Clone, Copy, Debug)]
struct Ellipse([f64; 3]);

impl Ellipse {
    fn new(aspect: f64, rotation: f64) -> Self {
        let (sin, cos) = rotation.sin_cos();
        let mixed = (aspect - 1.0 / aspect) * sin * cos;
        Self([
            aspect * cos * cos + sin * sin / aspect,
            mixed,
            aspect * sin * sin + cos * cos / aspect,
        ])
    }

    fn form(&self, p: &Vector, q: &Vector) -> f64 {
        let [vv, vw, ww] = self.0;
        vv * p[1] * q[1] + vw * (p[1] * q[2] + p[2] * q[1]) + ww * p[2] * q[2]
    }

    fn normal(&self, p: &Vector) -> Vector {
        let [vv, vw, ww] = self.0;
        let [v, w] = [vv * p[1] + vw * p[2], vw * p[1] + ww * p[2]];
        let length = v.hypot(w);
        [0.0, v / length, w / length]
    }

    /// Returns where a ray enters and leaves the ellipse that is `ratio` times as large, as distances; `None` if it misses.
    fn crossing(&self, p: &Vector, ray: &Vector, ratio: f64) -> Option<[f64; 2]> {
        let square = self.form(ray, ray);
        let half = self.form(p, ray);
        let root = half * half - square * (self.form(p, p) - ratio * ratio);
        (root > 0.0 && square > 0.0)
            .then(|| [-half - root.sqrt(), -half + root.sqrt()].map(|x| x / square))
    }
}

impl Fiber {
    /// Returns the projected width of the section, seen at an azimuth from the major axis, over that of a circle of the same area.
    #[must_use]
    pub fn width(&self, from_major: f64) -> f64 {
        let (sin, cos) = from_major.sin_cos();
        (sin * sin / self.aspect + cos * cos * self.aspect).sqrt()
    }

    /// Follows a path from the viewer at `wo`, a unit vector off the axis, by uniform numbers in `[0, 1)`. The mean of `weight` over the paths
    /// into a solid angle is the integral of `S cos theta_i` over the solid angle.
    ///
    /// Returns `None` if the path ends inside: by chance after absorption, or after 100,000 passages.
    #[must_use]
    pub fn trace(&self, wo: [f64; 3], xi: &mut dyn FnMut() -> f64) -> Option<Exit> {
        let azimuth = wo[2].atan2(wo[1]);
        let (sin, cos) = azimuth.sin_cos();
        // A rotation is drawn with the light that it meets.
        let (rotation, offset) = loop {
            let rotation = self.rotation.unwrap_or_else(|| PI * xi());
            let width = self.width(azimuth - rotation);
            let most = self.rotation.map_or(self.aspect.sqrt().recip(), |_| width);
            let offset = (2.0 * xi() - 1.0) * most;
            if offset.abs() <= width {
                break (rotation, offset);
            }
        };
        let ellipse = Ellipse::new(self.aspect, rotation);
        let surface = Surface::new(self.eta, self.roughness, self.tilt);
        let start = [0.0, -offset * sin, offset * cos];
        let mut ray = wo.map(|x| -x);
        let [enter, _] = ellipse.crossing(&start, &ray, 1.0)?;
        let mut p = along(&start, &ray, enter);
        let (mut weight, mut scattered, mut legs) = ([1.0; 3], false, 0);
        let mut outside;
        (ray, outside) = surface.cross(&ellipse.normal(&p), &ray, true, xi);
        while !outside {
            legs += 1;
            loop {
                let [_, leave] = ellipse.crossing(&p, &ray, 1.0)?;
                let [from, to] = (self.medulla.ratio > 0.0)
                    .then(|| ellipse.crossing(&p, &ray, self.medulla.ratio))
                    .flatten()
                    .map_or([0.0; 2], |ends| ends.map(|x| x.clamp(0.0, leave)));
                let free = if self.medulla.sigma_s > 0.0 && to > from {
                    -(1.0 - xi()).ln() / self.medulla.sigma_s
                } else {
                    f64::INFINITY
                };
                let is_event = free < to - from;
                let [cortex, medulla] = if is_event {
                    [from, free]
                } else {
                    [leave - (to - from), to - from]
                };
                for (channel, weight) in weight.iter_mut().enumerate() {
                    let depth =
                        self.sigma_a[channel] * cortex + self.medulla.sigma_a[channel] * medulla;
                    *weight *= (-depth).exp();
                }
                p = along(&p, &ray, if is_event { from + free } else { leave });
                if !is_event {
                    break;
                }
                scattered = true;
                ray = henyey_greenstein(self.medulla.g, &ray, [xi(), xi()]);
            }
            let largest = weight.into_iter().fold(0.0, f64::max);
            if legs == LEGS || (largest < FAINT && xi() * FAINT >= largest) {
                return None;
            }
            if largest < FAINT {
                weight = weight.map(|x| x * FAINT / largest);
            }
            (ray, outside) = surface.cross(&ellipse.normal(&p), &ray, false, xi);
        }
        let lobe = match legs {
            _ if scattered => Lobe::Scattered,
            0 => Lobe::R,
            1 => Lobe::Tt,
            2 => Lobe::Trt,
            _ => Lobe::Rest,
        };
        Some(Exit {
            wi: ray,
            lobe,
            weight,
        })
    }
}

/// Draws a direction about `ray`, whose mean cosine is `g`.
fn henyey_greenstein(g: f64, ray: &Vector, xi: [f64; 2]) -> Vector {
    let z = 2.0 * xi[0] - 1.0;
    let cos = if g.abs() < 1e-6 {
        z
    } else {
        let ratio = (1.0 - g * g) / (1.0 + g * z);
        (1.0 + g * g - ratio * ratio) / (2.0 * g)
    };
    let (sin, turn) = ((1.0 - cos * cos).max(0.0).sqrt(), TAU * xi[1]);
    let ray = around(ray, [sin * turn.cos(), sin * turn.sin(), cos]);
    // Many scatterings would add up their rounding.
    let length = dot(&ray, &ray).sqrt();
    ray.map(|x| x / length)
}
