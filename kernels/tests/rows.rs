//! Bounds of tests whose errors have none by argument, one row each, with the worst case measured above it, over all levels: the larger of
//! a default build with forty seeds (`HAIRIS_SEED`) and one for x86-64-v3 with twelve. Worst cases that random numbers find still grow with
//! the number of seeds, so that their bounds are 1.3 to 1.5 times as large, and twice that for another seed than CI's.
//! To measure again: `cargo test --workspace -- --nocapture | grep measured`.

use hairis_conformance::published::Rows;

/// The published sampler.
pub(crate) const PUBLISHED: Rows = Rows {
    // 4.2e-7
    lobe_sum: 6e-7,
    // 3.7e-7
    sample_length: 4.5e-7,
    // 2.2e-6, 4.5e-7
    grid_cdf: [3e-6, 6e-7],
    // 5.3e-6, 6.2e-6
    narrow_cdf: [7e-6, 8.1e-6],
    // 2.9e-7, 9.8e-8
    wide_cdf: [4e-7, 1.4e-7],
    // 3.0e-6
    albedo: 4e-6,
    // 5.3e-5
    albedo_any: 7e-5,
    // 1.8e-6
    albedo_mesh: 4e-6,
    // 2.5e-5
    reciprocity: 3.2e-5,
    integral: [0.0; 3],
    seam: [0.0; 3],
    tail_sample: [0.0; 4],
    off_sphere_sample: [0.0; 3],
    gain: [[0.0; 3]; 3],
};

/// The matched samplers.
pub(crate) const MATCHED: Rows = Rows {
    // 3.7e-6
    lobe_sum: 4.8e-6,
    // 3.3e-7
    sample_length: 4.5e-7,
    // 2.2e-5, 6.0e-7
    grid_cdf: [3e-5, 9e-7],
    // 1e-4, 6.2e-6
    narrow_cdf: [1.4e-4, 8.1e-6],
    // 7.4e-7, 1.6e-7
    wide_cdf: [1.1e-6, 2.5e-7],
    // 3.0e-6
    albedo: 4e-6,
    // 5.3e-5
    albedo_any: 7e-5,
    // 5.4e-5: the mesh of a glint of half a degree
    albedo_mesh: 7e-5,
    // 2.5e-5
    reciprocity: 3.3e-5,
    // 4.2e-6, 7.4e-5, 7.5e-7
    integral: [5.5e-6, 9.6e-5, 9.8e-7],
    // 3.3e-6, 3.1e-6, 7.6e-7
    seam: [4.3e-6, 4.1e-6, 1e-6],
    // 3.9e-5, 3.9e-5, 4.3e-6, 2.1e-5
    tail_sample: [5e-5, 5e-5, 5.6e-6, 2.7e-5],
    // 4.5e-5, 2.4e-5, 2.6e-5
    off_sphere_sample: [5.9e-5, 3.1e-5, 3.4e-5],
    // .0412, 7.27, 2.27; .0206, 14.0, 3.69; .0059, 55.6, 8.27
    gain: [[0.0413, 7.2, 2.2], [0.0207, 13.9, 3.6], [0.006, 55.0, 8.1]],
};
