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
        (bounds, (value, pdf)): (PerLobe<[f64; 2]>, ([f64; 3], f64)),
        at: &impl Fn() -> String,
    ) {
        for lobe in Lobe::FOUR {
            let (got, want, [of_value, of_pdf]) = (&lobes[lobe], &book[lobe], bounds[lobe]);
            if want.pdf > LEAST {
                self.lobes
                    .see((f64::from(got.pdf) / want.pdf - 1.0).abs() / of_pdf, || {
                        format!("density of {lobe:?}: {}", at())
                    });
                self.lobes.see(
                    (f64::from(got.value) / want.value - 1.0).abs() / of_value,
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
    /// allow for, their errors do not cancel: a lobe's changes the weight by the difference of its shares of S and of the density, and S of a
    /// lobe may be off by more than its density.
    fn see_weight(
        &mut self,
        sample: &Sample,
        (book, (value, pdf)): (PerLobe<LobeAt<f64>>, ([f64; 3], f64)),
        (bounds, shares): (PerLobe<[f64; 2]>, PerLobe<f64>),
        at: &impl Fn() -> String,
    ) {
        let cos = f64::from(sample.wi.y).hypot(f64::from(sample.wi.z));
        for (c, (got, value)) in sample.weight.into_iter().zip(value).enumerate() {
            if cos > 1e-3 && value > LEAST {
                let apart = Lobe::FOUR.into_iter().map(|lobe| {
                    let (of, [of_value, of_pdf]) = (&book[lobe], bounds[lobe]);
                    let share = of.value * of.color[c] / value;
                    (share - of.pdf * shares[lobe] / pdf).abs() * of_pdf
                        + share * (of_value - of_pdf)
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

        let (got, want) = (bsdf.albedo(), book.albedo());
        let allowed = attenuation_errors(&book, &p, (wo[0], f64::from(hit.h)));
        for lobe in Lobe::FOUR {
            for (c, allowed) in allowed[lobe].into_iter().enumerate() {
                let (got, want) = (f64::from(got[lobe][c]), want[lobe][c]);
                if want > LEAST {
                    attenuation.see((got / want - 1.0).abs() / allowed, || {
                        format!("{lobe:?} {desc:?} {hit:?}")
                    });
                }
            }
        }
        let shares = book.probabilities();
        let (xi, samples, wi) = directions(&bsdf, &mut draws);
        let bounds_at = |d: [f64; 3]| book.lobe_errors(d).unwrap();
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
            see_sample(&mut drawn, &book, &allowed, (wo, xi[k], sample), &at);
        }
    }
    errors.check();
    attenuation.check("an attenuation over its bound", 1.0);
    drawn.check("a sample over its bound", 1.0);
}

/// Returns the relative errors that attenuations may have. Fresnel's reflectance is off by up to 1.5e-6, at 2.4 million hits, and a factor of
/// R and TRT, and twice of the rest. A passage multiplies by `exp(-sigma_a l)`, whose exponent takes six roundings, and `l` has the cosines
/// of refracted angles, which amplify those of their sines.
fn attenuation_errors(
    book: &ChiangReference<f64>,
    p: &ChiangDesc<f64>,
    (sin_o, h): (f64, f64),
) -> PerLobe<[f64; 3]> {
    const ROUNDING: f64 = 6e-8;
    let index_sq = p.eta * p.eta;
    let of_sines = [sin_o * sin_o / index_sq, {
        let cos_sq = 1.0 - sin_o * sin_o;
        h * h * cos_sq / (index_sq - sin_o * sin_o)
    }];
    let steep: f64 = of_sines.map(|sq| sq / (1.0 - sq).max(1e-6)).iter().sum();
    let reflections = [1.0, 0.0, 1.0, 2.0];
    let lobes = Lobe::FOUR.map(|lobe| {
        let plain = 1.5e-6 + 1.6e-6 * reflections[lobe.index()];
        p.sigma_a.map(|sigma_a| {
            let depth = lobe.index() as f64 * sigma_a * book.path_length();
            plain + ROUNDING * (6.0 + 4.0 * steep) * depth
        })
    });
    PerLobe::padded(lobes, [0.0; 3])
}

/// A sample belongs to numbers that are rounded: its lobe's share of the first by 2e-7 over the share, and by the errors of this share and
/// of those before it, and the second by 1.2e-7, and by as much again in its logarithm, and the third by 6e-8. The distribution of the azimuth says
/// which number it belongs to. The inclination is smooth, and takes a dozen roundings of 6e-8 in the sine and in the cosine besides.
fn see_sample(
    worst: &mut LargestError,
    book: &ChiangReference<f64>,
    attenuations: &PerLobe<[f64; 3]>,
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
    let albedo = book.albedo();
    let wrong = |lobe: Lobe| {
        let (of, errors) = (albedo[lobe], attenuations[lobe]);
        let sum: f64 = of.iter().sum();
        let wrong: f64 = of.iter().zip(errors).map(|(x, error)| x * error).sum();
        if sum > 0.0 {
            shares[lobe] * wrong / sum
        } else {
            0.0
        }
    };
    let moved: f64 = Lobe::FOUR[..=lobe.index()]
        .iter()
        .map(|lobe| wrong(*lobe))
        .sum();
    let rounding =
        (2e-7 + moved) / shares[lobe] + 4e-7 + 0.3 * ANGLE / (cos.min(wo[1].hypot(wo[2])));
    let allowed = rounding + book.azimuthal(lobe, turn + book.centre(lobe)) * 1e-6;
    worst.see(off.min((1.0 - off).abs()).abs() / allowed, || {
        format!("azimuth of {sample:?} xi {xi:?}: {}", at())
    });
    let [second, third] = [xi[1], xi[2]].map(f64::from);
    let inclination = |[by, turned]: [f64; 2]| {
        book.sample_inclination(lobe, (second + by).clamp(0.0, 1.0 - 1e-9), third + turned)
    };
    let [sin, cos_i] = inclination([0.0; 2]);
    let reach = |moved: [f64; 2]| {
        [moved, moved.map(|by| -by)]
            .map(inclination)
            .map(|[s, c]| (s - sin).hypot(c - cos_i))
            .into_iter()
            .fold(0.0, f64::max)
    };
    let reach = reach([2.4e-7, 0.0]) + reach([0.0, 6e-8]);
    let off = (u - sin).hypot(cos - cos_i);
    worst.see(off / (1e-6 + reach), || {
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
            let bounds_at = |d: [f64; 3]| book.lobe_errors(d).unwrap();
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
        for (k, evals) in evals(&bsdf, &wi).into_iter().enumerate() {
            let d = double(wi[k]);
            // Where rounding decides on which side of TT's last azimuth a direction is, there is no bound.
            let Some(bounds) = book.lobe_errors(d) else {
                continue;
            };
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
                let Some(bounds) = book.lobe_errors(d) else {
                    continue;
                };
                let of = (bounds, book.probabilities());
                errors.see_weight(sample, (book.lobes(d), book.eval_pdf(d)), of, &at);
            }
        }
    }
    assert!(seen > 79_000, "directions with a bound: {seen}");
    errors.check();
}
