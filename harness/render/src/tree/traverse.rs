//! Search through the tree, which visits near boxes first.

use super::Boxes;
use super::block::Leaf;
use super::build::DEEPEST;
use super::node::Child;
use super::ray::{Ray, Spread};
use hairis::simd::{Kernel, Lanes, f32x8};

/// Numbers of nodes and blocks, of a tree or of those that a search visits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Number of nodes, of eight boxes each.
    pub nodes: u64,
    /// Number of blocks, of eight segments or triangles each.
    pub blocks: u64,
}

/// Counter of the nodes and blocks that a search visits, or of nothing.
pub(super) trait Count {
    fn node(&mut self);
    fn block(&mut self);
}

impl Count for () {
    #[inline(always)]
    fn node(&mut self) {}
    #[inline(always)]
    fn block(&mut self) {}
}

impl Count for Visits {
    #[inline(always)]
    fn node(&mut self) {
        self.nodes += 1;
    }
    #[inline(always)]
    fn block(&mut self) {
        self.blocks += 1;
    }
}

/// Search for the nearest hit of a ray.
pub(super) struct Closest<'a, B, C> {
    pub(super) boxes: &'a Boxes<B>,
    pub(super) ray: &'a Ray,
    pub(super) visits: &'a mut C,
}

/// Search for any hit of a ray.
pub(super) struct Any<'a, B, C> {
    pub(super) boxes: &'a Boxes<B>,
    pub(super) ray: &'a Ray,
    pub(super) visits: &'a mut C,
}

impl<B: Leaf, C: Count> Kernel for Closest<'_, B, C> {
    type Output = Option<B::Hit>;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> Option<B::Hit> {
        search::<L, B, C, false>(self.boxes, self.ray, self.visits)
    }
}

impl<B: Leaf, C: Count> Kernel for Any<'_, B, C> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> bool {
        search::<L, B, C, true>(self.boxes, self.ray, self.visits).is_some()
    }
}

/// Test of a ray against every block.
pub(super) struct All<'a, B> {
    pub(super) boxes: &'a Boxes<B>,
    pub(super) ray: &'a Ray,
}

impl<B: Leaf> Kernel for All<'_, B> {
    type Output = Vec<B::Hit>;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> Vec<B::Hit> {
        let spread = Spread::<L>::new(self.ray, self.boxes.meet);
        let mut hits = Vec::new();
        for block in &self.boxes.blocks {
            let (met, [t, s]) = block.meet(&spread, f32::INFINITY);
            let lanes = (0..8).filter(|lane| met >> lane & 1 == 1);
            hits.extend(
                lanes.map(|lane| block.hit(lane, self.ray, t.as_array()[lane], s.as_array()[lane])),
            );
        }
        hits
    }
}

/// The nearest hit so far.
#[derive(Clone, Copy)]
struct Best {
    t: f32,
    s: f32,
    block: usize,
    lane: usize,
    number: u32,
}

/// Largest number of children that wait: seven siblings at each level, and the root.
const STACK: usize = 7 * DEEPEST + 1;

/// Returns the nearest hit, or with `ANY` the first that is found, which only shows that there is one.
#[inline(always)]
fn search<L: Lanes<Stored = f32x8>, B: Leaf, C: Count, const ANY: bool>(
    tree: &Boxes<B>,
    ray: &Ray,
    visits: &mut C,
) -> Option<B::Hit> {
    let spread = Spread::<L>::new(ray, tree.meet);
    // No segment has a number below 0, so that a hit at `t_max` itself does not count.
    let mut best = Best {
        t: ray.t_max,
        s: 0.0,
        block: usize::MAX,
        lane: 0,
        number: 0,
    };
    let mut stack = [(Child::ROOT, 0.0_f32); STACK];
    let mut waiting = 1;
    while waiting > 0 {
        waiting -= 1;
        let (child, near) = stack[waiting];
        if near > best.t {
            continue;
        }
        if child.is_block() {
            visits.block();
            let block = &tree.blocks[child.index()];
            // Segments as near as the best one may have lower numbers.
            let limit = if ANY { best.t } else { best.t.next_up() };
            let (mut met, [t, s]) = block.meet(&spread, limit);
            while met != 0 {
                let lane = met.trailing_zeros() as usize;
                met &= met - 1;
                let (t, number) = (t.as_array()[lane], block.number(lane));
                let nearer = t < best.t || (t == best.t && number < best.number);
                if nearer && !block.skipped(lane, t, ray) {
                    best = Best {
                        t,
                        s: s.as_array()[lane],
                        block: child.index(),
                        lane,
                        number,
                    };
                    if ANY {
                        met = 0;
                        waiting = 0;
                    }
                }
            }
        } else {
            visits.node();
            let node = &tree.nodes[child.index()];
            let (mut passed, near) = node.pass(&spread, best.t);
            let first = waiting;
            while passed != 0 {
                let lane = passed.trailing_zeros() as usize;
                passed &= passed - 1;
                let near = near.as_array()[lane];
                // Insert the child so that the nearest is on top. Rays from hits that only test whether there is anything gain from that,
                // too: there are a fifth more of them per second.
                let mut place = waiting;
                while place > first && stack[place - 1].1 < near {
                    stack[place] = stack[place - 1];
                    place -= 1;
                }
                stack[place] = (node.child(lane), near);
                waiting += 1;
            }
        }
    }
    let block = tree.blocks.get(best.block)?;
    Some(block.hit(best.lane, ray, best.t, best.s))
}
