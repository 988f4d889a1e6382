//! Search for the segment or triangle that a ray meets first, in a tree of boxes, eight to a node, over
//! blocks of eight segments or triangles.
//!
//! The tree handles strands, meshes and rays, but no light. Lanes are eight boxes, segments or triangles against which one ray is
//! tested, and [`hairis::simd::Level`] finds their instruction set at run time. Hits depend on [`hairis::simd::Level::fuses`] in their
//! last bits, and on nothing else of the machine.

mod block;
mod build;
mod node;
mod ray;
mod split;
mod traverse;
mod triangles;

pub use ray::{Hit, Meet, Ray, Skip};
pub use traverse::Visits;
pub use triangles::MeshTree;

use crate::geometry::Strands;
use block::{Block, Leaf};
use core::fmt;
use hairis::simd::Level;
use node::Node;
use traverse::{All, Any, Closest};

/// Largest size of a scene, relative to the radius of its thinnest strand. Distances are computed to about 2^-22 of the
/// scene, which is then below 3 % of a radius.
const LARGEST_SCALE: f32 = 1e5;

/// Returns the least radius of a strand in a scene of this size, with room for what the radius adds to the size.
pub(crate) fn thinnest(size: f32) -> f32 {
    1.001 * size / LARGEST_SCALE
}

/// Tree of boxes over the segments of strands, which finds the segments that rays meet.
///
/// ```
/// use glam::Vec3;
/// use hairis_render::geometry::Strands;
/// use hairis_render::tree::{Ray, Tree};
/// let mut builder = Strands::builder();
/// builder.push([(Vec3::NEG_X, 0.01), (Vec3::X, 0.01)])?;
/// let tree = Tree::build(&builder.finish())?;
/// let hit = tree.closest(&Ray::new(Vec3::new(0.0, 3.0, 0.005), Vec3::NEG_Y)).expect("within the radius");
/// assert!((hit.t - 3.0).abs() < 1e-5 && (hit.h.abs() - 0.5).abs() < 1e-4);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tree(Boxes<Block>);

/// Nodes of a tree over blocks of eight primitives.
#[derive(Clone, Debug)]
struct Boxes<B> {
    nodes: Vec<Node>,
    blocks: Vec<B>,
    level: Level,
    meet: Meet,
}

impl<B: Leaf> Boxes<B> {
    fn new((nodes, blocks): (Vec<Node>, Vec<B>)) -> Self {
        Self {
            nodes,
            blocks,
            level: Level::detect(),
            meet: Meet::default(),
        }
    }

    #[inline]
    fn closest(&self, ray: &Ray) -> Option<B::Hit> {
        self.level.run(Closest {
            boxes: self,
            ray,
            visits: &mut (),
        })
    }

    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        self.level.run(Any {
            boxes: self,
            ray,
            visits: &mut (),
        })
    }
}

impl Tree {
    /// Builds the tree over all segments. The tree is the same for any number of threads.
    ///
    /// # Errors
    ///
    /// Returns an error if the scene is too large for its radii, see [`TreeError`].
    pub fn build(strands: &Strands) -> Result<Self, TreeError> {
        let size = strands.bounds().size().length();
        let thickest = |strand| {
            strands
                .nodes_of(strand)
                .map(|k| strands.node_radius(k))
                .fold(0.0, f32::max)
        };
        let radius = (0..)
            .take(strands.strands())
            .map(thickest)
            .filter(|&r| r > 0.0)
            .fold(f32::INFINITY, f32::min);
        if size > LARGEST_SCALE * radius {
            return Err(TreeError::Scale { size, radius });
        }
        let block = |segments: &[_]| Block::new(strands, segments);
        Ok(Self(Boxes::new(build::build(
            block::primitives(strands),
            block,
        ))))
    }

    /// Returns the tree, to be searched with another instruction set.
    #[must_use]
    pub fn at(self, level: Level) -> Self {
        Self(Boxes { level, ..self.0 })
    }

    /// Returns the tree, with hits at another place of the strands.
    #[must_use]
    pub fn with_meet(self, meet: Meet) -> Self {
        Self(Boxes { meet, ..self.0 })
    }

    /// Returns the place of the strands at which rays meet them.
    #[inline]
    #[must_use]
    pub const fn meet(&self) -> Meet {
        self.0.meet
    }

    /// Returns the nearest segment that the ray meets. Among equally near segments, the one with the lowest number is returned, so
    /// that images do not depend on the shape of the tree.
    #[inline]
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.0.closest(ray)
    }

    /// Returns true if the ray meets any segment.
    #[inline]
    #[must_use]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.0.occluded(ray)
    }

    /// Returns every segment that the ray meets, at any distance and of any strand, from a test of all blocks without boxes. Searches
    /// are checked against it.
    #[must_use]
    pub fn every_hit(&self, ray: &Ray) -> Vec<Hit> {
        self.0.level.run(All {
            boxes: &self.0,
            ray,
        })
    }

    /// Finds the nearest segment as [`closest`](Self::closest) does, and adds the nodes and blocks that it visits to `visits`.
    #[must_use]
    pub fn closest_counted(&self, ray: &Ray, visits: &mut Visits) -> Option<Hit> {
        self.0.level.run(Closest {
            boxes: &self.0,
            ray,
            visits,
        })
    }

    /// Returns the number of nodes and of blocks of the tree.
    #[must_use]
    pub fn size(&self) -> Visits {
        Visits {
            nodes: self.0.nodes.len() as u64,
            blocks: self.0.blocks.len() as u64,
        }
    }

    /// Returns the size of the nodes and blocks in bytes.
    #[must_use]
    pub fn memory(&self) -> usize {
        size_of_val(self.0.nodes.as_slice()) + size_of_val(self.0.blocks.as_slice())
    }
}

/// Reason why a tree was not built.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum TreeError {
    /// Distances in the scene are so much larger than radii that rounding would show.
    Scale {
        /// Diagonal of the scene, in centimetres.
        size: f32,
        /// Largest radius of the thinnest strand, in centimetres.
        radius: f32,
    },
}

impl fmt::Display for TreeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scale { size, radius } => write!(
                f,
                "a scene must be at most {LARGEST_SCALE} times as large as the radius of its thinnest strand, got {size} \
                 cm and {radius} cm"
            ),
        }
    }
}

impl core::error::Error for TreeError {}
