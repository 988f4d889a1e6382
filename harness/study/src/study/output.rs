//! Files of a finished study, and the columns of its efficiencies.

use super::estimator::published;
use super::rays;
use super::report;
use super::rows::Row;
use super::view::Counted;
use crate::difference::Difference;
use hairis_harness::times::PER_POINT;
use hairis_instruments::columns::Columns;
use hairis_instruments::error::Error;
use hairis_instruments::files::{whole, writable, write_json};
use hairis_instruments::machine;
use hairis_instruments::stats::Estimate;
use serde_json::{Value, json};
use std::path::Path;

pub use super::finished::Study;
pub use hairis_harness::times::Times;

impl Study {
    /// Parses the content of a `claims.json` for the report of this study.
    ///
    /// # Errors
    ///
    /// Returns the reason, in words, if the content is damaged or belongs to a run with other settings.
    pub fn claims(&self, content: &[u8]) -> Result<Value, String> {
        let claims = serde_json::from_slice(content)
            .ok()
            .filter(report::has_claims);
        let claims: Value = claims.ok_or("it is damaged")?;
        let header = json!(self.header);
        for name in ["seed", "quick", "cells", "samples"] {
            let (here, there) = (&header[name], &claims["settings"][name]);
            if here != there {
                return Err(format!(
                    "it belongs to a run with {name} {there}, expected {here}"
                ));
            }
        }
        Ok(claims)
    }

    /// Returns the rows' efficiencies, which depend on the machine as well.
    ///
    /// | column | what it is |
    /// |---|---|
    /// | `cell` .. `light`, `v`, `v_se` | as in [`columns`](Self::columns) |
    /// | `break_even`, `break_even_se` | V of `published` over `v`: the time of a sample, in times of `published`, at which it loses in equal time |
    /// | `look_up_ns`, `look_up_ns_se` | time of a look-up of the light in a direction, ns |
    /// | `ns_at_N`, `efficiency_at_N` | time of a sample, ns, and `1 / (V seconds)`, for N of 1, 4 and 16 samples per shading point |
    /// | `gain_at_N`, `gain_at_N_se` | by what factor less variance than `published` it has in equal time |
    /// | `look_up_efficiency_at_N` .. `look_up_gain_at_N_se` | the three with the look-up counted in every sample's time |
    /// | `ray_ns_mis`, `ray_ns_4_4`, `ray_ns_8_8` and their `_se` | time of a ray without its tracing, ns |
    /// | `gain_4_4_at_P_us`, `gain_8_8_at_P_us` and their `_se` | efficiency of such a ray over one-sample MIS where a ray costs P of 0.1, 0.3, 1 and 3 µs, half of the directions visible |
    ///
    /// Rows of `perfect`, which has no time, have only the columns of the first two lines, without a break-even if V is 0. A look-up that
    /// was not timed ([`Times::measure`]) leaves its columns empty.
    #[must_use]
    pub fn efficiencies(&self) -> Columns {
        let rows = self.rows();
        // The ratio of the published sampler to itself is exactly 1.
        let is_published = |row: &Row<'_>| row.of == published(row.of);
        let against_published = |row: &Row<'_>| match is_published(row) {
            true => Estimate::exact(1.0),
            false => self
                .row(row.cell, published(row.of), row.light)
                .v()
                .ratio(&row.v()),
        };
        let gains: Vec<Estimate> = rows.iter().map(against_published).collect();
        let look_up = |row: &Row<'_>| {
            row.of
                .1
                .map_or(Estimate::UNKNOWN, |_| self.look_up(row.light))
        };
        let mut columns = self
            .keys(&rows)
            .estimate("v", rows.iter().map(Row::v))
            .estimate("break_even", gains.iter().copied())
            .estimate("look_up_ns", rows.iter().map(look_up));
        for per_point in PER_POINT {
            let ns = |row: &Row<'_>| self.ns(row.of, per_point).value;
            columns = columns.number(format!("ns_at_{per_point}"), rows.iter().map(ns));
            for (prefix, counted) in [("", Counted::Sample), ("look_up_", Counted::LookUp)] {
                let efficiency = |row: &Row<'_>| {
                    1e9 / (row.v().value * (ns(row) + self.more(row.light, counted).value))
                };
                let gain = |(row, gain): (&Row<'_>, &Estimate)| {
                    let time =
                        self.time_ratio([published(row.of), row.of], row.light, per_point, counted);
                    if is_published(row) && !time.value.is_nan() {
                        *gain
                    } else {
                        gain.times(&time)
                    }
                };
                columns = columns
                    .number(
                        format!("{prefix}efficiency_at_{per_point}"),
                        rows.iter().map(efficiency),
                    )
                    .estimate(
                        &format!("{prefix}gain_at_{per_point}"),
                        rows.iter().zip(&gains).map(gain),
                    );
            }
        }
        rays::efficiencies(columns, &rows, self)
    }

    /// Checks that [`write`](Self::write) can write into `dir`, before the work for it begins.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Output`] for the first file that cannot be written.
    pub fn writable(dir: &Path, has_materials: bool) -> Result<(), Error> {
        let mut files = vec!["times.csv", "refitted.csv", "study.json"];
        files.extend(["study.csv", "efficiency.csv", "difference.csv"]);
        if cfg!(feature = "parquet") {
            files.extend(["study.parquet", "efficiency.parquet", "difference.parquet"]);
        }
        if has_materials {
            files.push("materials.csv");
        }
        files.iter().try_for_each(|name| writable(&dir.join(name)))
    }

    /// Writes the files of the study into `dir`, each as a whole or not at all: `study.csv` (the rows), `efficiency.csv`, `difference.csv`
    /// (the differences in look), `refitted.csv` (the fitted Cauchy model), `times.csv` and `study.json` (the settings). If there are
    /// materials, writes `materials.csv` (their rows). With the feature `parquet`, writes the first three as `.parquet` too.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Output`] for the first file that cannot be written.
    pub fn write(&self, dir: &Path, difference: &Difference) -> Result<(), Error> {
        whole(&dir.join("times.csv"), |out| {
            self.times.columns().write_csv(out)
        })?;
        let tables = [
            ("study", self.columns()),
            ("efficiency", self.efficiencies()),
            ("difference", difference.columns()),
        ];
        for (name, columns) in tables {
            whole(&dir.join(format!("{name}.csv")), |out| {
                columns.write_csv(out)
            })?;
            #[cfg(feature = "parquet")]
            whole(&dir.join(format!("{name}.parquet")), |out| {
                columns.write_parquet(self.notes(), out)
            })?;
        }
        let refits = self.refit_columns(difference);
        whole(&dir.join("refitted.csv"), |out| refits.write_csv(out))?;
        if !self.materials.is_empty() {
            let columns = self.material_columns();
            whole(&dir.join("materials.csv"), |out| columns.write_csv(out))?;
        }
        let settings = json!({ "study": self.header, "times_measured_on": machine!() });
        write_json(&dir.join("study.json"), &settings)
    }
}

#[cfg(feature = "parquet")]
impl Study {
    /// Returns the header, as metadata.
    fn notes(&self) -> Vec<(String, String)> {
        let header = serde_json::to_value(&self.header).unwrap_or_default();
        let fields = header.as_object().into_iter().flatten();
        fields
            .map(|(key, value)| (format!("hairis.{key}"), value.to_string()))
            .collect()
    }
}
