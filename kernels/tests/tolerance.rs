//! Every bound of the tests, one row each, with the worst case measured beside it: the larger of a default build and one
//! for x86-64-v3, over all levels. To measure again: `cargo test --workspace -- --nocapture | grep measured`.

// Elementary functions: units in the last place, unless the name says otherwise.
pub(crate) const EXP2_NEG: f64 = 1.6; // 1.39, x in [0, 114]
pub(crate) const ATAN_UNIT: f64 = 2.3; // 1.91, t in [-1, 1]
pub(crate) const ATAN_UNIT_RAD: f64 = 1.4e-7; // 1.14e-7
pub(crate) const ATAN2_UPPER: f64 = 2.7; // 2.22, any magnitude
pub(crate) const ATAN2_UPPER_RAD: f64 = 3.7e-7; // 3.11e-7, beside pi
pub(crate) const SIN_HALF_TURN: f64 = 2.7; // 2.31, x in [-pi/2, pi/2]
pub(crate) const COS_HALF_TURN: f64 = 2.7; // 2.22, up to its zero
pub(crate) const SIN_COS_HALF_TURN_ABS: f64 = 1.6e-7; // 1.38e-7
pub(crate) const MATH_LANES: f64 = 2.7; // 0 where neither fuses

// S and density against the textbook, relative, further than 1e-3 rad from the axis; the lobes' own included.
pub(crate) const GRID: [f64; 2] = [1e-4, 1e-5]; // 7.3e-5, 8.8e-6: the grid of the efficiency figures, and the presets
pub(crate) const NARROW: [f64; 2] = [2.5e-4, 2.7e-5]; // 2.0e-4, 2.2e-5: every width 0.5 degrees
pub(crate) const WIDE: [f64; 2] = [2.4e-6, 1.1e-6]; // 1.9e-6, 9.1e-7: every width 60 degrees
