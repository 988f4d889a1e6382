//! Which segment a ray meets first. Knows strands and rays, and no light.

mod ray;
mod segment;

pub use ray::{Hit, Ray, Skip};

use crate::geometry::Strands;
use core::fmt;
use segment::Segment;

/// Finds the segments that rays meet.
#[derive(Clone, Debug)]
pub struct Tree {
    segments: Vec<Segment>,
}

impl Tree {
    /// Builds the tree.
    ///
    /// # Errors
    ///
    /// If the scene is too large for its radii, see [`TreeError`].
    pub fn build(strands: &Strands) -> Result<Self, TreeError> {
        let segments = strands.numbers().map(|(strand, number)| Segment::new(strands, strand, number)).collect();
        Ok(Self { segments })
    }

    /// The nearest segment that the ray meets. Of equally near ones, that of the lowest number.
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let nearer =
            |best: Option<Hit>, hit: Hit| if best.is_some_and(|best| best.t <= hit.t) { best } else { Some(hit) };
        self.segments.iter().filter_map(|segment| segment.meet(ray)).fold(None, nearer)
    }

    /// Whether the ray meets any segment.
    #[must_use]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.segments.iter().any(|segment| segment.meet(ray).is_some())
    }

    /// Its size in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of_val(self.segments.as_slice())
    }
}

/// Why a tree was not built.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum TreeError {
    /// Distances in the scene are so much larger than radii that rounding would show.
    Scale {
        /// Diagonal of the scene, in centimetres.
        size: f32,
        /// The largest radius of the thinnest strand, in centimetres.
        radius: f32,
    },
}

impl fmt::Display for TreeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scale { size, radius } => {
                write!(
                    f,
                    "a scene must be at most 1e5 times as large as its thinnest strand, got {size} cm and {radius} cm"
                )
            }
        }
    }
}

impl core::error::Error for TreeError {}
