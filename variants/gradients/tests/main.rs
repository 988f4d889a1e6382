//! Tests: lanes against the interpreter of graphs, and against differences of the formulas in double precision.

mod differences;
mod edges;
mod lanes;
mod refusals;
mod support;
