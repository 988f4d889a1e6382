//! Lights that every experiment compares models under, and their names in sentences.
//!
//! Experiments select lights by name, or by kind. No figure depends on how many lights there are.

use hairis_instruments::direction::fibre_direction;
use hairis_instruments::light::{Constant, Environment, Light, Rectangle, Sky, Smooth, Sun};
use std::sync::LazyLock;

/// Inclination and azimuth of the sun's centre, in degrees.
pub const SUN_DEG: [f64; 2] = [-60.0, 25.0];

/// Lights of a run: those that need no file, the environment, and further ones.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lights<'a> {
    environment: Option<&'a Environment>,
    further: &'a [&'a dyn Light],
}

impl<'a> From<&'a Environment> for Lights<'a> {
    fn from(environment: &'a Environment) -> Self {
        Some(environment).into()
    }
}

impl<'a> From<Option<&'a Environment>> for Lights<'a> {
    fn from(environment: Option<&'a Environment>) -> Self {
        Self {
            environment,
            further: &[],
        }
    }
}

impl<'a> Lights<'a> {
    /// Returns the same lights with `further` ones after all others.
    #[must_use]
    pub const fn with(self, further: &'a [&'a dyn Light]) -> Self {
        Self { further, ..self }
    }

    /// Returns every light of the run, in the order of reports.
    #[must_use]
    pub fn all(&self) -> Vec<&'a dyn Light> {
        static SUN: LazyLock<Sun> = LazyLock::new(|| {
            let [theta, phi] = SUN_DEG.map(f64::to_radians);
            Sun::five_degrees(fibre_direction(theta, phi))
        });
        let mut all: Vec<&dyn Light> = vec![&Constant, &Smooth, &*SUN, &Rectangle];
        all.extend(self.environment.map(|map| map as &dyn Light));
        // Append a new light here, on its own line: streams of random numbers are keyed by place.
        all.extend(self.further);
        all
    }

    /// Returns the environment, if the run has one.
    #[must_use]
    pub const fn environment(&self) -> Option<&'a Environment> {
        self.environment
    }

    /// Returns the environment, if `light` is the environment.
    pub(crate) fn as_environment(&self, light: &dyn Light) -> Option<&'a Environment> {
        self.environment.filter(|map| map.name() == light.name())
    }
}

/// Returns the light of a name, if it needs no file.
fn find(name: &str) -> Option<&'static dyn Light> {
    let mut all = Lights::default().all().into_iter();
    all.find(|light| light.name() == name)
}

/// Returns the index of the environment among names of lights: the first name that no light without a file has.
pub(crate) fn environment(names: &[String]) -> Option<usize> {
    names.iter().position(|name| find(name).is_none())
}

/// Returns a light's name in a sentence.
pub(crate) fn in_words(name: &str) -> &str {
    match find(name) {
        Some(light) => light.words(),
        None if name == Sky::NAME => Sky::WORDS,
        None => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claims;
    use crate::efficiency::{self, Budget, EfficiencyConfig, EfficiencyResult};
    use crate::journal::Journal;
    use crate::study::Plan;
    use crate::study::output::Study;
    use glam::DVec3;
    use hairis::Vec3x8;
    use hairis_instruments::light::{LightSample, Seen8};
    use hairis_instruments::quadrature::{Integral, SphereIntegrator};
    use hairis_instruments::shard::Shard;

    /// Sixth light: a sun elsewhere.
    #[derive(Debug)]
    struct Moon(Sun);

    impl Light for Moon {
        fn name(&self) -> &str {
            "moon"
        }

        fn see(&self, dir: DVec3) -> ([f64; 3], f64) {
            self.0.see(dir)
        }

        fn sample(&self, xi: [f64; 2]) -> LightSample {
            self.0.sample(xi)
        }

        fn see8(&self, dir: &Vec3x8) -> Seen8 {
            self.0.see8(dir)
        }

        // Over its own disc. Over the whole sphere no quadrature converges, and each integral takes seconds.
        fn integrate(
            &self,
            f: &dyn Fn(DVec3) -> [f64; 3],
            sphere: &SphereIntegrator,
        ) -> Integral<3> {
            self.0.integrate(f, sphere)
        }
    }

    const BUDGET: Budget = Budget {
        independent: 512,
        correlated: 16,
        randomisations: 16,
        mis: 256,
        sweep: 256,
        convergence: 16,
        convergence_n: 16,
        quadrature_texels: 0,
        reference_passes: 4,
    };

    /// Returns the results of `of` under the five lights, and under the five and the sixth.
    fn without_and_with<T>(of: impl Fn(Lights<'_>) -> T) -> [T; 2] {
        let sky = Sky::default().environment();
        let moon = Moon(Sun::five_degrees(DVec3::new(0.7, 0.7, -0.1)));
        let five = Lights::from(&sky);
        [five, five.with(&[&moon])].map(of)
    }

    #[test]
    fn names_are_distinct_and_found() {
        let all = Lights::default().all();
        for (place, light) in all.iter().enumerate() {
            let same = all.iter().position(|other| other.name() == light.name());
            assert_eq!(same, Some(place), "{} is the name of two", light.name());
            assert_eq!(in_words(light.name()), light.words());
        }
        assert_eq!(in_words(Sky::NAME), Sky::WORDS);
        assert_eq!(in_words("a map.hdr"), "a map.hdr");
        let names = ["sun", "a map.hdr", "constant", "moon"].map(str::to_owned);
        assert_eq!(environment(&names), Some(1));
    }

    #[test]
    fn a_sixth_light_moves_no_row_of_the_others() {
        let run = |lights: Lights<'_>| {
            let config = EfficiencyConfig {
                budget: BUDGET,
                ..EfficiencyConfig::new(3, true, lights)
            };
            efficiency::run(&config, &|_, _| ()).expect("accepted")
        };
        let [five, mut six] = without_and_with(run);
        assert_eq!(six.settings.lights.len(), 6);
        let rows = six.rows.len();
        six.rows.retain(|row| row.light != "moon");
        assert_eq!(rows - six.rows.len(), rows / 6, "the sixth has rows");
        let shown = |of: &EfficiencyResult| {
            format!(
                "{:?} {:?} {:?} {:?} {:?}",
                of.rows, of.mis_rows, of.convergence, of.beta_sweep, of.reference_v
            )
        };
        assert!(shown(&five) == shown(&six), "the others are as before");
        assert_eq!(five.check.passed(), six.check.passed());
    }

    #[test]
    fn a_sixth_light_moves_no_verdict_of_the_claims() {
        let [five, six] = without_and_with(|lights: Lights<'_>| {
            let plan = Plan {
                seed: 5,
                quick: true,
                lights,
                materials: &[],
            };
            claims::sampled(&plan, &Journal::default()).expect("accepted")
        });
        assert!(five.len() > 5, "{five:?}");
        assert_eq!(five, six);
    }

    #[test]
    fn a_sixth_light_moves_no_finding_of_a_study() {
        // V of 1 to 5, by light, model and sampler; a small V under the sixth.
        let study = |lights: Lights<'_>| {
            let plan = Plan {
                seed: 5,
                quick: true,
                lights,
                materials: &[],
            };
            Study::of_figures(plan.header(Shard::WHOLE), &|row, light| {
                if light == "moon" {
                    1e-3
                } else {
                    1.0 + (7 * row % 11) as f64 / 3.0
                }
            })
        };
        let [five, six] = without_and_with(study);
        assert_eq!(five.failures(), six.failures());
        let lines = |study: &Study| -> Vec<String> {
            let tables = study.summary();
            let text = tables.iter().map(|table| table.to_text(Some(u16::MAX)));
            let text = text.collect::<Vec<_>>().join("\n");
            let lines = text.lines().filter(|line| !line.contains("moon"));
            lines
                .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "))
                .collect()
        };
        assert_eq!(lines(&five), lines(&six));
        assert!(five.limit_in_words().is_some());
        assert_eq!(five.limit_in_words(), six.limit_in_words());
    }
}
