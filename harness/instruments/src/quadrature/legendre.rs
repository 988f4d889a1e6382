//! Gauss-Legendre rules of any order, whose nodes are computed by Newton's method.

use core::f64::consts::PI;

/// Gauss-Legendre rule, which is exact for polynomials of degree `2 order - 1`.
///
/// # Examples
/// ```
/// use hairis_instruments::quadrature::GaussLegendre;
/// let rule = GaussLegendre::new(8);
/// let integral: f64 = rule.on(0.0, 1.0).map(|[x, weight]| weight * x.powi(15)).sum();
/// assert!((integral - 1.0 / 16.0).abs() < 1e-15);
/// ```
#[derive(Clone, Debug)]
pub struct GaussLegendre {
    nodes: Vec<[f64; 2]>,
}

impl GaussLegendre {
    /// Computes the rule with `order` nodes; an order of 0 is taken as 1.
    #[must_use]
    pub fn new(order: usize) -> Self {
        let n = order.max(1);
        let mut nodes = vec![[0.0; 2]; n];
        for i in 0..n.div_ceil(2) {
            // Tricomi's approximation is within a few 1e-3 of the root; Newton doubles the digits each time.
            let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut derivative = 1.0;
            for _ in 0..100 {
                let (value, slope) = legendre(n, x);
                derivative = slope;
                let step = value / slope;
                x -= step;
                if step.abs() <= 2.0 * f64::EPSILON {
                    derivative = legendre(n, x).1;
                    break;
                }
            }
            if 2 * i + 1 == n {
                x = 0.0;
                derivative = legendre(n, x).1;
            }
            let weight = 2.0 / ((1.0 - x * x) * derivative * derivative);
            nodes[i] = [-x, weight];
            nodes[n - 1 - i] = [x, weight];
        }
        Self { nodes }
    }

    /// Returns the nodes on [-1, 1] in ascending order, each with its weight; the weights sum to 2.
    #[must_use]
    pub fn nodes(&self) -> &[[f64; 2]] {
        &self.nodes
    }

    /// Returns the nodes and weights of the rule transformed to the interval [a, b].
    pub fn on(&self, a: f64, b: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
        let (centre, half) = (0.5 * (a + b), 0.5 * (b - a));
        self.nodes
            .iter()
            .map(move |[x, w]| [centre + half * x, half * w])
    }
}

/// Returns the Legendre polynomial of degree `n` and its derivative at `x` in (-1, 1).
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (previous, current) = (
            current,
            ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k,
        );
    }
    (current, n as f64 * (x * current - previous) / (x * x - 1.0))
}
