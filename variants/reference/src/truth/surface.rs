//! Surface of the fibre: scales with risers, and their roughness.

use super::vector::{Vector, along, around, dot, frame};
use core::f64::consts::TAU;

/// Rough dielectric surface with scales.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    eta: f64,
    alpha: f64,
    sin_tilt: f64,
    cos_tilt: f64,
}

impl Surface {
    /// Makes the surface of a fibre, of its [`eta`](super::Fiber::eta), [`roughness`](super::Fiber::roughness) and [`tilt`](super::Fiber::tilt).
    #[must_use]
    pub fn new(eta: f64, alpha: f64, tilt: f64) -> Self {
        Self {
            eta,
            alpha,
            sin_tilt: tilt.sin(),
            cos_tilt: tilt.cos(),
        }
    }

    /// Follows a unit `ray` from this side of the surface, whose `normal` without scales lies in the normal plane and points out, until the ray
    /// leaves. Returns its direction and whether it is outside.
    ///
    /// The areas of scale and riser per area of the fibre are `1 / cos tilt` and `tan tilt`, so that their normals, times these, sum to the
    /// normal of the fibre: projected areas balance in every direction, which makes light paths reciprocal (Schüssler et al. 2017). A facet is
    /// met by its projected area. A ray leaves with the share of a facet's projected area that is visible, `normal / (scale + riser)`.
    ///
    /// Without a tilt, `xi` is called four times for each bounce on a microfacet and once more.
    pub fn cross(
        &self,
        normal: &[f64; 3],
        ray: &[f64; 3],
        outside: bool,
        xi: &mut dyn FnMut() -> f64,
    ) -> ([f64; 3], bool) {
        let scale = [
            -self.sin_tilt,
            self.cos_tilt * normal[1],
            self.cos_tilt * normal[2],
        ];
        let riser = [1.0_f64.copysign(self.sin_tilt), 0.0, 0.0];
        let facets = [scale, riser];
        let areas = [1.0 / self.cos_tilt, self.sin_tilt.abs() / self.cos_tilt];
        let projected =
            |w: &Vector, side: f64| [0, 1].map(|k| (areas[k] * side * dot(&facets[k], w)).max(0.0));
        let (mut ray, mut side) = (*ray, if outside { 1.0 } else { -1.0 });
        let [on_scale, on_riser] = projected(&ray, -side);
        let mut facet = usize::from(on_riser > 0.0 && xi() * (on_scale + on_riser) >= on_scale);
        loop {
            let facing = facets[facet].map(|x| side * x);
            let crossed;
            (ray, crossed) = self.walk(&facing, &ray, side > 0.0, xi);
            side = if crossed { -side } else { side };
            let [on_scale, on_riser] = projected(&ray, side);
            let visible = side * dot(normal, &ray);
            let seen = on_scale + on_riser;
            let is_shadowed = visible <= 0.0 || (seen > visible && xi() * seen >= visible);
            if !is_shadowed {
                return (ray, side > 0.0);
            }
            facet = 1 - facet;
        }
    }

    /// Follows a `ray` over a rough facet with the normal `n` on the side of the ray, until the ray leaves. Returns its direction and
    /// whether it has crossed the facet.
    ///
    /// The height of the ray is that of Heitz et al. 2016 as the share `c` of the surface below it, which no distribution of heights
    /// changes. A ray with the cosine `z` leaves upwards with the probability `c^Lambda`, and meets the surface at `c (1 - xi)^(-1 / Lambda)`.
    /// Beyond the surface the ray is turned over, and `c` becomes `1 - c`.
    fn walk(
        &self,
        n: &Vector,
        ray: &Vector,
        outside: bool,
        xi: &mut dyn FnMut() -> f64,
    ) -> (Vector, bool) {
        let [s, t] = frame(n);
        let mut w = [dot(&s, ray), dot(&t, ray), dot(n, ray)];
        let (mut below, mut crossed) = (1.0_f64, false);
        loop {
            let lambda = self.lambda(&w);
            let rest = 1.0 - xi();
            let meets = w[2] < 0.0 || rest > below.powf(lambda);
            if !meets {
                break;
            }
            below *= rest.powf(-1.0 / lambda);
            let back = w.map(|x| -x);
            let m = self.visible_normal(&back, [xi(), xi()]);
            let cos = dot(&back, &m).max(0.0);
            let eta = if outside == crossed {
                1.0 / self.eta
            } else {
                self.eta
            };
            let (reflectance, cos_t) = fresnel(cos, eta);
            if xi() < reflectance {
                w = along(&w, &m, 2.0 * cos);
            } else {
                // Turned over, which is the negative of the refracted ray.
                w = along(&back.map(|x| x / eta), &m, cos_t - cos / eta);
                below = 1.0 - below;
                crossed = !crossed;
            }
        }
        let out = around(n, w);
        let length = dot(&out, &out)
            .sqrt()
            .copysign(if crossed { -1.0 } else { 1.0 });
        (out.map(|x| x / length), crossed)
    }

    /// Evaluates Smith's `Lambda` of GGX, at most -1 for rays that go down.
    fn lambda(&self, w: &Vector) -> f64 {
        let slope = self.alpha * w[0].hypot(w[1]) / w[2];
        0.5 * ((1.0 + slope * slope).sqrt().copysign(w[2]) - 1.0)
    }

    /// Draws a normal as it is seen from `w`, above the surface or below it.
    ///
    /// - Source: Dupuy and Benyoub 2023: on the sphere that GGX is a stretch of, reflected rays are uniform in a cap.
    fn visible_normal(&self, w: &Vector, xi: [f64; 2]) -> Vector {
        let normalised = |[x, y, z]: Vector| {
            let length = (x * x + y * y + z * z).sqrt();
            [x / length, y / length, z / length]
        };
        let from = normalised([self.alpha * w[0], self.alpha * w[1], w[2]]);
        let z = (1.0 - xi[0]) * (1.0 + from[2]) - from[2];
        let (sin, turn) = ((1.0 - z * z).max(0.0).sqrt(), TAU * xi[1]);
        let [x, y] = [sin * turn.cos() + from[0], sin * turn.sin() + from[1]];
        normalised([self.alpha * x, self.alpha * y, z + from[2]])
    }
}

/// Evaluates the reflectance of unpolarised light that meets a medium `eta` times as dense at the cosine `cos`, and the cosine within.
fn fresnel(cos: f64, eta: f64) -> (f64, f64) {
    let square = 1.0 - (1.0 - cos * cos) / (eta * eta);
    if square <= 0.0 {
        return (1.0, 0.0);
    }
    let cos_t = square.sqrt();
    let s = (cos - eta * cos_t) / (cos + eta * cos_t);
    let p = (eta * cos - cos_t) / (eta * cos + cos_t);
    (0.5 * (s * s + p * p), cos_t)
}
