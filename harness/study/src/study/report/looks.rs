//! Plots of how different the models look.

use super::maps::maps;
use crate::difference::{Difference, Differences, Summary, Width, albedo_ratio};
use hairis::HairParams;
use hairis_harness::figures;
use hairis_instruments::plot::{Axis, Bar, Series, lines};
use hairis_instruments::report::Drawing;
use hairis_variants::Cauchy;

/// Inclination of the viewer in the pictures of the default hair, in degrees.
const THETA_O_DEG: f64 = 45.0;

/// Name of a difference, and the function that returns it.
type NamedDifference = (&'static str, fn(&Differences) -> f64);

/// Draws the default hair: sections and maps.
pub(super) fn pictures() -> Vec<Drawing> {
    let (hair, theta_o) = (HairParams::bright(), THETA_O_DEG.to_radians());
    let variants = [
        ("Cauchy, k = 1", Cauchy::PAPER),
        ("Cauchy, k = 1.177", Cauchy::HALF_WIDTH),
        ("Cauchy, k = 0.798", Cauchy::AREA),
    ];
    let mut all = vec![figures::polar(&hair, theta_o, &variants)];
    all.extend(maps(&hair, theta_o, Cauchy::PAPER));
    all
}

/// Draws the differences over the grid.
pub(super) fn charts(of: &Difference) -> Vec<Drawing> {
    let width = || Axis::linear("width of R, β_R (°)");
    let l1 = || Axis::linear("difference of S cos θᵢ, L1 (%)");
    let (widths, inclinations) = (of.grid.widths(), of.grid.inclinations());
    let by_factor = Width::ALL.map(|width| {
        let points = of.along(widths, width, |f| 100.0 * f.plain.l1).into_iter();
        Series::new(
            named(of, width),
            points.map(|(beta, found)| (beta, found.median)),
        )
    });
    let kinds: [NamedDifference; 4] = [
        ("as they are", |f| 100.0 * f.plain.l1),
        ("shape alone", |f| 100.0 * f.shape.l1),
        ("blurred by 10°", |f| 100.0 * f.blurred.l1),
        ("shape alone, blurred", |f| 100.0 * f.blurred_shape.l1),
    ];
    let bar = |value: f64, found: Summary| Bar {
        value,
        low: found.least,
        high: found.most,
    };
    let by_kind = kinds.map(|(name, figure)| {
        let points = of.along(widths, Width::Paper, figure).into_iter();
        Series::new(name, points.map(|(x, found)| (x, bar(found.median, found))))
    });
    let albedos = Width::ALL.map(|width| {
        let points = of.along(inclinations, width, albedo_ratio).into_iter();
        Series::new(
            named(of, width),
            points.map(|(x, found)| (x, bar(found.geometric_mean, found))),
        )
    });
    let theta_o = Axis::linear("inclination of the viewer, θₒ (°)");
    let ratio = Axis::linear("ratio of the albedos");
    [
        (
            "difference-by-k",
            lines("How far the Cauchy model is from the Gaussian one", width(), l1(), &by_factor),
            "Integral over the sphere of |S cos θᵢ of the Cauchy model − that of the Gaussian model|, relative to the \
             albedo of the latter, by the factor k on the Cauchy model's widths: medians over the other axes of the grid. \
             By quadrature, exact to less than 0.1% of each figure.",
        ),
        (
            "difference-by-kind",
            lines("The same widths: as they are, by shape, and blurred", width(), l1(), &by_kind),
            "The same for k = 1: as the models are, with the Cauchy model scaled to the Gaussian one's albedo, and after a \
             blur of 10°. Marks are medians, bars go from the least to the most of the cells.",
        ),
        (
            "albedo",
            lines("Albedo of the Cauchy model over that of the Gaussian one", theta_o, ratio, &albedos),
            "Directional albedos, the integrals of S cos θᵢ: geometric means over the other axes of the grid; bars go from \
             the least to the most of the cells.",
        ),
    ]
    .map(|(name, chart, caption)| Drawing::new(name, chart, caption))
    .into()
}

/// Returns the name of a choice of widths, with its factor.
fn named(of: &Difference, width: Width) -> String {
    let factor = of.factor(width);
    if factor.is_empty() {
        width.name().to_owned()
    } else {
        format!("{}, k = {factor}", width.name())
    }
}
