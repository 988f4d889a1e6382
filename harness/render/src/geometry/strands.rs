//! Strands of hair, as polylines with a radius per node.

use super::bounds::Bounds;
use core::fmt;
use core::ops::Range;
use glam::Vec3;

/// Length below which segments are dropped, because their direction consists of rounding errors.
const SHORTEST: f32 = 1e-7;
/// Largest magnitude of a coordinate, in centimetres.
const FARTHEST: f32 = 1e6;
/// Largest number of nodes, so that numbers of segments, blocks and tree nodes fit into 31 bits.
const MOST_NODES: usize = 1 << 31;

/// Strands of hair, flattened to polylines from root to tip, with a radius per node.
///
/// A segment has the number of its node on the root side. [`numbers`](Self::numbers) lists the numbers.
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
    /// First node of each strand, and the number of nodes.
    first: Vec<u32>,
    bounds: Bounds,
}

/// Position and radius side by side, because both are read for every hit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StrandNode {
    position: Vec3,
    radius: f32,
}

impl Strands {
    /// Returns a builder that takes strands one by one.
    #[must_use]
    pub fn builder() -> Builder {
        Builder::default()
    }

    /// Returns the number of strands.
    #[must_use]
    pub fn strands(&self) -> usize {
        self.first.len() - 1
    }

    /// Returns the number of segments of all strands.
    #[must_use]
    pub fn segments(&self) -> usize {
        self.nodes.len() - self.strands()
    }

    /// Returns the number of nodes, which is one more per strand than that of segments.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the smallest box that holds every round segment.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns the nodes of a strand; all but the last number its segments.
    ///
    /// # Panics
    ///
    /// Panics if there is no strand of this number.
    #[must_use]
    pub fn nodes_of(&self, strand: u32) -> Range<u32> {
        let strand = strand as usize;
        self.first[strand]..self.first[strand + 1]
    }

    /// Iterates over all segments in ascending order, each as the number of its strand and its own number.
    pub fn numbers(&self) -> impl Iterator<Item = (u32, u32)> {
        (0..)
            .zip(self.first.windows(2))
            .flat_map(|(strand, ends)| (ends[0]..ends[1] - 1).map(move |k| (strand, k)))
    }

    /// Returns the point of the axis of a segment at `s`, from 0 at the root's end to 1 at the tip's end.
    ///
    /// # Panics
    ///
    /// Panics if there is no node of this number, or none after it.
    #[inline]
    #[must_use]
    pub fn position(&self, segment: u32, s: f32) -> Vec3 {
        let k = segment as usize;
        self.nodes[k].position + s * (self.nodes[k + 1].position - self.nodes[k].position)
    }

    /// Returns the radius of a segment at `s`, interpolated between the radii of its nodes.
    ///
    /// # Panics
    ///
    /// Panics as [`position`](Self::position) does.
    #[inline]
    #[must_use]
    pub fn radius(&self, segment: u32, s: f32) -> f32 {
        let k = segment as usize;
        self.nodes[k].radius + s * (self.nodes[k + 1].radius - self.nodes[k].radius)
    }

    /// Returns the position of the axis of a strand at a node.
    ///
    /// # Panics
    ///
    /// Panics if there is no node of this number.
    #[must_use]
    pub fn node_position(&self, node: u32) -> Vec3 {
        self.nodes[node as usize].position
    }

    /// Returns the largest radius of any node, which is 0 without strands.
    #[must_use]
    pub fn thickest(&self) -> f32 {
        self.nodes
            .iter()
            .map(|node| node.radius)
            .fold(0.0, f32::max)
    }

    /// Multiplies the radii of a strand by a factor, and widens the bounds.
    pub(crate) fn widen(&mut self, strand: u32, factor: f32) {
        for k in self.nodes_of(strand) {
            let node = &mut self.nodes[k as usize];
            node.radius *= factor;
            self.bounds = self.bounds.with(node.position - node.radius);
            self.bounds = self.bounds.with(node.position + node.radius);
        }
    }

    /// Returns the radius of a strand at a node.
    ///
    /// # Panics
    ///
    /// Panics if there is no node of this number.
    #[must_use]
    pub fn node_radius(&self, node: u32) -> f32 {
        self.nodes[node as usize].radius
    }

    /// Returns the shading tangent at `s`, from root to tip, unit. It is interpolated between the tangents of the nodes, which are
    /// means of the directions of the segments that meet there.
    ///
    /// # Panics
    ///
    /// Panics as [`position`](Self::position) does.
    #[inline]
    #[must_use]
    pub fn tangent(&self, segment: u32, s: f32) -> Vec3 {
        let k = segment as usize;
        let tangent = self.tangents[k] + s * (self.tangents[k + 1] - self.tangents[k]);
        // If a strand turns back at both ends, the tangents of the nodes may cancel.
        tangent
            .try_normalize()
            .unwrap_or_else(|| (self.nodes[k + 1].position - self.nodes[k].position).normalize())
    }
}

/// Builder of [`Strands`], which takes strands one by one and checks each.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    nodes: Vec<StrandNode>,
    last: Vec<u32>,
    dropped_nodes: usize,
    dropped_strands: usize,
}

impl Builder {
    /// Adds a strand, given by positions and radii from root to tip. Of nodes that lie on one another, the first is kept.
    /// A strand with fewer than two nodes left is dropped.
    ///
    /// # Errors
    ///
    /// Returns an error, and adds nothing, if a coordinate or radius is not finite, if a coordinate is above 1e6 cm in magnitude,
    /// if a radius is negative or above 1e6 cm, or if there are too many nodes.
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

    /// Returns true if two successive nodes count as one.
    pub(crate) fn coincide(a: Vec3, b: Vec3) -> bool {
        a.distance(b) < SHORTEST
    }

    /// Returns the number of strands that were added so far.
    #[must_use]
    pub fn strands(&self) -> usize {
        self.last.len()
    }

    /// Returns the number of nodes that were dropped, because they lay on the node before them.
    #[must_use]
    pub fn dropped_nodes(&self) -> usize {
        self.dropped_nodes
    }

    /// Returns the number of strands that were dropped, because fewer than two nodes were left.
    #[must_use]
    pub fn dropped_strands(&self) -> usize {
        self.dropped_strands
    }

    /// Returns the strands that were added, with their tangents and their bounds.
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
                // A strand that turns back on itself has no mean direction at that node.
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

/// Reason why a strand, or a setting of procedural hair, was rejected.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum GeometryError {
    /// A coordinate was not finite, or too far away.
    Position {
        /// Index of the node in the strand, from 0.
        node: usize,
        /// Position of the node.
        position: Vec3,
    },
    /// A radius was negative, not finite, or too large.
    Radius {
        /// Index of the node in the strand, from 0.
        node: usize,
        /// Radius at the node.
        radius: f32,
    },
    /// A setting of a groom was not finite, or out of its range.
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Value given.
        value: f32,
        /// Smallest value allowed.
        least: f32,
        /// Largest value allowed.
        most: f32,
    },
    /// A count of a groom was out of its range.
    Count {
        /// Name of the count.
        name: &'static str,
        /// Number given.
        value: usize,
        /// Smallest number allowed.
        least: usize,
        /// Largest number allowed.
        most: usize,
    },
    /// There were more nodes than can be numbered.
    TooMany,
}

impl GeometryError {
    /// Checks counts, each with its name, its least and its largest value.
    pub(crate) fn check_counts<const N: usize>(
        counts: [(&'static str, usize, usize, usize); N],
    ) -> Result<(), Self> {
        for (name, value, least, most) in counts {
            if !(least..=most).contains(&value) {
                return Err(Self::Count {
                    name,
                    value,
                    least,
                    most,
                });
            }
        }
        Ok(())
    }

    /// Checks settings, each with its name, its least and its largest value. NaN lies in no range.
    pub(crate) fn check_settings<const N: usize>(
        settings: [(&'static str, f32, f32, f32); N],
    ) -> Result<(), Self> {
        for (name, value, least, most) in settings {
            if !(least..=most).contains(&value) {
                return Err(Self::Setting {
                    name,
                    value,
                    least,
                    most,
                });
            }
        }
        Ok(())
    }
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
