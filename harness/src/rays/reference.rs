//! The value that estimates ought to have.

use super::RaySubject;
use crate::efficiency::{EfficiencyResult, Reference, ReferenceMethod, THETA_O_DEG};
use crate::light::Light;
use crate::sequence::{Stratified, XiSource, stream_id};
use crate::stats::{Estimate, Moments};
use hairis::reference::Reference as _;

/// Strata of a pass, across and down.
const STRATA: [usize; 2] = [64, 64];

/// The reference that sample efficiency has for this model and light, seen from place `pose`.
pub(super) fn known(from: &EfficiencyResult, subject: RaySubject, light: &str, pose: usize) -> Option<Reference> {
    let key = (subject.model(), light, THETA_O_DEG[pose]);
    from.rows.iter().find(|row| (row.model.name(), &*row.light, row.theta_o_deg) == key).map(|row| row.reference)
}

/// The mean of RGB by a stratified run over the formulas in double precision, drawn from the light.
pub(super) fn by_run(subject: RaySubject, light: &dyn Light, pose: usize, at: [u64; 2], passes: usize) -> Reference {
    let formulas = subject.formulas(pose);
    let [seed, stream] = at;
    let mut source = Stratified::new(&STRATA, seed, stream_id(&[stream, pose as u64]));
    let mut means = Moments::new();
    for _ in 0..passes {
        let mut sum = 0.0;
        for _ in 0..source.cells() {
            let sample = light.sample(source.next_xi());
            let (value, cos_theta) = (formulas.eval(sample.dir.to_array()), sample.dir.y.hypot(sample.dir.z));
            let y = (0..3).map(|c| sample.radiance[c] * (value[c] * cos_theta)).sum::<f64>() / 3.0;
            sum += if sample.pdf > 0.0 { y / sample.pdf } else { 0.0 };
        }
        means.push(sum / source.cells() as f64);
    }
    of_run(means.mean_estimate())
}

/// The mean of a run as a reference.
pub(super) const fn of_run(mean: Estimate) -> Reference {
    Reference {
        value: mean.value,
        standard_error: mean.standard_error,
        quadrature_error: 0.0,
        method: ReferenceMethod::StratifiedRun,
        v: [f64::NAN; 3],
        skewness: [f64::NAN; 3],
    }
}
