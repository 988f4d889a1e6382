//! The bounds for the matched sampler, one row each, with the worst case measured beside it: the larger of a default build
//! and one for x86-64-v3, over all levels.

// S and density against the textbook, relative, further than 1e-3 rad from the axis; then those of a lobe alone.
pub(crate) const GRID: [f64; 4] = [1.9e-5, 1.9e-5, 5.6e-5, 5.6e-5]; // 1.5e-5, 1.4e-5, 4.3e-5, 4.3e-5
pub(crate) const NARROW: [f64; 4] = [1.4e-4, 1.4e-4, 1.6e-4, 1.6e-4]; // 1e-4, 1e-4, 1.2e-4, 1.2e-4
pub(crate) const WIDE: [f64; 4] = [8.8e-7, 1.2e-6, 2.5e-6, 2.5e-6]; // 6.7e-7, 9e-7, 1.9e-6, 1.9e-6

// The sum of the lobes against the whole, relative.
pub(crate) const LOBE_SUM: f64 = 4.8e-6; // 3.7e-6

// Samples against the textbook at the direction they return: S, density, weight, relative, off the seam and the axis.
pub(crate) const GRID_SAMPLE: [f64; 3] = [1.8e-5, 1.9e-5, 1.4e-6]; // 1.4e-5, 1.4e-5, 1e-6
pub(crate) const NARROW_SAMPLE: [f64; 3] = [9.8e-5, 9.8e-5, 1.2e-6]; // 7.5e-5, 7.5e-5, 8.8e-7
pub(crate) const WIDE_SAMPLE: [f64; 3] = [8.5e-7, 1e-6, 1.2e-6]; // 6.5e-7, 7.6e-7, 8.9e-7
pub(crate) const SAMPLE_LENGTH: f64 = 3.5e-7; // 2.6e-7

// The cdf of the drawn angles against the numbers they were drawn with: theta, phi. The worst are of lobes off the sphere,
// whose density falls from the pole: there 1e-7 rad is 1e-4 of the cdf.
pub(crate) const GRID_CDF: [f64; 2] = [2.5e-5, 7.2e-7]; // 1.9e-5, 5.5e-7
pub(crate) const NARROW_CDF: [f64; 2] = [1.4e-4, 6e-6]; // 1e-4, 4.6e-6
pub(crate) const WIDE_CDF: [f64; 2] = [7.3e-7, 1.9e-7]; // 5.5e-7, 1.4e-7

// A level that fuses against one lane that does not, wide lobes off the seam and the axis: S, density, direction.
pub(crate) const LEVELS: [f64; 3] = [7.7e-7, 5.9e-7, 2.2e-6]; // 5.9e-7, 4.5e-7, 1.6e-6
pub(crate) const ALBEDO_LANES: f64 = 1.1e-4; // 8.4e-5; 0 where neither fuses

// Directional albedo of a lobe against quadrature, relative.
pub(crate) const ALBEDO: f64 = 1.4e-4; // 1.0e-4

// Reciprocity of S, relative, wide and grid materials.
pub(crate) const RECIPROCITY: f64 = 3.3e-5; // 2.5e-5
// Density of a sample against that of its direction, relative, times `width / (width + 0.1)` with the least width.
pub(crate) const SAMPLE_EVAL: f64 = 3.8e-6; // 2.9e-6
// A frame: dot products, lengths, handedness.
pub(crate) const FRAME: f32 = 1e-6;

// The integral of a lobe's density against 1: grid, narrow and wide materials.
pub(crate) const INTEGRAL: [f64; 3] = [5.5e-6, 9.6e-5, 9.8e-7]; // 4.2e-6, 7.4e-5, 7.5e-7

// Samples of TT and of glints next to the seam, against the textbook at the direction they return: S, density, weight.
pub(crate) const SEAM: [f64; 3] = [4.3e-6, 4.1e-6, 1e-6]; // 3.3e-6, 3.1e-6, 7.6e-7

// With 5, 9 and 25 bands, under constant light over the grid: V at most, its gain over the published sampler at least, as a
// geometric mean and anywhere.
pub(crate) const GAIN: [[f64; 3]; 3] = [[0.0413, 7.2, 2.2], [0.0207, 13.9, 3.6], [0.006, 55.0, 8.1]]; // .0412, 7.27, 2.27; .0206, 14.0, 3.69; .0059, 55.6, 8.27
// With so many bands, the bound on weights over their mean.
pub(crate) const WEIGHT: [f64; 3] = [7.6, 4.6, 2.6]; // 7.2, 4.3, 2.44
