//! The textbook in double precision, with the sampler that a kernel is held against.

use hairis::Lobe;
use hairis::textbook::{Drawn, MatchedTextbook, Parameters, Shape, Textbook};

/// The textbook for one hair and one `wo`, with one of the samplers that have a twin in it.
#[derive(Clone, Debug)]
pub enum Oracle {
    /// With the published sampler.
    Published(Box<Textbook<f64>>),
    /// With the sampler matched to the model.
    Matched(Box<MatchedTextbook<f64>>),
}

impl Oracle {
    /// What is constant for `parameters` and `wo`; with the matched sampler if `bands` says of how many bands.
    #[must_use]
    pub fn prepare(parameters: &Parameters<f64>, shape: Shape, wo: [f64; 3], bands: Option<usize>) -> Self {
        match bands {
            None => Self::Published(Box::new(Textbook::prepare(parameters, shape, wo))),
            Some(bands) => Self::Matched(Box::new(MatchedTextbook::prepare(parameters, shape, wo, bands))),
        }
    }

    /// S, linear RGB: the same with every sampler.
    #[must_use]
    pub fn eval(&self, wi: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Published(book) => book.eval(wi),
            Self::Matched(book) => book.eval(wi),
        }
    }

    /// Density of the sampler, per steradian.
    #[must_use]
    pub fn pdf(&self, wi: [f64; 3]) -> f64 {
        match self {
            Self::Published(book) => book.pdf(wi),
            Self::Matched(book) => book.pdf(wi),
        }
    }

    /// The sample of three numbers of [0, 1).
    #[must_use]
    pub fn sample(&self, xi: [f64; 3]) -> Drawn<f64> {
        match self {
            Self::Published(book) => book.sample(xi),
            Self::Matched(book) => book.sample(xi),
        }
    }

    /// Probability of a smaller inclination, and of a smaller azimuth, of those drawn from `lobe`.
    #[must_use]
    pub fn cdf(&self, lobe: Lobe, theta_i: f64, phi: f64) -> [f64; 2] {
        match self {
            Self::Published(book) => [book.cdf_theta(lobe, theta_i), book.cdf_phi(lobe, phi)],
            Self::Matched(book) => [book.cdf_theta(lobe, theta_i), book.cdf_phi(lobe, phi)],
        }
    }

    /// The inclinations where the density jumps whatever the azimuth, rad.
    #[must_use]
    pub fn jumps(&self) -> Vec<f64> {
        match self {
            Self::Published(_) => Vec::new(),
            Self::Matched(book) => book.bands().collect(),
        }
    }
}
