//! Formulas of the energy-conserving fibre, with and without scattering.

use super::{Accuracy, Formulas};
use crate::chiang::{ChiangConstants, ChiangFormulas, ChiangReference, Selection};
use crate::real::Real;
use core::f64::consts::TAU;
use hairis::Lobe;
use hairis_variants::chiang::{ScatteringChiang, ScatteringDesc, ScatteringParams};
use hairis_variants::{Chiang, ChiangDesc, ChiangParams, Parameters as _, Values};

impl<const BY_CHANNEL: bool> Formulas for Chiang<BY_CHANNEL> {
    type Constants<T: Real> = ChiangConstants<T>;
    type Point<T: Real> = ChiangReference<T>;
    // 1.6 times the largest that searches uphill found; `Reference::error_bound` is 8e-5 and less for roughnesses of .1.
    const ACCURACY: Accuracy = Accuracy {
        value: 4.5e-5,
        pdf: 4.5e-5,
        sample_value: 4.5e-5,
        sample_pdf: 4.5e-5,
        sample_weight: 1e-4,
        cdf: 0.0,
        slack_in_pdf: true,
    };

    #[inline]
    fn formulas<T: Real>(params: &ChiangParams) -> ChiangConstants<T> {
        ChiangConstants::new(&params.desc().map(T::from_f32), Selection::of(BY_CHANNEL))
    }

    #[inline]
    fn exact_formulas<T: Real>(params: &ChiangParams, exact: &Values<T>) -> ChiangConstants<T> {
        ChiangConstants::new(&exact_chiang(params, exact), Selection::of(BY_CHANNEL))
    }

    #[inline]
    fn point<T: Real>(constants: &ChiangConstants<T>, wo: [T; 3], h: T) -> ChiangReference<T> {
        constants.prepare(wo, h)
    }

    /// Returns the slack of the lobes, whose errors grow with their exponent: from `exp(-12)` of the peak down they are absolute.
    fn slack(params: &ChiangParams, _wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        let (p, [_, v, w]) = (params.desc().map(f64::from), wi);
        let peaks = [Lobe::R, Lobe::TT, Lobe::TRT].map(|lobe| {
            let width = (TAU * p.variances()[lobe]).sqrt() * p.scales()[lobe];
            0.25 * p.width_m[0] * p.width_n[0] / width
        });
        let peak = peaks[0];
        [Self::ACCURACY.value * (-12.0_f64).exp() * peak / v.hypot(w); 3]
    }
}

/// Returns the description that the numbers of `exact` form, with the words of `params`.
fn exact_chiang<T: Real>(params: &ChiangParams, exact: &Values<T>) -> ChiangDesc<T> {
    let parameters = ChiangDesc {
        shifts: params.desc().shifts,
        ..ChiangDesc::of_values(exact)
    };
    let parameters = if exact.has("cuticle_angle") {
        let [angle] = exact.get("cuticle_angle");
        parameters.with_cuticle_angle(angle)
    } else {
        parameters
    };
    if exact.has("melanin") {
        let [eumelanin, pheomelanin] = exact.get("melanin");
        parameters.with_melanin(eumelanin, pheomelanin)
    } else if exact.has("melanin_amount") {
        let [amount, redness] = exact.get("melanin_amount");
        parameters.with_melanin_amount(amount, redness)
    } else if exact.has("color") {
        parameters.with_color(exact.get("color"))
    } else {
        parameters
    }
}

/// Formulas with the accuracy of the fibre. Errors of widths by `wo` are in the errors of the lobes.
impl Formulas for ScatteringChiang {
    type Constants<T: Real> = ChiangConstants<T>;
    type Point<T: Real> = ChiangReference<T>;
    const ACCURACY: Accuracy = <Chiang as Formulas>::ACCURACY;

    #[inline]
    fn formulas<T: Real>(params: &ScatteringParams) -> ChiangConstants<T> {
        let ScatteringDesc { fiber, scattering } = params.desc();
        let parameters = fiber.desc().map(T::from_f32);
        ChiangConstants::new(&parameters, Selection::Mean)
            .with_scattering(&parameters, T::from_f32(*scattering))
    }

    #[inline]
    fn exact_formulas<T: Real>(params: &ScatteringParams, exact: &Values<T>) -> ChiangConstants<T> {
        let parameters = exact_chiang(&params.desc().fiber, exact);
        let scattering = exact.number_at(ChiangParams::FIELDS.len());
        ChiangConstants::new(&parameters, Selection::Mean).with_scattering(&parameters, scattering)
    }

    #[inline]
    fn point<T: Real>(constants: &ChiangConstants<T>, wo: [T; 3], h: T) -> ChiangReference<T> {
        constants.prepare(wo, h)
    }

    /// Returns that of the fibre without scattering, whose peaks are at least as high.
    fn slack(params: &ScatteringParams, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        <Chiang as Formulas>::slack(&params.desc().fiber, wo, wi)
    }
}
