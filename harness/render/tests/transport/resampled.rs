//! Tests of `resampled`.

mod cells;
