//! Factorisation of `S cos theta_i` of one hair into a sum of three products, each of a function of `theta_i` and one of `phi`.
//!
//! `S cos theta_i = sum_j along_j(theta_i) around_j(phi)`, the mean of RGB, with
//! - `cos(phi / 2)` around for R and TRT-g together,
//! - the bell of TT,
//! - the bell of the glints,
//!
//! so that integrals of S, and of products of two S, are sums of products of integrals on a line.

use core::array;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::HairParams;
use hairis::params::HairDesc;
use hairis_instruments::quadrature::GaussLegendre;
use hairis_reference::Shape;

/// Number of products in `S cos theta_i`.
pub(super) const TERMS: usize = 3;

/// Kind of bell, with the factor on its widths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    /// Shape of the bell.
    pub shape: Shape,
    /// Factor on the widths.
    pub factor: f64,
    /// Parameters that replace those of the hair.
    refit: Option<HairDesc<f64>>,
}

impl Kind {
    /// Published model, with Gaussian bells.
    pub const GAUSSIAN: Self = Self {
        shape: Shape::Gaussian,
        factor: 1.0,
        refit: None,
    };

    /// Returns the Cauchy model with its widths times `factor`.
    #[must_use]
    pub const fn cauchy(factor: f64) -> Self {
        Self {
            shape: Shape::Cauchy,
            factor,
            refit: None,
        }
    }

    /// Returns the Cauchy model with parameters of its own.
    pub fn refitted(params: &HairParams) -> Self {
        Self {
            shape: Shape::Cauchy,
            factor: 1.0,
            refit: Some(params.desc().map(f64::from)),
        }
    }

    /// Returns the parameters of a hair in this model.
    fn parameters(self, of: &ViewedHair) -> HairDesc<f64> {
        let own = self.refit.unwrap_or(of.parameters);
        own.with_width_factor(self.factor)
    }
}

/// Hair seen from one inclination.
#[derive(Clone, Copy, Debug)]
pub struct ViewedHair {
    parameters: HairDesc<f64>,
    theta_o: f64,
}

/// Points of a quadrature rule, each with its weight.
pub type Nodes = Vec<[f64; 2]>;

/// Points at which a hair is integrated. They serve every [`Kind`] whose factor is near 1.
#[derive(Clone, Debug)]
pub struct Rule {
    /// Points `theta_i` in rad; weights include the `cos theta_i` of the solid angle.
    pub along: Nodes,
    /// Points `|phi|` in rad; weights count both signs.
    pub around: Nodes,
}

/// Values of the three products of a [`Kind`] at the points of a [`Rule`].
#[derive(Clone, Debug)]
pub struct BellValues {
    /// Functions of `theta_i`.
    pub along: Vec<[f64; TERMS]>,
    /// Functions of `phi`.
    pub around: Vec<[f64; TERMS]>,
}

/// Returns the sum of products of two slices.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl ViewedHair {
    /// Returns the hair seen from `theta_o`, in rad, within (-pi/2, pi/2).
    pub fn new(params: &HairParams, theta_o: f64) -> Self {
        Self {
            parameters: params.desc().map(f64::from),
            theta_o,
        }
    }

    /// Returns the factors that depend on `theta_i`.
    #[must_use]
    pub fn along(&self, kind: Kind, theta_i: f64) -> [f64; TERMS] {
        let p = kind.parameters(self);
        let (theta_h, theta_d) = (
            0.5 * (theta_i + self.theta_o),
            0.5 * (self.theta_o - theta_i),
        );
        let cos_theta_d = theta_d.cos();
        let common = theta_i.cos() / (cos_theta_d * cos_theta_d);
        let [m_r, m_tt, m_trt] =
            [0, 1, 2].map(|l| common * kind.shape.bell(p.beta[l], theta_h - p.alpha[l]));
        let [r, tt, trt] = [p.i_r, p.i_tt, p.i_trt].map(|rgb| rgb.iter().sum::<f64>() / 3.0);
        [r * m_r + trt * m_trt, tt * m_tt, trt * p.i_g * m_trt]
    }

    /// Returns the factors that depend on `phi`, which is in [-pi, pi].
    #[must_use]
    pub fn around(&self, kind: Kind, phi: f64) -> [f64; TERMS] {
        let p = kind.parameters(self);
        let bell = |width, x| kind.shape.bell(width, x);
        [
            (0.5 * phi).cos().max(0.0),
            bell(p.gamma_tt, PI - phi.abs()),
            bell(p.gamma_g, phi.abs() - p.phi_g),
        ]
    }

    /// Returns Gauss-Legendre rules of `order` points on panels that follow the lobes.
    #[must_use]
    pub fn rule(&self, order: usize) -> Rule {
        const DISTANCES: [f64; 9] = [-12.0, -5.0, -2.5, -1.0, 0.0, 1.0, 2.5, 5.0, 12.0];
        let p = &self.parameters;
        let rule = GaussLegendre::new(order);
        let mut along = vec![-FRAC_PI_2, FRAC_PI_2];
        for l in 0..3 {
            // A bell of width beta in theta_h has twice the width in theta_i.
            let centre = 2.0 * p.alpha[l] - self.theta_o;
            along.extend(DISTANCES.map(|d| centre + 2.0 * d * p.beta[l]));
        }
        // The ratio cos^2 theta_i / cos^2 theta_d turns at theta_i = -theta_o, over a range as wide as the distance to the pole.
        let pole = FRAC_PI_2 - self.theta_o.abs();
        along.extend(
            [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 5.0]
                .map(|d| -self.theta_o + self.theta_o.signum() * d * pole),
        );
        let mut around = vec![0.0, FRAC_PI_2, PI];
        around.extend(DISTANCES.map(|d| p.phi_g + d * p.gamma_g));
        around.extend(DISTANCES.map(|d| PI - d.abs() * p.gamma_tt));
        let along = panels(&rule, along, [-FRAC_PI_2, FRAC_PI_2])
            .into_iter()
            .map(|[x, w]| [x, w * x.cos()])
            .collect();
        let around = panels(&rule, around, [0.0, PI])
            .into_iter()
            .map(|[x, w]| [x, 2.0 * w])
            .collect();
        Rule { along, around }
    }
}

/// Returns the nodes of a rule on each panel between the breakpoints within the interval.
fn panels(rule: &GaussLegendre, mut breaks: Vec<f64>, [lo, hi]: [f64; 2]) -> Nodes {
    breaks.retain(|x| (lo..=hi).contains(x));
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    breaks
        .windows(2)
        .flat_map(|ends| rule.on(ends[0], ends[1]))
        .collect()
}

impl Rule {
    /// Returns the values of a model at the points of the rule.
    #[must_use]
    pub fn values(&self, view: &ViewedHair, kind: Kind) -> BellValues {
        BellValues {
            along: self
                .along
                .iter()
                .map(|[theta, _]| view.along(kind, *theta))
                .collect(),
            around: self
                .around
                .iter()
                .map(|[phi, _]| view.around(kind, *phi))
                .collect(),
        }
    }

    /// Returns the integral of `S cos theta_i` over the sphere, which is the directional albedo as the mean of RGB.
    #[must_use]
    pub fn albedo(&self, of: &BellValues) -> f64 {
        let integral = |nodes: &Nodes, values: &[[f64; TERMS]]| -> [f64; TERMS] {
            array::from_fn(|j| {
                nodes
                    .iter()
                    .zip(values)
                    .map(|([_, weight], value)| weight * value[j])
                    .sum()
            })
        };
        dot(
            &integral(&self.along, &of.along),
            &integral(&self.around, &of.around),
        )
    }

    /// Returns the integral over the sphere of the product of two models' `S cos theta_i`.
    pub(super) fn product(&self, a: &BellValues, b: &BellValues) -> f64 {
        let (along, around) = (
            gram(&self.along, &a.along, &b.along),
            gram(&self.around, &a.around, &b.around),
        );
        dot(along.as_flattened(), around.as_flattened())
    }
}

/// Returns the integrals of the products of two models' terms.
fn gram(nodes: &Nodes, a: &[[f64; TERMS]], b: &[[f64; TERMS]]) -> [[f64; TERMS]; TERMS] {
    let integral = |i: usize, j: usize| {
        let values = a.iter().zip(b).map(|(a, b)| (a[i], b[j]));
        nodes
            .iter()
            .zip(values)
            .map(|([_, weight], (a, b))| weight * a * b)
            .sum()
    };
    array::from_fn(|i| array::from_fn(|j| integral(i, j)))
}
