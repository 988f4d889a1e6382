//! Files of a finished study, with their rows, columns and figures.

use super::{shared_folder, sized};
#[cfg(feature = "parquet")]
use parquet::file::reader::{FileReader, SerializedFileReader};
#[cfg(feature = "parquet")]
use parquet::record::Field;
use serde_json::Value;
use std::collections::HashMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Number of cells of the short run.
const CELLS: usize = 48;
/// Number of samplers that can be run.
const SAMPLERS: usize = hairis_harness::sampler::Sampler::ALL.len();
/// Number of rows of a cell: two models, each sampler and perfect sampling, five lights.
const ROWS_OF_A_CELL: usize = 2 * (SAMPLERS + 1) * 5;

/// Returns the folder of a finished short run, made once.
fn reference() -> &'static Path {
    static DIR: OnceLock<(File, PathBuf)> = OnceLock::new();
    let (_, dir) = DIR.get_or_init(|| {
        let (lock, dir) = shared_folder("study-quick");
        let run = sized("--quick", &dir, "2", &[]);
        assert_eq!(run.code, Some(0), "{:?}", run.err);
        (lock, dir)
    });
    dir
}

fn csv(name: &str) -> Vec<Vec<String>> {
    let text = fs::read_to_string(reference().join(name)).unwrap();
    text.lines()
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect()
}

#[test]
fn the_rows_are_all_there() {
    let rows = csv("study.csv");
    assert_eq!(rows.len(), 1 + CELLS * ROWS_OF_A_CELL);
    assert!(
        rows.iter().all(|row| row.len() == rows[0].len()),
        "as many fields as names"
    );
    let column = |name: &str| rows[0].iter().position(|of| of == name).unwrap();
    for row in &rows[1..] {
        // No figure is missing or negative, standard errors included; the largest contribution is at least the mean.
        for name in [
            "v",
            "v_se",
            "kl",
            "kl_se",
            "mean",
            "mean_se",
            "max_weight",
            "ess_per_1000",
        ] {
            let value: f64 = row[column(name)].parse().unwrap();
            assert!(value.is_finite() && value >= 0.0, "{name} of {row:?}");
        }
        let [v, percent, ess, contribution] = [
            "v",
            "samples_for_1_percent",
            "ess_per_1000",
            "max_contribution",
        ]
        .map(|name| row[column(name)].parse::<f64>().unwrap());
        assert!(
            (percent - 1e4 * v).abs() <= 1e-12 * percent
                && (ess * (1.0 + v) / 1e3 - 1.0).abs() < 1e-12,
            "{row:?}"
        );
        let is_even = row[column("sampler")] == "perfect" && row[column("light")] == "constant";
        assert!(
            if is_even {
                contribution == 1.0 && v == 0.0
            } else {
                contribution > 1.0 && v > 0.0
            },
            "{row:?}"
        );
        let bounded = !row[column("weight_bound")].is_empty();
        assert!(bounded || row[column("sampler")] != "uniform", "{row:?}");
        assert!(!bounded || row[column("sampler")] != "perfect", "{row:?}");
    }
}

/// Returns the rows of a file, each as its values by name.
fn named(name: &str) -> Vec<HashMap<String, String>> {
    let rows = csv(name);
    rows[1..]
        .iter()
        .map(|row| rows[0].iter().cloned().zip(row.iter().cloned()).collect())
        .collect()
}

#[test]
fn rays_have_their_variances_and_gains() {
    let (rows, efficiencies) = (named("study.csv"), named("efficiency.csv"));
    let is_of_rays = |name: &String| {
        ["v_mis", "v_4_4", "v_8_8", "gain_4_4", "gain_8_8"]
            .iter()
            .any(|s| name.starts_with(s))
    };
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    let mut ratios = Vec::new();
    for (row, times) in rows.iter().zip(&efficiencies) {
        if row["sampler"] == "perfect" {
            let all = || row.iter().chain(times).filter(|(name, _)| is_of_rays(name));
            assert!(
                all().count() == 15 + 16 && all().all(|(_, value)| value.is_empty()),
                "{row:?}"
            );
            continue;
        }
        let number = |name: &str| {
            row.get(name)
                .or(times.get(name))
                .unwrap()
                .parse::<f64>()
                .unwrap()
        };
        let v = ["mis", "4_4", "8_8"].map(|by| number(&format!("v_{by}")));
        // The balance heuristic over n + n candidates has at most 1/(2n) of the variance of one of its samples.
        for (by, bound) in [("4_4", 8.0), ("8_8", 16.0)] {
            let [(a, da), (b, db)] =
                ["mis", by].map(|by| (number(&format!("v_{by}")), number(&format!("v_{by}_se"))));
            assert!(
                a / b * (1.0 + 4.5 * (da / a).hypot(db / b)) > bound,
                "{by}: {row:?}"
            );
        }
        ratios.push(v[1] / v[2]);
        for (by, v) in ["mis", "4_4", "8_8"].into_iter().zip(v) {
            for share in [0.25, 0.5, 0.75] {
                let visible = number(&format!("v_{by}_visible_{:.0}", 100.0 * share));
                assert!(
                    near(visible + 1.0, (v + 1.0) / share),
                    "{by} {share}: {row:?}"
                );
            }
        }
        for by in ["4_4", "8_8"] {
            for price in [0.1, 0.3, 1.0, 3.0] {
                let cost = |by| {
                    number(&format!("v_{by}_visible_50"))
                        * (number(&format!("ray_ns_{by}")) + 1e3 * price)
                };
                assert!(
                    near(
                        number(&format!("gain_{by}_at_{price}_us")),
                        cost("mis") / cost(by)
                    ),
                    "{by} {price}: {row:?}"
                );
            }
        }
    }
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    assert!(
        (mean - 2.0).abs() < 0.05,
        "twice the candidates, half the variance: {mean}"
    );
}

#[test]
fn efficiencies_follow_from_variances_and_times() {
    let rows = named("efficiency.csv");
    assert_eq!(rows.len(), CELLS * ROWS_OF_A_CELL);
    let number = |row: &HashMap<String, String>, name: &str| row[name].parse::<f64>().unwrap();
    let key =
        |row: &HashMap<String, String>| ["cell", "model", "light"].map(|name| row[name].clone());
    let published: HashMap<_, _> = rows
        .iter()
        .filter(|row| row["sampler"] == "published")
        .map(|row| (key(row), row))
        .collect();
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    for row in &rows {
        let published = published[&key(row)];
        let v = |row| number(row, "v");
        if row["sampler"] == "perfect" {
            assert!(
                row.keys()
                    .filter(|name| name.contains("_at_"))
                    .all(|name| row[name].is_empty()),
                "{row:?}"
            );
            let limit = row["break_even"].parse().ok();
            assert!(
                limit.map_or(row["light"] == "constant", |limit| near(
                    limit,
                    v(published) / v(row)
                )),
                "{row:?}"
            );
            continue;
        }
        assert!(
            near(number(row, "break_even"), v(published) / v(row)),
            "{row:?}"
        );
        for n in [1, 4, 16] {
            let ns = |row| number(row, &format!("ns_at_{n}"));
            let look_up = |row| ns(row) + number(row, "look_up_ns");
            let gain = |name: &str| number(row, &format!("{name}_at_{n}"));
            assert!(
                near(gain("efficiency"), 1e9 / (v(row) * ns(row))),
                "{n}: {row:?}"
            );
            assert!(
                near(gain("look_up_efficiency"), 1e9 / (v(row) * look_up(row))),
                "{n}: {row:?}"
            );
            assert!(
                near(
                    gain("gain"),
                    v(published) * ns(published) / (v(row) * ns(row))
                ),
                "{n}: {row:?}"
            );
            assert!(
                near(
                    gain("look_up_gain"),
                    v(published) * look_up(published) / (v(row) * look_up(row))
                ),
                "{n}: {row:?}"
            );
            // The error is at least that of the variances.
            let least = if row["sampler"] == "published" {
                0.0
            } else {
                number(row, "break_even_se") / number(row, "break_even")
            };
            for name in ["gain", "look_up_gain"] {
                let error = number(row, &format!("{name}_at_{n}_se")) / gain(name);
                assert!(
                    error >= least * 0.999_999 && error.is_finite(),
                    "{name} {n}: {error} {row:?}"
                );
            }
        }
    }
}

#[cfg(feature = "parquet")]
#[test]
fn csv_and_parquet_have_the_same_content() {
    for name in ["study", "efficiency", "difference"] {
        let rows = csv(&format!("{name}.csv"));
        let file = File::open(reference().join(format!("{name}.parquet"))).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        let schema = reader.metadata().file_metadata().schema();
        let names: Vec<&str> = schema
            .get_fields()
            .iter()
            .map(|field| field.name())
            .collect();
        assert_eq!(names, rows[0], "{name}: columns");
        let mut count = 0;
        for (row, want) in reader.get_row_iter(None).unwrap().zip(&rows[1..]) {
            let row = row.unwrap();
            for ((name, field), want) in row.get_column_iter().zip(want) {
                let same = match field {
                    Field::Str(text) => text == want,
                    Field::Int(count) => Ok(*count) == want.parse(),
                    Field::Double(number) => want
                        .parse::<f64>()
                        .is_ok_and(|want| want.to_bits() == number.to_bits()),
                    Field::Null => want.is_empty(),
                    _ => false,
                };
                assert!(same, "{name} of row {count}: {field} is not {want}");
            }
            count += 1;
        }
        assert_eq!(count, rows.len() - 1, "{name}: rows");
        let notes = reader
            .metadata()
            .file_metadata()
            .key_value_metadata()
            .unwrap();
        let note = |key: &str| {
            notes
                .iter()
                .find(|note| note.key == key)
                .and_then(|note| note.value.clone())
        };
        assert_eq!(
            note("hairis.seed").as_deref(),
            Some("1"),
            "{name}: {notes:?}"
        );
    }
}

#[test]
fn settings_and_times_are_complete() {
    let settings: Value =
        serde_json::from_slice(&fs::read(reference().join("study.json")).unwrap()).unwrap();
    assert_eq!(settings["study"]["seed"], 1);
    assert_eq!(settings["study"]["cells"], CELLS);
    assert!(
        settings["times_measured_on"]["cpu"].is_string(),
        "{settings}"
    );
    let times = csv("times.csv");
    assert_eq!(
        times.len() - 1,
        3 * 2 * SAMPLERS + 5,
        "1, 4 and 16 samples a point, and five lights"
    );
    assert!(
        times[1..]
            .iter()
            .all(|row| row[4].parse::<f64>().unwrap() > 0.0),
        "{times:?}"
    );
    let left: Vec<_> = fs::read_dir(reference())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert!(
        left.iter()
            .all(|name| !name.to_string_lossy().ends_with(".new")),
        "{left:?}"
    );
}

#[test]
fn the_report_stands_alone_and_has_every_part() {
    let page = fs::read_to_string(reference().join("report.html")).unwrap();
    let answers = [
        "Is the Cauchy model worth it?",
        "How far can that go?",
        "change in looks?",
        "cost?",
        "Where not?",
    ];
    for words in answers {
        assert_eq!(page.matches(words).count(), 1, "{words}");
    }
    for words in [
        "perfect sampling",
        "Least variance in equal time",
        "look-up of the light",
        "won / undecided / lost",
        "Rays from candidates",
    ] {
        assert!(page.contains(words), "{words}");
    }
    for words in [
        "How different the models look",
        "Method and machine",
        "standard error",
        "hairis claims",
    ] {
        assert!(page.contains(words), "{words}");
    }
    for outside in ["<script", "<link", " src=", "url(", "@import", "NaN"] {
        assert!(!page.contains(outside), "{outside} in the page");
    }
    // Every figure is a file, and there are no others.
    let figures = page.matches("<figure ").count();
    let mut ends: Vec<String> = Vec::new();
    for entry in fs::read_dir(reference().join("figures")).unwrap() {
        let path = entry.unwrap().path();
        let bytes = fs::read(&path).unwrap();
        let end = path.extension().unwrap().to_str().unwrap().to_owned();
        assert!(
            bytes.starts_with(if end == "png" { b"\x89PNG" } else { b"<svg" }),
            "{}",
            path.display()
        );
        ends.push(end);
    }
    let count = |kind: &str| ends.iter().filter(|end| *end == kind).count();
    assert_eq!(count("svg"), figures, "a drawing each");
    assert_eq!(
        count("png"),
        if cfg!(feature = "png") { figures } else { 0 },
        "a picture each"
    );
}

#[test]
fn differences_have_a_row_for_each_cell_and_width() {
    let rows = csv("difference.csv");
    assert_eq!(rows.len() - 1, 6 * CELLS);
    let column = |name: &str| rows[0].iter().position(|of| of == name).unwrap();
    for row in &rows[1..] {
        let number = |name: &str| row[column(name)].parse::<f64>().unwrap();
        for name in ["l1", "l2", "shape_l1", "blurred_l1", "blurred_shape_l2"] {
            assert!(
                number(name) > 0.0 && number(name) < 2.0,
                "{name} of {row:?}"
            );
        }
        // A blur cannot add to L1, and L1 is at least the change of the albedo.
        assert!(number("blurred_l1") <= number("l1") * 1.001, "{row:?}");
        assert!(
            number("blurred_l1") >= (number("albedo_ratio") - 1.0).abs() * 0.999,
            "{row:?}"
        );
    }
}

#[test]
fn the_refit_has_parameters_and_v_of_every_cell() {
    let rows = csv("refitted.csv");
    assert_eq!(rows.len() - 1, CELLS);
    let column = |name: &str| rows[0].iter().position(|of| of == name).unwrap();
    let v = |name: &str| column(&format!("v_{name}"));
    for (row, next) in rows[1..].iter().zip(&rows[2..]) {
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        assert!(number(column("beta[0]")) > 0.01, "{row:?}");
        let [published, matched] = ["published_constant", "matched_constant"].map(v);
        assert!(number(matched) < number(published), "{row:?}");
        // The next cell has the same hair, from another inclination.
        if row[1..6] == next[1..6] {
            assert_eq!(row[column("alpha[0]")..], next[column("alpha[0]")..]);
        }
    }
}
