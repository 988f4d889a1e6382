//! Tests next to `|phi|` = pi, where glints may end: samples report value and density of the direction they return, however narrow TT is.

use super::Tested;
use super::handles::Material;
use super::support::{direction, double, lanes_of, oracle};
use crate::comparison::{LargestError, relative};
use hairis::params::HairDesc;
use hairis::simd::Level;
use hairis::{HairParams, Lobe};

/// Returns numbers of 24 bits about a half, from which both TT and the glints draw pi: all next to it, and then fewer and fewer.
fn about_a_half() -> impl Iterator<Item = f32> {
    let steps = (0..200_u16).chain((8..20).map(|power| 7 << (power - 5)));
    steps.flat_map(|k| [1.0, -1.0].map(|side| 0.5 + side * f32::from(k) * f32::EPSILON / 2.0))
}

pub fn samples_next_to_the_seam_report_their_own_direction(tested: &Tested) {
    let mut worst: [LargestError; 3] = Default::default();
    let mut glints = 0;
    for (gamma_tt, gamma_g, phi_g) in [
        (0.0175, 0.3, 2.8),
        (0.0175, 1.0, 3.1),
        (0.05, 0.7, 2.2),
        (0.0175, 0.02, 3.1),
        (0.3, 0.0175, 3.12),
        (1.0, 1.0, 0.4),
    ] {
        let params = HairDesc {
            gamma_tt,
            gamma_g,
            phi_g,
            ..*HairParams::bright().desc()
        };
        let params = HairParams::new(&params).unwrap();
        for (theta_o, phi_o) in [
            (0.0, 0.0),
            (0.3, 0.785),
            (-0.9, 2.4),
            (1.2, -1.1),
            (0.7, 3.1),
        ] {
            let wo = direction(theta_o, phi_o);
            let bsdf = Material::new(tested.model(), &params).prepare(wo);
            let reference = oracle(&tested.formulas, &params, 1.0, wo);
            for xi_phi in about_a_half() {
                let xi = core::array::from_fn(|lane| {
                    [(lane as f32 + 0.5) / 8.0, 0.11 * lane as f32 + 0.05, xi_phi]
                });
                for sample in Level::available().flat_map(|level| {
                    let eight = bsdf.with_level(level).sample8(&lanes_of(&xi));
                    (0..8).filter_map(move |lane| eight.lane(lane))
                }) {
                    // R and TRT-g are 0 where TT and the glints are drawn about pi, and elsewhere where R and TRT-g are drawn.
                    if sample.lobe != Lobe::TT && sample.lobe != Lobe::GLINT {
                        continue;
                    }
                    glints += usize::from(sample.lobe == Lobe::GLINT);
                    let at = || format!("{sample:?} wo {wo:?} {xi_phi} {params:?}");
                    let d = double(sample.wi);
                    let (value, pdf) = (reference.eval(d), reference.pdf(d));
                    worst[0].see(relative(sample.value[1], value[1], 1e-20), at);
                    worst[1].see(relative(sample.pdf, pdf, 1e-20), at);
                    let weight = value[1] * d[1].hypot(d[2]) / pdf;
                    worst[2].see(relative(sample.weight[1], weight, 1e-20), at);
                }
            }
        }
    }
    assert!(glints > 1000, "hardly any glint: {glints}");
    for ((worst, bound), what) in worst
        .iter()
        .zip(tested.rows.seam)
        .zip(["S", "pdf", "weight"])
    {
        worst.check(&format!("{what} of a sample on the seam"), bound);
    }
}
