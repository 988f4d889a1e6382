//! Studies over a grid of hair, fits of models to each other and the claims of the paper: the functions of the binary `hairis-study`,
//! as a library so that tests can call them.

pub mod args;
pub mod claims;
pub mod cmd;
pub mod difference;
pub mod fit;
#[cfg(any(doc, doctest))]
pub mod guide;
pub mod study;
