//! Chunks of the operations of a derivative, and the places where packets keep numbers from chunk to chunk.

use core::ops::{Range, RangeInclusive};
use hairis_shaders::Graph;
use std::collections::BTreeSet;

/// Number of operations of a chunk. Two chunks fit the window of a CPU, which can then begin a packet before the previous one is done.
const OPERATIONS: RangeInclusive<usize> = 48..=80;

/// Operations that rows need, in the order of the graph, chunk by chunk.
pub(crate) struct Chunks<'a> {
    graph: &'a Graph,
    order: Vec<u32>,
    /// Position of the last operation that reads a number.
    last: Vec<usize>,
    /// Operations of the chunk.
    chunk: Range<usize>,
    /// Numbers that packets keep and that the current chunk has already named.
    named: BTreeSet<u32>,
    /// Place of each number in a packet, if the packet keeps it.
    slots: Vec<Option<usize>>,
    /// Places of numbers that no later operation reads.
    free: Vec<usize>,
    len: usize,
}

impl<'a> Chunks<'a> {
    /// Prepares the chunks of the operations that these rows need. Packets keep `len` other numbers first.
    pub(crate) fn new(graph: &'a Graph, rows: &[u32], len: usize) -> Self {
        let places = (0_u32..).zip(graph.nodes()).zip(graph.needed(rows));
        let places = places.filter(|((_, node), is_needed)| *is_needed && node.is_computed());
        let order: Vec<u32> = places.map(|((place, _), _)| place).collect();
        let mut last = vec![0; graph.nodes().len()];
        for (at, place) in order.iter().enumerate() {
            for operand in graph.node(*place).operands() {
                last[*operand as usize] = at;
            }
        }
        Self {
            graph,
            order,
            slots: vec![None; last.len()],
            last,
            chunk: 0..0,
            named: BTreeSet::new(),
            free: Vec::new(),
            len,
        }
    }

    /// Returns the count of the numbers that a packet keeps.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Returns the operations of the next chunk, which ends where the fewest of its numbers are read later.
    pub(crate) fn next_chunk(&mut self) -> Option<Vec<u32>> {
        for place in core::mem::take(&mut self.named) {
            if self.last[place as usize] < self.chunk.end {
                self.free.extend(self.slots[place as usize]);
            }
        }
        let start = self.chunk.end;
        let left = self.order.len() - start;
        let len = if left <= *OPERATIONS.end() {
            left
        } else {
            OPERATIONS.min_by_key(|len| {
                let end = start + len;
                let places = self.order[start..end].iter();
                places
                    .filter(|place| self.last[**place as usize] >= end)
                    .count()
            })?
        };
        self.chunk = start..start + len;
        (len > 0).then(|| self.order[self.chunk.clone()].to_vec())
    }

    /// Returns the operands of an operation that the chunk has not named yet, and their places in a packet.
    pub(crate) fn loaded(&mut self, place: u32) -> Vec<(u32, usize)> {
        let mut loaded = Vec::new();
        for operand in self.graph.node(place).operands() {
            if let Some(slot) = self.slots[*operand as usize]
                && self.named.insert(*operand)
            {
                loaded.push((*operand, slot));
            }
        }
        loaded
    }

    /// Returns a place in a packet for the result of an operation of the chunk if a later chunk reads it.
    pub(crate) fn kept(&mut self, place: u32) -> Option<usize> {
        if self.last[place as usize] < self.chunk.end {
            return None;
        }
        let slot = self.free.pop().unwrap_or_else(|| {
            self.len += 1;
            self.len - 1
        });
        self.slots[place as usize] = Some(slot);
        self.named.insert(place);
        Some(slot)
    }
}
