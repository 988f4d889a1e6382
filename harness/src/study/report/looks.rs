//! The plots of how different the models look.

use super::view::View;
use crate::difference::{Differences, Summary, Width, albedo_ratio};
use crate::figures;
use crate::plot::{Axis, Bar, LineChart, Series};
use crate::report::Drawing;
use hairis::HairParams;
use hairis_variants::Cauchy;

/// Inclination of the viewer in the pictures of the default hair, in degrees.
const THETA_O_DEG: f64 = 45.0;

/// A difference by name.
type NamedDifference = (&'static str, fn(&Differences) -> f64);

/// The default hair: sections and maps.
pub(super) fn pictures() -> Vec<Drawing> {
    let (hair, theta_o) = (HairParams::default(), THETA_O_DEG.to_radians());
    let variants = [
        ("Cauchy, k = 1", Cauchy::PAPER),
        ("Cauchy, k = 1.177", Cauchy::HALF_WIDTH),
        ("Cauchy, k = 0.798", Cauchy::AREA),
    ];
    let mut all = vec![figures::polar(&hair, theta_o, &variants)];
    all.extend(figures::maps(&hair, theta_o, Cauchy::PAPER));
    all.push(figures::difference_map(&hair, theta_o, Cauchy::PAPER));
    all
}

/// The differences over the grid.
pub(super) fn charts(of: &View<'_>) -> Vec<Drawing> {
    let x = || Axis::linear("width of R, β_R (°)").from_zero();
    let percent = |label: &str| Axis::linear(label.to_owned()).from_zero();
    let over = |width: Width, figure: fn(&Differences) -> f64| {
        of.grid.beta_r_deg.iter().map(move |beta| {
            let rows = of.difference.of(width).filter(|row| row.cell.beta_r_deg == *beta);
            (f64::from(*beta), Summary::of(rows.map(|row| 100.0 * figure(&row.figures))))
        })
    };
    let mut by_width = LineChart::new(
        "How far the Cauchy model is from the Gaussian one",
        x(),
        percent("difference of S cos θᵢ, L1 (%)"),
    );
    for width in Width::ALL {
        let points = over(width, |f| f.plain.l1).map(|(beta, found)| (beta, found.median));
        by_width = by_width.series(Series::new(named(of, width), points));
    }
    let mut by_kind = LineChart::new(
        "The same widths: as they are, by shape, and blurred",
        x(),
        percent("difference of S cos θᵢ, L1 (%)"),
    );
    let kinds: [NamedDifference; 4] = [
        ("as they are", |f| f.plain.l1),
        ("shape alone", |f| f.shape.l1),
        ("blurred by 10°", |f| f.blurred.l1),
        ("shape alone, blurred", |f| f.blurred_shape.l1),
    ];
    for (name, figure) in kinds {
        let point =
            |(beta, found): (f64, Summary)| (beta, Bar::new(found.median).with_interval(found.least, found.most));
        by_kind = by_kind.series(Series::new(name, over(Width::Paper, figure).map(point)));
    }
    let mut albedo = LineChart::new(
        "Albedo of the Cauchy model over that of the Gaussian one",
        Axis::linear("inclination of the viewer, θₒ (°)").from_zero(),
        Axis::linear("ratio of the albedos"),
    );
    for width in Width::ALL {
        let point = |theta_o: &f32| {
            let rows = of.difference.of(width).filter(|row| row.cell.theta_o_deg == *theta_o);
            let found = Summary::of(rows.map(|row| albedo_ratio(&row.figures)));
            (f64::from(*theta_o), Bar::new(found.geometric_mean).with_interval(found.least, found.most))
        };
        albedo = albedo.series(Series::new(named(of, width), of.grid.theta_o_deg.iter().map(point)));
    }
    vec![
        Drawing::new(
            by_width.svg(),
            "Integral over the sphere of |S cos θᵢ of the Cauchy model − that of the Gaussian model|, relative to the \
             albedo of the latter, by the factor k on the Cauchy model's widths: medians over the other axes of the grid. \
             By quadrature, exact to less than 0.1% of each figure.",
        )
        .named("difference-by-k"),
        Drawing::new(
            by_kind.svg(),
            "The same for k = 1: as the models are, with the Cauchy model scaled to the Gaussian one's albedo, and after a \
             blur of 10°. Marks are medians, bars go from the least to the most of the cells.",
        )
        .named("difference-by-kind"),
        Drawing::new(
            albedo.svg(),
            "Directional albedos, the integrals of S cos θᵢ: geometric means over the other axes of the grid; bars go from \
             the least to the most of the cells.",
        )
        .named("albedo"),
    ]
}

/// A choice of widths with its factor.
fn named(of: &View<'_>, width: Width) -> String {
    format!("{}, k = {}", width.name(), of.difference.factor(width))
}
