//! Calls on columns of hits, in which each entry has a hit and a direction of its own.

mod kernels;

use crate::columns::{
    EvalColumns, HitColumns, LengthError, SAMPLE, SAMPLE_OF_BOTH, SampleColumns, VALUE_PDF, WI, XI,
    check_length, in_groups,
};
use crate::handle::bsdf::Bsdf8;
use crate::handle::material::{Material, Material8};
use crate::model::{Hit, Hit8, Model};
use crate::simd::columns::copy_few;
use crate::simd::dispatch::clean_upper_halves;
use crate::simd::{Level, Vec3x};
use core::fmt;
use kernels::{AtHits, EightHits, HitEvals, HitEvalsSamples, HitRow, HitSamples};
use wide::f32x8;

/// Materials of a call on columns: a table, and for each hit the index of its material in the table.
///
/// Hits in any order on a few materials take little longer than hits sorted by material, because the call groups them by material
/// like [`in_groups`]. If each hit has a material of its own, it takes some ten times as long.
#[derive(Debug)]
pub struct MaterialTable<'a, M: Model> {
    /// Table of materials, in which the indices count.
    pub materials: &'a [Material<M>],
    /// Index of each hit's material in the table.
    pub index: &'a [u32],
}

impl<M: Model> Clone for MaterialTable<'_, M> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}
impl<M: Model> Copy for MaterialTable<'_, M> {}

/// Error of a call on columns of hits, which then has written nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum HitsError {
    /// A slice differs in length from the first.
    Length(LengthError),
    /// An index is not in the table of materials.
    Material {
        /// Position of the hit at fault.
        hit: usize,
        /// Index of that hit's material, which is out of range.
        index: u32,
        /// Number of materials in the table.
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
    /// Evaluates S and the density of many directions, each at a hit of its own on this material; `wi` holds the components u, v, w.
    ///
    /// The results equal those of [`prepare8`](Self::prepare8) and [`eval_pdf8`](crate::Bsdf8::eval_pdf8), in half the time, because
    /// the constants of a hit stay in registers. Nothing is read or written beyond the slices, which may be of any length and
    /// alignment.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the slices differ in length.
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

    /// Draws many samples, each at a hit of its own on this material; `xi` holds uniform numbers in `[0, 1)` for the lobe, the
    /// inclination and the azimuth.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the slices differ in length.
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

    /// Evaluates directions and draws samples at the same hits, in less time than [`eval_hits`](Self::eval_hits) and
    /// [`sample_hits`](Self::sample_hits) together.
    ///
    /// A path tracer with light sampling needs both: the direction towards a light, and the next direction of the path. The bits are
    /// those of the two calls, but each hit is prepared only once.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the slices differ in length. The error names columns of `samples` with the prefix
    /// `sample.`.
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
        if const { M::INTEGRATES } && self.is_integrating() {
            return in_packets::<M, K, I, N>(inputs, &mut outputs, &|hits| self.prepare8(hits));
        }
        let row = AtHits::<M, K>::new(&self.constants);
        self.level.run_rows(row, inputs, &mut outputs);
    }
}

/// Computes rows of hits as packets in memory, for materials that integrate their lobes. Beside the integrals the memory costs
/// nothing, and rows need no code with an integral.
#[cold]
#[inline(never)]
fn in_packets<M: Model, K: HitRow<M, I, N>, const I: usize, const N: usize>(
    inputs: [&[f32]; I],
    outputs: &mut [&mut [f32]; N],
    prepare: &dyn Fn(&Hit8) -> Bsdf8<M>,
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

/// Returns the columns of evaluations and of samples, with empty slices for the columns that are left out.
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

/// Returns the first eight numbers of a column, and 0 beyond its end.
#[inline(always)]
fn packet(column: &[f32]) -> f32x8 {
    let mut lanes = [0.0; 8];
    copy_few(column, &mut lanes);
    f32x8::new(lanes)
}

impl<M: Model> MaterialTable<'_, M> {
    /// Evaluates S and the density like [`Material::eval_hits`], each hit with the material of its index, on the level of the first
    /// material.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length or an index is not in the table.
    #[inline]
    pub fn eval_hits(
        &self,
        hits: HitColumns<'_>,
        wi: [&[f32]; 3],
        out: EvalColumns<'_>,
    ) -> Result<(), HitsError> {
        self.run::<HitEvals, _, _>(hits.with(wi, WI)?, out.columns(hits.len(), VALUE_PDF)?)
    }

    /// Draws samples like [`Material::sample_hits`], each hit with the material of its index, on the level of the first material.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length or an index is not in the table.
    #[inline]
    pub fn sample_hits(
        &self,
        hits: HitColumns<'_>,
        xi: [&[f32]; 3],
        out: SampleColumns<'_>,
    ) -> Result<(), HitsError> {
        self.run::<HitSamples, _, _>(hits.with(xi, XI)?, out.columns(hits.len(), SAMPLE)?)
    }

    /// Evaluates directions and draws samples like [`Material::eval_sample_hits`], each hit with the material of its index, on the
    /// level of the first material.
    ///
    /// A path tracer with light sampling needs both: the direction towards a light, and the next direction of the path. The bits are
    /// those of [`eval_hits`](Self::eval_hits) and [`sample_hits`](Self::sample_hits), but each hit is prepared only once.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length or an index is not in the table. The error names
    /// columns of `samples` with the prefix `sample.`.
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

    /// Computes materials with several hits in a chunk as calls on columns, and the other hits eight at a time, with one material
    /// per lane.
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
            // Lanes past the last hit repeat the material of the first.
            let mut lanes = [first; 8];
            for (lane, material) in lanes.iter_mut().skip(1).zip(known) {
                *lane = material;
            }
            let material = Material8::pack(lanes).with_level(level);
            let mut outputs = outputs;
            if const { M::INTEGRATES } && material.integrating().is_some() {
                in_packets::<M, K, I, N>(inputs, &mut outputs, &|hits| material.prepare8(hits));
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
