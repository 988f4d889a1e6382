//! Sampling of a direction of one lobe by three uniform numbers.

use super::ChiangPrepared;
use crate::cone;
use core::f32::consts::PI;
use hairis::model::Direction;
use hairis::model::math::{log2, log2_one_plus, sin_cos_half_turn};
use hairis::simd::{Broadcast, Choice, Lanes};

/// Draws a direction of a lobe: the angle from its cone, the turn about the cone, and the azimuth.
#[inline(always)]
pub(super) fn sample<L: Lanes, C: Broadcast<L>>(
    prepared: &ChiangPrepared<C>,
    lobe: L::Index,
    xi: [L; 3],
) -> Direction<L> {
    let c = L::splat;
    let (zero, one, two) = (c(0.0), c(1.0), c(2.0));
    let m = &prepared.widths;

    L::stage("inclination: a point about the lobe's cone");
    // After d'Eon 2013: 1 less the cosine of the angle from the cone. The cosine of the turn is even.
    let cut = C::look_up_three(&m.cut, lobe);
    let by = C::look_up_three(&m.minus_v_ln_2, lobe);
    let drop = zero.max((log2_one_plus(-(xi[1] * cut)) * by).min(two));
    let around = cone::about(drop, xi[2]);
    let cone = [
        C::look_up(&prepared.sin_cone, lobe),
        C::look_up(&prepared.cos_cone, lobe),
    ];
    let theta_i = cone::inclination(drop, around, cone);

    L::stage("azimuth: the trimmed logistic by inversion");
    // The trimmed logistic by inversion; the azimuth of the rest is uniform.
    // A branch costs less than two tables that all lanes share, unless a level has an instruction for them as levels that fuse do.
    let has_branch = L::FUSES == Some(false) && size_of::<C>() == size_of::<f32>();
    let (kept, scale) = if !has_branch || C::any_below_0(&m.differ) {
        (
            C::look_up_three(&m.kept, lobe),
            C::look_up_three(&m.scale_ln_2, lobe),
        )
    } else {
        (m.kept[0].lanes(), m.scale_ln_2[0].lanes())
    };
    let edge = (one - kept) * 0.5;
    let ratio = L::quotient(xi[0].mul_add(kept, edge), (one - xi[0]).mul_add(kept, edge));
    let logistic = log2(ratio) * scale;
    let uniform = (xi[0] - 0.5) * PI;
    let half_turn = c(0.5 * PI);
    let half = L::select(lobe.equals(3), uniform, logistic)
        .min(half_turn)
        .max(-half_turn);
    L::stage("direction");
    let (sin, cos) = sin_cos_half_turn(half);
    let (sin_x, cos_x) = ((sin + sin) * cos, cos.mul_sub(cos, sin * sin));
    let (v, w) = (
        C::look_up(&prepared.azimuth_v, lobe),
        C::look_up(&prepared.azimuth_w, lobe),
    );
    let phi = [v.mul_add(sin_x, w * cos_x), v.mul_sub(cos_x, w * sin_x)];
    Direction::from_sin_cos(theta_i, phi)
}
