//! Lobes sum to the value, and masks select them.

use crate::erased::{ErasedSubject, Which};
use crate::failure::{Failure, Outcome, Worst};
use crate::probe::{Draws, hits8, masks, packet, relative, triples};
use hairis::simd::Level;
use hairis::{Eval, Lobe, LobeMask};

/// Hits per material.
const ROUNDS: usize = 120;

/// The lobes' values times their colours sum to S; the density of each lobe alone is that of the shading point with only
/// this lobe; the density of all is between the least and the largest of them.
///
/// # Errors
///
/// At the first direction where they do not.
pub fn lobes_sum_to_value(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "lobes sum to the value";
    let claims = subject.claims();
    let mut worst = Worst::new(NAME, "the sum of the lobes", claims.lobe_sum);
    let mut alone_worst = Worst::new(NAME, "a lobe alone", claims.lobe_sum);
    let mut draws = Draws(0x10b5);
    for material in subject.set(Which::Everyday).iter() {
        let name = material.name();
        for round in 0..ROUNDS {
            let hit = draws.hit();
            let bsdf = material.prepare(hit);
            let any = draws.direction();
            let drawn = bsdf.sample(draws.xi3()).map_or(any, |s| s.wi);
            let wi = if round % 3 == 0 { any } else { drawn };
            let (whole, lobes) = (bsdf.eval_pdf(wi), bsdf.lobes(wi));
            let at = || format!("{name} {hit:?} {wi:?} {lobes:?}, whole {whole:?}");
            for c in 0..3 {
                let sum = lobes
                    .0
                    .iter()
                    .map(|l| f64::from(l.value) * f64::from(l.color[c]))
                    .sum();
                worst.see(relative(f64::from(whole.value[c]), sum, 1e-20), at)?;
            }
            let mut densities = Vec::new();
            for lobe in subject.slots() {
                let alone = bsdf.with_lobes(LobeMask::of(&[lobe])).eval_pdf(wi);
                for (value, color) in alone.value.into_iter().zip(lobes[lobe].color) {
                    let want = f64::from(lobes[lobe].value) * f64::from(color);
                    alone_worst.see(relative(f64::from(value), want, 1e-20), || {
                        format!("value of {lobe:?} {alone:?}, {}", at())
                    })?;
                }
                // A lobe without energy may keep its shape in `lobes`, but is never drawn.
                if alone.pdf > 0.0 {
                    densities.push(f64::from(alone.pdf));
                    let error = relative(f64::from(alone.pdf), f64::from(lobes[lobe].pdf), 1e-20);
                    alone_worst
                        .see(error, || format!("density of {lobe:?} {alone:?}, {}", at()))?;
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
    }
    worst.report()?;
    alone_worst.report()
}

/// With some lobes masked the value is the sum of the others; masked lobes are never drawn; masks of masks are their
/// common lobes; without any lobe there is neither value, density nor sample. One lane and eight.
///
/// # Errors
///
/// At the first mask that leaks.
pub fn masks_select_lobes(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "masks select lobes";
    let claims = subject.claims();
    let mut worst = Worst::new(NAME, "the value with some lobes", claims.lobe_sum);
    let mut nested = Worst::new(NAME, "the density with a mask of a mask", claims.lobe_sum);
    let mut draws = Draws(0x3a5c);
    let level = Level::detect();
    for material in subject.set(Which::WithExtremes).iter() {
        let name = material.name();
        for _ in 0..ROUNDS / 4 {
            let hit = draws.hit();
            let (bsdf, each) = (
                material.prepare(hit),
                material.prepare8(level, hits8(&[hit; 8])),
            );
            let wi = core::array::from_fn(|_| draws.direction());
            let xi: [[f32; 3]; 8] = core::array::from_fn(|_| draws.xi3());
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
                let at = || format!("{name} {mask:?} {hit:?} {:?}", wi[0]);
                for got in [e, eight.lane(0)] {
                    for c in 0..3 {
                        let kept = single.iter().filter(|(lobe, _)| mask.contains(*lobe));
                        let sum: f64 = kept.map(|(_, alone)| f64::from(alone.value[c])).sum();
                        // Eight lanes may fuse: they are held to one lane elsewhere.
                        let error = relative(f64::from(got.value[c]), sum, 1e-20);
                        let leak = sum == 0.0 && got.value[c] != 0.0;
                        if leak {
                            return Err(Failure::new(
                                NAME,
                                format!("masked lobes scatter {got:?}: {}", at()),
                            ));
                        }
                        if got == e {
                            worst.see(error, || format!("{got:?}, sum {sum}: {}", at()))?;
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
                    if l.value * l.color.iter().sum::<f32>() != 0.0 {
                        return Err(Failure::new(
                            NAME,
                            format!("{lobe:?} is masked, yet scatters {l:?}: {}", at()),
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
                let other = *draws.pick(&masks());
                let common: Vec<Lobe> = Lobe::ALL
                    .into_iter()
                    .filter(|lobe| mask.contains(*lobe) && other.contains(*lobe))
                    .collect();
                let twice = part.with_lobes(other).eval_pdf(wi[0]);
                let once = bsdf.with_lobes(LobeMask::of(&common)).eval_pdf(wi[0]);
                let error = relative(f64::from(twice.pdf), f64::from(once.pdf), 1e-20);
                nested.see(error, || {
                    format!("{twice:?}, at once {once:?}: {} then {other:?}", at())
                })?;
            }
        }
    }
    nested.report()?;
    worst.report()
}
