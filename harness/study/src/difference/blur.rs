//! Blurred functions on the sphere, by spherical harmonics.
//!
//! The blur is the von Mises-Fisher density `exp(kappa cos gamma) kappa / (4 pi sinh kappa)` with `kappa = 1 / sigma^2`: the Gaussian of
//! the sphere, of deviation `sigma` along each of two directions at right angles. A convolution with it multiplies every harmonic of degree
//! l by one number. These numbers fall so fast that degrees beyond [`DEGREE`] are reduced to less than 1e-9. By Parseval's theorem, the
//! error in L2 is the norm of what is left out, and so below that share of the function's own norm.
//!
//! Functions are even in `phi`, so that `cos(m phi)` suffices.

use super::lobes::{BellValues, Rule, TERMS, dot};
use core::f64::consts::{PI, SQRT_2};
use hairis_instruments::quadrature::GaussLegendre;

/// Deviation of the blur along each of two directions, in degrees.
pub const SIGMA_DEG: f64 = 10.0;

/// Highest degree that is kept.
pub const DEGREE: usize = 40;

/// Number of coefficients of even functions up to [`DEGREE`].
const COEFFICIENTS: usize = (DEGREE + 1) * (DEGREE + 2) / 2;

/// Share of each harmonic above [`DEGREE`] that a blur of [`SIGMA_DEG`] leaves, at most.
pub const REST: f64 = 1e-9;

/// Coefficients of a blurred function: orders outermost, degrees from the order upwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonics(Vec<f64>);

/// Blur, with the directions at which blurred functions are evaluated.
#[derive(Debug)]
pub struct Blur {
    /// Factor on each degree.
    factors: Vec<f64>,
    /// Weight and Legendre functions of each latitude.
    latitudes: Vec<(f64, Vec<f64>)>,
    /// `cos(m phi)` for each longitude of a half circle.
    cosines: Vec<[f64; DEGREE + 1]>,
}

/// Returns the orders, each with the range of indices that its degrees have among the coefficients.
fn orders() -> impl Iterator<Item = (usize, core::ops::Range<usize>)> {
    let mut start = 0;
    (0..=DEGREE).map(move |order| {
        let range = start..start + DEGREE + 1 - order;
        start = range.end;
        (order, range)
    })
}

/// Returns the Legendre functions of `sin theta`. They are normalised so that their products with `cos(m phi)` are orthonormal, which
/// includes a factor of the square root of 2 for orders above 0.
fn legendre(theta: f64) -> Vec<f64> {
    let (x, cos_theta) = theta.sin_cos();
    let mut all = vec![0.0; COEFFICIENTS];
    let mut first = (0.25 / PI).sqrt();
    for (order, range) in orders() {
        let m = order as f64;
        if order > 0 {
            first *= cos_theta * ((2.0 * m + 1.0) / (2.0 * m)).sqrt();
        }
        let scale = if order > 0 { SQRT_2 } else { 1.0 };
        let (mut before, mut now) = (0.0, scale * first);
        for (place, degree) in range.zip(order..) {
            all[place] = now;
            // From degree l to l + 1.
            let l = degree as f64;
            let a = ((2.0 * l + 1.0) * (2.0 * l + 3.0) / ((l + 1.0 - m) * (l + 1.0 + m))).sqrt();
            let b = if degree > order {
                ((l - m) * (l + m) / ((2.0 * l - 1.0) * (2.0 * l + 1.0))).sqrt()
            } else {
                0.0
            };
            (before, now) = (now, a * (x * now - b * before));
        }
    }
    all
}

/// Returns the factors of a von Mises-Fisher blur on degrees 0 to `last`: ratios of modified spherical Bessel functions of `kappa`, by
/// downward recurrence.
#[must_use]
pub fn factors(kappa: f64, last: usize) -> Vec<f64> {
    let mut ratio = 0.0;
    let mut ratios = vec![0.0; last + 1];
    for degree in (1..last + 200).rev() {
        ratio = 1.0 / ((2 * degree + 1) as f64 / kappa + ratio);
        if degree <= last {
            ratios[degree] = ratio;
        }
    }
    ratios[0] = 1.0;
    for degree in 1..=last {
        ratios[degree] *= ratios[degree - 1];
    }
    ratios
}

impl Blur {
    /// Prepares a blur of deviation `sigma` (rad), evaluated at `latitudes` by `longitudes` directions of half a sphere.
    #[must_use]
    pub fn new(sigma: f64, latitudes: usize, longitudes: usize) -> Self {
        let rule = GaussLegendre::new(latitudes);
        let weight = 2.0 * PI / longitudes as f64;
        let cosines = |column: usize| {
            let phi = PI * (column as f64 + 0.5) / longitudes as f64;
            core::array::from_fn(|order| (order as f64 * phi).cos())
        };
        Self {
            factors: factors(1.0 / (sigma * sigma), DEGREE),
            latitudes: rule
                .nodes()
                .iter()
                .map(|[x, w]| (w * weight, legendre(x.asin())))
                .collect(),
            cosines: (0..longitudes).map(cosines).collect(),
        }
    }

    /// Returns the harmonics of several functions, blurred.
    #[must_use]
    pub fn harmonics(&self, rule: &Rule, functions: &[BellValues]) -> Vec<Harmonics> {
        let legendre: Vec<Vec<f64>> = rule
            .along
            .iter()
            .map(|[theta, _]| legendre(*theta))
            .collect();
        let add = |sums: &mut [f64; TERMS], factor: f64, values: &[f64; TERMS]| {
            sums.iter_mut()
                .zip(values)
                .for_each(|(sum, value)| *sum += factor * value);
        };
        let blurred = |of: &BellValues| {
            let mut along = vec![[0.0; TERMS]; COEFFICIENTS];
            for (([_, weight], values), legendre) in rule.along.iter().zip(&of.along).zip(&legendre)
            {
                let values = values.map(|value| weight * value);
                along
                    .iter_mut()
                    .zip(legendre)
                    .for_each(|(sums, p)| add(sums, *p, &values));
            }
            let mut around = [[0.0; TERMS]; DEGREE + 1];
            for ([phi, weight], values) in rule.around.iter().zip(&of.around) {
                let sums = around.iter_mut().enumerate();
                sums.for_each(|(order, sums)| {
                    add(sums, weight * (order as f64 * phi).cos(), values)
                });
            }
            let mut coefficients = vec![0.0; COEFFICIENTS];
            for (order, range) in orders() {
                for (place, degree) in range.zip(order..) {
                    coefficients[place] = self.factors[degree] * dot(&along[place], &around[order]);
                }
            }
            Harmonics(coefficients)
        };
        functions.iter().map(blurred).collect()
    }

    /// Returns the values of a blurred function at the directions, one latitude after the other.
    #[must_use]
    pub fn values(&self, of: &Harmonics) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.latitudes.len() * self.cosines.len());
        for (_, legendre) in &self.latitudes {
            let sums = of.on_latitude(legendre);
            values.extend(self.cosines.iter().map(|cosines| dot(cosines, &sums)));
        }
        values
    }

    /// Returns the integral over the sphere of `|a - scale b|`, from values at the directions.
    #[must_use]
    pub fn l1(&self, a: &[f64], b: &[f64], scale: f64) -> f64 {
        let columns = self.cosines.len();
        let rows = a.chunks_exact(columns).zip(b.chunks_exact(columns));
        let row = |(a, b): (&[f64], &[f64])| {
            a.iter()
                .zip(b)
                .map(|(a, b)| (a - scale * b).abs())
                .sum::<f64>()
        };
        self.latitudes
            .iter()
            .zip(rows)
            .map(|((weight, _), rows)| weight * row(rows))
            .sum()
    }
}

impl Harmonics {
    /// Returns the L2 norm of `self - scale other`.
    pub(super) fn l2(&self, other: &Self, scale: f64) -> f64 {
        self.0
            .iter()
            .zip(&other.0)
            .map(|(a, b)| (a - scale * b).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// Returns the L2 norm of the function.
    pub(super) fn norm(&self) -> f64 {
        self.0.iter().map(|c| c * c).sum::<f64>().sqrt()
    }

    /// Returns the integral of the function over the sphere.
    #[must_use]
    pub fn integral(&self) -> f64 {
        self.0[0] * (4.0 * PI).sqrt()
    }

    /// Returns the coefficients of the cosines on a latitude, given the Legendre functions of that latitude.
    fn on_latitude(&self, legendre: &[f64]) -> [f64; DEGREE + 1] {
        let mut sums = [0.0; DEGREE + 1];
        for (order, range) in orders() {
            sums[order] = dot(&legendre[range.clone()], &self.0[range]);
        }
        sums
    }

    /// Returns the blurred function's value in a direction.
    #[must_use]
    pub fn at(&self, theta: f64, phi: f64) -> f64 {
        let sums = self.on_latitude(&legendre(theta));
        (0..)
            .zip(sums)
            .map(|(order, sum)| sum * (f64::from(order) * phi).cos())
            .sum()
    }
}
