//! Columns and tables of the differences.

use super::{Difference, Differences, Width};
use crate::study::grid::{GridAxis, columns_of};
use hairis_instruments::columns::Columns;
use hairis_instruments::stats::percentile;
use hairis_instruments::table::{Table, number};

/// Figure of a row: its column, its name in tables, and the function that returns its value.
type Figure = (&'static str, &'static str, fn(&Differences) -> f64);

/// Relative differences, in the order of columns and tables.
const NORMS: [Figure; 8] = [
    ("l1", "L1", |f| f.plain.l1),
    ("l2", "L2", |f| f.plain.l2),
    ("shape_l1", "shape, L1", |f| f.shape.l1),
    ("shape_l2", "shape, L2", |f| f.shape.l2),
    ("blurred_l1", "blurred, L1", |f| f.blurred.l1),
    ("blurred_l2", "blurred, L2", |f| f.blurred.l2),
    ("blurred_shape_l1", "blurred shape, L1", |f| {
        f.blurred_shape.l1
    }),
    ("blurred_shape_l2", "blurred shape, L2", |f| {
        f.blurred_shape.l2
    }),
];

/// Geometric mean, median, least and most of some figures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Geometric mean.
    pub geometric_mean: f64,
    /// Median.
    pub median: f64,
    /// Least.
    pub least: f64,
    /// Most.
    pub most: f64,
}

impl Summary {
    /// Summarises positive numbers; all fields are NaN if there are none.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let logarithm = values.iter().map(|x| x.ln()).sum::<f64>() / values.len() as f64;
        let at = |share| percentile(&values, share);
        Self {
            geometric_mean: logarithm.exp(),
            median: at(0.5),
            least: at(0.0),
            most: at(1.0),
        }
    }
}

impl Difference {
    /// Returns the rows as columns of a file.
    ///
    /// | column | content |
    /// |---|---|
    /// | `cell` .. `theta_o_deg` | the cell, as in the study's rows; widths, `phi_g` and `theta_o` in degrees |
    /// | `width`, `k` | choice of the Cauchy model's widths ([`Width::name`]), and their factor; 1 for `refitted` |
    /// | `albedo_gaussian`, `albedo_cauchy` | integral of `S cos theta_i` over the sphere, mean of RGB |
    /// | `albedo_ratio` | that of the Cauchy model over that of the Gaussian one |
    /// | `l1`, `l2` | norm of the difference of `S cos theta_i` over the Gaussian model's own norm |
    /// | `shape_l1`, `shape_l2` | the same with the Cauchy model scaled to the Gaussian one's albedo |
    /// | `blurred_l1` .. `blurred_shape_l2` | the four after a blur of [`SIGMA_DEG`](super::SIGMA_DEG) |
    #[must_use]
    pub fn columns(&self) -> Columns {
        let figure =
            |of: fn(&Differences) -> f64| self.rows.iter().map(move |row| of(&row.figures));
        let columns = columns_of(self.rows.iter().map(|row| &row.cell))
            .text("width", self.rows.iter().map(|row| row.width.name()))
            .number("k", figure(|f| f.k))
            .number("albedo_gaussian", figure(|f| f.albedo_gaussian))
            .number("albedo_cauchy", figure(|f| f.albedo_cauchy))
            .number("albedo_ratio", figure(albedo_ratio));
        NORMS.into_iter().fold(columns, |columns, (name, _, of)| {
            columns.number(name, figure(of))
        })
    }

    /// Returns the tables that summarise the differences: by widths, by roughness and by inclination.
    #[must_use]
    pub fn tables(&self) -> Vec<Table> {
        vec![self.by_width(), self.by_roughness(), self.by_inclination()]
    }

    /// Summarises a figure over the cells of one choice of widths.
    pub(crate) fn summary(&self, width: Width, of: fn(&Differences) -> f64) -> Summary {
        Summary::of(self.of(width).map(|row| of(&row.figures)))
    }

    /// Summarises a figure for each value of an axis of the grid.
    pub(crate) fn along(
        &self,
        axis: GridAxis,
        width: Width,
        of: fn(&Differences) -> f64,
    ) -> Vec<(f64, Summary)> {
        let (values, value_of) = axis;
        let summary = |value: &f32| {
            let rows = self.of(width).filter(|row| value_of(&row.cell) == *value);
            (
                f64::from(*value),
                Summary::of(rows.map(|row| of(&row.figures))),
            )
        };
        values.iter().map(summary).collect()
    }

    /// Returns the factor of a choice of widths in words, or its range if every cell has its own; empty without a factor.
    pub(crate) fn factor(&self, width: Width) -> String {
        if width == Width::Refitted {
            return String::new();
        }
        let k = self.summary(width, |f| f.k);
        let shown = |k| number::plain(k, 4);
        if k.most > k.least {
            format!("{} to {}", shown(k.least), shown(k.most))
        } else {
            shown(k.median)
        }
    }

    fn by_width(&self) -> Table {
        let mut table =
            Table::new("How far the Cauchy model is from the Gaussian one, over the grid")
                .texts(["widths"])
                .numbers(["k"])
                .texts(["difference"])
                .numbers(["geometric mean", "median", "worst"]);
        for width in Width::ALL {
            for (_, name, of) in NORMS {
                let found = self.summary(width, of);
                let words = [width.name().to_owned(), self.factor(width), name.to_owned()];
                table.push(
                    words.into_iter().chain(
                        [found.geometric_mean, found.median, found.most].map(number::percent),
                    ),
                );
            }
        }
        table.note(format!(
            "Norms of the difference of S cos θᵢ over the sphere, mean of RGB, relative to the Gaussian model's own. Shape: \
             with the Cauchy model scaled to the same albedo. Blurred: by a von Mises-Fisher density of {}°. Refitted: all \
             parameters of the Cauchy model fitted to the Gaussian one, in L1.",
            super::SIGMA_DEG
        ))
    }

    fn by_roughness(&self) -> Table {
        let shown = [NORMS[0], NORMS[1], NORMS[2], NORMS[4], NORMS[6]];
        let mut table = Table::new("The same by the width of R: geometric mean (worst)")
            .numbers(["β_R, °"])
            .texts(["widths"])
            .numbers(shown.map(|(_, name, _)| name));
        for (place, beta) in self.grid.beta_r_deg.iter().enumerate() {
            for width in Width::ALL {
                let cell = |(_, _, of)| {
                    let (_, found) = self.along(self.grid.widths(), width, of)[place];
                    format!(
                        "{} ({})",
                        number::percent(found.geometric_mean),
                        number::percent(found.most)
                    )
                };
                let words = [number::plain(f64::from(*beta), 3), width.name().to_owned()];
                table.push(words.into_iter().chain(shown.map(cell)));
            }
        }
        table
    }

    fn by_inclination(&self) -> Table {
        let title = "Albedo of the Cauchy model over that of the Gaussian one: geometric mean (least to most)";
        let mut table = Table::new(title)
            .numbers(["θₒ, °", "albedo, Gaussian"])
            .numbers(Width::ALL.map(Width::name));
        for (place, theta_o) in self.grid.theta_o_deg.iter().enumerate() {
            let cell = |width, of| {
                let (_, found) = self.along(self.grid.inclinations(), width, of)[place];
                let [mean, least, most] =
                    [found.geometric_mean, found.least, found.most].map(|x| number::plain(x, 3));
                format!("{mean} ({least} to {most})")
            };
            let words = [
                number::plain(f64::from(*theta_o), 3),
                cell(Width::Paper, |f| f.albedo_gaussian),
            ];
            table.push(
                words
                    .into_iter()
                    .chain(Width::ALL.map(|width| cell(width, albedo_ratio))),
            );
        }
        table
    }
}

/// Returns the albedo of the Cauchy model over that of the Gaussian one.
pub(crate) fn albedo_ratio(of: &Differences) -> f64 {
    of.albedo_cauchy / of.albedo_gaussian
}
