//! Dual scattering: light that many fibres have scattered, in closed form, for renderers that trace no paths.
//!
//! Zinke et al. 2008 split the light that reaches a fibre inside a mass of hair into what crossed other fibres on its way
//! ([`Crossed`], their global part) and what comes back from those behind ([`Local`], their local part). Both follow from six
//! [`Averages`] of one fibre, which [`DualScattering`] keeps as polynomials of the inclination. The chapter
//! [dual scattering](crate::guide::dual_scattering) has the formulas, and says where they differ from the paper's.

mod crossed;
mod local;
mod measure;

pub use crossed::Crossed;
pub use local::Local;
pub use measure::{Draw, albedo_and_forward};

use crate::handle::Material;
use crate::model::math::{atan2_upper, gaussian, half_atan2};
use crate::model::{Direction, LobeMask, Model};
use crate::simd::{Broadcast, Lanes, Vec3x, lane_struct};
use core::f32::consts::{FRAC_1_PI, FRAC_2_PI, FRAC_PI_2, PI};
use measure::{measure, polynomials};

/// Number of coefficients of each polynomial.
pub const TERMS: usize = 10;
/// Number of quantities that [`Averages`] have per channel.
pub const QUANTITIES: usize = 8;

/// Factor on the light of both parts, fitted to paths of any length through blond and brown hair: see the chapter. Zinke et al. 2008 have
/// "density factors" of 0.7 in its place.
pub const GAIN: f32 = 1.15;

/// Smallest variance of an inclination, rad^2: that of a lobe of a third of a degree.
const LEAST_VARIANCE: f32 = 3e-5;

lane_struct! {
    /// Averages of a fibre's scattering as polynomials of the inclination of the light: constants of a material.
    ///
    /// ```
    /// use hairis::dual_scattering::{Crossed, GAIN, DualScattering};
    /// use hairis::{Conserving, Gaussian, HairParams, Matched, Material};
    /// let hair = Material::new(&Conserving(Matched::new(Gaussian)), &HairParams::blond());
    /// let dual = DualScattering::new(&hair);
    /// let (wo, wi) = (glam::Vec3::new(0.6, 0.8, 0.0), glam::Vec3::new(-0.6, 0.0, 0.8));
    /// // The light has crossed 3 fibres that are inclined to it as this one is.
    /// let crossed = Crossed::strands(&dual.averages(-0.64), 3.0);
    /// let single = hair.prepare(wo).eval(wi);
    /// let value = dual.shade(wo.into(), wi.into(), single, &crossed, [GAIN; 2]);
    /// assert!(value[0] > value[2] && value[2] > 0.0);
    /// ```
    pub struct DualScattering {
        /// Coefficients from the constant upwards, of the inclination over a right angle: for each quantity in the order of
        /// [`Averages`], and for each channel.
        pub coefficients: [[[C; TERMS]; 3]; QUANTITIES],
    }
}

/// Averages of the light that a fibre scatters to one side: linear RGB, one array entry per channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side<L = f32> {
    /// Share of the light that arrives.
    pub albedo: [L; 3],
    /// Mean of `theta_i + theta_o`, rad.
    pub shift: [L; 3],
    /// Variance of `theta_i + theta_o`, rad^2.
    pub variance: [L; 3],
}

/// Averages of a fibre's scattering at one inclination of the light.
///
/// The azimuth of the light is uniform over the half turn in front of a mass of hair, so that light which turns by the azimuth `phi`
/// goes on with the probability `|phi| / pi` (180 degrees: straight on), and back otherwise. The albedos of both sides sum to that of
/// the fibre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Averages<L = f32> {
    /// Light that goes on into the hair.
    pub forward: Side<L>,
    /// Light that goes back.
    pub backward: Side<L>,
    /// Means of `cos(phi)` and `cos(3 phi)` of the scattered light, times the fibre's albedo.
    pub azimuth: [[L; 3]; 2],
}

impl DualScattering<f32> {
    /// Measures the averages of a material and fits the polynomials to them. Takes about ten milliseconds, once per material; with a
    /// near-field model the offset of the hit is averaged as well.
    #[must_use]
    #[inline(never)]
    pub fn new<M: Model>(material: &Material<M>) -> Self {
        Self::measured(M::LOBES.len(), &mut |hit, lobe, xi, out| {
            let bsdf = material.prepare(hit).with_lobes(LobeMask::of(&[lobe]));
            let drawn = bsdf.sample_columns(xi, out);
            debug_assert!(drawn.is_ok(), "columns of one length");
        })
    }

    /// Measures the averages like [`new`](Self::new) by a function that draws samples of a lobe at a hit, for models chosen at run time.
    /// The model has the lobes of the first `lobes` slots.
    #[must_use]
    #[inline(never)]
    pub fn measured(lobes: usize, draw: &mut Draw<'_>) -> Self {
        Self {
            coefficients: polynomials(lobes, draw),
        }
    }

    /// Multiplies all scattered light by a factor, as of a host that scales S.
    #[inline]
    pub fn scale(&mut self, factor: f32) {
        for quantity in [0, 1, 6, 7] {
            let coefficients = self.coefficients[quantity].as_flattened_mut();
            coefficients.iter_mut().for_each(|number| *number *= factor);
        }
    }

    /// Returns the largest errors of the polynomials, channel by channel, at inclinations between those that they are fitted to.
    #[must_use]
    #[inline(never)]
    pub fn errors(&self, lobes: usize, draw: &mut Draw<'_>) -> Averages<f32> {
        let mut worst = [[0.0_f32; 3]; QUANTITIES];
        for step in 0_u8..24 {
            let theta = (f32::from(step) - 11.5) * (FRAC_PI_2 / 12.0);
            let (exact, fitted) = (measure(theta, lobes, draw), self.quantities::<f32>(theta));
            for (worst, (exact, fitted)) in worst.iter_mut().zip(exact.iter().zip(&fitted)) {
                for c in 0..3 {
                    worst[c] = worst[c].max((exact[c] - fitted[c]).abs());
                }
            }
        }
        Averages::from_quantities(worst)
    }
}

impl<C: Copy> DualScattering<C> {
    /// Evaluates the polynomials at an inclination of the light, rad. Albedos are at least 0, and variances above 0.
    #[inline(always)]
    #[must_use]
    pub fn averages<L: Lanes>(&self, theta: L) -> Averages<L>
    where
        C: Broadcast<L>,
    {
        let mut values = self.quantities::<L>(theta);
        let (zero, least) = (L::splat(0.0), L::splat(LEAST_VARIANCE));
        let mut c = 0;
        while c < 3 {
            values[0][c] = values[0][c].max(zero);
            values[1][c] = values[1][c].max(zero);
            values[4][c] = values[4][c].max(least);
            values[5][c] = values[5][c].max(least);
            c += 1;
        }
        Averages::from_quantities(values)
    }
}

impl<C: Copy> DualScattering<C> {
    /// Evaluates the polynomials, in the order of [`Averages`].
    #[inline(always)]
    fn quantities<L: Lanes>(&self, theta: L) -> [[L; 3]; QUANTITIES]
    where
        C: Broadcast<L>,
    {
        let x = (theta * FRAC_2_PI).min(L::splat(1.0)).max(L::splat(-1.0));
        let mut values = [[L::splat(0.0); 3]; QUANTITIES];
        let mut q = 0;
        while q < QUANTITIES {
            let mut c = 0;
            while c < 3 {
                let coefficients = &self.coefficients[q][c];
                let mut sum = coefficients[TERMS - 1].lanes();
                let mut term = TERMS - 1;
                while term > 0 {
                    term -= 1;
                    sum = sum.mul_add(x, coefficients[term].lanes());
                }
                values[q][c] = sum;
                c += 1;
            }
            q += 1;
        }
        values
    }

    /// Evaluates the light that reaches the viewer from `wi`, in place of S: the single scattering of light that comes there
    /// directly, light that crossed fibres, and light that comes back from those behind.
    ///
    /// - `wo`, `wi`: unit directions in the fibre's frame; along the fibre the result is 0.
    /// - `single`: S of the material at these directions, linear RGB, per steradian.
    /// - `crossed`: what fibres between the hit and the light do.
    /// - `gain`: factors on the light that crossed fibres and on the light that comes back: [`GAIN`], or 0 to leave a part out.
    /// - Result: a value like S, linear RGB, per steradian, to be multiplied by `cos theta_i` and the light's radiance.
    #[inline(always)]
    #[must_use]
    pub fn shade<L: Lanes>(
        &self,
        wo: Vec3x<L>,
        wi: Vec3x<L>,
        single: [L; 3],
        crossed: &Crossed<L>,
        gain: [L; 2],
    ) -> [L; 3]
    where
        C: Broadcast<L>,
    {
        let (one, half, zero) = (L::splat(1.0), L::splat(0.5), L::splat(0.0));
        let (o, i) = (Direction::normalized(wo), Direction::new(wi));
        let sound = L::and(o.is_sound(), i.is_sound());
        let theta_o = half_atan2(o.sin_theta, o.cos_theta, one);
        let theta_i = half_atan2(i.sin_theta, i.cos_theta, one);
        let (angle, theta) = (theta_o + theta_i, theta_i - theta_o);
        let angle = angle + angle;
        let averages = self.averages::<L>(theta);
        let local = averages.local();
        // cos(phi), cos(3 phi), and the shares of a viewer in front of the hair and behind it.
        let dot = o.vector.y.mul_add(i.vector.y, o.vector.z * i.vector.z);
        let cos = L::quotient(dot, (o.cos_theta * i.cos_theta).max(L::splat(1e-12)));
        let cos = cos.min(one).max(-one);
        let triple = cos * (cos * cos).mul_sub(L::splat(4.0), L::splat(3.0));
        let front = cos.mul_add(half, half);
        // The mean over the visible half of a round mass of hair, of light from one azimuth and from the half turn about it.
        let sin = (one - cos * cos).max(zero).sqrt();
        let phi = atan2_upper(sin, cos);
        let round = (L::splat(PI) - phi).mul_add(cos, sin) * (PI / 8.0);
        let round_spread = cos.mul_add(L::splat(PI / 8.0), half);
        // cos^2 theta_d, as 1 + cos(2 theta_d) halved.
        let cosines = o
            .cos_theta
            .mul_sub(i.cos_theta, -(o.sin_theta * i.sin_theta));
        let cos_sq = cosines.mul_add(half, half).max(L::splat(1e-6));
        let per_cos_sq = L::quotient(one, cos_sq);
        let [before, behind] = gain;
        let mut value = [zero; 3];
        let mut c = 0;
        while c < 3 {
            let (forward, backward) = (&averages.forward, &averages.backward);
            let (shift, spread) = (crossed.shift[c], crossed.variance[c]);
            let inclined = |mean: L, variance: L| inclinations(angle, mean, variance, per_cos_sq);
            let (mean, variance) = (local.shift[c], local.variance[c]);
            let comes_back = local.albedo[c] * behind;
            let once = comes_back * round * inclined(mean, variance);
            let again = comes_back * round_spread * inclined(mean + shift, variance + spread);
            // Light from the half turn in front, to the viewer's azimuth: the series of a fibre's azimuths times that of a half turn.
            let series =
                averages.azimuth[0][c].mul_sub(cos, averages.azimuth[1][c] * triple * (1.0 / 3.0));
            let total = forward.albedo[c] + backward.albedo[c];
            let spread_light = (total * half + series * FRAC_2_PI).max(zero).min(total);
            let ahead = forward.albedo[c] * (one - front);
            let back = backward.albedo[c] * front;
            let share = L::quotient(ahead, (ahead + back).max(L::splat(1e-12)));
            let ahead = share * inclined(forward.shift[c] + shift, forward.variance[c] + spread);
            let back =
                (one - share) * inclined(backward.shift[c] + shift, backward.variance[c] + spread);
            let scattered = before * crossed.scattered[c] * (spread_light * (ahead + back) + again);
            let multiple = crossed.direct.mul_add(once, scattered);
            let sum = multiple.mul_add(L::splat(FRAC_1_PI), crossed.direct * single[c]);
            value[c] = L::keep(sound, sum.min(L::splat(f32::MAX)));
            c += 1;
        }
        value
    }
}

/// Computes the share of light per inclination and squared cosine, for a sum of both inclinations with this mean and variance: a normal
/// density over the part of it that does not lead beyond the fibre's axis.
#[inline(always)]
fn inclinations<L: Lanes>(angle: L, mean: L, variance: L, per_cos_sq: L) -> L {
    /// Inverse root of a full turn.
    const NORM: f32 = 0.398_942_3;
    let one = L::splat(1.0);
    // Light that was shifted often does not turn beyond the axis, either.
    let mean = mean.min(one).max(-one);
    let inverse = L::quotient(one, variance);
    let distance = angle - mean;
    let normal = gaussian(distance * distance * inverse) * (inverse.sqrt() * NORM);
    // Integral of the normal density times exp(-3/4 x^2), which is near cos^2(x) / cos^2(x / 2).
    let within = L::quotient(one, variance.mul_add(L::splat(1.5), one));
    let kept = gaussian(mean * mean * within * 1.5) * within.sqrt();
    L::quotient(normal * per_cos_sq, kept)
}

impl<L: Copy> Averages<L> {
    /// Makes averages of quantities in their order.
    #[inline(always)]
    const fn from_quantities(values: [[L; 3]; QUANTITIES]) -> Self {
        let [
            forward,
            backward,
            shift_f,
            shift_b,
            variance_f,
            variance_b,
            one,
            three,
        ] = values;
        Self {
            forward: Side {
                albedo: forward,
                shift: shift_f,
                variance: variance_f,
            },
            backward: Side {
                albedo: backward,
                shift: shift_b,
                variance: variance_b,
            },
            azimuth: [one, three],
        }
    }
}
