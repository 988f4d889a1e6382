//! Strands of hair: polylines with a radius per node.

use super::Bounds;
use core::fmt;
use core::ops::Range;
use glam::Vec3;

/// Shorter segments are dropped: their direction is made of rounding errors.
const SHORTEST: f32 = 1e-7;
/// Coordinates are at most this far from 0, in centimetres.
const FARTHEST: f32 = 1e6;
/// Bounds the number of nodes, so that numbers of segments, blocks and tree nodes fit 31 bits.
const MOST_NODES: usize = 1 << 31;

/// Strands of hair, flattened to polylines from root to tip, with a radius per node.
///
/// A segment is numbered by its node on the root side. [`numbers`](Self::numbers) lists the numbers.
///
/// ```
/// use glam::Vec3;
/// use hairis_render::geometry::Strands;
/// let mut builder = Strands::builder();
/// builder.push([(Vec3::ZERO, 0.01), (Vec3::X, 0.01), (Vec3::X + Vec3::Y, 0.0)])?;
/// let strands = builder.finish();
/// assert_eq!((strands.strands(), strands.segments()), (1, 2));
/// assert!((strands.tangent(0, 1.0) - Vec3::new(0.5, 0.5, 0.0).normalize()).length() < 1e-6);
/// # Ok::<(), hairis_render::geometry::GeometryError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Strands {
    nodes: Vec<StrandNode>,
    tangents: Vec<Vec3>,
    /// The first node of each strand, and the number of nodes.
    first: Vec<u32>,
    bounds: Bounds,
}

/// Place and radius side by side: both are read for every hit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StrandNode {
    position: Vec3,
    radius: f32,
}

impl Strands {
    /// Takes strands one by one.
    #[must_use]
    pub fn builder() -> Builder {
        Builder::default()
    }

    /// Number of strands.
    #[must_use]
    pub fn strands(&self) -> usize {
        self.first.len() - 1
    }

    /// Number of segments.
    #[must_use]
    pub fn segments(&self) -> usize {
        self.nodes.len() - self.strands()
    }

    /// Number of nodes, one more per strand than segments.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// The smallest box that holds every round segment.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The nodes of a strand; all but the last number its segments.
    ///
    /// # Panics
    ///
    /// If there is no such strand.
    #[must_use]
    pub fn nodes_of(&self, strand: u32) -> Range<u32> {
        let strand = strand as usize;
        self.first[strand]..self.first[strand + 1]
    }

    /// The numbers of all segments, each with that of its strand, in ascending order.
    pub fn numbers(&self) -> impl Iterator<Item = (u32, u32)> {
        (0..)
            .zip(self.first.windows(2))
            .flat_map(|(strand, ends)| (ends[0]..ends[1] - 1).map(move |k| (strand, k)))
    }

    /// The point of the axis at `s`, 0 at the end of the root and 1 at that of the tip.
    ///
    /// # Panics
    ///
    /// If there is no such segment. `radius` and `tangent` do, too.
    #[inline]
    #[must_use]
    pub fn position(&self, segment: u32, s: f32) -> Vec3 {
        let k = segment as usize;
        self.nodes[k].position + s * (self.nodes[k + 1].position - self.nodes[k].position)
    }

    /// The radius at `s`.
    ///
    /// # Panics
    ///
    /// See [`position`](Self::position).
    #[inline]
    #[must_use]
    pub fn radius(&self, segment: u32, s: f32) -> f32 {
        let k = segment as usize;
        self.nodes[k].radius + s * (self.nodes[k + 1].radius - self.nodes[k].radius)
    }

    /// The place of a node.
    ///
    /// # Panics
    ///
    /// If there is no such node.
    #[must_use]
    pub fn node_position(&self, node: u32) -> Vec3 {
        self.nodes[node as usize].position
    }

    /// The largest radius; 0 without strands.
    #[must_use]
    pub fn thickest(&self) -> f32 {
        self.nodes
            .iter()
            .map(|node| node.radius)
            .fold(0.0, f32::max)
    }

    /// Multiplies the radii of a strand.
    pub(crate) fn widen(&mut self, strand: u32, factor: f32) {
        for k in self.nodes_of(strand) {
            let node = &mut self.nodes[k as usize];
            node.radius *= factor;
            self.bounds = self.bounds.with(node.position - node.radius);
            self.bounds = self.bounds.with(node.position + node.radius);
        }
    }

    /// The radius at a node.
    ///
    /// # Panics
    ///
    /// If there is no such node.
    #[must_use]
    pub fn node_radius(&self, node: u32) -> f32 {
        self.nodes[node as usize].radius
    }

    /// The shading tangent at `s`, from root to tip, unit: interpolated between those of the nodes, which are means of
    /// the directions of the segments that meet there.
    ///
    /// # Panics
    ///
    /// See [`position`](Self::position).
    #[inline]
    #[must_use]
    pub fn tangent(&self, segment: u32, s: f32) -> Vec3 {
        let k = segment as usize;
        let tangent = self.tangents[k] + s * (self.tangents[k + 1] - self.tangents[k]);
        // Where a strand turns back at both ends, the tangents of the nodes may cancel.
        tangent
            .try_normalize()
            .unwrap_or_else(|| (self.nodes[k + 1].position - self.nodes[k].position).normalize())
    }
}

/// Takes strands one by one, each checked, and makes [`Strands`] of them.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    nodes: Vec<StrandNode>,
    last: Vec<u32>,
    dropped_nodes: usize,
    dropped_strands: usize,
}

impl Builder {
    /// Adds a strand, given by positions and radii from root to tip. Of nodes that lie on one another the first is kept;
    /// a strand that has less than two left is dropped.
    ///
    /// # Errors
    ///
    /// If a coordinate or radius is not finite, a coordinate above 1e6 cm in magnitude, or a radius negative or above
    /// 1e6 cm; and if there are too many nodes. Nothing is added then.
    pub fn push(
        &mut self,
        nodes: impl IntoIterator<Item = (Vec3, f32)>,
    ) -> Result<(), GeometryError> {
        let start = self.nodes.len();
        let mut dropped = 0;
        for (node, (position, radius)) in nodes.into_iter().enumerate() {
            let far = position.abs().cmpgt(Vec3::splat(FARTHEST)).any();
            let wrong = if far || !position.is_finite() {
                Some(GeometryError::Position { node, position })
            } else if !(0.0..=FARTHEST).contains(&radius) {
                Some(GeometryError::Radius { node, radius })
            } else if self.nodes.len() >= MOST_NODES {
                Some(GeometryError::TooMany)
            } else {
                None
            };
            if let Some(error) = wrong {
                self.nodes.truncate(start);
                return Err(error);
            }
            let last = self.nodes[start..].last();
            if last.is_some_and(|last| Self::coincide(last.position, position)) {
                dropped += 1;
            } else {
                self.nodes.push(StrandNode { position, radius });
            }
        }
        self.dropped_nodes += dropped;
        if self.nodes.len() < start + 2 {
            self.nodes.truncate(start);
            self.dropped_strands += 1;
        } else {
            self.last
                .push(u32::try_from(self.nodes.len()).map_err(|_| GeometryError::TooMany)?);
        }
        Ok(())
    }

    /// Whether two nodes in a row count as one.
    pub(crate) fn coincide(a: Vec3, b: Vec3) -> bool {
        a.distance(b) < SHORTEST
    }

    /// Number of strands so far.
    #[must_use]
    pub fn strands(&self) -> usize {
        self.last.len()
    }

    /// Number of nodes that lay on the node before them.
    #[must_use]
    pub fn dropped_nodes(&self) -> usize {
        self.dropped_nodes
    }

    /// Number of strands with less than two nodes.
    #[must_use]
    pub fn dropped_strands(&self) -> usize {
        self.dropped_strands
    }

    /// The strands.
    #[must_use]
    pub fn finish(self) -> Strands {
        let mut tangents = Vec::with_capacity(self.nodes.len());
        let first: Vec<u32> = core::iter::once(0).chain(self.last).collect();
        let mut bounds = Bounds::EMPTY;
        for ends in first.windows(2) {
            let strand = &self.nodes[ends[0] as usize..ends[1] as usize];
            let direction = |k: usize| (strand[k + 1].position - strand[k].position).normalize();
            let mut before = direction(0);
            for (k, node) in strand.iter().enumerate() {
                bounds = bounds
                    .with(node.position - node.radius)
                    .with(node.position + node.radius);
                let after = if k + 1 < strand.len() {
                    direction(k)
                } else {
                    before
                };
                // A strand that turns back on itself has no mean direction there.
                tangents.push((before + after).try_normalize().unwrap_or(before));
                before = after;
            }
        }
        Strands {
            nodes: self.nodes,
            tangents,
            first,
            bounds,
        }
    }
}

/// Why a strand was refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum GeometryError {
    /// A coordinate was not finite, or too far away.
    Position {
        /// The node of the strand, from 0.
        node: usize,
        /// Position of the node.
        position: Vec3,
    },
    /// A radius was negative, not finite, or too large.
    Radius {
        /// The node of the strand, from 0.
        node: usize,
        /// Radius at the node.
        radius: f32,
    },
    /// A setting of a groom was not finite, or out of its range.
    Setting {
        /// Which.
        name: &'static str,
        /// Value given.
        value: f32,
        /// The least that it may be.
        least: f32,
        /// The most that it may be.
        most: f32,
    },
    /// A number of things of a groom was out of its range.
    Count {
        /// Name of the things that are counted.
        name: &'static str,
        /// Number given.
        value: usize,
        /// The least that it may be.
        least: usize,
        /// The most that it may be.
        most: usize,
    },
    /// There were more nodes than can be numbered.
    TooMany,
}

impl fmt::Display for GeometryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Position { node, position } => {
                write!(
                    f,
                    "coordinates must be finite and at most {FARTHEST} cm, got {position} at node {node}"
                )
            }
            Self::Radius { node, radius } => {
                write!(
                    f,
                    "radius must be in [0, {FARTHEST}] cm, got {radius} at node {node}"
                )
            }
            Self::Setting {
                name,
                value,
                least,
                most,
            } => {
                write!(f, "`{name}` must be in [{least}, {most}], got {value}")
            }
            Self::Count {
                name,
                value,
                least,
                most,
            } => {
                write!(f, "`{name}` must be from {least} to {most}, got {value}")
            }
            Self::TooMany => write!(f, "strands must have fewer than {MOST_NODES} nodes in all"),
        }
    }
}

impl core::error::Error for GeometryError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_nodes_are_refused_and_leave_nothing() {
        let mut builder = Strands::builder();
        builder
            .push([(Vec3::ZERO, 0.1), (Vec3::X, 0.1)])
            .expect("a cylinder");
        for position in [
            Vec3::new(f32::NAN, 0.0, 0.0),
            Vec3::new(0.0, 0.0, f32::INFINITY),
            Vec3::new(0.0, -1.1e6, 0.0),
        ] {
            let error = builder
                .push([(Vec3::Y, 0.1), (position, 0.1)])
                .expect_err("a node nowhere");
            assert!(
                matches!(error, GeometryError::Position { node: 1, .. }),
                "{error}"
            );
        }
        for radius in [f32::NAN, f32::INFINITY, -0.1] {
            let error = builder
                .push([(Vec3::Y, radius), (Vec3::X, 0.1)])
                .expect_err("no radius");
            assert!(
                matches!(error, GeometryError::Radius { node: 0, .. }),
                "{error}"
            );
        }
        let strands = builder.finish();
        assert_eq!(
            (strands.strands(), strands.nodes()),
            (1, 2),
            "what was right"
        );
    }

    #[test]
    fn nodes_and_strands_without_length_are_dropped() {
        let mut builder = Strands::builder();
        builder
            .push([(Vec3::ZERO, 0.1), (Vec3::ZERO, 0.2), (Vec3::X, 0.1)])
            .expect("finite nodes");
        builder.push([(Vec3::ONE, 0.1); 3]).expect("finite nodes");
        builder.push([]).expect("no node is wrong");
        assert_eq!(
            (builder.dropped_nodes(), builder.dropped_strands()),
            (3, 2),
            "one, and all but one of three"
        );
        let strands = builder.finish();
        assert_eq!(
            (
                strands.strands(),
                strands.segments(),
                strands.node_radius(0)
            ),
            (1, 1, 0.1),
            "what is left"
        );
    }

    #[test]
    fn strands_that_turn_back_have_tangents() {
        let mut builder = Strands::builder();
        builder
            .push([Vec3::ZERO, Vec3::X, Vec3::ZERO, Vec3::X].map(|p| (p, 0.1)))
            .expect("finite nodes");
        let strands = builder.finish();
        for (k, direction) in [(0, Vec3::X), (1, Vec3::NEG_X), (2, Vec3::X)] {
            let tangent = strands.tangent(k, 0.5);
            assert!(
                tangent.is_normalized() && tangent.dot(direction).abs() > 0.999,
                "{tangent} on segment {k}"
            );
        }
    }
}
