//! Resampled importance sampling of direct light (Talbot et al. 2005): one ray for many candidates, with the balance heuristic
//! between the candidates of the BSDF and those of the light.
//!
//! A ray costs as much as tens of candidates. Draw `n_b` directions from the BSDF and `n_l` from the light, weigh each by the light
//! that it would contribute without occlusion, and trace the few that are chosen:
//!
//! 1. **Propose.** [`Bsdf::propose_columns`] draws the BSDF's candidates; the host draws the light's.
//! 2. **Look up.** The host finds the radiance from each direction, and the light's density of the direction.
//! 3. **Weigh.** [`Bsdf::weigh_columns`] gives each candidate its contribution `f = L S cos theta_i` and its weight `w`, the mean
//!    of `f` over the channels by `n_b p_b + n_l p_l`.
//! 4. **Choose.** [`choose`] picks `k` of them by one uniform number; equal choices share one ray. The direct light is the sum of
//!    `V * contribution` over the choices, V being visibility.
//!
//! [`Pool`] holds the columns of one hit. For eight hits at a time, one per lane, keep a [`Reservoir8`].
//!
//! # When the estimate is unbiased
//!
//! - The mean of the estimate is right for any `n_b`, `n_l` and `k` above 0, if every direction that contributes light can be drawn
//!   by some technique that proposes. With `n_l` 0 the BSDF's density must be above 0 wherever `f` is, and with `n_b` 0 the light's
//!   density.
//! - Resampling estimates all direct light. A path that continues by a BSDF sample of its own must therefore not add an emitter that
//!   it meets, unless a [`Partition`] is used. With a `Partition` candidates come from the light alone, the estimate is the light
//!   technique's share, and the emitter counts with the rest, `1 - w_l`.
//! - Lights without an extent have no density, so add them separately.
//! - Radiance that is NaN or below 0 counts as 0. Contributions and weights above 1e30, such as those of infinite radiance, count as
//!   1e30, so that no sum overflows.

use crate::columns::{LengthError, VALUE_PDF, WI, XI, check_columns};
use crate::frame::Vec3x8;
use crate::handle::kernels::AtBsdf;
use crate::handle::{Bsdf, Bsdf8};
use crate::model::Model;
use crate::simd::columns::Columns;
use crate::simd::dispatch::clean_upper_halves;
use crate::simd::{Lanes, Level, Row, Vec3x};
use kernels::{ProposalsOf, Proposed, WeighOf, Weighs};
use weighing::Weighing;
use wide::f32x8;

mod choice;
mod dynamic;
mod kernels;
mod pool;
mod reservoir;
mod weighing;

pub use choice::{Choice, Choices, choose};
pub use dynamic::Resample;
pub use pool::Pool;
pub use reservoir::Reservoir8;
pub use weighing::{Counts, Partition, Weighed8};

/// Candidates of one hit by column, with the radiance and density that the host looked up.
#[derive(Clone, Copy, Debug)]
pub struct CandidateColumns<'a> {
    /// Direction towards the light, in the fibre's frame: u, v, w. For a discarded sample it is 0.
    pub wi: [&'a [f32]; 3],
    /// Radiance from the direction, linear RGB, without visibility; multiply it by the path's throughput if that is to affect the
    /// choice.
    pub radiance: [&'a [f32]; 3],
    /// The light's density of proposing the direction, per steradian, whichever technique proposed it.
    pub pdf_light: &'a [f32],
}

/// Output of [`Bsdf::weigh_columns`], one entry per candidate.
#[derive(Debug)]
pub struct WeightColumns<'a> {
    /// Light that the direction would contribute, `L S cos theta_i`, linear RGB, without visibility.
    pub contribution: [&'a mut [f32]; 3],
    /// Weight of the candidate; 0 if it contributes nothing.
    pub weight: &'a mut [f32],
}

/// Names of the slices of candidates.
const CANDIDATE: [&str; 7] = [
    "wi.u",
    "wi.v",
    "wi.w",
    "radiance.r",
    "radiance.g",
    "radiance.b",
    "pdf_light",
];
const EVALUATED: [&str; 11] = [
    VALUE_PDF[0],
    VALUE_PDF[1],
    VALUE_PDF[2],
    VALUE_PDF[3],
    CANDIDATE[0],
    CANDIDATE[1],
    CANDIDATE[2],
    CANDIDATE[3],
    CANDIDATE[4],
    CANDIDATE[5],
    CANDIDATE[6],
];
const WEIGHT: [&str; 4] = [
    "contribution.r",
    "contribution.g",
    "contribution.b",
    "weight",
];

/// Row that weighs columns of evaluations.
#[derive(Clone, Copy)]
struct WeighEvals(Weighing);

impl Row<11, 4> for WeighEvals {
    #[inline(always)]
    fn row<L: Lanes>(self, [vr, vg, vb, pdf, x, y, z, r, g, b, light]: [L; 11]) -> [L; 4] {
        let cos_theta_i = Vec3x::new(x, y, z).cos_theta();
        self.0
            .weigh([vr, vg, vb], pdf, cos_theta_i, [r, g, b], light)
    }
}

/// Weighs candidates whose values and densities the host has already; `evals` are red, green, blue and the density.
///
/// The bits are those of [`Bsdf::weigh_columns`] if the values are those of [`Bsdf::eval_columns`] on the same level. A host of many
/// models therefore compiles this once, instead of a kernel of weights per model.
///
/// Candidates may be at hits of their own: weigh the results of [`Material::eval_hits`](crate::Material::eval_hits). The second pass
/// adds a tenth to the time of that call.
///
/// # Errors
///
/// Returns an error, and writes nothing, if the columns differ in length.
///
/// ```
/// use hairis::columns::EvalColumns;
/// use hairis::resample::{CandidateColumns, Counts, Partition, WeightColumns, weigh_evals};
/// use hairis::{Gaussian, HairParams, Material, Published};
/// let bsdf = Material::new(&Published(Gaussian), &HairParams::red()).prepare(glam::Vec3::Y);
/// let wi = [[0.1; 11], [0.7; 11], [0.7; 11]];
/// let candidates = CandidateColumns {
///     wi: [&wi[0], &wi[1], &wi[2]],
///     radiance: [&[0.5; 11], &[2.0; 11], &[0.0; 11]],
///     pdf_light: &[0.3; 11],
/// };
/// let (counts, partition) = (Counts { bsdf: 3, light: 5 }, Partition::Balance);
/// let [mut by_model, mut by_evals, mut evals] = [[[0.0; 11]; 4]; 3];
/// let [r, g, b, weight] = by_model.each_mut().map(|column| &mut column[..]);
/// bsdf.weigh_columns(candidates, counts, partition, WeightColumns { contribution: [r, g, b], weight })?;
/// let [r, g, b, pdf] = evals.each_mut().map(|column| &mut column[..]);
/// bsdf.eval_columns(candidates.wi, EvalColumns { value: Some([r, g, b]), pdf: Some(pdf) })?;
/// let evals = evals.each_ref().map(|column| &column[..]);
/// let [r, g, b, weight] = by_evals.each_mut().map(|column| &mut column[..]);
/// let out = WeightColumns { contribution: [r, g, b], weight };
/// weigh_evals(bsdf.level(), evals, candidates, counts, partition, out)?;
/// assert!(by_model == by_evals && by_model[3][10] > 0.0);
/// # Ok::<(), hairis::columns::LengthError>(())
/// ```
#[inline]
pub fn weigh_evals(
    level: Level,
    evals: [&[f32]; 4],
    candidates: CandidateColumns<'_>,
    counts: Counts,
    partition: Partition,
    out: WeightColumns<'_>,
) -> Result<(), LengthError> {
    clean_upper_halves();
    let CandidateColumns {
        wi: [u, v, w],
        radiance: [r, g, b],
        pdf_light,
    } = candidates;
    let ([vr, vg, vb, pdf], [fr, fg, fb]) = (evals, out.contribution);
    let inputs = [vr, vg, vb, pdf, u, v, w, r, g, b, pdf_light];
    let columns = check_columns(&EVALUATED, inputs, &WEIGHT, [fr, fg, fb, out.weight])?;
    level.run_columns(WeighEvals(Weighing::new(counts, partition)), &columns);
    Ok(())
}

/// Returns the columns of a call that weighs candidates, all of one length.
#[inline(always)]
fn candidate_columns<'a>(
    candidates: CandidateColumns<'a>,
    out: WeightColumns<'a>,
) -> Result<Columns<'a, 7, 4>, LengthError> {
    let ([u, v, w], [r, g, b]) = (candidates.wi, candidates.radiance);
    let inputs = [u, v, w, r, g, b, candidates.pdf_light];
    let [fr, fg, fb] = out.contribution;
    check_columns(&CANDIDATE, inputs, &WEIGHT, [fr, fg, fb, out.weight])
}

impl<M: Model> Bsdf<M> {
    /// Draws the BSDF's candidates, like [`sample_columns`](Self::sample_columns) but directions alone. A discarded sample gives the
    /// direction 0, whose weight is 0.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    #[inline]
    pub fn propose_columns(&self, xi: [&[f32]; 3], wi: [&mut [f32]; 3]) -> Result<(), LengthError> {
        clean_upper_halves();
        let columns = check_columns(&XI, xi, &WI, wi)?;
        let row = AtBsdf::<M::Inner, Proposed>::new(&self.prepared);
        self.level.run_columns(row, &columns);
        Ok(())
    }

    /// Computes contributions and weights of the candidates of one hit, whichever technique proposed them.
    ///
    /// # Errors
    ///
    /// Returns an error, and writes nothing, if the columns differ in length.
    #[inline]
    pub fn weigh_columns(
        &self,
        candidates: CandidateColumns<'_>,
        counts: Counts,
        partition: Partition,
        out: WeightColumns<'_>,
    ) -> Result<(), LengthError> {
        clean_upper_halves();
        let columns = candidate_columns(candidates, out)?;
        let row = Weighs::<M::Inner>::new(&self.prepared, Weighing::new(counts, partition));
        self.level.run_columns(row, &columns);
        Ok(())
    }
}

impl<M: Model> Bsdf8<M> {
    /// Draws a candidate of the BSDF for each hit; the direction is 0 where the sample was discarded.
    #[inline]
    #[must_use]
    pub fn propose8(&self, xi: &[f32x8; 3]) -> Vec3x8 {
        self.level.run(ProposalsOf::<M::Inner> {
            prepared: &self.prepared,
            xi,
        })
    }

    /// Computes contribution and weight of a candidate for each hit, from the radiance and the light's density of its direction.
    #[inline]
    #[must_use]
    pub fn weigh8(
        &self,
        wi: &Vec3x8,
        radiance: &[f32x8; 3],
        pdf_light: &f32x8,
        counts: Counts,
        partition: Partition,
    ) -> Weighed8 {
        self.level.run(WeighOf::<M::Inner> {
            prepared: &self.prepared,
            wi,
            radiance,
            pdf_light,
            weighing: Weighing::new(counts, partition),
        })
    }
}
