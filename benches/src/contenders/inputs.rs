//! Arguments of all calls, drawn before anything is timed.

use glam::Vec3;
use hairis::ParamError;
use hairis_variants::{Parameters, Values};

/// Number of directions per pass, enough for packets of shading points with 16 samples each. With their numbers `xi` they take 21 KB.
pub const TIMED_DIRECTIONS: usize = 896;

/// Inputs of the timed operations: [`TIMED_DIRECTIONS`] directions and numbers, all lanes different, and eight sets of parameters.
#[derive(Clone, Debug)]
pub struct TimedInputs<P = Values> {
    /// Directions towards the light.
    pub wi: Vec<Vec3>,
    /// Directions towards the viewer.
    pub wo: Vec<Vec3>,
    /// Triples of uniform random numbers.
    pub xi: Vec<[f32; 3]>,
    /// Parameters of the eight lanes; the first set is used by all operations on one material.
    pub params: [P; 8],
    /// Default parameters with lobes so narrow (half a degree on hair) that almost all directions lie in their far tails, where
    /// intermediate results would be denormal if denormals were not avoided.
    pub narrow: P,
}

impl TimedInputs {
    /// Converts the parameters to those of a model, and checks the number of inputs.
    pub(super) fn typed<P: Parameters>(&self) -> Result<TimedInputs<P>, ParamError> {
        let Self {
            wi,
            wo,
            xi,
            params,
            narrow,
        } = self.clone();
        let counts = [wi.len(), wo.len(), xi.len()];
        assert_eq!(
            counts, [TIMED_DIRECTIONS; 3],
            "directions to and fro, and triples of numbers"
        );
        let (narrow, mut typed) = (P::from_values(&narrow)?, [P::default(); 8]);
        for (typed, values) in typed.iter_mut().zip(&params) {
            *typed = P::from_values(values)?;
        }
        Ok(TimedInputs {
            wi,
            wo,
            xi,
            params: typed,
            narrow,
        })
    }
}
