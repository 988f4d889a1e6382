//! Probabilities of the lobes, and the choice of a lobe by them.

use crate::model::lobe::times;
use crate::simd::{Lanes, store3, store4};

crate::simd::lane_struct! {
    /// Probabilities of the lobes of a shading point, and the choice of one.
    pub(crate) struct Mixture {
        /// Probability of each lobe.
        pub(super) selection: [C; 4],
        /// Start of the next lobe in `xi[0]`.
        pub(super) bounds: [C; 3],
        /// Start of each lobe in `xi[0]`, measured from 0: the sum of the probabilities of the lobes before it.
        pub(super) start: [C; 4],
        /// Start of each lobe in `xi[0]`, measured from 1: the negative sum of the probabilities from this lobe on.
        pub(super) start_less_one: [C; 4],
        /// 1 for a lobe that scatters, 0 for one that does not.
        pub(super) kept: [C; 4],
    }
}

impl<C: Lanes> Mixture<C> {
    /// Makes the mixture of lobes with these weights, restricted to the lobes of `kept`.
    ///
    /// The last lobe with a positive weight reaches to 2, so that a rounded sum never selects a lobe without weight. If no lobe has
    /// any weight, all probabilities are 0.
    #[inline(always)]
    pub(super) fn new(weights: [C; 4], kept: [C; 4]) -> Self {
        let c = C::splat;
        let (zero, one, two) = (c(0.0), c(1.0), c(2.0));
        // Scaled so that the sum of four does not overflow.
        let most = c(f32::MAX / 8.0);
        let [a, b, d, e] = weights;
        let e = times([a.min(most), b.min(most), d.min(most), e.min(most)], kept);
        // A sum of denormals has no reciprocal: it is scaled first.
        let total = (e[0] + e[1]) + (e[2] + e[3]);
        let scale = C::select(total.lt(c(1e-19)), c(1e19), one);
        let e = times(e, [scale; 4]);
        let total = total * scale;
        let by = C::keep(
            zero.lt(total),
            C::quotient(one, total.max(c(f32::MIN_POSITIVE))),
        );
        let p = times(e, [by; 4]);
        let (first, last) = (p[0] + p[1], p[2] + p[3]);
        let later = [p[1] + last, last, p[3]];
        Self {
            selection: p,
            bounds: [
                C::select(zero.lt(later[0]), p[0], two),
                C::select(zero.lt(later[1]), first, two),
                C::select(zero.lt(later[2]), first + p[2], two),
            ],
            start: [zero, p[0], first, first + p[2]],
            start_less_one: [-one, -later[0], -later[1], -later[2]],
            kept,
        }
    }

    /// Returns the mixture in its storage form.
    #[inline(always)]
    pub(super) fn store(self) -> Mixture<C::Stored> {
        Mixture {
            selection: store4(self.selection),
            bounds: store3(self.bounds),
            start: store4(self.start),
            start_less_one: store4(self.start_less_one),
            kept: store4(self.kept),
        }
    }
}
