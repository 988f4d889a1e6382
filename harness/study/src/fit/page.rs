//! Page of a fit: values, residuals by view and lobe, and maps of the difference.

use super::{Fit, Look, Norm, Residual};
use hairis_harness::materials::NamedMaterial;
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::error::Error;
use hairis_instruments::plot::{Axis, Series, SphereGrid, heat_map, lines};
use hairis_instruments::report::{Drawing, Report, Section, literal};
use hairis_instruments::table::{Table, number};
use hairis_materials::MaterialSpec;
use hairis_variants::{Kind, Values};

/// Contents of the page.
pub(crate) struct Shown<'a> {
    pub(crate) from: &'a NamedMaterial,
    pub(crate) start: &'a Look,
    pub(crate) fit: &'a Fit,
    pub(crate) norm: Norm,
    pub(crate) before: &'a [Residual],
    pub(crate) after: &'a [Residual],
}

impl Shown<'_> {
    /// Returns the distances at the start and after the fit, in words.
    pub(crate) fn sentence(&self) -> String {
        let Self {
            from, fit, norm, ..
        } = self;
        let [before, after] = [fit.distance_of_start, fit.distance].map(number::percent);
        let name = fit.found.model.name();
        format!(
            "{name} fitted to {}: {} {after}, from {before} at the start",
            from.name,
            norm.name()
        )
    }

    /// Lists the fitted values, with those of the start where they differ.
    fn changes(&self) -> String {
        let (start, found) = (&self.start.values, &self.fit.found.values);
        let fields = found.fields().iter().enumerate();
        let said = fields
            .filter(|(index, _)| found.has_at(*index))
            .map(|(index, field)| {
                let [before, after] = [start, found].map(|values| {
                    let entries =
                        (0..field.kind.width()).map(|place| in_words(values, index, place));
                    entries.collect::<Vec<_>>().join(" ")
                });
                let before = if before == after {
                    String::new()
                } else {
                    format!(" (from {before})")
                };
                format!("{} {after}{before}", field.name)
            });
        said.collect::<Vec<_>>().join(", ")
    }

    /// Returns the page with all sections.
    pub(crate) fn report(&self) -> Result<Report, Error> {
        let (name, to) = (&self.from.name, self.fit.found.model.name());
        Ok(Report {
            title: format!("{to} fitted to {name}"),
            subtitle: format!("hairis fit, norm {}", self.norm.name()),
            verdicts: vec![
                ["Distance".to_owned(), literal(&self.sentence()) + "."],
                ["Values".to_owned(), self.changes() + "."],
            ],
            sections: vec![
                Section::new("Values").tables([self.values(), self.starts()]),
                Section::new("Residuals")
                    .figures(self.residuals())
                    .tables([self.views()]),
                Section::new("Maps").figures(self.maps()?),
            ],
            ..Report::default()
        })
    }

    /// Returns the table of values at the first start and at the end.
    fn values(&self) -> Table {
        let mut table = Table::new("Values")
            .texts(["field"])
            .numbers(["start", "fitted"]);
        let (start, found) = (&self.start.values, &self.fit.found.values);
        for (index, field) in found.fields().iter().enumerate() {
            if !found.has_at(index) {
                continue;
            }
            for place in 0..field.kind.width() {
                let label = match field.kind {
                    Kind::Numbers(labels) => format!("{} {}", field.name, labels[place]),
                    Kind::Rgb => format!("{} {}", field.name, ["red", "green", "blue"][place]),
                    _ => field.name.to_owned(),
                };
                let [start, found] = [start, found].map(|values| in_words(values, index, place));
                table.push([label, start, found]);
            }
        }
        table
    }

    /// Returns the table of distances at every start and end.
    fn starts(&self) -> Table {
        let headers = ["start", "distance there", "at the end", "iterations"];
        let mut table = Table::new("Starts").numbers(headers);
        for (place, end) in (1..).zip(&self.fit.ends) {
            let [before, after] = [end.distance_of_start, end.distance].map(number::percent);
            table.push([
                format!("{place}"),
                before,
                after,
                end.iterations.to_string(),
            ]);
        }
        table
    }

    fn views(&self) -> Table {
        let headers = [
            "θₒ, °",
            "L1",
            "at the start",
            "L2",
            "at the start",
            "albedo",
            "fitted",
        ];
        let mut table = Table::new("Distance by view").numbers(headers);
        for (before, after) in self.before.iter().zip(self.after) {
            let [l1, l1_before, l2, l2_before] =
                [after.l1, before.l1, after.l2, before.l2].map(number::percent);
            let [own, fitted] = [after.albedo_from, after.albedo_to].map(|x| number::plain(x, 3));
            let angle = number::plain(after.theta_o_deg, 3);
            table.push([angle, l1, l1_before, l2, l2_before, own, fitted]);
        }
        table
    }

    fn residuals(&self) -> [Drawing; 2] {
        let theta_o = || Axis::linear("inclination of the viewer, θₒ (°)");
        let l1 = || Axis::linear("difference of S cos θᵢ, L1 (%)");
        let line = |name: &str, rows: &[Residual], of: &dyn Fn(&Residual) -> f64| {
            Series::new(
                name,
                rows.iter().map(|row| (row.theta_o_deg, 100.0 * of(row))),
            )
        };
        let by_view = [
            line("at the start", self.before, &|row| row.l1),
            line("fitted", self.after, &|row| row.l1),
        ];
        let lobes: Vec<Series> = (self.from.model.lobes().iter().enumerate())
            .map(|(lobe, name)| line(name, self.after, &|row| row.lobes[lobe]))
            .collect();
        [
            Drawing::new(
                "by-view",
                lines("Distance by view", theta_o(), l1(), &by_view),
                "Integral over the sphere of the magnitude of the difference, relative to the light that the first model reflects.",
            ),
            Drawing::new(
                "by-lobe",
                lines("Distance by lobe, fitted", theta_o(), l1(), &lobes),
                "The same after the fit, divided at each direction as the lobes of the first model divide S.",
            ),
        ]
    }

    /// Draws maps of the difference of `S cos theta_i` at 45 degrees, before and after the fit, in the same colours.
    fn maps(&self) -> Result<[Drawing; 2], Error> {
        const THETA_O_DEG: f64 = 45.0;
        let wo = fibre_direction(THETA_O_DEG.to_radians(), 0.0).as_vec3();
        let of = |look: &Look| -> Result<_, Error> {
            let spec = MaterialSpec::new(look.model, look.values)?;
            let bsdf = spec.material.prepare(wo);
            Ok(move |theta: f64, phi: f64| {
                let s = bsdf.eval(fibre_direction(theta, phi).as_vec3());
                theta.cos() * s.into_iter().map(f64::from).sum::<f64>() / 3.0
            })
        };
        let from = of(&Look {
            model: self.from.model,
            values: self.from.values,
        })?;
        let [start, found] = [of(self.start)?, of(&self.fit.found)?];
        let grids = [&start, &found].map(|other| {
            SphereGrid::sample((60, 120), &mut |theta, phi| {
                other(theta, phi) - from(theta, phi)
            })
        });
        let ranges = grids.iter().filter_map(SphereGrid::range);
        let most = ranges
            .fold(0.0, |most: f64, (low, high)| most.max(-low).max(high))
            .max(1e-9);
        let map = |name: &str, when: &str, grid: &SphereGrid| {
            let value = Axis::linear("difference of S cos θᵢ (1/sr)").range(-most, most);
            let title = format!("Difference {when}, θₒ = {THETA_O_DEG:.0}°");
            let caption = format!(
                "The second model less the first {when}, seen from θₒ = {THETA_O_DEG:.0}° at azimuth 0: the mean of RGB."
            );
            Drawing::new(name, heat_map(&title, value, grid), caption)
        };
        let [before, after] = &grids;
        Ok([
            map("map-start", "at the start", before),
            map("map-fitted", "after the fit", after),
        ])
    }
}

/// Returns one entry of a value.
fn in_words(values: &Values, index: usize, place: usize) -> String {
    let field = &values.fields()[index];
    match field.kind {
        Kind::Word(_) => values.word(field.name).to_owned(),
        _ => number::plain(f64::from(values.numbers_at(index)[place]), 4),
    }
}
