//! Globally adaptive Gauss-Kronrod integration on lines and rectangles.

use core::cmp::Ordering;
use serde::Serialize;
use std::collections::BinaryHeap;

/// Positive Kronrod nodes of the 15-point rule, outermost first, then 0 (QUADPACK, Piessens et al. 1983).
const NODES: [f64; 8] = [
    0.991_455_371_120_812_639_206_854_697_526_329,
    0.949_107_912_342_758_524_526_189_684_047_851,
    0.864_864_423_359_769_072_789_712_788_640_926,
    0.741_531_185_599_394_439_863_864_773_280_788,
    0.586_087_235_467_691_130_294_144_691_258_396,
    0.405_845_151_377_397_166_906_606_412_076_961,
    0.207_784_955_007_898_467_600_689_403_773_245,
    0.0,
];

/// Kronrod weights of [`NODES`].
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224_963_732_008_058_970,
    0.063_092_092_629_978_553_290_700_663_189_204,
    0.104_790_010_322_250_183_839_876_322_541_518,
    0.140_653_259_715_525_918_745_189_590_510_238,
    0.169_004_726_639_267_902_826_583_426_598_550,
    0.190_350_578_064_785_409_913_256_402_421_014,
    0.204_432_940_075_298_892_414_161_999_234_649,
    0.209_482_141_084_727_828_012_999_174_891_714,
];

/// Weights of the embedded 7-point Gauss rule, 0 at the nodes it lacks.
const GAUSS: [f64; 8] = [
    0.0,
    0.129_484_966_168_869_693_270_611_432_679_082,
    0.0,
    0.279_705_391_489_276_667_901_467_771_423_780,
    0.0,
    0.381_830_050_505_118_944_950_369_775_488_975,
    0.0,
    0.417_959_183_673_469_387_755_102_040_816_327,
];

/// Tolerance of an adaptive integral.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tolerance {
    /// Absolute error allowed in each component, in the unit of the integral.
    pub absolute: f64,
    /// Error allowed in each component relative to the largest component of the integral.
    pub relative: f64,
    /// Limit on panels (or cells); at it the result is marked as not converged.
    pub max_panels: usize,
}

impl Default for Tolerance {
    /// 1e-10 relative, 1e-300 absolute, at most 20 000 panels.
    fn default() -> Self {
        Self { absolute: 1e-300, relative: 1e-10, max_panels: 20_000 }
    }
}

impl Tolerance {
    /// The default with another relative error.
    #[must_use]
    pub fn relative(relative: f64) -> Self {
        Self { relative, ..Self::default() }
    }
}

/// An integral and its error estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral<const N: usize> {
    /// The integral, one component an element.
    pub value: [f64; N],
    /// Bound estimate of each component's error: usually far above the true error.
    pub error: [f64; N],
    /// Calls of the integrand.
    pub evaluations: u64,
    /// Whether the tolerance was met.
    pub converged: bool,
}

/// A part of the domain with its integral; the heap gives the one with the largest error first.
struct Panel<const N: usize> {
    lo: [f64; 2],
    hi: [f64; 2],
    value: [f64; N],
    error: [f64; N],
    worst: f64,
    split: usize,
}

impl<const N: usize> PartialEq for Panel<N> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<const N: usize> Eq for Panel<N> {}

impl<const N: usize> PartialOrd for Panel<N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const N: usize> Ord for Panel<N> {
    fn cmp(&self, other: &Self) -> Ordering {
        // The corner settles ties, so the order of splitting never depends on the heap's history.
        self.worst
            .total_cmp(&other.worst)
            .then_with(|| self.lo[0].total_cmp(&other.lo[0]))
            .then_with(|| self.lo[1].total_cmp(&other.lo[1]))
    }
}

/// Breakpoints that announce a bell: its centre, and 3 and 12 widths either side, in the unit of the arguments.
///
/// Panels beside them shrink fast enough to resolve the bell however narrow it is; the centre alone is not enough for a Gaussian.
#[must_use]
pub fn bell_breakpoints(centre: f64, width: f64) -> [f64; 5] {
    [-12.0, -3.0, 0.0, 3.0, 12.0].map(|k| centre + k * width)
}

/// Integral of `f` over the interval from the smallest to the largest of `breakpoints`.
///
/// Gauss-Kronrod 7-15 on each interval between breakpoints, then on halves of the worst panel until the summed error estimate meets the tolerance. The ends
/// are never evaluated.
///
/// - Shape: `breakpoints` in any order, at least two that differ; else the integral is 0.
///
/// # Examples
/// ```
/// use hairis_harness::quadrature::{Tolerance, integrate};
/// let r = integrate(|x| [x.abs()], &[-1.0, 0.0, 2.0], &Tolerance::default());
/// assert!(r.converged && (r.value[0] - 2.5).abs() < 1e-14);
/// ```
pub fn integrate<const N: usize>(
    mut f: impl FnMut(f64) -> [f64; N],
    breakpoints: &[f64],
    tolerance: &Tolerance,
) -> Integral<N> {
    let edges = clean(breakpoints);
    let panels = edges.windows(2).map(|x| ([x[0], 0.0], [x[1], 0.0])).collect();
    adapt(panels, 15, tolerance, |lo, hi| {
        let (centre, half) = (0.5 * (lo[0] + hi[0]), 0.5 * (hi[0] - lo[0]));
        let mut kronrod = [0.0; N];
        let mut gauss = [0.0; N];
        for_each_node(|x, k, g| {
            let y = f(centre + half * x);
            for c in 0..N {
                kronrod[c] += k * y[c];
                gauss[c] += g * y[c];
            }
        });
        let value = kronrod.map(|v| v * half);
        let error = core::array::from_fn(|c| ((kronrod[c] - gauss[c]) * half).abs());
        panel(*lo, *hi, value, error, 0)
    })
}

/// Integral of `f(x, y)` over the rectangle spanned by two sets of breakpoints.
///
/// The product of two 15-point Kronrod rules on each cell; the Gauss rule on each of its lines gives the error along either axis. The worst cell is halved
/// along its worse axis. The edges are never evaluated.
///
/// - Shape: as for [`integrate`], on each axis. Tilted ridges cost many cells: choose coordinates that follow the lobes.
pub fn integrate_rectangle<const N: usize>(
    mut f: impl FnMut(f64, f64) -> [f64; N],
    x_breakpoints: &[f64],
    y_breakpoints: &[f64],
    tolerance: &Tolerance,
) -> Integral<N> {
    let (xs, ys) = (clean(x_breakpoints), clean(y_breakpoints));
    let panels = xs.windows(2).flat_map(|x| ys.windows(2).map(move |y| ([x[0], y[0]], [x[1], y[1]]))).collect();
    adapt(panels, 225, tolerance, |lo, hi| {
        let centre = [0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1])];
        let half = [0.5 * (hi[0] - lo[0]), 0.5 * (hi[1] - lo[1])];
        let area = half[0] * half[1];
        let mut value = [0.0; N];
        // Errors are summed line by line in absolute value: on a tilted edge the lines' errors have both signs and would cancel.
        let mut error_x = [0.0; N];
        let mut error_y = [0.0; N];
        let mut columns = [([0.0; N], [0.0; N], 0.0); 15];
        for_each_node(|x, kx, gx| {
            let mut kronrod = [0.0; N];
            let mut gauss = [0.0; N];
            let mut column = columns.iter_mut();
            for_each_node(|y, ky, gy| {
                let v = f(centre[0] + half[0] * x, centre[1] + half[1] * y);
                for c in 0..N {
                    kronrod[c] += ky * v[c];
                    gauss[c] += gy * v[c];
                }
                if let Some((column_kronrod, column_gauss, weight)) = column.next() {
                    *weight = ky;
                    for c in 0..N {
                        column_kronrod[c] += kx * v[c];
                        column_gauss[c] += gx * v[c];
                    }
                }
            });
            for c in 0..N {
                value[c] += kx * kronrod[c];
                error_y[c] += kx * (kronrod[c] - gauss[c]).abs();
            }
        });
        for (kronrod, gauss, weight) in columns {
            for c in 0..N {
                error_x[c] += weight * (kronrod[c] - gauss[c]).abs();
            }
        }
        let worst = |error: &[f64; N]| error.iter().copied().fold(0.0, f64::max);
        let split = usize::from(worst(&error_y) > worst(&error_x));
        let error = core::array::from_fn(|c| area * (error_x[c] + error_y[c]));
        panel(*lo, *hi, value.map(|v| v * area), error, split)
    })
}

/// Calls `visit(node, kronrod weight, gauss weight)` for the fifteen nodes on [-1, 1].
fn for_each_node(mut visit: impl FnMut(f64, f64, f64)) {
    for i in 0..7 {
        visit(-NODES[i], KRONROD[i], GAUSS[i]);
        visit(NODES[i], KRONROD[i], GAUSS[i]);
    }
    visit(0.0, KRONROD[7], GAUSS[7]);
}

/// Breakpoints sorted, finite and without repeats.
fn clean(breakpoints: &[f64]) -> Vec<f64> {
    let mut edges: Vec<f64> = breakpoints.iter().copied().filter(|x| x.is_finite()).collect();
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
}

fn panel<const N: usize>(lo: [f64; 2], hi: [f64; 2], value: [f64; N], error: [f64; N], split: usize) -> Panel<N> {
    // A NaN counts as an infinite error, so that it is split, reported and never hidden.
    let worst = error.iter().fold(0.0, |a: f64, &e| a.max(if e.is_nan() { f64::INFINITY } else { e }));
    Panel { lo, hi, value, error, worst, split }
}

/// Splits the panel of the largest error until the total meets the tolerance.
fn adapt<const N: usize>(
    domain: Vec<([f64; 2], [f64; 2])>,
    cost: u64,
    tolerance: &Tolerance,
    mut measure: impl FnMut(&[f64; 2], &[f64; 2]) -> Panel<N>,
) -> Integral<N> {
    let mut heap: BinaryHeap<Panel<N>> = domain.iter().map(|(lo, hi)| measure(lo, hi)).collect();
    let mut evaluations = cost * heap.len() as u64;
    // Panels too small to halve in f64 wait here with their error.
    let mut done: Vec<Panel<N>> = Vec::new();
    let mut running = total(&heap, &done);
    loop {
        if met(&running, tolerance) {
            // The running sums drift by rounding; only fresh sums decide on convergence.
            running = total(&heap, &done);
            if met(&running, tolerance) {
                break;
            }
        }
        if heap.len() + done.len() >= tolerance.max_panels {
            running = total(&heap, &done);
            break;
        }
        let Some(worst) = heap.pop() else {
            running = total(&heap, &done);
            break;
        };
        let axis = worst.split;
        let middle = 0.5 * (worst.lo[axis] + worst.hi[axis]);
        if middle <= worst.lo[axis] || middle >= worst.hi[axis] {
            done.push(worst);
            continue;
        }
        let (mut left_hi, mut right_lo) = (worst.hi, worst.lo);
        left_hi[axis] = middle;
        right_lo[axis] = middle;
        let halves = [measure(&worst.lo, &left_hi), measure(&right_lo, &worst.hi)];
        evaluations += 2 * cost;
        for c in 0..N {
            running.0[c] += halves[0].value[c] + halves[1].value[c] - worst.value[c];
            running.1[c] += halves[0].error[c] + halves[1].error[c] - worst.error[c];
        }
        heap.extend(halves);
    }
    Integral { value: running.0, error: running.1, evaluations, converged: met(&running, tolerance) }
}

/// Sums of values and errors over all panels, in an order that does not depend on the heap's.
fn total<const N: usize>(heap: &BinaryHeap<Panel<N>>, done: &[Panel<N>]) -> ([f64; N], [f64; N]) {
    let mut panels: Vec<&Panel<N>> = heap.iter().chain(done).collect();
    // Ascending magnitude of error is also roughly ascending magnitude of value: small terms first.
    panels.sort();
    let (mut value, mut error) = ([0.0; N], [0.0; N]);
    for p in panels {
        for c in 0..N {
            value[c] += p.value[c];
            error[c] += p.error[c];
        }
    }
    (value, error)
}

fn met<const N: usize>(sums: &([f64; N], [f64; N]), tolerance: &Tolerance) -> bool {
    let largest = sums.0.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    let allowed = tolerance.absolute.max(tolerance.relative * largest);
    sums.0.iter().all(|v| v.is_finite()) && sums.1.iter().all(|e| *e <= allowed)
}

#[cfg(test)]
mod tests;
