//! Tests of `load`.

mod primaries;
