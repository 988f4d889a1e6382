//! Tests of `formats`.

mod follow;
