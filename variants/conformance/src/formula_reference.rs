//! Formulas of a model as the reference of a [`Subject`](crate::Subject).

use crate::subject::{Reference, ReferenceSample, Tolerance};
use hairis::{Lobe, reference};

/// A model's formulas in double precision, with the agreement to expect.
#[derive(Clone, Copy, Debug)]
pub struct FormulaReference<R> {
    /// The formulas at one hit.
    pub formulas: R,
    /// Agreement to expect.
    pub tolerance: Tolerance,
}

impl<R: reference::Reference<f64>> Reference for FormulaReference<R> {
    fn eval(&self, wi: [f64; 3]) -> [f64; 3] {
        self.formulas.eval(wi)
    }

    fn pdf(&self, wi: [f64; 3]) -> f64 {
        self.formulas.pdf(wi)
    }

    fn lobes(&self, wi: [f64; 3]) -> Option<[[f64; 2]; 4]> {
        let lobes = self.formulas.lobes(wi);
        Some(Lobe::ALL.map(|lobe| [lobes[lobe].value, lobes[lobe].pdf]))
    }

    fn sample(&self, xi: [f64; 3]) -> ReferenceSample {
        let drawn = self.formulas.sample(xi);
        drawn.lobe.map_or(ReferenceSample::Discarded, |lobe| {
            ReferenceSample::SampleLanes(lobe.index(), drawn.wi)
        })
    }

    fn tolerance(&self) -> Tolerance {
        self.tolerance
    }
}
