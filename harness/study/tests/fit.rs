//! Fits of models to each other.

mod objective;

use hairis_instruments::progress::Progress;
use hairis_instruments::record;
use hairis_study::fit::*;
use hairis_study::study::Grid;
use hairis_variants::Kind;
use hairis_variants::{ModelId, Values};

fn look(model: ModelId, preset: &str) -> Look {
    let (_, values) = model
        .presets()
        .find(|(name, _)| *name == preset)
        .expect("a preset");
    Look { model, values }
}

/// Returns the largest difference of two values: for angles in rad, for all others relative to the value or to a tenth.
fn apart(a: &Values, b: &Values) -> f64 {
    let mut most = 0.0_f64;
    for (index, field) in a.fields().iter().enumerate() {
        if matches!(field.kind, Kind::Word(_)) || !a.has_at(index) {
            continue;
        }
        for (a, b) in a.numbers_at(index).iter().zip(b.numbers_at(index)) {
            let (a, b) = (f64::from(*a), f64::from(*b));
            most = most.max((a - b).abs() / a.abs().max(0.1));
        }
    }
    most
}

#[test]
fn a_model_fitted_to_itself_returns_its_values_from_every_start() {
    for norm in [Norm::L1, Norm::L2] {
        let look = look(ModelId::Gaussian, "brown");
        let config = FitConfig {
            norm,
            starts: 21,
            directions: 256,
            ..FitConfig::default()
        };
        let found = fit(&look, ModelId::Gaussian, &config, &|_, _| ()).expect("legal values");
        // The first start is the answer.
        for end in &found.ends[1..] {
            let (start, error) = (
                apart(&look.values, &end.start),
                apart(&look.values, &end.values),
            );
            println!(
                "{norm:?}: from {start:.2} to {error:.1e} in {}",
                end.iterations
            );
            assert!(start > 0.05, "the start is elsewhere");
            assert!(error < 1e-3, "{norm:?}: {error:e}, {:?}", end.values);
        }
        assert!(found.distance < 1e-6, "{}", found.distance);
    }
}

#[test]
fn no_refit_is_further_away_than_its_start() {
    let pairs = [
        (ModelId::Gaussian, ModelId::Cauchy),
        (ModelId::Cauchy, ModelId::Gaussian),
        (ModelId::Gaussian, ModelId::Chiang),
        (ModelId::Chiang, ModelId::Gaussian),
        (ModelId::Gaussian, ModelId::KajiyaKay),
    ];
    for (from, to) in pairs {
        let (_, values) = from.presets().next().expect("a preset");
        let config = FitConfig {
            starts: 2,
            directions: 256,
            ..FitConfig::default()
        };
        let look = Look {
            model: from,
            values,
        };
        let found = fit(&look, to, &config, &|_, _| ()).expect("legal values");
        println!(
            "{from:?} to {to:?}: {} from {}",
            found.distance, found.distance_of_start
        );
        assert!(
            found.distance < 0.95 * found.distance_of_start,
            "{from:?} to {to:?}"
        );
        assert!(to.material(&found.found.values).is_ok(), "legal values");
    }
}

#[test]
fn fixed_fields_stay_and_equal_flags_give_equal_values() {
    let look = look(ModelId::Gaussian, "blond");
    let config = FitConfig {
        fixed: vec!["alpha".to_owned(), "phi_g".to_owned()],
        directions: 256,
        starts: 3,
        ..FitConfig::default()
    };
    let [one, two] =
        [(); 2].map(|()| fit(&look, ModelId::Cauchy, &config, &|_, _| ()).expect("legal values"));
    assert_eq!(one.found.values, two.found.values);
    for name in ["alpha", "phi_g"] {
        assert_eq!(
            one.found.values.numbers(name),
            look.values.numbers(name),
            "{name} is fixed"
        );
    }
    assert_ne!(
        one.found.values.numbers("beta"),
        look.values.numbers("beta")
    );
}

#[test]
fn weights_count_by_their_ratios() {
    let look = look(ModelId::Gaussian, "brown");
    for (to, norm) in [(ModelId::Cauchy, Norm::L1), (ModelId::KajiyaKay, Norm::L2)] {
        let fit_with = |weights: [f64; 2]| {
            let config = FitConfig {
                norm,
                views: vec![0.0, 0.2],
                weights: weights.to_vec(),
                starts: 1,
                directions: 128,
                ..FitConfig::default()
            };
            let found = fit(&look, to, &config, &|_, _| ()).expect("legal values");
            let rows = residuals(&look, &found.found, &found.points).expect("legal values");
            let numbers = |row: &Residual| [row.l1, row.l2, row.albedo_from, row.albedo_to];
            let mut numbers = rows.iter().flat_map(numbers);
            assert!(numbers.all(f64::is_finite), "{weights:?}: {rows:?}");
            found
        };
        let equal = fit_with([1.0, 1.0]);
        assert!(equal.distance < equal.distance_of_start, "it moves");
        for weight in [1e308, 1e-308] {
            let found = fit_with([weight, weight]);
            assert_eq!(found.found.values, equal.found.values, "{weight:e}");
            assert_eq!(found.distance, equal.distance, "{weight:e}");
        }
        fit_with([1e308, 1e-308]);
    }
}

#[test]
fn the_distance_is_that_of_another_quadrature() {
    let rows = crate::difference::QUICK.of(hairis_study::difference::Width::Paper);
    for row in rows.filter(|row| row.cell.theta_o_deg == 45.0) {
        let params = row.cell.params().expect("accepted");
        let values = hairis_variants::Parameters::values(&params);
        let look = Look {
            model: ModelId::Gaussian,
            values,
        };
        let config = FitConfig {
            views: vec![45.0_f64.to_radians()],
            weights: vec![1.0],
            directions: 8192,
            ..FitConfig::default()
        };
        let points = Points::new(&look, ModelId::Cauchy, &config, 1).expect("legal values");
        let other = Look {
            model: ModelId::Cauchy,
            values,
        };
        let found = &residuals(&look, &other, &points).expect("legal values")[0];
        println!(
            "{} {}: {:?}",
            found.l1_mean, row.figures.plain.l1, found.lobes
        );
        assert!(
            (found.l1_mean / row.figures.plain.l1 - 1.0).abs() < 0.02,
            "{} where {} is right",
            found.l1_mean,
            row.figures.plain.l1
        );
        assert!(
            (found.albedo_from / row.figures.albedo_gaussian - 1.0).abs() < 0.01,
            "albedo"
        );
        let blurred = FitConfig {
            norm: Norm::Blurred,
            ..config
        };
        let points = Points::new(&look, ModelId::Cauchy, &blurred, 1).expect("legal values");
        let distance = points.distance(ModelId::Cauchy, &values, Norm::Blurred);
        let (distance, want) = (distance.expect("legal values"), row.figures.blurred.l1);
        println!("blurred {distance} {want}");
        // The fit compares channels, and the difference compares their mean.
        assert!((distance / want - 1.0).abs() < 0.05, "{distance} {want}");
        let sum: f64 = found.lobes.iter().sum();
        assert!((sum / found.l1 - 1.0).abs() < 1e-6, "lobes have all of it");
    }
}

/// Record of refits.
const RECORD: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../../benches/records/refits.csv"
);

/// Models that are refitted, each with the one that is fitted to it.
const PAIRS: [(ModelId, ModelId); 4] = [
    (ModelId::Gaussian, ModelId::Cauchy),
    (ModelId::Cauchy, ModelId::Gaussian),
    (ModelId::Gaussian, ModelId::Chiang),
    (ModelId::Chiang, ModelId::Gaussian),
];

/// Refits a model to at most `most` looks of another, and returns the lines of the record: from its presets and, between models of the
/// same fields, from the hair of the study's short grid, all from its inclinations.
fn refit_lines((model, to): (ModelId, ModelId), most: usize) -> Vec<String> {
    let mut looks: Vec<(String, Look)> = (model.presets())
        .map(|(name, values)| (name.to_owned(), Look { model, values }))
        .collect();
    let config = if model.fields() == to.fields() {
        looks.extend(hair_of(Grid::QUICK, model).expect("accepted"));
        FitConfig::of_grid(&Grid::QUICK)
    } else {
        FitConfig {
            starts: 2,
            directions: 512,
            ..FitConfig::default()
        }
    };
    looks.truncate(most);
    let progress = Progress::new(looks.len(), &|_, _| ());
    let found = refits(&looks, to, &config, &progress).expect("legal values");
    println!(
        "{}",
        table(&format!("{model:?} to {to:?}"), &found).to_text(None)
    );
    let line = |refit: &Refit| {
        for (rule, distance) in RULES.iter().zip(&refit.distances_of_rules) {
            assert!(refit.distance <= *distance, "{}: {rule}", refit.name);
        }
        let of_rule = |place| {
            let of = refit.distances_of_rules.get(place);
            of.map_or_else(String::new, |distance| format!("{distance:.5}"))
        };
        let rules = [0, 1, 2, 3].map(of_rule).join(",");
        let (from, to, name) = (model.name(), to.name(), &refit.name);
        let Refit {
            distance, error, ..
        } = refit;
        format!("{from},{to},{name},{rules},{distance:.5},{error:.5}")
    };
    found.iter().map(line).collect()
}

/// Checks a line against that of the record.
fn assert_recorded(now: &str, recorded: &str) {
    let fields = |line: &str| line.split(',').count();
    assert_eq!(
        fields(now),
        fields(recorded),
        "{now} where the record has {recorded}"
    );
    for (now, recorded) in now.split(',').zip(recorded.split(',')) {
        let is_same = match (now.parse::<f64>(), recorded.parse::<f64>()) {
            // As near as levels and libraries agree.
            (Ok(now), Ok(recorded)) => (now - recorded).abs() <= 1e-3 + 0.01 * recorded,
            _ => now == recorded,
        };
        assert!(
            is_same,
            "{now} where the record has {recorded}: HAIRIS_RECORD=write cargo test -p hairis-study refits -- --ignored"
        );
    }
}

/// First two looks of a pair of models with the same fields, and of one with others. All are in `all_refits_are_those_recorded`.
#[test]
fn refits_are_those_recorded() {
    let recorded = std::fs::read_to_string(RECORD).expect("the record is here");
    for pair in [PAIRS[0], PAIRS[2]] {
        for line in refit_lines(pair, 2) {
            let fields: Vec<&str> = line.splitn(4, ',').collect();
            let key = fields[..3].join(",") + ",";
            let mut lines = recorded.lines();
            let of_record = lines.find(|line| line.starts_with(&key));
            assert_recorded(&line, of_record.expect("the look is in the record"));
        }
    }
}

/// Every refit. With `HAIRIS_RECORD=write` in the environment, writes the record.
#[test]
#[ignore = "slow: 20 s of processor time"]
fn all_refits_are_those_recorded() {
    let head = [
        "# CPU: any",
        "# L1 distance of S cos theta_i per channel, of all views, at the rules without a fit and fitted",
        "from,to,look,equal,half_width,area,best_factor,fitted,error",
    ];
    let mut lines: Vec<String> = head.map(str::to_owned).into();
    for pair in PAIRS {
        lines.extend(refit_lines(pair, usize::MAX));
    }
    if record::is_asked() {
        std::fs::write(RECORD, lines.join("\n") + "\n").expect("the folder is ours");
    }
    let recorded = std::fs::read_to_string(RECORD).expect("the record is here");
    assert_eq!(lines.len(), recorded.lines().count());
    for (now, recorded) in lines.iter().zip(recorded.lines()) {
        assert_recorded(now, recorded);
    }
}
