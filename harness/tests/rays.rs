//! Rays against references and closed forms, of determinism, and of times and prices.

use hairis_conformance::cases;
use hairis_harness::efficiency::{self, Budget, EfficiencyConfig, EfficiencyResult, THETA_O_DEG};
use hairis_harness::rays::*;
use hairis_instruments::light::{Environment, Light, Sky};
use hairis_instruments::sequence::{Independent, XiSource};
use hairis_instruments::stats::Estimate;
use std::sync::OnceLock;

const SMALL: Budget = Budget {
    independent: 2_000,
    correlated: 16,
    randomisations: 64,
    mis: 1_024,
    sweep: 1_024,
    convergence: 16,
    convergence_n: 16,
    quadrature_texels: 128,
    reference_passes: 64,
};

fn small_map() -> Environment {
    let mut xi = Independent::new(5, 0);
    let pixels = (0..128).map(|_| xi.next_xi_f32()).collect();
    Environment::from_pixels("small", 16, 8, pixels).expect("valid")
}

/// Returns the sky with the references under it.
fn sky() -> &'static (Environment, EfficiencyResult) {
    static SKY: OnceLock<(Environment, EfficiencyResult)> = OnceLock::new();
    SKY.get_or_init(|| {
        let sky = Sky::default().environment();
        let config = EfficiencyConfig {
            budget: SMALL,
            ..EfficiencyConfig::new(3, true, &sky)
        };
        let result = efficiency::run(&config, &|_, _| ()).expect("valid");
        (sky, result)
    })
}

fn rows_of(
    config: &RaysConfig<'_>,
    subjects: &[RaySubject],
    references: &EfficiencyResult,
) -> Vec<RayRow> {
    rows(
        config,
        subjects,
        &config.lights.all(),
        references,
        &|_, _| (),
    )
}

fn config<'a>(environment: &'a Environment, pools: usize) -> RaysConfig<'a> {
    RaysConfig {
        pools,
        passes: 16,
        rounds: 3,
        ..RaysConfig::new(3, true, environment)
    }
}

#[test]
fn a_ray_of_4_and_4_candidates_is_worth_8_of_mis_and_of_8_and_8_15() {
    let (map, references) = sky();
    let subjects: Vec<RaySubject> = RaySubject::all()
        .filter(|subject| subject.sampler() != "uniform")
        .collect();
    let rows = rows_of(&config(map, 512), &subjects, references);
    let under_sky: Vec<&RayRow> = rows.iter().filter(|row| row.light == map.name()).collect();
    assert_eq!(under_sky.len(), subjects.len());
    let of_all = |pick: &dyn Fn(&RayFigures) -> Estimate| {
        Estimate::geometric_mean(
            &under_sky
                .iter()
                .map(|row| pick(&row.mean))
                .collect::<Vec<_>>(),
        )
    };
    let mis = of_all(&|figures| figures.mis.unoccluded);
    for (size, least) in [(1, 8.0), (2, 15.0)] {
        let gain = mis.ratio(&of_all(&|figures| figures.chosen[size].unoccluded));
        assert!(
            gain.value > least,
            "{} + {}: {gain:?}",
            SIZES[size],
            SIZES[size]
        );
        for row in &under_sky {
            // The balance heuristic over n + n candidates has at most 1/(2n) of the variance of one of its samples.
            let gain = row
                .mean
                .mis
                .unoccluded
                .ratio(&row.mean.chosen[size].unoccluded);
            let bound = 2.0 * f64::from(SIZES[size]);
            assert!(
                gain.value > bound - 4.0 * gain.standard_error,
                "{} {}: {gain:?}",
                row.model,
                row.sampler
            );
        }
    }
    let check = check(&rows);
    assert!(check.passed(), "{check:#?}");
    assert!(
        check.tests > 20 * check.untested,
        "{} {}",
        check.tests,
        check.untested
    );
}

#[test]
fn one_ray_obeys_the_law_of_visibility() {
    let (map, references) = sky();
    let subjects: Vec<RaySubject> = RaySubject::all()
        .filter(|subject| subject.sampler() == "matched")
        .collect();
    let mut scores = Vec::new();
    for row in rows_of(&config(map, cases(1024)), &subjects, references) {
        for pose in &row.poses {
            for (size, pool) in pose
                .figures
                .half
                .iter()
                .filter(|pool| pool.rays == 1)
                .enumerate()
            {
                let law = occluded(pose.figures.chosen[size].unoccluded, HALF);
                scores.push(pool.v.z_score(law.value));
                assert!(pool.traced > 0.9 && pool.traced <= 1.0, "{pool:?}");
            }
        }
    }
    // The law's own error is of the same candidates, and below that of the measurement.
    assert!(
        scores.len() == 100 * subjects.len() && scores.iter().all(|z| z.abs() < 4.5),
        "{scores:?}"
    );
    assert!(scores.iter().any(|z| z.abs() > 0.5), "no errors at all");
}

#[test]
fn plain_estimators_have_the_variances_of_their_references() {
    // Under the sun the BSDF's samples hit once in thousands, but the error of its V is small all the same.
    let (map, references) = sky();
    let subjects: Vec<RaySubject> = RaySubject::all()
        .filter(|subject| subject.sampler() == "published")
        // Of models with a diffuse part there are no references.
        .filter(|subject| !subject.model().ends_with("-diffuse"))
        .collect();
    for row in rows_of(&config(map, 512), &subjects, references)
        .iter()
        .filter(|row| row.light == "sun")
    {
        for pose in &row.poses {
            let found = |r: &&efficiency::EfficiencyRow| {
                r.model.name() == row.model
                    && r.light == row.light
                    && r.theta_o_deg == pose.theta_o_deg
            };
            let exact = references
                .rows
                .iter()
                .find(found)
                .expect("a row")
                .reference
                .v[1];
            let v = pose.figures.bsdf.unoccluded;
            assert!(
                v.z_score(exact).abs() < 4.5 && v.standard_error < 0.05 * exact,
                "{v:?}, exact {exact}"
            );
        }
    }
}

#[test]
fn rows_depend_on_the_seed_alone_and_black_maps_are_no_failures() {
    let map = small_map();
    let budget = Budget {
        reference_passes: SMALL.reference_passes / 4,
        ..SMALL
    };
    let references = efficiency::run(
        &EfficiencyConfig {
            budget,
            ..EfficiencyConfig::new(3, true, &map)
        },
        &|_, _| (),
    );
    let references = references.expect("valid");
    let subjects: Vec<RaySubject> = RaySubject::all().collect();
    assert_eq!(
        subjects.len(),
        hairis_variants::ModelId::ALL.len() + 2,
        "both bells have uniform directions"
    );
    let on = |threads: usize, seed: u64| {
        let config = RaysConfig {
            seed,
            passes: 4,
            ..config(&map, 16)
        };
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        serde_json::to_string(&pool.install(|| rows_of(&config, &subjects, &references)))
            .expect("serialises")
    };
    let rows = on(2, 3);
    assert!(on(1, 3) == rows, "one thread and two gave different rows");
    assert!(rows != on(2, 4), "seeds do not matter");

    let black = Environment::from_pixels("black", 4, 2, vec![[0.0; 3]; 8]).expect("valid");
    let pose = pose(
        Lit {
            scatter: &subjects[0].scatter(0),
            light: &black,
        },
        0.0,
        Estimate::exact(0.0),
        [1, 1],
        16,
    );
    assert!(pose.z.iter().all(|score| score.z == 0.0), "{:?}", pose.z);
}

#[test]
fn a_wrong_mean_fails_the_check() {
    let (map, references) = sky();
    let subjects: Vec<RaySubject> = RaySubject::all()
        .filter(|subject| subject.model() == "kajiya-kay")
        .collect();
    let mut all = rows_of(&config(map, 512), &subjects, references);
    assert!(check(&all).passed(), "{:#?}", check(&all));
    all[0].poses[0].z[3].z = f64::NAN;
    assert_eq!(check(&all).failures.len(), 1);
    // A reference that is 5% off.
    let light = Sky::default().environment();
    let lit = Lit {
        scatter: &subjects[0].scatter(1),
        light: &light,
    };
    let pose_of = |value: f64| pose(lit, 45.0, Estimate::exact(value), [1, 1], 1024);
    let right = all
        .iter()
        .find(|row| row.light == map.name())
        .expect("the sky")
        .poses[1]
        .reference
        .value;
    let worst = |value| {
        pose_of(value)
            .z
            .iter()
            .filter(|score| score.tested)
            .map(|s| s.z.abs())
            .fold(0.0, f64::max)
    };
    assert!(
        worst(right) < 5.0 && worst(1.05 * right) > 6.0,
        "{} {}",
        worst(right),
        worst(1.05 * right)
    );
}

#[test]
fn times_prices_and_fronts_fit_together() {
    let row = RayRow {
        model: "gaussian",
        sampler: "published",
        light: "small".to_owned(),
        mean: figures(1.4, 0.2),
        poses: Vec::new(),
    };
    let times = RayTimes {
        model: "gaussian",
        sampler: "published",
        light: "small".to_owned(),
        mis_ns: 10.0,
        mis_ns_error: 0.0,
        pool_ns: SIZES.map(|count| [20.0 * f64::from(count), 25.0 * f64::from(count)]),
        pool_ns_error: [0.0; SIZES.len()],
    };
    let equal = EqualTime::new(&row, &times);
    let point = equal.pool(8, 1).expect("a pool");
    // MIS: V 3.8, 10 ns and a ray; the pool: V 1.4, 160 ns and a ray. Equal at 3.8 (10 + p) = 1.4 (160 + p).
    let expected = (1.4 * 160.0 - 3.8 * 10.0) / (3.8 - 1.4) * 1e-3;
    let price = point.break_even_us.expect("it gains");
    assert!((price - expected).abs() < 1e-12, "{price} {expected}");
    assert!((point.gain_over(&equal.mis[0], price) - 1.0).abs() < 1e-12);
    assert!(
        point.gain[0] > 1.0 && point.gain[3] > point.gain[0],
        "{point:?}"
    );
    assert_eq!(times.pool_ns(8, 16), 200.0, "as measured");
    for (place, price) in PRICES_US.into_iter().enumerate() {
        let all = || equal.mis.iter().chain(&equal.pools);
        let fastest = all().min_by(|a, b| a.time_ns(price).total_cmp(&b.time_ns(price)));
        assert!(
            fastest.expect("points").on_front[place],
            "the fastest is on the front"
        );
        assert!(all().any(|point| !point.on_front[place]), "not all are");
    }
    assert_eq!(
        equal
            .best(3.0)
            .map(|point| point.gain_over(&equal.mis[0], 3.0) > 2.0),
        Some(true)
    );
}

/// Returns figures in which plain estimators have `mis` as V, and pools have `chosen` over one ray.
fn figures(mis: f64, chosen: f64) -> RayFigures {
    let one = |v| OneRay::new(Estimate::exact(v));
    let half = pools().map(|(size, rays)| PoolFigures {
        candidates_each: SIZES[size],
        rays: RAYS[rays],
        traced: f64::from(RAYS[rays]),
        v: occluded(Estimate::exact(chosen), HALF).scale(1.0 / f64::from(RAYS[rays])),
    });
    RayFigures {
        bsdf: one(9.0),
        light: one(1.6),
        mis: one(mis),
        chosen: SIZES.map(|_| one(chosen)).to_vec(),
        half: half.collect(),
    }
}

#[test]
fn every_estimator_is_timed() {
    let map = small_map();
    let subjects: Vec<RaySubject> = RaySubject::all().take(2).collect();
    let mut calls = 0;
    let times = measure_times(&subjects, &[&map as &dyn Light], 1, 3, |_| calls += 1);
    assert_eq!((times.len(), calls), (2, 2));
    for time in &times {
        assert!(
            time.mis_ns > 0.0 && time.candidate_ns() > 0.0 && time.pool_ns(2, 1) > 0.0,
            "{time:?}"
        );
        assert!(time.pool_ns(32, 1) > time.pool_ns(4, 1), "{time:?}");
        assert!(time.pool_ns(3, 1).is_nan(), "no such pool");
        assert_eq!(time.shared_candidate_ns(), time.pool_ns(32, 16) / 64.0);
        assert!(
            time.mis_ns_error >= 0.0 && time.pool_ns_error.iter().all(|error| *error >= 0.0),
            "{time:?}"
        );
    }
    assert_eq!(THETA_O_DEG.len(), 4);
}
