//! Averages of a material, by quadrature over samples, and the polynomials that are fitted to them.

use super::{QUANTITIES, TERMS};
use crate::columns::SampleColumns;
use crate::model::{Hit, Lobe, Precision};
use crate::simd::Lanes;
use core::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4, PI};
use glam::Vec3;

/// Function that draws samples of one lobe at a hit, with uniform numbers in columns of one length.
pub type Draw<'a> = dyn FnMut(Hit, Lobe, [&[f32]; 3], SampleColumns<'_>) + 'a;

/// Number of inclinations.
const NODES: usize = 24;
/// Number of offsets from the axis.
const OFFSETS: u16 = 16;
/// Number of samples per offset and lobe: points of a lattice of Korobov's.
const POINTS: usize = 307;
/// Steps of the lattice for the three numbers of a sample: powers of 131, which is best by the criterion P2.
const STEPS: [usize; 3] = [1, 131, 276];
/// Shifts of the numbers from one offset to the next, in sixteenths, for a lobe beside four others. Such a lobe is diffuse, scatters alike at all offsets, and
/// takes all three numbers together, for which one lattice is uneven: shifted lattices err by a twentieth.
const SHIFTS: [u16; 3] = [0, 5, 7];
/// Albedo below which moments are those of all scattered light: those of nearly nothing would be noise.
const LEAST_ALBEDO: f32 = 1e-5;

/// Sums of weights and of weighted angles of one side and channel.
#[derive(Clone, Copy, Default)]
struct Sums {
    weight: f32,
    angle: f32,
    square: f32,
}

impl Sums {
    const fn add(&mut self, weight: f32, angle: f32) {
        self.weight += weight;
        self.angle += weight * angle;
        self.square += weight * angle * angle;
    }

    /// Returns the mean of the angle and its variance about it; of all light where this is nearly none.
    fn moments(&self, all: &Self) -> [f32; 2] {
        let of = if self.weight > LEAST_ALBEDO {
            self
        } else {
            all
        };
        // A compiler may divide before it knows whether there is light, and two numbers in the lanes of one vector.
        let weight = of.weight.max(LEAST_ALBEDO);
        let mean = f32::quotient(of.angle, weight);
        let variance = (f32::quotient(of.square, weight) - mean * mean).max(0.0);
        if of.weight > LEAST_ALBEDO {
            [mean, variance]
        } else {
            [0.0, 0.0]
        }
    }
}

/// Draws samples of every lobe at an inclination of the light, rad, and over the fibre's width. Calls `visit` with their directions and with
/// their weights, which sum to the albedo.
///
/// Each lobe is drawn alone, because its weights are smooth functions of the numbers and those of a mixture are not.
fn each_sample(
    theta: f32,
    lobes: usize,
    draw: &mut Draw<'_>,
    visit: &mut dyn FnMut([f32; 3], [f32; 3]),
) {
    let wo = Vec3::new(libm::sinf(theta), libm::cosf(theta), 0.0);
    let shares = (0..OFFSETS).map(|offset| around(offset).1).sum::<f32>();
    let shares = f32::quotient(1.0, shares * POINTS as f32);
    let each = |offset| {
        Lobe::ALL
            .into_iter()
            .take(lobes)
            .map(move |lobe| (offset, lobe))
    };
    for (offset, lobe) in (0..OFFSETS).flat_map(each) {
        let (around, share) = around(offset);
        let share = share * shares;
        let mut xi = [[0.0_f32; POINTS]; 3];
        for ((column, step), shift) in xi.iter_mut().zip(STEPS).zip(SHIFTS) {
            let shift = if lobe.index() < Lobe::FOUR.len() {
                0.0
            } else {
                f32::from(offset * shift % OFFSETS) * (1.0 / OFFSETS as f32)
            };
            for (point, xi) in column.iter_mut().enumerate() {
                // Lattices of other offsets lie between the points of this one.
                let between = (f32::from(offset) + 0.5) / f32::from(OFFSETS);
                // By a product: a quotient is computed in vectors, whose unused lanes divide by 0.
                const BY: f32 = 1.0 / POINTS as f32;
                let place = ((point * step % POINTS) as f32 + between) * BY;
                let place = place + shift;
                let place = if place < 1.0 { place } else { place - 1.0 };
                // As a tent, whose ends meet: a lattice is exact for functions that do not jump there.
                *xi = (1.0 - libm::fabsf(2.0 * place - 1.0)).min(1.0 - f32::EPSILON);
            }
        }
        let (mut wi, mut weight) = ([[0.0_f32; POINTS]; 3], [[0.0_f32; POINTS]; 3]);
        let ([x, y, z], [r, g, b]) = (&mut wi, &mut weight);
        let out = SampleColumns {
            wi: Some([x, y, z]),
            weight: Some([r, g, b]),
            ..SampleColumns::default()
        };
        let hit = Hit::new(wo, libm::sinf(around));
        draw(hit, lobe, xi.each_ref().map(|column| &column[..]), out);
        for point in 0..POINTS {
            // Discarded samples have no weight, and may have no direction.
            if weight.iter().any(|column| column[point] > 0.0) {
                let weight = weight.map(|column| column[point] * share);
                visit(wi.map(|column| column[point]), weight);
            }
        }
    }
}

/// Measures the averages at an inclination of the light, rad, in the order of [`Averages`](super::Averages).
pub(super) fn measure(theta: f32, lobes: usize, draw: &mut Draw<'_>) -> [[f32; 3]; QUANTITIES] {
    let mut sides = [[Sums::default(); 3]; 2];
    let mut azimuth = [[0.0_f32; 3]; 2];
    each_sample(theta, lobes, draw, &mut |[x, y, z], weight| {
        let across = libm::sqrtf(y * y + z * z);
        let angle = libm::atan2f(x, across) + theta;
        let phi = libm::fabsf(libm::atan2f(z, y));
        let (forward, cos) = (phi * FRAC_1_PI, libm::cosf(phi));
        let triple = cos * (4.0 * cos * cos - 3.0);
        for c in 0..3 {
            sides[0][c].add(weight[c] * forward, angle);
            sides[1][c].add(weight[c] * (1.0 - forward), angle);
            azimuth[0][c] += weight[c] * cos;
            azimuth[1][c] += weight[c] * triple;
        }
    });
    let mut out = [[0.0; 3]; QUANTITIES];
    [out[6], out[7]] = azimuth;
    for c in 0..3 {
        let [f, b] = [sides[0][c], sides[1][c]];
        let all = Sums {
            weight: f.weight + b.weight,
            angle: f.angle + b.angle,
            square: f.square + b.square,
        };
        for (side, sums) in [f, b].iter().enumerate() {
            out[side][c] = sums.weight;
            [out[2 + side][c], out[4 + side][c]] = sums.moments(&all);
        }
    }
    out
}

/// Measures the albedo of a material at an inclination of the light, rad, and its share that goes straight on: means over the fibre's width,
/// linear RGB.
///
/// The share is the mean of the albedo times the cosine of the azimuth by which light turns: 1 for light that goes on, and -1 for light that
/// comes back. Takes a quarter of a millisecond. `draw` is that of [`DualScattering::measured`](super::DualScattering::measured).
#[must_use]
#[inline(never)]
pub fn albedo_and_forward(theta: f32, lobes: usize, draw: &mut Draw<'_>) -> [[f32; 3]; 2] {
    // In double precision: inversion stalls on the roundings of twenty thousand sums.
    let mut sums = [[0.0_f64; 3]; 2];
    each_sample(theta, lobes, draw, &mut |[_, y, z], weight| {
        let across = libm::sqrtf(y * y + z * z).max(1e-12);
        // The azimuth of directions, which is half a turn for light that goes on.
        let forward = -f32::quotient(y, across);
        for c in 0..3 {
            sums[0][c] += f64::from(weight[c]);
            sums[1][c] += f64::from(weight[c] * forward);
        }
    });
    sums.map(|sum| sum.map(f64::rounded))
}

/// Returns the angle about the fibre of an offset, whose sine it is, and its share. Angles are denser towards the edges, so that their sum
/// converges fast: Fresnel terms rise there from nearly nothing to 1.
fn around(offset: u16) -> (f32, f32) {
    let place = (2.0 * f32::from(offset) + 1.0) / f32::from(OFFSETS) - 1.0;
    let square = place * place;
    let angle = place * (3.0 - square) * FRAC_PI_4;
    (angle, libm::cosf(angle) * (1.0 - square))
}

/// Fits polynomials to the averages at Chebyshev's nodes: least squares with the weight `1 / sqrt(1 - x^2)`.
pub(super) fn polynomials(lobes: usize, draw: &mut Draw<'_>) -> [[[f32; TERMS]; 3]; QUANTITIES] {
    let mut series = [[[0.0_f32; TERMS]; 3]; QUANTITIES];
    for node in 0..NODES {
        let angle = (node as f32 + 0.5) * (PI / NODES as f32);
        let values = measure(FRAC_PI_2 * libm::cosf(angle), lobes, draw);
        for term in 0..TERMS {
            let scale = if term == 0 { 1.0 } else { 2.0 } / NODES as f32;
            let basis = scale * libm::cosf(term as f32 * angle);
            for (series, values) in series.iter_mut().zip(&values) {
                for c in 0..3 {
                    series[c][term] += basis * values[c];
                }
            }
        }
    }
    series.map(|channels| channels.map(|series| powers(&series)))
}

/// Converts a series of Chebyshev's polynomials to powers.
fn powers(series: &[f32; TERMS]) -> [f32; TERMS] {
    let (mut before, mut here) = ([0.0; TERMS], [0.0; TERMS]);
    let mut sum = [0.0; TERMS];
    (before[0], here[1]) = (1.0, 1.0);
    for coefficient in series {
        let mut next = [0.0; TERMS];
        for power in 0..TERMS {
            sum[power] += coefficient * before[power];
            let shifted = if power > 0 { here[power - 1] } else { 0.0 };
            next[power] = 2.0 * shifted - before[power];
        }
        (before, here) = (here, next);
    }
    sum
}
