//! Globally adaptive Gauss-Kronrod integration on lines and rectangles.

use core::array;
use std::collections::BTreeMap;

/// Positive nodes of the 15-point Kronrod rule, outermost first, then 0. Each node has its weight and that of the embedded 7-point
/// Gauss rule, which is 0 at the nodes that the Gauss rule lacks (QUADPACK, Piessens et al. 1983).
const RULE: [[f64; 3]; 8] = [
    [
        0.991_455_371_120_812_639_206,
        0.022_935_322_010_529_224_963,
        0.0,
    ],
    [
        0.949_107_912_342_758_524_526,
        0.063_092_092_629_978_553_290,
        0.129_484_966_168_869_693_270,
    ],
    [
        0.864_864_423_359_769_072_789,
        0.104_790_010_322_250_183_839,
        0.0,
    ],
    [
        0.741_531_185_599_394_439_863,
        0.140_653_259_715_525_918_745,
        0.279_705_391_489_276_667_901,
    ],
    [
        0.586_087_235_467_691_130_294,
        0.169_004_726_639_267_902_826,
        0.0,
    ],
    [
        0.405_845_151_377_397_166_906,
        0.190_350_578_064_785_409_913,
        0.381_830_050_505_118_944_950,
    ],
    [
        0.207_784_955_007_898_467_600,
        0.204_432_940_075_298_892_414,
        0.0,
    ],
    [
        0.0,
        0.209_482_141_084_727_828_012,
        0.417_959_183_673_469_387_755,
    ],
];

/// Tolerance of an adaptive integral, met by an error within the absolute or the relative bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Absolute error allowed in each component, in the unit of the integral.
    pub absolute: f64,
    /// Error allowed in each component, relative to the largest component of the integral.
    pub relative: f64,
    /// Largest number of panels (or cells), at which refinement stops whether or not the tolerance is met.
    pub max_panels: usize,
}

impl Default for Tolerance {
    /// Returns a tolerance of 1e-10 relative and 1e-300 absolute error, with at most 20 000 panels.
    fn default() -> Self {
        Self {
            absolute: 1e-300,
            relative: 1e-10,
            max_panels: 20_000,
        }
    }
}

impl Tolerance {
    /// Returns the default tolerance with another relative error.
    #[must_use]
    pub fn relative(relative: f64) -> Self {
        Self {
            relative,
            ..Self::default()
        }
    }

    /// Returns true if an integral with these errors is within the tolerance and all its components are finite.
    pub(crate) fn is_met(&self, value: &[f64], error: &[f64]) -> bool {
        let largest = value.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
        let allowed = self.absolute.max(self.relative * largest);
        value.iter().all(|v| v.is_finite()) && error.iter().all(|e| *e <= allowed)
    }
}

/// Integral with its error estimate, as the adaptive rules return it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral<const N: usize> {
    /// Value of each component of the integral.
    pub value: [f64; N],
    /// Estimated bound on the error of each component, usually far above the true error.
    pub error: [f64; N],
    /// Whether the error estimate met the tolerance.
    pub converged: bool,
}

/// Largest number of components of an integrand.
const MOST: usize = 8;

/// Components of an integrand, padded with zeros, so that rules of one size are compiled once for all integrands.
type Components = [f64; MOST];

/// Sums of the values and sums of the errors of panels.
type Sums = [Components; 2];

/// Part of the domain with its integral.
struct Panel {
    lo: [f64; 2],
    hi: [f64; 2],
    sums: Sums,
    /// Axis of the larger error, along which the panel is split.
    split: usize,
}

/// Panels in the order of their largest errors. The corner settles ties, so that the order depends on nothing else.
type Panels = BTreeMap<[u64; 3], Panel>;

impl Panel {
    fn key(&self) -> [u64; 3] {
        // A NaN counts as an infinite error, so that the panel is split, and the NaN is reported and never hidden.
        let worst = self.sums[1].iter().fold(0.0, |a: f64, &e| {
            a.max(if e.is_nan() { f64::INFINITY } else { e })
        });
        // Maps the numbers to integers with the same order.
        [worst, self.lo[0], self.lo[1]].map(|x| {
            if x.is_sign_negative() {
                !x.to_bits()
            } else {
                x.to_bits() | 1 << 63
            }
        })
    }
}

/// Returns the breakpoints that announce a bell: its centre, and 3 and 12 widths to either side, in the unit of the arguments.
///
/// Panels beside the breakpoints shrink fast enough to resolve the bell however narrow it is; the centre alone is not enough for a
/// Gaussian.
#[must_use]
pub fn bell_breakpoints(centre: f64, width: f64) -> [f64; 5] {
    [-12.0, -3.0, 0.0, 3.0, 12.0].map(|k| centre + k * width)
}

/// Integrates `f` over the interval from the smallest to the largest of `breakpoints`.
///
/// Applies the Gauss-Kronrod rule 7-15 to each interval between breakpoints, and then to the halves of the worst panel until the summed
/// error estimate meets the tolerance. The ends are never evaluated.
///
/// - Shape: `breakpoints` in any order, of which at least two must differ, or the integral is 0. At most eight components.
///
/// # Examples
/// ```
/// use hairis_instruments::quadrature::{Tolerance, integrate};
/// let r = integrate(|x| [x.abs()], &[-1.0, 0.0, 2.0], &Tolerance::default());
/// assert!(r.converged && (r.value[0] - 2.5).abs() < 1e-14);
/// ```
pub fn integrate<const N: usize>(
    mut f: impl FnMut(f64) -> [f64; N],
    breakpoints: &[f64],
    tolerance: &Tolerance,
) -> Integral<N> {
    let edges = clean(breakpoints);
    let domain: Vec<_> = edges
        .windows(2)
        .map(|x| ([x[0], 0.0], [x[1], 0.0]))
        .collect();
    adapt(&domain, tolerance, &mut |lo, hi| {
        on_line(&mut |x| padded(f(x)), lo, hi)
    })
    .leading()
}

/// Integrates `f(x, y)` over the rectangle spanned by two sets of breakpoints.
///
/// Applies the product of two 15-point Kronrod rules to each cell; the Gauss rule on each of the cell's lines yields the error along
/// either axis. The worst cell is halved along its worse axis. The edges are never evaluated.
///
/// - Shape: as for [`integrate`], on each axis. Tilted ridges cost many cells, so choose coordinates that follow the lobes.
pub fn integrate_rectangle<const N: usize>(
    mut f: impl FnMut(f64, f64) -> [f64; N],
    x_breakpoints: &[f64],
    y_breakpoints: &[f64],
    tolerance: &Tolerance,
) -> Integral<N> {
    let (xs, ys) = (clean(x_breakpoints), clean(y_breakpoints));
    let domain: Vec<_> = xs
        .windows(2)
        .flat_map(|x| ys.windows(2).map(move |y| ([x[0], y[0]], [x[1], y[1]])))
        .collect();
    adapt(&domain, tolerance, &mut |lo, hi| {
        on_rectangle(&mut |x, y| padded(f(x, y)), lo, hi)
    })
    .leading()
}

impl Integral<MOST> {
    /// Returns the components that the integrand has.
    fn leading<const N: usize>(&self) -> Integral<N> {
        let [value, error] = [self.value, self.error].map(|all| array::from_fn(|c| all[c]));
        Integral {
            value,
            error,
            converged: self.converged,
        }
    }
}

/// Pads the components of an integrand with zeros.
fn padded<const N: usize>(y: [f64; N]) -> Components {
    const { assert!(N <= MOST, "too many components") };
    array::from_fn(|c| if c < N { y[c] } else { 0.0 })
}

/// Applies the rule to a part of a line.
fn on_line(f: &mut dyn FnMut(f64) -> Components, lo: [f64; 2], hi: [f64; 2]) -> Panel {
    let (centre, half) = (0.5 * (lo[0] + hi[0]), 0.5 * (hi[0] - lo[0]));
    let (mut kronrod, mut gauss) = ([0.0; MOST], [0.0; MOST]);
    for [x, k, g] in nodes() {
        let y = f(centre + half * x);
        add(&mut kronrod, k, y);
        add(&mut gauss, g, y);
    }
    let error = distance(kronrod, gauss).map(|e| e * half);
    Panel {
        lo,
        hi,
        sums: [kronrod.map(|v| v * half), error],
        split: 0,
    }
}

/// Applies the product rule to a cell.
fn on_rectangle(f: &mut dyn FnMut(f64, f64) -> Components, lo: [f64; 2], hi: [f64; 2]) -> Panel {
    let nodes = nodes();
    let centre = [0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1])];
    let half = [0.5 * (hi[0] - lo[0]), 0.5 * (hi[1] - lo[1])];
    let area = half[0] * half[1];
    let mut value = [0.0; MOST];
    // Errors are summed line by line in absolute value: on a tilted edge, the errors of the lines have both signs and would cancel.
    let (mut error_x, mut error_y) = ([0.0; MOST], [0.0; MOST]);
    let mut columns = [([0.0; MOST], [0.0; MOST]); 15];
    for [x, kx, gx] in nodes {
        let (mut kronrod, mut gauss) = ([0.0; MOST], [0.0; MOST]);
        for ([y, ky, gy], column) in nodes.into_iter().zip(&mut columns) {
            let v = f(centre[0] + half[0] * x, centre[1] + half[1] * y);
            add(&mut kronrod, ky, v);
            add(&mut gauss, gy, v);
            add(&mut column.0, kx, v);
            add(&mut column.1, gx, v);
        }
        add(&mut value, kx, kronrod);
        add(&mut error_y, kx, distance(kronrod, gauss));
    }
    for ((kronrod, gauss), [_, weight, _]) in columns.into_iter().zip(nodes) {
        add(&mut error_x, weight, distance(kronrod, gauss));
    }
    let worst = |error: &Components| error.iter().copied().fold(0.0, f64::max);
    let split = usize::from(worst(&error_y) > worst(&error_x));
    let error = array::from_fn(|c| area * (error_x[c] + error_y[c]));
    Panel {
        lo,
        hi,
        sums: [value.map(|v| v * area), error],
        split,
    }
}

/// Returns the fifteen nodes on [-1, 1], each with its Kronrod and its Gauss weight.
fn nodes() -> [[f64; 3]; 15] {
    array::from_fn(|i| {
        let [x, kronrod, gauss] = RULE[i / 2];
        [if i % 2 == 0 { -x } else { x }, kronrod, gauss]
    })
}

/// Adds `weight * y` to a sum.
fn add(sum: &mut Components, weight: f64, y: Components) {
    for (sum, y) in sum.iter_mut().zip(y) {
        *sum += weight * y;
    }
}

/// Returns the distance between `a` and `b` in each component.
fn distance(a: Components, b: Components) -> Components {
    array::from_fn(|c| (a[c] - b[c]).abs())
}

/// Returns the finite breakpoints, sorted and without repeats.
fn clean(breakpoints: &[f64]) -> Vec<f64> {
    let mut edges: Vec<f64> = breakpoints
        .iter()
        .copied()
        .filter(|x| x.is_finite())
        .collect();
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
}

/// Splits the panel with the largest error until the total meets the tolerance.
fn adapt(
    domain: &[([f64; 2], [f64; 2])],
    tolerance: &Tolerance,
    measure: &mut dyn FnMut([f64; 2], [f64; 2]) -> Panel,
) -> Integral<MOST> {
    let mut panels = Panels::new();
    panels.extend(
        domain
            .iter()
            .map(|(lo, hi)| measure(*lo, *hi))
            .map(|panel| (panel.key(), panel)),
    );
    // Panels too small to halve in f64 wait here with their error.
    let mut done = Panels::new();
    let mut running = total(&panels, &done);
    loop {
        let at_limit = panels.len() + done.len() >= tolerance.max_panels;
        if at_limit || panels.is_empty() || tolerance.is_met(&running[0], &running[1]) {
            // The running sums drift by rounding, so only fresh sums decide on convergence.
            running = total(&panels, &done);
            if at_limit || tolerance.is_met(&running[0], &running[1]) {
                break;
            }
        }
        let Some((key, worst)) = panels.pop_last() else {
            break;
        };
        let axis = worst.split;
        let middle = 0.5 * (worst.lo[axis] + worst.hi[axis]);
        if middle <= worst.lo[axis] || middle >= worst.hi[axis] {
            done.insert(key, worst);
            continue;
        }
        let (mut left_hi, mut right_lo) = (worst.hi, worst.lo);
        left_hi[axis] = middle;
        right_lo[axis] = middle;
        let halves = [measure(worst.lo, left_hi), measure(right_lo, worst.hi)];
        for (k, sum) in running.iter_mut().enumerate() {
            for (c, sum) in sum.iter_mut().enumerate() {
                *sum += halves[0].sums[k][c] + halves[1].sums[k][c] - worst.sums[k][c];
            }
        }
        panels.extend(halves.map(|panel| (panel.key(), panel)));
    }
    let [value, error] = running;
    Integral {
        value,
        error,
        converged: tolerance.is_met(&value, &error),
    }
}

/// Sums all panels by ascending error, which is also roughly ascending value, so that small terms are added first.
fn total(panels: &Panels, done: &Panels) -> Sums {
    let all: BTreeMap<_, _> = panels.iter().chain(done).collect();
    let mut sums = [[0.0; MOST]; 2];
    for panel in all.into_values() {
        sums.iter_mut()
            .zip(panel.sums)
            .for_each(|(sum, more)| add(sum, 1.0, more));
    }
    sums
}
