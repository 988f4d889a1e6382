//! Lambertian cylinder in the far field, which two models have: its value, and directions with its density.
//!
//! A cylinder whose surface reflects evenly, with an albedo of 1, is seen from `wo` and lit from `wi`. A normal at the azimuth `x` receives
//! `cos theta_i cos(x - phi_i)` and covers `cos(x - phi_o) dx / 2` of the width. The mean over the width is
//! `S = (sin |phi| + (pi - |phi|) cos phi) / (4 pi)`, with `phi` the azimuth from `wo` to `wi` in `[-pi, pi]`, and `S cos theta_i` integrates to
//! 1: over the inclinations to `pi / 2`, and over the azimuths to `2 / pi`. As a density it belongs to a normal that is drawn from the width
//! and a direction that is drawn about the normal by its cosine.

use core::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI};
use hairis::model::Direction;
use hairis::model::math::{FRAC_PI_2_LOW, atan_unit, polynomial, sin_cos_half_turn};
use hairis::simd::{Lanes, Vec3x};

/// Least value. Levels round differently, and without a least value the lobe might be 0 on one and not on another.
const LEAST: f32 = 1e-30;
/// Coefficients in powers of the square of `x` of `(sin x - x cos x) / x^3`.
const CYLINDER: [f32; 9] = [
    0.333_333_333,
    -0.033_333_333_3,
    1.190_476_19e-3,
    -2.204_585_54e-5,
    2.505_210_84e-7,
    -1.927_085_26e-9,
    1.070_602_92e-11,
    -4.498_331_6e-14,
    1.479_714_3e-16,
];

/// Returns the part of `wo` in the normal plane with the digits it was given, v and w and its length, and the reciprocal of the length.
/// `unit` is `wo` at unit length.
#[inline(always)]
pub(crate) fn plane<L: Lanes>(wo: Vec3x<L>, unit: Vec3x<L>) -> ([L; 3], L) {
    let c = L::splat;
    let one = c(1.0);
    // The digits of a `wo` of about unit length are kept as they are. On the axis the azimuth is 0.
    let largest = wo.x.abs().max(wo.z.abs().max(wo.y.abs()));
    let usual = L::and(c(0.25).lt(largest), largest.lt(c(4.0)));
    let (y, z) = (
        L::select_predictable(usual, wo.y, unit.y),
        L::select_predictable(usual, wo.z, unit.z),
    );
    let plane = y.mul_add(y, z * z).sqrt();
    let off_axis = c(1e-18).lt(plane);
    let plane_o = [
        L::select_predictable(off_axis, y, one),
        L::keep(off_axis, z),
        L::select_predictable(off_axis, plane, one),
    ];
    (plane_o, L::quotient(one, plane_o[2]))
}

/// Azimuth between two directions, from 0 to pi.
#[derive(Clone, Copy)]
pub(crate) struct Azimuth<L> {
    /// Cosine and sine of half the azimuth.
    pub(crate) half: [L; 2],
    /// The azimuth.
    pub(crate) phi: L,
    /// Difference of the azimuth from half a turn.
    pub(crate) lacking: L,
}

impl<L: Lanes> Azimuth<L> {
    /// Computes the azimuth from the part of `wo` in the normal plane and its length to `wi`.
    #[inline(always)]
    pub(crate) fn between([v_o, w_o, cos_o]: [L; 3], wi: &Direction<L>) -> Self {
        let (zero, one, least) = (L::splat(0.0), L::splat(1.0), L::splat(LEAST));
        L::stage("half the azimuth: its tangent, or the inverse of that, whichever is smaller");
        // Some lobes vanish with the cosine of half the azimuth, or at a sine near it: both take the digits of `wo` and of `wi` as they are,
        // and no sum that cancels.
        let dot = wi.vector.y.mul_add(v_o, wi.vector.z * w_o);
        let cross = L::difference_of_products(wi.vector.z, v_o, wi.vector.y, w_o).abs();
        let reach = (wi.cos_theta * cos_o).max(least);
        let far = reach + dot.abs();
        // A minimum is not NaN either, where `wi` is no direction.
        let tangent = L::quotient(cross, far).min(one);
        let larger = L::quotient(far, reach + reach).sqrt().min(one);
        let smaller = tangent * larger;
        let is_front = zero.lt(dot);
        let half = [
            L::select(is_front, larger, smaller),
            L::select(is_front, smaller, larger),
        ];
        let near = atan_unit(tangent);
        let rest = L::splat(FRAC_PI_2) - (near - FRAC_PI_2_LOW);
        Self {
            half,
            phi: L::select(is_front, near, rest) * 2.0,
            lacking: L::select(is_front, rest, near) * 2.0,
        }
    }
}

/// Evaluates S of the cylinder at an azimuth that lacks `lacking` of half a turn. The density is S times `cos theta_i`.
#[inline(always)]
pub(crate) fn value<L: Lanes>(lacking: L) -> L {
    let square = lacking * lacking;
    let cylinder = square * lacking * polynomial(square, CYLINDER) * (0.25 * FRAC_1_PI);
    cylinder.max(L::splat(LEAST))
}

/// Draws sine and cosine of `theta_i`, and of the azimuth from `wo`, by three uniform numbers.
#[inline(always)]
pub(crate) fn draw<L: Lanes>(xi: [L; 3]) -> ([L; 2], [L; 2]) {
    let (zero, one, two) = (L::splat(0.0), L::splat(1.0), L::splat(2.0));
    L::stage("diffuse lobe: a normal that is seen, and a direction about it by its cosine");
    let sin_normal = xi[0].mul_sub(two, one);
    let cos_normal = zero.max((one - sin_normal) * (one + sin_normal)).sqrt();
    let (radius, height) = (xi[1].sqrt(), (one - xi[1]).sqrt());
    let (sin, cos) = sin_cos_half_turn((xi[2] - 0.5) * PI);
    let (sin_turn, cos_turn) = ((sin + sin) * cos, (cos - sin) * (cos + sin));
    let (across, sin_d) = (radius * cos_turn, radius * sin_turn);
    let cos_d = across.mul_add(across, height * height).sqrt();
    let inv_cos_d = L::quotient(one, cos_d);
    let sin_phi_d = sin_normal.mul_add(height, cos_normal * across) * inv_cos_d;
    let cos_phi_d = cos_normal.mul_sub(height, sin_normal * across) * inv_cos_d;
    ([sin_d, cos_d], [sin_phi_d, cos_phi_d])
}

/// Makes the direction of an inclination and an azimuth from `wo`, each given as sine and cosine of about unit length. `plane_o` and
/// `inv_plane` are those of [`plane`].
#[inline(always)]
pub(crate) fn direction<L: Lanes>(
    plane_o: [L; 2],
    inv_plane: L,
    theta: [L; 2],
    [sin_x, cos_x]: [L; 2],
) -> Direction<L> {
    L::stage("direction");
    let (v, w) = (plane_o[0] * inv_plane, plane_o[1] * inv_plane);
    let phi = [v.mul_add(sin_x, w * cos_x), v.mul_sub(cos_x, w * sin_x)];
    Direction::from_sin_cos(unit(theta), unit(phi))
}

/// Returns sine and cosine of about unit length at unit length: the narrowest lobes change with the roundings of a few steps.
#[inline(always)]
fn unit<L: Lanes>([sin, cos]: [L; 2]) -> [L; 2] {
    let off = (L::splat(1.0) - cos.mul_add(cos, sin * sin)) * 0.5;
    [sin.mul_add(off, sin), cos.mul_add(off, cos)]
}
