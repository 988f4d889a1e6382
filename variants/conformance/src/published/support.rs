//! Numbers, directions, materials and references that the tests share.

pub use crate::probe::{Draws, direction, double, narrow, triples as lanes_of};

use super::Tested;
use super::handles::Material;
use crate::size::is_kept_of;
use core::f64::consts::{FRAC_PI_2, PI};
use glam::Vec3;
use hairis::params::{HairDesc, MAX_WIDTH, MIN_WIDTH};
use hairis::{HairParams, Vec3x8};
use hairis_reference::{HairFormulas, Reference};

pub const DEG: f64 = PI / 180.0;

impl Draws {
    /// Draws a number whose logarithm is uniform between those of `lo` and `hi`.
    pub fn scale(&mut self, lo: f64, hi: f64) -> f64 {
        self.between(lo.ln(), hi.ln()).exp()
    }

    pub fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.bits() % n as u64).unwrap()
    }

    pub fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// Draws a direction where results vary: anywhere, beside the peaks of the lobes, the seam, the plane of `wo`, the glints, or close
    /// to the axis.
    pub fn near_lobes(&mut self, p: &HairDesc<f64>, theta_o: f64, phi_o: f64) -> Vec3 {
        let lobe = self.below(3);
        let theta = match self.below(4) {
            0 => self.between(-FRAC_PI_2, FRAC_PI_2),
            1 => 2.0 * p.alpha[lobe] - theta_o + self.between(-6.0, 6.0) * p.beta[lobe],
            2 => 2.0 * p.alpha[lobe] - theta_o + self.between(-1.0, 1.0) * p.beta[lobe],
            _ => self.sign() * (FRAC_PI_2 - self.scale(1e-3, 1.0)),
        };
        let inside = FRAC_PI_2 - 1e-3;
        let phi = match self.below(5) {
            0 => self.between(-PI, PI),
            1 => PI + self.sign() * self.scale(1e-7, 1.0),
            2 => self.sign() * self.scale(1e-7, 1.0),
            3 => self.sign() * (p.phi_g + self.between(-6.0, 6.0) * p.gamma_g),
            _ => PI + self.between(-6.0, 6.0) * p.gamma_tt,
        };
        direction(theta.clamp(-inside, inside), phi_o - phi)
    }

    /// Draws legal parameters from the whole range, its ends included more often than chance.
    pub fn params(&mut self, brightest: f64) -> HairParams {
        let mut width = || match self.below(8) {
            0 => MIN_WIDTH,
            1 => MAX_WIDTH,
            _ => narrow(self.scale(1.001e-4, 3.1)),
        };
        let (beta, gamma_tt, gamma_g) = ([width(), width(), width()], width(), width());
        let right = core::f32::consts::FRAC_PI_2;
        let mut shift = || match self.below(8) {
            0 => right,
            1 => -right,
            2 => 0.0,
            _ => narrow(self.between(-1.57, 1.57)),
        };
        let alpha = [shift(), shift(), shift()];
        let phi_g = match self.below(6) {
            0 => 0.0,
            1 => core::f32::consts::PI,
            _ => narrow(self.between(0.0, PI)),
        };
        let dimmest = 1.0 / brightest;
        let mut intensity = || match self.below(8) {
            0 => 0.0,
            1 => narrow(brightest),
            _ => narrow(self.scale(dimmest, brightest)),
        };
        let mut rgb = || [intensity(), intensity(), intensity()];
        let (i_r, i_tt, i_trt) = (rgb(), rgb(), rgb());
        let i_g = intensity();
        HairParams::new(&HairDesc {
            alpha,
            beta,
            gamma_tt,
            gamma_g,
            phi_g,
            i_r,
            i_tt,
            i_trt,
            i_g,
        })
        .unwrap()
    }
}

/// Returns the inclination of `wi`, and its azimuth relative to `wo` folded into `[0, pi]`.
pub fn angles(wo: Vec3, wi: Vec3) -> [f64; 2] {
    let ([_, v_o, w_o], [u, v, w]) = (double(wo), double(wi));
    let (dot, cross) = (v * v_o + w * w_o, v * w_o - w * v_o);
    [u.atan2(v.hypot(w)), cross.atan2(dot).abs()]
}

/// Returns the parameters that the reference needs for the kernels' widths, rounded where the kernels round.
pub fn parameters(params: &HairParams, factor: f32) -> HairDesc<f64> {
    let p = params.desc().map(f64::from);
    let d = params.desc();
    let by = |width: f32| f64::from((width * factor).max(5e-5));
    HairDesc {
        beta: d.beta.map(by),
        gamma_tt: by(d.gamma_tt),
        gamma_g: by(d.gamma_g),
        ..p
    }
}

/// Returns the reference at the shading point of `wo`.
pub fn oracle(
    formulas: &HairFormulas,
    params: &HairParams,
    factor: f32,
    wo: Vec3,
) -> Box<dyn Reference<f64>> {
    formulas.prepare(&parameters(params, factor), double(wo))
}

/// Kinds of material that tests go through.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Materials of the grid of the efficiency figures, and the presets.
    Grid,
    /// Materials whose widths are all 0.5 degrees.
    Narrow,
    /// Materials whose widths are all 60 degrees.
    Wide,
}

/// Returns the default hair with all widths set to `width`, in rad.
pub(super) fn widths(width: f32) -> HairDesc {
    HairDesc {
        beta: [width; 3],
        gamma_tt: width,
        gamma_g: width,
        ..*HairParams::bright().desc()
    }
}

/// Returns the materials of one kind.
pub fn materials(kind: Kind) -> Vec<HairParams> {
    let uniform = |deg: f64| {
        let widths = widths(narrow(deg * DEG));
        let tilted = HairDesc {
            alpha: [0.2, -0.15, -0.35],
            phi_g: 0.7,
            ..widths
        };
        [widths, tilted]
            .map(|d| HairParams::new(&d).unwrap())
            .to_vec()
    };
    match kind {
        Kind::Narrow => uniform(0.5),
        Kind::Wide => uniform(60.0),
        Kind::Grid => {
            let mut all: Vec<_> = HairParams::presets()
                .into_iter()
                .map(|(_, params)| params)
                .collect();
            for beta in [2.5, 5.0, 7.5, 10.0, 15.0, 20.0] {
                for gamma_tt in [5.0, 10.0, 25.0, 45.0] {
                    for gamma_g in [5.0, 10.0, 20.0] {
                        for phi_g in [20.0, 35.0, 45.0] {
                            all.extend(
                                [0.5, 5.0]
                                    .map(|i_g| grid_point(beta, gamma_tt, gamma_g, phi_g, i_g)),
                            );
                        }
                    }
                }
            }
            all
        }
    }
}

/// Returns a material of the grid of the efficiency figures, with angles in degrees.
pub fn grid_point(beta_r: f64, gamma_tt: f64, gamma_g: f64, phi_g: f64, i_g: f32) -> HairParams {
    let beta = [1.0, 0.5, 2.0].map(|k| narrow(k * beta_r * DEG));
    let [gamma_tt, gamma_g, phi_g] = [gamma_tt, gamma_g, phi_g].map(|x| narrow(x * DEG));
    let desc = HairDesc {
        beta,
        gamma_tt,
        gamma_g,
        phi_g,
        i_g,
        ..*HairParams::bright().desc()
    };
    HairParams::new(&desc).unwrap()
}

/// Inclinations of `wo` in degrees: grazing on both sides, and tilted.
pub const THETA_O: [f64; 12] = [
    0.0, 15.0, -30.0, 45.0, -60.0, 75.0, -80.0, 85.0, 89.0, -89.0, 89.9, -89.9,
];

/// Calls `f` with a material of one kind and its reference, for every form of the model, material and inclination: of the grid, for the
/// share of its points that the size of the run keeps. Lobes chosen by channel have half of them in CI's size, as the code is that of nine
/// bands, which have all.
pub(super) fn for_each_point(
    tested: &Tested,
    kind: Kind,
    mut f: impl FnMut(&Material<'_>, &dyn Reference<f64>, &Point),
) {
    let share = if tested.formulas.by_channel { 0.5 } else { 1.0 };
    for (model, factor) in tested.forms() {
        for (index, params) in materials(kind).iter().enumerate() {
            let material = Material::new(model, params);
            for (turn, theta_o) in THETA_O.into_iter().enumerate() {
                if kind == Kind::Grid && !is_kept_of(share, index + turn) {
                    continue;
                }
                let (theta_o, phi_o) = (theta_o * DEG, 0.7 * turn as f64 - 3.0);
                let wo = direction(theta_o, phi_o);
                let seed = (index * 100 + turn) as u64;
                let p = parameters(params, factor);
                let point = Point {
                    params: *params,
                    p,
                    wo,
                    theta_o,
                    phi_o,
                    seed,
                };
                f(
                    &material,
                    &*oracle(&tested.formulas, params, factor, wo),
                    &point,
                );
            }
        }
    }
}

/// Shading point of a material, as parameters and angles.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub params: HairParams,
    pub p: HairDesc<f64>,
    pub wo: Vec3,
    pub theta_o: f64,
    pub phi_o: f64,
    pub seed: u64,
}

impl Point {
    /// Returns directions to test at, which are the same in every run. None is on the edge where the sampler cuts the glints.
    pub fn directions(&self, count: usize) -> Vec<Vec3> {
        let mut draws = Draws(self.seed);
        let mut all = Vec::with_capacity(count);
        while all.len() < count {
            let wi = draws.near_lobes(&self.p, self.theta_o, self.phi_o);
            if (angles(self.wo, wi)[1] - FRAC_PI_2).abs() > 1e-6 {
                all.push(wi);
            }
        }
        all
    }
}

/// Packs a list into eight lanes, and repeats it if it is short.
pub fn packet(v: &[Vec3]) -> Vec3x8 {
    core::array::from_fn::<Vec3, 8, _>(|lane| v[lane % v.len()]).into()
}
