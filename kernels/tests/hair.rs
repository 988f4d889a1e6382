//! The published model and its samplers, as the suites take them.

use crate::rows::{MATCHED, PUBLISHED};
use hairis::{Gaussian, Matched, Published};
use hairis_conformance::published::{FamilyModel, Rows};
use hairis_reference::Shape;

/// The published sampler.
pub(crate) struct PublishedHair;

impl FamilyModel for PublishedHair {
    type Model = Published<Gaussian>;
    type Bell = Gaussian;
    const SHAPE: Shape = Shape::Gaussian;
    // `exp(-x^2/2) (1 + x^2)` at `x = 1`, `2 / sqrt(e)`.
    const OVER_CAUCHY: f64 = 1.213_061_319_425_267;
    // A Cauchy has no end.
    const PDF_FLOOR: f64 = 0.0;
    const ROWS: Rows = PUBLISHED;

    fn bell() -> Gaussian {
        Gaussian
    }

    fn forms() -> Vec<(Self::Model, f32)> {
        vec![(Published(Gaussian), 1.0)]
    }
}

/// The matched sampler of so many bands.
pub(crate) struct Bands<const BANDS: usize, const BY_CHANNEL: bool = false>;

impl<const BANDS: usize, const BY_CHANNEL: bool> FamilyModel for Bands<BANDS, BY_CHANNEL> {
    type Model = Matched<Gaussian, BANDS, BY_CHANNEL>;
    type Bell = Gaussian;
    const SHAPE: Shape = Shape::Gaussian;
    const BANDS: Option<usize> = Some(BANDS);
    const BY_CHANNEL: bool = BY_CHANNEL;
    const OVER_CAUCHY: f64 = PublishedHair::OVER_CAUCHY;
    // A Gaussian, and with it the density, is cut to 0 at `2^-115` of its peak.
    const PDF_FLOOR: f64 = 1e-20;
    const ROWS: Rows = MATCHED;
    const DOCS: &'static str = include_str!("../src/hair/matched.rs");

    fn bell() -> Gaussian {
        Gaussian
    }

    fn forms() -> Vec<(Self::Model, f32)> {
        vec![(Matched(Gaussian), 1.0)]
    }
}
