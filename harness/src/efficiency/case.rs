//! Case of one model seen from one direction: the measured eight-lane shading point, and its double-precision oracle.

use super::{ModelKind, PHI_O_DEG};
use crate::sampler::{Sampler, Scatter, UNIFORM_PDF};
use core::array;
use core::f64::consts::{FRAC_PI_2, PI};
use glam::{DVec3, Vec3};
use hairis::HairParams;
use hairis::params::HairDesc;
use hairis::simd::f32x8;
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::quadrature::{SphereIntegrator, Tolerance};
use hairis_instruments::sequence::{XiSource, to_unit_f32};
use hairis_reference::Reference;

/// Model with its parameters, seen from `wo`.
pub struct Case {
    /// Model.
    pub model: ModelKind,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Samplers of the case, in the order of [`Sampler::ALL`].
    estimators: [SampledCase; Sampler::ALL.len()],
}

/// Sampler of the case, with its oracle.
struct SampledCase {
    scatter: Scatter,
    /// Oracle of S, and of the density of every sampler but the uniform one.
    oracle: Box<dyn Reference<f64>>,
    /// Integrator with breakpoints at the lobes, and at the jumps of the density.
    sphere: SphereIntegrator,
}

/// Eight samples of one technique. Discarded samples have weight and density 0.
pub(super) struct Draws {
    pub(super) dir: [DVec3; 8],
    /// `S cos theta_i / pdf`, linear RGB.
    pub(super) weight: [[f64; 3]; 8],
    /// Density of the technique, per steradian.
    pub(super) pdf: [f64; 8],
}

/// Prints the constants of all formulas, which determine every integral of the case.
impl core::fmt::Debug for Case {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let oracles = self.estimators.iter().map(|estimator| &estimator.oracle);
        write!(f, "{:?} {}", self.model, self.theta_o_deg)?;
        f.debug_list().entries(oracles).finish()
    }
}

impl Case {
    /// Prepares a model of these parameters, seen from the inclination `theta_o_deg` in degrees.
    pub fn new(model: ModelKind, params: &HairParams, theta_o_deg: f64) -> Self {
        let wo = fibre_direction(theta_o_deg.to_radians(), PHI_O_DEG.to_radians()).as_vec3();
        // The oracle is prepared with the same rounded direction.
        let (parameters, exact) = (params.desc().map(f64::from), wo.as_dvec3());
        let estimators = Sampler::ALL.map(|sampler| {
            let formulas = model.formulas(sampler.bands());
            let oracle = formulas.prepare(&parameters, exact.to_array());
            let sphere = oracle.jumps().into_iter().fold(
                integrator(&parameters, exact),
                SphereIntegrator::theta_break,
            );
            SampledCase {
                scatter: Scatter::new(model, sampler, params, wo),
                oracle,
                sphere,
            }
        });
        Self {
            model,
            theta_o_deg,
            estimators,
        }
    }

    fn of(&self, sampler: Sampler) -> &SampledCase {
        &self.estimators[sampler as usize]
    }

    /// Returns an integrator for integrands with the density of `sampler`.
    pub(super) fn sphere(&self, sampler: Sampler) -> &SphereIntegrator {
        &self.of(sampler).sphere
    }

    /// Returns `S cos theta_i` of the oracle, linear RGB.
    pub(super) fn oracle_value(&self, dir: DVec3) -> [f64; 3] {
        let cos_theta = dir.y.hypot(dir.z);
        self.of(Sampler::Published)
            .oracle
            .eval(dir.to_array())
            .map(|s| s * cos_theta)
    }

    /// Returns the oracle's density of `sampler`, per steradian.
    pub(super) fn density(&self, sampler: Sampler, dir: DVec3) -> f64 {
        match sampler {
            Sampler::Uniform => f64::from(UNIFORM_PDF),
            _ => self.of(sampler).oracle.pdf(dir.to_array()),
        }
    }

    /// Draws samples from the next `lanes` (1 to 8) points of `source`. Further lanes use no point and are to be ignored.
    pub(super) fn draw(&self, sampler: Sampler, source: &mut impl XiSource, lanes: usize) -> Draws {
        let mut xi = [[0.5; 8]; 3];
        // A sampler that chooses no lobe takes the last two numbers.
        let skipped = 3 - sampler.dims();
        for lane in 0..lanes {
            let mut point = [0.0; 3];
            source.next_point(&mut point[skipped..]);
            for (row, x) in xi.iter_mut().zip(point) {
                row[lane] = to_unit_f32(x);
            }
        }
        let sample = self.of(sampler).scatter.sample8(&xi.map(f32x8::new));
        let dir = array::from_fn(|lane| sample.wi.lane(lane).as_dvec3());
        Draws {
            dir,
            weight: colours(&sample.weight),
            pdf: sample.pdf.to_array().map(f64::from),
        }
    }

    /// Returns `S cos theta_i`, linear RGB, and the density of `sampler`, at eight directions.
    pub(super) fn eval(&self, sampler: Sampler, dir: &[DVec3; 8]) -> ([[f64; 3]; 8], [f64; 8]) {
        let wi: [Vec3; 8] = dir.map(|d| d.as_vec3());
        let eval = self.of(sampler).scatter.eval_pdf8(&wi.into());
        let mut value = colours(&eval.value);
        for (colour, dir) in value.iter_mut().zip(dir) {
            *colour = colour.map(|c| c * dir.y.hypot(dir.z));
        }
        (value, eval.pdf.to_array().map(f64::from))
    }
}

/// Converts eight lanes to one colour per lane.
fn colours(channels: &[f32x8; 3]) -> [[f64; 3]; 8] {
    array::from_fn(|lane| channels.map(|c| f64::from(c.as_array()[lane])))
}

/// Returns an integrator with breakpoints at each bell, at the seam of `phi` and at the glint density's end.
fn integrator(p: &HairDesc<f64>, wo: DVec3) -> SphereIntegrator {
    let theta_o = wo.x.atan2(wo.y.hypot(wo.z));
    let phi_o = wo.z.atan2(wo.y);
    let mut sphere = SphereIntegrator::new().with_tolerance(Tolerance::relative(1e-7));
    for (alpha, beta) in p.alpha.iter().zip(p.beta) {
        sphere = sphere.theta_lobe(2.0 * alpha - theta_o, 2.0 * beta);
    }
    sphere = sphere.phi_lobe(phi_o + PI, p.gamma_tt).phi_break(phi_o);
    for side in [-1.0, 1.0] {
        sphere = sphere
            .phi_lobe(phi_o + side * p.phi_g, p.gamma_g)
            .phi_break(phi_o + side * FRAC_PI_2);
    }
    sphere
}
