//! Kajiya and Kay's fibre: a diffuse cylinder and a cone of highlights.

mod fields;
mod params;

pub use params::{Form, KajiyaKayDesc, KajiyaKayParams, cosine_integral};

use core::f32::consts::{FRAC_1_PI, FRAC_PI_2, LN_2, PI};
use hairis::model::math::{
    GAUSS_LEGENDRE_32, gaussian, gaussian_and_complement, half_atan2, log2_near_one, log2_one_plus,
    sin_cos_half_turn,
};
use hairis::model::{Direction, LobeEval, LobeModel, Precision};
use hairis::simd::{Broadcast, Choice, Lanes, Scalar, lane_struct, lanes3};
use hairis::{Hit, PerLobe};

/// Model of Kajiya & Kay 1989, normalised, in a reciprocal form and in the form of the publication.
///
/// `S = kd / pi^2 + ks cos^p(theta_i + theta_o) / (2 pi B(p + 2))`; the published form has `B(p + 1) cos theta_i` in place of
/// `B(p + 2)`. `B(n)` is the integral of `cos^n` over `[-pi/2, pi/2]`, and a negative cosine counts as 0.
///
/// - Lobes: "diffuse" in slot 0, "specular" in slot 1.
/// - Sampling: densities are exact. The density of the diffuse lobe is proportional to `cos theta_i`. The specular lobe draws
///   `theta_i + theta_o` in proportion to `cos^p`, and its sign in proportion to the remaining cosines. Azimuths are uniform.
/// - Weights: at most `kd` over the probability of the diffuse lobe plus `ks (p + 2) / (p + 1)` over that of the specular lobe.
/// - Source: Kajiya & Kay 1989, with corrections of the errors in later texts: see `ERRATA.md` of this package.
/// - Accuracy: value and density are accurate to 2e-5 for exponents from 2 to 1000, further than 1e-3 rad from the axis, where `kd` is
///   a fiftieth or more. With exponents below 2 the density may be off by `6e-6 / cos theta_i`, where `theta_i + theta_o` is a right
///   angle. The specular lobe alone is accurate to `3e-6 + p (1.2e-7 + 2.4e-7 tan x - 4e-7 ln cos x)`,
///   `x = |theta_i + theta_o|`: the slope of `cos^p x` times the rounding of an angle, and the rounding of cosine and exponent.
///
/// ```
/// use glam::Vec3;
/// use hairis::Material;
/// use hairis_variants::{KajiyaKay, KajiyaKayParams};
/// let hair = Material::new(&KajiyaKay, &KajiyaKayParams::brown());
/// let sample = hair.prepare(Vec3::new(0.6, 0.8, 0.0)).sample([0.5, 0.25, 0.75]).expect("not along the fibre");
/// assert!(sample.weight.iter().all(|w| *w > 0.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KajiyaKay;

lane_struct! {
    /// Constants of a material of Kajiya and Kay's model.
    pub struct KajiyaKayMaterial {
        /// Diffuse albedo, linear RGB.
        kd: [C; 3],
        /// Specular albedo, linear RGB.
        ks: [C; 3],
        /// Mean of the channels of `kd` and of `ks`.
        mean: [C; 2],
        /// 1 for the reciprocal form, 0 for the published one.
        reciprocal: C,
        /// Factor `-p ln 2` from `log2 cos^2` to the argument of a Gaussian that equals `cos^p`.
        exponent: C,
        /// Factor from `log2 (1 - xi)` to the argument of a Gaussian that equals `(1 - xi)^(2/p)`.
        inv_exponent: C,
        /// Peak of the specular value.
        peak: C,
        /// Constant factor of the specular density.
        density: C,
        /// Share of `sin^2 theta_o` in the estimate of the specular albedo.
        grazing: C,
    }
}

lane_struct! {
    /// Constants of a shading point of Kajiya and Kay's model.
    pub struct KajiyaKayPrepared {
        /// Sine and cosine of `theta_o`.
        theta_o: [C; 2],
        /// Sampling weights of the lobes.
        weights: [C; 2],
        /// Constants of the material.
        material: KajiyaKayMaterial<C>,
    }
}

/// Returns `cos theta` squared for the reciprocal form, and `cos theta` for the published form.
#[inline(always)]
fn power<L: Lanes>(reciprocal: L::Mask, cos: L) -> L {
    cos * L::select(reciprocal, cos, L::splat(1.0))
}

/// Computes the constants of a material; the mask is set for the reciprocal form.
#[inline]
fn constants<W: Precision>(
    kd: [W::Lane; 3],
    ks: [W::Lane; 3],
    exponent: W::Lane,
    reciprocal: <W::Lane as Lanes>::Mask,
) -> KajiyaKayMaterial<W::Lane> {
    let (c, one) = (W::constant, W::constant(1.0));
    let lane = <W::Lane as Lanes>::splat;
    W::Lane::stage("integrals of powers of the cosine");
    let p = W::of(exponent);
    let b = cosine_integral(p + one);
    let m = W::select(reciprocal, c(2.0), one);
    let narrowing = W::select(reciprocal, one, (p + one) * b * b);
    let pi = c(core::f64::consts::PI);
    KajiyaKayMaterial {
        kd,
        ks,
        mean: [kd, ks].map(|rgb| {
            let [r, g, b] = rgb.map(|x| <W::Lane as Lanes>::quotient(x, lane(3.0)));
            r + g + b
        }),
        reciprocal: <W::Lane as Lanes>::keep(reciprocal, lane(1.0)),
        exponent: exponent * -LN_2,
        inv_exponent: <W::Lane as Lanes>::quotient(lane(-4.0 * LN_2), exponent),
        peak: (c(0.5) / (pi * cosine_integral(p + m))).rounded(),
        density: (one / (pi * cosine_integral(p))).rounded(),
        grazing: (one / ((p + one) * narrowing)).rounded(),
    }
}

impl LobeModel for KajiyaKay {
    type Params = KajiyaKayParams;
    type Material<C: Scalar> = KajiyaKayMaterial<C>;
    type Prepared<C: Scalar> = KajiyaKayPrepared<C>;

    const LOBES: &'static [&'static str] = &["diffuse", "specular"];
    const CONSERVES: bool = true;

    #[inline]
    fn material(&self, params: &KajiyaKayParams) -> KajiyaKayMaterial<f32> {
        let KajiyaKayDesc {
            kd,
            ks,
            exponent,
            form,
        } = *params.desc();
        constants::<f64>(kd, ks, exponent, form == Form::Reciprocal)
    }

    #[inline(always)]
    fn prepare<L: Lanes, C: Broadcast<L>>(
        m: &KajiyaKayMaterial<C>,
        hit: Hit<L>,
    ) -> KajiyaKayPrepared<L::Stored> {
        let Direction {
            sin_theta,
            cos_theta,
            ..
        } = Direction::normalized(hit.wo);
        L::stage("estimate of each lobe's albedo");
        let returned = cos_theta.mul_add(cos_theta, sin_theta * sin_theta * m.grazing.lanes());
        let reciprocal = L::splat(0.5).lt(m.reciprocal.lanes());
        let specular = m.mean[1].lanes() * L::select(reciprocal, returned, returned.sqrt());
        KajiyaKayPrepared {
            theta_o: [sin_theta.store(), cos_theta.store()],
            weights: [m.mean[0].lanes().store(), specular.store()],
            material: m.spread::<L>(),
        }
    }

    #[inline(always)]
    fn weights<L: Lanes, C: Broadcast<L>>(prepared: &KajiyaKayPrepared<C>) -> PerLobe<L> {
        PerLobe::padded(
            [prepared.weights[0].lanes(), prepared.weights[1].lanes()],
            L::splat(0.0),
        )
    }

    #[inline(always)]
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &KajiyaKayPrepared<C>,
        wi: &Direction<L>,
    ) -> PerLobe<LobeEval<L>> {
        let (c, zero, one) = (L::splat, L::splat(0.0), L::splat(1.0));
        let (m, [sin_o, cos_o]) = (
            &prepared.material,
            [prepared.theta_o[0].lanes(), prepared.theta_o[1].lanes()],
        );
        let (sin_i, cos_i) = (wi.sin_theta, wi.cos_theta);
        let reciprocal = c(0.5).lt(m.reciprocal.lanes());

        L::stage("cos^p of the sum of the inclinations");
        // Uses the sine where it is small, because p magnifies the rounding of the cosine.
        let sin = sin_i.mul_add(cos_o, cos_i * sin_o);
        let cos = L::difference_of_products(cos_i, cos_o, sin_i, sin_o);
        // The bell is at most 1 even for directions longer than unit length, so that no power overflows.
        let s = zero.max(log2_near_one(cos * cos, -(sin * sin)) * m.exponent.lanes());
        let bell = L::keep(zero.lt(cos), gaussian(s));

        L::stage("value and density of both lobes");
        // Density over both signs of the sum; one division serves both the density and 1 / cos theta_i.
        let mirrored = zero.max(cos.mul_sub(cos_o, sin * sin_o));
        let both = power(reciprocal, cos_i) + power(reciprocal, mirrored);
        let inverse = L::quotient(one, both * cos_i);
        let value = bell * m.peak.lanes() * L::select(reciprocal, one, inverse * both);
        let pdf = bell * m.density.lanes() * (inverse * cos_i) * L::select(reciprocal, cos_i, one);

        let flat = c(FRAC_1_PI * FRAC_1_PI);
        let diffuse = LobeEval::new(flat, lanes3(&m.kd), flat * cos_i);
        let specular = LobeEval::new(value, lanes3(&m.ks), pdf);
        PerLobe::padded([diffuse, specular], LobeEval::none())
    }

    #[inline(always)]
    fn sample_lobe<L: Lanes, C: Broadcast<L>>(
        prepared: &KajiyaKayPrepared<C>,
        lobe: L::Index,
        xi: [L; 3],
    ) -> Direction<L> {
        let (c, zero, one) = (L::splat, L::splat(0.0), L::splat(1.0));
        let [sin_o, cos_o] = [prepared.theta_o[0].lanes(), prepared.theta_o[1].lanes()];
        let is_diffuse = lobe.equals(0);
        let reciprocal = c(0.5).lt(prepared.material.reciprocal.lanes());

        L::stage("sum of the inclinations, by the polar method");
        // The polar method for a power of the cosine, which is 2 for the diffuse lobe and p for the specular lobe. `rest` is 1
        // minus the squared radius of a point in the disk.
        let (rest, radius_sq) =
            gaussian_and_complement(log2_one_plus(-xi[1]) * prepared.material.inv_exponent.lanes());
        let (rest, radius_sq) = (
            L::select(is_diffuse, one - xi[1], rest),
            L::select(is_diffuse, xi[1], radius_sq),
        );
        let (sin_turn, cos_turn) = sin_cos_half_turn((c(0.5) - xi[0]) * PI);
        let sin = radius_sq.sqrt() * sin_turn;
        let cos = (radius_sq * cos_turn).mul_add(cos_turn, rest).sqrt();

        L::stage("sign of the sum");
        // Each sign is chosen in proportion to the cosine that the power leaves out.
        let minus = cos.mul_add(cos_o, sin * sin_o);
        let plus = L::difference_of_products(cos, cos_o, sin, sin_o);
        let (kept, turned) = (
            power(reciprocal, zero.max(minus)),
            power(reciprocal, zero.max(plus)),
        );
        let scaled = xi[2] * (kept + turned);
        let keep = scaled.lt(kept);
        let into = L::select(keep, scaled, scaled - kept);
        let again = L::quotient(
            into,
            L::select(keep, kept, turned).max(c(f32::MIN_POSITIVE)),
        );
        let sum = L::select(keep, sin, -sin);
        let sin_i = sum.mul_sub(cos_o, cos * sin_o);
        let cos_i = zero.max(L::select(keep, minus, plus));

        L::stage("direction at this inclination, at a uniform azimuth");
        let theta = [
            L::select(is_diffuse, sin, sin_i),
            L::select(is_diffuse, cos, cos_i),
        ];
        Direction::with_uniform_azimuth(theta, L::select(is_diffuse, xi[2], again))
    }

    /// Returns `kd` for the diffuse lobe. The albedo of the specular lobe is a quadrature of 32 nodes over the sum `x` of the
    /// inclinations, out to where `cos^p x` is 1e-9 and the light is on the sphere. Its accuracy is 1e-6 of `ks`.
    #[inline(always)]
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &KajiyaKayPrepared<C>) -> PerLobe<[L; 3]> {
        let (c, zero, half_turn) = (L::splat, L::splat(0.0), L::splat(FRAC_PI_2));
        let (m, [sin_o, cos_o]) = (
            &prepared.material,
            [prepared.theta_o[0].lanes(), prepared.theta_o[1].lanes()],
        );
        let reciprocal = c(0.5).lt(m.reciprocal.lanes());
        let theta_o = half_atan2(sin_o, cos_o, c(1.0)) * 2.0;
        let reach = half_turn.min(c(6.5) * L::quotient(c(-LN_2), m.exponent.lanes()).sqrt());
        let (lo, hi) = (
            (theta_o - half_turn).max(-reach),
            (theta_o + half_turn).min(reach),
        );
        let mut sum = zero;
        for (x, weight) in GAUSS_LEGENDRE_32 {
            let (sin, cos) = sin_cos_half_turn((hi - lo).mul_add(c(x), lo));
            let bell = gaussian(log2_near_one(cos * cos, -(sin * sin)) * m.exponent.lanes());
            let cos_i = zero.max(cos.mul_add(cos_o, sin * sin_o));
            sum = (bell * power(reciprocal, cos_i)).mul_add(c(weight), sum);
        }
        let returned = sum * (hi - lo) * m.peak.lanes() * (2.0 * PI);
        let (kd, [r, g, b]) = (lanes3(&m.kd), lanes3(&m.ks));
        PerLobe::padded([kd, [r * returned, g * returned, b * returned]], [zero; 3])
    }
}
