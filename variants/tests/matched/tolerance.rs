//! The bounds for the matched sampler on the all-Cauchy variant, one row each, with the worst case measured beside it: the
//! larger of a default build and one for x86-64-v3, over all levels.

// S and density against the textbook, relative, further than 1e-3 rad from the axis; then those of a lobe alone.
pub(crate) const GRID: [f64; 4] = [4.8e-6, 5e-6, 4.9e-6, 5e-6]; // 3.6e-6, 3.8e-6, 3.7e-6, 3.8e-6
pub(crate) const NARROW: [f64; 4] = [1.9e-5, 1.9e-5, 4e-5, 4.4e-5]; // 1.4e-5, 1.4e-5, 3e-5, 3.3e-5
pub(crate) const WIDE: [f64; 4] = [7.9e-7, 1e-6, 1.1e-6, 1.3e-6]; // 6.1e-7, 7.7e-7, 7.7e-7, 1e-6

// The sum of the lobes against the whole, relative.
pub(crate) const LOBE_SUM: f64 = 1.4e-6; // 1.1e-6

// Samples against the textbook at the direction they return: S, density, weight, relative, off the seam and the axis.
pub(crate) const GRID_SAMPLE: [f64; 3] = [3.4e-6, 3.3e-6, 1.2e-6]; // 2.6e-6, 2.5e-6, 8.7e-7
pub(crate) const NARROW_SAMPLE: [f64; 3] = [1.8e-5, 1.8e-5, 1.3e-6]; // 1.4e-5, 1.3e-5, 9.8e-7
pub(crate) const WIDE_SAMPLE: [f64; 3] = [8.6e-7, 9e-7, 1.2e-6]; // 6.6e-7, 6.9e-7, 8.8e-7
pub(crate) const SAMPLE_LENGTH: f64 = 3.7e-7; // 2.8e-7

// The cdf of the drawn angles against the numbers they were drawn with: theta, phi.
pub(crate) const GRID_CDF: [f64; 2] = [2e-6, 6e-7]; // 1.5e-6, 4.6e-7
pub(crate) const NARROW_CDF: [f64; 2] = [6e-6, 6.5e-6]; // 4.5e-6, 4.9e-6
pub(crate) const WIDE_CDF: [f64; 2] = [3.5e-7, 1.3e-7]; // 2.7e-7, 9.5e-8

// A level that fuses against one lane that does not, wide lobes off the seam and the axis: S, density, direction.
pub(crate) const LEVELS: [f64; 3] = [7.8e-7, 6.8e-7, 2.1e-6]; // 6e-7, 5.2e-7, 1.6e-6
pub(crate) const ALBEDO_LANES: f64 = 1.1e-4; // 8.4e-5; 0 where neither fuses

// Directional albedo of a lobe against quadrature, relative.
pub(crate) const ALBEDO: f64 = 5.4e-3; // 4.1e-3

// Reciprocity of S, relative, wide and grid materials.
pub(crate) const RECIPROCITY: f64 = 1.2e-5; // 8.6e-6
// Density of a sample against that of its direction, relative, times `width / (width + 0.1)` with the least width.
pub(crate) const SAMPLE_EVAL: f64 = 4.8e-6; // 3.7e-6, a glint of 0.04 degrees
// A frame: dot products, lengths, handedness.
pub(crate) const FRAME: f32 = 1e-6;

// The integral of a lobe's density against 1: grid, narrow and wide materials.
pub(crate) const INTEGRAL: [f64; 3] = [3.1e-6, 5.4e-6, 4.5e-7]; // 2.4e-6, 4.1e-6, 3.5e-7

// Samples of TT and of glints next to the seam, against the textbook at the direction they return: S, density, weight.
pub(crate) const SEAM: [f64; 3] = [2.4e-6, 2.6e-6, 8e-7]; // 1.8e-6, 2e-6, 6e-7

// With 5, 9 and 25 bands, under constant light over the grid: V at most, its gain over the published sampler at least, as a
// geometric mean and anywhere.
pub(crate) const GAIN: [[f64; 3]; 3] = [[0.045, 4.3, 2.0], [0.0224, 8.7, 3.4], [0.0065, 34.3, 8.0]]; // .0448, 4.36, 2.10; .0223, 8.78, 3.47; .0065, 34.7, 8.16
// With so many bands, the bound on weights over their mean.
pub(crate) const WEIGHT: [f64; 3] = [4.8, 3.3, 2.6]; // 4.5, 3.1, 2.43
