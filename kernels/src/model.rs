//! For authors of models: the traits, their inputs and results, and the parts that the models here are made of.
//!
//! Implement [`LobeModel`] for a model given by its lobes, [`Bell`] for another bell in the published model, and [`Model`] for
//! one that computes several lobes together. Vectors are in [`simd`](crate::simd), elementary functions in [`math`].

mod conserving;
mod direction;
pub(crate) mod lobe;
mod lobe_model;
pub mod math;
pub(crate) mod precision;

pub use crate::hair::{Bell, FourBells, GRAZING, MatchedBell, TwoBells};
pub use crate::handle::{DynBsdf, DynBsdf8};
pub use conserving::Conserving;
pub use direction::Direction;
pub use lobe::{Lobe, LobeMask, PerLobe};
pub use lobe_model::LobeModel;
#[doc(hidden)]
pub use lobe_model::Mixed;
pub use precision::{Precision, Single};

use crate::simd::{Broadcast, LaneStruct, Lanes, Path, Scalar, Schedule, Vec3x};
use glam::{Vec3, Vec3A};
use wide::f32x8;

/// A scattering model, written once over [`Lanes`].
///
/// [`Material`](crate::Material) makes scalar calls, eight lanes (eight directions at one shading point, or eight shading points),
/// run-time dispatch and slices of it. Authors implement [`LobeModel`], which needs less and gives a
/// `Model`; this trait is for models that compute several lobes together, as the published one does.
///
/// # What an implementation promises
///
/// - Functions are total: for every finite input the results are finite and at least 0, and nothing panics.
/// - A direction that is not finite is black: a `wo` with NaN or an infinity makes every value, density and albedo 0 and every
///   sample discarded, a `wi` its own value and density 0; NaN among the uniform numbers discards the sample.
/// - `sample` draws from the density that `eval` reports. A discarded sample has slot -1 and no value, pdf or weight; a
///   model does not draw again.
/// - `prepare_one` gives the bits of `prepare` of one lane, in every build. `restrict` does not use `mul_add`: it runs in lanes
///   that may or may not fuse.
/// - Every function over lanes is `#[inline(always)]`, and so is all it calls: the dispatched entry points then
///   contain no call, and the model runs at the speed of ours. Array `map` and closures over lanes are calls.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scattering model",
    note = "a bell is part of one: `Published(Gaussian)`, `Matched::new(Gaussian)`"
)]
pub trait Model: Copy {
    /// Checked parameters of a material.
    type Params;
    /// Constants of a material: one number each (`C = f32`), or one per lane (`C = f32x8`).
    type Material<C: Scalar>: LaneStruct<Number = C, One = Self::Material<f32>, Eight = Self::Material<f32x8>>;
    /// Constants of a shading point.
    type Prepared<C: Scalar>: LaneStruct<Number = C, One = Self::Prepared<f32>, Eight = Self::Prepared<f32x8>>;

    /// Constants that [`Conserving`] adds to those of a material: `[C; 0]` for none.
    type Fit<C: Scalar>: LaneStruct<Number = C, One = Self::Fit<f32>, Eight = Self::Fit<f32x8>>;

    /// Names of the lobes, in slot order: at most [`Lobe::COUNT`].
    const LOBES: &'static [&'static str];
    /// Whether the parameters alone decide how much light returns, as albedos or absorption do: [`Conserving`] and
    /// [`conserving`](Self::conserving) change nothing then.
    const CONSERVES: bool;

    /// Whether [`integrates`](Self::integrates) is implemented.
    ///
    /// Provided: no.
    const INTEGRATES: bool = false;

    /// The constants of a material.
    fn material(&self, params: &Self::Params) -> Self::Material<f32>;

    /// Everything that depends on the material and the hit alone (section 3.3 of the paper).
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &Self::Material<C>,
        hit: Hit<L>,
    ) -> Self::Prepared<L::Stored>;

    /// Prepares one hit. A model whose lobes take the same steps may put them into lanes here.
    #[inline(always)]
    fn prepare_one(material: &Self::Material<f32>, hit: Hit<f32>) -> Self::Prepared<f32> {
        Self::prepare::<f32, f32>(material, hit)
    }

    /// The shading point with only the lobes of `lobes`: the others neither scatter nor are sampled.
    fn restrict<C: Lanes>(prepared: &Self::Prepared<C>, lobes: LobeMask) -> Self::Prepared<C>;

    /// Value and density of the direction `wi`.
    fn eval<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>, wi: Vec3x<L>) -> Eval<L>;

    /// Each lobe's value, colour and own density at `wi`.
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        wi: Vec3x<L>,
    ) -> PerLobe<LobeEval<L>>;

    /// A direction drawn with three uniform numbers in `[0, 1)`. The first chooses the lobe, and may serve again.
    fn sample<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        xi: [L; 3],
    ) -> SampleLanes<L>;

    /// The shading point with each channel scaled so that no more light returns than arrives, in the lanes of the mask:
    /// see [`Bsdf::conserving`](crate::Bsdf::conserving). Other lanes keep their bits.
    ///
    /// Provided: the shading point as it is, for models that [conserve energy](Self::CONSERVES) by their parameters.
    #[inline(always)]
    fn conserving<L: Lanes>(
        prepared: &Self::Prepared<L::Stored>,
        _lanes: L::Mask,
    ) -> Self::Prepared<L::Stored> {
        *prepared
    }

    /// The constants of [`fitted`](Self::fitted) for a material.
    ///
    /// Provided: zeros.
    #[inline]
    fn fit(_material: &Self::Material<f32>) -> Self::Fit<f32> {
        LaneStruct::make(&Path::Root, &mut |_| 0.0)
    }

    /// As [`conserving`](Self::conserving), by the constants of the material; the shading point as it is where they are
    /// [`unfit`](Self::unfit).
    ///
    /// Provided: the shading point as it is.
    #[inline(always)]
    fn fitted<L: Lanes, C: Broadcast<L>>(
        _fit: &Self::Fit<C>,
        prepared: &Self::Prepared<L::Stored>,
    ) -> Self::Prepared<L::Stored> {
        *prepared
    }

    /// 1 where the constants of [`fitted`](Self::fitted) are not accurate enough, so that [`conserving`](Self::conserving) has
    /// to follow, else 0.
    ///
    /// Provided: 0.
    #[inline(always)]
    fn unfit<L: Lanes, C: Broadcast<L>>(_fit: &Self::Fit<C>) -> L {
        L::splat(0.0)
    }

    /// 1 where [`conserving`](Self::conserving) has to follow [`prepare`](Self::prepare), else 0. Handles ask once per call and not
    /// in `prepare`, whose registers an integral would take.
    ///
    /// Provided: 0.
    #[inline(always)]
    fn integrates<L: Lanes, C: Broadcast<L>>(_material: &Self::Material<C>) -> L {
        L::splat(0.0)
    }

    /// Directional albedo of each lobe, linear RGB: the integral of `S cos theta_i` over all `wi`.
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>) -> PerLobe<[L; 3]>;
}

/// The hit of a ray on a fibre: the direction it came from, and its offset from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<L = f32> {
    /// Towards the viewer, in the fibre's frame, unit.
    pub wo: Vec3x<L>,
    /// Offset across the fibre, in radii in `[-1, 1]`: the sine of the angle about u from the outward normal of the hit,
    /// taken in the normal plane, to `wo`. Positive where a quarter turn from v to w leads from the normal towards `wo`
    /// ([`FiberFrame::offset`](crate::FiberFrame::offset)). Models of the far field, such as the published one, ignore it.
    pub h: L,
}

impl<L: Lanes> Hit<L> {
    /// A hit off the axis; of eight lanes, one per lane.
    ///
    /// - Domain: `h` is clamped to `[-1, 1]`; NaN counts as 0.
    ///
    /// ```
    /// use glam::Vec3;
    /// use hairis::Hit;
    /// assert_eq!(Hit::new(Vec3::Y, 1.5).h, 1.0);
    /// ```
    #[inline(always)]
    #[must_use]
    pub fn new(wo: impl Into<Vec3x<L>>, h: L) -> Self {
        let one = L::splat(1.0);
        let number = L::or(h.lt(one), (-one).lt(h));
        Self {
            wo: wo.into(),
            h: L::keep(number, (-one).max(one.min(h))),
        }
    }
}

impl Hit {
    /// Every number [alone](crate::simd::Schedule::alone).
    #[inline(always)]
    pub(crate) fn alone(self) -> Self {
        Self {
            wo: self.wo.alone(),
            h: self.h.alone(),
        }
    }
}

/// Eight hits, one per lane.
pub type Hit8 = Hit<f32x8>;

impl From<Vec3> for Hit {
    /// A hit on the axis (`h` is 0).
    ///
    /// That is one of the hits that a near-field model, such as Chiang's, distinguishes, and not its far field: draw `h` per
    /// hit, or give it by [`Hit::new`].
    #[inline(always)]
    fn from(wo: Vec3) -> Self {
        Self {
            wo: wo.into(),
            h: 0.0,
        }
    }
}

impl From<Vec3A> for Hit {
    /// A hit on the axis (`h` is 0).
    #[inline(always)]
    fn from(wo: Vec3A) -> Self {
        Self {
            wo: wo.into(),
            h: 0.0,
        }
    }
}

impl From<&Vec3x<f32x8>> for Hit8 {
    /// Hits on the axes (`h` is 0).
    #[inline(always)]
    fn from(wo: &Vec3x<f32x8>) -> Self {
        Self {
            wo: *wo,
            h: f32x8::ZERO,
        }
    }
}

impl From<&Self> for Hit8 {
    /// Copies hits by reference, so that vector code alone reads them.
    #[inline(always)]
    fn from(hits: &Self) -> Self {
        *hits
    }
}

/// Value and density of a direction, per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eval<L = f32> {
    /// The scattering function S, without the cosine, linear RGB, per steradian.
    pub value: [L; 3],
    /// Density of sampling the direction, per steradian.
    pub pdf: L,
}

/// Eight values and densities.
pub type Eval8 = Eval<f32x8>;

impl<L: Lanes> Eval<L> {
    /// The lanes in their storage form.
    #[inline(always)]
    pub(crate) fn store(self) -> Eval<L::Stored> {
        Eval {
            value: crate::simd::lanes::store3(self.value),
            pdf: self.pdf.store(),
        }
    }
}

impl Eval8 {
    /// One lane.
    ///
    /// # Panics
    ///
    /// If `lane` is above 7.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Eval {
        Eval {
            value: self.value.map(|c| c.as_array()[lane]),
            pdf: self.pdf.as_array()[lane],
        }
    }
}

/// One lobe at one direction, per lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LobeEval<L = f32> {
    /// The lobe's part of S without its colour, per steradian: a spectral host applies its own.
    pub value: L,
    /// The lobe's colour, linear RGB: `value * color` summed over the lobes is S.
    pub color: [L; 3],
    /// Density of sampling the direction from this lobe alone, per steradian.
    pub pdf: L,
}

/// One lobe at eight directions.
pub type LobeEval8 = LobeEval<f32x8>;

impl<L: Lanes> LobeEval<L> {
    /// A lobe at a direction.
    #[inline(always)]
    #[must_use]
    pub const fn new(value: L, color: [L; 3], pdf: L) -> Self {
        Self { value, color, pdf }
    }

    /// No lobe: all 0.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        let zero = L::splat(0.0);
        Self::new(zero, [zero; 3], zero)
    }

    /// The lanes in their storage form.
    #[inline(always)]
    pub(crate) fn store(self) -> LobeEval<L::Stored> {
        LobeEval {
            value: self.value.store(),
            color: crate::simd::lanes::store3(self.color),
            pdf: self.pdf.store(),
        }
    }
}

/// A sampled direction, per lane; value, pdf and weight 0 and slot -1 where it was discarded. What models return; users
/// see [`Sample`] and [`Sample8`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleLanes<L> {
    /// Towards the light, in the fibre's frame, unit.
    pub wi: Vec3x<L>,
    /// S at `wi`, without the cosine, linear RGB, per steradian.
    pub value: [L; 3],
    /// Density of `wi`, per steradian.
    pub pdf: L,
    /// `value * cos theta_i / pdf`.
    pub weight: [L; 3],
    /// Slot of the lobe that was chosen, as a number; -1 if the sample was discarded.
    pub slot: L,
}

impl<L: Lanes> SampleLanes<L> {
    /// The lanes in their storage form.
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

/// A direction sampled at one shading point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Towards the light, in the fibre's frame, unit.
    pub wi: Vec3,
    /// S at `wi`, without the cosine, linear RGB, per steradian.
    pub value: [f32; 3],
    /// Density of `wi`, per steradian, above 0.
    pub pdf: f32,
    /// Throughput weight `value * cos theta_i / pdf`.
    pub weight: [f32; 3],
    /// The lobe that was chosen; value and pdf are those of all lobes.
    pub lobe: Lobe,
}

impl Sample {
    /// The sample of one lane; `None` if it was discarded.
    #[inline]
    pub(crate) fn from_lanes(lanes: &SampleLanes<f32>) -> Option<Self> {
        let lobe = Lobe::from_number(lanes.slot)?;
        Some(Self {
            wi: lanes.wi.into(),
            value: lanes.value,
            pdf: lanes.pdf,
            weight: lanes.weight,
            lobe,
        })
    }
}

/// Eight sampled directions: of one shading point, or one of each of eight.
///
/// A discarded lane has value, pdf and weight 0 and slot -1, and counts as a sample whose contribution is 0.
pub type Sample8 = SampleLanes<f32x8>;

impl Sample8 {
    /// The lanes that were not discarded: bit `i` for lane `i`.
    #[inline]
    #[must_use]
    pub fn live(&self) -> u8 {
        let mut bits = 0;
        for (lane, pdf) in self.pdf.as_array().iter().enumerate() {
            bits |= u8::from(*pdf > 0.0) << lane;
        }
        bits
    }

    /// One lane; `None` if it was discarded.
    ///
    /// # Panics
    ///
    /// If `lane` is above 7.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Option<Sample> {
        let at = |x: &f32x8| x.as_array()[lane];
        Sample::from_lanes(&SampleLanes {
            wi: self.wi.lane(lane).into(),
            value: [at(&self.value[0]), at(&self.value[1]), at(&self.value[2])],
            pdf: at(&self.pdf),
            weight: [
                at(&self.weight[0]),
                at(&self.weight[1]),
                at(&self.weight[2]),
            ],
            slot: at(&self.slot),
        })
    }
}
