//! Tests of `pixels`.

mod openexr;
mod primaries;
