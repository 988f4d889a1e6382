//! Construction of the tree from the root down: a set of primitives is divided until there are eight
//! parts, and each part is divided in turn.

use super::node::{Child, Node};
use super::split::{Extent, Primitive, middle, split};
use crate::geometry::Bounds;
use core::ops::Range;
use rayon::prelude::*;

/// Level down to which sets are divided where it is cheapest; below, they are divided in the middle.
const BY_COST: usize = 14;
/// Level of the deepest node: eleven levels of halves hold 2^33 segments.
pub(super) const DEEPEST: usize = BY_COST + 11;
/// Number of primitives above which parts are built in parallel.
const PARALLEL: usize = 4096;

/// Part of the tree before it has its place.
enum Draft {
    /// Primitives of a block, as a range of all in their final order.
    Block(Range<usize>),
    Node(Vec<(Bounds, Self)>),
}

/// Returns the nodes, the root first, and the blocks, which `block` makes. Both are in the order of a
/// search that visits the first child first.
pub(super) fn build<B: Send>(
    mut primitives: Vec<Primitive>,
    block: impl Fn(&[Primitive]) -> B + Sync,
) -> (Vec<Node>, Vec<B>) {
    let extent = Extent::of(&primitives);
    let root = match draft(&mut primitives, extent, 0, 0) {
        Draft::Node(children) => children,
        Draft::Block(range) if range.is_empty() => Vec::new(),
        block => vec![(extent.bounds, block)],
    };
    let (mut nodes, mut ranges) = (Vec::new(), Vec::new());
    place(root, &mut nodes, &mut ranges);
    let block = |range: Range<usize>| block(&primitives[range]);
    (nodes, ranges.into_par_iter().map(block).collect())
}

/// Drafts the tree over `primitives`, and changes their order. `first` is the index of the first of them among all.
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

/// Divides primitives into at most eight parts, in order. The part with the largest surface is divided
/// first, or, without `by_cost`, the part with the most primitives.
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

/// Writes a node and all nodes below it, and returns its index. Blocks are listed by their primitives.
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
