//! Kajiya and Kay's fibre, the energy-conserving one and d'Eon's far field against their formulas in `f64` at 10,000 random hits each, with
//! grazing directions, offsets at both edges and narrow lobes: every bound is derived, and stated beside it.
//!
//! A direction that is an angle `d` off changes a lobe by `|d ln M / d theta| d`. The highlights are bells, of exponent E in
//! their tails: the derivative of `exp(-E)`, `E = x^2 / 2v`, is `sqrt(2E / v)`. The exponent's own rounding adds a few `E eps`.

use crate::fiber::vary;
use crate::support::{Draws, direction, narrow, packet};
use core::f64::consts::{FRAC_PI_2, PI};
use glam::Vec3;
use hairis::model::{LobeEval, Model};
use hairis::simd::Level;
use hairis::{Bsdf, Eval, Hit, Lobe, Material, PerLobe, Sample};
use hairis_conformance::comparison::{LargestError, relative};
use hairis_reference::{
    ChiangReference, DEonReference, KajiyaKayReference, LobeAt, Reference, Selection,
};
use hairis_variants::chiang::{Chiang, ChiangDesc, ChiangParams, Shifts};
use hairis_variants::kajiya_kay::{Form, KajiyaKayDesc, KajiyaKayParams};
use hairis_variants::{DEon, DEonDesc, DEonParams, KajiyaKay};

const CASES: usize = 10_000;
/// Below this lobes approach the end of `gaussian`, from where on they are 0.
const LEAST: f64 = 1e-22;
/// Rounding of an angle made of a few operations, rad.
const ANGLE: f64 = 1.2e-7;

/// An inclination: a quarter of them within a tenth of the axis, down to 1e-3 rad from it.
fn inclination(draws: &mut Draws) -> f64 {
    let grazing = draws.sign() * (FRAC_PI_2 - draws.scale(1.1e-3, 0.1));
    if draws.below(4) == 0 {
        grazing
    } else {
        draws.between(-FRAC_PI_2 + 1.1e-3, FRAC_PI_2 - 1.1e-3)
    }
}

fn hit(draws: &mut Draws) -> Hit {
    let wo = direction(inclination(draws), draws.between(-PI, PI));
    let h = match draws.below(8) {
        0 => 1.0,
        1 => -1.0,
        2 => narrow(draws.sign() * (1.0 - draws.scale(1e-7, 1e-2))),
        _ => narrow(draws.between(-1.0, 1.0)),
    };
    Hit { wo: wo.into(), h }
}

/// Eight directions: half of them samples, half from anywhere, grazing ones included.
fn directions<M: Model>(
    bsdf: &Bsdf<M>,
    draws: &mut Draws,
) -> ([[f32; 3]; 8], [Option<Sample>; 8], [Vec3; 8]) {
    let xi: [[f32; 3]; 8] = core::array::from_fn(|_| draws.xi3());
    let samples = xi.map(|xi| bsdf.sample(xi));
    let any: [Vec3; 8] =
        core::array::from_fn(|_| direction(inclination(draws), draws.between(-PI, PI)));
    (
        xi,
        samples,
        core::array::from_fn(|k| samples[k].filter(|_| k % 2 == 0).map_or(any[k], |s| s.wi)),
    )
}

fn double(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}

/// The errors of a model over their bounds.
#[derive(Default)]
struct Errors {
    lobes: LargestError,
    sums: LargestError,
    weights: LargestError,
}

impl Errors {
    /// Each lobe to its bound, S and density to theirs.
    fn see_eval(
        &mut self,
        (lobes, evals): (PerLobe<LobeEval>, [Eval; 2]),
        (book, want): (PerLobe<LobeAt<f64>>, ([f64; 3], f64)),
        (bounds, (value, pdf)): ([f64; Lobe::COUNT], ([f64; 3], f64)),
        at: &impl Fn() -> String,
    ) {
        for lobe in Lobe::FOUR {
            let (got, want, bound) = (&lobes[lobe], &book[lobe], bounds[lobe.index()]);
            if want.pdf > LEAST {
                self.lobes
                    .see((f64::from(got.pdf) / want.pdf - 1.0).abs() / bound, || {
                        format!("density of {lobe:?}: {}", at())
                    });
                self.lobes.see(
                    (f64::from(got.value) / want.value - 1.0).abs() / bound,
                    || format!("S of {lobe:?}: {}", at()),
                );
            }
        }
        for got in evals {
            for (c, (&got, &allowed)) in got.value.iter().zip(&value).enumerate() {
                self.sums.see(
                    (f64::from(got) - want.0[c]).abs() / (allowed + LEAST),
                    || format!("S, channel {c}: {}", at()),
                );
            }
            self.sums
                .see((f64::from(got.pdf) - want.1).abs() / (pdf + LEAST), || {
                    format!("density: {}", at())
                });
        }
    }

    /// Weights of samples further than 1e-3 rad from the axis to 1e-4. Where lobes overlap that are narrower than the bounds
    /// allow for, their errors do not cancel: a lobe's changes the weight by the difference of its shares of S and of the density.
    fn see_weight(
        &mut self,
        sample: &Sample,
        (book, (value, pdf)): (PerLobe<LobeAt<f64>>, ([f64; 3], f64)),
        (bounds, shares): ([f64; Lobe::COUNT], PerLobe<f64>),
        at: &impl Fn() -> String,
    ) {
        let cos = f64::from(sample.wi.y).hypot(f64::from(sample.wi.z));
        for (c, (got, value)) in sample.weight.into_iter().zip(value).enumerate() {
            if cos > 1e-3 && value > LEAST {
                let apart = Lobe::FOUR.into_iter().map(|lobe| {
                    let of = &book[lobe];
                    (of.value * of.color[c] / value - of.pdf * shares[lobe] / pdf).abs()
                        * bounds[lobe.index()]
                });
                let allowed = apart.sum::<f64>().max(1e-4);
                self.weights.see(
                    (f64::from(got) * pdf / (value * cos) - 1.0).abs() / allowed,
                    at,
                );
            }
        }
    }

    fn check(self) {
        self.lobes.check("a lobe over its bound", 1.0);
        self.sums.check("S or density over its bound", 1.0);
        self.weights.check("a weight over its bound", 1.0);
    }
}

/// Results of one lane, and of eight.
fn evals<M: Model>(bsdf: &Bsdf<M>, wi: &[Vec3; 8]) -> [[Eval; 2]; 8] {
    let eight = bsdf.with_level(Level::detect()).eval_pdf8(&packet(wi));
    core::array::from_fn(|k| [bsdf.eval_pdf(wi[k]), eight.lane(k)])
}

/// Roughnesses from one end to the other, each end more often than chance.
fn roughness(draws: &mut Draws) -> f32 {
    match draws.below(8) {
        0 => 1e-3,
        1 => 1.0,
        _ => narrow(draws.scale(1e-3, 1.0)),
    }
}

#[test]
fn the_energy_conserving_fibre_is_as_accurate_as_its_widths_allow() {
    let mut draws = Draws(0x12c1);
    let mut errors = Errors::default();
    let (mut attenuation, mut drawn) = (LargestError::default(), LargestError::default());
    for case in 0..CASES {
        let desc = ChiangDesc {
            beta_m: roughness(&mut draws),
            beta_n: roughness(&mut draws),
            tilt: narrow(draws.between(-0.35, 0.35)),
            eta: if case % 2 == 0 {
                1.55
            } else {
                narrow(draws.between(1.0, 4.0))
            },
            sigma_a: draws.xi3().map(|x| 6.0 * x * x),
            shifts: if case % 16 == 0 {
                Shifts::SmallAngle
            } else {
                Shifts::DEon
            },
            ..ChiangDesc::default()
        };
        // Of its own, so that the other cases stay what they were.
        let mut own = Draws(case as u64);
        let desc = if case % 4 == 1 {
            vary(desc, &mut own)
        } else {
            desc
        };
        let params = ChiangParams::new(&desc).unwrap();
        let hit = hit(&mut draws);
        let bsdf = Material::new(&Chiang::MEAN, &params).prepare(hit);
        let p = params.desc().map(f64::from);
        let wo = [hit.wo.x, hit.wo.y, hit.wo.z].map(f64::from);
        let book = ChiangReference::prepare(&p, Selection::Mean, wo, f64::from(hit.h));

        // A passage multiplies by exp(-sigma_a l), whose exponent takes six roundings; up to three passages. Without absorption
        // Fresnel's reflectance, cubed, is off by up to 2.2e-6 in forty seeds.
        for lobe in Lobe::FOUR {
            for c in 0..3 {
                let (got, want) = (f64::from(bsdf.albedo()[lobe][c]), book.albedo()[lobe][c]);
                let depth = lobe.index() as f64 * p.sigma_a[c] * book.path_length();
                if want > LEAST {
                    attenuation.see((got / want - 1.0).abs() / (2.8e-6 + 3.6e-7 * depth), || {
                        format!("{lobe:?} {desc:?} {hit:?}")
                    });
                }
            }
        }
        let shares = book.probabilities();
        let (xi, samples, wi) = directions(&bsdf, &mut draws);
        let bounds_at = |d: [f64; 3]| book.lobe_errors(d).unwrap().0.map(|[value, _]| value);
        for (k, evals) in evals(&bsdf, &wi).into_iter().enumerate() {
            let d = double(wi[k]);
            let bounds = bounds_at(d);
            let at = || format!("{:?} {desc:?} {hit:?}", wi[k]);
            errors.see_eval(
                (bsdf.lobes(wi[k]), evals),
                (book.lobes(d), book.eval_pdf(d)),
                (bounds, book.error_bound(d).unwrap()),
                &at,
            );
            let Some(sample) = &samples[k] else { continue };
            let d = double(sample.wi);
            errors.see_weight(
                sample,
                (book.lobes(d), book.eval_pdf(d)),
                (bounds_at(d), shares),
                &at,
            );
            see_sample(&mut drawn, &book, (wo, xi[k], sample), &at);
        }
    }
    errors.check();
    attenuation.check("an attenuation over its bound", 1.0);
    drawn.check("a sample over its bound", 1.0);
}

/// A sample belongs to numbers that are rounded: its lobe's share of the first by 2e-7 over the share, as the share itself is, and
/// the second by 1.2e-7, and by as much again in its logarithm. The distribution of the azimuth says which number it belongs to.
/// The inclination is smooth, and rounded by up to 6.4e-7 besides.
fn see_sample(
    worst: &mut LargestError,
    book: &ChiangReference<f64>,
    (wo, xi, sample): ([f64; 3], [f32; 3], &Sample),
    at: &impl Fn() -> String,
) {
    let (lobe, shares, [u, v, w]) = (sample.lobe, book.probabilities(), double(sample.wi));
    let before: f64 = shares.0[..lobe.index()].iter().sum();
    let number = (f64::from(xi[0]) - before) / shares[lobe];
    let turn = w.atan2(v) - wo[2].atan2(wo[1]) - book.centre(lobe);
    let of_azimuth = book.cdf_azimuth(lobe, turn - 2.0 * PI * (turn / (2.0 * PI)).round());
    // Both ends of a turn are the same azimuth.
    let off = (of_azimuth - number).abs();
    let cos = v.hypot(w);
    let rounding = 2e-7 / shares[lobe] + 4e-7 + 0.3 * ANGLE / (cos.min(wo[1].hypot(wo[2])));
    let allowed = rounding + book.azimuthal(lobe, turn + book.centre(lobe)) * 1e-6;
    worst.see(off.min((1.0 - off).abs()).abs() / allowed, || {
        format!("azimuth of {sample:?} xi {xi:?}: {}", at())
    });
    let [second, third] = [xi[1], xi[2]].map(f64::from);
    let inclination =
        |by: f64| book.sample_inclination(lobe, (second + by).clamp(0.0, 1.0 - 1e-9), third);
    let [sin, cos_i] = inclination(0.0);
    let reach =
        [-2.4e-7, 2.4e-7].map(|by| (inclination(by)[0] - sin).hypot(inclination(by)[1] - cos_i));
    let off = (u - sin).hypot(cos - cos_i);
    worst.see(off.abs() / (7.5e-7 + reach[0].max(reach[1])), || {
        format!("inclination of {sample:?} xi {xi:?}: {}", at())
    });
}

#[test]
fn kajiya_and_kay_s_fibre_is_as_accurate_as_its_exponent_allows() {
    for form in [Form::Reciprocal, Form::Published] {
        let mut draws = Draws(0x12cc);
        let mut errors = Errors::default();
        let mut plain = LargestError::default();
        for case in 0..CASES / 2 {
            // The exponent's logarithm is uniform; a tenth of them are beyond 1000.
            let exponent = if case % 10 == 0 {
                draws.scale(1e3, 1e4)
            } else {
                draws.scale(1.0, 1e3)
            };
            let kd = draws.xi3().map(|x| 0.02 + x);
            let desc = KajiyaKayDesc {
                kd,
                ks: draws.xi3(),
                exponent: narrow(exponent).clamp(1.0, 1e4),
                form,
            };
            let params = KajiyaKayParams::new(&desc).unwrap();
            let hit = hit(&mut draws);
            let bsdf = Material::new(&KajiyaKay, &params).prepare(hit);
            let wo = [hit.wo.x, hit.wo.y, hit.wo.z].map(f64::from);
            let book = KajiyaKayReference::prepare(&params.desc().map(f64::from), wo);
            let (_, samples, wi) = directions(&bsdf, &mut draws);
            let bounds_at = |d: [f64; 3]| book.lobe_errors(d).unwrap().0.map(|[value, _]| value);
            for (k, evals) in evals(&bsdf, &wi).into_iter().enumerate() {
                let d = double(wi[k]);
                let bounds = bounds_at(d);
                let at = || format!("{:?} {desc:?} {hit:?}", wi[k]);
                let want = book.eval_pdf(d);
                errors.see_eval(
                    (bsdf.lobes(wi[k]), evals),
                    (book.lobes(d), want),
                    (bounds, book.error_bound(d).unwrap()),
                    &at,
                );
                if exponent <= 1000.0 {
                    for got in evals {
                        for c in 0..3 {
                            plain.see(relative(got.value[c], want.0[c], 0.0) / 1e-5, at);
                        }
                        plain.see(relative(got.pdf, want.1, 0.0) / 1e-5, at);
                    }
                }
                if let Some(sample) = &samples[k] {
                    let d = double(sample.wi);
                    let of = (bounds_at(d), book.probabilities());
                    errors.see_weight(sample, (book.lobes(d), book.eval_pdf(d)), of, &at);
                }
            }
        }
        errors.check();
        plain.check("S or density over 1e-5", 1.0);
    }
}

#[test]
fn d_eon_s_far_field_is_as_accurate_as_its_widths_allow() {
    let mut draws = Draws(0xde0);
    let mut errors = Errors::default();
    let mut seen = 0;
    for case in 0..CASES {
        let share = |x: f64| narrow(x * x);
        let desc = DEonDesc {
            roughness: roughness(&mut draws).max(0.01),
            tilt: narrow(draws.between(-0.35, 0.35)),
            eta: if case % 2 == 0 {
                1.55
            } else {
                narrow(draws.between(1.1, 3.0))
            },
            sigma_a: draws.xi3().map(|x| 6.0 * x * x),
            diffuse: if case % 4 < 2 {
                0.0
            } else {
                share(draws.xi().into())
            },
            diffuse_color: draws.xi3(),
        };
        let params = DEonParams::new(&desc).unwrap();
        let mut hit = hit(&mut draws);
        hit.h = 0.0;
        let bsdf = Material::new(&DEon, &params).prepare(hit);
        let wo = [hit.wo.x, hit.wo.y, hit.wo.z].map(f64::from);
        let book = DEonReference::prepare(&params.desc().map(f64::from), wo);
        let (_, samples, mut wi) = directions(&bsdf, &mut draws);
        // Next to half a turn from wo, where R and the diffuse lobe vanish.
        let turn = draws.sign() * (PI - draws.scale(1e-8, 1e-2));
        wi[7] = direction(inclination(&mut draws), wo[2].atan2(wo[1]) + turn);
        let bounds_at = |d: [f64; 3]| Some(book.lobe_errors(d)?.0.map(|[value, _]| value));
        for (k, evals) in evals(&bsdf, &wi).into_iter().enumerate() {
            let d = double(wi[k]);
            // Where rounding decides on which side of TT's last azimuth a direction is, there is no bound.
            let Some(bounds) = bounds_at(d) else { continue };
            seen += 1;
            let at = || format!("{:?} {desc:?} {hit:?}", wi[k]);
            errors.see_eval(
                (bsdf.lobes(wi[k]), evals),
                (book.lobes(d), book.eval_pdf(d)),
                (bounds, book.error_bound(d).unwrap()),
                &at,
            );
            if let Some(sample) = &samples[k] {
                let d = double(sample.wi);
                let Some(bounds) = bounds_at(d) else { continue };
                let of = (bounds, book.probabilities());
                errors.see_weight(sample, (book.lobes(d), book.eval_pdf(d)), of, &at);
            }
        }
    }
    assert!(seen > 79_000, "directions with a bound: {seen}");
    errors.check();
}
