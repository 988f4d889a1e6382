//! Calls of a model that become functions of its program.

use crate::program::dual::PURPOSES;

/// Function of a model that a program provides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Call {
    /// Computes the constants of a material from parameters; available only for models of the list.
    Material,
    /// Computes the constants of a shading point from a material and a hit.
    Prepare,
    /// Evaluates value and density at a direction.
    Eval,
    /// Draws a direction, and returns it with its value, density and weight.
    Sample,
    /// Evaluates the value, the colour and the density of each lobe at a direction.
    Lobes,
    /// Combines [`Prepare`](Self::Prepare) and [`Eval`](Self::Eval) in one function.
    EvalHit,
    /// Combines [`Prepare`](Self::Prepare) and [`Sample`](Self::Sample) in one function.
    SampleHit,
    /// Combines [`Prepare`](Self::Prepare), [`Eval`](Self::Eval) and [`Sample`](Self::Sample): a bounce with one light.
    EvalSampleHit,
}

impl Call {
    /// Every function, in the order in which a program prints them.
    pub const ALL: [Self; 8] = [
        Self::Material,
        Self::Prepare,
        Self::Eval,
        Self::Sample,
        Self::Lobes,
        Self::EvalHit,
        Self::SampleHit,
        Self::EvalSampleHit,
    ];

    /// Returns the purpose of the function as one line, which is printed as a comment above it.
    #[must_use]
    pub const fn purpose(self) -> &'static str {
        match self {
            Self::Material => {
                "Constants of a material: once per material. Parameters are not checked; their ranges are beside them."
            }
            Self::Prepare => "Constants of a shading point: material and hit.",
            Self::Eval => "Value (without the cosine) and density at wi.",
            Self::Sample => {
                "A direction drawn with three uniform numbers in [0, 1); slot -1: discarded."
            }
            Self::Lobes => "Value without its colour, colour and density of each lobe at wi.",
            Self::EvalHit => "Value (without the cosine) and density at wi, of a hit.",
            Self::SampleHit => {
                "A direction drawn at a hit with three uniform numbers in [0, 1); slot -1: discarded."
            }
            Self::EvalSampleHit => "Value and density at wi, and a direction drawn, of a hit.",
        }
    }

    /// Returns the name of the function without the name of the model.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Material => "material",
            Self::Prepare => "prepare",
            Self::Eval => "eval",
            Self::Sample => "sample",
            Self::Lobes => "lobes",
            Self::EvalHit => "eval_hit",
            Self::SampleHit => "sample_hit",
            Self::EvalSampleHit => "eval_sample_hit",
        }
    }
}

/// Returns the purpose of a function by its name, of a model or of dual scattering.
pub(crate) fn purpose(name: &str) -> Option<&'static str> {
    let of_models = Call::ALL
        .into_iter()
        .map(|call| (call.name(), call.purpose()));
    (of_models.chain(PURPOSES)).find_map(|(one, purpose)| (one == name).then_some(purpose))
}
