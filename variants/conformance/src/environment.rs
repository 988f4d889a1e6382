//! Properties of floating-point environments of hosts: results stay finite in every rounding mode, and everyday input raises no
//! exception.
//!
//! The compiler assumes the default environment. At opt-levels 2 and 3 it may vectorise scalar code, and the unused lanes may then raise
//! an exception. Divisions are protected from this ([`Lanes::quotient`](hairis::simd::Lanes::quotient)). Run these properties in a
//! release build too. Only x86-64 is tested.

use crate::cases::Property;
use crate::cases::inputs::Inputs;
use crate::erased::{COLUMNS, ErasedBsdf, ErasedSubject, NamedMaterial, Which};
use crate::failure::{Failure, Outcome};
use crate::probe::{Direction, Draws, columns, hits8, packet, triples};
use crate::totality;
use core::hint::black_box;
use hairis::Hit;
use hairis::simd::{Level, control, set_control};

const NAME: &str = "results are finite however they are rounded";

/// Control bits for rounding to nearest, down, up and towards 0, each with denormals and without.
pub(crate) const MODES: [u32; 8] = [
    0x0000, 0x2000, 0x4000, 0x6000, 0x8040, 0xa040, 0xc040, 0xe040,
];
/// Control bits for rounding down, without denormals.
pub(crate) const DOWN: u32 = MODES[5];
/// Number of packets of eight materials.
const CASES: usize = 600;

/// Runs `f` with rounding and denormals as in `mode`, and restores the environment.
pub(crate) fn with_mode<T>(mode: u32, f: impl FnOnce() -> T) -> T {
    let before = control();
    set_control(before & !0xe040 | mode);
    let result = black_box(f());
    set_control(before);
    result
}

/// Flags of exceptions, with the names of the exceptions.
const FLAGS: [(u32, &str); 3] = [(1, "invalid"), (4, "division by zero"), (8, "overflow")];

/// Returns the flags of the exceptions that `f` raises, among those in [`FLAGS`].
fn raised<T>(f: impl FnOnce() -> T) -> u32 {
    let before = control();
    set_control(before & !0x3f);
    black_box(f());
    let after = control();
    set_control(before);
    after & (FLAGS[0].0 | FLAGS[1].0 | FLAGS[2].0)
}

/// Returns the names of exceptions. Not generic, so that it is compiled once.
fn names(flags: u32) -> String {
    let names: Vec<&str> = FLAGS
        .into_iter()
        .filter(|(flag, _)| flags & flag != 0)
        .map(|(_, name)| name)
        .collect();
    names.join(", ")
}

/// Fails if `f` raises an exception twice in a row. A single flag is not enough, because flags also appear spontaneously: on a host where
/// one run in four found a flag, the same calls with traps enabled never trapped.
fn quiet<T>(what: &str, at: impl FnOnce() -> String, mut f: impl FnMut() -> T) -> Outcome {
    let mut flags = raised(&mut f);
    if flags != 0 {
        flags &= raised(f);
    }
    if flags == 0 {
        Ok(())
    } else {
        Err(exceptions(what, flags, &at()))
    }
}

fn exceptions(what: &str, flags: u32, at: &str) -> Failure {
    Failure::new(
        "everyday input raises no exception",
        format!("{what} raises {}: {at}", names(flags)),
    )
}

/// Checks that results for unit directions are finite and not negative in all four rounding modes, with denormals and without: on one
/// lane, on eight, and in slices.
///
/// # Errors
///
/// Returns a failure if a result is negative or not finite.
pub fn any_rounding_is_finite(subject: &dyn ErasedSubject) -> Outcome {
    let in_mode = |mode: u32, failure: Failure| Failure {
        property: NAME,
        message: format!("mode {mode:#x}: {}", failure.message),
        ..failure
    };
    let property = Property {
        name: NAME,
        path: "environment::any_rounding_is_finite",
        subject,
        which: Which::WithExtremes,
        inputs: Inputs::Awkward,
        tolerances: true,
        cases: CASES,
    };
    property.check([], |trial, []| {
        MODES.into_iter().try_for_each(|mode| {
            let outcome = with_mode(mode, || totality::is_sound(subject, trial));
            outcome.map_err(|failure| in_mode(mode, failure))
        })
    })?;
    MODES.into_iter().try_for_each(|mode| {
        let outcome = with_mode(mode, || slices_are_finite(subject));
        outcome.map_err(|failure| in_mode(mode, failure))
    })
}

fn slices_are_finite(subject: &dyn ErasedSubject) -> Outcome {
    let mut draws = Draws(0xf1);
    for material in subject.set(Which::WithExtremes).iter() {
        let (name, bsdf) = (material.name(), material.prepare(draws.hit()));
        let rows: Vec<(Direction, [f32; 3])> =
            (0..69).map(|_| (draws.direction(), draws.xi3())).collect();
        let wi = columns(69, |n| {
            let (wi, _) = rows[n as usize];
            [wi.x, wi.y, wi.z]
        });
        let xi = columns(69, |n| rows[n as usize].1);
        for level in Level::available() {
            let (mut evals, mut samples) = (
                [const { [0.0_f32; 69] }; 4],
                [const { [0.0_f32; 69] }; COLUMNS],
            );
            let lengths = bsdf
                .with_level(level)
                .eval_array(
                    wi.each_ref().map(|c| &c[..]),
                    evals.each_mut().map(|c| &mut c[..]),
                )
                .and(bsdf.with_level(level).sample_array(
                    xi.each_ref().map(|c| &c[..]),
                    samples.each_mut().map(|c| &mut c[..]),
                ));
            let [u, v, w, numbers @ .., _] = &samples;
            let sound = |x: &f32| x.is_finite() && *x >= 0.0;
            if lengths.is_err()
                || !evals.iter().chain(numbers).flatten().all(sound)
                || ![u, v, w].into_iter().flatten().all(|x| x.is_finite())
            {
                return Err(Failure::new(
                    NAME,
                    format!("slices of {name} on {level}: {evals:?} {samples:?}"),
                ));
            }
        }
    }
    Ok(())
}

/// Checks that unit directions off the axis raise neither invalid nor division by zero nor overflow, if the material scatters at all. The
/// calls prepare, evaluate and sample eight lanes, evaluate slices, and run on one lane.
///
/// # Errors
///
/// Returns a failure if a call raises one of these exceptions.
pub fn everyday_input_raises_no_exception(subject: &dyn ErasedSubject) -> Outcome {
    let property = Property {
        name: "everyday input raises no exception",
        path: "environment::everyday_input_raises_no_exception",
        subject,
        which: Which::Everyday,
        inputs: Inputs::Everyday,
        tolerances: true,
        cases: 2 * CASES,
    };
    property.check([], |trial, []| {
        let (material, hits, wi, xi) = (trial.material(0), trial.hits, trial.wi, trial.xi);
        // The number 0 may sample the axis itself.
        if xi.as_flattened().contains(&0.0) {
            return Ok(());
        }
        let one = material.prepare(hits[0]);
        if one
            .albedo()
            .0
            .as_flattened()
            .iter()
            .all(|albedo| *albedo == 0.0)
        {
            return Ok(());
        }
        let (hits8, wi8, xi8) = (hits8(&hits), packet(&wi), triples(&xi));
        let by_axis = [wi8.x.to_array(), wi8.y.to_array(), wi8.z.to_array()];
        scalar_is_quiet(material, &*one, hits[0], (wi[0], xi[0]))?;
        for level in Level::available() {
            let at = || format!("{} on {level}, {hits:?} {wi:?}", material.name());
            quiet("prepare8", at, || {
                NamedMaterial::prepare_packed([material; 8], level, hits8)
            })?;
            let each = NamedMaterial::prepare_packed([material; 8], level, hits8);
            quiet("eval_pdf8 of one hit", at, || {
                one.with_level(level).eval_pdf8(&wi8)
            })?;
            quiet("eval_pdf8 of eight hits", at, || {
                each.with_level(level).eval_pdf8(&wi8)
            })?;
            quiet("sample8 of one hit", at, || {
                one.with_level(level).sample8(&xi8)
            })?;
            quiet("sample8 of eight hits", at, || {
                each.with_level(level).sample8(&xi8)
            })?;
            quiet("lobes8", at, || each.lobes8(&wi8))?;
            quiet("albedo8", at, || each.with_level(level).albedo8())?;
            quiet("conserving", at, || each.with_level(level).conserving())?;
            let mut room = [[0.0; 8]; 4];
            let len = trial.order[0];
            quiet("eval_columns", at, || {
                let out = room.each_mut().map(|column| &mut column[..len]);
                one.with_level(level)
                    .eval_array(by_axis.each_ref().map(|column| &column[..len]), out)
            })?;
        }
        Ok(())
    })
}

/// Checks that calls on one lane raise no exception.
fn scalar_is_quiet(
    material: NamedMaterial<'_>,
    one: &dyn ErasedBsdf,
    hit: Hit,
    (wi, xi): (Direction, [f32; 3]),
) -> Outcome {
    let at = || format!("{}, one lane, {hit:?} {wi:?} {xi:?}", material.name());
    quiet("prepare", at, || material.prepare(hit))?;
    quiet("eval_pdf", at, || one.eval_pdf(wi))?;
    quiet("lobes", at, || one.lobes(wi))?;
    quiet("sample", at, || one.sample(xi))?;
    quiet("albedo", at, || one.albedo())?;
    quiet("conserving", at, || one.conserving().albedo())
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;

    #[test]
    fn modes_and_exceptions_are_those_of_the_register() {
        let divide = |a: f32, b: f32| black_box(a) / black_box(b);
        assert!(with_mode(DOWN, || divide(1.0, 3.0)) < with_mode(0x4000, || divide(1.0, 3.0)));
        assert_eq!(with_mode(DOWN, || divide(1e-30, 1e10)), 0.0, "denormals");
        assert_eq!(names(raised(|| divide(1.0, 0.0))), "division by zero");
        assert_eq!(names(raised(|| divide(0.0, 0.0))), "invalid");
        assert_eq!(names(raised(|| divide(1e38, 1e-10))), "overflow");
        assert_eq!(raised(|| divide(1.0, 3.0)), 0);
    }
}
