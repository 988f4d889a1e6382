//! The reference with any of the samplers of the kernels.

use super::{HairReference, MatchedReference, Parameters, Real, ReferenceSample, Shape};
use crate::{Lobe, PerLobe};

/// The model for one set of parameters and one `wo`, with one of the samplers of the kernels: the reference for a kernel.
///
/// ```
/// use hairis::{Gaussian, HairParams, Matched, Material, reference::Oracle, reference::Parameters, reference::Shape};
/// let params = HairParams::brown();
/// let oracle = Oracle::prepare(&Parameters::<f64>::from(&params), Shape::Gaussian, [0.0, 1.0, 0.0], Some(9));
/// let kernel = Material::new(&Matched::<_>(Gaussian), &params).prepare(glam::Vec3::Y).pdf(glam::Vec3::Z);
/// assert!((f64::from(kernel) / oracle.pdf([0.0, 0.0, 1.0]) - 1.0).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Oracle<T> {
    /// With the published sampler.
    Published(HairReference<T>),
    /// With the sampler matched to the model.
    Matched(MatchedReference<T>),
}

impl<T: Real> Oracle<T> {
    /// Computes the constants of `parameters` and `wo`. `bands` selects the matched sampler of so many bands.
    ///
    /// # Panics
    ///
    /// If there is no matched sampler of so many.
    #[inline]
    #[must_use]
    pub fn prepare(
        parameters: &Parameters<T>,
        shape: Shape,
        wo: [T; 3],
        bands: Option<usize>,
    ) -> Self {
        match bands {
            None => Self::Published(HairReference::prepare(parameters, shape, wo)),
            Some(bands) => Self::Matched(MatchedReference::prepare(parameters, shape, wo, bands)),
        }
    }

    pub(super) fn book(&self) -> &HairReference<T> {
        match self {
            Self::Published(book) => book,
            Self::Matched(book) => book.book(),
        }
    }

    /// S, linear RGB: the same with every sampler.
    #[inline]
    #[must_use]
    pub fn eval(&self, wi: [T; 3]) -> [T; 3] {
        match self {
            Self::Published(book) => book.eval(wi),
            Self::Matched(book) => book.eval(wi),
        }
    }

    /// Density of the sampler, per steradian.
    #[inline]
    #[must_use]
    pub fn pdf(&self, wi: [T; 3]) -> T {
        match self {
            Self::Published(book) => book.pdf(wi),
            Self::Matched(book) => book.pdf(wi),
        }
    }

    /// Density of each lobe alone, per steradian.
    #[inline]
    #[must_use]
    pub fn lobe_pdfs(&self, wi: [T; 3]) -> PerLobe<T> {
        match self {
            Self::Published(book) => book.lobe_pdfs(wi),
            Self::Matched(book) => book.lobe_pdfs(wi),
        }
    }

    /// The sample of three numbers of [0, 1).
    #[inline]
    #[must_use]
    pub fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
        match self {
            Self::Published(book) => book.sample(xi),
            Self::Matched(book) => book.sample(xi),
        }
    }

    /// Probability of a smaller inclination, and of a smaller azimuth, of those drawn from `lobe`; rad.
    #[inline]
    #[must_use]
    pub fn cdf(&self, lobe: Lobe, theta_i: T, phi: T) -> [T; 2] {
        match self {
            Self::Published(book) => [book.cdf_theta(lobe, theta_i), book.cdf_phi(lobe, phi)],
            Self::Matched(book) => [book.cdf_theta(lobe, theta_i), book.cdf_phi(lobe, phi)],
        }
    }

    /// The inclinations where the density jumps whatever the azimuth, rad.
    #[inline]
    pub fn jumps(&self) -> impl Iterator<Item = T> + '_ {
        let bands = match self {
            Self::Published(_) => None,
            Self::Matched(book) => Some(book.bands()),
        };
        bands.into_iter().flatten()
    }
}
