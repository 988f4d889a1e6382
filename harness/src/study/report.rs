//! The report of a study: one page, the answer first.

mod charts;
mod findings;
mod looks;
mod rays;
mod tables;

use super::output::{Study, Times};
use super::part::Header;
use super::view::View;
use crate::difference::{Difference, SIGMA_DEG};
use crate::machine::Machine;
use crate::report::{Drawing, Report, Section};
use serde_json::Value;

/// Whether the content of a `claims.json` has verdicts to show.
pub(super) fn has_claims(claims: &Value) -> bool {
    tables::claims(claims).is_some()
}

impl Study {
    /// The page. `claims`, if given, is what `claims.json` holds: its verdicts are shown with the commit they are of.
    #[must_use]
    pub fn report(&self, times: &Times, difference: &Difference, claims: Option<&Value>) -> Report {
        let header = &self.header;
        let view = View { study: self, times };
        let quick = if header.quick { " --quick" } else { "" };
        let mut page = Report::new("Hair scattering: is the all-Cauchy model worth it?").subtitle(format!(
            "hairis study{quick}, seed {}: {} cells of hair and viewing angle, {} samplers of two models, {} lights{}",
            header.seed,
            header.cells,
            header.samplers.len(),
            header.lights.len(),
            findings::map(&header.lights).map_or_else(String::new, |map| format!(", of which the map is {map}"))
        ));
        for [case, sentence] in findings::verdicts(&view, difference) {
            page = page.verdict(case, sentence);
        }
        page = page.summary(charts::summary(&view));
        for finding in findings::findings(&view, difference) {
            page = page.finding(finding);
        }
        page = sections(page, &view, difference);
        if let Some(table) = claims.and_then(tables::claims) {
            page = page.section(Section::new("The paper's claims").table(table));
        }
        method(page, header, claims.is_some())
    }
}

fn sections(page: Report, view: &View<'_>, difference: &Difference) -> Report {
    let with = |section: Section, figures: Vec<Drawing>| figures.into_iter().fold(section, Section::figure);
    let variance = with(
        Section::new("Variance").paragraph(
            "V is the variance of one sample over the squared mean: an error of 1% takes 10⁴ V samples. `published` is the \
             published sampler, `uniform` draws from the whole sphere, and the samplers named `matched` follow each \
             model's own bells. The Cauchy model has the Gaussian one's widths (k = 1). `perfect` is no sampler: it is \
             what one would come to that draws in proportion to S cos θᵢ, the mean of red, green and blue, and knows \
             nothing of the light.",
        ),
        [charts::variances(view), charts::limits(view)].concat(),
    );
    let time = with(
        Section::new("Efficiency").paragraph(
            "What counts is the variance that is left after a given time. A sampler prepares each shading point, then \
             draws from it; a path tracer draws once, direct lighting often. Every sample needs the light in its \
             direction: gains are given for the samplers' own times, and with a look-up of the light added.",
        ),
        [charts::efficiencies(view), charts::gains(view)].concat(),
    );
    let spread = with(Section::new("How the gains spread"), charts::distributions(view));
    let weights = with(Section::new("Effective samples and largest weights"), charts::weights(view));
    let rays = rays::section(view);
    let looks = Section::new("How different the models look").paragraph(format!(
        "Differences are of S cos θᵢ over the whole sphere, the mean of red, green and blue. L1 is the integral of the \
         magnitude over the Gaussian model's albedo: 30% says that light worth 30% of what the Gaussian model \
         reflects is reflected elsewhere, is missing, or is new. L2 is the root of the integral of the square, over \
         that of the Gaussian model. k is the factor on the widths of the Cauchy model: 1 (paper), 1.177 (half-width), \
         0.798 (area), the best for the grid and the best for each cell, both in L2. The blur is by a von \
         Mises-Fisher density of {SIGMA_DEG}°: what is left of a difference in a light that wide."
    ));
    let looks = with(looks.heading("The default hair"), looks::pictures());
    let looks = with(looks.heading("Over the grid"), looks::charts(difference));
    let looks = difference.tables().into_iter().fold(looks, Section::table);
    let mut tables = view.summary(view.times).into_iter().fold(Section::new("Tables"), Section::table);
    tables = tables.table(tables::quality(view)).table(tables::times(view)).table(tables::look_ups(view));
    [variance, time, spread, weights, rays, looks, tables].into_iter().fold(page, Report::section)
}

fn method(mut page: Report, header: &Header, has_claims: bool) -> Report {
    page = page
        .method(format!(
            "Each of the {} cells is a hair (the widths of R, of TT and of the glints, the glints' distance and \
             strength) seen from an inclination. In each, every sampler of either model draws {} directions with \
             random numbers of its own; under lights that are not seen from everywhere {} directions of the light join \
             them, so that no small light has to be hit by luck. Contributions are the mean of red, green and blue.",
            header.cells, header.samples, header.light_samples
        ))
        .method(
            "Gains are medians over the grid, and other means geometric, unless it says otherwise; their standard errors \
             are those of the sampling, the grid being what it is; that of a median is that of its cell. Cells where a V is known to no better than 25% are left out of \
             gains. Words such as less and more are used beyond two standard errors.",
        )
        .method(
            "Perfect sampling is estimated from the directions of `matched-25`, whose weights vary least and are bounded, \
             and of the light; the albedo it needs is the mean of the same weights, not that of another source, so that \
             their errors cancel. A look-up is timed in directions of `published`, in turns with the samplers.",
        )
        .method(
            "Differences of looks are quadrature in double precision and have no statistical error; their own is \
             below 0.1% of each figure.",
        )
        .method(
            "The rows are in study.csv, efficiency.csv and difference.csv, the figures in figures/.",
        );
    if !has_claims {
        page = page.method(
            "`hairis claims` holds each of the paper's claims against figures; run with the same --out before \
             `hairis merge` or `hairis study`, its verdicts are part of this page.",
        );
    }
    let machine = Machine::current();
    page.fact("command", format!("hairis study{}", if header.quick { " --quick" } else { "" }))
        .fact("seed", header.seed.to_string())
        .fact("samples", format!("{} a sampler and cell, {} a light and cell", header.samples, header.light_samples))
        .fact("cells computed by", format!("version {}, commit {}", header.version, header.commit))
        .fact("cells computed on", header.level.clone())
        .fact("environment", format!("digest {}", header.environment))
        .fact("times measured on", machine.summary())
}
