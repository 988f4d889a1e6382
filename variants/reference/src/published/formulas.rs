//! Choice of a bell and of a sampler at run time.

use super::shape::Shape;
use super::{HairReference, MatchedReference};
use crate::interface::Reference;
use crate::real::Real;
use hairis::params::HairDesc;

/// The published model with a bell and a sampler chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HairFormulas {
    /// Bell of the lobes.
    pub shape: Shape,
    /// Number of bands of the matched sampler, 5, 9 or 25; `None` for the published sampler.
    pub bands: Option<usize>,
    /// True if the matched sampler chooses lobes by channel.
    pub by_channel: bool,
}

impl HairFormulas {
    /// Computes the constants of `parameters` and `wo` for the chosen bell and sampler.
    ///
    /// # Panics
    ///
    /// Panics if there is no matched sampler with this number of bands.
    #[must_use]
    pub fn prepare<T: Real>(&self, parameters: &HairDesc<T>, wo: [T; 3]) -> Box<dyn Reference<T>> {
        let Some(bands) = self.bands else {
            return Box::new(HairReference::prepare(parameters, self.shape, wo));
        };
        let matched = MatchedReference::prepare(parameters, self.shape, wo, bands);
        Box::new(if self.by_channel {
            matched.by_channel()
        } else {
            matched
        })
    }
}
