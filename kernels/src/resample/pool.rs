//! Candidates of one hit, stored by column.

use super::{
    CandidateColumns, Choice, Choices, Counts, Partition, Resample, WeightColumns, choose,
};
use crate::columns::LengthError;
use glam::Vec3;

/// Candidates of one hit, at most `N`, with those of the BSDF first. Keep one pool per thread and use it again.
///
/// ```
/// use glam::Vec3;
/// use hairis::resample::{Counts, Partition, Pool};
/// use hairis::{Gaussian, HairParams, Material, Published};
///
/// // A sky that is brighter above, and a light sampler that draws it uniformly: density 1 / (4 pi).
/// let sky = |wi: Vec3| ([1.0 + wi.y, 1.0, 1.0], 0.079_577_47);
/// let prepared = Material::new(&Published(Gaussian), &HairParams::brown()).prepare(Vec3::Y);
///
/// let mut pool = Pool::<16>::new(Counts { bsdf: 8, light: 8 }, Partition::All).expect("16 candidates");
/// let xi = core::array::from_fn::<f32, 8, _>(|i| (i as f32 + 0.5) / 8.0);
/// pool.propose(&prepared, [&xi, &xi, &xi])?; // from the BSDF
/// for i in 0..8 {
///     let (z, phi) = (xi[i] * 2.0 - 1.0, 2.4 * i as f32);
///     let r = (1.0 - z * z).sqrt();
///     let wi = Vec3::new(r * phi.cos(), r * phi.sin(), z);
///     pool.set_light(i, wi, sky(wi).0, sky(wi).1); // from the light
/// }
/// pool.look_up(sky);
/// pool.weigh(&prepared);
/// let mut direct = [0.0; 3];
/// for (wi, choice) in pool.choose(4, 0.3) {
///     let visible = wi.y > 0.0; // a ray
///     for (sum, light) in direct.iter_mut().zip(choice.contribution) {
///         *sum += if visible { light } else { 0.0 };
///     }
/// }
/// assert!(direct[0] > 0.0);
/// # Ok::<(), hairis::columns::LengthError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Pool<const N: usize> {
    wi: [[f32; N]; 3],
    radiance: [[f32; N]; 3],
    pdf_light: [f32; N],
    contribution: [[f32; N]; 3],
    weight: [f32; N],
    counts: Counts,
    partition: Partition,
    /// Number of the BSDF's candidates, as a length.
    bsdf: usize,
    len: usize,
}

/// Columns of the candidates of one technique, for the host to write.
#[derive(Debug)]
pub struct CandidateColumnsMut<'a> {
    /// Direction towards the light, in the fibre's frame: u, v, w.
    pub wi: [&'a mut [f32]; 3],
    /// Radiance from the direction, linear RGB, without visibility.
    pub radiance: [&'a mut [f32]; 3],
    /// The light's density of proposing the direction, per steradian.
    pub pdf_light: &'a mut [f32],
}

impl<const N: usize> Pool<N> {
    /// Makes a pool for these numbers of candidates. Returns `None` if they are more than `N` in all, or if a [`Partition`] other
    /// than `All` is combined with candidates of the BSDF, because that technique is then the path's next direction.
    #[inline]
    #[must_use]
    pub fn new(counts: Counts, partition: Partition) -> Option<Self> {
        let bsdf = usize::try_from(counts.bsdf).ok()?;
        let len = bsdf.checked_add(usize::try_from(counts.light).ok()?)?;
        let shared = partition != Partition::All && bsdf > 0;
        let (three, one) = ([[0.0; N]; 3], [0.0; N]);
        (len <= N && !shared).then_some(Self {
            wi: three,
            radiance: three,
            pdf_light: one,
            contribution: three,
            weight: one,
            counts,
            partition,
            bsdf,
            len,
        })
    }

    /// Draws the BSDF's candidates, one for each triple of uniform numbers.
    ///
    /// # Errors
    ///
    /// Returns an error if the columns of numbers differ in length from the number of the BSDF's candidates.
    #[inline]
    pub fn propose(
        &mut self,
        bsdf: &(impl Resample + ?Sized),
        xi: [&[f32]; 3],
    ) -> Result<(), LengthError> {
        bsdf.propose_columns(xi, self.bsdf_candidates().wi).map_err(
            |LengthError {
                 field,
                 len,
                 expected,
             }| {
                // The numbers are the first slices of that call, but the pool's length is the one that they must have.
                if field.starts_with("wi") {
                    LengthError {
                        field: "xi.lobe",
                        len: expected,
                        expected: len,
                    }
                } else {
                    LengthError {
                        field,
                        len,
                        expected,
                    }
                }
            },
        )
    }

    /// Returns the BSDF's candidates: directions to look up, and columns for their radiance and density.
    #[inline]
    pub fn bsdf_candidates(&mut self) -> CandidateColumnsMut<'_> {
        self.candidates(0, self.bsdf)
    }

    /// Returns the light's candidates, whose columns the host writes in full.
    #[inline]
    pub fn light_candidates(&mut self) -> CandidateColumnsMut<'_> {
        self.candidates(self.bsdf, self.len)
    }

    #[inline]
    fn candidates(&mut self, from: usize, to: usize) -> CandidateColumnsMut<'_> {
        CandidateColumnsMut {
            wi: self
                .wi
                .each_mut()
                .map(|column| column.get_mut(from..to).unwrap_or_default()),
            radiance: self
                .radiance
                .each_mut()
                .map(|column| column.get_mut(from..to).unwrap_or_default()),
            pdf_light: self.pdf_light.get_mut(from..to).unwrap_or_default(),
        }
    }

    /// Writes candidate `i` of the light: its direction, radiance and density. An `i` beyond the last candidate is ignored.
    #[inline]
    pub fn set_light(&mut self, i: usize, wi: Vec3, radiance: [f32; 3], pdf_light: f32) {
        let mut columns = self.light_candidates();
        set(&mut columns.wi, i, wi.to_array());
        set(&mut columns.radiance, i, radiance);
        set(&mut [columns.pdf_light], i, [pdf_light]);
    }

    /// Calls `light` for each of the BSDF's candidates, and stores the radiance and the light's density that it returns for the
    /// direction.
    #[inline]
    pub fn look_up(&mut self, mut light: impl FnMut(Vec3) -> ([f32; 3], f32)) {
        let mut columns = self.bsdf_candidates();
        for i in 0..columns.pdf_light.len() {
            let [x, y, z] = columns
                .wi
                .each_ref()
                .map(|column| column.get(i).copied().unwrap_or_default());
            let wi = Vec3::new(x, y, z);
            let (radiance, pdf) = if wi == Vec3::ZERO {
                ([0.0; 3], 0.0)
            } else {
                light(wi)
            };
            set(&mut columns.radiance, i, radiance);
            set(&mut [&mut *columns.pdf_light], i, [pdf]);
        }
    }

    /// Weighs all candidates. Call it once their radiance and densities have been written.
    #[inline]
    pub fn weigh(&mut self, bsdf: &(impl Resample + ?Sized)) {
        let len = self.len;
        let candidates = CandidateColumns {
            wi: self
                .wi
                .each_ref()
                .map(|column| column.get(..len).unwrap_or_default()),
            radiance: self
                .radiance
                .each_ref()
                .map(|column| column.get(..len).unwrap_or_default()),
            pdf_light: self.pdf_light.get(..len).unwrap_or_default(),
        };
        let out = WeightColumns {
            contribution: self
                .contribution
                .each_mut()
                .map(|column| column.get_mut(..len).unwrap_or_default()),
            weight: self.weight.get_mut(..len).unwrap_or_default(),
        };
        let written = bsdf.weigh_columns(candidates, self.counts, self.partition, out);
        debug_assert!(written.is_ok(), "all columns have the length of the pool");
    }

    /// Chooses `k` candidates by one uniform number, and yields the direction of each with its choice: see [`choose`].
    #[inline]
    pub fn choose(&self, k: u32, u: f32) -> impl Iterator<Item = (Vec3, Choice)> {
        self.choices(k, u).map(|choice| {
            let [x, y, z] = self
                .wi
                .each_ref()
                .map(|column| column.get(choice.index).copied().unwrap_or_default());
            (Vec3::new(x, y, z), choice)
        })
    }

    /// Chooses `k` candidates by one uniform number, and yields the choices with the candidates' indices.
    #[inline]
    #[must_use]
    pub fn choices(&self, k: u32, u: f32) -> Choices<'_> {
        let contribution = self.contribution.each_ref().map(|column| &column[..]);
        choose(
            contribution,
            self.weight.get(..self.len).unwrap_or_default(),
            k,
            u,
        )
    }
}

/// Writes entry `i` of each column, if it exists.
#[inline]
fn set<const C: usize>(columns: &mut [&mut [f32]; C], i: usize, values: [f32; C]) {
    for (column, value) in columns.iter_mut().zip(values) {
        if let Some(entry) = column.get_mut(i) {
            *entry = value;
        }
    }
}
