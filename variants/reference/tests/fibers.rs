//! The formulas of the two fibres, in double precision: normalisation, inversion, sampling, and the errata they mend.

mod chiang;
mod chiang_lobes;
mod chiang_sampling;
mod d_eon;
mod errata;
mod kajiya_kay;
mod rtxcr;
pub(crate) mod support;
