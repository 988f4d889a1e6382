//! Every bound of the tests, one row each, with the worst case measured beside it: the larger of a default build and one
//! for x86-64-v3, over all levels. To measure again: `cargo test --workspace -- --nocapture | grep measured`.

// Elementary functions: units in the last place, unless the name says otherwise.
pub(crate) const GAUSSIAN: f64 = 3.3; // 2.67, s in [0, 158]; times 1 + s/2, the rounding of the exponent
pub(crate) const GAUSSIAN_LANES: f64 = 6e1; // 45, the rounding of the exponent; 0 where neither fuses
pub(crate) const ATAN_UNIT: f64 = 2.3; // 1.91, t in [-1, 1]
pub(crate) const ATAN_UNIT_RAD: f64 = 1.4e-7; // 1.05e-7
pub(crate) const HALF_ATAN2: f64 = 3.3; // 2.72
pub(crate) const HALF_ATAN2_LANES: f64 = 3.6; // 3.0; 0 where neither fuses
pub(crate) const HALF_ATAN2_RAD: f64 = 1.3e-7; // 1.02e-7, the rounding of the length included
pub(crate) const ATAN2_UPPER: f64 = 2.7; // 2.22, any magnitude
pub(crate) const ATAN2_UPPER_RAD: f64 = 3.7e-7; // 3.11e-7, beside pi
pub(crate) const SIN_TWICE: f64 = 2.7; // 2.31, x in [-pi/4, pi/4]
pub(crate) const COS_TWICE: f64 = 2.7; // 2.22, up to its zero
pub(crate) const SIN_COS_TWICE_ABS: f64 = 1.6e-7; // 1.38e-7
pub(crate) const SIN_COS_ABSOLUTE: f64 = 2.8e-7; // 2.23e-7, x in [-pi/2, pi/2]
pub(crate) const COS_ABSOLUTE_LANES: f64 = 3e-7; // 2e-7; 0 where neither fuses
pub(crate) const LOG2: f64 = 8e-8; // 5.9e-8, normal numbers, over 1 + |log2|
pub(crate) const NORMAL_TAIL_RATIO: f64 = 5.9e-7; // 4.5e-7, x in [0, 12.6], relative
pub(crate) const NORMAL_TAIL_INVERSE: [f64; 2] = [1.4e-7, 2.7e-4]; // 1.02e-7, 2.1e-4: of q, absolute and relative, q above 2^-116
pub(crate) const MATH_LANES: f64 = 2.4; // 2.0; 0 where neither fuses

// S and density against the textbook, relative, further than 1e-3 rad from the axis; then those of a lobe
// alone.
pub(crate) const GRID: [f64; 4] = [6e-5, 1e-5, 1e-4, 1e-5]; // 4.6e-5, 8.8e-6, 7.3e-5, 8.7e-6: the efficiency grid, and the presets
pub(crate) const NARROW: [f64; 4] = [2.5e-4, 2.5e-5, 2.5e-4, 2.8e-5]; // 2.0e-4, 2.0e-5, 2.0e-4, 2.2e-5: every width 0.5 degrees
pub(crate) const WIDE: [f64; 4] = [1e-6, 7e-7, 2.4e-6, 1.1e-6]; // 7.7e-7, 5.6e-7, 1.9e-6, 9.1e-7: every width 60 degrees

// The sum of the lobes against the whole, relative.
pub(crate) const LOBE_SUM: f64 = 4.5e-7; // 3.5e-7

// Samples against the textbook at the direction they return: S, density, weight, relative, off the seam and the axis.
pub(crate) const GRID_SAMPLE: [f64; 3] = [2.2e-5, 6.5e-6, 2.2e-5]; // 1.6e-5, 4.8e-6, 1.6e-5
pub(crate) const NARROW_SAMPLE: [f64; 3] = [1.7e-4, 3.2e-5, 1.7e-4]; // 1.3e-4, 2.4e-5, 1.3e-4
pub(crate) const WIDE_SAMPLE: [f64; 3] = [1.1e-6, 8e-7, 1.2e-6]; // 7.8e-7, 6.1e-7, 8.6e-7
pub(crate) const SAMPLE_LENGTH: f64 = 4.5e-7; // 3.7e-7

// The cdf of the drawn angles against the numbers they were drawn with: theta, phi.
pub(crate) const GRID_CDF: [f64; 2] = [3e-6, 6e-7]; // 2.2e-6, 4.5e-7
pub(crate) const NARROW_CDF: [f64; 2] = [7e-6, 6e-6]; // 5.3e-6, 4.3e-6
pub(crate) const WIDE_CDF: [f64; 2] = [4e-7, 1.4e-7]; // 2.9e-7, 9.8e-8

// A level that fuses against one lane that does not, wide lobes off the seam and the axis: S, density, direction.
pub(crate) const LEVELS: [f64; 3] = [8e-7, 8e-7, 1.3e-6]; // 5.9e-7, 6.3e-7, 9.6e-7
pub(crate) const ALBEDO_LANES: f64 = 2.3e-5; // 1.8e-5; 0 where neither fuses

// Directional albedo of a lobe against quadrature, relative.
pub(crate) const ALBEDO: f64 = 1.3e-4; // 1.0e-4, widths of 60 degrees seen along the axis

// Reciprocity of S, relative, wide and grid materials.
pub(crate) const RECIPROCITY: f64 = 3.2e-5; // 2.5e-5
// Density of a sample against that of its direction, relative, times `width / (width + 0.1)` with the least width.
pub(crate) const SAMPLE_EVAL: f64 = 1.6e-6; // 1.2e-6
// A weight over its proven bound.
pub(crate) const WEIGHT_BOUND: f64 = 1.0 + 6e-7; // 1 + 3.3e-7
// A frame: dot products, lengths, handedness.
pub(crate) const FRAME: f32 = 1e-6;
