//! Inversion of cumulative sums, with guide tables that say where to begin the search.

/// Returns the index of the cell that contains `x`, among `n` equal cells of [0, 1]. Numbers outside count as the nearest end, and NaN
/// counts as 0.
///
/// # Panics
/// Panics if there are no cells.
#[must_use]
pub fn cell(x: f64, n: usize) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to 0..=n; NaN becomes 0"
    )]
    let i = (x * n as f64).clamp(0.0, n as f64) as usize;
    i.min(n - 1)
}

/// Returns the guide table: the total is divided into as many equal parts as there are indices, and each part gets the index in which
/// it begins. A search that starts at that index takes a step or two on average, where bisection takes a dozen. The inversion stays
/// monotone, unlike that of alias tables, so that stratified numbers stay stratified.
pub fn guide(cumulative: &[f64]) -> impl Iterator<Item = u32> + '_ {
    let (parts, total) = (cumulative.len(), cumulative.last().copied().unwrap_or(0.0));
    let mut index = 0;
    (0..parts).map(move |part| {
        while index + 1 < parts && cumulative[index] <= part as f64 / parts as f64 * total {
            index += 1;
        }
        u32::try_from(index).unwrap_or(u32::MAX)
    })
}

/// Draws an index from a cumulative sum, and returns it with the remainder of `xi`, rescaled to [0, 1]. Indices of no weight are never
/// drawn while some index has weight.
///
/// `start` is the index from the guide table, with the cumulative sum at that index.
///
/// # Panics
/// Panics if there are no weights.
#[must_use]
pub fn search(cumulative: &[f64], total: f64, start: (usize, f64), xi: f64) -> (usize, f64) {
    let last = cumulative.len() - 1;
    // Strictly below the total, because rounding could otherwise fall off the end into indices of no weight.
    let target = (xi * total).min(total * (1.0 - f64::EPSILON / 2.0));
    let (mut index, sum) = start;
    if sum > target {
        // Rounding may have put the start one too far.
        while index > 0 && cumulative[index - 1] > target {
            index -= 1;
        }
    } else {
        while index < last && cumulative[index] <= target {
            index += 1;
        }
    }
    let before = if index == 0 {
        0.0
    } else {
        cumulative[index - 1]
    };
    let rest = (target - before) / (cumulative[index] - before);
    (
        index,
        if rest.is_finite() {
            rest.clamp(0.0, 1.0)
        } else {
            0.5
        },
    )
}
