//! Tests of what programs share, as one binary with a module per subject.

mod files;
mod interrupt;
mod program;
