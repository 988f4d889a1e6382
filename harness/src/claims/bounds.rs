//! A and B as printed, without the half: samples off the sphere.

use super::FoundCells;
use super::claim::{Bounded, Claim, Figure, Side, Threshold, Words, geometric_mean, largest, smallest};
use super::hair::{HairFigures, Longitudinal, longitudinal_grid};

const WORDS: Words = Words {
    id: "misprint-bounds",
    quotation: "A = atan((π/2 + θ_r − α) / β) and B = atan((−π/2 + θ_r − α) / β)",
    source: "section 3.2.1, appendix A",
};

const THRESHOLD: Threshold = Threshold {
    of: "share of the samples of a lobe with |θ_i| > 90°",
    side: Side::AtMost,
    bound: 1e-6,
    limits: "the lobe of the parameter grid that loses least",
};

/// Error of closed forms: the rounding of double precision.
const ROUNDING: f64 = 1e-14;

fn exact(value: f64) -> Bounded {
    Bounded { value, error: ROUNDING }
}

/// The claim.
pub(super) fn claim(cells: &FoundCells) -> Claim {
    let lobes = || longitudinal_grid().into_iter().map(|lobe: Longitudinal| exact(1.0 - lobe.printed_mass()));
    let (most, least) = (largest(lobes()), smallest(lobes()));
    let lost = || cells.iter().map(|(.., found)| exact(found.lost));
    // All that is drawn lands on the sphere with a density of the printed one over the share that does.
    let bias = || lost().map(|lost| exact(lost.value / (1.0 - lost.value)));
    let factor = |found: &HairFigures| found.printed.over(found.published);
    let factors = || cells.iter().map(|(.., found)| factor(found));
    let mean = geometric_mean(factors());
    let sentence = format!(
        "A lobe loses {:.1}% to {:.0}% of its samples, a hair {:.1}% to {:.0}%; redrawn without renormalising they make \
         the result up to {:.0}% too bright, and counted as black they multiply the variance by {:.2} (geometric mean), \
         at most by {:.1}.",
        100.0 * least.value,
        100.0 * most.value,
        100.0 * smallest(lost()).value,
        100.0 * largest(lost()).value,
        100.0 * largest(bias()).value,
        mean.value,
        largest(factors()).value,
    );
    let figure = |name: &str, of| Figure::integral(name, of, "");
    Claim::judge(
        WORDS,
        THRESHOLD,
        [
            figure("share of samples lost, most of a lobe on the grid", most),
            figure("share of samples lost, least of a lobe on the grid", least),
        ],
        vec![
            figure("share of samples lost, most of a hair", largest(lost())),
            figure("share of samples lost, least of a hair", smallest(lost())),
            figure("relative bias if lost samples are redrawn, most", largest(bias())),
            figure("relative bias if lost samples are redrawn, least", smallest(bias())),
            figure("factor on V if lost samples count, geometric mean", mean),
            figure("factor on V if lost samples count, most", largest(factors())),
            figure("factor on V if lost samples count, least", smallest(factors())),
        ],
        sentence,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::Independent;
    use core::f64::consts::FRAC_PI_2;

    #[test]
    fn samples_are_lost_as_the_mass_says() {
        let (alpha, beta, theta_o) = (-0.13_f64, 0.26_f64, 0.8_f64);
        let [a, b] = [FRAC_PI_2, -FRAC_PI_2].map(|end: f64| ((end + theta_o - alpha) / beta).atan());
        let mut from = Independent::new(4, 0);
        let count = 100_000;
        let drawn = (0..count).map(|_| 2.0 * beta * (from.next_f64() * (a - b) + b).tan() + 2.0 * alpha - theta_o);
        let lost = drawn.filter(|theta_i| theta_i.abs() > FRAC_PI_2).count() as f64 / f64::from(count);
        let want = 1.0 - Longitudinal { alpha, beta, theta_o }.printed_mass();
        let error = (want * (1.0 - want) / f64::from(count)).sqrt();
        assert!((lost - want).abs() < 4.0 * error && want > 0.05, "{lost} {want}");
    }
}
