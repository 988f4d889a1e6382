//! Slice calls over hits: each entry has a hit and a direction of its own.

use crate::columns::{
    EvalColumns, HitColumns, LengthError, SAMPLE, SAMPLE_OF_BOTH, SampleColumns, VALUE_PDF, WI, XI,
    check_length, in_groups,
};
use crate::handle::kernels::{AtHits, EightHits, HitEvals, HitEvalsSamples, HitRow, HitSamples};
use crate::model::Model;
use crate::simd::columns::copy_few;
use crate::simd::dispatch::clean_upper_halves;
use crate::simd::{Level, Vec3x};
use crate::{Bsdf8, Hit, Hit8, Material, Material8};
use core::fmt;
use wide::f32x8;

/// Materials of a slice call: a table, and the index of each hit's material in it.
///
/// Hits in any order on a few materials take little longer than hits sorted by material: they are brought together, as by
/// [`in_groups`]. Where each hit has a material of its own, each takes some ten times as long.
#[derive(Debug)]
pub struct MaterialTable<'a, M: Model> {
    /// The materials.
    pub materials: &'a [Material<M>],
    /// Index of each hit's material.
    pub index: &'a [u32],
}

impl<M: Model> Clone for MaterialTable<'_, M> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: Model> Copy for MaterialTable<'_, M> {}

/// Why a slice call over hits did nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum HitsError {
    /// A slice differs in length from the first.
    Length(LengthError),
    /// An index is not in the table of materials.
    Material {
        /// The hit at fault.
        hit: usize,
        /// Its index.
        index: u32,
        /// Number of materials.
        materials: usize,
    },
}

impl fmt::Display for HitsError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(error) => error.fmt(f),
            Self::Material {
                hit,
                index,
                materials,
            } => {
                write!(
                    f,
                    "index[{hit}] is {index} where the table has {materials} materials"
                )
            }
        }
    }
}

impl core::error::Error for HitsError {}

impl From<LengthError> for HitsError {
    #[inline]
    fn from(error: LengthError) -> Self {
        Self::Length(error)
    }
}

impl<M: Model> Material<M> {
    /// Value and density of many directions, each at a hit of its own on this material: `wi` by component u, v, w.
    ///
    /// The same numbers as [`prepare8`](Self::prepare8) and [`eval_pdf8`](crate::Bsdf8::eval_pdf8) give, for half the time:
    /// the constants of a hit stay in registers. Nothing is read or written beyond the slices, which may be of any length and
    /// alignment.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    ///
    /// ```
    /// use hairis::{Gaussian, HairParams, Material, Published};
    /// use hairis::columns::{EvalColumns, HitColumns};
    /// let hair = Material::new(&Published(Gaussian), &HairParams::default());
    /// let (wo, wi) = ([[0.0; 11], [0.6; 11], [0.8; 11]], [[0.1; 11], [0.7; 11], [0.7; 11]]);
    /// let hits = HitColumns { wo: [&wo[0], &wo[1], &wo[2]], h: None };
    /// let mut pdf = [0.0; 11];
    /// let out = EvalColumns { pdf: Some(&mut pdf), ..EvalColumns::default() };
    /// hair.eval_hits(hits, [&wi[0], &wi[1], &wi[2]], out)?;
    /// assert!(pdf.iter().all(|pdf| *pdf > 0.0));
    /// # Ok::<(), hairis::columns::LengthError>(())
    /// ```
    #[inline]
    pub fn eval_hits(
        &self,
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        out: EvalColumns<'_>,
    ) -> Result<(), LengthError> {
        self.run::<HitEvals, _, _>(hits.with(wi, WI)?, out.columns(hits.len(), VALUE_PDF)?);
        Ok(())
    }

    /// Many samples, each at a hit of its own on this material: `xi` by component, for the lobe, the inclination and the
    /// azimuth, each in `[0, 1)`.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then.
    ///
    /// ```
    /// use hairis::{Gaussian, HairParams, Material, Published};
    /// use hairis::columns::{HitColumns, SampleColumns};
    /// let hair = Material::new(&Published(Gaussian), &HairParams::default());
    /// let (wo, xi) = ([[0.0; 11], [0.6; 11], [0.8; 11]], [[0.1; 11], [0.5; 11], [0.7; 11]]);
    /// let hits = HitColumns { wo: [&wo[0], &wo[1], &wo[2]], h: None };
    /// let (mut wi, mut pdf, mut weight) = ([[0.0; 11]; 3], [0.0; 11], [[0.0; 11]; 3]);
    /// let out = SampleColumns {
    ///     wi: Some(wi.each_mut().map(|column| &mut column[..])),
    ///     pdf: Some(&mut pdf),
    ///     weight: Some(weight.each_mut().map(|column| &mut column[..])),
    ///     ..SampleColumns::default() // a path tracer needs neither value nor slot
    /// };
    /// hair.sample_hits(hits, [&xi[0], &xi[1], &xi[2]], out)?;
    /// assert!(pdf.iter().all(|pdf| *pdf > 0.0));
    /// # Ok::<(), hairis::columns::LengthError>(())
    /// ```
    #[inline]
    pub fn sample_hits(
        &self,
        hits: HitColumns<'_>,
        xi: [&[f32]; 3],
        out: SampleColumns<'_>,
    ) -> Result<(), LengthError> {
        self.run::<HitSamples, _, _>(hits.with(xi, XI)?, out.columns(hits.len(), SAMPLE)?);
        Ok(())
    }

    /// Both of [`eval_hits`](Self::eval_hits) and [`sample_hits`](Self::sample_hits), for less than the two calls.
    ///
    /// A path tracer with light sampling needs both: the direction towards a light, and the path's next one. The bits are those of
    /// [`eval_hits`](Self::eval_hits) and [`sample_hits`](Self::sample_hits), and each hit is prepared once.
    ///
    /// # Errors
    ///
    /// If the slices differ in length; nothing is written then. Columns of `samples` have names that begin with `sample.`.
    ///
    /// ```
    /// use hairis::{Gaussian, HairParams, Material, Published};
    /// use hairis::columns::{EvalColumns, HitColumns, SampleColumns};
    /// let hair = Material::new(&Published(Gaussian), &HairParams::default());
    /// let (wo, wi, xi) = ([[0.0; 11], [0.6; 11], [0.8; 11]], [[0.1; 11], [0.7; 11], [0.7; 11]], [[0.5; 11]; 3]);
    /// let hits = HitColumns { wo: [&wo[0], &wo[1], &wo[2]], h: None };
    /// let (mut towards_light, mut next) = ([0.0; 11], [0.0; 11]);
    /// let evals = EvalColumns { pdf: Some(&mut towards_light), ..EvalColumns::default() };
    /// let samples = SampleColumns { pdf: Some(&mut next), ..SampleColumns::default() };
    /// hair.eval_sample_hits(hits, [&wi[0], &wi[1], &wi[2]], evals, [&xi[0], &xi[1], &xi[2]], samples)?;
    /// assert!(towards_light[10] > 0.0 && next[10] > 0.0);
    /// # Ok::<(), hairis::columns::LengthError>(())
    /// ```
    #[inline]
    pub fn eval_sample_hits(
        &self,
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        evals: EvalColumns<'_>,
        xi: [&[f32]; 3],
        samples: SampleColumns<'_>,
    ) -> Result<(), LengthError> {
        let inputs = hits.with_both(wi, xi)?;
        let outputs = both(hits.len(), evals, samples)?;
        self.run::<HitEvalsSamples, _, _>(inputs, outputs);
        Ok(())
    }

    #[inline]
    fn run<K: HitRow<M, I, N>, const I: usize, const N: usize>(
        &self,
        inputs: [&[f32]; I],
        mut outputs: [&mut [f32]; N],
    ) {
        clean_upper_halves();
        if self.is_integrating() {
            return in_packets::<M, K, I, N>(inputs, &mut outputs, |hits| self.prepare8(hits));
        }
        let row = AtHits::<M, K>::new(&self.constants);
        self.level.run_rows(row, inputs, &mut outputs);
    }
}

/// The rows of hits through packets in memory: for materials that integrate their lobes, beside which the memory is nothing, so
/// that rows need no code with an integral.
#[cold]
#[inline(never)]
fn in_packets<M: Model, K: HitRow<M, I, N>, const I: usize, const N: usize>(
    inputs: [&[f32]; I],
    outputs: &mut [&mut [f32]; N],
    prepare: impl Fn(&Hit8) -> Bsdf8<M>,
) {
    for first in (0..inputs[0].len()).step_by(8) {
        let input = inputs.map(|column| packet(column.get(first..).unwrap_or_default()));
        let wo = Vec3x::new(input[0], input[1], input[2]);
        let bsdf = prepare(&Hit::new(wo, input[3]));
        let rows = K::of_eight(&bsdf, &input);
        for (lanes, column) in rows.iter().zip(outputs.iter_mut()) {
            copy_few(
                lanes.as_array(),
                column.get_mut(first..).unwrap_or_default(),
            );
        }
    }
}

/// The columns of evaluations and of samples, empty ones where they are left out.
#[inline]
fn both<'a>(
    len: usize,
    evals: EvalColumns<'a>,
    samples: SampleColumns<'a>,
) -> Result<[&'a mut [f32]; 15], LengthError> {
    let [r, g, b, p] = evals.columns(len, VALUE_PDF)?;
    let [u, v, w, sr, sg, sb, sp, wr, wg, wb, slot] = samples.columns(len, SAMPLE_OF_BOTH)?;
    Ok([r, g, b, p, u, v, w, sr, sg, sb, sp, wr, wg, wb, slot])
}

/// The first eight numbers of a column, and 0 beyond its end.
#[inline(always)]
fn packet(column: &[f32]) -> f32x8 {
    let mut lanes = [0.0; 8];
    copy_few(column, &mut lanes);
    f32x8::new(lanes)
}

impl<M: Model> MaterialTable<'_, M> {
    /// As [`Material::eval_hits`], each hit with the material of its index, on the level of the first material.
    ///
    /// # Errors
    ///
    /// If the columns differ in length, or an index is not in the table; nothing is written then.
    #[inline]
    pub fn eval_hits(
        &self,
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        out: EvalColumns<'_>,
    ) -> Result<(), HitsError> {
        self.run::<HitEvals, _, _>(hits.with(wi, WI)?, out.columns(hits.len(), VALUE_PDF)?)
    }

    /// As [`Material::sample_hits`], each hit with the material of its index, on the level of the first material.
    ///
    /// # Errors
    ///
    /// If the columns differ in length, or an index is not in the table; nothing is written then.
    #[inline]
    pub fn sample_hits(
        &self,
        hits: HitColumns<'_>,
        xi: [&[f32]; 3],
        out: SampleColumns<'_>,
    ) -> Result<(), HitsError> {
        self.run::<HitSamples, _, _>(hits.with(xi, XI)?, out.columns(hits.len(), SAMPLE)?)
    }

    /// As [`Material::eval_sample_hits`], each hit with the material of its index, on the level of the first material.
    ///
    /// A path tracer with light sampling needs both: the direction towards a light, and the path's next one. The bits are those of
    /// [`eval_hits`](Self::eval_hits) and [`sample_hits`](Self::sample_hits), and each hit is prepared once.
    ///
    /// # Errors
    ///
    /// If the columns differ in length, or an index is not in the table; nothing is written then. Columns of `samples` have names that begin with `sample.`.
    #[inline]
    pub fn eval_sample_hits(
        &self,
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        evals: EvalColumns<'_>,
        xi: [&[f32]; 3],
        samples: SampleColumns<'_>,
    ) -> Result<(), HitsError> {
        let inputs = hits.with_both(wi, xi)?;
        let outputs = both(hits.len(), evals, samples)?;
        self.run::<HitEvalsSamples, _, _>(inputs, outputs)
    }

    /// Materials with several hits in a chunk as slice calls, and the rest eight hits at a time, one material per lane.
    fn run<K: HitRow<M, I, N>, const I: usize, const N: usize>(
        &self,
        inputs: [&[f32]; I],
        outputs: [&mut [f32]; N],
    ) -> Result<(), HitsError> {
        clean_upper_halves();
        check_length(inputs[0].len(), "index", Some(self.index))?;
        let materials = self.materials.len();
        let material = |index: u32| {
            self.materials
                .get(usize::try_from(index).unwrap_or(usize::MAX))
        };
        for (hit, &index) in self.index.iter().enumerate() {
            if material(index).is_none() {
                return Err(HitsError::Material {
                    hit,
                    index,
                    materials,
                });
            }
        }
        let level = self
            .materials
            .first()
            .map_or_else(Level::portable, Material::level);
        in_groups(self.index, inputs, outputs, 8, |index, inputs, outputs| {
            let mut known = index.iter().filter_map(|index| material(*index));
            let Some(first) = known.next() else { return };
            if index.iter().all(|other| Some(other) == index.first()) {
                return first.with_level(level).run::<K, I, N>(inputs, outputs);
            }
            // Lanes past the last hit have the material of the first.
            let mut lanes = [first; 8];
            for (lane, material) in lanes.iter_mut().skip(1).zip(known) {
                *lane = material;
            }
            let material = Material8::pack(lanes).with_level(level);
            let mut outputs = outputs;
            if material.integrating().is_some() {
                in_packets::<M, K, I, N>(inputs, &mut outputs, |hits| material.prepare8(hits));
            } else {
                let input = inputs.map(packet);
                let row = EightHits::<M, K, I, N>::new(&material.constants, &input);
                for (lanes, column) in level.run(row).iter().zip(outputs) {
                    copy_few(lanes.as_array(), column);
                }
            }
        });
        Ok(())
    }
}
