//! The published model and its samplers: the suite that every model passes, and the tests against the reference.

use crate::rows::{MATCHED, PUBLISHED};
use hairis::{Gaussian, Matched, Published};
use hairis_conformance::published::{Family, FamilyModel, Rows};
use hairis_conformance::{AsConserving, conformance, published};
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

conformance!(hair, Family::<PublishedHair>::new());
#[cfg(not(hairis_one))]
conformance!(matched_5, AsConserving(Family::<Bands<5>>::new()), sampler);
conformance!(matched_9, Family::<Bands<9>>::new());
#[cfg(not(hairis_one))]
conformance!(
    matched_25,
    AsConserving(Family::<Bands<25>>::new()),
    sampler
);
#[cfg(not(hairis_one))]
conformance!(
    matched_by_channel,
    AsConserving(Family::<Bands<9, true>>::new()),
    sampler
);

published!(published_sampler, crate::family::PublishedHair, published);
published!(matched, crate::family::Bands<9>, matched);
#[cfg(not(hairis_one))]
published!(by_channel, crate::family::Bands<9, true>, common);
