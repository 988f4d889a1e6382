//! The differences as columns and as tables.

use super::{Difference, DifferenceRow, Differences, Width};
use crate::stats::percentile;
use crate::study::columns::Columns;
use crate::study::grid::columns_of;
use crate::table::{Table, number};

/// Differences of a row, by name.
type Shown = (&'static str, fn(&Differences) -> f64);

/// The relative differences.
const NORMS: [Shown; 8] = [
    ("L1", |f| f.plain.l1),
    ("L2", |f| f.plain.l2),
    ("shape, L1", |f| f.shape.l1),
    ("shape, L2", |f| f.shape.l2),
    ("blurred, L1", |f| f.blurred.l1),
    ("blurred, L2", |f| f.blurred.l2),
    ("blurred shape, L1", |f| f.blurred_shape.l1),
    ("blurred shape, L2", |f| f.blurred_shape.l2),
];

/// Geometric mean, median, least and most of some figures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Summary {
    pub(crate) geometric_mean: f64,
    pub(crate) median: f64,
    pub(crate) least: f64,
    pub(crate) most: f64,
}

impl Summary {
    /// Summary of positive numbers; NaN if there are none.
    pub(crate) fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let logarithm = values.iter().map(|x| x.ln()).sum::<f64>() / values.len() as f64;
        let at = |share| percentile(&values, share);
        Self { geometric_mean: logarithm.exp(), median: at(0.5), least: at(0.0), most: at(1.0) }
    }
}

impl Difference {
    /// The rows as columns.
    ///
    /// | column | content |
    /// |---|---|
    /// | `cell` .. `theta_o_deg` | the cell, as in the study's rows; widths, `phi_g` and `theta_o` in degrees |
    /// | `width`, `k` | choice of the Cauchy model's widths ([`Width::name`]), and their factor |
    /// | `albedo_gaussian`, `albedo_cauchy` | integral of `S cos theta_i` over the sphere, mean of RGB |
    /// | `albedo_ratio` | that of the Cauchy model over that of the Gaussian one |
    /// | `l1`, `l2` | norm of the difference of `S cos theta_i` over the Gaussian model's own norm |
    /// | `shape_l1`, `shape_l2` | the same with the Cauchy model scaled to the Gaussian one's albedo |
    /// | `blurred_l1` .. `blurred_shape_l2` | the four after a blur of [`SIGMA_DEG`](super::SIGMA_DEG) |
    #[must_use]
    pub fn columns(&self) -> Columns {
        const NAMES: [&str; 8] =
            ["l1", "l2", "shape_l1", "shape_l2", "blurred_l1", "blurred_l2", "blurred_shape_l1", "blurred_shape_l2"];
        let rows = self.rows();
        let figure = |of: fn(&Differences) -> f64| rows.iter().map(move |row| of(&row.figures));
        let columns = columns_of(rows.iter().map(|row| &row.cell))
            .text("width", rows.iter().map(|row| row.width.name()))
            .number("k", figure(|f| f.k))
            .number("albedo_gaussian", figure(|f| f.albedo_gaussian))
            .number("albedo_cauchy", figure(|f| f.albedo_cauchy))
            .number("albedo_ratio", figure(albedo_ratio));
        NAMES.into_iter().zip(NORMS).fold(columns, |columns, (name, (_, of))| columns.number(name, figure(of)))
    }

    /// The tables that sum it up.
    #[must_use]
    pub fn tables(&self) -> Vec<Table> {
        vec![self.by_width(), self.by_roughness(), self.by_inclination()]
    }

    /// The summary of a figure over the cells of one choice of widths.
    pub(crate) fn summary(&self, width: Width, of: fn(&Differences) -> f64) -> Summary {
        Summary::of(self.of(width).map(|row| of(&row.figures)))
    }

    /// The factor of a choice of widths; for that of each cell its range, in words.
    pub(crate) fn factor(&self, width: Width) -> String {
        let k = self.summary(width, |f| f.k);
        let shown = |k| number::plain(k, 4);
        if k.most > k.least { format!("{} to {}", shown(k.least), shown(k.most)) } else { shown(k.median) }
    }

    fn by_width(&self) -> Table {
        let mut table = Table::new("How far the Cauchy model is from the Gaussian one, over the grid")
            .text("widths")
            .number("k")
            .text("difference")
            .numbers(["geometric mean", "median", "worst"]);
        for width in Width::ALL {
            for (name, of) in NORMS {
                let found = self.summary(width, of);
                let shown = [found.geometric_mean, found.median, found.most].map(number::percent);
                let [mean, median, most] = shown;
                table.push([width.name().to_owned(), self.factor(width), name.to_owned(), mean, median, most]);
            }
        }
        table.note(format!(
            "Norms of the difference of S cos θᵢ over the sphere, mean of RGB, relative to the Gaussian model's own. Shape: \
             with the Cauchy model scaled to the same albedo. Blurred: by a von Mises-Fisher density of {}°.",
            super::SIGMA_DEG
        ))
    }

    fn by_roughness(&self) -> Table {
        let mut table =
            Table::new("The same by the width of R: geometric mean (worst)").number("β_R, °").text("widths");
        let shown = [NORMS[0], NORMS[1], NORMS[2], NORMS[4], NORMS[6]];
        table = table.numbers(shown.map(|(name, _)| name));
        for beta in axis_values(self.rows(), |row| row.cell.beta_r_deg) {
            for width in Width::ALL {
                let mut cells = vec![number::plain(f64::from(beta), 3), width.name().to_owned()];
                for (_, of) in shown {
                    let rows = self.of(width).filter(|row| row.cell.beta_r_deg == beta);
                    let found = Summary::of(rows.map(|row| of(&row.figures)));
                    cells.push(format!("{} ({})", number::percent(found.geometric_mean), number::percent(found.most)));
                }
                table.push(cells);
            }
        }
        table
    }

    fn by_inclination(&self) -> Table {
        let mut table =
            Table::new("Albedo of the Cauchy model over that of the Gaussian one: geometric mean (least to most)")
                .numbers(["θₒ, °", "albedo, Gaussian"]);
        table = table.numbers(Width::ALL.map(Width::name));
        for theta_o in axis_values(self.rows(), |row| row.cell.theta_o_deg) {
            let of = |width, figure: fn(&Differences) -> f64| {
                let rows = self.of(width).filter(|row| row.cell.theta_o_deg == theta_o);
                let found = Summary::of(rows.map(|row| figure(&row.figures)));
                let [mean, least, most] = [found.geometric_mean, found.least, found.most].map(|x| number::plain(x, 3));
                format!("{mean} ({least} to {most})")
            };
            let mut cells = vec![number::plain(f64::from(theta_o), 3), of(Width::Paper, |f| f.albedo_gaussian)];
            cells.extend(Width::ALL.map(|width| of(width, albedo_ratio)));
            table.push(cells);
        }
        table
    }
}

/// Albedo of the Cauchy model over that of the Gaussian one.
pub(crate) fn albedo_ratio(of: &Differences) -> f64 {
    of.albedo_cauchy / of.albedo_gaussian
}

/// The values of an axis, ascending.
pub(crate) fn axis_values(rows: &[DifferenceRow], of: impl Fn(&DifferenceRow) -> f32) -> Vec<f32> {
    let mut values: Vec<f32> = rows.iter().map(of).collect();
    values.sort_by(f32::total_cmp);
    values.dedup();
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Grid;

    #[test]
    fn summaries_are_of_all_the_figures() {
        let found = Summary::of([8.0, 1.0, 2.0].into_iter());
        assert!((found.geometric_mean - 16.0_f64.cbrt()).abs() < 1e-12, "{found:?}");
        assert_eq!((found.median, found.least, found.most), (2.0, 1.0, 8.0));
    }

    #[test]
    fn every_row_has_every_column() {
        let found = Difference::over(Grid { theta_o_deg: &[45.0], ..Grid::QUICK }).expect("accepted");
        let mut csv = Vec::new();
        found.columns().write_csv(&mut csv).expect("written");
        let fields: Vec<usize> =
            csv.split(|byte| *byte == b'\n').map(|row| row.split(|b| *b == b',').count()).collect();
        assert_eq!(fields.len(), found.rows().len() + 2, "names, rows and the end");
        assert!(fields[..=found.rows().len()].iter().all(|count| *count == fields[0]), "ragged");
        for table in found.tables() {
            assert!(!table.is_empty() && !table.to_plain().contains("n/a"), "{table}");
        }
    }
}
