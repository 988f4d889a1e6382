//! Triangles.

use super::Bounds;
use glam::Vec3;

/// Coordinates are at most this far from 0, in centimetres.
const FARTHEST: f32 = 1e6;

/// Triangles between places.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    places: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    bounds: Bounds,
}

impl Mesh {
    /// Triangles by the numbers of their corners; those without area are dropped.
    ///
    /// # Errors
    ///
    /// A line, if a coordinate is not finite or above 1e6 cm in magnitude, a number is of no place,
    /// or no triangle is left.
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
        // Numbers of nodes and blocks of their tree fit 31 bits.
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

    /// Number of triangles.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// The smallest box that holds them.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The corners of a triangle.
    ///
    /// # Panics
    ///
    /// If there is no such triangle.
    #[inline]
    #[must_use]
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|k| self.places[k as usize])
    }

    /// Unit normal of a triangle: its corners go round it to the left.
    ///
    /// # Panics
    ///
    /// If there is no such triangle.
    #[inline]
    #[must_use]
    pub fn normal(&self, triangle: u32) -> Vec3 {
        normal(self.corners(triangle)).unwrap_or(Vec3::Y)
    }
}

/// The normal of a triangle with an area.
fn normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    (b - a).cross(c - a).try_normalize()
}
