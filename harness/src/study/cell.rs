//! One cell of the grid: every sampler of every model under every light.

use super::StudyBudget;
use super::grid::Cell;
use super::perfect::{self, PerfectTally};
use super::rays::SIZES;
use super::tally::{Figures, Tally, figures, largest};
use crate::efficiency::PHI_O_DEG;
use crate::rays::{LightBlocks, Lit, Unoccluded, numbers, unoccluded};
use crate::sampler::{Sampler, Scatter};
use crate::subject::ModelKind;
use hairis::{ParamError, Vec3x8};
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::light::Light;
use hairis_instruments::sequence::{Independent, XiSource, stream_id};
use hairis_instruments::stats::Estimate;
use wide::{f32x8, f64x8};

/// Figures of one sampler of one model under one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) figures: Figures,
    /// Largest mean of RGB of a weight, whatever the light.
    pub(super) max_weight: f64,
    /// Its proven bound, where there is one: set when a study is read.
    pub(super) weight_bound: Option<f64>,
    /// Largest contribution in means, of the directions of the sampler and of the light.
    pub(super) max_contribution: f64,
    /// V of one ray of direct light by the estimators of [`RAYS`](super::rays::RAYS), if they were measured.
    pub(super) rays: Option<[Estimate; 3]>,
    /// Bias of the mean of rays from the largest pools, in standard errors; none if there were too few for a test.
    pub(super) bias: Option<f64>,
}

/// Salt of the study's streams: no other part of the harness draws from them.
const SALT: u64 = 0x57d7_0000_0000_0001;

/// Eight directions drawn from a light.
struct LightDraw {
    wi: Vec3x8,
    /// A third of `cos theta_i`, all a mean of RGB needs besides S.
    cosine: f64x8,
    /// `cosine` times the radiance.
    factor: [f64x8; 3],
    /// The light's density, per steradian.
    pdf: f64x8,
}

/// Sums over the sampler's directions and over the light's; for perfect sampling as well where they are its source.
#[derive(Clone)]
struct Strata {
    sampled: [Tally; 2],
    perfect: Option<[PerfectTally; 2]>,
}

/// The figures of a cell: models outermost, then samplers, then lights; after them those of perfect sampling, models, then
/// lights, if the sampler it is estimated from is among `samplers`.
///
/// Each sampler's directions are drawn once and weighed by every light; each light's once and weighed by every sampler.
/// The streams are keyed by what the cell is, not by where it stands or who computes it.
pub(super) fn measure(
    seed: u64,
    budget: StudyBudget,
    lights: &[&dyn Light],
    cell: &Cell,
    samplers: &[Sampler],
) -> Result<Vec<Measured>, ParamError> {
    let params = cell.params()?;
    let wo = fibre_direction(
        f64::from(cell.theta_o_deg).to_radians(),
        PHI_O_DEG.to_radians(),
    )
    .as_vec3();
    let key = stream_id(&cell.values().map(|value| u64::from(value.to_bits())));
    let stream = |rest: &[u64]| Independent::new(seed, stream_id(&[SALT, key, stream_id(rest)]));

    let each_light = || lights.iter().copied().zip(0..);
    let draw = |(light, place): (&dyn Light, u64)| -> Vec<LightDraw> {
        let packets = if is_drawn(place) {
            budget.light_samples / 8
        } else {
            0
        };
        let mut from = stream(&[0, place]);
        (0..packets)
            .map(|_| LightDraw::next(light, &mut from))
            .collect()
    };
    let draws: Vec<Vec<LightDraw>> = each_light().map(draw).collect();
    let draw = |(light, place)| LightBlocks::draw(light, &mut stream(&[2, place]), budget.pools);
    let blocks: Vec<LightBlocks> = each_light().map(draw).collect();
    let (mut found, mut perfect) = (Vec::new(), Vec::new());
    for model in ModelKind::ALL {
        for &sampler in samplers {
            let scatter = Scatter::new(model, sampler, &params, wo);
            let mut from = stream(&[1, model.index(), sampler.index()]);
            let empty = Strata {
                sampled: Default::default(),
                perfect: (sampler == perfect::SOURCE).then(Default::default),
            };
            let mut strata = vec![empty; lights.len()];
            let max_weight = by_sampler(&scatter, &mut from, budget, lights, &mut strata);
            for (light, strata) in strata.iter_mut().enumerate() {
                by_light(&scatter, &draws[light], budget, strata);
                let figures = figures(&strata.sampled);
                let mut of = Measured {
                    figures,
                    max_weight,
                    weight_bound: None,
                    max_contribution: largest(&strata.sampled) / figures.mean.value,
                    rays: None,
                    bias: None,
                };
                if budget.pools > 0 {
                    let mut from = stream(&[3, model.index(), sampler.index(), light as u64]);
                    let lit = Lit {
                        scatter: &scatter,
                        light: lights[light],
                    };
                    let Unoccluded {
                        mis,
                        chosen: [small, large],
                        bias,
                    } = unoccluded(lit, &blocks[light], SIZES, figures.mean, &mut from);
                    (of.rays, of.bias) = (Some([mis, small, large]), bias);
                }
                found.push(of);
                perfect.extend(strata.perfect.as_ref().map(perfect::measured));
            }
        }
    }
    found.append(&mut perfect);
    Ok(found)
}

/// Whether directions of the light at this place join those of the sampler: the constant and the smooth light are seen
/// by every direction.
const fn is_drawn(place: u64) -> bool {
    place >= 2
}

impl Strata {
    /// Adds eight directions of the sampler (0) or of the light (1), of weight `w` and contribution `y`, each counted `m`.
    fn push(&mut self, stratum: usize, w: impl FnOnce() -> f64x8, y: f64x8, m: f64x8) {
        self.sampled[stratum].push(y, m);
        if let Some(perfect) = &mut self.perfect {
            let w = w();
            perfect[stratum].push(if stratum == 0 { w } else { f64x8::ZERO }, w, y, m);
        }
    }
}

/// Adds a sampler's directions to the strata of each light; returns the largest weight.
fn by_sampler(
    scatter: &Scatter,
    from: &mut Independent,
    budget: StudyBudget,
    lights: &[&dyn Light],
    strata: &mut [Strata],
) -> f64 {
    let mut max_weight = f32x8::ZERO;
    let third = f32x8::splat(1.0 / 3.0);
    for _ in 0..budget.samples / 8 {
        let sample = scatter.sample8(&numbers(from));
        let [r, g, b] = sample.weight.map(|w| w * third);
        let weight = r + g + b;
        max_weight = max_weight.max(weight);
        // A discarded sample has weights of 0: it counts, and contributes 0 whatever the density.
        let pdf = sample.pdf.max(f32x8::splat(f32::MIN_POSITIVE));
        for ((strata, light), place) in strata.iter_mut().zip(lights).zip(0..) {
            let seen = light.see8(&sample.wi);
            let ratio = if is_drawn(place) {
                budget.ratio()
            } else {
                f32x8::ZERO
            };
            let y = widened(seen.radiance[0] * r + seen.radiance[1] * g + seen.radiance[2] * b);
            strata.push(
                0,
                || widened(weight),
                y,
                widened(pdf / (pdf + ratio * seen.pdf)),
            );
        }
    }
    f64::from(max_weight.to_array().into_iter().fold(0.0, f32::max))
}

/// Adds a light's directions to its strata.
fn by_light(scatter: &Scatter, draws: &[LightDraw], budget: StudyBudget, strata: &mut Strata) {
    let ratio = widened(budget.ratio());
    for draw in draws {
        let eval = scatter.eval_pdf8(&draw.wi);
        let pdf = widened(eval.pdf);
        let value = eval.value.map(widened);
        let [r, g, b] = [0, 1, 2].map(|c| value[c] * draw.factor[c]);
        // In double precision: far from the lobes the density alone may be tiny.
        let over_pdf = |x: f64x8| pdf.simd_gt(f64x8::ZERO).select(x / pdf, f64x8::ZERO);
        let weight = || over_pdf((value[0] + value[1] + value[2]) * draw.cosine);
        strata.push(
            1,
            weight,
            over_pdf(r + g + b),
            ratio * pdf / (pdf + ratio * draw.pdf),
        );
    }
}

impl LightDraw {
    fn next(light: &dyn Light, from: &mut Independent) -> Self {
        let samples: [_; 8] = core::array::from_fn(|_| light.sample(from.next_xi()));
        let cosines = samples.map(|sample| sample.dir.y.hypot(sample.dir.z));
        let factor = |lane: usize, c: usize| samples[lane].radiance[c] * cosines[lane] / 3.0;
        Self {
            wi: samples.map(|sample| sample.dir.as_vec3()).into(),
            cosine: f64x8::new(cosines.map(|cosine| cosine / 3.0)),
            factor: core::array::from_fn(|c| {
                f64x8::new(core::array::from_fn(|lane| factor(lane, c)))
            }),
            // Directions that cannot be drawn are dark, and contribute nothing either way.
            pdf: f64x8::new(samples.map(|sample| sample.pdf.max(f64::MIN_POSITIVE))),
        }
    }
}

fn widened(x: f32x8) -> f64x8 {
    f64x8::new(x.to_array().map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::efficiency::{SAMPLERS, perfect_v, quadrature, ray_v};
    use crate::lights::lights;
    use crate::study::Grid;
    use hairis_instruments::light::{Constant, Sky};

    const BUDGET: StudyBudget = StudyBudget {
        samples: 1 << 16,
        light_samples: 1 << 13,
        pools: 0,
    };

    fn cell_of(beta_r_deg: f32, theta_o_deg: f32) -> Cell {
        let is = |cell: &Cell| cell.beta_r_deg == beta_r_deg && cell.theta_o_deg == theta_o_deg;
        (0..Grid::QUICK.len())
            .map(|i| Grid::QUICK.cell(i))
            .find(is)
            .expect("in the grid")
    }

    #[test]
    fn figures_agree_with_quadrature() {
        let lights = [lights(None), vec![&Constant]].concat();
        // Narrow hair that hardly meets the sun; the default; wide hair at grazing incidence.
        for (beta_r, theta_o) in [(2.5, 0.0), (7.5, 45.0), (20.0, 85.0)] {
            let cell = cell_of(beta_r, theta_o);
            let params = cell.params().expect("accepted");
            let found = measure(1, BUDGET, &lights, &cell, &Sampler::ALL).expect("accepted");
            let samplers = Sampler::ALL.len();
            for (m, model) in ModelKind::ALL.into_iter().enumerate() {
                for (l, light) in lights.iter().take(4).enumerate() {
                    let want = quadrature(model, &params, f64::from(theta_o), *light);
                    for (sampler, v) in SAMPLERS.into_iter().zip(want.v) {
                        let found = &found[(m * samplers + sampler as usize) * 5 + l];
                        let place = format!(
                            "{beta_r} {theta_o} {model:?} {} {sampler:?}: {found:?}",
                            light.name()
                        );
                        let mean = found.figures.mean.z_score(want.value);
                        assert!(
                            mean.abs() < 5.0,
                            "{place}: mean {} is {mean} errors off",
                            want.value
                        );
                        let z = found.figures.v.z_score(v);
                        assert!(z.abs() < 5.0, "{place}: V {v} is {z} errors off");
                        let error = found.figures.v.standard_error;
                        assert!(error < 0.05 * v, "{place}: an error of {error}");
                    }
                    let found = &found[(ModelKind::ALL.len() * samplers + m) * 5 + l];
                    let v = perfect_v(model, &params, f64::from(theta_o), *light);
                    let place = format!(
                        "{beta_r} {theta_o} {model:?} {} perfect: {found:?}",
                        light.name()
                    );
                    let Estimate {
                        value,
                        standard_error,
                    } = found.figures.v;
                    if l == 0 {
                        assert!(
                            v.abs() < 1e-6 && value.abs() < 1e-12 && standard_error < 1e-9,
                            "{place}: V {v}"
                        );
                        continue;
                    }
                    let [mean, z] = [
                        found.figures.mean.z_score(want.value),
                        found.figures.v.z_score(v),
                    ];
                    assert!(
                        mean.abs() < 5.0,
                        "{place}: mean {} is {mean} errors off",
                        want.value
                    );
                    assert!(z.abs() < 5.0, "{place}: V {v} is {z} errors off");
                    assert!(
                        standard_error < 0.05 * v,
                        "{place}: an error of {standard_error}"
                    );
                }
            }
        }
    }

    #[test]
    fn rays_agree_with_quadrature() {
        let lights = [lights(None), vec![&Constant]].concat();
        let budget = StudyBudget {
            pools: 1024,
            ..BUDGET
        };
        for (beta_r, theta_o) in [(7.5, 45.0), (20.0, 85.0)] {
            let cell = cell_of(beta_r, theta_o);
            let params = cell.params().expect("accepted");
            let found = measure(1, budget, &lights, &cell, &SAMPLERS).expect("accepted");
            for (m, model) in ModelKind::ALL.into_iter().enumerate() {
                for (s, sampler) in SAMPLERS.into_iter().enumerate() {
                    for (l, light) in lights.iter().take(4).enumerate() {
                        let found = &found[(m * SAMPLERS.len() + s) * 5 + l];
                        let [mis, pool] =
                            ray_v(model, &params, f64::from(theta_o), *light, sampler);
                        let place = format!(
                            "{beta_r} {theta_o} {model:?} {} {sampler:?}: {found:?}",
                            light.name()
                        );
                        let bias = found
                            .bias
                            .unwrap_or_else(|| panic!("{place}: no test of the mean"));
                        assert!(bias.abs() < 5.0, "{place}: the mean is {bias} errors off");
                        let sizes = SIZES.map(|count| pool / f64::from(count));
                        for (v, want) in found
                            .rays
                            .expect("measured")
                            .into_iter()
                            .zip([mis, sizes[0], sizes[1]])
                        {
                            let z = v.z_score(want);
                            assert!(z.abs() < 5.0, "{place}: V {want} is {z} errors off");
                            assert!(
                                v.standard_error < 0.1 * want,
                                "{place}: an error of {}",
                                v.standard_error
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn figures_depend_on_the_seed_and_the_cell_alone() {
        let sky = Sky::default().environment();
        let lights = lights(Some(&sky));
        let budget = StudyBudget {
            samples: 256,
            light_samples: 64,
            pools: 4,
        };
        let of = |seed, cell: &Cell| {
            measure(seed, budget, &lights, cell, &Sampler::ALL).expect("accepted")
        };
        let cell = cell_of(7.5, 45.0);
        let found = of(1, &cell);
        let drawn = 2 * Sampler::ALL.len() * 5;
        assert_eq!(found.len(), drawn + 2 * 5);
        assert_eq!(
            found,
            of(1, &Cell { index: 7, ..cell }),
            "where the cell stands"
        );
        assert_ne!(found, of(2, &cell), "another seed");
        let alone = measure(1, budget, &lights, &cell, &[Sampler::Published]).expect("accepted");
        let among = |of: &Measured| found[..drawn].contains(of);
        assert!(alone.iter().all(among), "a sampler alone and among others");
        assert_eq!(
            alone.len(),
            10,
            "perfect sampling has nothing to be estimated from"
        );
        let source = measure(1, budget, &lights, &cell, &[perfect::SOURCE]).expect("accepted");
        assert_eq!(source[10..], found[drawn..], "its source alone");
    }
}
