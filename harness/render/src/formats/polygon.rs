//! Polygons of meshes as triangles.

use glam::Vec3;

/// Positions, and triangles as indices into them.
pub(super) type Parts = (Vec<Vec3>, Vec<[u32; 3]>);

/// Splits a polygon into triangles that share its first corner.
pub(super) fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let pairs = corners.windows(2).skip(1);
    pairs.map(|pair| [corners[0], pair[0], pair[1]])
}
