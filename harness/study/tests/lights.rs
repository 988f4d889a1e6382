//! A light more, which moves no figure of the others.

use glam::DVec3;
use hairis::Vec3x8;
use hairis_harness::efficiency::{self, Budget, EfficiencyConfig, EfficiencyResult};
use hairis_harness::journal::Journal;
use hairis_harness::lights::Lights;
use hairis_instruments::light::{Light, LightSample, Seen8, Sky, Sun};
use hairis_instruments::quadrature::{Integral, SphereIntegrator};
use hairis_instruments::shard::Shard;
use hairis_study::claims;
use hairis_study::study::output::Study;
use hairis_study::study::{Plan, Size};

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
    fn integrate(&self, f: &dyn Fn(DVec3) -> [f64; 3], sphere: &SphereIntegrator) -> Integral<3> {
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
            size: Size::Tiny,
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
            size: Size::Quick,
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
