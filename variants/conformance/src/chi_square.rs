//! Property that random samples follow the density (chi-square test).

use crate::erased::{ErasedSubject, Which};
use crate::failure::{Failure, Outcome};
use crate::integral::Integral;
use crate::mesh::{Mesh, Samples};
use crate::probe::{Draws, fill, numbered_hits};
use crate::statistics::chi_square_tail;
use hairis::LobeMask;

/// Probability that a run of a sound model looks wrong, over all runs: it is then repeated.
const SUSPECT: f64 = 0.01;
/// Factor on the number of samples of the repetition, which are others, and the probability that a sound run fails it. A wrong density
/// differs by as many more standard deviations as this factor: the repetition hardly ever clears it.
const AGAIN: u32 = 4;
const FAIL: f64 = 2e-4;
/// Least number of expected samples in a cell: smaller cells are pooled, as are cells with less than `SHARE` of all samples.
const LEAST: f64 = 5.0;
const SHARE: f64 = 1.0 / 256.0;

/// Checks random samples by Pearson's chi-square test against the integral of the density over cells of inclination and azimuth.
///
/// A run is a material at a hit. One that is less probable than 0.01 over all of them (Sidak) is repeated with four times as many samples,
/// at the level 2e-4: a sound model fails with a probability of 2e-6.
///
/// # Errors
///
/// Returns a failure with the worst cells if a run is less probable than the significance allows.
pub fn samples_follow_density(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "samples follow the density";
    let (claims, materials) = (subject.claims(), subject.set(Which::Everyday));
    let runs = (materials.len() * numbered_hits(0).count()) as f64;
    let least = 1.0 - (1.0 - SUSPECT).powf(1.0 / runs);
    let (mut numbers, mut samples) = (Default::default(), Samples::default());
    let mut worst = 1.0_f64;
    for material in materials.iter() {
        let name = material.name();
        for (run, hit) in numbered_hits(material.index()) {
            let bsdf = material.prepare(hit);
            let mesh = Mesh::new(subject, material, &hit, &*bsdf, LobeMask::ALL, &mut samples);
            let [rows, width] = mesh.size();
            let expected = Integral::density(&*bsdf, &mesh).mass;
            let mut test = |count: u32, seed: u64| {
                let mut observed = vec![0_u32; rows * width];
                // The numbers of a run are the same in every size.
                let mut draws = Draws(seed);
                draws.skip(3 * run as u64 * u64::from(count));
                fill(&mut numbers, count, |_| draws.xi3());
                for direction in samples.draw(&*bsdf, &numbers).live() {
                    let [i, j] = mesh.find(direction);
                    observed[i * width + j] += 1;
                }
                let discarded = f64::from(count - observed.iter().sum::<u32>());
                let count = f64::from(count);
                Fit::of(
                    &expected,
                    &observed,
                    count,
                    discarded,
                    count * claims.integral,
                )
            };
            let first = test(claims.samples, 0x5eed);
            worst = worst.min(first.probability);
            if first.probability >= least {
                continue;
            }
            let again = test(AGAIN * claims.samples, 0xa9a1);
            if again.probability >= FAIL {
                continue;
            }
            let message = format!(
                "{}, allowed {least:.1e}, then {}, allowed {FAIL:.1e}: {name} {hit:?}; the worst cells: {}",
                first.describe(),
                again.describe(),
                again.worst(&mesh)
            );
            return Err(Failure::new(NAME, message));
        }
    }
    println!("{NAME}: least probability {worst:.1e} of {runs} runs, repeated below {least:.1e}");
    Ok(())
}

/// Fit of samples to the integral of the density.
struct Fit {
    cells: Vec<Cell>,
    statistic: f64,
    /// Probability of a statistic as large as this, 0 if it is not a number.
    probability: f64,
}

impl Fit {
    fn of(mass: &[f64], observed: &[u32], count: f64, discarded: f64, uncertain: f64) -> Self {
        let none = discarded == count && mass.iter().all(|mass| *mass == 0.0);
        let cells = pooled(mass, observed, count, discarded, uncertain);
        let statistic: f64 = cells.iter().map(Cell::term).sum();
        let probability = chi_square_tail(statistic, cells.len().max(2) - 1);
        Self {
            cells,
            statistic,
            probability: if none { 1.0 } else { probability.max(0.0) },
        }
    }

    fn describe(&self) -> String {
        let (statistic, cells, p) = (self.statistic, self.cells.len(), self.probability);
        format!("chi-square {statistic:.0} of {cells} cells has probability {p:.1e}")
    }

    fn worst(mut self, mesh: &Mesh) -> String {
        self.cells.sort_by(|a, b| b.term().total_cmp(&a.term()));
        let worst = self.cells.iter().take(6).map(|cell| cell.describe(mesh));
        worst.collect::<Vec<_>>().join("; ")
    }
}

/// Rectangles of a row that are pooled, from one to another.
struct Cell {
    from: usize,
    to: usize,
    expected: f64,
    observed: f64,
}

impl Cell {
    fn term(&self) -> f64 {
        let difference = self.observed - self.expected;
        if difference == 0.0 {
            0.0
        } else {
            difference * difference / self.expected
        }
    }

    fn describe(&self, mesh: &Mesh) -> String {
        let width = mesh.size()[1];
        let Self {
            from,
            to,
            expected,
            observed,
        } = self;
        let Some(theta) = mesh.theta.get(from / width) else {
            return format!("{observed} for {expected:.1} discarded");
        };
        let (phi, theta_to, phi_to) = (
            mesh.phi[from % width],
            mesh.theta[to / width + 1],
            mesh.phi[to % width + 1],
        );
        format!(
            "{observed} for {expected:.1} from theta {theta:.4} phi {phi:.4} to {theta_to:.4} {phi_to:.4}"
        )
    }
}

/// Pools neighbouring rectangles until each cell has enough expected samples. Discarded samples are the last cell, if their number
/// differs from the expected one by more than `uncertain`.
fn pooled(mass: &[f64], observed: &[u32], count: f64, discarded: f64, uncertain: f64) -> Vec<Cell> {
    let enough = (count * SHARE).max(LEAST);
    let mut cells: Vec<Cell> = Vec::new();
    let mut open: Option<Cell> = None;
    for (n, (mass, observed)) in mass.iter().zip(observed).enumerate() {
        let cell = open.get_or_insert(Cell {
            from: n,
            to: n,
            expected: 0.0,
            observed: 0.0,
        });
        cell.to = n;
        cell.expected += mass * count;
        cell.observed += f64::from(*observed);
        if cell.expected >= enough {
            cells.extend(open.take());
        }
    }
    if let Some(rest) = open {
        match cells.last_mut() {
            Some(last) => {
                last.to = rest.to;
                last.expected += rest.expected;
                last.observed += rest.observed;
            }
            None => cells.push(rest),
        }
    }
    let expected = (count * (1.0 - mass.iter().sum::<f64>())).max(0.0);
    match cells.last_mut() {
        // A difference below the error of the integral, which has a test of its own.
        Some(last) if (expected - discarded).abs() <= uncertain => {
            last.expected += expected;
            last.observed += discarded;
        }
        _ => cells.push(Cell {
            from: mass.len(),
            to: mass.len(),
            expected: expected.max(1e-9),
            observed: discarded,
        }),
    }
    cells
}
