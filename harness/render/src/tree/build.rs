//! Builds the tree from the root down: sets of segments are divided until eight parts are left, and so on with each.

use super::block::Block;
use super::node::{Child, Node};
use super::split::{Extent, Primitive, middle, split};
use crate::geometry::{Bounds, Strands};
use core::ops::Range;
use glam::Vec3;
use rayon::prelude::*;

/// Down to this level sets are divided where it is cheapest; below, in the middle.
const BY_COST: usize = 14;
/// No node is deeper: eleven levels of halves hold 2^33 segments.
pub(super) const DEEPEST: usize = BY_COST + 11;
/// Parts with more segments than this are built in parallel.
const PARALLEL: usize = 4096;

/// A part of the tree before it has its place.
enum Draft {
    /// The segments of a block, as a range of all in their final order.
    Block(Range<usize>),
    Node(Vec<(Bounds, Self)>),
}

/// The nodes, the root first, and the blocks. Both are in the order of a search that turns to the first child first.
pub(super) fn build(strands: &Strands) -> (Vec<Node>, Vec<Block>) {
    let mut primitives = primitives(strands);
    let extent = Extent::of(&primitives);
    let root = match draft(&mut primitives, extent, 0, 0) {
        Draft::Node(children) => children,
        Draft::Block(range) if range.is_empty() => Vec::new(),
        block => vec![(extent.bounds, block)],
    };
    let (mut nodes, mut ranges) = (Vec::new(), Vec::new());
    place(root, &mut nodes, &mut ranges);
    let block = |range: Range<usize>| {
        Block::new(
            strands,
            primitives[range].iter().map(|p| (p.strand, p.number)),
        )
    };
    (nodes, ranges.into_par_iter().map(block).collect())
}

/// The boxes of all segments. A ray that passes an end within its radius meets it, so that they are those of spheres about
/// both ends; they have some slack against rounding, for rays that start within a few scenes' sizes.
fn primitives(strands: &Strands) -> Vec<Primitive> {
    let bounds = strands.bounds();
    let slack = if bounds.is_empty() {
        0.0
    } else {
        bounds.lo.abs().max(bounds.hi.abs()).max_element() / (1 << 21) as f32
    };
    let sphere = |k, s| {
        let (centre, radius): (Vec3, f32) = (strands.position(k, s), strands.radius(k, s) + slack);
        Bounds {
            lo: centre - radius,
            hi: centre + radius,
        }
    };
    let box_of = |k| sphere(k, 0.0).union(&sphere(k, 1.0));
    strands
        .numbers()
        .map(|(strand, number)| Primitive {
            bounds: box_of(number),
            strand,
            number,
        })
        .collect()
}

/// The tree over `primitives`, whose order it changes; `first` is the place of the first of them among all.
fn draft(primitives: &mut [Primitive], extent: Extent, first: usize, depth: usize) -> Draft {
    if primitives.len() <= 8 {
        return Draft::Block(first..first + primitives.len());
    }
    let large = primitives.len() > PARALLEL;
    let mut next = first;
    let parts = divide(primitives, extent, depth < BY_COST)
        .into_iter()
        .map(|(part, extent)| {
            let first = next;
            next += part.len();
            (part, extent, first)
        });
    let below = |(part, extent, first): (&mut [Primitive], Extent, usize)| {
        (extent.bounds, draft(part, extent, first, depth + 1))
    };
    Draft::Node(if large {
        parts
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(below)
            .collect()
    } else {
        parts.map(below).collect()
    })
}

/// At most eight parts, in order. The part with the largest surface is divided first, or the one with the most segments.
fn divide(
    primitives: &mut [Primitive],
    extent: Extent,
    by_cost: bool,
) -> Vec<(&mut [Primitive], Extent)> {
    let mut parts = vec![(primitives, extent)];
    while parts.len() < 8 {
        let weight = |(part, extent): &(&mut [Primitive], Extent)| {
            if by_cost {
                extent.bounds.half_area()
            } else {
                part.len() as f32
            }
        };
        let large = parts
            .iter()
            .enumerate()
            .filter(|(_, (part, _))| part.len() > 8);
        let largest = large.max_by(|(_, a), (_, b)| weight(a).total_cmp(&weight(b)));
        let Some((index, _)) = largest else { break };
        let (part, extent) = parts.remove(index);
        let middle = if by_cost {
            split(part, &extent)
        } else {
            middle(part.len())
        };
        let (lower, upper) = part.split_at_mut(middle);
        let (lower_extent, upper_extent) = (Extent::of(lower), Extent::of(upper));
        parts.insert(index, (upper, upper_extent));
        parts.insert(index, (lower, lower_extent));
    }
    parts
}

/// Writes a node and all below it, and gives its index. Blocks are listed by their segments.
fn place(
    children: Vec<(Bounds, Draft)>,
    nodes: &mut Vec<Node>,
    blocks: &mut Vec<Range<usize>>,
) -> usize {
    let index = nodes.len();
    nodes.push(Node::new(&[]));
    let mut links = Vec::with_capacity(8);
    for (bounds, child) in children {
        let link = match child {
            Draft::Node(children) => Child::node(place(children, nodes, blocks)),
            Draft::Block(range) => {
                blocks.push(range);
                Child::block(blocks.len() - 1)
            }
        };
        links.push((bounds, link));
    }
    nodes[index] = Node::new(&links);
    index
}
