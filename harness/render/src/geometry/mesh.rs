//! Meshes of triangles, on which hair grows.

use super::Bounds;
use glam::Vec3;

/// Largest magnitude of a coordinate, in centimetres.
const FARTHEST: f32 = 1e6;

/// Mesh of triangles, each given by the indices of its corners, in centimetres.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    places: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    bounds: Bounds,
}

impl Mesh {
    /// Creates a mesh from corners and triangles of their indices. Triangles without area are dropped.
    ///
    /// # Errors
    ///
    /// Returns a line of text if a coordinate is not finite or above 1e6 cm in magnitude, if an index is of
    /// no corner, if no triangle is left, or if there are too many.
    pub fn new(places: Vec<Vec3>, mut triangles: Vec<[u32; 3]>) -> Result<Self, String> {
        let far = |place: &&Vec3| !place.abs().cmple(Vec3::splat(FARTHEST)).all();
        if let Some(place) = places.iter().find(far) {
            return Err(format!(
                "coordinates must be finite and at most {FARTHEST} cm, got {place}"
            ));
        }
        let mut corners = triangles.iter().flatten();
        if let Some(corner) = corners.find(|&&corner| corner as usize >= places.len()) {
            let count = places.len();
            return Err(format!(
                "numbers of vertices must be below {count}, got {corner}"
            ));
        }
        triangles.retain(|corners| normal(corners.map(|k| places[k as usize])).is_some());
        // Numbers of nodes and blocks of the tree must fit into 31 bits.
        if triangles.is_empty() || triangles.len() >= 1 << 31 {
            let count = triangles.len();
            return Err(format!(
                "a mesh must have from 1 to 2^31 - 1 triangles with an area, got {count}"
            ));
        }
        let used = triangles.iter().flatten().map(|&k| places[k as usize]);
        Ok(Self {
            bounds: used.fold(Bounds::EMPTY, |bounds, place| bounds.with(place)),
            places,
            triangles,
        })
    }

    /// Returns the number of triangles that have an area.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// Returns the smallest box that holds all triangles.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns the corners of a triangle, in the order in which the mesh was given.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle of this number.
    #[inline]
    #[must_use]
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|k| self.places[k as usize])
    }

    /// Returns the unit normal of a triangle, around which its corners go to the left.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle of this number.
    #[inline]
    #[must_use]
    pub fn normal(&self, triangle: u32) -> Vec3 {
        normal(self.corners(triangle)).unwrap_or(Vec3::Y)
    }
}

/// Returns the unit normal of a triangle, if the triangle has an area.
fn normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    (b - a).cross(c - a).try_normalize()
}
