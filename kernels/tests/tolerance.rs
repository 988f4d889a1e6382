//! Every bound of the tests, one row each, with the worst case measured beside it: the larger of a default build and one
//! for x86-64-v3, over all levels. To measure again: `cargo test --workspace -- --nocapture | grep measured`.

// Elementary functions: units in the last place, unless the name says otherwise.
pub(crate) const GAUSSIAN: f64 = 2.5; // 1.85, s in [0, 158]; times 1 + s/2, the rounding of the exponent
pub(crate) const GAUSSIAN_LANES: f64 = 6e1; // 45, the rounding of the exponent; 0 where neither fuses
pub(crate) const ATAN_UNIT: f64 = 1.4; // 1.09, t in [-1, 1]
pub(crate) const ATAN_UNIT_RAD: f64 = 8.5e-8; // 6.5e-8
pub(crate) const HALF_ATAN2: f64 = 3.6; // 2.72
pub(crate) const HALF_ATAN2_LANES: f64 = 3.6; // 3.0; 0 where neither fuses
pub(crate) const HALF_ATAN2_RAD: f64 = 1.1e-7; // 8.3e-8, the rounding of the length included
pub(crate) const HALF_ATAN2_PARTS_RAD: f64 = 2.8e-9; // 2.1e-9, within 0.02 of a quarter turn
pub(crate) const HALF_ANGLE_RAD: f64 = 1.2e-7; // 8.9e-8, the rounding of sine and cosine included
pub(crate) const HALF_ANGLE_LANES: f64 = 8.0; // 6.0, 2.2e-8 rad: one lane has halves apart; 0 where neither fuses
pub(crate) const TAN_HALF_TURN_RAD: f64 = 1.5e-7; // 1.16e-7, x in [-pi/2, pi/2]
pub(crate) const ATAN2_UPPER: f64 = 2.3; // 1.77, any magnitude
pub(crate) const ATAN2_UPPER_RAD: f64 = 3.4e-7; // 2.58e-7, beside pi
pub(crate) const SIN_TWICE: f64 = 2.6; // 1.95, x in [-pi/4, pi/4]
pub(crate) const COS_TWICE: f64 = 2.5; // 1.9, up to its zero
pub(crate) const SIN_COS_TWICE_ABS: f64 = 1.5e-7; // 1.16e-7
pub(crate) const SIN_COS_ABSOLUTE: f64 = 2.2e-7; // 1.68e-7, x in [-pi/2, pi/2]
pub(crate) const COS_ABSOLUTE_LANES: f64 = 1.4e-7; // 1.03e-7; 0 where neither fuses
pub(crate) const LOG2: f64 = 8e-8; // 5.9e-8, normal numbers, over 1 + |log2|
pub(crate) const NORMAL_TAIL_RATIO: f64 = 5.9e-7; // 5.7e-7, x in [0, 12.6], relative
pub(crate) const NORMAL_TAIL_INVERSE: [f64; 2] = [1.4e-7, 2.7e-4]; // 1.02e-7, 2.1e-4: of q, absolute and relative, q above 2^-116
pub(crate) const COMPLEMENT: f64 = 3.3; // 2.7, one lane, which does not fuse
pub(crate) const LOG2_ONE_PLUS: f64 = 3.2; // 2.6
pub(crate) const LOG2_SEAM: f64 = 1e-6; // 5.3e-7: of numbers that differ by 4 places
pub(crate) const ATAN_EIGHTH: f64 = 1.1; // 0.86
// Compiled for x86-64-v3, whose eight lanes fuse: 4 and 3 ULP from one lane, both within the bounds above of f64.
pub(crate) const COMPLEMENT_LANES: f64 = 5.0;
pub(crate) const LOG2_ONE_PLUS_LANES: f64 = 3.8;
pub(crate) const MATH_LANES: f64 = 2.4; // 2.0; 0 where neither fuses

// A frame: dot products, lengths, handedness.
pub(crate) const FRAME: f32 = 1e-6;
