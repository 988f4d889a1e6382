//! The all-Cauchy variant and its samplers, as the suites take them.

use crate::cauchy_rows::{MATCHED, PUBLISHED};
use hairis::{Matched, Published};
use hairis_conformance::published::{FamilyModel, Rows};
use hairis_reference::Shape;
use hairis_variants::Cauchy;

/// The published sampler, which follows this model exactly.
pub(crate) struct PublishedHair;

impl FamilyModel for PublishedHair {
    type Model = Published<Cauchy>;
    type Bell = Cauchy;
    const SHAPE: Shape = Shape::Cauchy;
    const OVER_CAUCHY: f64 = 1.0;
    // A Cauchy has no end.
    const PDF_FLOOR: f64 = 0.0;
    const ROWS: Rows = PUBLISHED;

    fn bell() -> Cauchy {
        Cauchy::PAPER
    }

    fn forms() -> Vec<(Self::Model, f32)> {
        vec![
            (Cauchy::PAPER.model(), 1.0),
            (Cauchy::HALF_WIDTH.model(), 1.177_41),
            (Cauchy::AREA.model(), 0.797_884_6),
        ]
    }
}

/// The matched sampler.
pub(crate) struct Bands;

impl FamilyModel for Bands {
    type Model = Matched<Cauchy>;
    type Bell = Cauchy;
    const SHAPE: Shape = Shape::Cauchy;
    const BANDS: Option<usize> = Some(9);
    const OVER_CAUCHY: f64 = 1.0;
    const PDF_FLOOR: f64 = 0.0;
    const ROWS: Rows = MATCHED;
    const DOCS: &'static str = include_str!("../../kernels/src/hair/matched.rs");

    fn bell() -> Cauchy {
        Cauchy::PAPER
    }

    fn forms() -> Vec<(Self::Model, f32)> {
        vec![
            (Cauchy::PAPER.matched(), 1.0),
            (Cauchy::HALF_WIDTH.matched(), 1.177_41),
            (Cauchy::AREA.matched(), 0.797_884_6),
        ]
    }
}
