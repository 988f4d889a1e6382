//! Directions that are drawn by the formulas.

use hairis_reference::Reference;

/// Samples of the formulas for each sample of a program.
const MORE: usize = 4;
/// Root of `x^4 = x + 1`: its powers make an even sequence of three numbers.
const ROOT: f64 = 1.220_744_084_605_759_5;

/// Returns point `n` of an even sequence in the unit cube.
pub(crate) fn even(seed: u64, n: u32) -> [f64; 3] {
    let shift = (seed % (1 << 20)) as f64 / ROOT.powi(5);
    [1, 2, 3].map(|power| (0.5 + shift + f64::from(n + 1) / ROOT.powi(power)).fract())
}

/// Draws directions by the sampler of the formulas, for a count of samples to compare with them.
pub(crate) fn of_formulas(point: &dyn Reference<f64>, count: usize) -> Vec<Option<[f64; 3]>> {
    let draws = u32::try_from(MORE * count).unwrap_or(u32::MAX);
    (0..draws)
        .map(|n| {
            let drawn = point.sample(even(0, n));
            drawn.lobe.map(|_| drawn.wi)
        })
        .collect()
}
