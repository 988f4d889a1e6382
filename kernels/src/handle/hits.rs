//! Slice calls over hits: each entry has a hit and a direction of its own.

use crate::columns::{EvalColumns, HitColumns, LengthError, SampleColumns, WI, XI, check_length};
use crate::handle::kernels::{AtHits, EightHits, HitEvals, HitRow, HitSamples};
use crate::model::Model;
use crate::simd::Level;
use crate::simd::columns::copy_few;
use crate::simd::dispatch::clean_upper_halves;
use crate::{Material, Material8};
use core::fmt;
use wide::f32x8;

/// Materials of a slice call: a table, and the index of each hit's material in it.
///
/// Eight hits in a row with one material take the path of [`Material::eval_hits`]; hits sorted by material are the fastest.
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
        self.run::<HitEvals, 4>(hits.with(wi, WI)?, out.columns(hits.len())?);
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
        self.run::<HitSamples, 11>(hits.with(xi, XI)?, out.columns(hits.len())?);
        Ok(())
    }

    #[inline]
    fn run<K: HitRow<M, N>, const N: usize>(
        &self,
        inputs: [&[f32]; 7],
        mut outputs: [&mut [f32]; N],
    ) {
        clean_upper_halves();
        let row = AtHits::<M, K>::new(&self.constants);
        self.level.run_rows(row, inputs, &mut outputs);
    }
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
        self.run::<HitEvals, 4>(hits.with(wi, WI)?, out.columns(hits.len())?)
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
        self.run::<HitSamples, 11>(hits.with(xi, XI)?, out.columns(hits.len())?)
    }

    /// Runs of one material as slice calls, and the rest eight hits at a time, one material per lane.
    fn run<K: HitRow<M, N>, const N: usize>(
        &self,
        inputs: [&[f32]; 7],
        mut outputs: [&mut [f32]; N],
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
        let (mut at, mut rest) = (0, self.index);
        while let [index, ..] = rest
            && let Some(first) = material(*index)
        {
            let alike = rest.iter().take_while(|other| *other == index).count();
            let done = if alike >= 8 || alike == rest.len() {
                alike
            } else {
                rest.len().min(8)
            };
            let inputs = inputs.map(|column| column.get(at..at + done).unwrap_or_default());
            let mut outputs = outputs
                .each_mut()
                .map(|column| column.get_mut(at..at + done).unwrap_or_default());
            if done == alike {
                level.run_rows(AtHits::<M, K>::new(&first.constants), inputs, &mut outputs);
            } else {
                // Lanes past the last hit have the material of the first.
                let mut lanes = [first; 8];
                for (lane, index) in lanes.iter_mut().zip(rest) {
                    *lane = material(*index).unwrap_or(first);
                }
                let input = inputs.map(|column| {
                    let mut lanes = [0.0; 8];
                    copy_few(column, &mut lanes);
                    f32x8::new(lanes)
                });
                let Material8 { constants, .. } = Material8::pack(lanes);
                let output = level.run(EightHits::<M, K, N>::new(&constants, &input));
                for (lanes, column) in output.iter().zip(outputs) {
                    copy_few(lanes.as_array(), column);
                }
            }
            at += done;
            rest = rest.get(done..).unwrap_or_default();
        }
        Ok(())
    }
}
