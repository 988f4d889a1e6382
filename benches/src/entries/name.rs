//! Names of entry points.

use core::fmt;

/// Operation that an entry point performs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Op {
    /// Computes everything that is constant for one shading point.
    Prepare,
    /// Value and density of a direction.
    Eval,
    /// Sampled direction with its value, density and weight.
    Sample,
    /// Shading point with this number of samples.
    Path(usize),
    /// Candidates for rays: their directions, their weights and the choice among them.
    Resample,
    /// Hits with one call each, or columns of hits, on a material that conserves energy.
    Hits,
}

impl Op {
    /// Operations in the order of the benches; a path takes 1, 4 or 16 samples per shading point.
    pub const ALL: [Self; 8] = [
        Self::Prepare,
        Self::Eval,
        Self::Sample,
        Self::Path(1),
        Self::Path(4),
        Self::Path(16),
        Self::Resample,
        Self::Hits,
    ];
}

impl fmt::Display for Op {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Prepare => f.write_str("prepare"),
            Self::Eval => f.write_str("eval"),
            Self::Sample => f.write_str("sample"),
            Self::Path(samples) => write!(f, "path-{samples}"),
            Self::Resample => f.write_str("resample"),
            Self::Hits => f.write_str("hits"),
        }
    }
}

/// Identity of an entry point: function, model and instruction set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name {
    /// Operation that the entry point performs.
    pub op: Op,
    /// Function of `hairis` that is called, with a suffix if it is measured in several ways.
    pub entry: &'static str,
    /// Name of the model, as in [`MODELS`](super::MODELS).
    pub model: &'static str,
    /// Instruction set: `scalar`, `portable`, or the name of the level.
    pub level: &'static str,
}

impl fmt::Display for Name {
    /// Writes the path of the bench: `eval/eval_pdf8/gaussian/avx2+fma`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            op,
            entry,
            model,
            level,
        } = self;
        write!(f, "{op}/{entry}/{model}/{level}")
    }
}
