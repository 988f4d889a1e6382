//! Tests of materials, as one binary.

mod material;
