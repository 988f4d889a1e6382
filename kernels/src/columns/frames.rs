//! Frames of many hits, stored by column.

use super::{LengthError, check_length, check_lengths3};
use crate::frame::{FiberFrame8, Vec3x8};
use crate::simd::columns::copy_few;
use glam::Vec3;
use wide::f32x8;

/// Frames of hits by column, one entry per hit: the data that a wavefront host has before it calls
/// [`Material::eval_hits`](crate::Material::eval_hits).
///
/// ```
/// use hairis::columns::FrameColumns;
/// let (tangent, wo) = ([[1.0; 11], [0.0; 11], [0.0; 11]], [[0.6; 11], [0.0; 11], [0.8; 11]]);
/// let frames = FrameColumns { tangent: tangent.each_ref().map(|t| &t[..]), normal: None };
/// let mut local = [[0.0; 11]; 3];
/// frames.to_local(wo.each_ref().map(|w| &w[..]), local.each_mut().map(|w| &mut w[..]))?;
/// assert!(local[0].iter().all(|u| (*u - 0.6).abs() < 1e-6));
/// # Ok::<(), hairis::columns::LengthError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FrameColumns<'a> {
    /// Directions along each fibre, from root to tip, unit: x, y, z in the world.
    pub tangent: [&'a [f32]; 3],
    /// Outward normals, unit, which define azimuth 0 like [`FiberFrame8::from_tangents_normals`]. With `None` the azimuth is
    /// arbitrary, like [`FiberFrame8::from_tangents`].
    pub normal: Option<[&'a [f32]; 3]>,
}

impl FrameColumns<'_> {
    /// Transforms vectors from the world to the fibres; `out` receives the components u, v, w.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    #[inline]
    pub fn to_local(&self, v: [&[f32]; 3], out: [&mut [f32]; 3]) -> Result<(), LengthError> {
        self.map(v, ["out.u", "out.v", "out.w"], out, |frames, v, _| {
            let Vec3x8 { x, y, z } = frames.to_local(v);
            [x, y, z]
        })
    }

    /// Transforms vectors from the fibres to the world; `out` receives the components x, y, z.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    #[inline]
    pub fn to_world(&self, v: [&[f32]; 3], out: [&mut [f32]; 3]) -> Result<(), LengthError> {
        self.map(v, ["out.x", "out.y", "out.z"], out, |frames, v, _| {
            let Vec3x8 { x, y, z } = frames.to_world(v);
            [x, y, z]
        })
    }

    /// Computes the offsets across the fibres viewed from `wo`, in the world, like [`FiberFrame8::offset`]. Without normals the
    /// offsets are 0.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    #[inline]
    pub fn offset(&self, wo: [&[f32]; 3], h: &mut [f32]) -> Result<(), LengthError> {
        self.map(wo, ["h"], [h], |frames, wo, normal| {
            [normal.map_or(f32x8::ZERO, |normal| frames.offset(normal, wo))]
        })
    }

    /// Calls `call` for eight hits at a time. In lanes past the last hit, every vector is along x.
    #[inline]
    fn map<const N: usize>(
        &self,
        v: [&[f32]; 3],
        names: [&'static str; N],
        mut out: [&mut [f32]; N],
        call: impl Fn(&FiberFrame8, &Vec3x8, Option<&Vec3x8>) -> [f32x8; N],
    ) -> Result<(), LengthError> {
        let len = self.tangent[0].len();
        check_lengths3(len, ["tangent.x", "tangent.y", "tangent.z"], self.tangent)?;
        if let Some(normal) = self.normal {
            check_lengths3(len, ["normal.x", "normal.y", "normal.z"], normal)?;
        }
        check_lengths3(len, ["v.x", "v.y", "v.z"], v)?;
        for (name, column) in names.into_iter().zip(&out) {
            check_length(len, name, Some(&**column))?;
        }
        for at in (0..len).step_by(8) {
            let (tangents, normals) = (
                read(self.tangent, at),
                self.normal.map(|normal| read(normal, at)),
            );
            let frames = match &normals {
                Some(normals) => FiberFrame8::from_tangents_normals(&tangents, normals),
                None => FiberFrame8::from_tangents(&tangents),
            };
            let results = call(&frames, &read(v, at), normals.as_ref());
            for (result, column) in results.iter().zip(&mut out) {
                copy_few(result.as_array(), column.get_mut(at..).unwrap_or_default());
            }
        }
        Ok(())
    }
}

/// Reads eight vectors from row `at` on.
#[inline]
fn read(columns: [&[f32]; 3], at: usize) -> Vec3x8 {
    let mut lanes = Vec3::X.to_array().map(|x| [x; 8]);
    for (lanes, column) in lanes.iter_mut().zip(columns) {
        copy_few(column.get(at..).unwrap_or_default(), lanes);
    }
    let [x, y, z] = lanes.map(f32x8::new);
    Vec3x8::new(x, y, z)
}
