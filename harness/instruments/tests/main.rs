//! Tests of the instruments: one binary, a module a subject.

mod appended;
mod columns;
mod direction;
mod light;
mod machine;
mod markup;
mod pixels;
mod plot;
mod quadrature;
mod record;
mod report;
mod sequence;
mod shard;
mod stats;
mod table;
