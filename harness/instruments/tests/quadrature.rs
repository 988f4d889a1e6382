//! Tests of `quadrature`.

mod adaptive;
mod legendre;
mod sphere;
