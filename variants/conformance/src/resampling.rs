//! Property that resampled estimates of direct light have the mean of plain ones.

use crate::environment::{DOWN, with_mode};
use crate::erased::{ErasedBsdf, ErasedBsdf8, ErasedSubject, Which};
use crate::failure::{Failure, Outcome};
use crate::probe::{Draws, hits8, packet, triples};
use crate::size::cases;
use core::f32::consts::PI;
use glam::Vec3;
use hairis::Hit;
use hairis::model::DynBsdf;
use hairis::resample::{Counts, Partition, Pool, Reservoir8, Weighed8};
use hairis::simd::{Level, f32x8};

const NAME: &str = "resampling is unbiased";
/// Number of estimates per cell with `HAIRIS_CASES=1`, which is large enough to detect estimates that are two percent off, for any seed and
/// number of levels.
const ESTIMATES: usize = 1280;
/// Factor on the number of estimates with which a cell that is too far off is drawn again. Long tails put cells further apart than chance
/// would, because the rarest estimates are missing from the mean and from its error. More estimates make a bias more visible.
const AGAIN: usize = 16;
/// Factor on the number of estimates of a round that is repeated.
const ROUND_AGAIN: usize = 4;
/// Number of standard errors that one cell in 1000 exceeds by chance.
const ONE_IN_1000: f64 = 3.29;

/// Light from a cap about a direction, and from everywhere else.
#[derive(Clone, Copy)]
struct Light {
    axis: Vec3,
    /// Cosine of the cap's radius.
    edge: f32,
    cap: [f32; 3],
    around: [f32; 3],
    /// Probability of drawing from the cap.
    share: f32,
}

impl Light {
    /// Returns five lights: constant, half a sphere, a window, a lamp with a sky, and a lamp alone.
    fn all(draws: &mut Draws) -> [Self; 5] {
        let white = [1.0; 3];
        [
            (-1.0, white, white, 0.5),
            (0.0, [2.0, 1.5, 0.5], [0.1, 0.2, 0.4], 0.5),
            (0.9, [9.0, 8.0, 7.0], [0.2; 3], 0.7),
            (0.998, [500.0, 400.0, 300.0], [0.0, 0.3, 0.6], 0.8),
            (0.98, [20.0, 0.0, 60.0], [0.0; 3], 1.0),
        ]
        .map(|(edge, cap, around, share)| Self {
            axis: draws.direction(),
            edge,
            cap,
            around,
            share,
        })
    }

    /// Returns the radiance from a direction, and the density of drawing that direction.
    fn look_up(&self, wi: Vec3) -> ([f32; 3], f32) {
        let (inside, outside) = (2.0 * PI * (1.0 - self.edge), 2.0 * PI * (1.0 + self.edge));
        if wi.dot(self.axis) >= self.edge {
            (
                self.cap,
                self.share / inside
                    + if self.edge == -1.0 {
                        1.0 - self.share
                    } else {
                        0.0
                    } / inside,
            )
        } else {
            (self.around, (1.0 - self.share) / outside.max(1e-6))
        }
    }

    /// Draws a direction with the density that [`look_up`](Self::look_up) returns.
    fn draw(&self, draws: &mut Draws) -> Vec3 {
        let [which, x, y] = draws.xi3();
        let cos = if which < self.share || self.edge == -1.0 {
            1.0 - x * (1.0 - self.edge)
        } else {
            // Below the edge, which itself belongs to the cap.
            (self.edge - (1.0 - x) * (1.0 + self.edge)).max(-1.0)
        };
        let (sin, (sin_phi, cos_phi)) =
            ((1.0 - cos * cos).max(0.0).sqrt(), (2.0 * PI * y).sin_cos());
        let (a, b) = self.axis.any_orthonormal_pair();
        (a * (sin * cos_phi) + b * (sin * sin_phi) + self.axis * cos).normalize()
    }
}

/// Returns the visibility of the light behind other hair, which blocks every second one of some cells.
fn visible(wi: Vec3) -> f64 {
    let cells = (wi * 3.0 + Vec3::splat(10.0)).floor();
    if (cells.x + cells.y + cells.z) % 2.0 < 1.0 {
        1.0
    } else {
        0.0
    }
}

/// Returns the mean over the channels.
fn mean(rgb: [f32; 3]) -> f64 {
    rgb.into_iter().map(f64::from).sum::<f64>() / 3.0
}

/// One-sample estimates of the reflected light by both techniques at once, in double precision and without a pool.
struct Plain<'a> {
    bsdf: &'a dyn ErasedBsdf,
    light: Light,
}

impl Plain<'_> {
    /// Returns `f V`, and the densities of the BSDF and of the light.
    fn terms(&self, wi: Vec3) -> [f64; 3] {
        let (radiance, pdf_light) = self.light.look_up(wi);
        let eval = self.bsdf.eval_pdf(wi);
        let cos = f64::from(wi.y).hypot(f64::from(wi.z));
        let f = (0..3)
            .map(|c| f64::from(eval.value[c]) * f64::from(radiance[c]))
            .sum::<f64>()
            / 3.0;
        [
            f * cos * visible(wi),
            f64::from(eval.pdf),
            f64::from(pdf_light),
        ]
    }

    fn estimate(&self, draws: &mut Draws) -> f64 {
        let over = |[f, bsdf, light]: [f64; 3]| if f > 0.0 { f / (bsdf + light) } else { 0.0 };
        let from_bsdf = self
            .bsdf
            .sample(draws.xi3())
            .map_or(0.0, |sample| over(self.terms(sample.wi)));
        from_bsdf + over(self.terms(self.light.draw(draws)))
    }

    /// Estimates the light by resampling from a pool of at most 16 candidates.
    fn pooled(&self, counts: Counts, partition: Partition, k: u32, draws: &mut Draws) -> f64 {
        let mut pool = Pool::<16>::new(counts, partition).expect("16 candidates at most");
        let xi: Vec<[f32; 3]> = (0..counts.bsdf).map(|_| draws.xi3()).collect();
        let xi = [0, 1, 2].map(|axis| xi.iter().map(|xi| xi[axis]).collect::<Vec<_>>());
        let bsdf: &dyn DynBsdf = self.bsdf;
        pool.propose(bsdf, xi.each_ref().map(|column| &column[..]))
            .expect("of one length");
        for i in 0..counts.light as usize {
            let wi = self.light.draw(draws);
            let (radiance, pdf) = self.light.look_up(wi);
            pool.set_light(i, wi, radiance, pdf);
        }
        pool.look_up(|wi| self.light.look_up(wi));
        pool.weigh(bsdf);
        let chosen: Vec<_> = pool.choose(k, draws.xi()).collect();
        let count: u32 = chosen.iter().map(|(_, choice)| choice.count).sum();
        assert!(chosen.is_empty() || count == k, "{count} of {k} choices");
        chosen
            .iter()
            .map(|(wi, choice)| visible(*wi) * mean(choice.contribution))
            .sum()
    }

    /// Estimates the light's share by resampling, and the rest from the light that a path's next direction meets.
    fn path(&self, partition: Partition, draws: &mut Draws) -> f64 {
        let direct = self.pooled(Counts { bsdf: 0, light: 8 }, partition, 1, draws);
        let Some(next) = self.bsdf.sample(draws.xi3()) else {
            return direct;
        };
        let ([f, bsdf, _], (_, pdf_light)) = (self.terms(next.wi), self.light.look_up(next.wi));
        let rest = 1.0 - f64::from(partition.light_share(pdf_light, next.pdf));
        direct + if f > 0.0 { rest * f / bsdf } else { 0.0 }
    }
}

/// Estimates the light at eight hits with a reservoir each, whose candidates are divided between two reservoirs that are merged.
fn reservoirs(bsdf: &dyn ErasedBsdf8, light: Light, level: Level, draws: &mut Draws) -> [f64; 8] {
    let counts = Counts { bsdf: 4, light: 4 };
    let mut kept = [Reservoir8::default().with_level(level); 2];
    for i in 0..8 {
        let wi = if i < 4 {
            let sample = bsdf.sample8(&triples(&core::array::from_fn(|_| draws.xi3())));
            packet(&core::array::from_fn(|lane| {
                sample.lane(lane).map_or(Vec3::ZERO, |sample| sample.wi)
            }))
        } else {
            packet(&core::array::from_fn(|_| light.draw(draws)))
        };
        let found: [([f32; 3], f32); 8] = core::array::from_fn(|lane| light.look_up(wi.lane(lane)));
        let (radiance, pdf) = (
            triples(&found.map(|(rgb, _)| rgb)),
            f32x8::new(found.map(|(_, pdf)| pdf)),
        );
        let (eval, cos) = (bsdf.eval_pdf8(&wi), wi.cos_theta());
        let weighed = Weighed8::new(&eval, &cos, &radiance, &pdf, counts, Partition::All);
        kept[i % 2].add(
            &wi,
            &weighed,
            &f32x8::new(core::array::from_fn(|_| draws.xi())),
        );
    }
    let [mut all, other] = kept;
    all.merge(&other, &f32x8::new(core::array::from_fn(|_| draws.xi())));
    let light = all.estimate();
    core::array::from_fn(|lane| {
        visible(all.wi.lane(lane)) * mean(light.map(|c| c.as_array()[lane]))
    })
}

/// Sums of estimates and of their squares.
#[derive(Clone, Copy, Default)]
struct Sums {
    n: f64,
    sum: f64,
    squares: f64,
}

impl Sums {
    fn of(count: usize, mut estimate: impl FnMut() -> f64) -> Self {
        let mut sums = Self::default();
        (0..count).for_each(|_| sums.add(estimate()));
        sums
    }

    fn add(&mut self, x: f64) {
        self.n += 1.0;
        self.sum += x;
        self.squares += x * x;
    }

    /// Returns the mean and its variance.
    fn mean(&self) -> [f64; 2] {
        let mean = self.sum / self.n;
        [
            mean,
            (self.squares / self.n - mean * mean).max(0.0) / self.n,
        ]
    }
}

/// Checks that resampled estimates have the mean of plain ones under five lights, partly hidden. The estimates come from pools with one
/// and with several rays, from both partitions with the path's next direction, and from merged reservoirs of eight hits on every level.
///
/// A round that is less probable than 0.002 is repeated with other numbers, and with four times as many estimates: a sound model fails with
/// a probability of 4e-6.
///
/// # Errors
///
/// Returns a failure if more cells differ than chance allows, if all are off to one side on average, or if an estimate is negative or not
/// finite.
pub fn resampling_is_unbiased(subject: &dyn ErasedSubject) -> Outcome {
    any_rounding_is_finite(subject)?;
    check(subject, 1.0)
}

/// Checks estimates that are multiplied by `factor`, so that tests can introduce a bias.
///
/// # Errors
///
/// Returns a failure if more cells differ than chance allows, or if all are off to one side on average.
#[doc(hidden)]
pub fn check(subject: &dyn ErasedSubject, factor: f64) -> Outcome {
    let faults = round(subject, factor, 1, 0x2e5a)
        .and_then(|first| Some([first, round(subject, factor, ROUND_AGAIN, 0xa9a1)?]));
    faults.map_or(Ok(()), |faults| Err(Failure::new(NAME, faults.join("; "))))
}

/// Returns what is wrong with a round of `times` as many estimates, if anything is.
fn round(subject: &dyn ErasedSubject, factor: f64, times: usize, seed: u64) -> Option<String> {
    let mut draws = Draws(seed);
    let mut errors: Vec<f64> = Vec::new();
    let set = subject.set(Which::Everyday);
    for index in 0..set.len() {
        let hits: [Hit; 8] = core::array::from_fn(|_| draws.hit());
        for light in Light::all(&mut draws) {
            // Adds the error of a cell: its resampled estimates, computed from their number, against plain ones.
            let mut cell =
                |hit: Hit, draws: &mut Draws, resampled: &dyn Fn(usize, &mut Draws) -> Sums| {
                    let bsdf = set.prepare(index, hit);
                    let apart = |count: usize, draws: &mut Draws| {
                        let resampled = resampled(count, draws);
                        // Each cell has samples of its own, so that the cells' errors are independent.
                        let plain = Sums::of(4 * count, || {
                            Plain {
                                bsdf: &*bsdf,
                                light,
                            }
                            .estimate(draws)
                        });
                        let ([a, a_var], [b, b_var]) = (resampled.mean(), plain.mean());
                        let error = (a_var + b_var).sqrt();
                        // Estimates without any spread, and hits that receive next to nothing, are left out.
                        (error > 1e-5 * b.abs() && b > 0.0).then(|| (factor * a - b) / error)
                    };
                    let first = apart(times * cases(ESTIMATES), draws);
                    let far = first.is_some_and(|z| z.abs() > ONE_IN_1000);
                    errors.extend(if far {
                        apart(AGAIN * times * cases(ESTIMATES), draws)
                    } else {
                        first
                    });
                };
            for (n, hit) in hits.into_iter().enumerate() {
                let bsdf = set.prepare(index, hit);
                let one = Plain {
                    bsdf: &*bsdf,
                    light,
                };
                let estimate = |draws: &mut Draws| match n % 4 {
                    0 => one.pooled(Counts { bsdf: 4, light: 4 }, Partition::All, 1, draws),
                    1 => one.pooled(Counts { bsdf: 6, light: 10 }, Partition::All, 4, draws),
                    2 => one.path(Partition::Balance, draws),
                    _ => one.path(Partition::Power, draws),
                };
                cell(hit, &mut draws, &|count, draws| {
                    Sums::of(count, || estimate(draws))
                });
            }
            for (level, lane) in Level::available().zip(0..) {
                let bsdf = set.prepare8(index, level, &hits8(&hits));
                cell(hits[lane], &mut draws, &|count, draws| {
                    Sums::of(count, || reservoirs(&*bsdf, light, level, draws)[lane])
                });
            }
        }
    }
    let (n, apart) = (
        errors.len() as f64,
        errors.iter().filter(|z| z.abs() > ONE_IN_1000).count(),
    );
    let aside = errors.iter().sum::<f64>() / n.sqrt();
    // By Poisson's law: 1e-3 of the cells, and as many more as chance exceeds once in 1000.
    let allowed = 2.0 + 1e-3 * n + 3.1 * (1e-3 * n).sqrt();
    let off = apart as f64 > allowed || aside.abs() > ONE_IN_1000;
    off.then(|| {
        format!(
            "{apart} of {n} cells are {ONE_IN_1000} standard errors apart, all on average {aside:.2}"
        )
    })
}

/// Checks that estimates are finite and not negative if the host rounds down and takes denormals for 0.
fn any_rounding_is_finite(subject: &dyn ErasedSubject) -> Outcome {
    let mut draws = Draws(0xd0);
    let set = subject.set(Which::Everyday);
    for index in 0..set.len() {
        let name = set.name(index);
        let hits: [Hit; 8] = core::array::from_fn(|_| draws.hit());
        for light in Light::all(&mut draws) {
            let estimates = with_mode(DOWN, || {
                let one = Plain {
                    bsdf: &*set.prepare(index, hits[0]),
                    light,
                };
                let mut all =
                    vec![one.pooled(Counts { bsdf: 6, light: 10 }, Partition::All, 4, &mut draws)];
                all.push(one.path(Partition::Power, &mut draws));
                for level in Level::available() {
                    let bsdf = set.prepare8(index, level, &hits8(&hits));
                    all.extend(reservoirs(&*bsdf, light, level, &mut draws));
                }
                all
            });
            if !estimates.iter().all(|x| x.is_finite() && *x >= 0.0) {
                return Err(Failure::new(
                    NAME,
                    format!("{name} {hits:?}, rounded down: {estimates:?}"),
                ));
            }
        }
    }
    Ok(())
}
