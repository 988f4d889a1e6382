//! Efficiencies against quadrature and the recorded table, of determinism, and of hair and lights that scatter nothing.

use hairis::HairParams;
use hairis::params::HairDesc;
use hairis_harness::efficiency::*;
use hairis_harness::lights::Lights;
use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_instruments::light::{Constant, Environment, Light, Sky, Sun};
use hairis_instruments::sequence::{Independent, SequenceKind, XiSource};
use hairis_instruments::stats::{Estimate, Moments};
use std::sync::{Mutex, OnceLock};

/// Budget that covers every table and is small enough to be computed in seconds.
const SMALL: Budget = Budget {
    independent: 20_000,
    correlated: 16,
    randomisations: 64,
    mis: 4_096,
    sweep: 4_096,
    convergence: 16,
    convergence_n: 64,
    quadrature_texels: 128,
    reference_passes: 4,
};

fn small_map() -> Environment {
    let mut xi = Independent::new(5, 0);
    let pixels = (0..128).map(|_| xi.next_xi_f32::<3>()).collect();
    Environment::from_pixels("small", 16, 8, pixels).expect("valid")
}

/// A part of that budget.
const fn part(of: usize) -> Budget {
    Budget {
        independent: SMALL.independent / of,
        randomisations: SMALL.randomisations / of,
        mis: SMALL.mis / of,
        sweep: SMALL.sweep / of,
        ..SMALL
    }
}

/// Settings for tests that no statistic decides.
fn least(map: &Environment) -> EfficiencyConfig<'_> {
    EfficiencyConfig {
        budget: Budget {
            convergence_n: SMALL.convergence_n / 4,
            quadrature_texels: 32,
            reference_passes: 2,
            ..part(32)
        },
        ..small(map)
    }
}

fn small(map: &Environment) -> EfficiencyConfig<'_> {
    EfficiencyConfig {
        budget: SMALL,
        ..EfficiencyConfig::new(11, true, map)
    }
}

fn cases() -> impl Iterator<Item = (Case, Sampler)> {
    ModelKind::ALL.into_iter().flat_map(|model| {
        SAMPLERS.into_iter().flat_map(move |sampler| {
            THETA_O_DEG.map(|theta_o| (Case::new(model, &HairParams::bright(), theta_o), sampler))
        })
    })
}

fn independent(
    case: &Case,
    technique: Technique,
    light: &dyn Light,
    at: [u64; 2],
    n: usize,
) -> CellMoments {
    moments(
        case,
        technique,
        light,
        at,
        SequenceKind::Independent,
        [1, n],
    )
}

#[test]
fn the_recorded_figures_are_of_the_mean_of_rgb() {
    let mut far_from_luminance = 0;
    for (case, sampler) in cases() {
        let exact = exact_variance(&case, sampler);
        assert!(
            exact.converged,
            "{:?} {sampler:?} {}",
            case.model, case.theta_o_deg
        );
        if let Some(recorded) = recorded_v(case.model, sampler, case.theta_o_deg) {
            // Measured: 5.4e-4 at most, published on the Cauchy model at 75 degrees, 0.23146 for the table's 0.232.
            assert!(
                (exact.v[0] - recorded).abs() < 6e-4,
                "{:?} {sampler:?} {}: {exact:?}, recorded {recorded}",
                case.model,
                case.theta_o_deg
            );
            far_from_luminance += usize::from((exact.v[1] - recorded).abs() > 1.5e-3);
        }
    }
    assert!(
        far_from_luminance >= 10,
        "only {far_from_luminance} of 12 tell luminance from the mean of RGB"
    );
}

#[test]
fn measured_variance_is_that_of_quadrature_and_of_the_table() {
    for (k, (case, sampler)) in cases().enumerate() {
        let tally = independent(
            &case,
            Technique::Bsdf(sampler),
            &Constant,
            [21, k as u64],
            400_000,
        );
        let v = tally.moments.relative_variance();
        let exact = exact_variance(&case, sampler).v[0];
        // 36 comparisons: a bound of 3.5 standard errors gives 1.7% of false alarms over all of them.
        assert!(
            v.z_score(exact).abs() < 3.5,
            "{:?} {sampler:?} {}: {v:?}, quadrature {exact}",
            case.model,
            case.theta_o_deg
        );
        if let Some(recorded) = recorded_v(case.model, sampler, case.theta_o_deg) {
            assert!(
                v.z_score(recorded).abs() < 3.5,
                "{v:?}, recorded {recorded}"
            );
        }
    }
}

#[test]
fn every_estimator_agrees_with_quadrature() {
    let lights = Lights::default().all();
    let theta_o = [45.0, 75.0];
    let mut worst = 0.0_f64;
    for (k, light) in lights.into_iter().enumerate() {
        for (model, theta_o) in ModelKind::ALL.into_iter().zip(theta_o) {
            let case = Case::new(model, &HairParams::bright(), theta_o);
            let reference = by_quadrature(&case, light);
            for (t, technique) in Technique::all().enumerate() {
                // 1e6 samples hit the sun about 480 times.
                let n = if light.name() == Sun::NAME {
                    1_000_000
                } else {
                    hairis_conformance::cases(200_000)
                };
                let tally = independent(&case, technique, light, [31, (16 * k + t) as u64], n);
                let z = bias_z(&tally.moments, reference.estimate());
                worst = worst.max(z.abs());
                assert!(
                    z.abs() < 4.0,
                    "{} {model:?} {}: z {z}",
                    light.name(),
                    technique.name()
                );
                if let Technique::Bsdf(sampler) = technique {
                    // The second moment is compared with quadrature too, unless hits are rare.
                    let v = tally.moments.relative_variance();
                    let exact = reference.predicted(sampler)[0];
                    assert!(
                        v.z_score(exact).abs() < 4.5,
                        "{} {}: {v:?}, {exact}",
                        light.name(),
                        technique.name()
                    );
                }
            }
        }
    }
    assert!(
        worst > 0.5,
        "fifty-six z-scores below {worst} are no errors at all"
    );
}

#[test]
fn the_sun_is_for_light_sampling_and_the_rest_for_both() {
    let case = Case::new(ModelKind::Gaussian, &HairParams::bright(), 45.0);
    let mut lights = Lights::default().all().into_iter();
    let sun = lights
        .find(|light| light.name() == Sun::NAME)
        .expect("listed");
    let v = |technique: Technique| {
        let tally = independent(&case, technique, sun, [41, 0], 100_000);
        tally.moments.relative_variance().value * technique.samples_each() as f64
    };
    assert!(
        v(Technique::Light) < 0.1,
        "the lobes are wider than the sun"
    );
    assert!(v(Technique::Bsdf(Sampler::Uniform)) > 1_000.0);
    assert!(v(Technique::Bsdf(Sampler::Published)) > 100.0);
    assert!(v(Technique::Mis(Sampler::Published)) < 3.0);
}

/// Returns the small run and its calls of the progress report, computed once, on two threads.
fn small_run() -> &'static (EfficiencyResult, Vec<(usize, usize)>) {
    static RUN: OnceLock<(EfficiencyResult, Vec<(usize, usize)>)> = OnceLock::new();
    RUN.get_or_init(|| {
        let calls = Mutex::new(Vec::new());
        let report = |done, total| calls.lock().expect("no panic").push((done, total));
        let result = on_threads(2, || run(&small(&small_map()), &report)).expect("valid");
        (result, calls.into_inner().expect("no panic"))
    })
}

fn on_threads<R: Send>(threads: usize, f: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads")
        .install(f)
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let json = [1, 2].map(|threads| {
        let result = on_threads(threads, || run(&least(&small_map()), &|_, _| ()));
        serde_json::to_string(&result.expect("valid")).expect("serialises")
    });
    assert!(
        json[0] == json[1],
        "one thread and two gave different tables"
    );
}

#[test]
fn a_small_run_has_every_row_and_passes_its_check() {
    let (result, calls) = small_run();
    assert_eq!(result.reference_v.len(), 24);
    assert_eq!(result.rows.len(), 360);
    assert_eq!(result.mis_rows.len(), 168);
    assert_eq!(result.convergence.len(), 270);
    assert_eq!(result.beta_sweep.len(), 144);
    let mut calls = calls.clone();
    calls.sort_unstable();
    assert!(
        calls
            .iter()
            .enumerate()
            .all(|(i, call)| *call == (i + 1, calls.len())),
        "progress skips"
    );
    let check = &result.check;
    assert!(check.passed(), "{check:#?}");
    // The sun is too rarely hit at these sizes to be tested by the scattering function alone.
    let sun = |r: &&EfficiencyRow| r.light == "sun";
    assert!(
        result.rows.iter().filter(sun).all(|r| !r.tested),
        "{check:?}"
    );
    assert!(
        result
            .rows
            .iter()
            .filter(|r| r.light == "constant")
            .all(|r| r.tested),
        "{check:?}"
    );
    assert!(
        check.tests > 675 && check.untested >= 72,
        "{} {}",
        check.tests,
        check.untested
    );
    assert!((4.0..6.0).contains(&check.bound), "{}", check.bound);
}

#[test]
fn efficiency_is_one_over_variance_and_time() {
    let costs = SampleCosts {
        gaussian: [4.0, 8.0, 16.0],
        cauchy: [3.0, 6.0, 12.0],
    };
    let v = Estimate {
        value: 0.2,
        standard_error: 0.01,
    };
    let e = costs.efficiency(&v, ModelKind::Cauchy, Sampler::Published);
    assert!(
        (e.value * 0.2 * 6e-9 - 1.0).abs() < 1e-12
            && (e.standard_error / e.value - 0.05).abs() < 1e-12,
        "{e:?}"
    );
}

#[test]
fn a_wrong_mean_fails_the_check() {
    let mut result = small_run().0.clone();
    // As if the sampler's weights were too large by 5%.
    let row = result
        .rows
        .iter_mut()
        .find(|r| r.sampler == Sampler::Published && r.light == "constant")
        .expect("a row");
    row.z = 0.05 * row.mean.value / row.mean.standard_error;
    assert_eq!(check(&result).failures.len(), 1, "{:?}", check(&result));
    result.rows[1].z = f64::NAN;
    let found = check(&result);
    assert!(
        found.failures.len() == 2 && found.largest_z.is_infinite(),
        "{found:?}"
    );
}

#[test]
fn maps_of_few_texels_raise_no_alarm() {
    // Four nodes do not resolve a lobe inside a texel of 45 degrees and more, so the quadrature must not count as exact.
    let gradient = |width: u16, height: u16| {
        let pixels = (0..width * height)
            .map(|k| [1.0, 0.5 + f32::from(k), 2.0])
            .collect();
        Environment::from_pixels("few", usize::from(width), usize::from(height), pixels)
            .expect("valid")
    };
    for map in [
        Environment::from_pixels("one", 1, 1, vec![[1.0; 3]]).expect("valid"),
        gradient(2, 1),
        gradient(8, 4),
    ] {
        let result = run(&small(&map), &|_, _| ()).expect("valid hair");
        assert!(
            result.check.passed(),
            "{:?}: {:?}",
            map.size(),
            result.check.failures
        );
    }
    // The one texel is a constant light, whose integral is known.
    let one = Environment::from_pixels("one", 1, 1, vec![[1.0; 3]]).expect("valid");
    let case = Case::new(ModelKind::Gaussian, &HairParams::bright(), 45.0);
    let [got, exact] = [
        of_environment(&case, &one, 128, 16, 1),
        by_quadrature(&case, &Constant),
    ];
    assert_eq!(got.method, ReferenceMethod::StratifiedRun);
    assert!(
        (got.value - exact.value).abs() < 5.0 * got.standard_error,
        "{got:?}, {exact:?}"
    );
}

#[test]
fn black_hair_and_black_maps_are_no_failures() {
    let black = HairDesc {
        i_r: [0.0; 3],
        i_tt: [0.0; 3],
        i_trt: [0.0; 3],
        ..*HairParams::bright().desc()
    };
    let map = Environment::from_pixels("black", 4, 2, vec![[0.0; 3]; 8]).expect("valid");
    let params = HairParams::new(&black).expect("black is legal");
    let result = run(
        &EfficiencyConfig {
            params,
            ..least(&map)
        },
        &|_, _| (),
    )
    .expect("valid");
    assert!(
        result
            .rows
            .iter()
            .all(|r| r.mean.value == 0.0 && r.z == 0.0),
        "black hair scatters"
    );
    assert!(
        result
            .mis_rows
            .iter()
            .all(|r| r.mean.value == 0.0 && r.z == 0.0),
        "black hair scatters"
    );
    assert!(result.check.passed(), "{:#?}", result.check);
    serde_json::to_string(&result).expect("serialises");
    let case = Case::new(ModelKind::Gaussian, &HairParams::bright(), 45.0);
    let reference = of_environment(&case, &map, 8, 1, 0);
    for technique in Technique::all() {
        let tally = independent(&case, technique, &map, [61, 0], 1_000);
        assert_eq!(
            bias_z(&tally.moments, reference.estimate()),
            0.0,
            "{}",
            technique.name()
        );
    }
}

#[test]
fn the_bias_score_is_normal_where_hits_are_rare() {
    // Poisson hits, 25 expected per run: a plain z exceeds 3 below the mean three times too often, this score does not.
    let reference = Estimate::exact(0.0025);
    let mut xi = Independent::new(51, 0);
    let mut plain = 0;
    let mut corrected = 0;
    for _ in 0..4_000 {
        let m: Moments = (0..10_000)
            .map(|_| f64::from(u8::from(xi.next_f64() < 0.0025)))
            .collect();
        plain += usize::from(m.mean_estimate().z_score(0.0025).abs() > 2.576);
        corrected += usize::from(bias_z(&m, reference).abs() > 2.576);
    }
    // 1% of 4000 are 40, give or take 6.3.
    assert!(
        (18..=65).contains(&corrected),
        "{corrected} of 4000 beyond 1%, a plain z has {plain}"
    );
}

#[test]
fn ten_hits_that_carry_a_fifth_of_the_mean_are_too_few() {
    // The value is 0.8, and once in 10^4 samples 2000 more: 10^5 samples are worth 249, and have ten hits.
    let (v, skewness) = (0.04 / 1e-4, 100.0);
    assert!(!is_tested(100_000, [v, skewness]), "ten hits are expected");
    assert!(is_tested(1_000_000, [v, skewness]), "a hundred are");
}

#[test]
#[ignore = "slow: 100 s of processor time in release"]
fn a_full_run_under_the_sky_passes_its_check() {
    let sky = Sky::default().environment();
    let result = run(&EfficiencyConfig::new(2, false, &sky), &|_, _| ()).expect("valid");
    assert!(result.check.passed(), "{:#?}", result.check);
    // Directions from the BSDF hit a sun off the highlights once in a thousand samples or less: V is up to 40,000, and two million samples
    // are worth 50. Those rows are predicted instead. Uniform directions test every light, and the others test those that are wider than a
    // sun.
    let independent: Vec<_> = result
        .rows
        .iter()
        .filter(|r| r.sequence == SequenceKind::Independent)
        .collect();
    let has_sun = |r: &EfficiencyRow| [Sun::NAME, Sky::NAME].contains(&&*r.light);
    let untested: Vec<_> = independent.iter().filter(|r| !r.tested).collect();
    let wrong: Vec<_> = untested
        .iter()
        .filter(|r| r.sampler == Sampler::Uniform || !has_sun(r))
        .collect();
    assert!(
        wrong.is_empty(),
        "seen often enough by independent numbers, but for {wrong:#?}"
    );
    assert!(
        untested.len() * 5 <= independent.len(),
        "{} of {} rows are not tested",
        untested.len(),
        independent.len()
    );
}

#[test]
fn the_bound_is_that_of_the_normal_table() {
    for (p, z) in [
        (0.05, 1.959_963_984_540_054),
        (6.334_248_366_623_996e-5, 4.0),
        (1e-9, 6.109_410_204_869_03),
    ] {
        assert!((z_bound(p) - z).abs() < 1e-9, "{p}: {}", z_bound(p));
    }
}
