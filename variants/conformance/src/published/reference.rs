//! The reference with the sampler of the model under test.

use super::Formulas;
use hairis::reference::{HairReference, MatchedReference, Parameters, ReferenceSample};
use hairis::{Lobe, LobeMask, PerLobe};

/// The reference of a model, in double precision.
#[derive(Clone, Copy, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "one at a time lives on the stack of a test"
)]
pub enum PublishedReference {
    /// With the published sampler.
    Published(HairReference<f64>),
    /// With the matched one.
    Matched(MatchedReference<f64>),
}

macro_rules! both {
    ($($name:ident($($arg:ident: $type:ty),*) -> $out:ty;)*) => { $(
        /// As in the reference.
        #[must_use]
        pub fn $name(&self $(, $arg: $type)*) -> $out {
            match self {
                Self::Published(formulas) => formulas.$name($($arg),*),
                Self::Matched(formulas) => formulas.$name($($arg),*),
            }
        }
    )* };
}

impl PublishedReference {
    /// The reference for these parameters at the shading point of `wo`.
    #[must_use]
    pub fn prepare(formulas: &Formulas, parameters: &Parameters<f64>, wo: [f64; 3]) -> Self {
        let Formulas {
            shape,
            bands,
            by_channel,
        } = *formulas;
        let Some(bands) = bands else {
            return Self::Published(HairReference::prepare(parameters, shape, wo));
        };
        let formulas = MatchedReference::prepare(parameters, shape, wo, bands);
        Self::Matched(if by_channel {
            formulas.by_channel()
        } else {
            formulas
        })
    }

    both! {
        eval(wi: [f64; 3]) -> [f64; 3];
        pdf(wi: [f64; 3]) -> f64;
        lobe_values(wi: [f64; 3]) -> PerLobe<f64>;
        lobe_pdfs(wi: [f64; 3]) -> PerLobe<f64>;
        probabilities() -> PerLobe<f64>;
        sample(xi: [f64; 3]) -> ReferenceSample<f64>;
        cdf_theta(lobe: Lobe, theta_i: f64) -> f64;
        cdf_phi(lobe: Lobe, phi: f64) -> f64;
    }

    /// The bound of the matched sampler's weights.
    ///
    /// # Panics
    ///
    /// With the published sampler: its bound is in the tests of weights.
    #[must_use]
    pub fn weight_bound(&self, mask: LobeMask) -> f64 {
        match self {
            Self::Published(_) => panic!("the published sampler has a bound of its own"),
            Self::Matched(formulas) => formulas.weight_bound(mask),
        }
    }
}
