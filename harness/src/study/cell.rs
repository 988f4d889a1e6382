//! One cell of the grid: every sampler of every model under every light.

use super::grid::Cell;
use super::tally::{Figures, Tally, figures};
use super::{Budget, Light5};
use crate::efficiency::{ModelKind, PHI_O_DEG};
use crate::light::Light;
use crate::quadrature::fibre_direction;
use crate::sampler::{Sampler, Scatter, gather};
use crate::sequence::{Independent, XiSource, stream_id};
use hairis::{ParamError, Vec3x8};
use wide::{f32x8, f64x8};

/// What was found of one sampler of one model under one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) figures: Figures,
    /// Largest mean of RGB of a weight, whatever the light.
    pub(super) max_weight: f64,
    /// Largest contribution in means, of the directions of the sampler and of the light.
    pub(super) max_contribution: f64,
}

/// Salt of the study's streams: no other part of the harness draws from them.
const SALT: u64 = 0x57d7_0000_0000_0001;

/// Eight directions drawn from a light.
struct LightDraw {
    wi: Vec3x8,
    /// `cos theta_i` and the radiance, all a mean of RGB needs besides S.
    factor: [f64x8; 3],
    /// The light's density, per steradian.
    pdf: f64x8,
}

/// The figures of a cell: models outermost, then `samplers`, then lights.
///
/// Each sampler's directions are drawn once and weighed by every light; each light's once and weighed by every sampler.
/// The streams are keyed by what the cell is, not by where it stands or who computes it.
pub(super) fn measure(
    seed: u64,
    budget: Budget,
    lights: &Light5<'_>,
    cell: &Cell,
    samplers: &[Sampler],
) -> Result<Vec<Measured>, ParamError> {
    let params = cell.params()?;
    let wo = fibre_direction(f64::from(cell.theta_o_deg).to_radians(), PHI_O_DEG.to_radians()).as_vec3();
    let key = stream_id(&cell.values().map(|value| u64::from(value.to_bits())));
    let stream = |rest: &[u64]| Independent::new(seed, stream_id(&[SALT, key, stream_id(rest)]));

    let draws: Vec<Vec<LightDraw>> = (lights.iter().zip(0..))
        .map(|(light, place)| {
            let packets = if is_drawn(place) { budget.light_samples / 8 } else { 0 };
            let mut from = stream(&[0, place]);
            (0..packets).map(|_| LightDraw::next(*light, &mut from)).collect()
        })
        .collect();
    let mut measured = Vec::with_capacity(ModelKind::ALL.len() * samplers.len() * lights.len());
    for model in ModelKind::ALL {
        for &sampler in samplers {
            let scatter = gather(model, sampler, &params, wo);
            let mut from = stream(&[1, model.index(), sampler.index()]);
            let (tallies, max_weight) = by_sampler(&*scatter, &mut from, budget, lights);
            for (tally, draws) in tallies.into_iter().zip(&draws) {
                let strata = [tally, by_light(&*scatter, draws, budget)];
                let figures = figures(&strata);
                let max_contribution = strata[0].largest().max(strata[1].largest()) / figures.mean.value;
                measured.push(Measured { figures, max_weight, max_contribution });
            }
        }
    }
    Ok(measured)
}

/// Whether directions of the light at this place join those of the sampler: the constant and the smooth light are seen
/// by every direction.
const fn is_drawn(place: u64) -> bool {
    place >= 2
}

/// Tallies of a sampler's directions, a light each, and the largest weight.
fn by_sampler(scatter: &dyn Scatter, from: &mut Independent, budget: Budget, lights: &Light5<'_>) -> ([Tally; 5], f64) {
    let mut tallies = [Tally::default(); 5];
    let mut max_weight = f32x8::ZERO;
    let third = f32x8::splat(1.0 / 3.0);
    let ratios = [0, 1, 2, 3, 4].map(|place| if is_drawn(place) { budget.ratio() } else { f32x8::ZERO });
    for _ in 0..budget.samples / 8 {
        let xi = core::array::from_fn(|_| f32x8::new(core::array::from_fn(|_| from.next_f32())));
        let sample = scatter.sample8(&xi);
        let [r, g, b] = sample.weight.map(|w| w * third);
        max_weight = max_weight.max(r + g + b);
        // A discarded sample has weights of 0: it counts, and contributes 0 whatever the density.
        let pdf = sample.pdf.max(f32x8::splat(f32::MIN_POSITIVE));
        for ((tally, light), ratio) in tallies.iter_mut().zip(lights).zip(ratios) {
            let seen = light.see8(&sample.wi);
            let y = seen.radiance[0] * r + seen.radiance[1] * g + seen.radiance[2] * b;
            tally.push(widened(y), widened(pdf / (pdf + ratio * seen.pdf)));
        }
    }
    let max_weight = max_weight.to_array().into_iter().fold(0.0, f32::max);
    (tallies, f64::from(max_weight))
}

/// The tally of a light's directions.
fn by_light(scatter: &dyn Scatter, draws: &[LightDraw], budget: Budget) -> Tally {
    let mut tally = Tally::default();
    let ratio = widened(budget.ratio());
    for draw in draws {
        let eval = scatter.eval_pdf8(&draw.wi);
        let pdf = widened(eval.pdf);
        let [r, g, b] = [0, 1, 2].map(|c| widened(eval.value[c]) * draw.factor[c]);
        // In double precision: far from the lobes the density alone may be tiny.
        let y = pdf.simd_gt(f64x8::ZERO).select((r + g + b) / pdf, f64x8::ZERO);
        tally.push(y, ratio * pdf / (pdf + ratio * draw.pdf));
    }
    tally
}

impl LightDraw {
    fn next(light: &dyn Light, from: &mut Independent) -> Self {
        let samples: [_; 8] = core::array::from_fn(|_| light.sample(from.next_xi()));
        let factor =
            |lane: usize, c: usize| samples[lane].radiance[c] * samples[lane].dir.y.hypot(samples[lane].dir.z) / 3.0;
        Self {
            wi: samples.map(|sample| sample.dir.as_vec3()).into(),
            factor: core::array::from_fn(|c| f64x8::new(core::array::from_fn(|lane| factor(lane, c)))),
            // What cannot be drawn is dark, and counts nothing either way.
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
    use crate::efficiency::{SAMPLERS, quadrature, sun};
    use crate::light::{Constant, Rectangle, Sky, Smooth};
    use crate::study::Grid;

    const BUDGET: Budget = Budget { samples: 1 << 16, light_samples: 1 << 13 };

    fn cell_of(beta_r_deg: f32, theta_o_deg: f32) -> Cell {
        let is = |cell: &Cell| cell.beta_r_deg == beta_r_deg && cell.theta_o_deg == theta_o_deg;
        (0..Grid::QUICK.len()).map(|i| Grid::QUICK.cell(i)).find(is).expect("in the grid")
    }

    #[test]
    fn figures_agree_with_quadrature() {
        let (constant, smooth, sun, area) = (Constant::white(), Smooth::new(), sun(), Rectangle::figure_6a());
        let lights: Light5<'_> = [&constant, &smooth, &sun, &area, &constant];
        // Narrow hair that hardly meets the sun; the default; wide hair at grazing incidence.
        for (beta_r, theta_o) in [(2.5, 0.0), (7.5, 45.0), (20.0, 85.0)] {
            let cell = cell_of(beta_r, theta_o);
            let params = cell.params().expect("accepted");
            let measured = measure(1, BUDGET, &lights, &cell, &Sampler::ALL).expect("accepted");
            let samplers = Sampler::ALL.len();
            for (m, model) in ModelKind::ALL.into_iter().enumerate() {
                for (l, light) in lights.iter().take(4).enumerate() {
                    let want = quadrature(model, &params, f64::from(theta_o), *light);
                    for (sampler, v) in SAMPLERS.into_iter().zip(want.v) {
                        let found = &measured[(m * samplers + sampler as usize) * 5 + l];
                        let place = format!("{beta_r} {theta_o} {model:?} {} {sampler:?}: {found:?}", light.name());
                        let mean = found.figures.mean.z_score(want.value);
                        assert!(mean.abs() < 5.0, "{place}: mean {} is {mean} errors off", want.value);
                        let z = found.figures.v.z_score(v);
                        assert!(z.abs() < 5.0, "{place}: V {v} is {z} errors off");
                        let error = found.figures.v.standard_error;
                        assert!(error < 0.05 * v, "{place}: an error of {error}");
                    }
                }
            }
        }
    }

    #[test]
    fn figures_depend_on_the_seed_and_the_cell_alone() {
        let sky = Sky::default().environment();
        let (constant, smooth, sun, area) = (Constant::white(), Smooth::new(), sun(), Rectangle::figure_6a());
        let lights: Light5<'_> = [&constant, &smooth, &sun, &area, &sky];
        let budget = Budget { samples: 256, light_samples: 64 };
        let of = |seed, cell: &Cell| measure(seed, budget, &lights, cell, &Sampler::ALL).expect("accepted");
        let cell = cell_of(7.5, 45.0);
        let found = of(1, &cell);
        assert_eq!(found.len(), 2 * Sampler::ALL.len() * 5);
        assert_eq!(found, of(1, &Cell { index: 7, ..cell }), "where the cell stands");
        assert_ne!(found, of(2, &cell), "another seed");
        let alone = measure(1, budget, &lights, &cell, &[Sampler::Ou]).expect("accepted");
        let among = |of: &Measured| found.contains(of);
        assert!(alone.len() == 10 && alone.iter().all(among), "a sampler alone and among others");
    }
}
