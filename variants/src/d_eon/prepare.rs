//! Constants of d'Eon's far field, which are computed once per material and once per hit.

use super::DEonDesc;
use super::trt::{DEonGaussians, gaussians};
use crate::cylinder;
use core::f32::consts::LN_2;
use hairis::model::math::{gaussian, gaussian_and_complement, half_atan2, horner, polynomial};
use hairis::model::{Direction, Precision};
use hairis::simd::{Broadcast, Lanes, Vec3x, lane_struct, lanes3, store3, store4};

lane_struct! {
    /// Constants of a material of d'Eon's far field.
    pub struct DEonMaterial {
        /// Variance of R in front of the fibre: `2 r^2`.
        variance_r: C,
        /// Variance of TT in the normal plane: `r^2 (eta^2 - 1) / 4`.
        variance_tt: C,
        /// Roughness r.
        roughness: C,
        /// Widths of the Gaussians of TRT, in those of the fit.
        width: C,
        /// Index of refraction, the square less 1, and the root of that.
        eta: [C; 3],
        /// Reflectance at the normal, and its complement to 1.
        reflectance: [C; 2],
        /// Sine of the shift of R, TT and TRT.
        sin_shift: [C; 3],
        /// Cosine of each shift.
        cos_shift: [C; 3],
        /// Absorption per radius, linear RGB, times four: of a diameter, and doubled to be the argument of a Gaussian.
        four_sigma_a: [C; 3],
        /// Share of R, TT and TRT.
        kept: C,
        /// Colour of the diffuse lobe times its share.
        diffuse: [C; 3],
    }
}

lane_struct! {
    /// Constants of a shading point of d'Eon's far field. Arrays of four hold R, TT, TRT and TRT again.
    pub struct DEonPrepared {
        /// Part of `wo` in the normal plane, with the digits it was given: v and w, and its length.
        pub(super) plane_o: [C; 3],
        /// Reciprocal of that length.
        pub(super) inv_plane_o: C,
        /// Cosine of `theta_o`.
        pub(super) cos_theta_o: C,
        /// Inverse of the projected index.
        pub(super) q: C,
        /// `1 - q`.
        pub(super) less: C,
        /// Reflectance at the normal, and its complement to 1.
        pub(super) normal: [C; 2],
        /// Mean reflectance over the width of the fibre.
        pub(super) reflectance: C,
        /// Share of uniform offsets among those of R.
        pub(super) uniform: C,
        /// Share of R, TT and TRT.
        pub(super) kept: C,
        /// Sine of each lobe's cone, `theta' = theta_o - shift`.
        pub(super) sin_cone: [C; 4],
        /// Cosine of each lobe's cone.
        pub(super) cos_cone: [C; 4],
        /// Inverse of the variance v of M, of R in front of the fibre.
        pub(super) inv_variance: [C; 4],
        /// Factor of the Bessel function's argument: `cos theta' / v`.
        pub(super) concentration: [C; 4],
        /// Inverse root of that factor.
        pub(super) spread: [C; 4],
        /// Norm of M, `1 / (v cut)`, except that of R.
        pub(super) norm: [C; 4],
        /// Factor of the longitudinal sampler: `-v ln 2`.
        pub(super) minus_v_ln_2: [C; 4],
        /// Range of the longitudinal sampler, `1 - exp(-2 / v)`, except that of R.
        pub(super) cut: [C; 4],
        /// Depth of a diameter, linear RGB, doubled to be the argument of a Gaussian.
        pub(super) twice_depth: [C; 3],
        /// Attenuation of TRT, linear RGB.
        pub(super) attenuation_trt: [C; 3],
        /// Albedo of the diffuse lobe, linear RGB.
        pub(super) diffuse: [C; 3],
        /// Share of each lobe among the samples, to a common scale.
        pub(super) weights: [C; 4],
        /// Gaussians of TRT.
        pub(super) gaussians: DEonGaussians<C>,
    }
}

/// Least `cos theta_o` in the width of TT.
const LEAST_COSINE: f32 = 1e-3;
/// Cosine of `theta_o` below which means over the width are series in the cosine.
const GRAZING: f32 = 0.15;

/// Coefficients in powers of `1 - k` of the mean over the width of `(1 - k cos gamma)^5`, which is the integral of
/// `(1 - k cos gamma)^5 cos gamma` over a right angle.
const FIFTH: [f32; 6] = [
    0.024_982_438_7,
    0.052_818_754_0,
    0.086_469_469_0,
    0.132_558_080_0,
    0.212_297_406_0,
    0.490_873_852_1,
];
/// Coefficients of the mean of the tenth power, without the first.
const TENTH: [f32; 10] = [
    0.015_707_026_9,
    0.024_184_146_0,
    0.033_397_460_9,
    0.043_717_577_3,
    0.055_725_345_7,
    0.070_423_085_4,
    0.089_772_935_2,
    0.118_406_639_8,
    0.171_547_891_4,
    0.369_408_369_4,
];
/// First coefficient of the mean of the tenth power.
const TENTH_FIRST: f32 = 0.007_709_521_85;
/// Coefficients in powers of `k` of the complement to 1 of the mean of the fifth power, over `k`.
const FIFTH_GRAZING: [f32; 5] = [
    3.926_990_817,
    -6.666_666_667,
    5.890_486_225,
    -2.666_666_667,
    0.490_873_852,
];
/// Coefficients in powers of `k` of the mean of `(1 - (1 - k cos gamma)^5)^2`, over the square of `k`.
const PASSED_GRAZING: [f32; 9] = [
    16.666_666_67,
    -58.904_862_25,
    106.666_666_7,
    -122.718_463_0,
    96.0,
    -51.541_754_47,
    18.285_714_29,
    -3.865_631_586,
    0.369_408_369,
];

impl<L: Lanes<Stored = L>> DEonMaterial<L> {
    /// Computes the constants of a description, whose values lie in the ranges of checked parameters.
    #[inline]
    #[must_use]
    pub(super) fn new<W: Precision<Lane = L>>(fiber: &DEonDesc<L>) -> Self {
        let (c, one) = (W::constant, W::constant(1.0));
        L::stage("widths, reflectance at the normal, and shifts of the lobes");
        let (r, eta) = (W::of(fiber.roughness), W::of(fiber.eta));
        let square = r * r;
        let contrast = (eta - one) * (eta + one);
        let root = (eta - one) / (eta + one);
        let normal = root * root;
        let shift = [-2.0, 1.0, 3.0].map(|tilts| (c(tilts) * W::of(fiber.tilt)).sin_cos());
        Self {
            variance_r: (c(2.0) * square).rounded(),
            variance_tt: (c(0.25) * square * contrast).rounded(),
            roughness: fiber.roughness,
            width: (r / c(0.06)).rounded(),
            eta: [fiber.eta, contrast.rounded(), contrast.rounded().sqrt()],
            reflectance: [normal.rounded(), (one - normal).rounded()],
            sin_shift: shift.map(|[sin, _]| sin.rounded()),
            cos_shift: shift.map(|[_, cos]| cos.rounded()),
            four_sigma_a: fiber
                .sigma_a
                .map(|sigma| (sigma * 4.0).min(L::splat(f32::MAX))),
            kept: L::splat(1.0) - fiber.diffuse,
            diffuse: fiber.diffuse_color.map(|color| fiber.diffuse * color),
        }
    }
}

/// Returns the mean of three channels.
#[inline(always)]
fn mean<L: Lanes>([r, g, b]: [L; 3]) -> L {
    (r + g + b) * (1.0 / 3.0)
}

/// Means over the width of the fibre at `k = cos theta_o`, with `e = 1 - k`: of Schlick's reflectance F, of `(1 - F)^2` and of `F (1 - F)`.
///
/// Where `k` is small, so are the last two, and differences of the others would lose their digits.
#[inline(always)]
fn means<L: Lanes>(k: L, e: L, [f0, rest]: [L; 2]) -> [L; 3] {
    let (one, grazing) = (L::splat(1.0), k.lt(L::splat(GRAZING)));
    let fifth = polynomial(e, FIFTH);
    let tenth = polynomial(e, TENTH).mul_add(e, L::splat(TENTH_FIRST));
    let reflectance = rest.mul_add(fifth, f0);
    let passed = L::select(
        grazing,
        polynomial(k, PASSED_GRAZING) * k * k,
        one - fifth - fifth + tenth,
    );
    let once = horner(k, FIFTH_GRAZING) * k;
    let both = L::select(
        grazing,
        rest * (once - rest * passed),
        rest * ((one - f0 - f0).mul_add(fifth, f0) - rest * tenth),
    );
    [reflectance, rest * rest * passed, both]
}

/// Stores the numbers of three lobes as a table of four.
#[inline(always)]
fn three<L: Lanes>([r, tt, trt, _]: [L; 4]) -> [L::Stored; 4] {
    store4([r, tt, trt, trt])
}

/// Computes the constants of a shading point for a material seen from `wo`.
#[inline(always)]
pub(super) fn prepare<L: Lanes, C: Broadcast<L>>(
    m: &DEonMaterial<C>,
    wo: Vec3x<L>,
) -> DEonPrepared<L::Stored> {
    let c = L::splat;
    let (zero, one) = (c(0.0), c(1.0));
    let Direction {
        vector,
        sin_theta: sin_o,
        cos_theta: k,
        ..
    } = Direction::normalized(wo);
    let k = k.min(one);
    let (plane_o, inv_plane) = cylinder::plane(wo, vector);

    L::stage("refraction, and means of the reflectance over the width");
    let [eta, contrast, root_contrast] = lanes3(&m.eta);
    let root = k.mul_add(k, contrast).sqrt();
    let inv_root = L::quotient(one, root);
    let q = k * inv_root;
    let less = L::quotient(contrast * inv_root, root + k);
    let normal = [m.reflectance[0].lanes(), m.reflectance[1].lanes()];
    let e = L::quotient(sin_o * sin_o, one + k);
    let [reflectance, passed, both] = means(k, e, normal);
    let square = e * e;
    let at_normal = (normal[1] * (square * square)).mul_add(e, normal[0]);
    let uniform = L::quotient(at_normal, reflectance).min(one);

    L::stage("attenuation of TRT, and share of each lobe");
    let kept = m.kept.lanes();
    let (inv_cos_t, shortest) = (eta * inv_root, root_contrast * inv_root);
    let mut twice_depth = [zero; 3];
    let mut through = [zero; 3];
    let mut trt = [zero; 3];
    let mut channel = 0;
    while channel < 3 {
        let depth = (m.four_sigma_a[channel].lanes() * inv_cos_t).min(c(f32::MAX));
        twice_depth[channel] = depth;
        through[channel] = gaussian(depth * shortest);
        trt[channel] = kept * both * gaussian(depth * 1.875);
        channel += 1;
    }
    let diffuse = lanes3(&m.diffuse);
    let weights = [
        kept * reflectance,
        kept * passed * mean(through),
        mean(trt),
        mean(diffuse),
    ];

    L::stage("cone of each lobe: theta_o less the shift");
    let (sin_shift, cos_shift) = (lanes3(&m.sin_shift), lanes3(&m.cos_shift));
    let mut sin_cone = [zero; 4];
    let mut cos_cone = [zero; 4];
    let mut lobe = 0;
    while lobe < 3 {
        let (sin, cos) = (sin_shift[lobe], cos_shift[lobe]);
        sin_cone[lobe] = L::difference_of_products(sin_o, cos, k, sin);
        cos_cone[lobe] = L::difference_of_products(k, cos, -sin_o, sin).abs();
        lobe += 1;
    }

    L::stage("variance of each lobe");
    let theta = half_atan2(sin_o.abs(), k, one) * 2.0;
    let wide = k.max(c(LEAST_COSINE));
    let width_trt = theta.sqrt().mul_add(theta, c(2.0)) * m.roughness.lanes();
    let variance_trt = width_trt * width_trt;
    let variance = [
        m.variance_r.lanes(),
        L::quotient(m.variance_tt.lanes(), wide * wide),
        variance_trt,
        variance_trt,
    ];
    let mut inv_variance = [zero; 4];
    let mut concentration = [zero; 4];
    let mut spread = [zero; 4];
    let mut norm = [zero; 4];
    let mut minus_v_ln_2 = [zero; 4];
    let mut cut = [zero; 4];
    let mut lobe = 0;
    while lobe < 3 {
        let inverse = L::quotient(one, variance[lobe]);
        inv_variance[lobe] = inverse;
        concentration[lobe] = cos_cone[lobe] * inverse;
        spread[lobe] = L::quotient(one, concentration[lobe].max(c(1e-8)).sqrt());
        minus_v_ln_2[lobe] = variance[lobe] * -LN_2;
        if lobe > 0 {
            let (_, range) = gaussian_and_complement(inverse * 4.0);
            cut[lobe] = range;
            norm[lobe] = L::quotient(inverse, range);
        }
        lobe += 1;
    }
    DEonPrepared {
        plane_o: store3(plane_o),
        inv_plane_o: inv_plane.store(),
        cos_theta_o: k.store(),
        q: q.store(),
        less: less.store(),
        normal: [normal[0].store(), normal[1].store()],
        reflectance: reflectance.store(),
        uniform: uniform.store(),
        kept: kept.store(),
        sin_cone: three(sin_cone),
        cos_cone: three(cos_cone),
        inv_variance: three(inv_variance),
        concentration: three(concentration),
        spread: three(spread),
        norm: three(norm),
        minus_v_ln_2: three(minus_v_ln_2),
        cut: three(cut),
        twice_depth: store3(twice_depth),
        attenuation_trt: store3(trt),
        diffuse: store3(diffuse),
        weights: store4(weights),
        gaussians: gaussians(theta, [sin_o.abs(), k], m.width.lanes()),
    }
}
