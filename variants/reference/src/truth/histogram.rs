//! Histogram of paths over directions.

use super::{Exit, Lobe};
use core::f64::consts::{FRAC_PI_2, PI, TAU};

/// Light by direction and [`Lobe`], collected in batches, of which the errors are computed.
///
/// A cell is a range of inclinations and of azimuths `phi_i`. Cells are numbered by inclination from -pi/2 and then by azimuth from -pi.
#[derive(Clone, Debug)]
pub struct Histogram {
    size: [usize; 2],
    /// Mean weight of a path by batch: by cell, lobe and channel.
    batches: Vec<Vec<[[f64; 3]; Lobe::COUNT]>>,
}

impl Histogram {
    /// Makes an empty histogram with these numbers of inclinations and azimuths, both at least 1.
    #[must_use]
    pub const fn new(size: [usize; 2]) -> Self {
        Self {
            size,
            batches: Vec::new(),
        }
    }

    /// Adds a batch of so many paths, each as [`Fiber::trace`](super::Fiber::trace) ends it.
    pub fn add(&mut self, paths: u32, path: &mut dyn FnMut() -> Option<Exit>) {
        let mut cells = vec![[[0.0; 3]; Lobe::COUNT]; self.size[0] * self.size[1]];
        let share = 1.0 / f64::from(paths);
        for _ in 0..paths {
            if let Some(exit) = path() {
                let sums = &mut cells[self.cell(exit.wi)][exit.lobe as usize];
                for (sum, weight) in sums.iter_mut().zip(exit.weight) {
                    *sum += share * weight;
                }
            }
        }
        self.batches.push(cells);
    }

    /// Returns the cell of a direction.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a cast saturates, and a place is clamped"
    )]
    pub fn cell(&self, [u, v, w]: [f64; 3]) -> usize {
        let share = [u.atan2(v.hypot(w)) / PI + 0.5, w.atan2(v) / TAU + 0.5];
        let place = |k: usize| ((share[k] * self.size[k] as f64) as usize).min(self.size[k] - 1);
        place(0) * self.size[1] + place(1)
    }

    /// Returns the least and largest inclination and azimuth of a cell, rad.
    #[must_use]
    pub fn ends(&self, cell: usize) -> [[f64; 2]; 2] {
        let end = |k: usize, at: usize| {
            [FRAC_PI_2, PI][k] * (2.0 * at as f64 / self.size[k] as f64 - 1.0)
        };
        let (row, column) = (cell / self.size[1], cell % self.size[1]);
        [
            [end(0, row), end(0, row + 1)],
            [end(1, column), end(1, column + 1)],
        ]
    }

    /// Returns the integral of `cos theta_i` over a cell, by which its light is divided for the mean of S.
    #[must_use]
    pub fn measure(&self, cell: usize) -> f64 {
        let [[low, high], [from, to]] = self.ends(cell);
        let inner = 0.5 * (high - low) + 0.25 * ((2.0 * high).sin() - (2.0 * low).sin());
        inner * (to - from)
    }

    /// Estimates the sum over cells and lobes of light times `factor`, in one channel, with its standard error over the batches. The error of a
    /// single batch is NaN.
    ///
    /// - Units: share of the light that meets the fibre.
    #[must_use]
    pub fn estimate(&self, channel: usize, factor: impl Fn(usize, Lobe) -> f64) -> [f64; 2] {
        let sums = self.batches.iter().map(|cells| {
            let cells = cells.iter().enumerate();
            let of_cell = |(cell, light): (usize, &[[f64; 3]; Lobe::COUNT])| -> f64 {
                let lobes = Lobe::ALL.into_iter().zip(light);
                lobes
                    .filter(|(_, light)| light[channel] != 0.0)
                    .map(|(lobe, light)| factor(cell, lobe) * light[channel])
                    .sum()
            };
            cells.map(of_cell).sum()
        });
        let sums: Vec<f64> = sums.collect();
        let count = sums.len() as f64;
        let mean = sums.iter().sum::<f64>() / count;
        let squares: f64 = sums.iter().map(|sum| (sum - mean).powi(2)).sum();
        [mean, (squares / (count - 1.0) / count).sqrt()]
    }

    /// Returns the mean light of every cell, by lobe and channel.
    #[must_use]
    pub fn means(&self) -> Vec<[[f64; 3]; Lobe::COUNT]> {
        let mut means = vec![[[0.0; 3]; Lobe::COUNT]; self.size[0] * self.size[1]];
        for cells in &self.batches {
            for (mean, cell) in means
                .iter_mut()
                .flatten()
                .flatten()
                .zip(cells.iter().flatten().flatten())
            {
                *mean += cell / self.batches.len() as f64;
            }
        }
        means
    }
}
