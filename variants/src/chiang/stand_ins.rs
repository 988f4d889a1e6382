//! Derivatives by the fields that stand in for the absorption: colour and melanin.

use super::params::{COLOR, LEAST_COLOR};
use hairis::params::{Pigments, melanin_concentrations};

/// Returns the derivatives by concentrations of melanin, of which the absorption is a sum, given those by the absorption.
#[inline]
pub(crate) fn by_melanin(pigments: &Pigments, by_absorption: [f64; 3]) -> [f64; 2] {
    [pigments.eumelanin, pigments.pheomelanin].map(|unit| dot(unit.map(f64::from), by_absorption))
}

/// Returns the derivatives by an artist's amount and redness of melanin, given those by the absorption.
///
/// With `q = -ln(1 - amount)`, the concentrations are `q (1 - redness)` and `q redness`. Where `q` is largest, the amount has no effect.
#[inline]
pub(super) fn by_melanin_amount(
    pigments: &Pigments,
    [amount, redness]: [f32; 2],
    by_absorption: [f64; 3],
) -> [f64; 2] {
    let [eumelanin, pheomelanin] = by_melanin(pigments, by_absorption);
    // A legal amount is never refused.
    let quantity = |amount| melanin_concentrations(amount, 0.0).map_or(0.0, |[all, _]| all);
    let (q, most) = (quantity(amount), quantity(1.0));
    let slope = if q < most {
        (1.0 - f64::from(amount)).recip()
    } else {
        0.0
    };
    let redness = f64::from(redness);
    [
        slope * (eumelanin * (1.0 - redness) + pheomelanin * redness),
        f64::from(q) * (pheomelanin - eumelanin),
    ]
}

/// Returns the derivatives by the colour of a mass of hair, and the derivative by `beta_n` through the absorption of that colour, given
/// those by the absorption.
///
/// The absorption is `(ln color / d)^2`, with `d` a polynomial in `beta_n`. A channel below the least one has no effect.
#[inline]
pub(super) fn by_color(color: [f32; 3], beta_n: f32, by_absorption: [f64; 3]) -> ([f64; 3], f64) {
    let n = f64::from(beta_n);
    let [d, d_slope] = COLOR.iter().rev().fold([0.0; 2], |[sum, slope], c| {
        [f64::from(*c) + n * sum, sum + n * slope]
    });
    let log = color.map(|c| libm::log(f64::from(c.max(LEAST_COLOR))) / d);
    let by_color = core::array::from_fn(|channel| {
        let c = color[channel];
        if c < LEAST_COLOR {
            return 0.0;
        }
        2.0 * log[channel] / (d * f64::from(c)) * by_absorption[channel]
    });
    let by_beta_n = log.map(|log| -2.0 * log * log * d_slope / d);
    (by_color, dot(by_beta_n, by_absorption))
}

#[inline]
fn dot([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> f64 {
    a * x + b * y + c * z
}
