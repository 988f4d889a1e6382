//! Tests that compare lanes with the interpreter of graphs, and with differences in double precision, of the graphs and of the formulas.

mod differences;
mod edges;
mod ends;
mod lanes;
mod precision;
mod refusals;
mod support;
