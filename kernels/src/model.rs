//! For authors of models: traits, their inputs and results, and the parts that the built-in models are made of.
//!
//! Implement [`LobeModel`] for a model given by its lobes, [`Bell`] for another bell in the published model, and [`Model`] for
//! one that computes several lobes together. Vectors are in [`simd`](crate::simd), and elementary functions in [`math`].

pub(crate) mod conserving;
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

/// Scattering model, written once over [`Lanes`].
///
/// [`Material`](crate::Material) turns a model into scalar calls, calls of eight lanes (eight directions at one shading point, or
/// eight shading points), run-time dispatch and calls on columns. Most authors implement [`LobeModel`], which needs less and
/// provides a `Model`; this trait is for models that compute several lobes together, as the published one does.
///
/// # What an implementation promises
///
/// - Functions are total: for every finite input the results are finite and at least 0, and nothing panics.
/// - Non-finite directions evaluate to zero. A non-finite `wo` makes every value, density and albedo 0 and discards every sample,
///   and a non-finite `wi` makes its own value and density 0. NaN among the uniform numbers discards the sample.
/// - `sample` draws from the density that `eval` reports. A discarded sample has slot -1, and its value, pdf and weight are 0; the
///   model does not draw again.
/// - `prepare_one` returns the bits that `prepare` returns for one lane, in every build. `restrict` does not use `mul_add`, because
///   it runs in lanes that may or may not fuse.
/// - Every function over lanes, and every function it calls, is `#[inline(always)]`, so that the dispatched entry points contain no
///   call and the model runs as fast as the built-in ones. Array `map` and closures over lanes count as calls.
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

    /// Model whose calls at a shading point serve this one: `Self`, or the model that this one prepares otherwise, as [`Conserving`]
    /// does. Its `eval`, `lobes`, `sample`, `albedo` and `conserving` must have the same results, and are compiled once for both.
    type Inner: Model<
            Inner = Self::Inner,
            Prepared<f32> = Self::Prepared<f32>,
            Prepared<f32x8> = Self::Prepared<f32x8>,
        >;

    /// Names of the lobes in slot order, at most [`Lobe::COUNT`] of them.
    const LOBES: &'static [&'static str];
    /// True if the parameters alone limit how much light returns, as albedos or absorption do, so that [`Conserving`] and
    /// [`conserving`](Self::conserving) change nothing.
    const CONSERVES: bool;

    /// True if [`integrates`](Self::integrates) is implemented.
    ///
    /// Provided: false.
    const INTEGRATES: bool = false;

    /// Computes the constants of a material from its parameters.
    fn material(&self, params: &Self::Params) -> Self::Material<f32>;

    /// Computes everything that depends on the material and the hit alone (section 3.3 of the paper).
    fn prepare<L: Lanes, C: Broadcast<L>>(
        material: &Self::Material<C>,
        hit: Hit<L>,
    ) -> Self::Prepared<L::Stored>;

    /// Prepares one hit. A model whose lobes take the same steps may compute several lobes in the lanes of one vector here.
    #[inline(always)]
    fn prepare_one(material: &Self::Material<f32>, hit: Hit<f32>) -> Self::Prepared<f32> {
        Self::prepare::<f32, f32>(material, hit)
    }

    /// Returns the shading point with only the lobes of `lobes`: the others neither scatter nor are sampled.
    fn restrict<C: Lanes + Broadcast<C>>(
        prepared: &Self::Prepared<C>,
        lobes: LobeMask,
    ) -> Self::Prepared<C>;

    /// Evaluates S and the density of sampling at the direction `wi`.
    fn eval<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>, wi: Vec3x<L>) -> Eval<L>;

    /// Evaluates each lobe's value, colour and own density at `wi`.
    fn lobes<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        wi: Vec3x<L>,
    ) -> PerLobe<LobeEval<L>>;

    /// Draws a direction by three uniform numbers in `[0, 1)`. The first number chooses the lobe, and may be used again within the
    /// lobe.
    fn sample<L: Lanes, C: Broadcast<L>>(
        prepared: &Self::Prepared<C>,
        xi: [L; 3],
    ) -> SampleLanes<L>;

    /// Draws the direction of [`sample`](Self::sample) and the slot of its lobe, for models that add lobes to this one and evaluate both
    /// at any direction. A direction without value and density may have any slot.
    ///
    /// Provided: those of `sample`, which computes more.
    #[inline(always)]
    fn draw<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>, xi: [L; 3]) -> (Vec3x<L>, L) {
        let SampleLanes { wi, slot, .. } = Self::sample(prepared, xi);
        (wi, slot)
    }

    /// Estimates the albedo of all lobes together, as the mean over the channels. Models that add lobes to this one choose between both
    /// by their energies. Estimates use no `mul_add`, as [`restrict`](Self::restrict) calls them.
    ///
    /// Provided: the mean of [`albedo`](Self::albedo), which costs more than an estimate.
    #[inline(always)]
    fn energy<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>) -> L {
        let PerLobe(lobes) = Self::albedo::<L, C>(prepared);
        let (mut sum, mut lobe) = (L::splat(0.0), 0);
        while lobe < Self::LOBES.len() {
            let [r, g, b] = lobes[lobe];
            sum = sum + (r + g + b) * (1.0 / 3.0);
            lobe += 1;
        }
        sum
    }

    /// Scales each channel of the shading point so that no more light returns than arrives, in the lanes of the mask: see
    /// [`Bsdf::conserving`](crate::Bsdf::conserving). Other lanes keep their bits.
    ///
    /// Provided: returns the shading point unchanged, for models that [conserve energy](Self::CONSERVES) by their parameters.
    #[inline(always)]
    fn conserving<L: Lanes>(
        prepared: &Self::Prepared<L::Stored>,
        _lanes: L::Mask,
    ) -> Self::Prepared<L::Stored> {
        *prepared
    }

    /// Computes the constants of a material that [`fitted`](Self::fitted) reads.
    ///
    /// Provided: those of [`raw_fit`](Self::raw_fit).
    #[inline]
    fn fit(_material: &Self::Material<f32>) -> Self::Fit<f32> {
        Self::raw_fit()
    }

    /// Returns the constants with which [`fitted`](Self::fitted) changes nothing, for materials that conserve no energy.
    ///
    /// Provided: zeros.
    #[inline]
    #[must_use]
    fn raw_fit<C: Scalar + From<f32>>() -> Self::Fit<C> {
        LaneStruct::make(&Path::Root, &mut |_| 0.0.into())
    }

    /// Scales the shading point like [`conserving`](Self::conserving), but reads the constants of the material instead of
    /// integrating the lobes. Where the constants are [`unfit`](Self::unfit), it returns the shading point unchanged.
    ///
    /// Provided: returns the shading point unchanged.
    #[inline(always)]
    fn fitted<L: Lanes, C: Broadcast<L>>(
        _fit: &Self::Fit<C>,
        prepared: &Self::Prepared<L::Stored>,
    ) -> Self::Prepared<L::Stored> {
        *prepared
    }

    /// Returns 1 where the constants of [`fitted`](Self::fitted) are not accurate enough, so that [`conserving`](Self::conserving)
    /// has to follow, and 0 elsewhere.
    ///
    /// Provided: 0.
    #[inline(always)]
    fn unfit<L: Lanes, C: Broadcast<L>>(_fit: &Self::Fit<C>) -> L {
        L::splat(0.0)
    }

    /// Returns 1 where [`conserving`](Self::conserving) has to follow [`prepare`](Self::prepare), and 0 elsewhere. Handles call this
    /// once per call, outside `prepare`, because an integral there would take its registers.
    ///
    /// Provided: 0.
    #[inline(always)]
    fn integrates<L: Lanes, C: Broadcast<L>>(_material: &Self::Material<C>) -> L {
        L::splat(0.0)
    }

    /// Returns the directional albedo of each lobe, linear RGB: the integral of `S cos theta_i` over all `wi`.
    fn albedo<L: Lanes, C: Broadcast<L>>(prepared: &Self::Prepared<C>) -> PerLobe<[L; 3]>;
}

/// Hit of a ray on a fibre: the direction towards the viewer, and the offset from the fibre's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<L = f32> {
    /// Direction towards the viewer, in the fibre's frame, unit.
    pub wo: Vec3x<L>,
    /// Offset across the fibre, in radii in `[-1, 1]`: the sine of the angle about u from the outward normal of the hit, taken in
    /// the normal plane, to `wo`. The offset is positive if a quarter turn from v to w leads from the normal towards `wo`
    /// ([`FiberFrame::offset`](crate::FiberFrame::offset)). Far-field models, such as the published one, ignore it.
    pub h: L,
}

impl<L: Lanes> Hit<L> {
    /// Makes a hit at the offset `h` from the axis, or eight hits, one per lane.
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

    /// Returns the hit with the direction v in place of a `wo` that is not finite, and whether `wo` was finite: towards any other no lobe
    /// scatters.
    #[inline(always)]
    #[must_use]
    pub fn finite(self) -> (Self, L::Mask) {
        let (one, infinity) = (L::splat(1.0), L::splat(f32::INFINITY));
        L::stage("whether wo is finite: no lobe scatters towards any other");
        let Vec3x { x, y, z } = self.wo;
        let finite = L::and(
            L::and(x.abs().lt(infinity), y.abs().lt(infinity)),
            z.abs().lt(infinity),
        );
        let wo = Vec3x::new(
            L::keep(finite, x),
            L::select(finite, y, one),
            L::keep(finite, z),
        );
        (Self { wo, ..self }, finite)
    }
}

impl Hit {
    /// Reads every number [alone](crate::simd::Schedule::alone).
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
    /// Makes a hit on the axis (`h` is 0).
    ///
    /// A near-field model, such as Chiang's, scatters differently at every offset, so that hits on the axis alone do not give its
    /// far field: draw `h` per hit, or pass it to [`Hit::new`].
    #[inline(always)]
    fn from(wo: Vec3) -> Self {
        Self {
            wo: wo.into(),
            h: 0.0,
        }
    }
}

impl From<Vec3A> for Hit {
    /// Makes a hit on the axis (`h` is 0).
    #[inline(always)]
    fn from(wo: Vec3A) -> Self {
        Self {
            wo: wo.into(),
            h: 0.0,
        }
    }
}

impl From<&Vec3x<f32x8>> for Hit8 {
    /// Makes hits on the axes (`h` is 0).
    #[inline(always)]
    fn from(wo: &Vec3x<f32x8>) -> Self {
        Self {
            wo: *wo,
            h: f32x8::ZERO,
        }
    }
}

impl From<&Self> for Hit8 {
    /// Copies hits from a reference, so that only vector code reads them.
    #[inline(always)]
    fn from(hits: &Self) -> Self {
        *hits
    }
}

/// Value and density of the BSDF for a direction, per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eval<L = f32> {
    /// Scattering function S without the cosine, linear RGB, per steradian.
    pub value: [L; 3],
    /// Density of sampling the direction, per steradian.
    pub pdf: L,
}

/// Values and densities of eight directions, one per lane.
pub type Eval8 = Eval<f32x8>;

impl<L: Lanes> Eval<L> {
    /// Returns the lanes in their storage form.
    #[inline(always)]
    pub(crate) fn store(self) -> Eval<L::Stored> {
        Eval {
            value: crate::simd::lanes::store3(self.value),
            pdf: self.pdf.store(),
        }
    }
}

impl Eval8 {
    /// Returns the value and the density of one lane.
    ///
    /// # Panics
    ///
    /// Panics if `lane` is above 7.
    #[inline]
    #[must_use]
    pub fn lane(&self, lane: usize) -> Eval {
        Eval {
            value: self.value.map(|c| c.as_array()[lane]),
            pdf: self.pdf.as_array()[lane],
        }
    }
}

/// Value, colour and density of one lobe at a direction, per lane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LobeEval<L = f32> {
    /// The lobe's part of S without its colour, per steradian, so that a spectral host can apply its own colour.
    pub value: L,
    /// The lobe's colour, linear RGB: `value * color` summed over the lobes is S.
    pub color: [L; 3],
    /// Density of sampling the direction from this lobe alone, per steradian.
    pub pdf: L,
}

/// Value, colour and density of one lobe at eight directions, one per lane.
pub type LobeEval8 = LobeEval<f32x8>;

impl<L: Lanes> LobeEval<L> {
    /// Makes the result of a lobe at a direction from its value, colour and density.
    #[inline(always)]
    #[must_use]
    pub const fn new(value: L, color: [L; 3], pdf: L) -> Self {
        Self { value, color, pdf }
    }

    /// Returns the result of an empty slot: value, colour and density are 0.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        let zero = L::splat(0.0);
        Self::new(zero, [zero; 3], zero)
    }

    /// Returns the lanes in their storage form.
    #[inline(always)]
    pub(crate) fn store(self) -> LobeEval<L::Stored> {
        LobeEval {
            value: self.value.store(),
            color: crate::simd::lanes::store3(self.color),
            pdf: self.pdf.store(),
        }
    }
}

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

/// Direction sampled at one shading point, with its value, density and weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Direction towards the light, in the fibre's frame, unit.
    pub wi: Vec3,
    /// S at `wi`, without the cosine, linear RGB, per steradian.
    pub value: [f32; 3],
    /// Density of `wi`, per steradian, above 0.
    pub pdf: f32,
    /// Throughput weight `value * cos theta_i / pdf`.
    pub weight: [f32; 3],
    /// Chosen lobe. Value and pdf are sums over all lobes.
    pub lobe: Lobe,
}

impl Sample {
    /// Returns the sample of one lane, or `None` if the sample was discarded.
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

/// Eight sampled directions, of one shading point or of one shading point per lane.
///
/// A discarded lane has value, pdf and weight 0 and slot -1, and counts as a sample whose contribution is 0.
pub type Sample8 = SampleLanes<f32x8>;

impl Sample8 {
    /// Returns the lanes that were not discarded as a bit set: bit `i` for lane `i`.
    #[inline]
    #[must_use]
    pub fn live(&self) -> u8 {
        let mut bits = 0;
        for (lane, pdf) in self.pdf.as_array().iter().enumerate() {
            bits |= u8::from(*pdf > 0.0) << lane;
        }
        bits
    }

    /// Returns the sample of one lane, or `None` if the sample was discarded.
    ///
    /// # Panics
    ///
    /// Panics if `lane` is above 7.
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
