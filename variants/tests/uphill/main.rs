//! Searches for the worst case of every bound that the documentation states, and cases that searches have found.
//!
//! A bound is a figure as a function of a point in a cube: material, directions, offset and numbers follow from its coordinates. The
//! test [`search`] maximises each figure, and `HAIRIS_RECORD=write` writes the worst cases to `benches/records/uphill.csv`:
//!
//! ```sh
//! HAIRIS_UPHILL=600 HAIRIS_RECORD=write cargo test --release -p hairis-variants --features any,serde --test uphill -- --ignored --nocapture
//! ```
//!
//! `HAIRIS_UPHILL` is the time per bound in seconds, 1 without the variable, and `HAIRIS_UPHILL_OF=albedo` searches only the bounds whose names
//! contain the word. A search starts from the recorded case as well as from the best of random points, so that it goes on where the last one
//! ended; the record has the seconds of all of them. CI evaluates the recorded cases.
#![allow(clippy::unwrap_used, reason = "a test may panic: that is how it fails")]
#![cfg(not(hairis_one))]

mod accuracy;
mod climb;
mod energy;
mod point;

use climb::{Budget, Found, climb};
use core::sync::atomic::{AtomicUsize, Ordering};
use core::time::Duration;
use hairis::simd::Level;
use hairis_conformance::published::support::Draws;
use hairis_variants::ModelId;
use point::Coordinates;
use std::collections::BTreeMap;
use std::fs;
use std::sync::{Arc, Mutex};
use std::thread;

/// Arithmetic of a figure: one lane and the levels that have its bits, or levels that fuse products and sums.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Arithmetic {
    OneLane,
    Fused(Level),
}

impl Arithmetic {
    /// Returns one lane, and a level that fuses if the CPU has one.
    fn all() -> impl Iterator<Item = Self> {
        let fused = Level::available().find(|level| level.fuses());
        [Self::OneLane].into_iter().chain(fused.map(Self::Fused))
    }
}

type Figure = dyn Fn(&mut Coordinates<'_>, Arithmetic) -> f64 + Send + Sync;

/// Figure that must not be above a stated one.
#[derive(Clone)]
pub(crate) struct Bound {
    quantity: &'static str,
    model: String,
    stated: f64,
    figure: Arc<Figure>,
}

impl Bound {
    pub(crate) fn new(
        quantity: &'static str,
        model: ModelId,
        stated: f64,
        figure: impl Fn(&mut Coordinates<'_>, Arithmetic) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let sampler = model.choice().filter(|_| !model.is_default());
        let model = match sampler {
            Some((_, word)) => format!("{} {word}", model.name()),
            None => model.name().to_owned(),
        };
        Self {
            quantity,
            model,
            stated,
            figure: Arc::new(figure),
        }
    }

    /// Returns the first two fields of the bound's row.
    fn name(&self) -> String {
        format!("{},{}", self.quantity, self.model)
    }

    fn dimension(&self) -> usize {
        let mut at = Coordinates::new(&[]);
        (self.figure)(&mut at, Arithmetic::OneLane);
        at.taken()
    }

    /// Returns the figure on one lane and on a level that fuses.
    fn figures(&self, at: &[f32]) -> Vec<f64> {
        Arithmetic::all()
            .map(|arithmetic| (self.figure)(&mut Coordinates::new(at), arithmetic))
            .collect()
    }

    /// Returns material, directions and numbers of a case.
    fn notes(&self, at: &[f32]) -> String {
        let mut at = Coordinates::with_notes(at);
        (self.figure)(&mut at, Arithmetic::OneLane);
        at.notes()
    }

    fn search(&self, start: Option<&[f32]>, seed: u64, time: Duration) -> Found {
        let worst = |at: &[f32]| {
            let figures = self.figures(at).into_iter();
            // NaN is larger than all numbers.
            figures.max_by(f64::total_cmp).unwrap()
        };
        climb(
            self.dimension(),
            worst,
            start,
            Draws(seed),
            Budget::Time(time),
        )
    }
}

/// Returns the bounds of every model and sampler, but of samplers that differ from one of these by constants. A model with a diffuse part
/// or with scattering is not searched.
fn bounds() -> Vec<Bound> {
    let words = ["published", "matched", "mean"];
    let is_one = |model: &&ModelId| model.choice().is_none_or(|(_, word)| words.contains(&word));
    let of = |model: &ModelId| [accuracy::bounds(*model), energy::bounds(*model)].concat();
    let ends = ["-diffuse", "-scattering"];
    let is_alone = |model: &&ModelId| !ends.iter().any(|end| model.name().ends_with(end));
    let models = ModelId::ALL.iter().filter(is_one).filter(is_alone);
    models.flat_map(of).collect()
}

const RECORD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../benches/records/uphill.csv");
const HEAD: &str = "\
# Worst cases of the stated bounds that searches uphill found, by the test `search` of variants/tests/uphill.
# CPU: any
quantity,model,stated,sampled,one lane,fused,seconds,evaluations,case
";

/// Row of the record.
#[derive(Clone, Debug)]
struct Row {
    stated: f64,
    sampled: f64,
    /// Figures of the case on one lane and on a level that fuses.
    figures: [f64; 2],
    seconds: u64,
    evaluations: u64,
    case: Vec<f32>,
}

impl Row {
    fn write(&self, name: &str) -> String {
        let Self {
            stated,
            sampled,
            figures: [one, fused],
            seconds,
            evaluations,
            case,
        } = self;
        let case: Vec<String> = case.iter().map(|x| format!("{x}")).collect();
        let case = case.join(" ");
        format!(
            "{name},{stated:e},{sampled:.4e},{one:.5e},{fused:.5e},{seconds},{evaluations},{case}\n"
        )
    }

    fn read(line: &str) -> (String, Self) {
        let fields: Vec<&str> = line.split(',').collect();
        let [
            quantity,
            model,
            stated,
            sampled,
            one,
            fused,
            seconds,
            evaluations,
            case,
        ] = fields[..]
        else {
            panic!("a row must have nine fields: {line}");
        };
        let case = case.split_whitespace().map(|x| x.parse().unwrap());
        let row = Self {
            stated: stated.parse().unwrap(),
            sampled: sampled.parse().unwrap(),
            figures: [one, fused].map(|x| x.parse().unwrap()),
            seconds: seconds.parse().unwrap(),
            evaluations: evaluations.parse().unwrap(),
            case: case.collect(),
        };
        (format!("{quantity},{model}"), row)
    }

    /// Returns true if no figure is above the stated one, or NaN.
    fn is_within(&self) -> bool {
        self.figures.iter().all(|figure| *figure <= self.stated)
    }
}

fn rows() -> BTreeMap<String, Row> {
    let text = fs::read_to_string(RECORD).unwrap_or_default();
    text.lines()
        .skip(HEAD.lines().count())
        .map(Row::read)
        .collect()
}

/// The recorded cases have their figures, which are below the stated ones; every bound has a case.
#[test]
fn recorded_cases_are_within_the_bounds() {
    let rows = rows();
    for bound in bounds() {
        let name = bound.name();
        let row = rows
            .get(&name)
            .unwrap_or_else(|| panic!("the record must have a row {name}"));
        assert_eq!(row.stated, bound.stated, "stated in the record: {name}");
        assert_eq!(row.case.len(), bound.dimension(), "coordinates: {name}");
        for (figure, recorded) in bound.figures(&row.case).into_iter().zip(row.figures) {
            assert!(
                (figure - recorded).abs() <= 1e-5 * recorded,
                "{name}: {figure:.5e} where the record has {recorded:.5e}: {}",
                bound.notes(&row.case)
            );
            assert!(
                figure <= bound.stated,
                "{name}: {figure:.5e} is above {:e}: {}",
                bound.stated,
                bound.notes(&row.case)
            );
        }
    }
}

/// Searches for a worse case of each bound.
#[test]
#[ignore = "as long as it is told: 1 s per bound without HAIRIS_UPHILL"]
fn search() {
    let seconds = std::env::var("HAIRIS_UPHILL").map_or(1, |text| text.parse().unwrap());
    let only = std::env::var("HAIRIS_UPHILL_OF").unwrap_or_default();
    let writes = std::env::var("HAIRIS_RECORD").is_ok_and(|word| word == "write");
    let all = bounds();
    let rows = Mutex::new(rows());
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(bound) = all.get(next.fetch_add(1, Ordering::Relaxed)) {
            let name = bound.name();
            if !name.contains(&only) {
                continue;
            }
            // Of a case whose coordinates still mean what they did.
            let before = rows.lock().unwrap().get(&name).cloned();
            let before = before.filter(|row| row.case.len() == bound.dimension());
            let start = before.as_ref().map(|row| &row.case[..]);
            // Other numbers than those of the searches before.
            let of_name = |seed: u64, byte| seed.wrapping_mul(31) ^ u64::from(byte);
            let seed = before.as_ref().map_or(0, |row| row.evaluations);
            let seed = Draws(name.bytes().fold(seed, of_name)).bits();
            let found = bound.search(start, seed, Duration::from_secs(seconds));
            let figures = bound.figures(&found.at);
            let mut row = Row {
                stated: bound.stated,
                sampled: found.sampled,
                figures: [figures[0], figures[figures.len() - 1]],
                seconds,
                evaluations: found.evaluations,
                case: found.at,
            };
            let [one, fused] = row.figures;
            println!(
                "{name}: stated {:e}, random {:.2e}, searched {one:.2e} and {fused:.2e}, {} evaluations: {}",
                row.stated,
                row.sampled,
                row.evaluations,
                bound.notes(&row.case)
            );
            if let Some(before) = before {
                row.sampled = row.sampled.max(before.sampled);
                row.seconds += before.seconds;
                row.evaluations += before.evaluations;
            }
            let mut rows = rows.lock().unwrap();
            rows.insert(name, row);
            if writes {
                // At once, so that a search that is stopped keeps what it found.
                let lines = all.iter().map(Bound::name);
                let lines = lines.filter_map(|name| Some(rows.get(&name)?.write(&name)));
                fs::write(
                    RECORD,
                    lines.fold(HEAD.to_owned(), |text, line| text + &line),
                )
                .unwrap();
            }
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(work);
        }
    });
    let rows = rows.into_inner().unwrap();
    let beyond: Vec<String> = all
        .iter()
        .filter(|bound| rows.get(&bound.name()).is_some_and(|row| !row.is_within()))
        .map(Bound::name)
        .collect();
    assert!(beyond.is_empty(), "above their bounds: {beyond:#?}");
}
