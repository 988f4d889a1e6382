//! Energy conservation of materials and BSDFs.

use crate::handle::bsdf::{Bsdf, Bsdf8};
use crate::handle::material::{Material, Material8};
use crate::model::Model;
use crate::model::conserving::{Conserving, ConservingMaterial};
use crate::simd::{Broadcast, Kernel, Lanes};
use wide::f32x8;

impl<M: Model> Bsdf<M> {
    /// Returns the BSDF with each channel divided by its albedo where the albedo is above 1: see [`Conserving`].
    ///
    /// Call this for parameters that vary per hit, because it integrates the lobes where [`Conserving`] reads a fit of the material.
    /// To conserve energy for some lobes alone, call `with_lobes` first: `with_lobes` of a BSDF that conserves energy keeps the
    /// factors of all lobes.
    #[inline]
    #[must_use]
    pub fn conserving(&self) -> Self {
        Self {
            prepared: M::conserving::<f32>(&self.prepared, true),
            level: self.level,
        }
    }
}

impl<M: Model> Bsdf8<M> {
    /// Returns the BSDFs with each channel divided by its albedo where the albedo is above 1: see [`Bsdf::conserving`].
    #[inline]
    #[must_use]
    pub fn conserving(&self) -> Self {
        self.conserving_where(f32x8::ONE)
    }

    /// Conserves energy in the lanes whose number is above 0.
    #[cold]
    #[inline(never)]
    pub(crate) fn conserving_where(&self, lanes: f32x8) -> Self {
        let level = self.level;
        let kernel = Integrate::<M::Inner> {
            prepared: &self.prepared,
            lanes,
        };
        level.run_into(kernel, |prepared| Self { prepared, level })
    }
}

/// Kernel of [`Model::conserving`] for eight shading points.
struct Integrate<'a, M: Model> {
    prepared: &'a M::Prepared<f32x8>,
    lanes: f32x8,
}

impl<M: Model> Kernel for Integrate<'_, M> {
    type Output = M::Prepared<f32x8>;
    const MANY_REGISTERS: bool = false;

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> M::Prepared<f32x8> {
        M::conserving::<L>(self.prepared, L::splat(0.0).lt(self.lanes.lanes()))
    }
}

impl<M: Model> Material<Conserving<M>> {
    /// Returns true if every hit integrates the lobes, because the fit of this material is not accurate enough. Calls then take many
    /// times as long, with results as good.
    ///
    /// Lobes narrower than a degree, or intensities far above 1, may need the integrals; everyday hair does not.
    #[inline]
    #[must_use]
    pub fn integrates(&self) -> bool {
        M::unfit::<f32, f32>(&self.constants.fit) > 0.0
    }

    /// Returns the material with energy conservation, whether it conserves energy already or is [`raw`](Self::raw). The fit is made
    /// anew.
    #[inline]
    #[must_use]
    pub fn conserving(&self) -> Self {
        let inner = self.constants.inner;
        let fit = M::fit(&inner);
        Self {
            constants: ConservingMaterial { inner, fit },
            level: self.level,
        }
    }

    /// Returns the material without energy conservation, like [`from`](Self::from) of a [`Material<M>`].
    #[inline]
    #[must_use]
    pub fn raw(&self) -> Self {
        self.inner().into()
    }

    /// Returns the material of the model that conserves no energy, with the bits of [`raw`](Self::raw) and hits in less time.
    #[inline]
    #[must_use]
    pub fn inner(&self) -> Material<M> {
        Material {
            constants: self.constants.inner,
            level: self.level,
        }
    }
}

/// Conversions of a raw material to the type of one that conserves energy, with the same bits: for hosts that choose at run time,
/// because a second type would double their code. Constants that change nothing are read all the same, which
/// [`inner`](Material::inner) avoids.
macro_rules! from_raw_material {
    ($($Handle:ident)*) => { $(
        impl<M: Model> From<$Handle<M>> for $Handle<Conserving<M>> {
            #[inline]
            fn from(raw: $Handle<M>) -> Self {
                let constants = ConservingMaterial {
                    inner: raw.constants,
                    fit: M::raw_fit(),
                };
                Self {
                    constants,
                    level: raw.level,
                }
            }
        }
    )* };
}
from_raw_material! { Material Material8 }

/// Conversions of a raw BSDF to the type of one whose material conserves energy: both have the same constants.
macro_rules! from_raw_bsdf {
    ($($Handle:ident)*) => { $(
        impl<M: Model> From<$Handle<M>> for $Handle<Conserving<M>> {
            #[inline]
            fn from(raw: $Handle<M>) -> Self {
                Self {
                    prepared: raw.prepared,
                    level: raw.level,
                }
            }
        }
    )* };
}
from_raw_bsdf! { Bsdf Bsdf8 }
