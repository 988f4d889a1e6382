//! Rectangles of inclination and azimuth over which a density is integrated.
//!
//! A narrow lobe is located by the quantiles of a few samples and not by chance, because quadrature on a sphere would miss lobes below a
//! degree. From there the mesh widens by a constant factor, so that tails are resolved too. The samples determine only where the edges
//! lie: the rectangles between them are integrated from the density alone.

use crate::erased::{COLUMNS, ErasedBsdf, ErasedSubject, NamedMaterial};
use crate::probe::{angles, columns, sides, sobol};
use crate::statistics::AngleEdges;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::simd::Level;
use hairis::{Hit, LobeMask};
use std::sync::OnceLock;

/// Number of samples per lobe from which edges are taken.
const SAMPLES: u32 = 4096;
/// Largest ratio of the widths of neighbouring intervals.
const GRADE: f64 = 2.5;
/// Largest width of an interval, as a share of the domain.
const WIDEST: f64 = 1.0 / 8.0;
/// Least distance of two edges, in rad: closer edges count as one.
const CLOSEST: f64 = 1e-6;

/// Edges of the rectangles, ascending, from end to end of the domain.
pub(crate) struct Mesh {
    pub(crate) theta: Vec<f64>,
    pub(crate) phi: Vec<f64>,
    /// All edges except the ends.
    inner: [AngleEdges; 2],
}

impl Mesh {
    /// Makes a mesh for the density of a shading point with these lobes. `samples` is overwritten.
    pub(crate) fn new(
        subject: &dyn ErasedSubject,
        material: NamedMaterial<'_>,
        hit: &Hit,
        bsdf: &dyn ErasedBsdf,
        mask: LobeMask,
        samples: &mut Samples,
    ) -> Self {
        static POINTS: OnceLock<[Vec<f32>; 3]> = OnceLock::new();
        let points = POINTS.get_or_init(|| columns(SAMPLES, sobol));
        let [mut theta, mut phi] = material.edges(hit);
        for lobe in subject.slots().filter(|lobe| mask.contains(*lobe)) {
            let alone = bsdf.with_lobes(LobeMask::of(&[lobe]));
            let live = samples.draw(&*alone, points).live();
            let drawn: Vec<[f64; 2]> = live.map(angles).collect();
            theta.extend(quantiles(drawn.iter().map(|[theta, _]| *theta).collect()));
            phi.extend(quantiles(drawn.iter().map(|[_, phi]| *phi).collect()));
        }
        let (theta, phi) = (graded(theta, FRAC_PI_2), graded(phi, PI));
        let inner = [&theta, &phi].map(|edges| AngleEdges::new(&edges[1..edges.len() - 1]));
        Self { theta, phi, inner }
    }

    /// Returns the rectangle that contains a direction. A direction along the axis counts in the first column.
    pub(crate) fn find(&self, direction: [f64; 3]) -> [usize; 2] {
        let [theta, phi] = sides(direction);
        [self.inner[0].below(theta), self.inner[1].below(phi)]
    }

    /// Returns the number of intervals of each angle.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.theta.len() - 1, self.phi.len() - 1]
    }
}

/// Samples of one shading point, by column. Their memory is kept from one shading point to the next: fresh columns of this size would take
/// a page fault per page.
#[derive(Default)]
pub(crate) struct Samples {
    columns: [Vec<f32>; COLUMNS],
}

impl Samples {
    /// Draws the samples that these numbers give, in place of those before.
    pub(crate) fn draw(&mut self, bsdf: &dyn ErasedBsdf, xi: &[Vec<f32>; 3]) -> &Self {
        let inputs = xi.each_ref().map(|column| &column[..]);
        let columns = self.columns.each_mut().map(|column| {
            column.resize(xi[0].len(), 0.0);
            &mut column[..]
        });
        let written = bsdf
            .with_level(Level::detect())
            .sample_array(inputs, columns);
        assert!(
            written.is_ok(),
            "slices of one length are accepted: {written:?}"
        );
        self
    }

    /// Returns the share of the samples that were not discarded.
    pub(crate) fn kept(&self) -> f64 {
        let [.., slot] = &self.columns;
        slot.iter().filter(|slot| **slot >= 0.0).count() as f64 / slot.len() as f64
    }

    /// Returns the directions of the samples that were not discarded.
    pub(crate) fn live(&self) -> impl Iterator<Item = [f64; 3]> {
        let [u, v, w, .., slot] = &self.columns;
        let live = (0..slot.len()).filter(|n| slot[*n] >= 0.0);
        live.map(|n| [u[n], v[n], w[n]].map(f64::from))
    }
}

/// Returns every twelfth of a distribution, and its tails.
fn quantiles(mut sorted: Vec<f64>) -> Vec<f64> {
    sorted.retain(|x| x.is_finite());
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    if count == 0 {
        return sorted;
    }
    let tails = [1, 6, 30, 120]
        .into_iter()
        .flat_map(|per_mille| [per_mille, 1000 - per_mille])
        .map(|n| n * count / 1000);
    (0..12)
        .map(|n| n * count / 12)
        .chain(tails)
        .map(|n| sorted[n.min(count - 1)])
        .collect()
}

/// Sorts edges, adds the ends of the domain, and halves intervals that are too wide, by themselves or beside their neighbours.
fn graded(mut edges: Vec<f64>, end: f64) -> Vec<f64> {
    edges.retain(|x| x.abs() < end - CLOSEST);
    edges.extend([-end, end]);
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|b, a| *b - *a < CLOSEST);
    loop {
        let width: Vec<f64> = edges.windows(2).map(|ends| ends[1] - ends[0]).collect();
        let mut added = Vec::new();
        for (n, ends) in edges.windows(2).enumerate() {
            let before = n.checked_sub(1).map_or(f64::MAX, |n| width[n]);
            let after = width.get(n + 1).copied().unwrap_or(f64::MAX);
            if width[n] > GRADE * before.min(after).max(CLOSEST) {
                // One step away from the narrower neighbour.
                let step = 2.0 * before.min(after).max(CLOSEST);
                added.push(if before <= after {
                    ends[0] + step
                } else {
                    ends[1] - step
                });
            } else if width[n] > WIDEST * 2.0 * end {
                added.push(0.5 * (ends[0] + ends[1]));
            }
        }
        if added.is_empty() {
            return edges;
        }
        edges.extend(added);
        edges.sort_by(f64::total_cmp);
    }
}

#[cfg(test)]
mod tests {
    use super::{GRADE, graded, quantiles};

    #[test]
    fn meshes_widen_step_by_step() {
        let edges = graded(vec![0.3, 0.3001, 0.3002, 7.0, -1.0], 1.5);
        assert!(
            edges[0] == -1.5 && edges[edges.len() - 1] == 1.5,
            "the ends: {edges:?}"
        );
        assert!(
            edges.contains(&0.3001) && edges.contains(&-1.0),
            "what was asked for: {edges:?}"
        );
        let widths: Vec<f64> = edges.windows(2).map(|ends| ends[1] - ends[0]).collect();
        for pair in widths.windows(2) {
            let ratio = pair[0] / pair[1];
            assert!(
                ratio < 1.001 * GRADE && ratio > 0.999 / GRADE,
                "neighbours of ratio {ratio}"
            );
        }
        assert!(edges.len() < 100, "{} edges", edges.len());
        assert!(
            quantiles(vec![f64::NAN]).is_empty(),
            "no samples, no quantiles"
        );
    }
}
