//! Verdicts: how far the numbers of a program are from the formulas, and what kind of fault explains them.

use crate::answers::{Answer, Answers, Numbers};
use crate::integrals::{Estimate, by_scene};
use crate::samples::{self, Drawn};
use core::f64::consts::PI;
use core::fmt;
use hairis::Lobe;

/// Share of the largest number of a shading point below which a number is not judged by its ratio.
const FAINT: f64 = 1e-6;
/// Share of all numbers that must agree, so that a few rounded ones decide nothing.
const NEARLY_ALL: [usize; 2] = [99, 100];
/// Standard errors by which an integral must be off, and the part of it, to be reported.
const SURE: f64 = 5.0;
const LEAST: f64 = 0.01;

/// Share of a lobe's density that the other lobes do not have, below which the lobe has no probability of its own.
const SINGULAR: f64 = 1e-12;

/// Verdict on one quantity, which is displayed as a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Name of the quantity.
    pub quantity: String,
    /// Finding about it.
    pub verdict: Verdict,
}

/// Finding about a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Equal to the formulas: the relative error that 99% of the numbers stay below, and the largest.
    Right {
        /// Error of 99% of the numbers.
        most: f64,
        /// Largest error.
        largest: f64,
    },
    /// Density of the lobes of the formulas, with other probabilities: that of another sampler. The relative error that 99% of the numbers
    /// stay below.
    Mixture {
        /// Error of 99% of the numbers.
        most: f64,
    },
    /// Equal to the formulas but for a factor.
    Factor {
        /// Factor in words: a constant, a cosine, or both.
        factor: String,
        /// Relative error of 99% of the numbers without the factor.
        most: f64,
    },
    /// Not explained by a factor: the least, the middle and the largest ratio to the formulas, and the line of the file with the
    /// largest distance.
    Shape {
        /// Ratios.
        ratios: [f64; 3],
        /// Line of the file.
        line: usize,
    },
    /// A density whose integral over the sphere is not 1, in the mean over shading points.
    NotNormalised(Estimate),
    /// More light than arrives, at one shading point.
    TooBright(Estimate),
    /// Samples beside the program's own density.
    Drawn(Drawn),
}

impl Verdict {
    fn is_right(&self) -> bool {
        match self {
            Self::Right { .. } | Self::Mixture { .. } => true,
            Self::Drawn(drawn) => drawn.deviates() < SURE,
            _ => false,
        }
    }
}

impl Line {
    /// Returns true if nothing is wrong.
    #[must_use]
    pub fn is_right(&self) -> bool {
        self.verdict.is_right()
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<16} ", self.quantity)?;
        match &self.verdict {
            Verdict::Right { most, largest } => {
                write!(f, "right within {most:.1e} (largest error {largest:.1e})")
            }
            Verdict::Mixture { most } => write!(
                f,
                "right within {most:.1e} for lobes that are chosen with other probabilities"
            ),
            Verdict::Factor { factor, most } => {
                write!(
                    f,
                    "WRONG by the factor {factor}, else right within {most:.1e}"
                )
            }
            Verdict::Shape {
                ratios: [least, middle, most],
                line,
            } => write!(
                f,
                "WRONG in shape: {least:.3} to {most:.3} times the formulas, {middle:.3} in the middle; furthest in line {line}"
            ),
            Verdict::NotNormalised(Estimate { mean, error }) => {
                write!(
                    f,
                    "WRONG: integrates to {mean:.3} +- {error:.3} over the sphere"
                )
            }
            Verdict::TooBright(Estimate { mean, error }) => {
                write!(f, "WRONG: returns {mean:.3} +- {error:.3} of the light")
            }
            Verdict::Drawn(drawn) => {
                if self.is_right() {
                    write!(f, "right: {drawn}")
                } else {
                    write!(f, "WRONG: {drawn}; {}", drawn.worst)
                }
            }
        }
    }
}

/// Judges every quantity that the answers have. A relative error below `tolerance` is right.
#[must_use]
pub fn judge(answers: &Answers, tolerance: f64) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut add = |quantity: &str, verdict: Option<Verdict>| {
        let quantity = quantity.to_owned();
        lines.extend(verdict.map(|verdict| Line { quantity, verdict }));
    };
    for (place, name) in answers.lobes.iter().enumerate() {
        let pairs = pairs(answers, |numbers| {
            numbers.lobes[place].as_ref().map(|rgb| &rgb[..])
        });
        add(&format!("lobe {name}"), compared(&pairs, tolerance));
    }
    for (place, name) in answers.lobes.iter().enumerate() {
        let pairs = pairs(answers, |numbers| {
            numbers.albedo.get(place)?.as_ref().map(|rgb| &rgb[..])
        });
        add(&format!("albedo {name}"), compared(&pairs, tolerance));
    }
    let value = compared(
        &pairs(answers, |numbers| {
            numbers.value.as_ref().map(|rgb| &rgb[..])
        }),
        tolerance,
    );
    let pdf = compared(
        &pairs(answers, |numbers| {
            numbers.pdf.as_ref().map(core::slice::from_ref)
        }),
        tolerance,
    );
    let pdf = pdf.map(|verdict| {
        let mixture = (!verdict.is_right()).then(|| mixture(answers));
        match mixture.flatten().filter(|most| *most <= tolerance) {
            Some(most) => Verdict::Mixture { most },
            None => verdict,
        }
    });
    let is_wrong = |verdict: &Option<Verdict>| verdict.as_ref().is_some_and(|v| !v.is_right());
    let (bright, sums) = (is_wrong(&value), is_wrong(&pdf));
    add("value", value);
    if bright {
        add("energy", too_bright(answers));
    }
    add("pdf", pdf);
    if sums {
        add("pdf's integral", not_normalised(answers));
    }
    add(
        "samples",
        samples::judge(answers, !sums).map(Verdict::Drawn),
    );
    lines
}

/// Number of a program beside that of the formulas.
struct Pair<'a> {
    got: f64,
    want: f64,
    answer: &'a Answer,
}

/// Returns the pairs of a quantity that are bright enough to be judged.
fn pairs<'a>(answers: &'a Answers, of: impl Fn(&'a Numbers) -> Option<&'a [f64]>) -> Vec<Pair<'a>> {
    let mut all = Vec::new();
    for scene in answers.scenes() {
        let pairs = scene.iter().flat_map(|answer| {
            let [got, want] = [&answer.got, &answer.want].map(&of);
            let both = got.unwrap_or_default().iter().zip(want.unwrap_or_default());
            both.map(move |(got, want)| Pair {
                got: *got,
                want: *want,
                answer,
            })
        });
        let pairs: Vec<_> = pairs.collect();
        let largest = pairs.iter().map(|pair| pair.want).fold(0.0, f64::max);
        let least = (FAINT * largest).max(f64::MIN_POSITIVE);
        all.extend(
            (pairs.into_iter())
                .filter(|pair| pair.want >= least || pair.got.abs() >= 100.0 * least),
        );
    }
    all
}

/// Returns the relative error that nearly all numbers stay below, and the largest.
fn errors(ratios: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut errors: Vec<f64> = ratios.map(|ratio| (ratio - 1.0).abs()).collect();
    errors.sort_by(f64::total_cmp);
    let last = errors.len() - 1;
    [
        errors[(last * NEARLY_ALL[0]).div_ceil(NEARLY_ALL[1])],
        errors[last],
    ]
}

/// Name of a factor that depends on the direction, and its value.
type NamedFactor = (&'static str, fn(&Answer) -> f64);

/// Factors that faults often are, besides constants.
fn factors() -> [NamedFactor; 9] {
    fn cos(v: [f64; 3]) -> f64 {
        v[1].hypot(v[2]).max(1e-9)
    }
    fn cos_d(answer: &Answer) -> f64 {
        let theta = |v: [f64; 3]| v[0].atan2(cos(v));
        (0.5 * (theta(answer.wi) - theta(answer.wo))).cos()
    }
    [
        ("", |_| 1.0),
        ("cos theta_i", |answer| cos(answer.wi)),
        ("1/cos theta_i", |answer| 1.0 / cos(answer.wi)),
        ("cos theta_o", |answer| cos(answer.wo)),
        ("1/cos theta_o", |answer| 1.0 / cos(answer.wo)),
        ("cos theta_d", cos_d),
        ("1/cos theta_d", |answer| 1.0 / cos_d(answer)),
        ("cos^2 theta_d", |answer| cos_d(answer).powi(2)),
        ("1/cos^2 theta_d", |answer| cos_d(answer).powi(-2)),
    ]
}

/// Names a constant, if it is one that faults often are.
fn named(constant: f64, tolerance: f64) -> String {
    let powers = [("", 1.0), ("pi", PI), ("pi^2", PI * PI)];
    for (name, power) in powers {
        for scale in [1.0, 2.0, 4.0, 8.0, 0.5, 0.25, 0.125] {
            for (inverse, x) in [(false, power * scale), (true, scale / power)] {
                if (constant / x - 1.0).abs() > tolerance {
                    continue;
                }
                let (above, below) = if scale < 1.0 {
                    (1.0, 1.0 / scale)
                } else {
                    (scale, 1.0)
                };
                let [top, bottom] = [(above, !inverse), (below, inverse)].map(|(number, here)| {
                    match (number == 1.0, here && !name.is_empty()) {
                        (true, true) => name.to_owned(),
                        (false, true) => format!("{number} {name}"),
                        (_, false) => format!("{number}"),
                    }
                });
                let text = if bottom == "1" {
                    top
                } else if bottom.contains(' ') {
                    format!("{top}/({bottom})")
                } else {
                    format!("{top}/{bottom}")
                };
                return format!("{text} ({constant:.5})");
            }
        }
    }
    format!("{constant:.5}")
}

/// Compares numbers with the formulas; `None` if there are none.
fn compared(pairs: &[Pair<'_>], tolerance: f64) -> Option<Verdict> {
    if pairs.is_empty() {
        return None;
    }
    let ratio = |pair: &Pair<'_>| pair.got / pair.want.max(f64::MIN_POSITIVE);
    let [most, largest] = errors(pairs.iter().map(ratio));
    if most <= tolerance {
        return Some(Verdict::Right { most, largest });
    }
    let middle = |ratios: &mut Vec<f64>| {
        ratios.sort_by(f64::total_cmp);
        ratios[ratios.len() / 2]
    };
    for (name, factor) in factors() {
        let ratios: Vec<f64> = (pairs.iter())
            .map(|pair| ratio(pair) / factor(pair.answer))
            .collect();
        let constant = middle(&mut ratios.clone());
        let [most, _] = errors(ratios.iter().map(|ratio| ratio / constant));
        if most <= tolerance {
            let is_one = (constant - 1.0).abs() <= tolerance && !name.is_empty();
            let factor = match (is_one, name.is_empty()) {
                (true, _) => name.to_owned(),
                (_, true) => named(constant, tolerance),
                _ => format!("{name} times {}", named(constant, tolerance)),
            };
            return Some(Verdict::Factor { factor, most });
        }
    }
    let mut ratios: Vec<f64> = pairs.iter().map(ratio).collect();
    let off = |pair: &Pair<'_>| (pair.got - pair.want).abs() / pair.want.max(f64::MIN_POSITIVE);
    let worst = pairs.iter().max_by(|a, b| off(a).total_cmp(&off(b)))?;
    let middle = middle(&mut ratios);
    Some(Verdict::Shape {
        ratios: [ratios[0], middle, ratios[ratios.len() - 1]],
        line: worst.answer.line,
    })
}

/// Returns the relative error of densities that 99% of the numbers stay below, if the lobes of each shading point have the probabilities that
/// fit best. The probabilities must sum to 1. `None` without enough densities.
fn mixture(answers: &Answers) -> Option<f64> {
    let mut ratios = Vec::new();
    for scene in answers.scenes() {
        // Least squares of relative errors: the equations are those of the lobes' densities over that of the program.
        let mut equations = [[0.0; Lobe::COUNT + 1]; Lobe::COUNT];
        let parts = |answer: &Answer| {
            let pdf = answer.got.pdf?;
            Some(
                answer
                    .lobe_pdfs
                    .map(|lobe| lobe / pdf.max(f64::MIN_POSITIVE)),
            )
        };
        for answer in scene {
            let parts = parts(answer)?;
            for (row, part) in equations.iter_mut().zip(parts) {
                for (sum, other) in row.iter_mut().zip(parts.into_iter().chain([1.0])) {
                    *sum += part * other;
                }
            }
        }
        let probabilities = solved(equations);
        let is_mixture = probabilities.iter().all(|p| *p > -LEAST)
            && (probabilities.iter().sum::<f64>() - 1.0).abs() < LEAST;
        if !is_mixture || scene.len() < 8 {
            return None;
        }
        let mixed = |parts: [f64; Lobe::COUNT]| {
            parts
                .iter()
                .zip(probabilities)
                .map(|(a, p)| a * p)
                .sum::<f64>()
        };
        ratios.extend(scene.iter().filter_map(parts).map(mixed));
    }
    Some(errors(ratios.into_iter().map(|ratio| 1.0 / ratio))[0])
}

/// Solves an equation per lobe, whose matrix is symmetric and not negative, by elimination. A lobe without density of its own gets 0.
fn solved(mut rows: [[f64; Lobe::COUNT + 1]; Lobe::COUNT]) -> [f64; Lobe::COUNT] {
    // Densities of lobes that are hardly ever chosen are many orders of magnitude larger than their mixture: scale all of them to 1.
    let scale: [f64; Lobe::COUNT] =
        core::array::from_fn(|k| rows[k][k].max(f64::MIN_POSITIVE).sqrt());
    for (row, own) in rows.iter_mut().zip(scale) {
        for (x, other) in row.iter_mut().zip(scale.into_iter().chain([1.0])) {
            *x /= own * other;
        }
    }
    for k in 0..Lobe::COUNT {
        let pivot = rows[k];
        for (n, row) in rows.iter_mut().enumerate() {
            let factor = if n == k || pivot[k] < SINGULAR {
                0.0
            } else {
                row[k] / pivot[k]
            };
            for (x, y) in row.iter_mut().zip(pivot) {
                *x -= factor * y;
            }
        }
    }
    core::array::from_fn(|k| {
        let [x, pivot] = [rows[k][Lobe::COUNT], rows[k][k]];
        if pivot < SINGULAR {
            0.0
        } else {
            x / pivot / scale[k]
        }
    })
}

/// Returns the mean of the density's integral over the shading points, if it is not 1. The formulas integrate to 1 and are subtracted, so
/// that a right density has no error. A mean, because the few directions of one shading point may miss a peak.
fn not_normalised(answers: &Answers) -> Option<Verdict> {
    let off = by_scene(answers, |answer| Some(answer.got.pdf? - answer.want.pdf?));
    let count = off.len().max(1) as f64;
    let sum = Estimate {
        mean: 1.0 + off.iter().map(|off| off.mean).sum::<f64>() / count,
        error: off.iter().map(|off| off.error.powi(2)).sum::<f64>().sqrt() / count,
    };
    let is_wrong = sum.away(1.0).abs() > SURE && (sum.mean - 1.0).abs() > LEAST;
    is_wrong.then_some(Verdict::NotNormalised(sum))
}

/// Returns the shading point that returns the most light, if that is more than arrives, and more than the formulas return.
fn too_bright(answers: &Answers) -> Option<Verdict> {
    let light = |of: fn(&Answer) -> &Numbers, rgb: usize| {
        by_scene(answers, move |answer| {
            Some(of(answer).value?[rgb] * answer.wi[1].hypot(answer.wi[2]))
        })
    };
    let channel = |rgb: usize| {
        let formulas = light(|answer| &answer.want, rgb);
        light(|answer| &answer.got, rgb).into_iter().zip(formulas)
    };
    let bright = [0, 1, 2].into_iter().flat_map(channel);
    let bright = bright.filter(|(got, want)| {
        got.away(1.0) > SURE && got.mean > (1.0 + LEAST) * want.mean.max(1.0)
    });
    let most = bright.max_by(|a, b| a.0.mean.total_cmp(&b.0.mean));
    most.map(|(got, _)| Verdict::TooBright(got))
}
