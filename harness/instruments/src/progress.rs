//! Progress bars, and parallel work that counts the finished cells.

use core::sync::atomic::{AtomicUsize, Ordering};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use std::sync::OnceLock;

/// Makes a progress bar on standard error, which draws nothing unless standard error is a terminal.
#[must_use]
pub fn bar(steps: u64, template: &str) -> ProgressBar {
    let style =
        ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(steps).with_style(style)
}

/// Number of steps of a bar that shows a share.
const STEPS: u64 = 1000;

/// Makes a progress bar for a share of the work, which [`show_share`] moves.
#[must_use]
pub fn share_bar(template: &str) -> ProgressBar {
    bar(STEPS, template)
}

/// Moves a [`share_bar`] to the share of the work that is done, from 0 to 1.
pub fn show_share(bar: &ProgressBar, done: f64) {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 1000"
    )]
    bar.set_position((done.clamp(0.0, 1.0) * STEPS as f64) as u64);
}

/// Count of the cells that are done so far, out of all cells of a run.
#[expect(missing_debug_implementations, reason = "`report` is a closure")]
pub struct Progress<'a> {
    done: AtomicUsize,
    total: usize,
    report: &'a (dyn Fn(usize, usize) + Sync),
}

impl<'a> Progress<'a> {
    /// Makes a count of `total` cells. Workers call `report` with the number of cells that are done and with `total`, in no particular
    /// order.
    pub const fn new(total: usize, report: &'a (dyn Fn(usize, usize) + Sync)) -> Self {
        Self {
            done: AtomicUsize::new(0),
            total,
            report,
        }
    }

    /// Computes `f` on every cell, in parallel on all cores; the results are in the order of the cells.
    pub fn map<C: Sync, R: Send + Sync>(&self, cells: &[C], f: impl Fn(&C) -> R + Sync) -> Vec<R> {
        let results: Vec<OnceLock<R>> = cells.iter().map(|_| OnceLock::new()).collect();
        self.each(cells.len(), &|index| {
            results[index].get_or_init(|| f(&cells[index]));
        });
        results
            .into_iter()
            .filter_map(OnceLock::into_inner)
            .collect()
    }

    /// Does the work of every cell by its index, so that this function is compiled once for all kinds of cells.
    fn each(&self, count: usize, work: &(dyn Fn(usize) + Sync)) {
        // One cell at a time, because cells differ in length by a factor of a hundred.
        (0..count)
            .into_par_iter()
            .with_max_len(1)
            .for_each(|index| {
                work(index);
                let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
                (self.report)(done, self.total);
            });
    }
}
