//! Constants of the energy-conserving fibre, which are computed once per material and once per hit.

use super::params;
use hairis::model::math::gaussian_and_complement;
use hairis::model::{Direction, Precision};
use hairis::simd::{Broadcast, Lanes, Pair, lane_struct, lanes3, store4};
use hairis::{Hit, PerLobe};

lane_struct! {
    /// Widths of the lobes. Arrays of four hold R, TT, TRT and the rest.
    pub(super) struct ChiangWidths {
        /// Longitudinal variance v.
        pub(super) variance: [C; 4],
        /// Inverse of the variance: `1 / v`.
        pub(super) inv_variance: [C; 4],
        /// Range of the longitudinal sampler: `1 - exp(-2 / v)`.
        pub(super) cut: [C; 4],
        /// Norm of `M N`: `1 / (v (1 - exp(-2 / v)) s K)`, and for the rest `2 pi` in place of `s K`.
        pub(super) norm: [C; 4],
        /// Scale s of the azimuthal logistic, rad.
        pub(super) scale: C,
        /// Factor from a half azimuth to the argument of a Gaussian: `4 / s`.
        pub(super) four_inv_scale: C,
        /// Part of the logistic within half a turn: `K = tanh(pi / 2s)`.
        pub(super) kept: C,
    }
}

lane_struct! {
    /// Constants of a material of the energy-conserving fibre.
    pub struct ChiangMaterial {
        /// Absorption per radius, linear RGB, doubled to be the argument of a Gaussian per length.
        pub(super) twice_sigma_a: [C; 3],
        /// Twice the index of refraction, its square, and its square less 1.
        pub(super) eta: [C; 3],
        /// Sine of each lobe's shift of `theta_i + theta_o`.
        pub(super) sin_shift: [C; 4],
        /// Cosine of each lobe's shift.
        pub(super) cos_shift: [C; 4],
        /// Widths of the lobes.
        pub(super) widths: ChiangWidths<C>,
    }
}

lane_struct! {
    /// Constants of a shading point of the energy-conserving fibre, from which a spectral host can compute attenuations.
    pub struct ChiangPrepared {
        /// Sine of each lobe's cone, `theta' = theta_o - shift`.
        pub(super) sin_cone: [C; 4],
        /// Cosine of each lobe's cone.
        pub(super) cos_cone: [C; 4],
        /// Factor of the Bessel function's argument: `cos theta' / v`.
        pub(super) concentration: [C; 4],
        /// Inverse root of that factor: `sqrt(v / cos theta')`.
        pub(super) spread: [C; 4],
        /// Component along v of the unit vector at each lobe's azimuth.
        pub(super) azimuth_v: [C; 4],
        /// Component along w of the unit vector at each lobe's azimuth.
        pub(super) azimuth_w: [C; 4],
        /// Attenuation of each lobe, linear RGB, with the channels of R first.
        pub(super) attenuation: [C; 12],
        /// Fresnel reflectance.
        pub(super) fresnel: C,
        /// Length of one passage through the fibre, in radii.
        pub(super) path_length: C,
        /// Widths of the lobes.
        pub(super) widths: ChiangWidths<C>,
    }
}

impl<L: Lanes<Stored = L>> ChiangMaterial<L> {
    /// Computes the constants of a description, whose values lie in the ranges of checked parameters. The mask is set for
    /// [`Shifts::SmallAngle`](super::Shifts::SmallAngle).
    #[inline]
    #[must_use]
    pub(super) fn new<W: Precision<Lane = L>>(
        [beta_m, beta_n, tilt, eta]: [L; 4],
        sigma_a: [L; 3],
        small_angle: L::Mask,
    ) -> Self {
        L::stage("widths of the lobes by the roughnesses");
        let (c, one) = (W::constant, W::constant(1.0));
        let (v, s) = (
            params::variance(W::of(beta_m)),
            params::scale(W::of(beta_n)),
        );
        let kept = (c(core::f64::consts::FRAC_PI_2) / s).tanh();
        let index = W::of(eta);
        let variance = [v, c(0.25) * v, c(4.0) * v, c(4.0) * v];
        let cut = variance.map(|v| (c(2.0) / v).one_less_exp());
        let turn = [s * kept, s * kept, s * kept, c(core::f64::consts::TAU)];
        L::stage("shift of each lobe by the tilt of the scales");
        let shift = params::shifts(W::of(tilt), index, small_angle).map(W::sin_cos);
        L::stage("normalisation of the lobes");
        let widths = ChiangWidths {
            variance: variance.map(W::rounded),
            inv_variance: variance.map(|v| (one / v).rounded()),
            cut: cut.map(W::rounded),
            norm: core::array::from_fn(|p| (one / (variance[p] * cut[p] * turn[p])).rounded()),
            scale: s.rounded(),
            four_inv_scale: (c(4.0) / s).rounded(),
            kept: kept.rounded(),
        };
        Self {
            twice_sigma_a: sigma_a.map(|sigma| (sigma * 2.0).min(L::splat(f32::MAX))),
            // The last number keeps its digits next to an index of 1, and is exact in double precision.
            eta: [
                eta * 2.0,
                (index * index).rounded(),
                ((index - one) * (index + one)).rounded(),
            ],
            sin_shift: shift.map(|[sin, _]| sin.rounded()),
            cos_shift: shift.map(|[_, cos]| cos.rounded()),
            widths,
        }
    }
}

/// Packet of the four lobes: R, TT, TRT and the rest.
pub(super) type Four<L> = Pair<Pair<L>>;

/// Reads the four numbers of a table as one packet.
#[inline(always)]
pub(super) fn four<L: Lanes, C: Broadcast<L>>(x: &[C; 4]) -> Four<L> {
    Pair(
        Pair(x[0].lanes(), x[1].lanes()),
        Pair(x[2].lanes(), x[3].lanes()),
    )
}

/// Repeats one number for all four lobes.
#[inline(always)]
pub(super) fn same<L: Lanes>(x: L) -> Four<L> {
    Pair(Pair(x, x), Pair(x, x))
}

/// Splits a packet into the number of each lobe.
#[inline(always)]
pub(super) fn apart<L: Lanes>(Pair(Pair(a, b), Pair(c, d)): Four<L>) -> [L; 4] {
    [a, b, c, d]
}

/// Multiplies two complex numbers.
#[inline(always)]
fn product<L: Lanes>([a, b]: [L; 2], [c, d]: [L; 2]) -> [L; 2] {
    [
        L::difference_of_products(a, c, b, d),
        L::difference_of_products(a, d, -b, c),
    ]
}

/// Returns the Fresnel reflectance and transmittance of unpolarised light at the cosine `c`; `k` is `sqrt(eta^2 - 1 + c^2)`.
///
/// No difference is taken, so that the reflectance keeps its digits where the index is next to 1, and the transmittance where
/// all light is reflected. `(c - k)(c + k)` is `1 - eta^2`.
#[inline(always)]
fn fresnel<L: Lanes>(c: L, k: L, eta_sq: L, eta_sq_less_one: L) -> [L; 2] {
    let (one, tiny) = (L::splat(1.0), L::splat(1e-15));
    let (across, along) = (c + k, eta_sq.mul_add(c, k));
    // An index of 1 at the very edge reflects nothing.
    let none = across.lt(tiny);
    let inverse = L::quotient(one, across.max(tiny) * along.max(tiny));
    let (inv_across, inv_along) = (inverse * along, inverse * across);
    let (t_s, t_p) = (inv_across * inv_across, inv_along * inv_along);
    let r_s = eta_sq_less_one * t_s;
    let r_p = eta_sq_less_one * t_p * (c * c).mul_sub(eta_sq + 1.0, one);
    let reflected = (L::splat(0.5) * r_s.mul_add(r_s, r_p * r_p)).min(one);
    let passed = (c + c) * k * eta_sq.mul_add(t_p, t_s);
    [
        L::select(none, L::splat(0.0), reflected),
        L::select(none, one, passed),
    ]
}

/// Computes the constants of a shading point for a material seen from `hit.wo` at the offset `hit.h`.
#[inline(always)]
pub(super) fn prepare<L: Lanes, C: Broadcast<L>>(
    m: &ChiangMaterial<C>,
    hit: Hit<L>,
) -> ChiangPrepared<L::Stored> {
    let c = L::splat;
    let (zero, one) = (c(0.0), c(1.0));
    let Direction {
        vector,
        sin_theta: sin_o,
        cos_theta: cos_o,
        ..
    } = Direction::normalized(hit.wo);
    let off_axis = c(1e-18).lt(cos_o);
    let inv_cos_o = L::quotient(
        L::select(off_axis, one, zero),
        L::select(off_axis, cos_o, one),
    );
    let azimuth_o = [
        L::select(off_axis, vector.y * inv_cos_o, one),
        vector.z * inv_cos_o,
    ];

    L::stage("angles about the fibre: of the hit, from its normal to wo, and of the ray inside");
    let sin_gamma_o = hit.h;
    let cos_gamma_o = zero.max((one - sin_gamma_o) * (one + sin_gamma_o)).sqrt();
    let [twice_eta, eta_sq, eta_sq_less_one] = lanes3(&m.eta);
    let inside_sq = cos_o.mul_add(cos_o, eta_sq_less_one);
    // In a fibre that does not refract, the ray inside has the direction of the ray outside.
    let straight = inside_sq.lt(c(1e-30));
    let inv_inside = L::quotient(one, inside_sq.max(c(1e-30)).sqrt());
    let sin_gamma_t = sin_gamma_o * L::select(straight, one, (cos_o * inv_inside).min(one));
    // A sum of squares, because a difference from 1 loses the edge of a fibre that hardly refracts.
    let cos_hit = cos_o * cos_gamma_o;
    let k = cos_hit.mul_add(cos_hit, eta_sq_less_one).sqrt();
    let cos_gamma_t = L::select(straight, cos_gamma_o, (k * inv_inside).min(one));

    L::stage("length of a passage, and Fresnel's reflectance");
    let path_length = twice_eta * cos_gamma_t * inv_inside;
    let [f, passed] = fresnel(cos_hit, k, eta_sq, eta_sq_less_one);
    L::stage("attenuation of each lobe in each channel");
    let mut attenuation = [f.store(); 12];
    let mut channel = 0;
    while channel < 3 {
        let (t, absorbed) = gaussian_and_complement(m.twice_sigma_a[channel].lanes() * path_length);
        let tt = passed * passed * t;
        let trt = tt * (f * t);
        attenuation[3 + channel] = tt.store();
        attenuation[6 + channel] = trt.store();
        // Divided by the loss of a passage, `1 - F T`, which is the light that does not return to the inside.
        attenuation[9 + channel] =
            L::quotient(trt * (f * t), f.mul_add(absorbed, passed).max(c(1e-30))).store();
        channel += 1;
    }

    L::stage("azimuth of each lobe");
    // The azimuth of wo, turned by -2 gamma_o, and by pi + 2 gamma_t for each passage.
    let back = product([cos_gamma_o, -sin_gamma_o], [cos_gamma_o, -sin_gamma_o]);
    let passage = product([cos_gamma_t, sin_gamma_t], [cos_gamma_t, sin_gamma_t]);
    let passage = [-passage[0], -passage[1]];
    let r = product(azimuth_o, back);
    let tt = product(r, passage);
    let trt = product(tt, passage);
    let rest = product(trt, passage);
    let [v, w] = [
        Pair(Pair(r[0], tt[0]), Pair(trt[0], rest[0])),
        Pair(Pair(r[1], tt[1]), Pair(trt[1], rest[1])),
    ];
    // Restores unit length, from which rounding has moved the vectors a little.
    let by = v
        .mul_add(v, w * w)
        .mul_add(Four::splat(-0.5), Four::splat(1.5));

    L::stage("cone of each lobe: theta_o less the shift");
    // Past the pole, the cone folds back.
    let (sin, cos) = (four(&m.sin_shift), four(&m.cos_shift));
    let sin_cone = Four::difference_of_products(same(sin_o), cos, same(cos_o), sin);
    let cos_cone = Four::difference_of_products(same(cos_o), cos, same(-sin_o), sin).abs();
    let concentration = cos_cone * four(&m.widths.inv_variance);

    ChiangPrepared {
        sin_cone: store4(apart(sin_cone)),
        cos_cone: store4(apart(cos_cone)),
        concentration: store4(apart(concentration)),
        spread: store4(apart(Four::quotient(
            same(one),
            concentration.max(same(c(1e-8))).sqrt(),
        ))),
        azimuth_v: store4(apart(v * by)),
        azimuth_w: store4(apart(w * by)),
        attenuation,
        fresnel: f.store(),
        path_length: path_length.store(),
        widths: m.widths.spread::<L>(),
    }
}

/// Returns the attenuation of lobe `p`, linear RGB.
#[inline(always)]
pub(super) fn attenuation<L: Lanes, C: Broadcast<L>>(
    prepared: &ChiangPrepared<C>,
    p: usize,
) -> [L; 3] {
    lanes3(&[
        prepared.attenuation[3 * p],
        prepared.attenuation[3 * p + 1],
        prepared.attenuation[3 * p + 2],
    ])
}

/// Returns the attenuation of the four lobes in one channel.
#[inline(always)]
fn channel<L: Lanes, C: Broadcast<L>>(prepared: &ChiangPrepared<C>, c: usize) -> Four<L> {
    let a = &prepared.attenuation;
    four(&[a[c], a[3 + c], a[6 + c], a[9 + c]])
}

/// Returns the mean of each lobe's attenuation over the channels.
#[inline(always)]
pub(super) fn mean_shares<L: Lanes, C: Broadcast<L>>(prepared: &ChiangPrepared<C>) -> PerLobe<L> {
    PerLobe(apart(
        (channel(prepared, 0) + channel(prepared, 1) + channel(prepared, 2))
            * Four::splat(1.0 / 3.0),
    ))
}

/// Returns `sqrt(sum over the channels of (A_pc / mu_c)^2)` for each lobe, with `mu_c` the sum over the lobes.
#[inline(always)]
pub(super) fn shares_by_channel<L: Lanes, C: Broadcast<L>>(
    prepared: &ChiangPrepared<C>,
) -> PerLobe<L> {
    let mut sum = Four::splat(0.0);
    let mut c = 0;
    while c < 3 {
        let lobes: Four<L> = channel(prepared, c);
        let [r, tt, trt, rest] = apart(lobes);
        let total = (r + tt) + (trt + rest);
        let share = lobes
            * same(L::keep(
                L::splat(f32::MIN_POSITIVE).lt(total),
                L::quotient(L::splat(1.0), total),
            ));
        sum = share.mul_add(share, sum);
        c += 1;
    }
    PerLobe(apart(sum.sqrt()))
}

impl ChiangPrepared<f32> {
    /// Returns the Fresnel reflectance F at the hit. With F and the [path length](Self::path_length) l, a spectral host computes
    /// the attenuations for an absorption sigma. With `T = exp(-sigma l)`, R has `F`, TT has `(1 - F)^2 T`, TRT has
    /// `(1 - F)^2 F T^2`, and the rest has `(1 - F)^2 F^2 T^3 / (1 - F T)`.
    #[inline]
    #[must_use]
    pub const fn fresnel(&self) -> f32 {
        self.fresnel
    }

    /// Returns the length of one passage through the fibre, in radii.
    #[inline]
    #[must_use]
    pub const fn path_length(&self) -> f32 {
        self.path_length
    }
}
