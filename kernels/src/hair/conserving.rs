//! Energy conservation of the published model: each channel is divided by its albedo where the albedo is above 1.
//!
//! The albedo of a material depends on the inclination of `wo` alone. [`AlbedoFit`] holds the resulting factor on the colours as
//! polynomials; where these are not accurate enough, every shading point integrates the lobes.

mod fit;

use super::albedo::channels;
use super::view::{HairLobes, HairView};
use crate::model::Bell;
use crate::simd::storage::{ENTRIES, NUMBERS};
use crate::simd::table::Table;
use crate::simd::{Broadcast, Choice, Lanes, Scalar, f32x8, lanes3, store3};

/// Number of pieces on each side of the normal plane; the table has entries for both sides.
const PIECES: usize = ENTRIES / 2;
/// Number of coefficients of a piece in each channel.
const POWERS: usize = NUMBERS / 3;
// The formulas of `fitted` rely on these numbers.
const _: () = assert!(
    PIECES == 4 && POWERS == 5 && NUMBERS == 15,
    "the pieces fill a table"
);

/// Fit of `1 / albedo - 1` of each channel as a function of the inclination of `wo`: on each side of the normal plane, the lower
/// side first, four polynomials of degree 4 in a warped inclination.
///
/// With `x = sqrt(cos / (1 + |sin|))` of the inclination the pieces have equal lengths in `v = (1 + near) x / (x + near)`. Next to a
/// pole the albedo is `A + B log x` of smooth `A` and `B`, the latter of order `x^2`: the root makes the logarithm harmless, and
/// `near` is the scale of narrow lobes. Where the albedo is below 1 the polynomials continue smoothly above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlbedoFit<C: Scalar> {
    pub(in crate::hair) warp: Warp<C>,
    /// Coefficients of each piece for the three channels, from the highest power down.
    pieces: Table<C>,
}

crate::simd::lane_struct! {
    @impl {C: Scalar} C, AlbedoFit {C} {f32} {f32x8}
    warp: Warp<C>, pieces: Table<C>
}

crate::simd::lane_struct! {
    /// Constants of a fit besides its polynomials.
    pub(in crate::hair) struct Warp {
        /// Scale of the warp on either side of the normal plane.
        pub(in crate::hair) near: [C; 2],
        /// 1 where the polynomials are not accurate enough, else 0. The polynomials are then all 0, which changes no colour.
        pub(in crate::hair) refused: C,
    }
}

/// Returns the view terms with each channel of the lobes divided by its albedo where the albedo is above 1, from the fit.
#[inline(always)]
pub(super) fn fitted<L: Lanes, C: Broadcast<L>>(
    fit: &AlbedoFit<C>,
    view: &HairView<L::Stored>,
) -> HairView<L::Stored> {
    let c = L::splat;
    let one = c(1.0);
    let (sin, cos) = (view.half_sin_theta_o.lanes(), view.half_cos_theta_o.lanes());
    let upper = c(0.0).lt(sin);
    let near = L::select(upper, fit.warp.near[1].lanes(), fit.warp.near[0].lanes());
    // `x` is `root / below`. For NaN `min` returns its second operand. The divisor is above 0, because `near` is.
    let below = sin.abs() + 0.5;
    let root = (cos * below).sqrt();
    let reach = near.mul_add(below, root);
    let v = L::quotient(root * (near + 1.0), reach).min(one);
    let piece = L::Index::search(v, [c(0.25), c(0.5), c(0.75)], PIECES - 1);
    let t = v.mul_add(c(8.0), piece.to_number().mul_add(c(-2.0), c(-1.0)));
    // Not a closure, because closures over lanes may become calls, out of functions of target features, where compilers optimise for
    // size.
    macro_rules! four {
        ($four:literal) => {
            C::look_up_four(&fit.pieces.0, piece, upper, $four)
        };
    }
    let [r, g, b, next] = four!(0);
    let mut by = [r, g, b];
    macro_rules! horner {
        ($($channel:literal $coefficient:expr;)*) => { $(
            by[$channel] = by[$channel].mul_add(t, $coefficient);
        )* };
    }
    let [e, f, g, h] = four!(1);
    horner! { 0 next; 1 e; 2 f; 0 g; 1 h; }
    let [i, j, k, l] = four!(2);
    horner! { 2 i; 0 j; 1 k; 2 l; }
    let [m, n, o, _] = four!(3);
    horner! { 0 m; 1 n; 2 o; }
    let by = [by[0].min(c(0.0)), by[1].min(c(0.0)), by[2].min(c(0.0))];
    // Either sum loses digits next to -1, where no fit exists: see `LEAST`.
    if L::fuses() {
        return scaled::<L, true>(view, by);
    }
    let by = L::together([by[0] + 1.0, by[1] + 1.0, by[2] + 1.0]);
    scaled::<L, false>(view, by)
}

/// Returns the view terms with each channel of the lobes divided by its albedo where the albedo is above 1, to within 2e-4, in the
/// lanes of the mask.
#[inline(always)]
pub(super) fn integrated<B: Bell, L: Lanes>(
    view: &HairView<L::Stored>,
    lanes: L::Mask,
) -> HairView<L::Stored> {
    let (one, most) = (L::splat(1.0), L::splat(f32::MAX));
    let mut by = channels::<B, L>(view);
    let mut channel = 0;
    while channel < 3 {
        // `max` returns its second operand for NaN, which is the albedo towards a wo that is no direction.
        let albedo = L::keep(lanes, by[channel].min(most)).max(one);
        by[channel] = L::quotient(one, albedo);
        channel += 1;
    }
    scaled::<L, false>(view, by)
}

/// Returns the view terms with each colour multiplied by the number of its channel, or with `ADD` by 1 plus that number.
#[inline(always)]
fn scaled<L: Lanes, const ADD: bool>(
    view: &HairView<L::Stored>,
    by: [L; 3],
) -> HairView<L::Stored> {
    let hair = &view.lobes;
    let mut colors = [
        lanes3(&hair.color_r),
        lanes3(&hair.color_tt),
        lanes3(&hair.color_trt),
    ];
    let mut channel = 0;
    while channel < 3 {
        let mut lobe = 0;
        while lobe < 3 {
            let color = colors[lobe][channel];
            colors[lobe][channel] = if ADD {
                color.mul_add(by[channel], color)
            } else {
                color * by[channel]
            };
            lobe += 1;
        }
        channel += 1;
    }
    let [r, tt, trt] = colors;
    let lobes = HairLobes {
        color_r: store3(r),
        color_tt: store3(tt),
        color_trt: store3(trt),
        ..*hair
    };
    HairView { lobes, ..*view }
}
