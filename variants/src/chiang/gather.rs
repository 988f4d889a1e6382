//! Constants of the energy-conserving fibre, which are computed once per material and once per hit.

use super::{ChiangDesc, params};
use core::f32::consts::LN_2;
use hairis::model::math::gaussian_and_complement;
use hairis::model::{Direction, Precision};
use hairis::simd::{Broadcast, Lanes, Pair, lane_struct, lanes3, store4};
use hairis::{Hit, PerLobe};

lane_struct! {
    /// Widths of the lobes. Arrays of four hold R, TT, TRT and the rest, whose widths are those of TRT.
    pub(super) struct ChiangWidths {
        /// Factor of the longitudinal sampler: `-v ln 2`, of the longitudinal variance v.
        pub(super) minus_v_ln_2: [C; 4],
        /// Inverse of the variance: `1 / v`.
        pub(super) inv_variance: [C; 4],
        /// Range of the longitudinal sampler: `1 - exp(-2 / v)`.
        pub(super) cut: [C; 4],
        /// Norm of `M N`: `1 / (v (1 - exp(-2 / v)) s K)`, and for the rest `2 pi` in place of `s K`.
        pub(super) norm: [C; 4],
        /// Factor of the azimuthal sampler: `s (ln 2) / 2`, of the scale s of the azimuthal logistic, rad.
        pub(super) scale_ln_2: [C; 4],
        /// Factor from a half azimuth to the argument of a Gaussian: `4 / s`.
        pub(super) four_inv_scale: [C; 4],
        /// Part of the logistic within half a turn: `K = tanh(pi / 2s)`.
        pub(super) kept: [C; 4],
        /// Number below 0 if the azimuthal scales differ. Otherwise samples look nothing up, unless they record.
        pub(super) differ: C,
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
        /// Colour that multiplies the attenuation, with the channels of R first; the rest has the colour of TRT.
        pub(super) tint: [C; 9],
        /// Number below 0 if a tint is not 1. Otherwise hits skip the tints, unless they record.
        pub(super) tinted: C,
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
    /// [`Shifts::SmallAngle`](super::Shifts::SmallAngle), in place of the word of the description.
    #[inline]
    #[must_use]
    pub(super) fn new<W: Precision<Lane = L>>(fiber: &ChiangDesc<L>, small_angle: L::Mask) -> Self {
        let (eta, tint) = (fiber.eta, [fiber.tint_r, fiber.tint_tt, fiber.tint_trt]);
        L::stage("widths of the lobes by the roughnesses");
        let (c, one) = (W::constant, W::constant(1.0));
        let (v, s) = (
            params::variance(W::of(fiber.beta_m)),
            params::scale(W::of(fiber.beta_n)),
        );
        let index = W::of(eta);
        let [r, tt, trt] = fiber.width_m.map(|width| W::of(width) * W::of(width) * v);
        let variance = [r, tt, trt, trt];
        let cut = variance.map(|v| (c(2.0) / v).one_less_exp());
        let scale = fiber.width_n.map(|width| W::of(width) * s);
        let kept = scale.map(|s| (c(core::f64::consts::FRAC_PI_2) / s).tanh());
        let [r, tt, trt] = [0, 1, 2].map(|p| scale[p] * kept[p]);
        let turn = [r, tt, trt, c(core::f64::consts::TAU)];
        L::stage("shift of each lobe by the tilt of the scales");
        let shift = params::shifts(W::of(fiber.tilt), index, small_angle).map(W::sin_cos);
        L::stage("normalisation of the lobes");
        let by_lobe = |[r, tt, trt]: [L; 3]| [r, tt, trt, trt];
        let [width_r, width_tt, width_trt] = fiber.width_n;
        let (wider_tt, wider_trt) = (width_tt - width_r, width_trt - width_r);
        let widths = ChiangWidths {
            minus_v_ln_2: variance.map(|v| v.rounded() * -LN_2),
            inv_variance: variance.map(|v| (one / v).rounded()),
            cut: cut.map(W::rounded),
            norm: core::array::from_fn(|p| (one / (variance[p] * cut[p] * turn[p])).rounded()),
            scale_ln_2: by_lobe(scale.map(|s| s.rounded() * (0.5 * LN_2))),
            four_inv_scale: by_lobe(scale.map(|s| (c(4.0) / s).rounded())),
            kept: by_lobe(kept.map(W::rounded)),
            differ: -(wider_tt * wider_tt + wider_trt * wider_trt),
        };
        L::stage("whether a lobe is tinted: differences that are exact, and 0 without tints");
        let missing = tint.as_flattened().iter().map(|x| L::splat(1.0) - *x);
        let missing = missing.fold(L::splat(0.0), |sum, x| sum + x);
        Self {
            twice_sigma_a: fiber
                .sigma_a
                .map(|sigma| (sigma * 2.0).min(L::splat(f32::MAX))),
            // The last number keeps its digits next to an index of 1, and is exact in double precision.
            eta: [
                eta * 2.0,
                (index * index).rounded(),
                ((index - one) * (index + one)).rounded(),
            ],
            sin_shift: shift.map(|[sin, _]| sin.rounded()),
            cos_shift: shift.map(|[_, cos]| cos.rounded()),
            tint: core::array::from_fn(|place| tint[place / 3][place % 3]),
            tinted: -missing,
            widths,
        }
    }
}

/// Packet of the four lobes: R, TT, TRT and the rest.
pub(crate) type Four<L> = Pair<Pair<L>>;

/// Reads the four numbers of a table as one packet.
#[inline(always)]
pub(crate) fn four<L: Lanes, C: Broadcast<L>>(x: &[C; 4]) -> Four<L> {
    Pair(
        Pair(x[0].lanes(), x[1].lanes()),
        Pair(x[2].lanes(), x[3].lanes()),
    )
}

/// Repeats one number for all four lobes.
#[inline(always)]
pub(crate) fn same<L: Lanes>(x: L) -> Four<L> {
    Pair(Pair(x, x), Pair(x, x))
}

/// Divides packets.
#[inline(always)]
pub(super) fn quotient<L: Lanes>(over: Four<L>, under: Four<L>) -> Four<L> {
    let [r, tt, trt, rest] = L::four_quotients(apart(over), apart(under));
    Pair(Pair(r, tt), Pair(trt, rest))
}

/// Splits a packet into the number of each lobe.
#[inline(always)]
pub(crate) fn apart<L: Lanes>(Pair(Pair(a, b), Pair(c, d)): Four<L>) -> [L; 4] {
    [a, b, c, d]
}

/// Returns the reciprocal where the mask is set, and 0 elsewhere. Neither divides by zero, so that derivatives are finite as well.
#[inline(always)]
fn inverse_where<L: Lanes>(mask: L::Mask, x: L) -> L {
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    L::quotient(L::select(mask, one, zero), L::select(mask, x, one))
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
    let inv_cos_o = inverse_where(off_axis, cos_o);
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
    // Red, green, blue and a copy of blue: on one lane compilers make vectors of four numbers, and not of three.
    let [red, green, blue] = lanes3(&m.twice_sigma_a);
    let sigma = Pair(Pair(red, green), Pair(blue, blue.alone()));
    let (t, absorbed) = gaussian_and_complement(sigma * same(path_length));
    let tt = same(passed * passed) * t;
    let again = same(f) * t;
    let trt = tt * again;
    // Divided by the loss of a passage, `1 - F T`, which is the light that does not return to the inside.
    let lost = same(f).mul_add(absorbed, same(passed));
    let rest = quotient(trt * again, lost.max(same(c(1e-30))));
    L::stage("tint of each lobe");
    // On one lane the products take fewer instructions than the branch.
    let attenuation = if is_one_lane::<L>() || C::any_below_0(&m.tinted) {
        let by: Four<L> = tint(m, 2);
        [same(f) * tint(m, 0), tt * tint(m, 1), trt * by, rest * by]
    } else {
        [same(f), tt, trt, rest]
    };

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
    let [sin_cone, cos_cone] = cones(m, [sin_o, cos_o]);
    let concentration = cos_cone * four(&m.widths.inv_variance);

    let [r, tt, trt, rest] = [
        store4(apart(attenuation[0])),
        store4(apart(attenuation[1])),
        store4(apart(attenuation[2])),
        store4(apart(attenuation[3])),
    ];
    ChiangPrepared {
        sin_cone: store4(apart(sin_cone)),
        cos_cone: store4(apart(cos_cone)),
        concentration: store4(apart(concentration)),
        spread: store4(L::four_quotients(
            [one; 4],
            L::four_roots(apart(concentration.max(same(c(1e-8))))),
        )),
        azimuth_v: store4(apart(v * by)),
        azimuth_w: store4(apart(w * by)),
        attenuation: [
            r[0], r[1], r[2], tt[0], tt[1], tt[2], trt[0], trt[1], trt[2], rest[0], rest[1],
            rest[2],
        ],
        fresnel: f.store(),
        path_length: path_length.store(),
        widths: m.widths.spread::<L>(),
    }
}

/// Returns the tint of the lobe with this place in each channel, and that of blue again.
#[inline(always)]
fn tint<L: Lanes, C: Broadcast<L>>(m: &ChiangMaterial<C>, place: usize) -> Four<L> {
    let tint = &m.tint;
    let blue = tint[3 * place + 2];
    four(&[tint[3 * place], tint[3 * place + 1], blue, blue])
}

/// Returns true if `L` is one lane, for which compilers make vectors of equal steps.
#[inline(always)]
const fn is_one_lane<L: Lanes>() -> bool {
    size_of::<L>() == size_of::<f32>()
}

/// Computes sine and cosine of each lobe's cone, by those of the inclination of `wo`, which is the cone of the rest. Past the pole, a
/// cone folds back.
#[inline(always)]
fn cones<L: Lanes, C: Broadcast<L>>(m: &ChiangMaterial<C>, [sin_o, cos_o]: [L; 2]) -> [Four<L>; 2] {
    let (sin, cos) = (four(&m.sin_shift), four(&m.cos_shift));
    // On one lane compilers make one vector of four lobes. Elsewhere three lobes are less than four.
    if is_one_lane::<L>() {
        return [
            Four::difference_of_products(same(sin_o), cos, same(cos_o), sin),
            Four::difference_of_products(same(cos_o), cos, same(-sin_o), sin).abs(),
        ];
    }
    let (Pair(sin, Pair(sin_trt, _)), Pair(cos, Pair(cos_trt, _))) = (sin, cos);
    let (sin_two, cos_two, minus_two) =
        (Pair(sin_o, sin_o), Pair(cos_o, cos_o), Pair(-sin_o, -sin_o));
    [
        Pair(
            Pair::difference_of_products(sin_two, cos, cos_two, sin),
            Pair(
                L::difference_of_products(sin_o, cos_trt, cos_o, sin_trt),
                sin_o,
            ),
        ),
        Pair(
            Pair::difference_of_products(cos_two, cos, minus_two, sin).abs(),
            Pair(
                L::difference_of_products(cos_o, cos_trt, -sin_o, sin_trt).abs(),
                cos_o,
            ),
        ),
    ]
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

/// Returns the numbers of the four lobes, and 0 in the slot after them.
#[inline(always)]
fn padded<L: Lanes>(four: Four<L>) -> PerLobe<L> {
    let [r, tt, trt, rest] = apart(four);
    PerLobe([r, tt, trt, rest, L::splat(0.0)])
}

/// Returns the mean of each lobe's attenuation over the channels.
#[inline(always)]
pub(super) fn mean_shares<L: Lanes, C: Broadcast<L>>(prepared: &ChiangPrepared<C>) -> PerLobe<L> {
    let sum = channel(prepared, 0) + channel(prepared, 1) + channel(prepared, 2);
    padded(sum * Four::splat(1.0 / 3.0))
}

/// Returns `sqrt(sum over the channels of (A_pc / mu_c)^2)` for each lobe, with `mu_c` the sum over the lobes.
#[inline(always)]
pub(super) fn shares_by_channel<L: Lanes, C: Broadcast<L>>(
    prepared: &ChiangPrepared<C>,
) -> PerLobe<L> {
    let (mut sum, mut squares) = (Four::splat(0.0), Four::splat(0.0));
    let mut c = 0;
    while c < 3 {
        let lobes: Four<L> = channel(prepared, c);
        let [r, tt, trt, rest] = apart(lobes);
        let total = (r + tt) + (trt + rest);
        let share = lobes * same(inverse_where(L::splat(f32::MIN_POSITIVE).lt(total), total));
        sum = sum + share;
        squares = share.mul_add(share, squares);
        c += 1;
    }
    // A lobe that is about to appear by one channel has its share, where the root has no derivative. Below 1e-22 squares are denormal.
    let faint = sum.lt(Four::splat(1e-22));
    padded(Four::select(faint, sum, squares.sqrt()))
}

impl ChiangPrepared<f32> {
    /// Returns the Fresnel reflectance F at the hit. With F and the [path length](Self::path_length) l, a spectral host computes
    /// the attenuations for an absorption sigma. With `T = exp(-sigma l)`, R has `F`, TT has `(1 - F)^2 T`, TRT has
    /// `(1 - F)^2 F T^2`, and the rest has `(1 - F)^2 F^2 T^3 / (1 - F T)`,
    /// each times the tint of the lobe.
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
