//! Discard of samples at grazing angles: the share of the energy within 1e-5 rad of the fibre's axis.

use super::bounded::{Bounded, integrals, largest};
use super::claim::{Claim, Figure, Side, Statement};
use super::hair::Longitudinal;
use crate::study::Grid;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::params::HairDesc;
use hairis::{HairParams, Lobe, ParamError};
use hairis_harness::subject::ModelKind;
use hairis_reference::{HairReference, Reference, Shape};

/// Statement whose bound is a hundredth of an error of 1%.
const STATEMENT: Statement = Statement {
    id: "grazing-discard",
    quotation: "Although in theory this may bias the result when the gaussian is wide, in practice this is not a problem \
                since most longitudinal lobe for hair tend to be sharp.",
    source: "section 3.3",
    of: "relative bias under constant light: the share of the energy that is discarded",
    side: Side::AtMost,
    bound: 1e-4,
    limits: "the parameter grid",
};

/// Angle to the axis within which samples are discarded, rad.
pub const CAP: f64 = 1e-5;

/// Widths of the lobe that points at the axis, rad: the least accepted width, then 0.1, 0.5, 2.5, 10 and 60 degrees.
const BETA: [f64; 6] = [
    1e-4,
    0.1 * PI / 180.0,
    0.5 * PI / 180.0,
    2.5 * PI / 180.0,
    10.0 * PI / 180.0,
    60.0 * PI / 180.0,
];

impl Longitudinal {
    /// Returns `M cos^2 theta_i / cos^2 theta_d` at `delta` from the end `sign` of the axis. The reference returns 0 within the cap.
    #[must_use]
    pub fn energy_at(&self, shape: Shape, sign: f64, delta: f64) -> f64 {
        let theta_i = sign * (FRAC_PI_2 - delta);
        let m = shape.bell(self.beta, 0.5 * (theta_i + self.theta_o) - self.alpha);
        let ratio = delta.sin() / (0.5 * (self.theta_o - theta_i)).cos();
        m * ratio * ratio
    }

    /// Returns the energy of the lobe within `reach` of both ends of the axis.
    fn energy(&self, shape: Shape, reach: f64) -> Bounded {
        let at_end = |sign: f64| {
            let centre = FRAC_PI_2 - sign * (2.0 * self.alpha - self.theta_o);
            integrals(
                |delta| [self.energy_at(shape, sign, delta)],
                &[0.0, reach],
                centre,
                2.0 * self.beta,
            )
        };
        [-1.0, 1.0].into_iter().flat_map(at_end).sum()
    }

    /// Returns the share of the lobe's energy that is discarded.
    #[must_use]
    pub fn discarded(&self, shape: Shape) -> Bounded {
        self.energy(shape, CAP).over(self.energy(shape, FRAC_PI_2))
    }
}

/// Returns, for R, TT and TRT with its glints, the mean intensity times the azimuthal integral.
fn areas(shape: Shape, p: &HairDesc<f64>) -> [f64; 3] {
    let mean = |rgb: [f64; 3]| rgb.iter().sum::<f64>() / 3.0;
    let area = |centre: f64, width: f64| {
        let [half] = integrals(
            |phi| [shape.bell(width, phi - centre)],
            &[0.0, PI],
            centre,
            width,
        );
        2.0 * half.value
    };
    let trt = 4.0 + p.i_g * area(p.phi_g, p.gamma_g);
    [
        4.0 * mean(p.i_r),
        area(PI, p.gamma_tt) * mean(p.i_tt),
        trt * mean(p.i_trt),
    ]
}

/// Returns the share of a hair's energy that is discarded.
fn share_of(shape: Shape, params: &HairParams, theta_o: f64) -> Bounded {
    let p = params.desc().map(f64::from);
    let areas = areas(shape, &p);
    let energy = |reach: f64| -> Bounded {
        let of_lobe = |lobe: usize| Longitudinal::of(&p, lobe, theta_o).energy(shape, reach);
        (0..3)
            .map(|lobe| Bounded::exact(areas[lobe]).times(of_lobe(lobe)))
            .sum()
    };
    energy(CAP).over(energy(FRAC_PI_2))
}

/// Returns the share of a hair's samples that are discarded.
pub fn discarded(params: &HairParams, theta_o: f64) -> f64 {
    let wo = [theta_o.sin(), theta_o.cos(), 0.0];
    let hair = HairReference::prepare(&params.desc().map(f64::from), Shape::Gaussian, wo);
    let shares = hair.probabilities();
    let of = |lobe: Lobe| {
        hair.cdf_theta(lobe, CAP - FRAC_PI_2) + 1.0 - hair.cdf_theta(lobe, FRAC_PI_2 - CAP)
    };
    Lobe::FOUR
        .into_iter()
        .map(|lobe| shares[lobe] * of(lobe))
        .sum()
}

/// Returns the discarded share of a lobe of width `beta` with its peak on the axis, opposite to a viewer at `theta_o` above the normal
/// plane.
#[must_use]
pub fn pointed(shape: Shape, beta: f64, theta_o: f64) -> Bounded {
    Longitudinal {
        alpha: 0.5 * (theta_o - FRAC_PI_2),
        beta,
        theta_o,
    }
    .discarded(shape)
}

/// Judges the discard of samples at grazing angles.
pub(super) fn claim() -> Result<Claim, ParamError> {
    let mut cells = Vec::new();
    for index in 0..Grid::FULL.len() {
        let cell = Grid::FULL.cell(index);
        cells.push((cell.params()?, f64::from(cell.theta_o_deg).to_radians()));
    }
    let grid = |model: ModelKind| {
        largest(
            cells
                .iter()
                .map(|(params, theta_o)| share_of(model.shape(), params, *theta_o)),
        )
    };
    let [gaussian, cauchy] = ModelKind::ALL.map(grid);
    let lost = cells
        .iter()
        .map(|(params, theta_o)| discarded(params, *theta_o))
        .fold(0.0, f64::max);
    let theta_o = [0.0, 45.0, 85.0, 90.0].map(f64::to_radians);
    let across = |beta: f64| {
        largest(
            theta_o[..3]
                .iter()
                .map(|t| pointed(Shape::Gaussian, beta, *t)),
        )
    };
    let all = BETA.iter().flat_map(|beta| {
        ModelKind::ALL
            .into_iter()
            .flat_map(move |model| theta_o.map(|t| pointed(model.shape(), *beta, t)))
    });
    let (worst, narrow, half, wide) = (
        largest(all),
        across(BETA[0]),
        across(BETA[2]),
        across(BETA[5]),
    );
    let sentence = format!(
        "Over the grid at most {:.0e} of the energy is lost; it is narrow lobes that lose more, not wide ones: pointed at \
         the axis, {:.0e} at β = 0.5° and {:.0e} at 1e-4 rad, {:.0}% of the latter when the viewer looks along the \
         fibre.",
        largest([gaussian, cauchy]).value,
        half.value,
        narrow.value,
        100.0 * worst.value,
    );
    let figures = Figure::integrals([
        (
            "largest bias of a lobe pointed at the axis, β from 1e-4 rad to 60°, θ_o from 0° to 90°",
            worst,
        ),
        (
            "largest bias on the grid, both models",
            largest([gaussian, cauchy]),
        ),
        ("largest bias on the grid, Gaussian", gaussian),
        ("largest bias on the grid, Cauchy", cauchy),
        (
            "pointed at the axis, β = 1e-4 rad, θ_o from 0° to 85°",
            narrow,
        ),
        ("pointed at the axis, β = 0.5°, θ_o from 0° to 85°", half),
        ("pointed at the axis, β = 60°, θ_o from 0° to 85°", wide),
        (
            "pointed at the axis, β = 10°, viewer on the axis",
            pointed(Shape::Gaussian, BETA[4], FRAC_PI_2),
        ),
        (
            "largest share of samples discarded on the grid",
            Bounded {
                value: lost,
                error: 1e-12,
            },
        ),
    ]);
    Ok(STATEMENT.judge(figures, sentence))
}
