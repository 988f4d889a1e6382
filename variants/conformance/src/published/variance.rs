//! Tests of the relative variance V of one sample under constant light, for every sampler, by quadrature of the kernels' own values and
//! densities over the grid of the efficiency figures.

use super::Tested;
use super::handles::{Sampler, Sampling};
use super::quadrature::{panels, rule};
use super::support::{DEG, direction, double, grid_point, narrow, parameters};
use crate::size::is_full;
use core::array;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::{HairParams, Lobe, LobeMask, PerLobe};
use hairis_reference::{HairFormulas, Reference};

const PHI_O: f64 = 0.4;

/// Function that returns the probabilities of the lobes, by parameters and `theta_o`.
type Shares<'a> = &'a dyn Fn(&HairParams, f64) -> PerLobe<f64>;

/// Returns the probabilities of the lobes with the matched sampler of `bands` bands, or with the published one.
fn shares(
    tested: &Tested,
    bands: Option<usize>,
    params: &HairParams,
    theta_o: f64,
) -> PerLobe<f64> {
    reference(tested, bands, params, double(direction(theta_o, PHI_O))).probabilities()
}

fn reference(
    tested: &Tested,
    bands: Option<usize>,
    params: &HairParams,
    wo: [f64; 3],
) -> Box<dyn Reference<f64>> {
    let formulas = HairFormulas {
        bands,
        ..tested.formulas
    };
    formulas.prepare(&parameters(params, 1.0), wo)
}

/// Quadrature in one angle: its weights, and each lobe's value and density there, with the other angle at a peak.
struct Line {
    weights: Vec<f64>,
    value: [Vec<f64>; 4],
    density: [Vec<f64>; 4],
}

/// Returns `theta` and `phi` where each lobe is large.
fn peaks(params: &HairParams, theta_o: f64) -> PerLobe<[f64; 2]> {
    let p = parameters(params, 1.0);
    let peaks = Lobe::FOUR.map(|lobe| {
        [
            (2.0 * p.alpha[lobe.index().min(2)] - theta_o).clamp(-1.3, 1.3),
            [0.0, PI, 0.0, p.phi_g][lobe.index()],
        ]
    });
    PerLobe::padded(peaks, [0.0; 2])
}

fn line(bsdf: &dyn Sampling, points: &[(f64, f64)], at: impl Fn(Lobe, f64) -> [f64; 2]) -> Line {
    let mut line = Line {
        weights: points.iter().map(|(_, w)| *w).collect(),
        value: Default::default(),
        density: Default::default(),
    };
    for (slot, lobe) in Lobe::FOUR.into_iter().enumerate() {
        for eight in points.chunks(8) {
            // Lanes past the last point repeat the first.
            let angles: [_; 8] = array::from_fn(|i| at(lobe, eight.get(i).unwrap_or(&eight[0]).0));
            let wi = angles.map(|[theta, phi]| direction(theta, PHI_O - phi));
            let found = bsdf.lobes8(&wi.into())[lobe];
            let (value, pdf) = (found.value.to_array(), found.pdf.to_array());
            for (i, [theta, _]) in angles.into_iter().enumerate().take(eight.len()) {
                line.value[slot].push(f64::from(value[i]) * theta.cos().powi(2));
                line.density[slot].push(f64::from(pdf[i]) * theta.cos());
            }
        }
    }
    line
}

/// Returns the line in `theta_i`: values absolute, densities to an integral of 1; the density jumps at `jumps`.
fn inclination(bsdf: &dyn Sampling, params: &HairParams, theta_o: f64, jumps: &[f64]) -> Line {
    let p = parameters(params, 1.0);
    let bell = |l: usize| (2.0 * p.alpha[l] - theta_o, p.beta[l]);
    let pole = FRAC_PI_2 - theta_o;
    let mut ends = panels(
        -FRAC_PI_2 + 1e-5,
        FRAC_PI_2 - 1e-5,
        &[bell(0), bell(1), bell(2), (-FRAC_PI_2, pole)],
    );
    ends.extend(jumps.iter().filter(|x| x.abs() < FRAC_PI_2 - 1e-5));
    ends.sort_by(f64::total_cmp);
    let peaks = peaks(params, theta_o);
    let mut line = line(bsdf, &rule(&ends), |lobe, theta| [theta, peaks[lobe][1]]);
    unit(&mut line.density, &line.weights);
    line
}

/// Returns the line in `phi`: values to a peak of 1, densities to an integral of 1.
fn azimuth(bsdf: &dyn Sampling, params: &HairParams, theta_o: f64) -> Line {
    let p = parameters(params, 1.0);
    let ends = panels(
        0.0,
        PI,
        &[(p.phi_g, p.gamma_g), (PI, p.gamma_tt), (FRAC_PI_2, 1.0)],
    );
    let points: Vec<_> = rule(&ends).into_iter().map(|(x, w)| (x, 2.0 * w)).collect();
    let peaks = peaks(params, theta_o);
    let mut line = line(bsdf, &points, |lobe, phi| [peaks[lobe][0], phi]);
    for lobe in Lobe::FOUR {
        let [theta, phi] = peaks[lobe];
        let top =
            f64::from(bsdf.lobes(direction(theta, PHI_O - phi))[lobe].value) * theta.cos().powi(2);
        line.value[lobe.index()].iter_mut().for_each(|x| *x /= top);
    }
    unit(&mut line.density, &line.weights);
    line
}

fn unit(density: &mut [Vec<f64>; 4], weights: &[f64]) {
    for column in density {
        let sum: f64 = column.iter().zip(weights).map(|(x, w)| x * w).sum();
        column.iter_mut().for_each(|x| *x /= sum);
    }
}

/// Returns V of the mean of RGB.
fn v(long: &Line, round: &Line, params: &HairParams, shares: PerLobe<f64>) -> f64 {
    let d = params.desc();
    let mean = |rgb: [f32; 3]| rgb.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
    let trt = mean(d.i_trt);
    let intensity = [mean(d.i_r), mean(d.i_tt), trt, trt];
    let (mut first, mut second) = (0.0, 0.0);
    for (i, w_i) in long.weights.iter().enumerate() {
        let f: [f64; 4] = array::from_fn(|l| intensity[l] * long.value[l][i]);
        let p: [f64; 4] = array::from_fn(|l| shares.0[l] * long.density[l][i]);
        for (j, w_j) in round.weights.iter().enumerate() {
            let (mut value, mut density) = (0.0, 0.0);
            for l in 0..4 {
                value += f[l] * round.value[l][j];
                density += p[l] * round.density[l][j];
            }
            first += w_i * w_j * value;
            second += w_i * w_j * value * value / density.max(1e-300);
        }
    }
    second / (first * first) - 1.0
}

/// Returns the inclinations where the density of a sampler of `bands` bands jumps, which are the same for all hair.
fn jumps(tested: &Tested, bands: usize) -> Vec<f64> {
    reference(tested, Some(bands), &HairParams::bright(), [0.0, 1.0, 0.0]).jumps()
}

/// Returns V at every point of the grid.
fn over_grid(sampler: &dyn Sampler, shares: Shares<'_>, jumps: &[f64]) -> Vec<f64> {
    let mut all = Vec::new();
    for beta in [2.5, 5.0, 7.5, 10.0, 15.0, 20.0] {
        for degrees in [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0] {
            let theta_o = degrees * DEG;
            let wo = direction(theta_o, PHI_O);
            let mut long: Option<Line> = None;
            for gamma_tt in [5.0, 10.0, 25.0, 45.0] {
                for gamma_g in [5.0, 10.0, 20.0] {
                    for phi_g in [20.0, 35.0, 45.0] {
                        for intensity_g in [0.5, 5.0] {
                            let params = grid_point(beta, gamma_tt, gamma_g, phi_g, intensity_g);
                            let bsdf = sampler.prepare(&params, wo, LobeMask::ALL);
                            let mut line = inclination(&*bsdf, &params, theta_o, jumps);
                            // The strength of the glints is in their value; the rest is the same for all of these.
                            if let Some(long) = &long {
                                line = Line {
                                    density: long.density.clone(),
                                    ..line
                                };
                            }
                            let round = azimuth(&*bsdf, &params, theta_o);
                            all.push(v(&line, &round, &params, shares(&params, theta_o)));
                            long = Some(line);
                        }
                    }
                }
            }
        }
    }
    all
}

/// Returns the mean of V, the geometric mean of its gain over the published sampler, and the least gain.
fn gain(tested: &Tested, bands: usize, published: &[f64], v: &[f64]) -> [f64; 3] {
    let n = narrow(v.len() as f64);
    let mean = |x: &[f64]| x.iter().sum::<f64>() / f64::from(n);
    let logs: Vec<f64> = published
        .iter()
        .zip(v)
        .map(|(published, v)| (published / v).ln())
        .collect();
    let (geometric, least) = (
        mean(&logs).exp(),
        logs.iter().fold(f64::MAX, |a, x| a.min(*x)).exp(),
    );
    let most = v.iter().fold(0.0, |a: f64, x| a.max(*x));
    println!(
        "{:?} {bands} bands: V {:.5} (at most {most:.5}; published {:.4}), gain {geometric:.2}, at least {least:.2}, {} points",
        tested.formulas.shape,
        mean(v),
        mean(published),
        v.len()
    );
    [mean(v), geometric, least]
}

pub fn variance_falls_by_what_is_promised(tested: &Tested) {
    let published = over_grid(
        tested.sampler(None),
        &|params, theta_o| shares(tested, None, params, theta_o),
        &[],
    );
    for (bands, [v, gain_of_mean, least]) in [5, 9, 25].into_iter().zip(tested.rows.gain) {
        // The figures are those of the whole grid. The usual size has them for the number of bands that `Matched` has without another.
        if bands != 9 && !is_full() {
            continue;
        }
        let shares =
            |params: &HairParams, theta_o: f64| shares(tested, Some(bands), params, theta_o);
        let all = over_grid(tested.sampler(Some(bands)), &shares, &jumps(tested, bands));
        let got = gain(tested, bands, &published, &all);
        assert!(
            got[0] <= v && got[1] >= gain_of_mean && got[2] >= least,
            "{got:?}, not {v}, {gain_of_mean}, {least}"
        );
        for (got, [stated, unit]) in got.iter().zip(tested.documented(bands)) {
            let off = (got - stated).abs();
            assert!(
                off <= 0.5 * unit,
                "{bands} bands: {got} is documented as {stated}"
            );
        }
    }
}
