//! Estimates of the albedo at a shading point, by which a model with further lobes chooses between them and these.

use super::{HairView, PublishedPrepared};
use crate::model::lobe::times;
use crate::simd::{Broadcast, Lanes, lanes3, lanes4};

/// Root of `2 pi`: the area of a Gaussian per deviation.
const ROOT_TWO_PI: f32 = 2.506_628_3;
/// Largest channel of a colour that counts, so that no product overflows.
const MOST: f32 = 1e30;

/// Returns the mean of a colour's channels.
#[inline(always)]
fn mean<L: Lanes>([r, g, b]: [L; 3]) -> L {
    let most = L::splat(MOST);
    (r.min(most) + g.min(most) + b.min(most)) * (1.0 / 3.0)
}

/// Sums the lobes of these extents, each times the mean of its colour.
#[inline(always)]
pub(super) fn sum<L: Lanes, C: Broadcast<L>>(view: &HairView<C>, extent: [L; 4]) -> L {
    L::stage("estimate of the albedo, in the mean of the channels");
    let hair = &view.lobes;
    let trt = mean(lanes3(&hair.color_trt));
    let color = [
        mean(lanes3(&hair.color_r)),
        mean(lanes3(&hair.color_tt)),
        trt,
        trt,
    ];
    let [r, tt, trt, glint] = times(times(color, lanes4(&hair.strength)), extent);
    (r + tt) + (trt + glint)
}

/// Estimates the albedo by the energies of section 3.2.3 of the paper, which integrate Gaussians over the whole line. `theta_i` moves by
/// twice as much as `theta_h`.
#[inline(always)]
pub(super) fn published<L: Lanes, C: Broadcast<L>>(prepared: &PublishedPrepared<C>) -> L {
    let hair = &prepared.view.lobes;
    let along = times(lanes4(&hair.beta), [L::splat(2.0 * ROOT_TWO_PI); 4]);
    let (cosine, two_deviations) = (L::splat(4.0), L::splat(2.0 * ROOT_TWO_PI));
    let tt = hair.half_gamma[0].lanes() * two_deviations;
    let glint = hair.half_gamma[1].lanes() * two_deviations;
    sum(
        &prepared.view,
        times(along, [cosine, tt, cosine, glint + glint]),
    )
}
