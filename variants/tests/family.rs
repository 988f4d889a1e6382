//! The all-Cauchy variant and its samplers: the suite that every model passes, and the tests against the reference.

use crate::cauchy_hair::{Bands, PublishedHair};
use hairis_conformance::published::Family;
use hairis_conformance::{AsConserving, conformance, published};

conformance!(hair, AsConserving(Family::<PublishedHair>::new()), but hits);
conformance!(matched_9, AsConserving(Family::<Bands>::new()), but hits);

published!(
    published_sampler,
    crate::cauchy_hair::PublishedHair,
    published
);
published!(matched, crate::cauchy_hair::Bands, matched);
