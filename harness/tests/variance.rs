//! Engine of the variances.

mod perfect;
mod tally;
