//! Runs of figures that are stopped and started again.

mod csv;
mod map;
mod names;
mod panel;
mod store;
mod verdict;

use clap::Parser as _;
use core::cell::Cell;
use core::panic::AssertUnwindSafe;
use hairis_instruments::interrupt::{Interrupt, Signal};
use hairis_materials::MaterialSpec;
use hairis_render::args::{Args, Command};
use hairis_render::figures::done::Done;
use hairis_render::figures::measure::{Measured, Plan, preset};
use hairis_render::figures::models::Preset;
use hairis_render::figures::store::Store;
use hairis_render::figures::{SCENES, page};
use hairis_render::hair::Choice;
use hairis_render::lights::RectangleSampling;
use hairis_render::protocol::Runs;
use hairis_render::scenes::Name;
use hairis_render::transport::Integrator;
use std::panic::catch_unwind;
use std::path::Path;

const TINY: Plan = Plan {
    side: 12,
    strands: 200,
    samples: [&[2, 4], &[2, 4]],
    reference: [8, 4],
    runs: 3,
    ..Plan::QUICK
};

/// Measures a scene, and stops at the given step of progress. Also returns the count of measurements that were there.
fn measured(plan: &Plan, seed: u64, out: &Path, last: usize) -> Option<(Measured, usize)> {
    let hair = preset(Name::AreaHead).expect("listed");
    measured_with(&hair, plan, seed, out, last)
}

/// Measures a scene with other hair.
fn measured_with(
    hair: &Choice,
    plan: &Plan,
    seed: u64,
    out: &Path,
    last: usize,
) -> Option<(Measured, usize)> {
    let store = Store::new(out, Interrupt::default()).expect("a folder");
    let steps = Cell::new(0);
    let step = |what: &str| {
        steps.set(steps.get() + 1);
        assert!(steps.get() < last, "stopped at {what}");
    };
    let run = || {
        Measured::render(Name::AreaHead, None, hair, plan, seed, &store, &step).expect("rendered")
    };
    let measured = catch_unwind(AssertUnwindSafe(run)).ok()?;
    Some((measured, store.resumed()))
}

/// Returns all runs without their times.
fn results(measured: &Measured) -> Vec<Runs> {
    let runs = measured.samplers.iter().flat_map(|sampler| &sampler.runs);
    runs.map(|runs| Runs {
        seconds: 0.0,
        ..runs.clone()
    })
    .collect()
}

#[test]
fn a_run_that_is_stopped_goes_on_to_the_same_results() {
    let folders = [0; 2].map(|_| tempfile::TempDir::new().expect("a folder"));
    let [at_once, stopped] = folders.each_ref().map(|folder| folder.path());
    let (expected, resumed) = measured(&TINY, 1, at_once, usize::MAX).expect("whole");
    assert_eq!(resumed, 0);
    for last in [2, 3, 6, 9] {
        assert!(
            measured(&TINY, 1, stopped, last).is_none(),
            "stopped at step {last}"
        );
    }
    // The two halves of the reference, and six runs before the stop.
    let (got, resumed) = measured(&TINY, 1, stopped, usize::MAX).expect("whole");
    assert_eq!(resumed, 2 + 6);
    assert_eq!(results(&got), results(&expected));
    assert_eq!(got.reference.picture, expected.reference.picture);
    // Finished measurements keep their times, so that counts at equal time are the same, too.
    let (again, _) = measured(&TINY, 1, stopped, usize::MAX).expect("whole");
    for (a, b) in again.samplers.iter().zip(&got.samplers) {
        assert!(
            a.runs == b.runs && a.equal_time == b.equal_time,
            "{}",
            a.name
        );
    }
}

#[test]
fn a_signal_within_a_measurement_loses_no_picture() {
    let folders = [0; 2].map(|_| tempfile::TempDir::new().expect("a folder"));
    let [at_once, stopped] = folders.each_ref().map(|folder| folder.path());
    let (expected, _) = measured(&TINY, 1, at_once, usize::MAX).expect("whole");
    let files = |ending: &str| {
        let files = std::fs::read_dir(stopped.join("unfinished")).expect("a folder");
        files
            .filter(|file| {
                let path = file.as_ref().expect("read").path();
                path.extension().is_some_and(|end| end == ending)
            })
            .count()
    };
    // Each run renders one picture: the halves of the reference, and some of the first error's
    // three.
    for run in 0..4 {
        let interrupt = Interrupt::default();
        interrupt.raise(Signal::Terminate);
        let store = Store::new(stopped, interrupt).expect("a folder");
        let hair = preset(Name::AreaHead).expect("listed");
        let error = Measured::render(Name::AreaHead, None, &hair, &TINY, 1, &store, &|_| ());
        assert_eq!(error.expect_err("a signal").exit_code(), 143);
        assert_eq!(
            (files("part"), files("film")),
            [(0, 1), (1, 1), (2, 1), (2, 2)][run]
        );
    }
    let (got, resumed) = measured(&TINY, 1, stopped, usize::MAX).expect("whole");
    assert_eq!((resumed, files("film")), (2, 0));
    assert_eq!(results(&got), results(&expected));
}

#[test]
fn other_settings_use_no_results_of_a_run() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let resumed = |plan: &Plan, seed: u64| {
        measured(plan, seed, folder.path(), usize::MAX)
            .expect("whole")
            .1
    };
    assert_eq!(resumed(&TINY, 1), 0);
    assert_eq!(resumed(&TINY, 2), 0, "another seed");
    assert_eq!(
        resumed(
            &Plan {
                strands: 201,
                ..TINY
            },
            1
        ),
        0,
        "other hair"
    );
    assert_eq!(
        resumed(
            &Plan {
                rectangle_sampling: RectangleSampling::Area,
                ..TINY
            },
            1
        ),
        0,
        "lights drawn otherwise"
    );
    assert_eq!(resumed(&Plan { side: 13, ..TINY }, 1), 0, "another size");
    assert_eq!(
        resumed(
            &Plan {
                reference: [9, 4],
                ..TINY
            },
            1
        ),
        0,
        "another reference"
    );
    // The halves of the reference are those of the first run.
    assert_eq!(
        resumed(&Plan { runs: 4, ..TINY }, 1),
        2,
        "more pictures per error"
    );
}

#[test]
fn pictures_of_models_are_kept() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let render = || {
        let store = Store::new(folder.path(), Interrupt::default()).expect("a folder");
        Preset::render("brown", &TINY, 1, &store, &|_| ()).expect("rendered");
        store.resumed()
    };
    assert_eq!(render(), 0);
    let models = hairis_variants::ModelId::defaults_of_names().count();
    assert_eq!(render(), 2 * models, "two halves each");
}

#[test]
fn hair_that_paths_do_not_converge_in_is_refused() {
    let paths = Plan {
        integrator: Some(Integrator::Path),
        ..TINY
    };
    let check = |plan: &Plan, name| plan.check(name, &preset(name).expect("listed"));
    let message = check(&paths, Name::AreaSoft)
        .expect_err("refused")
        .to_string();
    assert!(
        message.contains("area-soft") && message.contains("default") && message.contains("0.98"),
        "{message}"
    );
    for name in SCENES {
        check(&TINY, name).expect("its own integrator");
    }
    check(&paths, Name::Env).expect("blond hair");
}

#[test]
fn hair_of_any_model_is_measured_with_its_own_samplers() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let material = |melanin: &str| {
        let params = format!(r#"{{"beta_m":0.3,"beta_n":0.3,"melanin_amount":{melanin}}}"#);
        let text = format!(r#"{{"model":"chiang","select":"mean","params":{params}}}"#);
        let spec = MaterialSpec::parse_all(&text).expect("legal")[0];
        Choice::of_material("mine", &spec, None).expect("its own sampler")
    };
    let render = |hair: &Choice| {
        let (measured, resumed) =
            measured_with(hair, &TINY, 1, folder.path(), usize::MAX).expect("whole");
        (measured, resumed)
    };
    let (first, _) = render(&material("[0.5,0.2]"));
    let names: Vec<&str> = first.samplers.iter().map(|one| one.name).collect();
    assert_eq!(names, ["uniform", "resampled", "published"]);
    assert_eq!(
        (first.title().as_str(), first.best()),
        ("area-head (mine)", "published")
    );
    // No sampler of another model is on the page.
    let Command::Figures(flags) = Args::parse_from(["hairis-render", "figures"]).command else {
        panic!("the flags of figures")
    };
    let expected = results(&first);
    let done = Done {
        scenes: vec![first],
        ..Done::default()
    };
    let (report, table) = page::write(&done, &TINY, &flags, folder.path()).expect("written");
    let [first] = &*done.scenes else {
        panic!("one scene")
    };
    let head = report.headline(80, "report.html");
    assert!(head.contains("area-head (mine)"), "{head}");
    assert!(
        head.lines().all(|line| line.chars().count() <= 80),
        "{head}"
    );
    assert!(!table.is_empty());
    let page = std::fs::read_to_string(folder.path().join("report.html")).expect("written");
    assert!(page.contains("relMSE × time, relative to published"));
    assert!(!page.contains("matched"), "{page}");
    let (again, resumed) = render(&material("[0.5,0.2]"));
    assert!(resumed > 0 && results(&again) == expected);
    // Another material of the same name shares nothing.
    let (other, resumed) = render(&material("[0.9,0.2]"));
    assert_eq!(resumed, 0);
    assert_ne!(other.reference.picture, first.reference.picture);
}
