//! Fit of a material's albedo. It is made once per material, in eight lanes that never fuse, so that it has the same bits
//! everywhere.

use super::{AlbedoFit, HairLobes, PIECES, POWERS, Warp};
use crate::hair::albedo::channels;
use crate::hair::prepare_view;
use crate::model::Bell;
use crate::simd::portable::Unfused;
use crate::simd::storage::{ENTRIES, NUMBERS};
use crate::simd::table::Table;
use crate::simd::{Broadcast, LaneStruct, Lanes, Path, Scalar, Vec3x};
use core::f32::consts::{FRAC_PI_2, PI};
use wide::f32x8;

/// Number of inclinations per piece, one per lane.
const NODES: usize = 8;

/// Warps to try, given by `near`; the first suits everyday hair.
const NEAR: [f32; 6] = [0.5, 0.38, 0.8, 0.25, 1.5, 100.0];

/// Largest error of a fit in use at the points that are tested, relative to the albedo after scaling. Between them it is below 1e-3.
const ACCEPTED: f32 = 7e-4;

/// Width of a lobe, rad, below which the end of its range is tested separately, and the positions of these tests in widths from the
/// end.
const NARROW: f32 = 0.05;
const WIDTHS: [f32; 8] = [-16.0, -4.0, -1.6, -0.5, 0.5, 1.6, 4.0, 16.0];

/// Least factor on colours that is fitted, which is that of an albedo of 1,000: the fit is of the distance from 1.
const LEAST: f32 = 1e-3;

/// Table of `cos(k pi / 16)`, for `k` from 0 to 8.
const COS: [f32; 9] = [
    1.0,
    0.980_785_25,
    0.923_879_5,
    0.831_469_6,
    0.707_106_77,
    0.555_570_24,
    0.382_683_43,
    0.195_090_32,
    0.0,
];

/// Returns `cos(k pi / 16)` for any `k`.
const fn cosine(k: usize) -> f32 {
    let k = k % 32;
    let k = if k > 16 { 32 - k } else { k };
    if k > 8 { -COS[16 - k] } else { COS[k] }
}

/// Returns the cosines of eight angles in steps of `pi / 8` from `first * pi / 16`.
const fn cosines(first: usize) -> [f32; NODES] {
    let mut eight = [0.0; NODES];
    let mut i = 0;
    while i < NODES {
        eight[i] = cosine(2 * i + first);
        i += 1;
    }
    eight
}

/// Nodes of a piece in `[-1, 1]`, descending: the roots of the Chebyshev polynomial of degree 8.
const ROOTS: [f32; NODES] = cosines(1);

/// Extremes of that polynomial, descending, without -1. They lie between the nodes.
const EXTREMES: [f32; NODES] = cosines(0);

/// Returns `1 / albedo - 1`; for albedos below 1 its series about 1, which has no pole.
fn excess(albedo: f32) -> f32 {
    let e = albedo - 1.0;
    if e > 0.0 {
        f32::quotient(-e, albedo)
    } else {
        e * (e * (e * (e - 1.0) + 1.0) - 1.0)
    }
}

/// Computes the Chebyshev coefficients of the polynomial through the values at the roots.
fn chebyshev(values: &[f32; NODES]) -> [f32; NODES] {
    let mut coefficients = [0.0; NODES];
    for (degree, coefficient) in coefficients.iter_mut().enumerate() {
        let mut sum = 0.0;
        for (i, value) in values.iter().enumerate() {
            sum += value * cosine(degree * (2 * i + 1));
        }
        *coefficient = sum * if degree == 0 { 0.125 } else { 0.25 };
    }
    coefficients
}

/// Returns the least value of a polynomial on `[-1, 1]`, at 17 points; NaN if a value is NaN.
fn least(coefficients: &[f32; POWERS]) -> f32 {
    let mut least = f32::MAX;
    for k in 0..=16 {
        let t = cosine(k);
        let value = coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c);
        least = if value > least { least } else { value };
    }
    least
}

/// Polynomials of one side of the normal plane, in one warp.
struct Side {
    near: f32,
    coefficients: [[[f32; PIECES]; 3]; POWERS],
}

/// Computes the albedos of the channels at eight inclinations, given by `x`.
#[inline(never)]
fn albedos<B: Bell>(lobes: &HairLobes<f32>, sign: f32, x: f32x8) -> [f32x8; 3] {
    let x: Unfused = x.lanes();
    let (one, q) = (Unfused::splat(1.0), x * x);
    let inv = Unfused::quotient(one, q * q + 1.0);
    let wo = Vec3x::new(
        (one - q * q) * inv * sign,
        (q + q) * inv,
        Unfused::splat(0.0),
    );
    let view = prepare_view::<Unfused, f32>(lobes, wo);
    let [r, g, b] = channels::<B, Unfused>(&view);
    [r.store(), g.store(), b.store()]
}

impl Side {
    /// Fits the polynomials, and returns them if they are accurate enough.
    fn of<B: Bell>(lobes: &HairLobes<f32>, sign: f32, near: f32) -> Option<Self> {
        let mut side = Self {
            near,
            coefficients: [[[0.0; PIECES]; 3]; POWERS],
        };
        let mut middle = 1.0;
        for piece in 0..PIECES {
            let albedo = albedos::<B>(lobes, sign, side.unwarped(f32x8::new(ROOTS) + middle));
            for (channel, albedo) in albedo.iter().enumerate() {
                let c = chebyshev(&albedo.as_array().map(excess));
                let monomials = [
                    c[0] - c[2] + c[4],
                    c[1] - 3.0 * c[3],
                    2.0 * c[2] - 8.0 * c[4],
                    4.0 * c[3],
                    8.0 * c[4],
                ];
                for (table, coefficient) in side.coefficients.iter_mut().zip(monomials) {
                    table[channel][piece] = coefficient;
                }
                if relative_error(&c, least(&monomials)) > ACCEPTED {
                    return None;
                }
            }
            middle += 2.0;
        }
        let mut lobe_ends = lobes.alpha.into_iter().zip(lobes.beta);
        lobe_ends
            .all(|(alpha, beta)| {
                side.error_at_ends::<B>(lobes, sign, sign * alpha, beta) <= ACCEPTED
            })
            .then_some(side)
    }

    /// Returns the largest error where the range of a narrow lobe's inclinations ends at its centre. The albedo changes within two
    /// widths there, possibly between nodes.
    fn error_at_ends<B: Bell>(
        &self,
        lobes: &HairLobes<f32>,
        sign: f32,
        tilt: f32,
        beta: f32,
    ) -> f32 {
        if beta > NARROW {
            return 0.0;
        }
        // Twice the angle in `theta_h`, and the width. An end behind the pole counts as long as the lobe reaches the pole.
        let reach = 2.0 * beta * WIDTHS[7];
        let mut largest = 0.0_f32;
        for end in [-2.0 * tilt, PI - 2.0 * tilt] {
            if end > -reach && end - 8.0 * beta <= FRAC_PI_2 {
                largest = largest.max(self.error_about::<B>(lobes, sign, end, beta));
            }
        }
        largest
    }

    /// Returns the largest error about an angle from the pole: at multiples of a lobe's width, and between the nodes of the pieces that
    /// are within the inner ones.
    fn error_about<B: Bell>(&self, lobes: &HairLobes<f32>, sign: f32, end: f32, beta: f32) -> f32 {
        let at_widths = WIDTHS.map(|widths| {
            let from_pole = (end + 2.0 * beta * widths).clamp(1e-6, FRAC_PI_2);
            libm::sqrtf(libm::tanf(0.5 * from_pole))
        });
        let mut largest = self.error_at::<B>(lobes, sign, at_widths);
        let [first, last] = [at_widths[2], at_widths[5]].map(|x| self.piece(x).0);
        for piece in first..=last {
            let middle = (2 * piece + 1) as f32;
            let extremes = self.unwarped(f32x8::new(EXTREMES) + middle);
            largest = largest.max(self.error_at::<B>(lobes, sign, extremes.to_array()));
        }
        largest
    }

    /// Returns the largest error at eight positions.
    fn error_at<B: Bell>(&self, lobes: &HairLobes<f32>, sign: f32, x: [f32; NODES]) -> f32 {
        let albedo = albedos::<B>(lobes, sign, f32x8::new(x));
        let mut largest = 0.0_f32;
        for (channel, albedo) in albedo.iter().enumerate() {
            for (x, albedo) in x.into_iter().zip(albedo.as_array()) {
                let factor = 1.0 + self.at(channel, x).min(0.0);
                largest = largest.max((factor * albedo.max(1.0) - 1.0).abs());
            }
        }
        largest
    }

    /// Returns the positions that the warp takes to these, which are given in eighths.
    fn unwarped(&self, eighths: f32x8) -> f32x8 {
        let v = eighths * 0.125;
        v * self.near / (1.0 + self.near - v)
    }

    /// Returns the piece of a position, and the argument of its polynomials in `[-1, 1]`.
    fn piece(&self, x: f32) -> (usize, f32) {
        let v = f32::quotient((1.0 + self.near) * x, x + self.near);
        let (mut piece, mut t) = (0, 8.0 * v - 1.0);
        while t > 1.0 && piece < PIECES - 1 {
            (piece, t) = (piece + 1, t - 2.0);
        }
        (piece, t)
    }

    /// Evaluates the fit of `1 / albedo - 1` of a channel.
    fn at(&self, channel: usize, x: f32) -> f32 {
        let (piece, t) = self.piece(x);
        self.coefficients
            .iter()
            .rev()
            .fold(0.0, |sum, table| sum * t + table[channel][piece])
    }

    /// Fits the first warp that is accurate enough, if there is one.
    fn accurate<B: Bell>(lobes: &HairLobes<f32>, sign: f32) -> Option<Self> {
        NEAR.iter()
            .find_map(|near| Self::of::<B>(lobes, sign, *near))
    }
}

/// Returns a bound on the error of a piece whose least value is known, relative to the factor on colours where the factor is below 1.
/// The bound is infinite for factors that are not fitted.
///
/// Coefficients that are left out bound the error of the polynomial through the nodes; half of the last two, counted once more,
/// stands for the coefficients beyond.
fn relative_error(c: &[f32; NODES], least: f32) -> f32 {
    let error = c[5].abs() + 1.5 * (c[6].abs() + c[7].abs());
    let factor = 1.0 + least - error;
    if factor > 1.0 {
        0.0
    } else if factor > LEAST {
        f32::quotient(error, factor)
    } else {
        f32::INFINITY
    }
}

impl<C: Scalar + From<f32>> AlbedoFit<C> {
    /// Returns the fit that changes no colour.
    #[inline(never)]
    pub(in crate::hair) fn raw() -> Self {
        let mut raw: Self = LaneStruct::make(&Path::Root, &mut |_| 0.0.into());
        raw.warp.near = [1.0.into(); 2];
        raw
    }
}

impl AlbedoFit<f32> {
    /// Fits the albedo of a material's lobes.
    pub(in crate::hair) fn of<B: Bell>(lobes: &HairLobes<f32>) -> Self {
        let mut warp = Warp {
            near: [1.0; 2],
            refused: 1.0,
        };
        let mut entries = [[0.0; NUMBERS]; ENTRIES];
        if let Some(low) = Side::accurate::<B>(lobes, -1.0)
            && let Some(high) = Side::accurate::<B>(lobes, 1.0)
        {
            warp = Warp {
                near: [low.near, high.near],
                refused: 0.0,
            };
            for (piece, entry) in entries.iter_mut().enumerate() {
                let side = if piece < PIECES { &low } else { &high };
                let coefficients = side.coefficients.iter().rev().flatten();
                for (number, pieces) in entry.iter_mut().zip(coefficients) {
                    *number = pieces[piece % PIECES];
                }
            }
        }
        Self {
            warp,
            pieces: Table::new(&entries),
        }
    }
}
