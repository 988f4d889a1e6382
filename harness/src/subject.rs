//! The models under comparison by name, each beside its textbook twin, and the hair and directions that comparisons draw.

use crate::sampler::Sampler;
use crate::sequence::Independent;
use core::f32::consts::PI;
use glam::Vec3;
use hairis::textbook::{Oracle, Parameters, Real, Shape};
use hairis::{Bell, Gaussian, Hair, HairDesc, HairParams, Matched, MatchedBell, Model, ParamError};
use hairis_variants::Cauchy;
use serde::Serialize;

/// The models compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ModelKind {
    /// The published model.
    Gaussian,
    /// The all-Cauchy variant with the same widths.
    Cauchy,
}

impl ModelKind {
    /// Every model, in the order of reports.
    pub const ALL: [Self; 2] = [Self::Gaussian, Self::Cauchy];

    /// Name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Gaussian => "gaussian",
            Self::Cauchy => "cauchy",
        }
    }

    /// Name in titles and sentences.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Gaussian => "Gaussian",
            Self::Cauchy => "Cauchy",
        }
    }

    /// Its bell in the textbook.
    pub(crate) const fn shape(self) -> Shape {
        match self {
            Self::Gaussian => Shape::Gaussian,
            Self::Cauchy => Shape::Cauchy,
        }
    }

    pub(crate) fn index(self) -> u64 {
        match self {
            Self::Gaussian => 0,
            Self::Cauchy => 1,
        }
    }
}

/// A model that takes the published parameters, and what the textbook needs to be the same model.
#[derive(Clone, Copy, Debug)]
pub struct Subject<M> {
    /// The model's name in tables and in JSON.
    pub name: &'static str,
    /// The kernel's sampler.
    pub sampler: Sampler,
    /// The kernel.
    pub model: M,
    /// The textbook's bell.
    pub shape: Shape,
    /// Factor on every width, the kernel's own.
    pub width_factor: f32,
}

impl Subject<Hair<Gaussian>> {
    /// The published model.
    #[must_use]
    pub fn gaussian() -> Self {
        Self::of("gaussian", Gaussian, Shape::Gaussian)
    }
}

impl Subject<Hair<Cauchy>> {
    /// The all-Cauchy variant with the Gaussian model's own widths.
    #[must_use]
    pub fn cauchy() -> Self {
        Self::of("cauchy", Cauchy::PAPER, Shape::Cauchy)
    }
}

impl<B: Bell> Subject<Hair<B>> {
    fn of(name: &'static str, bell: B, shape: Shape) -> Self {
        let width_factor = bell.width_factor();
        Self { name, sampler: Sampler::Ou, model: Hair(bell), shape, width_factor }
    }
}

impl<B: MatchedBell> Subject<Hair<B>> {
    /// The same model with the sampler matched to it, the default one.
    #[must_use]
    pub fn matched(self) -> Subject<Matched<B>> {
        let Self { name, model: Hair(bell), shape, width_factor, .. } = self;
        Subject { name, sampler: Sampler::Matched, model: Matched(bell), shape, width_factor }
    }
}

impl<M: Model<Params = HairParams>> Subject<M> {
    /// The textbook's parameters for this hair, exact in `f64`.
    #[must_use]
    pub fn parameters<T: Real>(&self, hair: &HairParams) -> Parameters<T> {
        Parameters::from(hair).with_width_factor(T::from_f32(self.width_factor))
    }

    /// The oracle: the textbook in `f64` for this hair seen from `wo`, with the same sampler.
    #[must_use]
    pub fn oracle(&self, hair: &HairParams, wo: Vec3) -> Oracle<f64> {
        Oracle::prepare(&self.parameters(hair), self.shape, to_f64(wo), self.sampler.bands())
    }
}

/// The components in double precision.
#[must_use]
pub fn to_f64(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}

/// A direction at `sin_theta` above the normal plane, of cosine `cos_theta`, at azimuth `phi` rad.
///
/// The components are formed in `f64` and rounded, so that those of a direction near the axis keep their digits.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is the purpose")]
pub fn direction(sin_theta: f64, cos_theta: f64, phi: f64) -> Vec3 {
    Vec3::new(sin_theta as f32, (cos_theta * phi.cos()) as f32, (cos_theta * phi.sin()) as f32)
}

/// A direction uniform on the sphere.
pub fn uniform_direction(xi: &mut Independent) -> Vec3 {
    let sin_theta = 2.0 * xi.next_f64() - 1.0;
    let phi = core::f64::consts::TAU * xi.next_f64();
    direction(sin_theta, (1.0 - sin_theta * sin_theta).sqrt(), phi)
}

/// Hair drawn over the range of the everyday: widths log-uniform in 1 to 30 degrees, shifts uniform within 15 degrees,
/// glints at 10 to 80 degrees and of strength 0.1 to 10 (log-uniform), colours uniform in `[0, 1)`.
///
/// # Errors
///
/// Never: every range lies within those accepted.
pub fn random_hair(xi: &mut Independent) -> Result<HairParams, ParamError> {
    const DEG: f32 = PI / 180.0;
    let mut shift = || (30.0 * xi.next_f32() - 15.0) * DEG;
    let [alpha_r, alpha_tt, alpha_trt] = [shift(), shift(), shift()];
    let mut width = || 30.0_f32.powf(xi.next_f32()) * DEG;
    let [beta_r, beta_tt, beta_trt, gamma_tt, gamma_g] = [width(), width(), width(), width(), width()];
    let mut color = || [xi.next_f32(), xi.next_f32(), xi.next_f32()];
    let [intensity_r, intensity_tt, intensity_trt] = [color(), color(), color()];
    HairParams::new(&HairDesc {
        alpha_r,
        alpha_tt,
        alpha_trt,
        beta_r,
        beta_tt,
        beta_trt,
        gamma_tt,
        gamma_g,
        phi_g: (10.0 + 70.0 * xi.next_f32()) * DEG,
        intensity_r,
        intensity_tt,
        intensity_trt,
        intensity_g: 0.1 * 100.0_f32.powf(xi.next_f32()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_hair_is_accepted_and_differs() {
        let mut xi = Independent::new(3, 0);
        let hair: Vec<HairParams> = (0..1_000).map(|_| random_hair(&mut xi).expect("within range")).collect();
        assert!(hair.windows(2).all(|pair| pair[0] != pair[1]), "two draws are the same hair");
    }

    #[test]
    fn directions_are_unit() {
        let mut xi = Independent::new(3, 1);
        for _ in 0..1_000 {
            let length = uniform_direction(&mut xi).length();
            assert!((length - 1.0).abs() < 3e-7, "length {length}");
        }
    }
}
