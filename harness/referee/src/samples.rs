//! Samples of a program beside its own density, by a chi-square test.

use crate::answers::{Answer, Answers};
use core::fmt;

/// Samples per cell, so that their count is nearly normal.
const SAMPLES: usize = 16;
/// Answers per cell where their densities are not those of the formulas, so that the difference is known.
const ANSWERS: usize = 16;
/// Most cells of a shading point.
const MOST: usize = 64;

/// Counts of samples beside the integrals of the density over the same cells of directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Sum of the squared distances in standard errors.
    pub chi_square: f64,
    /// Count of cells.
    pub cells: usize,
    /// Cell that is furthest off.
    pub worst: Cell,
}

/// Cell of directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cell {
    /// Inclinations in rad.
    theta: [f64; 2],
    /// Azimuths from the viewer in rad.
    phi: [f64; 2],
    /// Share of the samples.
    counted: f64,
    /// Integral of the density.
    expected: f64,
    /// Difference in standard errors.
    away: f64,
    /// First line of the shading point in the file.
    line: usize,
}

impl Drawn {
    /// Returns the distance from what the density says in standard errors of a normal distribution, after Wilson and Hilferty.
    #[must_use]
    pub fn deviates(&self) -> f64 {
        let part = 2.0 / (9.0 * self.cells as f64);
        ((self.chi_square / self.cells as f64).cbrt() - 1.0 + part) / part.sqrt()
    }
}

impl fmt::Display for Drawn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            chi_square, cells, ..
        } = self;
        write!(f, "chi-square {chi_square:.0} in {cells} cells")
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [[a, b], [c, d]] = [self.theta, self.phi].map(|side| side.map(f64::to_degrees));
        write!(
            f,
            "{:.4} of them, by their density {:.4}, at inclinations {a:.1} to {b:.1} and azimuths {c:.0} to {d:.0} degrees from the viewer, \
             from line {}",
            self.counted, self.expected, self.line
        )
    }
}

/// Compares samples with the density that the program states. `None` without samples, or without densities at directions whose own
/// density is known. `is_right` says that the densities are those of the formulas.
pub(crate) fn judge(answers: &Answers, is_right: bool) -> Option<Drawn> {
    let cells = answers.scenes().filter_map(|scene| cells(scene, is_right));
    let cells: Vec<Cell> = cells.flatten().collect();
    let worst = cells
        .iter()
        .max_by(|a, b| a.away.abs().total_cmp(&b.away.abs()))?;
    Some(Drawn {
        chi_square: cells.iter().map(|cell| cell.away.powi(2)).sum(),
        cells: cells.len(),
        worst: *worst,
    })
}

/// Returns the cells of a shading point. The integral of the program's density over a cell is the share of the formulas' samples, and the
/// integral of the difference of the two densities, which the answers have.
fn cells(scene: &[Answer], is_right: bool) -> Option<Vec<Cell>> {
    let first = scene.iter().find(|answer| !answer.samples.is_empty())?;
    let angles = |v: &[f64; 3]| {
        let phi = v[2].atan2(v[1]) - first.wo[2].atan2(first.wo[1]);
        [v[0].atan2(v[1].hypot(v[2])), phi.sin().atan2(phi.cos())]
    };
    let off = |answer: &Answer| {
        let off = (answer.got.pdf? - answer.want.pdf?) / answer.drawn_with?;
        Some((angles(&answer.wi), off))
    };
    let off: Vec<([f64; 2], f64)> = scene.iter().map(off).collect::<Option<_>>()?;
    let [drawn, wanted] = [&first.samples, &first.formulas]
        .map(|samples| -> Vec<_> { samples.iter().flatten().map(angles).collect() });
    let [count, of_formulas, answers] =
        [first.samples.len(), first.formulas.len(), off.len()].map(|count| count as f64);
    let most = if is_right { MOST } else { off.len() / ANSWERS };
    let most = most.min(MOST).min(drawn.len() / SAMPLES);
    // All samples lie in a single cell, whatever their density.
    if most < 2 {
        return None;
    }
    let rows = most.isqrt();
    let mut cells = Vec::new();
    for (theta, row) in parts(wanted, 0, rows) {
        for (phi, cell) in parts(row, 1, most / rows) {
            let within = |[t, p]: &[f64; 2]| {
                (theta[0]..theta[1]).contains(t) && (phi[0]..phi[1]).contains(p)
            };
            let (sum, squares) = (off.iter().filter(|(at, _)| within(at)))
                .fold((0.0, 0.0), |(sum, squares), (_, x)| {
                    (sum + x, squares + x * x)
                });
            let (more, share) = (sum / answers, cell.len() as f64 / of_formulas);
            let expected = share + more;
            let counted = drawn.iter().filter(|at| within(at)).count() as f64 / count;
            let binomial = |p: f64| p * (1.0 - p).max(0.0);
            // Samples where the density is 0 have the error of a single one.
            let variance = (squares / answers - more * more).max(0.0) / answers
                + binomial(share) / of_formulas
                + binomial(expected.max(1.0 / count)) / count;
            cells.push(Cell {
                theta,
                phi,
                counted,
                expected,
                away: (counted - expected) / variance.sqrt(),
                line: first.line,
            });
        }
    }
    Some(cells)
}

/// Divides directions into parts of the same count along one of their angles. Returns the ends of each part, of which the first and the last
/// are open.
fn parts(mut all: Vec<[f64; 2]>, angle: usize, count: usize) -> Vec<([f64; 2], Vec<[f64; 2]>)> {
    all.sort_by(|a, b| a[angle].total_cmp(&b[angle]));
    let size = all.len().div_ceil(count).max(1);
    let chunks: Vec<&[[f64; 2]]> = all.chunks(size).collect();
    let start = |k: usize| match (k, chunks.get(k)) {
        (0, _) => f64::NEG_INFINITY,
        (_, Some(chunk)) => chunk[0][angle],
        (_, None) => f64::INFINITY,
    };
    (chunks.iter().enumerate())
        .map(|(k, chunk)| ([start(k), start(k + 1)], chunk.to_vec()))
        .collect()
}
