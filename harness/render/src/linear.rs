//! Solver for systems of linear equations.

/// Solves linear equations by elimination with pivots, or returns `None` if a pivot is 0 or not finite. The rows are overwritten.
pub(crate) fn solve<R: AsMut<[f64]> + Clone>(matrix: &mut [R], right: &[f64]) -> Option<Vec<f64>> {
    let count = right.len();
    let mut right = right.to_vec();
    for k in 0..count {
        let mut size = |row: usize| matrix[row].as_mut()[k].abs();
        let sizes: Vec<f64> = (k..count).map(&mut size).collect();
        let pivot = k + (0..count - k).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b]))?;
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        let mut upper = matrix[k].clone();
        let upper = upper.as_mut();
        let lead = upper[k];
        if lead == 0.0 || !lead.is_finite() {
            return None;
        }
        for below in k + 1..count {
            let row = matrix[below].as_mut();
            let factor = row[k] / lead;
            for (entry, above) in row.iter_mut().zip(&*upper).skip(k) {
                *entry -= factor * above;
            }
            right[below] -= factor * right[k];
        }
    }
    for k in (0..count).rev() {
        let row = matrix[k].as_mut();
        let rest: f64 = (k + 1..count)
            .map(|column| row[column] * right[column])
            .sum();
        right[k] = (right[k] - rest) / row[k];
    }
    Some(right)
}
