//! Properties of lobes: they sum to the value, and masks select them.

use crate::cases::Property;
use crate::cases::inputs::Inputs;
use crate::comparison::relative;
use crate::erased::{ErasedSubject, Which};
use crate::failure::{Failure, Outcome};
use crate::probe::{masks, packet, triples};
use hairis::simd::Level;
use hairis::{Eval, Lobe, LobeMask};

/// Number of packets of eight hits, for sums and for masks.
const CASES: [usize; 2] = [100, 300];

/// Checks that the lobes' values times their colours sum to S, and that the density of each lobe alone is that of the shading point with
/// only this lobe. The density of all lobes is at most the largest of these densities.
///
/// # Errors
///
/// Returns a failure if a sum or a density differs at a direction.
pub fn lobes_sum_to_value(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "lobes sum to the value";
    let claims = subject.claims();
    let quantities = [
        ("the sum of the lobes (`Claims::lobe_sum`)", claims.lobe_sum),
        ("a lobe alone (`Claims::lobe_sum`)", claims.lobe_sum),
    ];
    let property = Property {
        name: NAME,
        path: "lobes::lobes_sum_to_value",
        subject,
        which: Which::Everyday,
        inputs: Inputs::Everyday,
        tolerances: true,
        cases: CASES[0],
    };
    property.check(quantities, |trial, [worst, alone_worst]| {
        for lane in 0..8 {
            let (bsdf, wi) = (
                trial.material(lane).prepare(trial.hits[lane]),
                trial.wi[lane],
            );
            let (whole, lobes) = (bsdf.eval_pdf(wi), bsdf.lobes(wi));
            let at = || format!("{} {lobes:?}, whole {whole:?}", trial.at(lane, "one lane"));
            for c in 0..3 {
                let sum = lobes
                    .0
                    .iter()
                    .map(|l| f64::from(l.value) * f64::from(l.color[c]))
                    .sum();
                worst.see(relative(f64::from(whole.value[c]), sum, 1e-20), at);
            }
            let mut densities = Vec::new();
            for lobe in subject.slots() {
                let alone = bsdf.with_lobes(LobeMask::of(&[lobe])).eval_pdf(wi);
                for (value, color) in alone.value.into_iter().zip(lobes[lobe].color) {
                    let want = f64::from(lobes[lobe].value) * f64::from(color);
                    alone_worst.see(relative(f64::from(value), want, 1e-20), || {
                        format!("value of {} {alone:?}, {}", subject.lobe(lobe), at())
                    });
                }
                // A lobe without energy may keep its shape in `lobes`, but is never drawn.
                if alone.pdf > 0.0 {
                    densities.push(f64::from(alone.pdf));
                    let error = relative(f64::from(alone.pdf), f64::from(lobes[lobe].pdf), 1e-20);
                    alone_worst.see(error, || {
                        format!("density of {} {alone:?}, {}", subject.lobe(lobe), at())
                    });
                }
            }
            let most = densities.iter().fold(0.0, |a: f64, x| a.max(*x));
            let pdf = f64::from(whole.pdf);
            if pdf > most * (1.0 + claims.lobe_sum) + 1e-20 {
                return Err(Failure::new(
                    NAME,
                    format!(
                        "the density is above those of all lobes {densities:?}: {}",
                        at()
                    ),
                ));
            }
        }
        Ok(())
    })
}

/// Checks that masks select lobes, on one lane and on eight. With some lobes masked, the value is the sum of the others, and masked lobes
/// are never drawn. A mask of a mask leaves the common lobes. Without any lobe there is neither value, density nor sample.
///
/// # Errors
///
/// Returns a failure if a mask leaks.
pub fn masks_select_lobes(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "masks select lobes";
    let claims = subject.claims();
    let quantities = [
        (
            "the value with some lobes (`Claims::lobe_sum`)",
            claims.lobe_sum,
        ),
        (
            "the density with a mask of a mask (`Claims::lobe_sum`)",
            claims.lobe_sum,
        ),
    ];
    let level = Level::detect();
    let property = Property {
        name: NAME,
        path: "lobes::masks_select_lobes",
        subject,
        which: Which::WithExtremes,
        inputs: Inputs::Awkward,
        tolerances: true,
        cases: CASES[1],
    };
    property.check(quantities, |trial, [worst, nested]| {
        let (material, wi, xi) = (trial.material(0), trial.wi, trial.xi);
        let bsdf = material.prepare(trial.hits[0]);
        let each = trial.prepare(level, [0, 1, 2, 3, 4, 5, 6, 7]);
        let single: Vec<(Lobe, Eval)> = subject
            .slots()
            .map(|lobe| (lobe, bsdf.with_lobes(LobeMask::of(&[lobe])).eval_pdf(wi[0])))
            .collect();
        for mask in masks() {
            let (part, part8) = (bsdf.with_lobes(mask), each.with_lobes(mask));
            let (e, eight) = (
                part.eval_pdf(wi[0]),
                part8.with_level(level).eval_pdf8(&packet(&wi)),
            );
            let at = || format!("{}, {}", subject.lobes(mask), trial.at(0, level));
            let lanes = 0..if mask == LobeMask::NONE { 8 } else { 1 };
            for got in lanes.map(|lane| eight.lane(lane)).chain([e]) {
                for c in 0..3 {
                    let kept = single.iter().filter(|(lobe, _)| mask.contains(*lobe));
                    let sum: f64 = kept.map(|(_, alone)| f64::from(alone.value[c])).sum();
                    let is_compared = sum <= claims.most;
                    // Values are finite, so that no sum is above the largest float.
                    let sum = sum.min(f64::from(f32::MAX));
                    // Eight lanes may fuse: other properties compare them with one lane.
                    let error = relative(f64::from(got.value[c]), sum, 1e-20);
                    // Lobes that vanish alone may sum to a denormal.
                    let leak = sum == 0.0 && got.value[c] >= f32::MIN_POSITIVE;
                    if leak {
                        return Err(Failure::new(
                            NAME,
                            format!("masked lobes scatter {got:?}: {}", at()),
                        ));
                    }
                    if got == e && trial.tolerances[0] && is_compared {
                        worst.see(error, || format!("{got:?}, sum {sum}: {}", at()));
                    }
                }
                if mask == LobeMask::NONE && (got.pdf != 0.0 || got.value != [0.0; 3]) {
                    return Err(Failure::new(
                        NAME,
                        format!("no lobes, yet {got:?}: {}", at()),
                    ));
                }
            }
            for lobe in Lobe::ALL.into_iter().filter(|lobe| !mask.contains(*lobe)) {
                let l = part.lobes(wi[0])[lobe];
                if l.color.iter().any(|color| l.value * color != 0.0) {
                    return Err(Failure::new(
                        NAME,
                        format!(
                            "{} is masked, yet scatters {l:?}: {}",
                            subject.lobe(lobe),
                            at()
                        ),
                    ));
                }
            }
            let samples = part8.with_level(level).sample8(&triples(&xi));
            for (lane, xi) in xi.into_iter().enumerate() {
                for s in [part.sample(xi), samples.lane(lane)].into_iter().flatten() {
                    if !mask.contains(s.lobe) || s.lobe.index() >= subject.lobe_count() {
                        return Err(Failure::new(
                            NAME,
                            format!("{s:?} is of a masked lobe, xi {xi:?}: {}", at()),
                        ));
                    }
                }
            }
            for other in masks() {
                let both = |lobe: &Lobe| mask.contains(*lobe) && other.contains(*lobe);
                let common: Vec<Lobe> = Lobe::ALL.into_iter().filter(both).collect();
                let twice = part.with_lobes(other).eval_pdf(wi[0]);
                let once = bsdf.with_lobes(LobeMask::of(&common)).eval_pdf(wi[0]);
                let error = relative(f64::from(twice.pdf), f64::from(once.pdf), 1e-20);
                if trial.tolerances[0] {
                    nested.see(error, || {
                        let other = subject.lobes(other);
                        format!("{twice:?}, at once {once:?}: {} then {other}", at())
                    });
                }
            }
        }
        Ok(())
    })
}
