//! Meshes of triangles, on which hair grows.

use super::bounds::Bounds;
use glam::{Quat, Vec3};

/// Largest magnitude of a coordinate, in centimetres.
const FARTHEST: f32 = 1e6;

/// Mesh of triangles, each given by the indices of its corners, in centimetres.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    places: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Unit normals of the corners for shading; without them, triangles are flat.
    normals: Vec<Vec3>,
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
            normals: Vec::new(),
        })
    }

    /// Gives the mesh a unit normal per corner, between which shading interpolates.
    ///
    /// # Errors
    ///
    /// Returns a line of text unless there is a normal of length 1 for each corner.
    pub fn with_normals(self, normals: Vec<Vec3>) -> Result<Self, String> {
        let [count, places] = [normals.len(), self.places.len()];
        if count != places {
            return Err(format!("a mesh must have {places} normals, got {count}"));
        }
        if let Some(normal) = normals.iter().find(|normal| !normal.is_normalized()) {
            return Err(format!("normals must have length 1, got {normal}"));
        }
        Ok(Self { normals, ..self })
    }

    /// Joins meshes, each with the rotation about the vertical axis, in rad, and then the shift that are applied to it.
    ///
    /// # Errors
    ///
    /// Returns a line of text if the meshes have too many corners or triangles.
    pub fn join(parts: impl IntoIterator<Item = (Self, f32, Vec3)>) -> Result<Self, String> {
        let (mut places, mut triangles, mut normals) = (Vec::new(), Vec::new(), Vec::new());
        for (mesh, angle, shift) in parts {
            let turn = Quat::from_rotation_y(angle);
            let first = u32::try_from(places.len()).map_err(|problem| problem.to_string())?;
            triangles.extend(
                mesh.triangles
                    .iter()
                    .map(|corners| corners.map(|k| first + k)),
            );
            places.extend(mesh.places.iter().map(|place| shift + turn * *place));
            normals.extend(mesh.normals.iter().map(|normal| turn * *normal));
        }
        let mesh = Self::new(places, triangles)?;
        if normals.is_empty() {
            return Ok(mesh);
        }
        mesh.with_normals(normals)
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

    /// Returns the unit normal for shading at a point of a triangle: that of the triangle, or interpolated between those of its
    /// corners if the mesh has them.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle of this number.
    #[inline]
    #[must_use]
    pub fn shading_normal(&self, triangle: u32, point: Vec3) -> Vec3 {
        let flat = self.normal(triangle);
        if self.normals.is_empty() {
            return flat;
        }
        // Areas of the triangles between the point and two corners.
        let [a, b, c] = self.corners(triangle).map(|corner| corner - point);
        let weights = [b.cross(c), c.cross(a), a.cross(b)].map(|area| area.dot(flat).max(0.0));
        let corners = self.triangles[triangle as usize].map(|k| self.normals[k as usize]);
        let sum: Vec3 = weights.into_iter().zip(corners).map(|(w, n)| w * n).sum();
        sum.try_normalize().unwrap_or(flat)
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
