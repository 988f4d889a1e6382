//! Deterministic integrals in `f64`, which serve as references for estimators.
//!
//! - [`GaussLegendre`]: fixed rules of any order, whose nodes are computed.
//! - [`integrate`]: adaptive Gauss-Kronrod integration on a line, with breakpoints.
//! - [`integrate_rectangle`]: adaptive Gauss-Kronrod integration on a rectangle, whose cells are split along the worse axis.
//! - [`SphereIntegrator`]: integration over directions in fibre coordinates, with breakpoints so that narrow lobes are found.
//!
//! Every integrand returns `[f64; N]`: use `N = 1` for a number and `N = 3` for linear RGB. An adaptive rule can miss a peak between
//! its nodes, so a peak narrower than a panel needs a breakpoint.

mod adaptive;
mod legendre;
mod sphere;

pub use adaptive::{Integral, Tolerance, bell_breakpoints, integrate, integrate_rectangle};
pub use legendre::GaussLegendre;
pub use sphere::SphereIntegrator;
