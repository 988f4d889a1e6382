//! The discard of samples at grazing angles: the energy within 1e-5 rad of the fibre's axis, over the whole.

use super::claim::{Bounded, Claim, Figure, Side, Threshold, Words, largest};
use crate::quadrature::{Tolerance, bell_breakpoints, integrate};
use crate::study::Grid;
use crate::subject::ModelKind;
use core::f64::consts::{FRAC_PI_2, PI};
use hairis::reference::{HairReference, Parameters, Shape};
use hairis::{HairParams, Lobe};

const WORDS: Words = Words {
    id: "grazing-discard",
    quotation: "Although in theory this may bias the result when the gaussian is wide, in practice this is not a problem \
                since most longitudinal lobe for hair tend to be sharp.",
    source: "section 3.3",
};

/// The bound is a hundredth of an error of 1%.
const THRESHOLD: Threshold = Threshold {
    of: "relative bias under constant light: the share of the energy that is discarded",
    side: Side::AtMost,
    bound: 1e-4,
    limits: "the parameter grid",
};

/// Angle from the axis within which samples are discarded, rad.
const CAP: f64 = 1e-5;

/// Widths of the lobe that points at the axis, rad: the least that is accepted, then 0.1, 0.5, 2.5, 10 and 60 degrees.
const BETA: [f64; 6] =
    [1e-4, 0.1 * PI / 180.0, 0.5 * PI / 180.0, 2.5 * PI / 180.0, 10.0 * PI / 180.0, 60.0 * PI / 180.0];

/// A longitudinal lobe, seen from `theta_o`; in rad.
#[derive(Clone, Copy, Debug)]
struct Lobe1 {
    shape: Shape,
    alpha: f64,
    beta: f64,
    theta_o: f64,
}

impl Lobe1 {
    /// `M cos^2 theta_i / cos^2 theta_d` at `delta` from the end `sign` of the axis. The reference is 0 within the cap.
    fn energy_at(&self, sign: f64, delta: f64) -> f64 {
        let theta_i = sign * (FRAC_PI_2 - delta);
        let m = self.shape.bell(self.beta, 0.5 * (theta_i + self.theta_o) - self.alpha);
        let ratio = delta.sin() / (0.5 * (self.theta_o - theta_i)).cos();
        m * ratio * ratio
    }

    /// Its energy within `reach` of both ends of the axis.
    fn energy(&self, reach: f64) -> Bounded {
        let mut sum = Bounded { value: 0.0, error: 0.0 };
        for sign in [-1.0, 1.0] {
            let centre = FRAC_PI_2 - sign * (2.0 * self.alpha - self.theta_o);
            let mut breaks = vec![0.0, reach];
            breaks.extend(bell_breakpoints(centre, 2.0 * self.beta).into_iter().filter(|x| (0.0..=reach).contains(x)));
            let r = integrate(|delta| [self.energy_at(sign, delta)], &breaks, &Tolerance::default());
            sum = Bounded { value: sum.value + r.value[0], error: sum.error + r.error[0] };
        }
        sum
    }

    /// The share of its energy that is discarded.
    fn share(&self) -> Bounded {
        self.energy(CAP).over(self.energy(FRAC_PI_2))
    }
}

/// Mean intensity times azimuthal integral of R, TT and of TRT with its glints.
fn areas(shape: Shape, p: &Parameters<f64>) -> [f64; 3] {
    let mean = |rgb: [f64; 3]| rgb.iter().sum::<f64>() / 3.0;
    let area = |centre: f64, width: f64| {
        let mut breaks = vec![0.0, PI];
        breaks.extend(bell_breakpoints(centre, width).into_iter().filter(|x| (0.0..=PI).contains(x)));
        2.0 * integrate(|phi| [shape.bell(width, phi - centre)], &breaks, &Tolerance::default()).value[0]
    };
    let trt = 4.0 + p.intensity_g * area(p.phi_g, p.gamma_g);
    [4.0 * mean(p.intensity_r), area(PI, p.gamma_tt) * mean(p.intensity_tt), trt * mean(p.intensity_trt)]
}

/// The share of the energy of a hair that is discarded.
fn share_of(shape: Shape, params: &HairParams, theta_o: f64) -> Bounded {
    let p = Parameters::<f64>::from(params);
    let none = Bounded { value: 0.0, error: 0.0 };
    let (mut cap, mut whole) = (none, none);
    for (lobe, area) in areas(shape, &p).into_iter().enumerate() {
        let of = Lobe1 { shape, alpha: p.alpha[lobe], beta: p.beta[lobe], theta_o };
        let add = |sum: &mut Bounded, reach: f64| {
            let energy = of.energy(reach);
            *sum = Bounded { value: sum.value + area * energy.value, error: sum.error + area * energy.error };
        };
        add(&mut cap, CAP);
        add(&mut whole, FRAC_PI_2);
    }
    cap.over(whole)
}

/// The share of the samples of a hair that are discarded.
fn discarded(params: &HairParams, theta_o: f64) -> f64 {
    let wo = [theta_o.sin(), theta_o.cos(), 0.0];
    let hair = HairReference::prepare(&Parameters::<f64>::from(params), Shape::Gaussian, wo);
    let shares = hair.probabilities();
    let of = |lobe: Lobe| hair.cdf_theta(lobe, CAP - FRAC_PI_2) + 1.0 - hair.cdf_theta(lobe, FRAC_PI_2 - CAP);
    Lobe::ALL.into_iter().map(|lobe| shares[lobe] * of(lobe)).sum()
}

/// A lobe of width `beta` with its peak on the axis, opposite to a viewer at `theta_o` above the normal plane.
fn pointed(shape: Shape, beta: f64, theta_o: f64) -> Lobe1 {
    Lobe1 { shape, alpha: 0.5 * (theta_o - FRAC_PI_2), beta, theta_o }
}

/// The claim.
pub(super) fn claim() -> Claim {
    let cells: Vec<(HairParams, f64)> = (0..Grid::FULL.len())
        .filter_map(|index| {
            let cell = Grid::FULL.cell(index);
            Some((cell.params().ok()?, f64::from(cell.theta_o_deg).to_radians()))
        })
        .collect();
    let grid =
        |model: ModelKind| largest(cells.iter().map(|(params, theta_o)| share_of(model.shape(), params, *theta_o)));
    let [gaussian, cauchy] = ModelKind::ALL.map(grid);
    let lost = cells.iter().map(|(params, theta_o)| discarded(params, *theta_o)).fold(0.0, f64::max);
    let theta_o = [0.0, 45.0, 85.0, 90.0].map(f64::to_radians);
    let across = |beta: f64| largest(theta_o[..3].iter().map(|t| pointed(Shape::Gaussian, beta, *t).share()));
    let along = |beta: f64| pointed(Shape::Gaussian, beta, FRAC_PI_2).share();
    let all = BETA.iter().flat_map(|beta| {
        ModelKind::ALL.into_iter().flat_map(move |model| theta_o.map(|t| pointed(model.shape(), *beta, t).share()))
    });
    let (worst, narrow, half, wide) = (largest(all), across(BETA[0]), across(BETA[2]), across(BETA[5]));
    let sentence = format!(
        "Over the grid at most {:.0e} of the energy is lost; it is narrow lobes that lose more, not wide ones: pointed at \
         the axis, {:.0e} at β = 0.5° and {:.0e} at 1e-4 rad, {:.0}% of the latter when the viewer looks along the \
         fibre.",
        largest([gaussian, cauchy]).value,
        half.value,
        narrow.value,
        100.0 * worst.value,
    );
    let figure = |name: &str, of| Figure::integral(name, of, "");
    Claim::judge(
        WORDS,
        THRESHOLD,
        [
            figure("largest bias of a lobe pointed at the axis, β from 1e-4 rad to 60°, θ_o from 0° to 90°", worst),
            figure("largest bias on the grid, both models", largest([gaussian, cauchy])),
        ],
        vec![
            figure("largest bias on the grid, Gaussian", gaussian),
            figure("largest bias on the grid, Cauchy", cauchy),
            figure("pointed at the axis, β = 1e-4 rad, θ_o from 0° to 85°", narrow),
            figure("pointed at the axis, β = 0.5°, θ_o from 0° to 85°", half),
            figure("pointed at the axis, β = 60°, θ_o from 0° to 85°", wide),
            figure("pointed at the axis, β = 10°, viewer on the axis", along(BETA[4])),
            figure("largest share of samples discarded on the grid", Bounded { value: lost, error: 1e-12 }),
        ],
        sentence,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beyond_the_cap_it_is_the_reference() {
        let params = HairParams::default();
        let p = Parameters::<f64>::from(&params);
        for (theta_o, delta) in [(0.3_f64, 2e-5_f64), (-1.2, 0.4), (1.5, 1.1)] {
            let hair = HairReference::prepare(&p, Shape::Cauchy, [theta_o.sin(), theta_o.cos(), 0.0]);
            for sign in [-1.0, 1.0] {
                let wi = [sign * delta.cos(), delta.sin(), 0.0];
                let of = Lobe1 { shape: Shape::Cauchy, alpha: p.alpha[2], beta: p.beta[2], theta_o };
                let want = hair.lobe_values(wi)[Lobe::TRT] * delta.sin() * delta.sin();
                assert!((of.energy_at(sign, delta) / want - 1.0).abs() < 1e-9, "{theta_o} {delta}");
            }
        }
    }

    #[test]
    fn a_narrow_lobe_loses_the_cube_of_the_cap() {
        // Integral of x^2 exp(-x^2 / 2 s^2) over [0, e], over that on the half line, for e far below s: (e/s)^3 / 3 / sqrt(pi/2).
        let beta = 2e-3;
        let want = (CAP / (2.0 * beta)).powi(3) / 3.0 / FRAC_PI_2.sqrt();
        let got = pointed(Shape::Gaussian, beta, 0.0).share();
        assert!((got.value / want - 1.0).abs() < 1e-2, "{got:?} {want}");
    }

    #[test]
    fn few_samples_are_discarded() {
        let got = discarded(&HairParams::default(), 0.0);
        // Densities of theta_i at the axis are near 0.05 per rad.
        assert!((1e-7..1e-5).contains(&got), "{got}");
    }
}
