//! Bounds of one model.

/// Every bound of the tests of one model of the family. Rows that a model's tests do not read may be 0.
#[derive(Clone, Copy, Debug)]
pub struct Rows {
    /// S and density against the reference, relative, further than 1e-3 rad from the axis; then those of a lobe alone: on the
    /// efficiency grid and the presets.
    pub grid: [f64; 4],
    /// Bound for lobes that are all 0.5 degrees wide.
    pub narrow: [f64; 4],
    /// Bound for lobes that are all 60 degrees wide.
    pub wide: [f64; 4],
    /// The sum of the lobes against the whole, relative.
    pub lobe_sum: f64,
    /// Samples against the reference at the direction they return: S, density, weight, relative, off the seam and the axis.
    pub grid_sample: [f64; 3],
    /// Bound for lobes that are all 0.5 degrees wide.
    pub narrow_sample: [f64; 3],
    /// Bound for lobes that are all 60 degrees wide.
    pub wide_sample: [f64; 3],
    /// Length of a sampled direction, off 1.
    pub sample_length: f64,
    /// The cdf of the drawn angles against the numbers they were drawn with: theta, phi.
    pub grid_cdf: [f64; 2],
    /// Bound for lobes that are all 0.5 degrees wide.
    pub narrow_cdf: [f64; 2],
    /// Bound for lobes that are all 60 degrees wide.
    pub wide_cdf: [f64; 2],
    /// A level that fuses against one lane that does not, wide lobes off the seam and the axis: S, density, direction.
    pub levels: [f64; 3],
    /// Directional albedo of a lobe against quadrature, relative.
    pub albedo: f64,
    /// Directional albedo of a lobe of any width, seen from further than 1e-5 rad from the axis, relative to at least 1e-9.
    pub albedo_any: f64,
    /// Directional albedo of a lobe against quadrature on the mesh of its own samples, relative to at least 1e-3, and of eight
    /// lanes against one. The mesh of the matched Gaussian's samples is coarser than that of the published sampler's.
    pub albedo_mesh: f64,
    /// Reciprocity of S, relative, wide and grid materials.
    pub reciprocity: f64,
    /// Density of a sample against that of its direction, relative, times `width / (width + 0.1)` with the least width.
    pub sample_eval: f64,
    /// A weight over its proven bound: published sampler.
    pub weight_bound: f64,
    /// The integral of a lobe's density against 1: grid, narrow and wide materials; matched samplers.
    pub integral: [f64; 3],
    /// Samples of TT and of glints next to the seam, against the reference at the direction they return: S, density, weight;
    /// matched samplers.
    pub seam: [f64; 3],
    /// Samples at the ends of the uniform numbers, widths of a degree and more, against the reference at the direction they
    /// return: S, density, weight off the seam, density next to it; matched samplers.
    pub tail_sample: [f64; 4],
    /// Bound off the seam, where no lobe has its centre on the sphere.
    pub off_sphere_sample: [f64; 3],
    /// With 5, 9 and 25 bands, under constant light over the grid: V at most, its gain over the published sampler at least,
    /// as a geometric mean and anywhere.
    pub gain: [[f64; 3]; 3],
    /// With so many bands, the bound on weights over their mean.
    pub weight: [f64; 3],
}
