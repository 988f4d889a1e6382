//! Candidates of a shading point, stored by column.

use super::cells::{CELLS, cells};
use super::{Candidate, MOST};
use crate::lights::LightSample8;
use glam::Vec3;
use hairis::resample::{Counts, Partition, Weighed8, choose};
use hairis::simd::f32x8;
use hairis::{Eval8, Vec3x8};

/// Cell of candidates without a weight, which comes after all others.
#[expect(clippy::cast_possible_truncation, reason = "64")]
const NO_WEIGHT: u8 = CELLS as u8;

/// Columns of candidates, with their weights and cells.
#[derive(Clone, Copy, Debug)]
pub(in crate::transport) struct Candidates {
    direction: [[f32; MOST]; 3],
    cos: [f32; MOST],
    distance: [f32; MOST],
    /// Red, green, blue, and the weight.
    weighed: [[f32; MOST]; 4],
    cell: [u8; MOST],
    len: usize,
    /// Candidates with a weight, cell by cell: their indices, contributions and weights.
    order: [u8; MOST],
    ordered: [[f32; MOST]; 4],
}

impl Default for Candidates {
    fn default() -> Self {
        let one = [0.0; MOST];
        Self {
            direction: [one; 3],
            cos: one,
            distance: one,
            weighed: [one; 4],
            cell: [0; MOST],
            len: 0,
            order: [0; MOST],
            ordered: [one; 4],
        }
    }
}

impl Candidates {
    /// Removes all candidates.
    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Weighs eight directions, and keeps the first `limit` of them.
    #[inline]
    pub(super) fn push(
        &mut self,
        eval: &Eval8,
        cos: &f32x8,
        light: &LightSample8,
        counts: Counts,
        limit: u32,
    ) {
        let weighed = Weighed8::new(
            eval,
            cos,
            &light.radiance,
            &light.pdf,
            counts,
            Partition::All,
        );
        let range = self.len..self.len + 8;
        let write = |column: &mut [f32; MOST], lanes: &f32x8| {
            column[range.clone()].copy_from_slice(lanes.as_array())
        };
        let Vec3x8 { x, y, z } = light.direction;
        self.direction
            .iter_mut()
            .zip([x, y, z])
            .for_each(|(column, lanes)| write(column, &lanes));
        write(&mut self.cos, cos);
        write(&mut self.distance, &light.distance);
        let ([r, g, b], weight) = (weighed.contribution, weighed.weight);
        self.weighed
            .iter_mut()
            .zip([r, g, b, weight])
            .for_each(|(column, lanes)| write(column, &lanes));
        let cells = cells(&light.direction).into_iter().zip(weight.as_array());
        for (to, (cell, weight)) in self.cell[range].iter_mut().zip(cells) {
            *to = if *weight > 0.0 { cell } else { NO_WEIGHT };
        }
        self.len += limit.min(8) as usize;
    }

    /// Chooses the candidates that are worth one of `rays` rays, each with the radiance that it contributes unless it is blocked.
    ///
    /// Evenly spaced numbers choose them from a sequence of cells, so that rays are spread over the sphere as far as the light is. Objects
    /// that block one ray block its neighbours as well, so that the count of blocked rays varies less.
    #[inline]
    pub(super) fn choose(&mut self, rays: u32, u: f32) -> impl Iterator<Item = (Candidate, Vec3)> {
        let count = self.arrange();
        let [r, g, b, weight] = self.ordered.each_ref().map(|column| &column[..count]);
        choose([r, g, b], weight, rays, u).map(|choice| {
            let at = usize::from(self.order[choice.index]);
            let direction = Vec3::from_array(self.direction.each_ref().map(|column| column[at]));
            let candidate = Candidate {
                direction,
                cos: self.cos[at],
                distance: self.distance[at],
            };
            (candidate, Vec3::from_array(choice.contribution))
        })
    }

    /// Sorts the candidates with a weight by cell, and returns their count.
    #[inline]
    fn arrange(&mut self) -> usize {
        let cells = &self.cell[..self.len];
        let mut next = [0_u8; CELLS + 2];
        for cell in cells {
            next[usize::from(*cell) + 1] += 1;
        }
        for cell in 0..CELLS {
            next[cell + 1] += next[cell];
        }
        let count = usize::from(next[CELLS]);
        for (number, cell) in (0..).zip(cells) {
            let place = &mut next[usize::from(*cell)];
            self.order[usize::from(*place)] = number;
            *place += 1;
        }
        for (ordered, column) in self.ordered.iter_mut().zip(&self.weighed) {
            for (to, from) in ordered.iter_mut().zip(&self.order[..count]) {
                *to = column[usize::from(*from)];
            }
        }
        count
    }
}
