//! Tests of lobes next to nothing: faint ones, and ones that lie off the sphere.

use super::Tested;
use super::edge::samples;
use super::handles::{Bsdf, Material};
use super::support::{Draws, packet};
use core::f32::consts::FRAC_PI_2;
use glam::Vec3;
use hairis::params::HairDesc;
use hairis::simd::Level;
use hairis::{HairParams, Lobe, LobeMask, Sample};

fn bsdf(tested: &Tested, desc: &HairDesc, wo: Vec3) -> Bsdf {
    Material::new(tested.model(), &HairParams::new(desc).unwrap()).prepare(wo)
}

fn near(got: f32, want: f32, by: f32) -> bool {
    (got / want - 1.0).abs() < by
}

/// A share of the energy below the normal numbers has no finite reciprocal.
pub fn a_faint_lobe_alone_is_sampled_as_a_bright_one(tested: &Tested) {
    let mut draws = Draws(61);
    let only = LobeMask::of(&[Lobe::TT]);
    for wo in [Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.96, 0.0, 0.28)] {
        let usual = bsdf(tested, HairParams::bright().desc(), wo).with_lobes(only);
        for intensity in [1e-10, 1e-30, 1e-37, 1e-39, 1e-42, 1e-45] {
            let desc = HairDesc {
                i_tt: [intensity; 3],
                ..*HairParams::bright().desc()
            };
            let faint = bsdf(tested, &desc, wo).with_lobes(only);
            let mut drawn = 0;
            for _ in 0..200 {
                let xi = draws.xi3();
                for (faint, usual) in samples(&faint, xi).into_iter().zip(samples(&usual, xi)) {
                    let (faint, usual) = match (faint, usual) {
                        (Some(faint), Some(usual)) => (faint, usual),
                        // Next to the axis either is discarded.
                        (None, None) => continue,
                        one => panic!("{one:?} at {intensity} xi {xi:?}"),
                    };
                    let at = || {
                        format!("{faint:?}, as bright as usual {usual:?}, at {intensity} xi {xi:?}")
                    };
                    assert_eq!((faint.lobe, faint.wi), (usual.lobe, usual.wi), "{}", at());
                    assert!(near(faint.pdf, usual.pdf, 1e-5), "{}", at());
                }
                let Some(Sample { wi, .. }) = usual.sample(xi) else {
                    continue;
                };
                drawn += 1;
                for level in Level::available() {
                    let eight =
                        |bsdf: &Bsdf| bsdf.with_level(level).eval_pdf8(&packet(&[wi])).lane(3);
                    for (got, want) in [
                        (eight(&faint), eight(&usual)),
                        (faint.eval_pdf(wi), usual.eval_pdf(wi)),
                    ] {
                        assert!(
                            near(got.pdf, want.pdf, 1e-5),
                            "{got:?}, as bright as usual {want:?}, {level} {wi}"
                        );
                    }
                }
            }
            assert!(drawn > 190, "{drawn} of 200 are drawn");
        }
    }
}

/// All of a lobe's density is in its far tail, and its integral is next to nothing: less than a reciprocal of the squares.
pub fn a_lobe_off_the_sphere_has_the_density_it_is_drawn_with(tested: &Tested) {
    let black = [0.0; 3];
    let mut seen = 0;
    let default = *HairParams::bright().desc();
    for (alpha_trt, beta_trt) in [
        (-FRAC_PI_2, 0.063),
        (-FRAC_PI_2, 0.0628),
        (-FRAC_PI_2, 0.07),
        (-1.3, 0.05),
        (1.4, 0.1),
    ] {
        let desc = HairDesc {
            i_r: black,
            i_tt: black,
            i_g: 0.0,
            alpha: [default.alpha[0], default.alpha[1], alpha_trt],
            beta: [default.beta[0], default.beta[1], beta_trt],
            ..*HairParams::bright().desc()
        };
        let bsdf = bsdf(tested, &desc, Vec3::Y);
        for wi in [
            Vec3::new(-1.0, 1e-3, 0.0),
            Vec3::new(-1.0, 1e-4, 1e-4),
            Vec3::new(1.0, 1e-2, 0.0),
            Vec3::new(0.9, 0.1, 0.4),
        ] {
            let wi = wi.normalize();
            let eight = |level| {
                (
                    bsdf.with_level(level).eval_pdf8(&packet(&[wi])).lane(2).pdf,
                    bsdf.with_level(level).lobes8(&packet(&[wi]))[Lobe::TRT]
                        .pdf
                        .to_array()[2],
                )
            };
            for (pdf, lobe) in Level::available()
                .map(eight)
                .chain([(bsdf.pdf(wi), bsdf.lobes(wi)[Lobe::TRT].pdf)])
            {
                assert!(
                    lobe == pdf || near(lobe, pdf, 1e-4),
                    "{lobe} where {pdf} is drawn: {wi} {desc:?}"
                );
                seen += usize::from(pdf > 0.0);
            }
        }
    }
    assert!(seen > 20, "hardly any density: {seen}");
}
