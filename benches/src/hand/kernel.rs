//! The algebra of the hand-written kernels, once for all instruction sets.

use super::vector::{Table, Vector};
use core::f32::consts::{FRAC_PI_4, LOG2_E};
use core::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4 as QUARTER, PI};
use hairis::params::HairDesc;

/// The constants of one shading point, prepared once.
#[derive(Clone, Copy, Debug)]
pub struct Constants {
    sin_theta_o: f32,
    cos_theta_o: f32,
    inv_cos_theta_o: f32,
    /// The part of `wo` across the fibre, with the digits that it has: next to `phi = pi` they decide.
    v_o: f32,
    w_o: f32,
    /// Part of `wo` across the fibre, scaled to unit length.
    v_unit: f32,
    w_unit: f32,
    /// From half of `theta_i` to the distances from the centres of R, TT and TRT in widths: a factor and a term.
    to_x: [[f32; 2]; 3],
    /// From `pi/4 - |phi|/2` to those of TT and the glints.
    to_y: [[f32; 2]; 2],
    /// Colours of R, TT and TRT, and the strength of the glints: those of R and TRT over `sqrt 2`, as `cos(phi / 2)` is times that.
    colors: [[f32; 3]; 3],
    glint: f32,
    /// Shares of the lobes in the density.
    weights: [f32; 4],
    bounds: [f32; 3],
    /// Truncated Cauchy of each lobe's inclination: span and tangent of the middle; width and shift.
    inclination: [Table; 4],
    /// Tables of the azimuth: span, middle, half width, half of the centre; entries of TT first.
    azimuth: [Table; 4],
}

impl Constants {
    /// The constants of checked parameters seen from a unit `wo` off the axis.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "computed in double precision, kept in single"
    )]
    pub fn new(desc: &HairDesc, wo: [f32; 3]) -> Self {
        let wo = wo.map(f64::from);
        let plane = wo[1].hypot(wo[2]);
        let half_theta_o = 0.5 * wo[0].atan2(plane);
        let beta = desc.beta.map(f64::from);
        let shift = desc.alpha.map(|alpha| half_theta_o - f64::from(alpha));
        let gamma = [desc.gamma_tt, desc.gamma_g].map(f64::from);
        let (phi_g, intensity_g) = (f64::from(desc.phi_g), f64::from(desc.i_g));
        let colors = [desc.i_r, desc.i_tt, desc.i_trt].map(|color| color.map(f64::from));
        let mean = colors.map(|color| color.iter().sum::<f64>() / 3.0);

        let root = 4.0 * (2.0 * PI).sqrt();
        let energy = [
            root * beta[0] * mean[0],
            2.0 * PI * beta[1] * gamma[0] * mean[1],
            root * beta[2] * mean[2],
            4.0 * PI * beta[2] * gamma[1] * mean[2] * intensity_g,
        ];
        let total: f64 = energy.iter().sum();
        let p = energy.map(|energy| energy / total);

        let ends = |lo: f64, hi: f64, width: f64| {
            let (lo, hi) = ((lo / width).atan(), (hi / width).atan());
            [hi - lo, (0.5 * (lo + hi)).tan()]
        };
        let theta = [0, 1, 2].map(|l: usize| ends(shift[l] - QUARTER, shift[l] + QUARTER, beta[l]));
        let tt = ends(0.0, PI, gamma[0]);
        let g = ends(-phi_g, FRAC_PI_2 - phi_g, gamma[1]);
        let of_theta = [0, 1, 2].map(|l: usize| 0.5 / (theta[l][0] * beta[l]));
        let by_lobe = |x: [f64; 3]| Table::new([x[0], x[1], x[2], x[2]].map(|x| x as f32));
        let by_bell = |tt: f64, g: f64| Table::new([tt, tt, g, g].map(|x| x as f32));
        let scaled = |color: [f64; 3], by: f64| color.map(|c| (c * by) as f32);
        Self {
            sin_theta_o: wo[0] as f32,
            cos_theta_o: plane as f32,
            inv_cos_theta_o: (1.0 / plane) as f32,
            v_o: wo[1] as f32,
            w_o: wo[2] as f32,
            v_unit: (wo[1] / plane) as f32,
            w_unit: (wo[2] / plane) as f32,
            to_x: [0, 1, 2].map(|l: usize| [1.0 / beta[l], shift[l] / beta[l]].map(|x| x as f32)),
            to_y: [
                [2.0 / gamma[0], QUARTER * 2.0 / gamma[0]].map(|x| x as f32),
                [2.0 / gamma[1], (QUARTER - 0.5 * phi_g) * 2.0 / gamma[1]].map(|x| x as f32),
            ],
            // 1 / cos^2 theta_d is 4 over a squared length.
            colors: [
                scaled(colors[0], 4.0 * FRAC_1_SQRT_2),
                scaled(colors[1], 4.0),
                scaled(colors[2], 4.0 * FRAC_1_SQRT_2),
            ],
            glint: (intensity_g / FRAC_1_SQRT_2) as f32,
            weights: [
                p[0] * of_theta[0] * 0.25 * FRAC_1_SQRT_2,
                p[1] * of_theta[1] / (2.0 * tt[0] * gamma[0]),
                p[2] * of_theta[2] * 0.25 * FRAC_1_SQRT_2,
                p[3] * of_theta[2] / (2.0 * g[0] * gamma[1]),
            ]
            .map(|x| x as f32),
            bounds: [p[0], p[0] + p[1], p[0] + p[1] + p[2]].map(|x| x as f32),
            inclination: [
                by_lobe(theta.map(|t| t[0])),
                by_lobe(theta.map(|t| t[1])),
                by_lobe(beta),
                by_lobe(shift),
            ],
            azimuth: [
                by_bell(-tt[0], g[0]),
                by_bell(tt[1], g[1]),
                by_bell(0.5 * gamma[0], 0.5 * gamma[1]),
                by_bell(0.0, 0.5 * phi_g),
            ],
        }
    }
}

#[inline(always)]
fn horner<V: Vector, const N: usize>(x: V, coefficients: [f32; N]) -> V {
    let mut sum = V::splat(coefficients[N - 1]);
    let mut i = N - 1;
    while i > 0 {
        i -= 1;
        sum = sum.mul_add(x, V::splat(coefficients[i]));
    }
    sum
}

/// `atan t` for `|t| <= 1`, to 1e-8 before rounding.
#[inline(always)]
fn atan<V: Vector>(t: V) -> V {
    let z = (t * t).together();
    let over = horner(z, [1.0, 1.221_005_45, 0.340_378_022, 0.011_830_160_6]);
    (t * horner(z, [0.999_999_873, 0.887_677_098, 0.133_320_266])).over(over)
}

/// Numerator and denominator of `tan x` for `|x| <= pi/2`, to 1.5e-8 in the angle before rounding.
#[inline(always)]
fn tan_half_turn<V: Vector>(x: V) -> [V; 2] {
    let z = (x * x).together();
    [
        x * horner(z, [1.000_000_1, -0.112_152_473, 0.001_132_496_5]),
        horner(z, [1.0, -0.445_485, 0.016_292_556_6]),
    ]
}

/// Tangent as a quotient, for `|x| <= pi/4`.
#[inline(always)]
fn tan_quarter_turn<V: Vector>(x: V) -> [V; 2] {
    let z = (x * x).together();
    [
        x * horner(z, [0.999_999_947, -0.095_853_754_7]),
        horner(z, [1.0, -0.429_188_206, 0.009_735_576_67]),
    ]
}

/// `acos(a) / sqrt(1 - a^2)` for `0 <= a <= 1`, to 1.6e-8 in the angle before rounding, numerator and denominator.
#[inline(always)]
fn acos_over_sine<V: Vector>(a: V) -> [V; 2] {
    [
        horner(a, [1.570_796_31, 1.347_228_79, 0.190_921_536]),
        horner(a, [1.0, 1.494_291_01, 0.572_863_406, 0.041_792_620_2]),
    ]
}

/// `exp(-s/2)`; 0 from about `2^-115` down.
#[inline(always)]
fn gaussian<V: Vector>(s: V) -> V {
    const LEAST: f32 = 115.0;
    const TO_EXPONENT: f32 = 0.5 * LOG2_E;
    const SCALE: f32 = 4096.0;
    let magic = V::splat(8_388_608.0 + LEAST);
    let by = V::splat(TO_EXPONENT);
    let s = s.min(V::splat(0.999_98 * LEAST / TO_EXPONENT));
    let n = s.sub_from(by, magic);
    let f = s.sub_from(by, magic - n).together();
    let p = horner(
        f,
        [
            SCALE,
            SCALE * 0.693_146_977_598_470_9,
            SCALE * 0.240_222_420_849_192_87,
            SCALE * 0.055_507_337_442_446_49,
            SCALE * 0.009_671_512_660_561_226,
            SCALE * 0.001_326_472_689_901_139_9,
        ],
    );
    p * n.shift_23()
}

/// Angles and distances that the lobes are functions of.
struct Angles<V> {
    half_theta_i: V,
    sin_theta_i: V,
    cos_theta_i: V,
    /// `pi/4 - |phi|/2`.
    from_side: V,
    /// `sqrt 2 cos(phi / 2)`.
    cos_half_phi: V,
}

/// The lobes at some angles.
struct Lobes<V> {
    /// S times `length_sq`.
    value: [V; 3],
    /// Squared length of the sum of the two directions in the meridian plane: `4 cos^2 theta_d`.
    length_sq: V,
    /// The density times `cos theta_i`.
    density: V,
}

#[inline(always)]
fn lobes<V: Vector, const CAUCHY: bool>(c: &Constants, at: &Angles<V>) -> Lobes<V> {
    let k = V::splat;
    let one = k(1.0);
    let half = at.half_theta_i;
    let x_r = half.mul_add(k(c.to_x[0][0]), k(c.to_x[0][1]));
    let x_tt = half.mul_add(k(c.to_x[1][0]), k(c.to_x[1][1]));
    let x_trt = half.mul_add(k(c.to_x[2][0]), k(c.to_x[2][1]));
    let y_tt = at.from_side.mul_add(k(c.to_y[0][0]), k(c.to_y[0][1]));
    let y_g = at.from_side.sub_from(k(c.to_y[1][0]), k(c.to_y[1][1]));
    let (s_r, s_tt, s_trt, t_tt, t_g) = (
        x_r * x_r,
        x_tt * x_tt,
        x_trt * x_trt,
        y_tt * y_tt,
        y_g * y_g,
    );
    let cos = at.cos_half_phi;

    let [q_r, q_tt, q_trt, q_g] = V::reciprocals(
        [
            one + s_r,
            (one + s_tt) * (one + t_tt),
            one + s_trt,
            one + t_g,
        ],
        CAUCHY,
    );
    let q_r = cos * q_r;
    let front_g = V::clear(at.from_side.below_zero(), q_g);
    let secondary = front_g.mul_add(k(c.weights[3]), cos * k(c.weights[2]));
    let density = q_trt.mul_add(
        secondary,
        q_tt.mul_add(k(c.weights[1]), q_r * k(c.weights[0])),
    );

    let (f_r, f_tt, f_trt) = if CAUCHY {
        (q_r, q_tt, q_trt * q_g.mul_add(k(c.glint), cos))
    } else {
        (
            cos * gaussian(s_r),
            gaussian(s_tt + t_tt),
            gaussian(s_trt) * gaussian(t_g).mul_add(k(c.glint), cos),
        )
    };
    let sum_u = at.sin_theta_i + k(c.sin_theta_o);
    let sum_c = at.cos_theta_i + k(c.cos_theta_o);
    let length_sq = sum_u.mul_add(sum_u, sum_c * sum_c);
    let [r, tt, trt] = &c.colors;
    let value = [
        f_r.mul_add(k(r[0]), f_tt.mul_add(k(tt[0]), f_trt * k(trt[0]))),
        f_r.mul_add(k(r[1]), f_tt.mul_add(k(tt[1]), f_trt * k(trt[1]))),
        f_r.mul_add(k(r[2]), f_tt.mul_add(k(tt[2]), f_trt * k(trt[2]))),
    ];
    Lobes {
        value,
        length_sq,
        density,
    }
}

/// Value and density of a direction.
#[inline(always)]
pub(super) fn eval<V: Vector, const CAUCHY: bool>(c: &Constants, [x, y, z]: [V; 3]) -> [V; 4] {
    let k = V::splat;
    let one = k(1.0);
    let cos = y.mul_add(y, z * z).sqrt();
    let half_theta_i = atan(x.over(one + cos));
    // The tangent of half of |phi| or of pi - |phi|, whichever is smaller.
    let dot = y.mul_add(k(c.v_o), z * k(c.w_o));
    let cross = V::cross(k(c.v_o), z, k(c.w_o), y).abs();
    let far = cos.mul_add(k(c.cos_theta_o), dot.abs());
    let inv_cos = one.over(cos);
    let tau = cross.over(far);
    let root = (far * (inv_cos * k(c.inv_cos_theta_o))).sqrt();
    let from_side = (k(FRAC_PI_4) - atan(tau)).times_sign(dot);
    let cos_half_phi = root * V::select(dot.below_zero(), tau, one);
    let at = Angles {
        half_theta_i,
        sin_theta_i: x,
        cos_theta_i: cos,
        from_side,
        cos_half_phi,
    };
    let Lobes {
        value: [r, g, b],
        length_sq,
        density,
    } = lobes::<V, CAUCHY>(c, &at);
    let by = one.over(length_sq);
    [r * by, g * by, b * by, density * inv_cos]
}

/// The part of a Cauchy distribution at cdf `1/2 + u`.
#[inline(always)]
fn invert<V: Vector>(u: V, middle: V) -> V {
    let [n, d] = tan_half_turn(u);
    middle.mul_add(d, n).over(middle.sub_from(n, d))
}

/// A direction for three uniform numbers, its density and its weight.
#[inline(always)]
pub(super) fn sample<V: Vector>(c: &Constants, xi: [V; 3]) -> [V; 7] {
    let k = V::splat;
    let (one, half, two) = (k(1.0), k(0.5), k(2.0));
    let lobe = V::search(xi[0], [k(c.bounds[0]), k(c.bounds[1]), k(c.bounds[2])]);
    let (is_tt, is_glint) = (V::is_tt(lobe), V::is_glint(lobe));
    let is_bell = V::either(is_tt, is_glint);

    let u = (xi[1] - half) * V::look_up(&c.inclination[0], lobe);
    let x = invert(u, V::look_up(&c.inclination[1], lobe));
    let half_theta_i = x.mul_sub(
        V::look_up(&c.inclination[2], lobe),
        V::look_up(&c.inclination[3], lobe),
    );
    let [n, d] = tan_quarter_turn(half_theta_i);
    let n_sq = n * n;
    let by = two.over(d.mul_add(d, n_sq));
    let (sin_theta_i, cos_theta_i) = (n * d * by, n_sq.sub_from(by, one));

    let side = xi[2].mul_sub(two, one);
    let across = side.abs();
    let u = (half - across) * V::look_up_half(&c.azimuth[0], lobe);
    let y = invert(u, V::look_up_half(&c.azimuth[1], lobe));
    let psi = y.mul_add(
        V::look_up_half(&c.azimuth[2], lobe),
        V::look_up_half(&c.azimuth[3], lobe),
    );
    let [n, d] = tan_half_turn(psi);
    // R and TRT-g: sin(phi / 2) is `across`.
    let cosine = V::rest_of_square(across);
    let [acos_n, acos_d] = acos_over_sine(across);
    let psi = V::select(is_bell, psi, (cosine * acos_n).over(acos_d));
    let (n, d) = (V::select(is_bell, n, across), V::select(is_bell, d, cosine));
    let n_sq = n * n;
    let by = two.over(d.mul_add(d, n_sq));
    let sin_abs = n * d * by;
    let sin_phi = sin_abs.times_sign(V::negate(is_bell, side));
    let cos_phi = V::negate(is_tt, n_sq.sub_from(by, one));
    let root = by.sqrt();
    let (cos_half_phi, sin_half_phi) =
        (V::select(is_tt, n, d) * root, V::select(is_tt, d, n) * root);
    // Half of |phi| for the glints, of pi - |phi| for the others.
    let from_side = V::negate(is_glint, psi - k(FRAC_PI_4));

    let v = cos_phi.mul_add(k(c.v_unit), sin_phi * k(c.w_unit)) * cos_theta_i;
    let w = cos_phi.mul_sub(k(c.w_unit), sin_phi * k(c.v_unit)) * cos_theta_i;
    // The angle of the rounded direction: half of |phi| is larger by this much.
    let inv_cos = one.over(cos_theta_i);
    let dot = v.mul_add(k(c.v_o), w * k(c.w_o));
    let cross = V::cross(k(c.v_o), w, k(c.w_o), v).abs();
    let rotation = cross.mul_sub(cos_phi, dot * sin_abs) * (inv_cos * k(0.5 * c.inv_cos_theta_o));
    let at = Angles {
        half_theta_i,
        sin_theta_i,
        cos_theta_i,
        from_side: from_side - rotation,
        cos_half_phi: rotation.sub_from(sin_half_phi, cos_half_phi).max(k(0.0)),
    };
    let Lobes {
        value: [r, g, b],
        length_sq,
        density,
    } = lobes::<V, false>(c, &at);
    let by = (cos_theta_i * cos_theta_i).over(length_sq * density);
    [sin_theta_i, v, w, density * inv_cos, r * by, g * by, b * by]
}
