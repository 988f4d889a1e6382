//! Reservoirs of eight hits, each of which keeps one of the candidates that are added to it.

use super::Weighed8;
use crate::frame::Vec3x8;
use crate::handle::level_methods;
use crate::simd::lanes::{lanes3, store3};
use crate::simd::{Broadcast, Kernel, Lanes, Level, Vec3x};
use wide::f32x8;

/// Reservoir of eight hits: each lane keeps one candidate, with a probability proportional to its weight among all that were added.
///
/// After the last candidate, trace [`wi`](Self::wi) and add [`estimate`](Self::estimate) where the direction is visible. That is one
/// ray per lane; keep several reservoirs for several rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reservoir8 {
    /// Kept direction of each lane, in the fibre's frame; 0 while no candidate has had a weight.
    pub wi: Vec3x8,
    /// Contribution of the kept candidate, linear RGB.
    pub contribution: [f32x8; 3],
    /// Sum of all weights, which is the estimate of the mean over the channels if everything were visible.
    pub sum: f32x8,
    level: Level,
}

impl Default for Reservoir8 {
    /// Makes an empty reservoir, on the best instruction set of the CPU.
    #[inline]
    fn default() -> Self {
        let zero = f32x8::ZERO;
        Self {
            wi: Vec3x::new(zero, zero, zero),
            contribution: [zero; 3],
            sum: zero,
            level: Level::detect(),
        }
    }
}

impl Reservoir8 {
    level_methods! {}

    /// Adds a candidate per lane, which is kept if `u` times the sum of the weights is below the weight of the candidate. Draw `u`
    /// anew for each candidate, uniform in `[0, 1)`: one number that is rescaled runs out of bits after twenty.
    ///
    /// The candidate's weight includes the numbers of candidates of one hit: see [`Bsdf8::weigh8`](crate::Bsdf8::weigh8).
    #[inline]
    pub fn add(&mut self, wi: &Vec3x8, candidate: &Weighed8, u: &f32x8) {
        let other = Self {
            wi: *wi,
            contribution: candidate.contribution,
            sum: candidate.weight,
            level: self.level,
        };
        self.merge(&other, u);
    }

    /// Merges a reservoir of other candidates, by a uniform number `u` like [`add`](Self::add). The result is exact for the same
    /// hits, the same target, and weights that count the candidates of both. Across hits it would be biased: weigh the kept
    /// directions anew at the other hit, with the weights of Lin et al. 2022.
    #[inline]
    pub fn merge(&mut self, other: &Self, u: &f32x8) {
        *self = self.level.run(Merge {
            a: self,
            b: other,
            u,
        });
    }

    /// Returns the contribution of each lane's kept direction if the direction is visible, linear RGB.
    #[inline]
    #[must_use]
    pub fn estimate(&self) -> [f32x8; 3] {
        self.level.run(Estimate(self))
    }
}

/// Kernel that merges two reservoirs.
struct Merge<'a> {
    a: &'a Reservoir8,
    b: &'a Reservoir8,
    u: &'a f32x8,
}

impl Kernel for Merge<'_> {
    type Output = Reservoir8;
    const MANY_REGISTERS: bool = false;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> Reservoir8 {
        let Self { a, b, u } = self;
        let (u, old, added): (L, L, L) = (u.lanes(), a.sum.lanes(), b.sum.lanes());
        let sum = old + added;
        // False for a weight of 0, and for NaN as `u`.
        let taken = (u * sum).lt(added);
        let (from, to) = (Vec3x::<L>::load(&a.wi), Vec3x::<L>::load(&b.wi));
        let (old, new): ([L; 3], [L; 3]) = (lanes3(&a.contribution), lanes3(&b.contribution));
        Reservoir8 {
            wi: Vec3x::new(
                L::select(taken, to.x, from.x).store(),
                L::select(taken, to.y, from.y).store(),
                L::select(taken, to.z, from.z).store(),
            ),
            contribution: store3([
                L::select(taken, new[0], old[0]),
                L::select(taken, new[1], old[1]),
                L::select(taken, new[2], old[2]),
            ]),
            sum: sum.min(L::splat(f32::MAX)).store(),
            level: a.level,
        }
    }
}

/// Kernel that scales the contribution of the kept candidate, so that its mean over the channels is the sum of all weights.
struct Estimate<'a>(&'a Reservoir8);

impl Kernel for Estimate<'_> {
    type Output = [f32x8; 3];
    const MANY_REGISTERS: bool = false;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> [f32x8; 3] {
        let [r, g, b]: [L; 3] = lanes3(&self.0.contribution);
        let sum: L = self.0.sum.lanes();
        let c = L::splat;
        // Shares come first, at most 3, because the sum may be close to the largest float.
        let total = c(f32::MIN_POSITIVE).max(r + g + b);
        let most = c(f32::MAX);
        let scale = c(3.0) * sum;
        store3([
            (L::quotient(r, total) * scale).min(most),
            (L::quotient(g, total) * scale).min(most),
            (L::quotient(b, total) * scale).min(most),
        ])
    }
}
