//! One cell of the grid: every sampler of every model under every light.

use super::grid::Cell;
use super::perfect;
use super::rays::{Rays, SIZES};
use super::tally::{Figures, Tally, figures};
use super::{Light5, StudyBudget};
use crate::efficiency::PHI_O_DEG;
use crate::light::Light;
use crate::quadrature::fibre_direction;
use crate::rays::{LightBlocks, unoccluded};
use crate::sampler::{Sampler, Scatter};
use crate::sequence::{Independent, XiSource, stream_id};
use crate::subject::ModelKind;
use hairis::{ParamError, Vec3x8};
use wide::{f32x8, f64x8};

/// Figures of one sampler of one model under one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) figures: Figures,
    /// Largest mean of RGB of a weight, whatever the light.
    pub(super) max_weight: f64,
    /// Largest contribution in means, of the directions of the sampler and of the light.
    pub(super) max_contribution: f64,
    /// Rays of direct light with directions of the sampler and of the light, if they were measured.
    pub(super) rays: Option<Rays>,
}

/// Figures of a cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    /// Of the samplers: models outermost, then samplers, then lights.
    pub(super) samplers: Vec<Measured>,
    /// Of perfect sampling: models, then lights. Empty if the sampler it is estimated from was not measured.
    pub(super) perfect: Vec<Measured>,
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

/// The figures of a cell.
///
/// Each sampler's directions are drawn once and weighed by every light; each light's once and weighed by every sampler.
/// The streams are keyed by what the cell is, not by where it stands or who computes it.
pub(super) fn measure(
    seed: u64,
    budget: StudyBudget,
    lights: &Light5<'_>,
    cell: &Cell,
    samplers: &[Sampler],
) -> Result<Found, ParamError> {
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
    let of_light =
        |(light, place): (&&dyn Light, u64)| LightBlocks::draw(*light, &mut stream(&[2, place]), budget.pools);
    let blocks: Vec<LightBlocks> = lights.iter().zip(0..).map(of_light).collect();
    let mut found = Found { samplers: Vec::new(), perfect: Vec::new() };
    for model in ModelKind::ALL {
        for &sampler in samplers {
            let scatter = Scatter::new(model, sampler, &params, wo);
            let mut from = stream(&[1, model.index(), sampler.index()]);
            let mut perfect = (sampler == perfect::SOURCE).then_some([[perfect::PerfectTally::default(); 2]; 5]);
            let (tallies, max_weight) = by_sampler(&scatter, &mut from, budget, lights, perfect.as_mut());
            for (light, (tally, draws)) in tallies.into_iter().zip(&draws).enumerate() {
                let of_light = perfect.as_mut().map(|perfect| &mut perfect[light][1]);
                let strata = [tally, by_light(&scatter, draws, budget, of_light)];
                let figures = figures(&strata);
                let max_contribution = strata[0].largest().max(strata[1].largest()) / figures.mean.value;
                let rays = (budget.pools > 0).then(|| {
                    let mut from = stream(&[3, model.index(), sampler.index(), light as u64]);
                    unoccluded(&scatter, lights[light], &blocks[light], SIZES, figures.mean, &mut from)
                });
                found.samplers.push(Measured { figures, max_weight, max_contribution, rays });
            }
            found.perfect.extend(perfect.iter().flatten().map(perfect::measured));
        }
    }
    Ok(found)
}

/// Whether directions of the light at this place join those of the sampler: the constant and the smooth light are seen
/// by every direction.
const fn is_drawn(place: u64) -> bool {
    place >= 2
}

/// Tallies of a sampler's directions, a light each, and the largest weight; perfect sampling's first strata on the side.
fn by_sampler(
    scatter: &Scatter,
    from: &mut Independent,
    budget: StudyBudget,
    lights: &Light5<'_>,
    mut perfect: Option<&mut [[perfect::PerfectTally; 2]; 5]>,
) -> ([Tally; 5], f64) {
    let mut tallies = [Tally::default(); 5];
    let mut max_weight = f32x8::ZERO;
    let third = f32x8::splat(1.0 / 3.0);
    let ratios = [0, 1, 2, 3, 4].map(|place| if is_drawn(place) { budget.ratio() } else { f32x8::ZERO });
    for _ in 0..budget.samples / 8 {
        let xi = core::array::from_fn(|_| f32x8::new(core::array::from_fn(|_| from.next_f32())));
        let sample = scatter.sample8(&xi);
        let [r, g, b] = sample.weight.map(|w| w * third);
        let weight = r + g + b;
        max_weight = max_weight.max(weight);
        // A discarded sample has weights of 0: it counts, and contributes 0 whatever the density.
        let pdf = sample.pdf.max(f32x8::splat(f32::MIN_POSITIVE));
        for (place, ((tally, light), ratio)) in tallies.iter_mut().zip(lights).zip(ratios).enumerate() {
            let seen = light.see8(&sample.wi);
            let y = widened(seen.radiance[0] * r + seen.radiance[1] * g + seen.radiance[2] * b);
            let m = widened(pdf / (pdf + ratio * seen.pdf));
            tally.push(y, m);
            if let Some(perfect) = &mut perfect {
                perfect[place][0].push_drawn(widened(weight), y, m);
            }
        }
    }
    let max_weight = max_weight.to_array().into_iter().fold(0.0, f32::max);
    (tallies, f64::from(max_weight))
}

/// The tally of a light's directions; perfect sampling's on the side.
fn by_light(
    scatter: &Scatter,
    draws: &[LightDraw],
    budget: StudyBudget,
    mut perfect: Option<&mut perfect::PerfectTally>,
) -> Tally {
    let mut tally = Tally::default();
    let ratio = widened(budget.ratio());
    for draw in draws {
        let eval = scatter.eval_pdf8(&draw.wi);
        let pdf = widened(eval.pdf);
        let value = eval.value.map(widened);
        let [r, g, b] = [0, 1, 2].map(|c| value[c] * draw.factor[c]);
        // In double precision: far from the lobes the density alone may be tiny.
        let over_pdf = |x: f64x8| pdf.simd_gt(f64x8::ZERO).select(x / pdf, f64x8::ZERO);
        let (y, m) = (over_pdf(r + g + b), ratio * pdf / (pdf + ratio * draw.pdf));
        tally.push(y, m);
        if let Some(perfect) = &mut perfect {
            perfect.push_lit(over_pdf((value[0] + value[1] + value[2]) * draw.cosine), y, m);
        }
    }
    tally
}

impl LightDraw {
    fn next(light: &dyn Light, from: &mut Independent) -> Self {
        let samples: [_; 8] = core::array::from_fn(|_| light.sample(from.next_xi()));
        let cosines = samples.map(|sample| sample.dir.y.hypot(sample.dir.z));
        let factor = |lane: usize, c: usize| samples[lane].radiance[c] * cosines[lane] / 3.0;
        Self {
            wi: samples.map(|sample| sample.dir.as_vec3()).into(),
            cosine: f64x8::new(cosines.map(|cosine| cosine / 3.0)),
            factor: core::array::from_fn(|c| f64x8::new(core::array::from_fn(|lane| factor(lane, c)))),
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
    use crate::efficiency::{SAMPLERS, perfect_v, quadrature, ray_v, sun};
    use crate::light::{Constant, Rectangle, Sky, Smooth};
    use crate::stats::Estimate;
    use crate::study::Grid;

    const BUDGET: StudyBudget = StudyBudget { samples: 1 << 16, light_samples: 1 << 13, pools: 0 };

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
            let found = measure(1, BUDGET, &lights, &cell, &Sampler::ALL).expect("accepted");
            let samplers = Sampler::ALL.len();
            for (m, model) in ModelKind::ALL.into_iter().enumerate() {
                for (l, light) in lights.iter().take(4).enumerate() {
                    let want = quadrature(model, &params, f64::from(theta_o), *light);
                    for (sampler, v) in SAMPLERS.into_iter().zip(want.v) {
                        let found = &found.samplers[(m * samplers + sampler as usize) * 5 + l];
                        let place = format!("{beta_r} {theta_o} {model:?} {} {sampler:?}: {found:?}", light.name());
                        let mean = found.figures.mean.z_score(want.value);
                        assert!(mean.abs() < 5.0, "{place}: mean {} is {mean} errors off", want.value);
                        let z = found.figures.v.z_score(v);
                        assert!(z.abs() < 5.0, "{place}: V {v} is {z} errors off");
                        let error = found.figures.v.standard_error;
                        assert!(error < 0.05 * v, "{place}: an error of {error}");
                    }
                    let (found, v) = (&found.perfect[m * 5 + l], perfect_v(model, &params, f64::from(theta_o), *light));
                    let place = format!("{beta_r} {theta_o} {model:?} {} perfect: {found:?}", light.name());
                    let Estimate { value, standard_error } = found.figures.v;
                    if l == 0 {
                        assert!(v.abs() < 1e-6 && value.abs() < 1e-12 && standard_error < 1e-9, "{place}: V {v}");
                        continue;
                    }
                    let [mean, z] = [found.figures.mean.z_score(want.value), found.figures.v.z_score(v)];
                    assert!(mean.abs() < 5.0, "{place}: mean {} is {mean} errors off", want.value);
                    assert!(z.abs() < 5.0, "{place}: V {v} is {z} errors off");
                    assert!(standard_error < 0.05 * v, "{place}: an error of {standard_error}");
                }
            }
        }
    }

    #[test]
    fn rays_agree_with_quadrature() {
        let (constant, smooth, sun, area) = (Constant::white(), Smooth::new(), sun(), Rectangle::figure_6a());
        let lights: Light5<'_> = [&constant, &smooth, &sun, &area, &constant];
        let budget = StudyBudget { pools: 1024, ..BUDGET };
        for (beta_r, theta_o) in [(7.5, 45.0), (20.0, 85.0)] {
            let cell = cell_of(beta_r, theta_o);
            let params = cell.params().expect("accepted");
            let found = measure(1, budget, &lights, &cell, &SAMPLERS).expect("accepted");
            for (m, model) in ModelKind::ALL.into_iter().enumerate() {
                for (s, sampler) in SAMPLERS.into_iter().enumerate() {
                    for (l, light) in lights.iter().take(4).enumerate() {
                        let rays = found.samplers[(m * SAMPLERS.len() + s) * 5 + l].rays.expect("measured");
                        let [mis, pool] = ray_v(model, &params, f64::from(theta_o), *light, sampler);
                        let place = format!("{beta_r} {theta_o} {model:?} {} {sampler:?}: {rays:?}", light.name());
                        let bias = rays.bias.unwrap_or_else(|| panic!("{place}: no test of the mean"));
                        assert!(bias.abs() < 5.0, "{place}: the mean is {bias} errors off");
                        let sizes = rays.chosen.into_iter().zip(SIZES.map(|count| pool / f64::from(count)));
                        for (v, want) in [(rays.mis, mis)].into_iter().chain(sizes) {
                            let z = v.z_score(want);
                            assert!(z.abs() < 5.0, "{place}: V {want} is {z} errors off");
                            assert!(v.standard_error < 0.1 * want, "{place}: an error of {}", v.standard_error);
                        }
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
        let budget = StudyBudget { samples: 256, light_samples: 64, pools: 4 };
        let of = |seed, cell: &Cell| measure(seed, budget, &lights, cell, &Sampler::ALL).expect("accepted");
        let cell = cell_of(7.5, 45.0);
        let found = of(1, &cell);
        assert_eq!((found.samplers.len(), found.perfect.len()), (2 * Sampler::ALL.len() * 5, 2 * 5));
        assert_eq!(found, of(1, &Cell { index: 7, ..cell }), "where the cell stands");
        assert_ne!(found, of(2, &cell), "another seed");
        let alone = measure(1, budget, &lights, &cell, &[Sampler::Published]).expect("accepted");
        let among = |of: &Measured| found.samplers.contains(of);
        assert!(alone.samplers.len() == 10 && alone.samplers.iter().all(among), "a sampler alone and among others");
        assert_eq!(alone.perfect.len(), 0, "nothing to estimate it from");
        let source = measure(1, budget, &lights, &cell, &[perfect::SOURCE]).expect("accepted");
        assert_eq!(source.perfect, found.perfect, "its source alone");
    }
}
