//! Golden spiral on the unit sphere, whose points are spread evenly.

use glam::Vec3;

/// Angle in radians between neighbours of a golden spiral, `pi (3 - sqrt 5)`.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Returns the direction of point `index` at the height `y`, in `[-1, 1]`.
pub(crate) fn golden_spiral(index: usize, y: f32) -> Vec3 {
    #[expect(clippy::cast_possible_truncation, reason = "rounded to the nearest")]
    let azimuth = (GOLDEN_ANGLE * index as f64 % core::f64::consts::TAU) as f32;
    let across = (1.0 - y * y).max(0.0).sqrt();
    Vec3::new(
        across * libm::cosf(azimuth),
        y,
        across * libm::sinf(azimuth),
    )
}
