//! One model seen from one direction: the eight-lane gather point that is measured, and the double-precision oracle it is held against.

use super::{ModelKind, PHI_O_DEG, Sampler};
use crate::quadrature::{SphereIntegrator, Tolerance, fibre_direction};
use crate::sequence::{XiSource, to_unit_f32};
use core::f64::consts::{FRAC_PI_2, PI};
use glam::{DVec3, Vec3};
use hairis::textbook::{Parameters, Textbook};
use hairis::wide::f32x8;
use hairis::{Bsdf, Eval8, Gather, Gaussian, Hair, HairParams, Model, Sample8, Vec3x8};
use hairis_variants::Cauchy;

/// Density of a uniform direction, per steradian.
pub(super) const UNIFORM_PDF: f64 = 0.25 / PI;

/// A gather point of any model, eight directions at a time: one call through a table for eight samples costs nothing that shows.
pub(crate) trait Scatter: Send + Sync {
    fn sample8(&self, xi: &[f32x8; 3]) -> Sample8;
    fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8;
}

impl<M: Model> Scatter for Gather<M>
where
    M::Gather<f32>: Send + Sync,
{
    fn sample8(&self, xi: &[f32x8; 3]) -> Sample8 {
        Self::sample8(self, xi)
    }

    fn eval_pdf8(&self, wi: &Vec3x8) -> Eval8 {
        Self::eval_pdf8(self, wi)
    }
}

/// A model with its parameters, seen from `wo`.
pub(super) struct Case {
    pub(super) model: ModelKind,
    pub(super) theta_o_deg: f64,
    scatter: Box<dyn Scatter>,
    pub(super) oracle: Textbook<f64>,
    /// An integrator that knows where the lobes are.
    pub(super) sphere: SphereIntegrator,
}

/// Eight samples of one technique. A discarded one has weight and density 0.
pub(super) struct Draws {
    pub(super) dir: [DVec3; 8],
    /// `S cos theta_i / pdf`, linear RGB.
    pub(super) weight: [[f64; 3]; 8],
    /// Density of the technique, per steradian.
    pub(super) pdf: [f64; 8],
}

impl Case {
    pub(super) fn new(model: ModelKind, params: &HairParams, theta_o_deg: f64) -> Self {
        let exact = fibre_direction(theta_o_deg.to_radians(), PHI_O_DEG.to_radians());
        let wo = exact.as_vec3();
        let scatter = match model {
            ModelKind::Gaussian => gather(&Hair(Gaussian), params, wo),
            ModelKind::Cauchy => gather(&Cauchy::PAPER.model(), params, wo),
        };
        // The oracle sees the same rounded direction.
        let parameters = Parameters::<f64>::from(params);
        let oracle = Textbook::prepare(&parameters, model.shape(), wo.as_dvec3().to_array());
        Self { model, theta_o_deg, scatter, oracle, sphere: integrator(&parameters, wo.as_dvec3()) }
    }

    /// `S cos theta_i` of the oracle, linear RGB.
    pub(super) fn oracle_value(&self, dir: DVec3) -> [f64; 3] {
        let cos_theta = dir.y.hypot(dir.z);
        self.oracle.eval(dir.to_array()).map(|s| s * cos_theta)
    }

    /// The next `lanes` (1 to 8) points of `source`, as samples; further lanes repeat no point and are to be ignored.
    pub(super) fn draw(&self, sampler: Sampler, source: &mut impl XiSource, lanes: usize) -> Draws {
        let mut xi = [[0.5; 8]; 3];
        let dims = sampler.dims();
        for lane in 0..lanes {
            let mut point = [0.0; 3];
            source.next_point(&mut point[..dims]);
            for (row, x) in xi.iter_mut().zip(point) {
                row[lane] = x;
            }
        }
        match sampler {
            Sampler::Uniform => self.uniform(&xi),
            Sampler::Ou => self.importance(&xi),
        }
    }

    /// `S cos theta_i`, linear RGB, and the density of `sampler`, at eight directions.
    pub(super) fn eval(&self, sampler: Sampler, dir: &[DVec3; 8]) -> ([[f64; 3]; 8], [f64; 8]) {
        let wi: [Vec3; 8] = dir.map(|d| d.as_vec3());
        let eval = self.scatter.eval_pdf8(&wi.into());
        let value = core::array::from_fn(|lane| {
            let cos_theta = dir[lane].y.hypot(dir[lane].z);
            eval.value.map(|c| f64::from(c.as_array()[lane]) * cos_theta)
        });
        let pdf = match sampler {
            Sampler::Uniform => [UNIFORM_PDF; 8],
            Sampler::Ou => eval.pdf.to_array().map(f64::from),
        };
        (value, pdf)
    }

    fn uniform(&self, xi: &[[f64; 8]; 3]) -> Draws {
        let dir = core::array::from_fn(|lane| {
            let (a, b) = (xi[0][lane], xi[1][lane]);
            let r = (4.0 * a * (1.0 - a)).max(0.0).sqrt();
            let (sin_phi, cos_phi) = (2.0 * PI * b).sin_cos();
            DVec3::new(1.0 - 2.0 * a, r * cos_phi, r * sin_phi)
        });
        let (value, pdf) = self.eval(Sampler::Uniform, &dir);
        Draws { dir, weight: value.map(|v| v.map(|c| c / UNIFORM_PDF)), pdf }
    }

    fn importance(&self, xi: &[[f64; 8]; 3]) -> Draws {
        let sample = self.scatter.sample8(&xi.map(|row| f32x8::new(row.map(to_unit_f32))));
        let at = |x: &f32x8, lane: usize| f64::from(x.as_array()[lane]);
        Draws {
            dir: core::array::from_fn(|lane| sample.wi.lane(lane).as_dvec3()),
            weight: core::array::from_fn(|lane| core::array::from_fn(|c| at(&sample.weight[c], lane))),
            pdf: sample.pdf.to_array().map(f64::from),
        }
    }
}

fn gather<M>(model: &M, params: &HairParams, wo: Vec3) -> Box<dyn Scatter>
where
    M: Model<Params = HairParams> + 'static,
    M::Gather<f32>: Send + Sync,
{
    Box::new(Bsdf::new(model, params).prepare(wo))
}

/// Breakpoints at each bell, at the seam of `phi` and at the glint density's end.
fn integrator(p: &Parameters<f64>, wo: DVec3) -> SphereIntegrator {
    let theta_o = wo.x.atan2(wo.y.hypot(wo.z));
    let phi_o = wo.z.atan2(wo.y);
    let mut sphere = SphereIntegrator::new().with_tolerance(Tolerance::relative(1e-7));
    for (alpha, beta) in p.alpha.iter().zip(p.beta) {
        sphere = sphere.theta_lobe(2.0 * alpha - theta_o, 2.0 * beta);
    }
    sphere = sphere.phi_lobe(phi_o + PI, p.gamma_tt).phi_break(phi_o);
    for side in [-1.0, 1.0] {
        sphere = sphere.phi_lobe(phi_o + side * p.phi_g, p.gamma_g).phi_break(phi_o + side * FRAC_PI_2);
    }
    sphere
}
