//! Report of a study: one page, with the answer first.

mod charts;
mod findings;
mod looks;
mod maps;
mod rays;
pub mod tables;

use super::finished::Study;
use crate::difference::{Difference, SIGMA_DEG};
use hairis_harness::variance::SOURCE;
use hairis_instruments::machine;
use hairis_instruments::report::{Report, Section};
use serde_json::Value;

/// Returns true if the content of a `claims.json` has verdicts to show.
pub(super) fn has_claims(claims: &Value) -> bool {
    tables::claims(claims).is_some()
}

impl Study {
    /// Returns the page. If `claims`, the content of `claims.json`, is given, its verdicts are shown with the commit that they are from.
    #[must_use]
    pub fn report(&self, difference: &Difference, claims: Option<&Value>) -> Report {
        let header = &self.header;
        let quick = header.size().flag();
        let subtitle = format!(
            "hairis study{quick}, seed {}: {} cells of hair and viewing angle, {} samplers of two models, {} lights{}",
            header.seed,
            header.cells,
            header.samplers.len(),
            header.lights.len(),
            findings::map(&header.lights)
                .map_or_else(String::new, |map| format!(", of which the map is {map}"))
        );
        let claims = claims.and_then(tables::claims);
        let method = self.method(claims.is_some());
        let mut sections = self.sections(difference);
        let materials = self.materials();
        sections.extend(materials.map(|table| Section::new("Other materials").tables([table])));
        sections.extend(claims.map(|table| Section::new("The paper's claims").tables([table])));
        sections.push(method);
        Report {
            title: "Hair scattering: is the all-Cauchy model worth it?".to_owned(),
            subtitle,
            verdicts: findings::verdicts(self, difference),
            summary: Some(charts::summary(self)),
            findings: findings::findings(self, difference),
            sections,
        }
    }

    /// Returns the limit of sampling the hair alone under the environment, in words.
    #[must_use]
    pub fn limit_in_words(&self) -> Option<String> {
        findings::limit(self)
    }

    fn sections(&self, difference: &Difference) -> Vec<Section> {
        let variance = "V is the variance of one sample over the squared mean: an error of 1% takes 10⁴ V samples. `published` \
                        is the published sampler, `uniform` draws from the whole sphere, and the samplers named `matched` \
                        follow each model's own bells. The Cauchy model has the widths of the Gaussian one (k = 1). `perfect` \
                        is no sampler but the limit of samplers that ignore the light: it draws in proportion to S cos θᵢ, \
                        the mean of red, green and blue.";
        let time = "What counts is the variance that is left after a given time. A sampler prepares each shading point, then \
                    draws from it: a path tracer once, direct lighting often. Every sample needs the light in its direction: \
                    gains are given for the samplers' own times, and with a look-up of the light added.";
        let looks = format!(
            "Differences are of S cos θᵢ over the whole sphere, the mean of red, green and blue. L1 is the integral of the \
             magnitude over the Gaussian model's albedo: 30% says that light worth 30% of what the Gaussian model reflects \
             is reflected elsewhere, is missing, or is new. L2 is the root of the integral of the square, over that of the \
             Gaussian model. k is the factor on the widths of the Cauchy model: 1 (paper), 1.177 (half-width), 0.798 (area), \
             the best for the grid and the best for each cell, both in L2; refitted, all parameters of the Cauchy model are \
             fitted to each hair, in L1 and from all inclinations together, by directions that no figure here is of. The blur is by a von Mises-Fisher density of \
             {SIGMA_DEG}°: what is left of a difference in a light that wide."
        );
        vec![
            Section::new("Variance")
                .paragraph(variance)
                .figures(charts::variances(self))
                .figures(charts::limits(self)),
            Section::new("Efficiency")
                .paragraph(time)
                .figures(charts::efficiencies(self))
                .figures(charts::gains(self)),
            Section::new("How the gains spread").figures(charts::distributions(self)),
            Section::new("Largest weights").figures(charts::weights(self)),
            rays::section(self),
            Section::new("How different the models look")
                .paragraph(looks)
                .heading("The default hair")
                .figures(looks::pictures())
                .heading("Over the grid")
                .figures(looks::charts(difference))
                .tables(difference.tables()),
            Section::new("Tables")
                .tables(self.summary())
                .tables(tables::all(self)),
        ]
    }

    fn method(&self, has_claims: bool) -> Section {
        let header = &self.header;
        let cells = format!(
            "Each of the {} cells is a hair (the widths of R, of TT and of the glints, the glints' distance and strength) seen \
             from an inclination. In each, every sampler of either model draws {} directions with random numbers of its own; \
             under lights that are not seen from everywhere {} directions of the light join them, so that no small light has \
             to be hit by luck. Contributions are the mean of red, green and blue.",
            header.cells, header.samples, header.light_samples
        );
        let claims = "`hairis claims` holds each of the paper's claims against figures; run with the same --out before \
                      `hairis merge` or `hairis study`, its verdicts are part of this page.";
        let perfect = format!(
            "Perfect sampling is estimated from the directions of `{}`, whose weights vary least and are bounded, and \
             of the light; the albedo it needs is the mean of the same weights, so that their errors cancel. A look-up is \
             timed in directions of `published`, in turns with the samplers.",
            SOURCE.name()
        );
        let others = [
            "Gains are medians over the grid, and other means geometric, unless it says otherwise. Standard errors are those \
             of the sampling, the grid being what it is; that of a median is that of its cell. Cells where a V is known to no \
             better than 25% are left out of gains. Words such as less and more are used beyond two standard errors.",
            &perfect,
            "Differences of looks are quadrature in double precision and have no statistical error; their own is below 0.1% \
             of each figure.",
            "The rows are in study.csv, efficiency.csv, difference.csv and refitted.csv, the figures in figures/.",
            claims,
        ];
        let others = &others[..others.len() - usize::from(has_claims)];
        let section = Section::new("Method and machine").paragraph(cells);
        others.iter().fold(section, Section::paragraph).facts(&[
            ["command", &format!("hairis study{}", header.size().flag())],
            ["seed", &header.seed.to_string()],
            [
                "samples",
                &format!(
                    "{} a sampler and cell, {} a light and cell",
                    header.samples, header.light_samples
                ),
            ],
            [
                "cells computed by",
                &format!("version {}, commit {}", header.version, header.commit),
            ],
            ["cells computed on", &header.level],
            ["environment", &format!("digest {}", header.environment)],
            ["times measured on", &machine!().summary()],
        ])
    }
}
