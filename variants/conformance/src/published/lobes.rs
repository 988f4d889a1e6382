//! The lobes apart: their sums, and every subset of them.

use super::Tested;
use super::support::{Draws, Kind, double, for_each_point, lanes_of, narrow, packet};
use crate::comparison::{LargestError, relative};
use crate::probe::masks;
use hairis::simd::Level;
use hairis::{Lobe, LobeMask};

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
            let sum = Lobe::ALL
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

pub fn a_subset_scatters_and_samples_its_lobes_alone(tested: &Tested) {
    let (mut s, mut pdf) = (LargestError::default(), LargestError::default());
    for_each_point(tested, Kind::Wide, |material, reference, point| {
        let bsdf = material.prepare(point.wo);
        let eight = material
            .with_level(Level::detect())
            .prepare8(&hairis::Vec3x8::splat(point.wo));
        let mut draws = Draws(point.seed);
        for mask in masks() {
            let part = bsdf.with_lobes(mask);
            let total: f64 = Lobe::ALL
                .into_iter()
                .map(|l| reference.probabilities()[l] * f64::from(mask.factor(l)))
                .sum();
            for wi in point.directions(8) {
                let at = || format!("{mask:?} wo {:?} wi {wi:?} {:?}", point.wo, point.params);
                let (lobes, got) = (bsdf.lobes(wi), part.eval_pdf(wi));
                let of = |f: &dyn Fn(Lobe) -> f64| -> f64 {
                    Lobe::ALL
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
                let value_alone = part.lobes(wi);
                for lobe in Lobe::ALL {
                    let color =
                        value_alone[lobe].color.iter().sum::<f32>() * value_alone[lobe].value;
                    assert!(
                        mask.contains(lobe) || color == 0.0,
                        "{lobe:?} is not in {mask:?} yet scatters {color}"
                    );
                }
            }
            let xi = core::array::from_fn(|_| draws.xi3());
            let samples = eight
                .with_lobes(mask)
                .with_level(Level::detect())
                .sample8(&lanes_of(&xi));
            for (lane, xi) in xi.into_iter().enumerate() {
                for sample in [part.sample(xi), samples.lane(lane)] {
                    let lobe = sample.map(|s| s.lobe);
                    assert!(
                        lobe.is_none_or(|l| mask.contains(l)),
                        "{lobe:?} was drawn of {mask:?} xi {xi:?}"
                    );
                    assert!(
                        mask != LobeMask::NONE || lobe.is_none(),
                        "no lobe, yet {lobe:?} was drawn"
                    );
                }
            }
        }
        let none = bsdf.with_lobes(LobeMask::NONE);
        for eight in point.directions(8).chunks(8) {
            let all = none.with_level(Level::detect()).eval_pdf8(&packet(eight));
            assert!(
                all.pdf.to_array() == [0.0; 8],
                "a pdf without lobes: {all:?}"
            );
            assert!(
                all.value.iter().all(|c| c.to_array() == [0.0; 8]),
                "a value without lobes: {all:?}"
            );
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
        for (lobe, color) in Lobe::ALL.into_iter().zip(colors) {
            assert_eq!(lobes[lobe].color, color, "color of {lobe:?}");
        }
        // The strength of the glints is theirs, not the color's.
        let glint = reference.lobe_values(double(wi))[Lobe::GLINT];
        let error = relative(lobes[Lobe::GLINT].value, glint, 1e-20);
        assert!(
            error <= tested.rows.wide[2],
            "glint {:?} against {}",
            lobes[Lobe::GLINT],
            narrow(glint)
        );
    });
}
