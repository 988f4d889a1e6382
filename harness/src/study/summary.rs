//! What a study comes to: gains over the published sampler, as geometric means over the grid.

use super::cell::Measured;
use super::rows::place;
use super::times::{PER_POINT, Time, ns};
use crate::efficiency::{ModelKind, Sampler};
use crate::stats::Estimate;
use crate::table::{Table, number};

/// Relative standard error of V beyond which a cell is left out: the light was hardly seen.
const MAX_RELATIVE_ERROR: f64 = 0.25;

/// Ratios of V over the cells of a grid.
#[derive(Clone, Debug, PartialEq)]
struct Gain {
    geometric_mean: Estimate,
    least: Estimate,
    most: Estimate,
    /// Cells left out.
    unsure: usize,
}

/// Gains of the second of two lists of V over the first, cell by cell.
///
/// The standard error of the geometric mean is that of its figures, the grid being what it is. Both samplers are held
/// against the same directions of the light: errors of the ratios are, if anything, less than said.
fn gain(pairs: impl Iterator<Item = [Estimate; 2]>) -> Option<Gain> {
    let sure = |v: &Estimate| v.value > 0.0 && v.standard_error <= MAX_RELATIVE_ERROR * v.value;
    let (mut ratios, mut unsure) = (Vec::new(), 0);
    for [base, other] in pairs {
        if sure(&base) && sure(&other) {
            ratios.push(base.ratio(&other));
        } else {
            unsure += 1;
        }
    }
    let by_value = |a: &&Estimate, b: &&Estimate| a.value.total_cmp(&b.value);
    let least = *ratios.iter().min_by(by_value)?;
    let most = *ratios.iter().max_by(by_value)?;
    let n = ratios.len() as f64;
    let logarithm = ratios.iter().map(|ratio| ratio.value.ln()).sum::<f64>() / n;
    let error = ratios.iter().map(|ratio| (ratio.standard_error / ratio.value).powi(2)).sum::<f64>().sqrt() / n;
    let value = logarithm.exp();
    Some(Gain { geometric_mean: Estimate { value, standard_error: value * error }, least, most, unsure })
}

/// A ratio of variances times that of the times.
fn in_equal_time(variance: Estimate, time: Estimate) -> Estimate {
    let value = variance.value * time.value;
    let relative = (variance.standard_error / variance.value).hypot(time.standard_error / time.value);
    Estimate { value, standard_error: value * relative }
}

/// The tables: variance, and variance in equal time.
pub(super) fn tables(cells: &[Vec<Measured>], lights: &[String], times: &[Time]) -> Vec<Table> {
    let mut variance = Table::new("Variance of ou over that of the sampler, over the grid")
        .text("model")
        .text("sampler")
        .text("light")
        .number("geometric mean")
        .number("least")
        .number("most")
        .number("cells left out");
    let mut equal_time = Table::new("The same in equal time, set-up included: geometric means")
        .text("model")
        .text("sampler")
        .text("light");
    for per_point in PER_POINT {
        equal_time = equal_time.number(format!("{per_point} a point"));
    }
    for model in ModelKind::ALL {
        for sampler in Sampler::ALL {
            if sampler == Sampler::Ou {
                continue;
            }
            for (light, name) in lights.iter().enumerate() {
                let v = |cell: &[Measured], sampler| cell[place(model, sampler, light, lights.len())].figures.v;
                let pairs = cells.iter().map(|cell| [v(cell, Sampler::Ou), v(cell, sampler)]);
                let keys = [model.name().to_owned(), sampler.name().to_owned(), name.clone()];
                let Some(gain) = gain(pairs) else {
                    variance.push(keys.into_iter().chain([
                        String::new(),
                        String::new(),
                        String::new(),
                        cells.len().to_string(),
                    ]));
                    continue;
                };
                let shown = |of: Estimate| number::with_error(of.value, of.standard_error);
                let of = [gain.geometric_mean, gain.least, gain.most].map(shown);
                variance.push(keys.clone().into_iter().chain(of).chain([gain.unsure.to_string()]));
                let of = PER_POINT.map(|per_point| {
                    let [ou, own] = [Sampler::Ou, sampler].map(|of| ns(times, model, of, per_point));
                    shown(in_equal_time(gain.geometric_mean, ou.ratio(&own)))
                });
                equal_time.push(keys.into_iter().chain(of));
            }
        }
    }
    let percent = 100.0 * MAX_RELATIVE_ERROR;
    vec![
        variance.note(format!(
            "{} cells; above 1, the sampler needs fewer samples than ou. Left out: cells where the standard error of a V \
             is above {percent}% of it, or nothing was seen of the light. ±: one standard error.",
            cells.len()
        )),
        equal_time.note(
            "Times of the default hair, eight lanes, one thread, on this machine; ±: one standard error, that of the times \
             included.",
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v(value: f64, standard_error: f64) -> Estimate {
        Estimate { value, standard_error }
    }

    #[test]
    fn gains_are_geometric_and_leave_out_what_is_unsure() {
        let nan = v(f64::NAN, f64::NAN);
        let pairs = [
            [v(2.0, 0.02), v(1.0, 0.0)],
            [v(8.0, 0.08), v(1.0, 0.0)],
            [v(1.0, 0.0), v(100.0, 30.0)],
            [nan, v(1.0, 0.0)],
        ];
        let gain = gain(pairs.into_iter()).expect("two cells");
        assert!((gain.geometric_mean.value - 4.0).abs() < 1e-12);
        assert!((gain.geometric_mean.standard_error - 4.0 * 0.01 / 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!((gain.least.value, gain.most.value, gain.unsure), (2.0, 8.0, 2));
        assert_eq!(super::gain([[nan, nan]].into_iter()), None, "nothing is sure");
    }
}
