//! The published sampler and the matched one of nine bands: the suite that every model passes, and the tests against the reference.

use crate::hair::{Bands, PublishedHair};
use hairis_conformance::published::Family;
use hairis_conformance::{conformance, published};

conformance!(hair, Family::<PublishedHair>::new());
conformance!(matched_9, Family::<Bands<9>>::new());

published!(published_sampler, crate::hair::PublishedHair, published);
published!(matched, crate::hair::Bands<9>, matched);
