//! Property that NaN and infinite inputs give no value and no density, and samples that are discarded.

use crate::cases::Property;
use crate::cases::inputs::Inputs;
use crate::erased::{COLUMNS, ErasedBsdf, ErasedBsdf8, ErasedSubject, Which};
use crate::failure::{Failure, Outcome};
use crate::probe::{Direction, hits, hits8, packet, sobol, triples};
use hairis::simd::{Level, f32x8};
use hairis::{Eval, Hit, Lobe, Sample8};

const NAME: &str = "inputs that are no numbers are black";

/// Number of packets of eight materials.
const CASES: usize = 1500;

/// Rows of a slice: whole packets of every level, and a few more.
const ROWS: usize = 71;

fn black(e: Eval) -> bool {
    e.value == [0.0; 3] && e.pdf == 0.0
}

/// Returns true if every lane is discarded, and all of its numbers are 0.
fn discarded(s: &Sample8) -> bool {
    let numbers = [&s.pdf].into_iter().chain(&s.value).chain(&s.weight);
    numbers.into_iter().all(|x| x.to_array() == [0.0; 8])
        && s.slot.to_array() == [-1.0; 8]
        && s.live() == 0
}

fn no_lobes(lobes: &[[f32x8; 2]]) -> bool {
    lobes
        .as_flattened()
        .iter()
        .all(|x| x.to_array() == [0.0; 8])
}

/// Describes any result other than zero at this direction, or of these numbers.
fn at_one(bsdf: &dyn ErasedBsdf, wi: Option<Direction>, xi: Option<[f32; 3]>) -> Option<String> {
    if let Some(wi) = wi {
        let e = bsdf.eval_pdf(wi);
        let lobes = bsdf.lobes(wi);
        if !black(e)
            || lobes
                .0
                .iter()
                .any(|lobe| lobe.value != 0.0 || lobe.pdf != 0.0)
        {
            return Some(format!("{e:?} {lobes:?}, one lane"));
        }
    }
    let sample = xi.and_then(|xi| bsdf.sample(xi));
    if sample.is_some() {
        return Some(format!("{sample:?}, one lane"));
    }
    for level in Level::available() {
        if let Some(wi) = wi {
            let (e, lobes) = (
                bsdf.with_level(level).eval_pdf8(&packet(&[wi; 8])),
                bsdf.with_level(level).lobes8(&packet(&[wi; 8])),
            );
            if !(0..8).all(|lane| black(e.lane(lane)))
                || !no_lobes(&lobes.0.map(|lobe| [lobe.value, lobe.pdf]))
            {
                return Some(format!("{e:?} {lobes:?}, {level}"));
            }
            let mut out = [const { [1.0; ROWS] }; 4];
            let written = bsdf.with_level(level).eval_array(
                [&[wi.x; ROWS], &[wi.y; ROWS], &[wi.z; ROWS]],
                slices(&mut out),
            );
            if written.is_err() || out.as_flattened().iter().any(|x| *x != 0.0) {
                return Some(format!("{out:?}, slices on {level}"));
            }
        }
        if let Some(xi) = xi {
            let s = bsdf.with_level(level).sample8(&triples(&[xi; 8]));
            if !discarded(&s) {
                return Some(format!("{s:?}, {level}"));
            }
            let mut out = [const { [1.0; ROWS] }; COLUMNS];
            let written = bsdf.with_level(level).sample_array(
                [&[xi[0]; ROWS], &[xi[1]; ROWS], &[xi[2]; ROWS]],
                slices(&mut out),
            );
            let nothing = out[3..10].as_flattened().iter().all(|x| *x == 0.0)
                && out[10].iter().all(|slot| *slot == -1.0);
            if written.is_err() || !nothing {
                return Some(format!("{out:?}, slices on {level}"));
            }
        }
    }
    None
}

fn slices<const N: usize>(out: &mut [[f32; ROWS]; N]) -> [&mut [f32]; N] {
    out.each_mut().map(|column| &mut column[..])
}

/// Describes any result other than zero at eight shading points.
fn at_each(
    each: &dyn ErasedBsdf8,
    level: Level,
    wi: Option<[Direction; 8]>,
    xi: Option<[[f32; 3]; 8]>,
) -> Option<String> {
    if let Some(wi) = wi {
        let (e, lobes) = (
            each.with_level(level).eval_pdf8(&packet(&wi)),
            each.lobes8(&packet(&wi)),
        );
        if !(0..8).all(|lane| black(e.lane(lane)))
            || !no_lobes(&lobes.0.map(|lobe| [lobe.value, lobe.pdf]))
        {
            return Some(format!("{e:?} {lobes:?}, eight hits on {level}"));
        }
    }
    let sample = xi.map(|xi| each.with_level(level).sample8(&triples(&xi)));
    sample
        .filter(|s| !discarded(s))
        .map(|s| format!("{s:?}, eight hits on {level}"))
}

/// Checks that a `wo` or a `wi` with a component that is NaN or infinite evaluates to zero, and that samples are discarded for such a
/// `wo` or if one of the numbers is NaN. Calls run on one lane, on eight and in slices, at one hit and at eight, on every level.
///
/// # Errors
///
/// Returns a failure if a result is not 0, or if a sample is kept.
pub fn inputs_that_are_no_numbers_are_black(subject: &dyn ErasedSubject) -> Outcome {
    // Finite inputs that are combined with the non-finite ones.
    let sound: [Hit; 8] = core::array::from_fn(|lane| hits()[lane % hits().len()]);
    let (wi, xi) = (
        sound.map(|hit| hit.wo.into()),
        [1, 2, 3, 4, 5, 6, 7, 8].map(sobol),
    );
    let property = Property {
        name: NAME,
        path: "not_numbers::inputs_that_are_no_numbers_are_black",
        subject,
        which: Which::WithExtremes,
        inputs: Inputs::NotNumbers,
        tolerances: true,
        cases: CASES,
    };
    property.check([], |trial, []| {
        let (odd_hits, odd_wi, odd_xi) = (trial.hits, trial.wi, trial.xi);
        let material = trial.material(0);
        let (seen, unseen) = (material.prepare(sound[0]), material.prepare(odd_hits[0]));
        let mut faults = vec![
            at_one(&*unseen, Some(wi[0]), Some(xi[0])),
            at_one(&*unseen, Some(odd_wi[0]), Some(odd_xi[0])),
            at_one(&*seen, Some(odd_wi[0]), Some(odd_xi[0])),
        ];
        let albedo = unseen.albedo();
        if albedo.0 != [[0.0; 3]; Lobe::COUNT] {
            faults.push(Some(format!("albedo {albedo:?}")));
        }
        for level in Level::available() {
            let unseen = trial.prepare(level, [0, 1, 2, 3, 4, 5, 6, 7]);
            faults.push(at_each(&*unseen, level, Some(wi), Some(xi)));
            let seen = material.prepare8(level, hits8(&sound));
            faults.push(at_each(&*seen, level, Some(odd_wi), Some(odd_xi)));
            let albedo = unseen.with_level(level).albedo8();
            let albedo = albedo.0.as_flattened();
            if albedo.iter().any(|x| x.to_array() != [0.0; 8]) {
                faults.push(Some(format!("albedos {albedo:?}, {level}")));
            }
        }
        faults.into_iter().flatten().next().map_or(Ok(()), |fault| {
            let rows = [0, 1, 2, 3, 4, 5, 6, 7].map(|lane| trial.at(lane, "any level"));
            Err(Failure::new(
                NAME,
                format!("{fault}, of {}", rows.join("; ")),
            ))
        })
    })
}
