//! The far field as RTXCR has it, with its faults, for comparison.

use super::azimuth::{Fit, Passage, normal_reflectance, schlick};
use crate::interface::Reference;
use crate::real::Real;
use crate::steps::{Fixed, GRAZING, fixed, inclination};
use hairis_variants::DEonDesc;

/// Faults of RTXCR's far field that can be mended one by one: each is true as it is shipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RtxcrFaults {
    /// The diffuse lobe has the cosine of the integral twice.
    pub diffuse_cosine: bool,
    /// The Gaussian at the centre of TRT keeps its negative weight next to 30 degrees.
    pub negative_weight: bool,
    /// The Gaussians of TRT are cut off at half a turn and not normalised.
    pub cut_turn: bool,
    /// The sampler draws inclinations as if there was no tilt.
    pub sample_tilt: bool,
}

impl RtxcrFaults {
    /// Faults of the code as it is.
    pub const SHIPPED: Self = Self {
        diffuse_cosine: true,
        negative_weight: true,
        cut_turn: true,
        sample_tilt: true,
    };
    /// Formulas without these faults.
    pub const MENDED: Self = Self {
        diffuse_cosine: false,
        negative_weight: false,
        cut_turn: false,
        sample_tilt: false,
    };
}

/// Formulas of RTXCR's far field at one `wo`: the value, the density that it states, and the directions that it draws.
///
/// - Source: `HairFarFieldBCSDF.hlsli` of RTXCR's material library, revision 5041cfad, whose comments name d'Eon 2022. The paper itself was
///   not read.
/// - Density: [`eval_pdf`](Reference::eval_pdf) returns the stated density, which is the value without absorption. It is not the density
///   of [`draw`](Self::draw) and does not integrate to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RtxcrReference<T> {
    parameters: DEonDesc<T>,
    faults: RtxcrFaults,
    sin_theta_o: T,
    cos_theta_o: T,
    phi_o: T,
}

/// Least `cos(phi/2)` in the width of R.
const LEAST_SQUEEZE: f64 = 0.01;
/// Width of a fibre's edge that TT leaves out, as a factor on its last azimuth.
const EDGE: f64 = 2.001;

/// Density of a Gaussian.
fn gaussian<T: Real>(x: T, deviation: T) -> T {
    let z = x / deviation;
    (T::from_f64(-0.5) * z * z).exp() / (deviation * (T::PI + T::PI).sqrt())
}

/// Probability that a Gaussian about `place` lies within half a turn of 0.
fn within_turn<T: Real>(place: T, deviation: T) -> T {
    let half = T::from_f64(0.5);
    let beyond = |x: T| half * (x / (deviation * T::from_f64(2.0).sqrt())).erfc();
    T::from_f64(1.0) - beyond(T::PI - place) - beyond(T::PI + place)
}

impl<T: Real> RtxcrReference<T> {
    /// Prepares the formulas of `parameters` for `wo`.
    #[inline]
    #[must_use]
    pub fn prepare(parameters: &DEonDesc<T>, faults: RtxcrFaults, wo: [T; 3]) -> Self {
        let Fixed {
            sin_theta_o,
            cos_theta_o,
            phi_o,
        } = fixed(wo);
        Self {
            parameters: *parameters,
            faults,
            sin_theta_o,
            cos_theta_o,
            phi_o,
        }
    }

    /// Evaluates N of TRT at an azimuth in `[0, pi]`, for an angle of the fit.
    fn three_gaussians(&self, angle: T, phi: T) -> T {
        let (number, zero) = (T::from_f64, T::default());
        let fit = Fit::new(angle);
        let width = |variance: T| {
            self.parameters.roughness / number(0.06) * variance.max(number(1e-7)).sqrt()
        };
        let [outer, centre] = [fit.outer_variance, fit.centre_variance].map(width);
        let norm = |place: T, deviation: T| {
            if self.faults.cut_turn {
                number(1.0)
            } else {
                within_turn(place, deviation)
            }
        };
        let weight = if self.faults.negative_weight {
            fit.centre
        } else {
            fit.centre.max(zero)
        };
        let pair = gaussian(phi - fit.place, outer) + gaussian(phi + fit.place, outer);
        number(200.0) / T::PI
            * (fit.outer * pair / norm(fit.place, outer)
                + weight * gaussian(phi, centre) / norm(zero, centre))
    }

    /// Evaluates the diffuse lobe, and the sum of the others with and without absorption, all times the cosine of `wi`.
    fn times_cosine(&self, wi: [T; 3]) -> (T, [T; 3], T) {
        let number = T::from_f64;
        let (zero, half, one, two) = (T::default(), number(0.5), number(1.0), number(2.0));
        let DEonDesc {
            roughness,
            tilt,
            eta,
            sigma_a,
            ..
        } = self.parameters;
        let [sin_i, cos_i] = inclination(wi);
        let (sin_o, cos_o) = (self.sin_theta_o, self.cos_theta_o);
        let (theta_i, theta_o) = (sin_i.atan2(cos_i), sin_o.atan2(cos_o));
        let (theta_h, theta_d) = (half * (theta_o + theta_i), half * (theta_o - theta_i));
        let cos_phi = (wi[2].atan2(wi[1]) - self.phi_o).cos();
        let cos_half = ((one + cos_phi) * half).max(zero).sqrt();
        let sin_half = ((one - cos_phi) * half).max(zero).sqrt();
        let phi = two * sin_half.atan2(cos_half);
        let f0 = normal_reflectance(eta);
        let contrast = (eta - one) * (eta + one);
        let k = theta_d.cos();

        let between = sin_i * sin_o + cos_i * cos_o * cos_phi;
        let reflected = schlick(f0, ((one + between) * half).max(zero).sqrt());
        let width_r = roughness * cos_half.max(number(LEAST_SQUEEZE)) / two.sqrt();
        let r = gaussian(theta_h + tilt, width_r) * reflected * number(0.25) * cos_half;

        let width_tt = number(0.25) * roughness * (contrast.sqrt() / cos_i);
        let root = (contrast + k * k).sqrt();
        let [n_tt, cos_gamma_i, cos_gamma_t] = Passage::new(eta, k).at([sin_half, cos_half]);
        let passed = one - schlick(f0, k * cos_gamma_i);
        let seen = phi >= number(EDGE) * (k / root).asin();
        let tt = if seen {
            gaussian(theta_h - half * tilt, width_tt) * n_tt * passed * passed
        } else {
            zero
        };

        let width_trt = roughness * half * (two + theta_i.abs().powf(number(1.5)));
        let trt =
            gaussian(theta_h - number(1.5) * tilt, width_trt) * self.three_gaussians(theta_d, phi);

        let inv_cos_t = eta / root;
        let share = half * (one - self.parameters.diffuse) * cos_i / (k * k);
        let absorbed = sigma_a.map(|sigma| {
            let tt = tt * (-sigma * two * cos_gamma_t * inv_cos_t).exp();
            let trt = trt * (number(-3.75) * sigma * inv_cos_t).exp();
            (share * (r + tt + trt)).max(zero)
        });
        let cosines = if self.faults.diffuse_cosine {
            cos_i * cos_i
        } else {
            cos_i
        };
        let cylinder = ((T::PI - phi) * cos_phi + phi.sin()).abs();
        let diffuse = self.parameters.diffuse * cosines * cylinder * number(0.25) / T::PI;
        (diffuse, absorbed, diffuse + share * (r + tt + trt))
    }

    /// Draws a direction: `xi` has the offset `h`, the lobe, and two pairs for Gaussians.
    #[inline]
    #[must_use]
    pub fn draw(&self, xi: [T; 6]) -> [T; 3] {
        let number = T::from_f64;
        let (one, two) = (number(1.0), number(2.0));
        let DEonDesc {
            roughness,
            tilt,
            eta,
            sigma_a: [red, green, blue],
            ..
        } = self.parameters;
        let (sin_o, cos_o) = (self.sin_theta_o, self.cos_theta_o);
        let h = two * xi[0] - one;
        let f0 = normal_reflectance(eta);
        let root = |k: T| ((eta - one) * (eta + one) + k * k).sqrt();
        let sigma = number(0.2126) * red + number(0.7152) * green + number(0.0722) * blue;
        let reflected = schlick(f0, cos_o * ((one - h) * (one + h)).sqrt());
        let passed = one - reflected;
        let gamma_t = (h * cos_o / root(cos_o)).asin();
        // Twice the square of the cosine in place of the cosine (E11).
        let passage = (-two * sigma * (one + (two * gamma_t).cos()) * eta / root(cos_o)).exp();
        let r = reflected;
        let tt = passed * passed * passage;
        let trt = tt * reflected * passage;
        let normal = |a: T, b: T| two.sqrt() * (two * T::PI * a).cos() * (-(one - b).ln()).sqrt();
        let chosen = xi[1] * (r + tt + trt);
        let theta_o = sin_o.atan2(cos_o);
        let (tilts, width) = if chosen < r {
            (
                -2.0,
                two.sqrt() * roughness * ((one - h) * (one + h)).sqrt().max(number(LEAST_SQUEEZE)),
            )
        } else if chosen < r + tt {
            (
                1.0,
                roughness * ((eta - one) * (eta + one)).sqrt() / (two * cos_o),
            )
        } else {
            (3.0, roughness * (two + theta_o.abs().powf(number(1.5))))
        };
        let shift = if self.faults.sample_tilt {
            T::default()
        } else {
            number(tilts) * tilt
        };
        let theta_i = shift - theta_o + width * normal(xi[2], xi[3]);
        let k = (number(0.5) * (theta_i - theta_o)).cos();
        let inside = (h * k / root(k)).asin();
        let phi = if chosen < r {
            -two * h.asin()
        } else if chosen < r + tt {
            T::PI - two * h.asin() + two * inside
        } else {
            two * (inside + inside - h.asin()) + roughness * normal(xi[4], xi[5])
        };
        let phi_i = self.phi_o + phi;
        [
            theta_i.sin(),
            theta_i.cos() * phi_i.cos(),
            theta_i.cos() * phi_i.sin(),
        ]
    }
}

impl<T: Real> Reference<T> for RtxcrReference<T> {
    /// Evaluates S without the cosine, and the density that RTXCR states, per steradian.
    #[inline]
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
        let [_, cos_i] = inclination(wi);
        if cos_i < T::from_f64(GRAZING) {
            return ([T::default(); 3], T::default());
        }
        let (diffuse, value, pdf) = self.times_cosine(wi);
        let color = self.parameters.diffuse_color;
        (
            [0, 1, 2].map(|c| (value[c] + diffuse * color[c]) / cos_i),
            pdf,
        )
    }
}
