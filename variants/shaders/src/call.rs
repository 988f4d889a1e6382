//! Names of what a program is for, and of what it does.

/// Arithmetic of the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// Products and sums round apart: the bits of one lane.
    Exact,
    /// Products with sums round once: the bits of a level that fuses.
    Fused,
    /// Products with sums may round once or twice, as `fma` of WGSL.
    Gpu,
    /// As [`Gpu`](Self::Gpu), with `exp2` and `log2` of the target.
    GpuNative,
}

/// A function of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Call {
    /// Parameters to the constants of a material; of models of the list alone.
    Material,
    /// Material and hit to the constants of a shading point.
    Prepare,
    /// Value and density at a direction.
    Eval,
    /// A sampled direction.
    Sample,
    /// Value, colour and density of each lobe at a direction.
    Lobes,
    /// [`Prepare`](Self::Prepare) and [`Eval`](Self::Eval) in one.
    EvalHit,
    /// [`Prepare`](Self::Prepare) and [`Sample`](Self::Sample) in one.
    SampleHit,
    /// [`Prepare`](Self::Prepare), [`Eval`](Self::Eval) and [`Sample`](Self::Sample) in one: a bounce with one light.
    EvalSampleHit,
}

impl Call {
    /// Every function.
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

    /// Purpose, in a line.
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

    /// Name.
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
