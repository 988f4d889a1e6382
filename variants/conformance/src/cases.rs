//! Random cases of properties, which are drawn from strategies, shrunk, and printed as code.

pub(crate) mod case;
mod code;
pub(crate) mod inputs;
mod regressions;

use crate::erased::hits::{HitsSet, HitsSubject};
use crate::erased::{ErasedBsdf8, ErasedSubject, MaterialSet, NamedMaterial, Which};
use crate::failure::{Failure, Outcome, Worst};
use crate::probe::{Direction, Draws, hits8, run_seed};
use crate::size::cases;
use crate::subject::{Claims, Subject};
use case::{Choice, Choices, Source};
use hairis::simd::Level;
use hairis::{Hit, LobeMask};
use inputs::{Aim, Drawn, Inputs};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use regressions::Regressions;
use std::rc::Rc;

pub use case::{Case, Row};

/// Largest number of steps in which one case is shrunk.
const STEPS: usize = 20_000;

/// Subject whose cases have another source than random numbers alone.
///
/// A failing property prints its smallest case as code that ends in [`pasted`](Self::pasted).
#[derive(Debug)]
pub struct Replay<'a, S> {
    subject: &'a S,
    source: Source,
}

impl<'a, S: Subject> Replay<'a, S> {
    /// Wraps a subject so that its properties run on this case alone.
    ///
    /// Properties that draw no cases, such as statistical tests, run as they always do.
    pub fn pasted(subject: &'a S, case: Case<crate::ParamsOf<S>>) -> Self {
        let Case { rows, lobes, order } = case;
        let rows = rows.map(|row| Row {
            material: Choice::pasted(Rc::new(row.material)),
            hit: row.hit,
            wi: row.wi,
            xi: row.xi,
            tolerances: row.tolerances,
        });
        let source = Source::Pasted(Box::new(Case { rows, lobes, order }));
        Self { subject, source }
    }

    /// Wraps the subject of a test, which keeps its regressions in the folder `proptest-regressions` of its package.
    #[doc(hidden)]
    pub fn kept(subject: &'a S, package: &str, test: &'static str) -> Self {
        let source = Source::Kept(Regressions::new(package, test));
        Self { subject, source }
    }
}

impl<S: Subject> ErasedSubject for Replay<'_, S> {
    fn claims(&self) -> Claims {
        ErasedSubject::claims(self.subject)
    }

    fn lobe_names(&self) -> &'static [&'static str] {
        self.subject.lobe_names()
    }

    fn set(&self, which: Which) -> Box<dyn MaterialSet + '_> {
        self.subject.set(which)
    }

    fn choices(&self, which: Which) -> Choices {
        self.subject.choices(which)
    }

    fn set_of(&self, choices: [&Choice; 8]) -> Box<dyn MaterialSet + '_> {
        self.subject.set_of(choices)
    }

    fn source(&self) -> Source {
        self.source.clone()
    }
}

impl<S: Subject> HitsSubject for Replay<'_, S> {
    fn hits(&self) -> Box<dyn HitsSet + '_> {
        self.subject.hits()
    }
}

/// Case whose materials have been made.
pub(crate) struct Trial<'a> {
    set: Box<dyn MaterialSet + 'a>,
    pub(crate) hits: [Hit; 8],
    pub(crate) wi: [Direction; 8],
    pub(crate) xi: [[f32; 3]; 8],
    /// True in the lanes in which the tolerances of the claims apply.
    pub(crate) tolerances: [bool; 8],
    pub(crate) lobes: LobeMask,
    pub(crate) order: [usize; 8],
}

impl<'a> Trial<'a> {
    fn new(subject: &'a dyn ErasedSubject, case: &Case<Choice>) -> Self {
        let rows = &case.rows;
        Self {
            set: subject.set_of(rows.each_ref().map(|row| &row.material)),
            hits: rows.each_ref().map(|row| row.hit),
            wi: rows.each_ref().map(|row| row.wi),
            xi: rows.each_ref().map(|row| row.xi),
            tolerances: rows.each_ref().map(|row| row.tolerances),
            lobes: case.lobes,
            order: case.order,
        }
    }

    pub(crate) fn material(&self, lane: usize) -> NamedMaterial<'_> {
        (&*self.set as &dyn MaterialSet).get(lane)
    }

    /// Prepares the shading points in the lanes of a packet, in this order.
    pub(crate) fn prepare(&self, level: Level, order: [usize; 8]) -> Box<dyn ErasedBsdf8> {
        let hits = hits8(&order.map(|lane| self.hits[lane]));
        self.set.prepare_packed(order, level, &hits)
    }

    /// Describes the shading point and the queries of a lane.
    pub(crate) fn at(&self, lane: usize, how: impl core::fmt::Display) -> String {
        let (name, hit, wi) = (self.material(lane).name(), self.hits[lane], self.wi[lane]);
        let xi = self.xi[lane];
        format!("{name} lane {lane} on {how} {hit:?} {wi:?} xi {xi:?}")
    }
}

/// Property that is tested on random cases.
pub(crate) struct Property<'a> {
    pub(crate) name: &'static str,
    /// Module and name of the function.
    pub(crate) path: &'static str,
    pub(crate) subject: &'a dyn ErasedSubject,
    pub(crate) which: Which,
    pub(crate) inputs: Inputs,
    /// True if tolerances apply at these inputs.
    pub(crate) tolerances: bool,
    /// Number of cases with `HAIRIS_CASES=1`.
    pub(crate) cases: usize,
}

impl Property<'_> {
    /// Runs `test` on every case, and compares the errors of these quantities with their tolerances. The worst failure is shrunk, and the
    /// smallest case that fails is printed as code.
    pub(crate) fn check<const N: usize>(
        &self,
        quantities: [(&'static str, f64); N],
        test: impl Fn(&Trial<'_>, &mut [Worst; N]) -> Outcome,
    ) -> Outcome {
        let zero = quantities.map(|(what, tolerance)| Worst::new(self.name, what, tolerance));
        let mut total = zero.clone();
        let mut run = |case: &Case<Choice>| {
            let mut worst = zero.clone();
            let outcome = test(&Trial::new(self.subject, case), &mut worst);
            let excess = |worst: &Worst| worst.verdict().err();
            // Of equal failures, the first counts.
            let failures = worst.iter().rev().filter_map(excess);
            let failure = outcome
                .err()
                .or_else(|| failures.max_by(|a, b| f64::total_cmp(&a.excess, &b.excess)));
            for (total, worst) in total.iter_mut().zip(worst) {
                total.merge(worst);
            }
            failure
        };
        let source = self.subject.source();
        let kept = match &source {
            Source::Pasted(case) => return run(case).map_or(Ok(()), Err),
            Source::Kept(regressions) => regressions.seeds(self.path),
            Source::Fresh => Vec::new(),
        };
        let strategy = self.inputs.cases(self.subject.choices(self.which));
        let mut fresh = Draws(self.path.bytes().fold(0, |seed, byte| {
            Draws(seed ^ u64::from(byte) ^ run_seed()).bits()
        }));
        let fresh = core::iter::repeat_with(|| fresh.bits()).take(cases(self.cases));
        let mut found: Option<(Failure, u64, _)> = None;
        for seed in kept.into_iter().chain(fresh) {
            let tree = new_tree(&strategy, seed);
            let Some(failure) = run(&self.resolve(&tree.current())) else {
                continue;
            };
            let last = failure.excess == f64::INFINITY;
            if found
                .as_ref()
                .is_none_or(|(worst, ..)| failure.excess > worst.excess)
            {
                found = Some((failure, seed, tree));
            }
            if last {
                break;
            }
        }
        let Some((worst, seed, mut tree)) = found else {
            return total.into_iter().try_for_each(Worst::report);
        };
        let (mut smallest, mut case) = (worst.clone(), self.resolve(&tree.current()));
        let mut more = tree.simplify();
        for _ in 0..STEPS {
            if !more {
                break;
            }
            let next = self.resolve(&tree.current());
            more = if let Some(failure) = run(&next) {
                (smallest, case) = (failure, next);
                tree.simplify()
            } else {
                tree.complicate()
            };
        }
        let code = code::write(&case, self.path);
        if let Source::Kept(regressions) = &source {
            regressions.add(self.path, seed, &code);
        }
        Err(Failure {
            message: format!("{}\nworst case: {}", smallest.message, worst.message),
            case: Some(code),
            ..smallest
        })
    }

    /// Completes a drawn case with the directions that have to be sampled.
    fn resolve(&self, (rows, lobes, order): &Drawn) -> Case<Choice> {
        let set = self.subject.set_of(rows.each_ref().map(|row| &row.0));
        let row = |lane: usize| {
            let (material, hit, aim, xi) = &rows[lane];
            let wi = match *aim {
                Aim::At(wi) => wi,
                Aim::Lobe(xi, otherwise) => {
                    let sample = set.prepare(lane, *hit).sample(xi);
                    sample.map_or(otherwise, |s| s.wi)
                }
            };
            Row {
                tolerances: self.tolerances && material.is_named(),
                material: material.clone(),
                hit: *hit,
                wi,
                xi: *xi,
            }
        };
        Case {
            rows: core::array::from_fn(row),
            lobes: *lobes,
            order: *order,
        }
    }
}

/// Draws the case of a seed.
fn new_tree<S: Strategy>(strategy: &S, seed: u64) -> S::Tree {
    let mut draws = Draws(seed);
    let bytes: [[u8; 8]; 4] = core::array::from_fn(|_| draws.unseeded().to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, bytes.as_flattened());
    let config = Config {
        failure_persistence: None,
        ..Config::default()
    };
    let tree = strategy.new_tree(&mut TestRunner::new_with_rng(config, rng));
    tree.unwrap_or_else(|reason| panic!("strategies of materials must not reject: {reason}"))
}
