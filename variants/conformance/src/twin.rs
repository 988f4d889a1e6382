//! Formulas of a textbook as the reference of a [`Subject`](crate::Subject).

use crate::subject::{Reference, ReferenceSample, Tolerance};
use hairis::{Lobe, textbook};

/// A model's formulas in double precision, with the agreement to expect.
#[derive(Clone, Copy, Debug)]
pub struct Twin<R> {
    /// The formulas at one hit.
    pub book: R,
    /// Agreement to expect.
    pub tolerance: Tolerance,
}

impl<R: textbook::Reference<f64>> Reference for Twin<R> {
    fn eval(&self, wi: [f64; 3]) -> [f64; 3] {
        self.book.eval(wi)
    }

    fn pdf(&self, wi: [f64; 3]) -> f64 {
        self.book.pdf(wi)
    }

    fn lobes(&self, wi: [f64; 3]) -> Option<[[f64; 2]; 4]> {
        let lobes = self.book.lobes(wi);
        Some(Lobe::ALL.map(|lobe| [lobes[lobe].value, lobes[lobe].pdf]))
    }

    fn sample(&self, xi: [f64; 3]) -> ReferenceSample {
        let drawn = self.book.sample(xi);
        drawn.lobe.map_or(ReferenceSample::Discarded, |lobe| ReferenceSample::Drawn(lobe.index(), drawn.wi))
    }

    fn tolerance(&self) -> Tolerance {
        self.tolerance
    }
}
