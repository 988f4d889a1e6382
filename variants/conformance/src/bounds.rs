//! Properties of energy and weights: albedo, furnace, bounds of weights, reciprocity.

use crate::cases::Property;
use crate::cases::inputs::Inputs;
use crate::erased::{ErasedBsdf, ErasedSubject, Which};
use crate::failure::{Failure, Outcome, Worst, not_claimed};
use crate::integral::Integral;
use crate::mesh::{Mesh, Samples};
use crate::near::Nearby;
use crate::probe::{Draws, cos_theta, hits_and, some_hits, triples};
use crate::size::cases;
use core::cell::Cell;
use hairis::simd::Level;
use hairis::{Eval, LobeMask};

/// Integrates `S cos theta_i` of one channel over the sphere.
fn reflected(bsdf: &dyn ErasedBsdf, mesh: &Mesh, channel: usize) -> Integral {
    Integral::new(mesh, |wi, out| {
        let mut value = [const { Vec::new() }; 3].map(|mut v: Vec<f32>| {
            v.resize(out.len(), 0.0);
            v
        });
        let written = bsdf
            .with_level(Level::detect())
            .value_array(wi, value.each_mut().map(|v| &mut v[..]));
        assert!(
            written.is_ok(),
            "slices of one length are accepted: {written:?}"
        );
        for (n, x) in out.iter_mut().enumerate() {
            *x = value[channel][n] * wi[1][n].hypot(wi[2][n]);
        }
    })
}

/// Checks that `albedo` of each lobe is the integral of its `S cos theta_i` over the sphere.
///
/// # Errors
///
/// Returns the largest error if the albedo of a lobe is further off than `Claims::albedo` allows.
pub fn albedo_is_the_integral(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "albedo is the integral of S cos theta_i";
    let claims = subject.claims();
    let mut worst = Worst::new(NAME, "albedo (`Claims::albedo`)", claims.albedo);
    let mut samples = Samples::default();
    for material in subject.set(Which::Everyday).iter() {
        let name = material.name();
        for hit in some_hits(material.index()) {
            let bsdf = material.prepare(hit);
            let albedo = bsdf.albedo();
            for lobe in subject.slots() {
                let mask = LobeMask::of(&[lobe]);
                let alone = bsdf.with_lobes(mask);
                let mesh = Mesh::new(subject, material, &hit, &*alone, mask, &mut samples);
                for c in 0..3 {
                    if c > 0 && albedo[lobe][c] == albedo[lobe][c - 1] {
                        continue;
                    }
                    let (got, want) = (
                        f64::from(albedo[lobe][c]),
                        reflected(&*alone, &mesh, c).total(),
                    );
                    // A lobe that lies off the sphere returns next to nothing.
                    worst.see((got - want).abs() / want.max(1e-3), || {
                        let lobe = subject.lobe(lobe);
                        format!("{got}, integral {want}: channel {c} of {lobe}, {name} {hit:?}")
                    });
                }
            }
        }
    }
    worst.report()
}

/// Checks that white materials return all light, if the model claims it: the albedos of the lobes sum to 1, and so does the integral of
/// `S cos theta_i`.
///
/// # Errors
///
/// Returns the largest error if a sum is further off than `Claims::furnace` allows, or a failure if the model makes this claim without a
/// white material.
pub fn white_furnace(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "white materials return all light";
    let Some(tolerance) = subject.claims().furnace else {
        return not_claimed(NAME, "Claims::furnace");
    };
    let white = subject.set(Which::White);
    if white.len() == 0 {
        return Err(Failure::new(
            NAME,
            "the subject has no white material to test it on",
        ));
    }
    let mut worst = Worst::new(NAME, "the sum of albedos (`Claims::furnace`)", tolerance);
    let mut integral = Worst::new(
        NAME,
        "the integral of S cos theta_i (`Claims::furnace`, `Claims::integral`)",
        tolerance.max(subject.claims().integral),
    );
    let (mut draws, mut samples) = (Draws(0xf00d), Samples::default());
    for material in white.iter() {
        let name = material.name();
        for hit in hits_and(cases(100), &mut draws) {
            let albedo = material.prepare(hit).albedo().0;
            for c in 0..3 {
                let sum: f64 = albedo.iter().map(|lobe| f64::from(lobe[c])).sum();
                worst.see((sum - 1.0).abs(), || {
                    format!("{sum}: channel {c}, {name} {hit:?}")
                });
            }
        }
        for hit in some_hits(material.index()) {
            let bsdf = material.prepare(hit);
            let mesh = Mesh::new(subject, material, &hit, &*bsdf, LobeMask::ALL, &mut samples);
            let sum = reflected(&*bsdf, &mesh, 0).total();
            integral.see((sum - 1.0).abs(), || format!("{sum}: {name} {hit:?}"));
        }
    }
    worst.report()?;
    integral.report()
}

/// Checks that no weight, of all lobes and of some, is above the bound that the model states, if it states one.
///
/// # Errors
///
/// Returns a failure if a weight is above its bound.
pub fn weights_are_bounded(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "weights are below their bound";
    let (closest, seen) = (Cell::new(0.0_f64), Cell::new(0_usize));
    let property = Property {
        name: NAME,
        path: "bounds::weights_are_bounded",
        subject,
        which: Which::Everyday,
        inputs: Inputs::Ends,
        tolerances: true,
        cases: 4000,
    };
    property.check([], |trial, []| {
        let mask = trial.lobes;
        let bound = |lane: usize| trial.material(lane).weight_bound(&trial.hits[lane], mask);
        let bounds: [_; 8] = core::array::from_fn(bound);
        for level in Level::available() {
            let each = trial
                .prepare(level, [0, 1, 2, 3, 4, 5, 6, 7])
                .with_lobes(mask);
            let eight = each.with_level(level).sample8(&triples(&trial.xi));
            for (lane, bound) in bounds.into_iter().enumerate() {
                let (Some(s), Some(bound)) = (eight.lane(lane), bound) else {
                    continue;
                };
                let most = f64::from(s.weight.into_iter().fold(0.0, f32::max));
                closest.set(closest.get().max(most / bound));
                seen.set(seen.get() + 1);
                if most > bound * (1.0 + 1e-5) {
                    let (lobes, at) = (subject.lobes(mask), trial.at(lane, level));
                    let message = format!("{most} is above {bound}: {s:?}, {lobes}, {at}");
                    return Err(Failure {
                        excess: most / bound,
                        ..Failure::new(NAME, message)
                    });
                }
            }
        }
        Ok(())
    })?;
    if seen.get() == 0 {
        return not_claimed(NAME, "Subject::weight_bound");
    }
    println!(
        "{NAME}: the largest of {} is {:.3} of its bound",
        seen.get(),
        closest.get()
    );
    Ok(())
}

/// Checks that S is the same with its two directions exchanged, if the model claims it: to the tolerance of the claim beyond what
/// rounding the directions changes.
///
/// # Errors
///
/// Returns a failure if S differs for a pair of directions.
pub fn eval_is_reciprocal(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "S is reciprocal";
    let claims = subject.claims();
    let Some(tolerance) = claims.reciprocal else {
        return not_claimed(NAME, "Claims::reciprocal");
    };
    let quantity = (
        "S with its directions exchanged (`Claims::reciprocal`)",
        tolerance,
    );
    let property = Property {
        name: NAME,
        path: "bounds::eval_is_reciprocal",
        subject,
        which: Which::Everyday,
        inputs: Inputs::Everyday,
        tolerances: true,
        cases: 1500,
    };
    property.check([quantity], |trial, [worst]| {
        for lane in 0..8 {
            let (a, b) = (trial.hits[lane].wo.into(), trial.wi[lane]);
            if cos_theta(a).min(cos_theta(b)) < 1e-3 {
                continue;
            }
            let material = trial.material(lane);
            let here = Nearby::new(material, a.into(), claims.near_field);
            let there = material.prepare(b.into());
            let (forth, back) = (here.bsdf().eval_pdf(b), there.eval_pdf(a));
            // Densities are not reciprocal.
            let error = here.error(Eval { pdf: 0.0, ..back }, Eval { pdf: 0.0, ..forth }, b);
            let at = || format!("{forth:?} and {back:?}: {}", trial.at(lane, "one lane"));
            worst.see(error, at);
        }
        Ok(())
    })
}
