//! Energy and weights: albedo, furnace, bounds of weights, reciprocity.

use crate::erased::{ErasedBsdf, ErasedSubject, Which};
use crate::failure::{Failure, Outcome, Worst};
use crate::integral::Integral;
use crate::mesh::Mesh;
use crate::near::Nearby;
use crate::probe::{Draws, cos_theta, direction, hits, hits_and, masks, triples};
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::simd::Level;
use hairis::{Eval, LobeMask};

/// Integral of `S cos theta_i` of one channel.
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

/// `albedo` of each lobe is the integral of its `S cos theta_i` over the sphere.
///
/// # Errors
///
/// At the first lobe where it is not.
pub fn albedo_is_the_integral(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "albedo is the integral of S cos theta_i";
    let claims = subject.claims();
    let mut worst = Worst::new(NAME, "albedo", claims.albedo);
    for material in subject.set(Which::Everyday).iter() {
        let name = material.name();
        for hit in hits() {
            let bsdf = material.prepare(hit);
            let albedo = bsdf.albedo();
            for lobe in subject.slots() {
                let mask = LobeMask::of(&[lobe]);
                let alone = bsdf.with_lobes(mask);
                let mesh = Mesh::new(subject, material, &hit, &*alone, mask);
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
                        format!("{got}, integral {want}: channel {c} of {lobe:?}, {name} {hit:?}")
                    })?;
                }
            }
        }
    }
    worst.report()
}

/// White materials return all light, where the model claims so: the albedos of the lobes sum to 1, and so does the integral
/// of `S cos theta_i`.
///
/// # Errors
///
/// At the first hit where they do not, or if the model claims it without a white material.
pub fn white_furnace(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "white materials return all light";
    let Some(tolerance) = subject.claims().furnace else {
        return Ok(());
    };
    let white = subject.set(Which::White);
    if white.len() == 0 {
        return Err(Failure::new(
            NAME,
            "the subject has no white material to test it on",
        ));
    }
    let mut worst = Worst::new(NAME, "the sum of albedos", tolerance);
    let mut integral = Worst::new(
        NAME,
        "the integral of S cos theta_i",
        tolerance.max(subject.claims().integral),
    );
    let mut draws = Draws(0xf00d);
    for material in white.iter() {
        let name = material.name();
        for hit in hits_and(100, &mut draws) {
            let albedo = material.prepare(hit).albedo().0;
            for c in 0..3 {
                let sum: f64 = albedo.iter().map(|lobe| f64::from(lobe[c])).sum();
                worst.see((sum - 1.0).abs(), || {
                    format!("{sum}: channel {c}, {name} {hit:?}")
                })?;
            }
        }
        for hit in hits() {
            let bsdf = material.prepare(hit);
            let mesh = Mesh::new(subject, material, &hit, &*bsdf, LobeMask::ALL);
            let sum = reflected(&*bsdf, &mesh, 0).total();
            integral.see((sum - 1.0).abs(), || format!("{sum}: {name} {hit:?}"))?;
        }
    }
    integral.report()?;
    worst.report()
}

/// No weight is above the bound that the model states, for all lobes and for some, where it states one.
///
/// # Errors
///
/// At the first weight above its bound.
pub fn weights_are_bounded(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "weights are below their bound";
    const PACKETS: usize = 64;
    let mut draws = Draws(0xb0d5);
    let masks = masks();
    let (mut closest, mut seen) = (0.0_f64, 0_usize);
    for material in subject.set(Which::Everyday).iter() {
        let name = material.name();
        for (round, hit) in hits_and(50, &mut draws).into_iter().enumerate() {
            let mask = if round % 2 == 0 {
                LobeMask::ALL
            } else {
                masks[round / 2 % 15 + 1]
            };
            let Some(bound) = material.weight_bound(&hit, mask) else {
                continue;
            };
            let bsdf = material.prepare(hit).with_lobes(mask);
            for packet in 0..PACKETS {
                let mut xi: [[f32; 3]; 8] = core::array::from_fn(|_| draws.xi3());
                if packet % 4 == 0 {
                    // The ends of a lobe are where weights are large.
                    xi[packet / 4 % 8][1 + packet % 2] = if packet % 8 == 0 {
                        0.0
                    } else {
                        crate::probe::LAST
                    };
                }
                for level in Level::available() {
                    let eight = bsdf.with_level(level).sample8(&triples(&xi));
                    for s in (0..8).filter_map(|lane| eight.lane(lane)) {
                        let most = s.weight.into_iter().fold(0.0, f32::max);
                        (closest, seen) = (closest.max(f64::from(most) / bound), seen + 1);
                        if f64::from(most) > bound * (1.0 + 1e-5) {
                            let message = format!(
                                "{most} is above {bound}: {s:?} {name} {mask:?} {hit:?} on {level}"
                            );
                            return Err(Failure::new(NAME, message));
                        }
                    }
                }
            }
        }
    }
    if seen > 0 {
        println!("{NAME}: the largest of {seen} is {closest:.3} of its bound");
    }
    Ok(())
}

/// S is the same with its two directions exchanged, where the model claims so: to its tolerance beyond what
/// rounding the directions changes.
///
/// # Errors
///
/// At the first pair of directions where it is not.
pub fn eval_is_reciprocal(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "S is reciprocal";
    let claims = subject.claims();
    let Some(tolerance) = claims.reciprocal else {
        return Ok(());
    };
    let mut worst = Worst::new(NAME, "S with its directions exchanged", tolerance);
    let mut draws = Draws(0x4ec1);
    for material in subject.set(Which::Everyday).iter() {
        let name = material.name();
        for round in 0..2000 {
            let mut any =
                || direction(draws.between(-FRAC_PI_2, FRAC_PI_2), draws.between(-PI, PI));
            let (a, mut b) = (any(), any());
            let here = Nearby::new(material, a.into(), claims.near_field);
            if round % 2 == 0 {
                b = here.bsdf().sample(draws.xi3()).map_or(b, |s| s.wi);
            }
            if cos_theta(a).min(cos_theta(b)) < 1e-3 {
                continue;
            }
            let there = material.prepare(b.into());
            let (forth, back) = (here.bsdf().eval_pdf(b), there.eval_pdf(a));
            // Densities are not reciprocal.
            let error = here.error(Eval { pdf: 0.0, ..back }, Eval { pdf: 0.0, ..forth }, b);
            worst.see(error, || {
                format!("{forth:?} and {back:?}: {name} {a:?} {b:?}")
            })?;
        }
    }
    worst.report()
}
