//! Tests of separate lobes: their sums, and every subset of them.

use super::Tested;
use super::support::{Kind, double, for_each_point, narrow};
use crate::comparison::{LargestError, relative};
use crate::probe::masks;
use hairis::Lobe;

pub fn lobes_add_up(tested: &Tested) {
    let (mut s, mut pdf) = (LargestError::default(), LargestError::default());
    for_each_point(tested, Kind::Grid, |material, reference, point| {
        let bsdf = material.prepare(point.wo);
        let probability = reference.probabilities();
        for wi in point.directions(8) {
            let (lobes, all) = (bsdf.lobes(wi), bsdf.eval_pdf(wi));
            let at = || format!("wo {:?} wi {wi:?} {:?}", point.wo, point.params);
            for c in 0..3 {
                let sum = lobes
                    .0
                    .iter()
                    .map(|lobe| f64::from(lobe.value) * f64::from(lobe.color[c]))
                    .sum();
                s.see(relative(all.value[c], sum, 1e-20), at);
            }
            let sum = Lobe::FOUR
                .into_iter()
                .map(|lobe| probability[lobe] * f64::from(lobes[lobe].pdf))
                .sum();
            pdf.see(
                relative(all.pdf, sum, tested.pdf_floor.max(f64::MIN_POSITIVE)),
                at,
            );
        }
    });
    s.check("S against its lobes", tested.rows.lobe_sum);
    pdf.check("pdf against its lobes", tested.rows.lobe_sum);
}

pub fn a_subset_scatters_its_lobes_alone(tested: &Tested) {
    let (mut s, mut pdf) = (LargestError::default(), LargestError::default());
    for_each_point(tested, Kind::Wide, |material, reference, point| {
        let bsdf = material.prepare(point.wo);
        for mask in masks() {
            let part = bsdf.with_lobes(mask);
            let total: f64 = Lobe::FOUR
                .into_iter()
                .map(|l| reference.probabilities()[l] * f64::from(mask.factor(l)))
                .sum();
            for wi in point.directions(8) {
                let at = || format!("{mask:?} wo {:?} wi {wi:?} {:?}", point.wo, point.params);
                let (lobes, got) = (bsdf.lobes(wi), part.eval_pdf(wi));
                let of = |f: &dyn Fn(Lobe) -> f64| -> f64 {
                    Lobe::FOUR
                        .into_iter()
                        .filter(|lobe| mask.contains(*lobe))
                        .map(f)
                        .sum()
                };
                for c in 0..3 {
                    let sum = of(&|l| f64::from(lobes[l].value) * f64::from(lobes[l].color[c]));
                    s.see(relative(got.value[c], sum, 1e-20), at);
                }
                let sum = of(&|l| reference.probabilities()[l] * f64::from(lobes[l].pdf))
                    / total.max(1e-300);
                pdf.see(relative(got.pdf, sum, tested.pdf_floor.max(1e-300)), at);
            }
        }
    });
    s.check("S of a subset", tested.rows.lobe_sum);
    pdf.check("pdf of a subset", tested.rows.lobe_sum);
}

pub fn a_lobe_is_colored_by_its_parameters(tested: &Tested) {
    for_each_point(tested, Kind::Wide, |material, reference, point| {
        let bsdf = material.prepare(point.wo);
        let d = point.params.desc();
        let wi = point.directions(1)[0];
        let lobes = bsdf.lobes(wi);
        let colors = [d.i_r, d.i_tt, d.i_trt, d.i_trt];
        for (lobe, color) in Lobe::FOUR.into_iter().zip(colors) {
            assert_eq!(lobes[lobe].color, color, "color of {lobe:?}");
        }
        // The strength of the glints belongs to their value, not to their colour.
        let glint = reference.lobe_values(double(wi))[Lobe::GLINT];
        let [allowed, _] = reference.lobe_errors(double(wi)).unwrap()[Lobe::GLINT];
        assert!(
            relative(lobes[Lobe::GLINT].value, glint, 1e-20) <= allowed,
            "glint {:?} against {}",
            lobes[Lobe::GLINT],
            narrow(glint)
        );
    });
}
