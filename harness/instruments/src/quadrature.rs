//! Deterministic integrals in `f64`: the references of estimators.
//!
//! - [`GaussLegendre`]: fixed rules of any order, nodes computed.
//! - [`integrate`]: adaptive Gauss-Kronrod on a line, with breakpoints.
//! - [`integrate_rectangle`]: the same on a rectangle, cells split along the worse axis.
//! - [`SphereIntegrator`]: directions in fibre coordinates, with breakpoints so that narrow lobes are found.
//!
//! Every integrand returns `[f64; N]`: use `N = 1` for a number and `N = 3` for linear RGB. An adaptive rule can miss a peak between its nodes: one narrower
//! than a panel needs a breakpoint.

mod adaptive;
mod legendre;
mod sphere;

pub use adaptive::{Integral, Tolerance, bell_breakpoints, integrate, integrate_rectangle};
pub use legendre::GaussLegendre;
pub use sphere::SphereIntegrator;
