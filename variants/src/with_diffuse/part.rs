//! Constants of a diffuse part: of its cylinder, and of the choice between the model and the cylinder.

use crate::cylinder::{self, Azimuth};
use hairis::Hit;
use hairis::model::Direction;
use hairis::simd::{Broadcast, Lanes, Scalar, lane_struct, lanes3, store3};

lane_struct! {
    /// Constants of a diffuse part per material.
    pub struct DiffuseMaterial {
        /// Share of the model.
        pub(super) share: C,
        /// Albedo of the cylinder, linear RGB.
        pub(super) color: [C; 3],
    }
}

lane_struct! {
    /// Constants of a diffuse part per shading point.
    pub struct DiffusePrepared {
        /// Part of `wo` in the normal plane: v and w, and its length.
        pub(super) plane_o: [C; 3],
        /// Reciprocal of that length.
        pub(super) inv_plane_o: C,
        /// Share of the model.
        pub(super) share: C,
        /// Albedo of the cylinder, linear RGB.
        pub(super) color: [C; 3],
        /// 1 if the cylinder scatters, 0 if it does not.
        pub(super) kept: C,
        /// Choice between the model and the cylinder.
        pub(super) choice: DiffuseChoice<C>,
    }
}

lane_struct! {
    /// Choice between a model and its diffuse part.
    pub(super) struct DiffuseChoice {
        /// Probability of the model, and of the cylinder.
        pub(super) selection: [C; 2],
        /// First number above those that choose the model.
        pub(super) bound: C,
    }
}

/// Largest energy, so that the sum of two does not overflow.
const MOST_ENERGY: f32 = f32::MAX / 8.0;

/// Smallest probability of the model or of the cylinder beside the other.
const LEAST_SHARE: f32 = 1e-20;

impl<L: Lanes> DiffuseMaterial<L> {
    /// Computes the constants of a share and a colour.
    #[inline]
    pub(super) fn new(diffuse: L, color: [L; 3]) -> Self {
        Self {
            share: L::splat(1.0) - diffuse,
            color: [diffuse * color[0], diffuse * color[1], diffuse * color[2]],
        }
    }
}

impl<L: Lanes> DiffuseChoice<L> {
    /// Chooses by the energies of the model and of the cylinder, without `mul_add`. Without any energy both probabilities are 0.
    #[inline(always)]
    pub(super) fn new(model: L, cylinder: L) -> Self {
        let c = L::splat;
        let (zero, one) = (c(0.0), c(1.0));
        L::stage("probability of the model, and of the diffuse lobe");
        let (model, cylinder) = (model.min(c(MOST_ENERGY)), cylinder.min(c(MOST_ENERGY)));
        let total = model + cylinder;
        // A sum of denormals has no reciprocal: it is scaled first.
        let scale = L::select(total.lt(c(1e-19)), c(1e19), one);
        let by = L::quotient(one, (total * scale).max(c(f32::MIN_POSITIVE)));
        // The larger one is a difference from 1, so that it is 1 without the other.
        let is_rare = cylinder.lt(model);
        let less = L::select(is_rare, cylinder, model) * scale * by;
        // Rarer than any number but 0, which would always draw it, although its own lobes may be too faint to be drawn.
        let less = L::keep(c(LEAST_SHARE).lt(less), less);
        let rest = L::keep(zero.lt(total), one - less);
        let (q, p) = (
            L::select(is_rare, rest, less),
            L::select(is_rare, less, rest),
        );
        Self {
            selection: [q, p],
            bound: L::select(zero.lt(p), q, c(2.0)),
        }
    }

    #[inline(always)]
    pub(super) fn store(self) -> DiffuseChoice<L::Stored> {
        DiffuseChoice {
            selection: [self.selection[0].store(), self.selection[1].store()],
            bound: self.bound.store(),
        }
    }
}

/// Returns the energy of a cylinder with this albedo.
#[inline(always)]
pub(super) fn mean<L: Lanes>([r, g, b]: [L; 3]) -> L {
    (r + g + b) * (1.0 / 3.0)
}

impl<C: Scalar> DiffuseMaterial<C> {
    /// Prepares a hit, with a choice that is still to be made.
    #[inline(always)]
    pub(super) fn prepare<L: Lanes>(&self, hit: Hit<L>) -> DiffusePrepared<L::Stored>
    where
        C: Broadcast<L>,
    {
        let zero = L::splat(0.0);
        let (Hit { wo, .. }, finite) = hit.finite();
        let (plane_o, inv_plane) = cylinder::plane(wo, Direction::normalized(wo).vector);
        DiffusePrepared {
            plane_o: store3(plane_o),
            inv_plane_o: inv_plane.store(),
            share: self.share.lanes().store(),
            color: store3(lanes3(&self.color)),
            kept: L::keep(finite, L::splat(1.0)).store(),
            choice: DiffuseChoice {
                selection: [zero.store(), zero.store()],
                bound: zero.store(),
            },
        }
    }
}

impl<C: Scalar> DiffusePrepared<C> {
    /// Evaluates S of the cylinder without its colour, and its density.
    #[inline(always)]
    pub(super) fn at<L: Lanes>(&self, wi: &Direction<L>) -> [L; 2]
    where
        C: Broadcast<L>,
    {
        let azimuth = Azimuth::between(lanes3(&self.plane_o), wi);
        L::stage("value and density of the diffuse lobe");
        let value = cylinder::value(azimuth.lacking) * self.kept.lanes();
        [value, value * wi.cos_theta]
    }
}
