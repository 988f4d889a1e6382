//! The bounds for the matched sampler on the all-Cauchy variant, one row each, with the worst case measured beside it: the
//! larger of a default build and one for x86-64-v3, over all levels.

// S and density against the textbook, relative, further than 1e-3 rad from the axis; then those of a lobe
// alone. The worst densities are next to a pole that a lobe is centred on, where W and the height in its place fall to 0:
// there a rounding of theta_i by 1e-7 rad is one of the height by 1e-4.
pub(crate) const GRID: [f64; 4] = [4.9e-6, 1.1e-4, 5e-6, 1.9e-4]; // 3.7e-6, 8.4e-5, 3.8e-6, 1.4e-4
pub(crate) const NARROW: [f64; 4] = [1.9e-5, 3.9e-4, 4.1e-5, 5.2e-4]; // 1.4e-5, 3.0e-4, 3.1e-5, 4.0e-4
pub(crate) const WIDE: [f64; 4] = [8e-7, 7.8e-5, 1.1e-6, 8.4e-5]; // 6.1e-7, 6.0e-5, 8.1e-7, 6.4e-5

// The sum of the lobes against the whole, relative.
pub(crate) const LOBE_SUM: f64 = 1.2e-6; // 8.8e-7

// Samples against the textbook at the direction they return: S, density, weight, relative, off the seam and the axis.
pub(crate) const GRID_SAMPLE: [f64; 3] = [3.8e-6, 4.3e-5, 4.3e-5]; // 2.9e-6, 3.3e-5, 3.3e-5
pub(crate) const NARROW_SAMPLE: [f64; 3] = [2e-5, 3.6e-5, 3.3e-5]; // 1.5e-5, 2.7e-5, 2.5e-5
pub(crate) const WIDE_SAMPLE: [f64; 3] = [9.8e-7, 4.6e-5, 4.6e-5]; // 7.5e-7, 3.5e-5, 3.5e-5
pub(crate) const SAMPLE_LENGTH: f64 = 7.1e-7; // 5.4e-7

// The cdf of the drawn angles against the numbers they were drawn with: theta, phi.
pub(crate) const GRID_CDF: [f64; 2] = [2.1e-6, 6.7e-7]; // 1.6e-6, 5.1e-7
pub(crate) const NARROW_CDF: [f64; 2] = [6.2e-6, 6.2e-6]; // 4.7e-6, 4.7e-6
pub(crate) const WIDE_CDF: [f64; 2] = [5.1e-7, 2e-7]; // 3.9e-7, 1.5e-7

// A level that fuses against one lane that does not, wide lobes off the seam and the axis: S, density, direction.
pub(crate) const LEVELS: [f64; 3] = [6.7e-7, 4.5e-6, 1.3e-6]; // 5.1e-7, 3.4e-6, 9.6e-7
pub(crate) const ALBEDO_LANES: f64 = 1.1e-4; // 8.4e-5; 0 where neither fuses

// Directional albedo of a lobe against quadrature, relative.
pub(crate) const ALBEDO: f64 = 5.4e-3; // 4.1e-3

// Reciprocity of S, relative, wide and grid materials.
pub(crate) const RECIPROCITY: f64 = 1.2e-5; // 8.6e-6
// Density of a sample against that of its direction, relative, times `width / (width + 0.1)` with the least width.
pub(crate) const SAMPLE_EVAL: f64 = 5.5e-6; // 4.2e-6
// A frame: dot products, lengths, handedness.
pub(crate) const FRAME: f32 = 1e-6;

// The integral of a lobe's density against 1: grid, narrow and wide materials.
pub(crate) const INTEGRAL: [f64; 3] = [2.3e-5, 2.5e-5, 3.9e-6]; // 1.7e-5, 1.9e-5, 3.0e-6
