//! Samples as models return them, in lanes.

use super::{Direction, Eval};
use crate::simd::{Lanes, Vec3x};

/// Sampled direction, as models return it, per lane. A discarded lane has value, pdf and weight 0 and slot -1; users read [`Sample`]
/// and [`Sample8`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleLanes<L> {
    /// Direction towards the light, in the fibre's frame, unit.
    pub wi: Vec3x<L>,
    /// S at `wi`, without the cosine, linear RGB, per steradian.
    pub value: [L; 3],
    /// Density of `wi`, per steradian.
    pub pdf: L,
    /// Throughput weight `value * cos theta_i / pdf`.
    pub weight: [L; 3],
    /// Slot of the chosen lobe as a number; -1 if the sample was discarded.
    pub slot: L,
}

impl<L: Lanes> SampleLanes<L> {
    /// Density below which models discard a sample, because close to denormals its weight would have no digits.
    pub const LEAST_DENSITY: f32 = 1e-30;

    /// Makes the sample of a direction by a lobe's slot, from S there, which is at least 0, and from the density, which is at least the
    /// [least one](Self::LEAST_DENSITY). Lanes that are not sound are discarded, as are those of the least density and those whose direction
    /// is none.
    #[inline(always)]
    #[must_use]
    pub fn new(wi: &Direction<L>, eval: Eval<L>, sound: L::Mask, slot: L) -> Self {
        let Eval {
            value: [r, g, b],
            pdf,
        } = eval;
        L::stage("density and weight of the sample, 0 where it is discarded");
        let least = L::splat(Self::LEAST_DENSITY);
        let sound = L::and(L::and(wi.is_sound(), least.lt(pdf)), sound);
        let limit = L::keep(sound, L::splat(f32::MAX));
        let by = L::quotient(wi.cos_theta, pdf);
        let Vec3x { x, y, z } = wi.vector;
        Self {
            wi: Vec3x::new(L::keep(sound, x), L::keep(sound, y), L::keep(sound, z)),
            value: [r.min(limit), g.min(limit), b.min(limit)],
            pdf: pdf.min(limit),
            weight: [
                (r * by).min(limit),
                (g * by).min(limit),
                (b * by).min(limit),
            ],
            slot: L::select_predictable(sound, slot, L::splat(-1.0)),
        }
    }

    /// Returns the lanes in their storage form.
    #[inline(always)]
    pub(crate) fn store(self) -> SampleLanes<L::Stored> {
        SampleLanes {
            wi: self.wi.store(),
            value: crate::simd::lanes::store3(self.value),
            pdf: self.pdf.store(),
            weight: crate::simd::lanes::store3(self.weight),
            slot: self.slot.store(),
        }
    }
}
