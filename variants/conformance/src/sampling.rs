//! A sample reports the value and the density of its direction.

use crate::erased::{ErasedSubject, Which};
use crate::failure::{Failure, Outcome, Worst};
use crate::near::Nearby;
use crate::probe::{Draws, cos_theta, triples};
use hairis::Eval;
use hairis::simd::Level;

/// Hits per material, and packets per hit.
const HITS: usize = 150;
const PACKETS: usize = 4;

/// A sample's value and density are those that evaluation gives at its direction, its weight is `value cos theta_i / pdf`,
/// and its own lobe has a density there: on one lane and on every level.
///
/// # Errors
///
/// At the first sample that reports otherwise.
pub fn samples_agree_with_eval(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "samples agree with evaluation";
    let claims = subject.claims();
    let mut worst = Worst::new(NAME, "value or density of a sample", claims.sample_eval);
    let mut weights = Worst::new(NAME, "weight of a sample", claims.weight);
    let mut draws = Draws(0xa94e);
    let mut live = 0_usize;
    for material in subject.set(Which::Everyday).iter() {
        let name = material.name();
        for _ in 0..HITS {
            let hit = draws.hit();
            let nearby = Nearby::new(material, hit, claims.near_field);
            let bsdf = nearby.bsdf();
            for _ in 0..PACKETS {
                let xi: [[f32; 3]; 8] = core::array::from_fn(|_| draws.xi3());
                let packets = Level::available().flat_map(|level| {
                    let eight = bsdf.with_level(level).sample8(&triples(&xi));
                    (0..8).map(move |lane| (eight.lane(lane), lane, level.name()))
                });
                let scalar = (0..8).map(|lane| (bsdf.sample(xi[lane]), lane, "one lane"));
                for (sample, lane, level) in packets.chain(scalar) {
                    let Some(s) = sample else { continue };
                    live += 1;
                    let wi = s.wi;
                    let cos = cos_theta(wi);
                    let at = || format!("{s:?} {name} {hit:?} xi {:?} {level}", xi[lane]);
                    for (value, weight) in s.value.into_iter().zip(s.weight) {
                        let want = f64::from(value) * cos / f64::from(s.pdf);
                        // A tiny cosine has digits of its own.
                        if cos > 1e-3 {
                            weights.see((f64::from(weight) - want).abs() / want.max(1e-12), at)?;
                        }
                    }
                    if cos < 1e-3 {
                        continue;
                    }
                    let e = bsdf.eval_pdf(wi);
                    let error = nearby.error(
                        Eval {
                            value: s.value,
                            pdf: s.pdf,
                        },
                        e,
                        wi,
                    );
                    worst.see(error, || format!("evaluation gives {e:?}: {}", at()))?;
                    if bsdf.lobes(wi)[s.lobe].pdf <= 0.0 {
                        return Err(Failure::new(
                            NAME,
                            format!("its own lobe has no density there: {}", at()),
                        ));
                    }
                }
            }
        }
    }
    if live == 0 {
        return Err(Failure::new(NAME, "no sample was kept at all"));
    }
    weights.report()?;
    worst.report()
}
