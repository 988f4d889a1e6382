//! Tests of exact cases, at the ends of every range.

use super::Tested;
use super::handles::{Bsdf, Material};
use super::support::{Draws, lanes_of, packet, widths};
use crate::probe::LAST;
use core::f32::consts::{FRAC_PI_2, PI};
use glam::Vec3;
use hairis::model::GRAZING;
use hairis::params::{HairDesc, MAX_WIDTH, MIN_WIDTH};
use hairis::simd::Level;
use hairis::{HairParams, Lobe, LobeMask, Sample};

pub(super) const ENDS: [f32; 4] = [0.0, f32::EPSILON / 2.0, 0.5, LAST];

pub(super) fn material<'a>(tested: &'a Tested, desc: &HairDesc) -> Material<'a> {
    Material::new(tested.model(), &HairParams::new(desc).unwrap())
}

/// Draws the sample of one lane, and of every level.
pub(super) fn samples(bsdf: &Bsdf, xi: [f32; 3]) -> Vec<Option<Sample>> {
    let wide =
        Level::available().map(|level| bsdf.with_level(level).sample8(&lanes_of(&[xi; 8])).lane(5));
    wide.chain([bsdf.sample(xi)]).collect()
}

fn assert_sound(sample: &Sample, at: &str) {
    let numbers = [sample.value, sample.weight].concat();
    assert!(
        numbers.iter().all(|x| x.is_finite() && *x >= 0.0),
        "{at}: {sample:?}"
    );
    assert!(
        sample.pdf.is_finite() && sample.pdf > 0.0,
        "{at}: {sample:?}"
    );
    assert!((sample.wi.length() - 1.0).abs() < 1e-6, "{at}: {sample:?}");
}

pub fn ends_of_xi_give_sound_samples_of_every_lobe(tested: &Tested) {
    let wos = [
        Vec3::Y,
        Vec3::X,
        -Vec3::X,
        Vec3::ZERO,
        Vec3::new(0.6, 0.0, -0.8),
        Vec3::new(-0.9999, 0.01, 0.01),
    ];
    let mut seen = [0; 4];
    for desc in [widths(MIN_WIDTH), widths(0.1), widths(MAX_WIDTH)] {
        for (alpha, phi_g) in [
            (0.0, 0.0),
            (FRAC_PI_2, PI),
            (-FRAC_PI_2, FRAC_PI_2),
            (0.3, 0.7),
        ] {
            let desc = HairDesc {
                alpha: [alpha, -alpha, alpha],
                phi_g,
                ..desc
            };
            for wo in wos {
                let bsdf = material(tested, &desc).prepare(wo);
                for lobe in Lobe::FOUR {
                    let alone = bsdf.with_lobes(LobeMask::of(&[lobe]));
                    for xi in ENDS
                        .iter()
                        .flat_map(|a| ENDS.iter().flat_map(|b| ENDS.map(|c| [*a, *b, c])))
                    {
                        for sample in samples(&alone, xi).into_iter().flatten() {
                            assert_sound(&sample, &format!("xi {xi:?} wo {wo:?} {desc:?}"));
                            assert_eq!(sample.lobe, lobe, "xi {xi:?} wo {wo:?} {desc:?}");
                            seen[lobe.index()] += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(
        seen.iter().all(|n| *n > 2000),
        "hardly any sample was kept: {seen:?}"
    );
}

/// On the seam R and TRT-g vanish: only a difference of rounded numbers is left of them, and no other lobe has their colours.
pub fn nothing_is_negative_on_the_seam(tested: &Tested) {
    let black = [0.0; 3];
    let colours = HairDesc {
        i_r: [0.0, 0.0, 1.0],
        i_tt: black,
        i_trt: [1.0, 1.0, 0.0],
        ..widths(0.3)
    };
    let bsdf = |wo| {
        material(
            tested,
            &HairDesc {
                phi_g: 3.0,
                gamma_g: 0.35,
                ..colours
            },
        )
        .prepare(wo)
    };
    let mut seen = 0;
    for (y, z) in [
        (1.0, 1.0),
        (-1.0, 1.0),
        (1.0, -1.0),
        (-1.0, -1.0),
        (0.6, 0.8),
        (1.0, 0.0),
        (0.3, -0.7),
    ] {
        for x in [0.0, 0.4, -2.0] {
            let bsdf = bsdf(Vec3::new(x, y, z).normalize());
            for xi_lobe in (0..32_u8).map(|i| f32::from(i) / 32.0) {
                for (xi_theta, xi_phi) in [0.02, 0.3, 0.5, 0.81]
                    .into_iter()
                    .flat_map(|a| [0.0, 0.5, LAST].map(|b| (a, b)))
                {
                    for sample in samples(&bsdf, [xi_lobe, xi_theta, xi_phi])
                        .into_iter()
                        .flatten()
                    {
                        assert_sound(&sample, "on the seam");
                        seen += 1;
                    }
                }
            }
        }
    }
    assert!(seen > 1000, "hardly any sample was kept: {seen}");
}

pub fn the_axis_scatters_nothing(tested: &Tested) {
    for desc in [widths(MIN_WIDTH), widths(0.1), widths(MAX_WIDTH)] {
        for wo in [Vec3::Y, Vec3::X, -Vec3::X, Vec3::ZERO] {
            let bsdf = material(tested, &desc).prepare(wo);
            let beside = 0.99 * GRAZING;
            let axis = [
                Vec3::X,
                -Vec3::X,
                Vec3::new(1.0, beside, 0.0),
                Vec3::new(-1.0, 0.0, -beside),
                Vec3::ZERO,
            ];
            for wi in axis {
                for level in Level::available() {
                    let eight = bsdf.with_level(level).eval_pdf8(&packet(&[wi])).lane(2);
                    for e in [bsdf.eval_pdf(wi), eight] {
                        assert_eq!(
                            (e.value, e.pdf),
                            ([0.0; 3], 0.0),
                            "{level} wi {wi:?} wo {wo:?}"
                        );
                    }
                }
                let lobes = bsdf.lobes(wi);
                assert!(
                    lobes.0.iter().all(|l| l.value == 0.0 && l.pdf == 0.0),
                    "lobes at wi {wi:?} wo {wo:?}"
                );
            }
            let near = bsdf.eval_pdf(Vec3::new(0.0, 1.0, 0.0));
            assert!(
                f64::from(near.pdf) > tested.pdf_floor || near.value[0] <= 1e-20,
                "off the axis: {near:?}"
            );
        }
    }
}

pub fn a_direction_just_off_the_axis_has_a_density(tested: &Tested) {
    let bsdf = material(tested, &widths(1.0)).prepare(Vec3::Y);
    let off = 1.01 * GRAZING;
    let e = bsdf.eval_pdf(Vec3::new(1.0, off, 0.0));
    assert!(e.pdf > 0.0 && e.value[0] > 0.0, "at cos theta {off}: {e:?}");
}

pub fn vectors_that_are_no_direction_give_zero(tested: &Tested) {
    let bsdf = material(tested, HairParams::bright().desc()).prepare(Vec3::new(0.6, 0.8, 0.0));
    let odd = [
        Vec3::new(2.01, 0.1, 0.0),
        Vec3::new(0.0, -2.5, 0.0),
        Vec3::new(0.0, 2e30, 1e30),
        Vec3::splat(f32::MAX),
        Vec3::new(0.0, f32::INFINITY, 0.0),
        Vec3::new(0.0, f32::NAN, 0.0),
        Vec3::new(f32::NAN, 1.0, 0.0),
        Vec3::new(0.0, 1e-40, 1e-41),
        Vec3::splat(f32::from_bits(1)),
        Vec3::ZERO,
    ];
    for wi in odd {
        for level in Level::available() {
            for e in [
                bsdf.eval_pdf(wi),
                bsdf.with_level(level).eval_pdf8(&packet(&[wi])).lane(7),
            ] {
                assert_eq!((e.value, e.pdf), ([0.0; 3], 0.0), "{level} {wi:?}");
            }
        }
    }
}

pub fn the_seam_is_no_edge(tested: &Tested) {
    // At phi = pi, TT peaks, R and TRT-g vanish, and both sides are one.
    for (y, z) in [(1.0, 0.0), (0.0, 1.0), (0.6, -0.8)] {
        let wo = Vec3::new(0.0, y, z);
        let bsdf = material(tested, HairParams::bright().desc()).prepare(wo);
        let on = bsdf.lobes(-wo);
        assert!(
            on[Lobe::R].value.abs() < 1e-7 && on[Lobe::TRT].pdf.abs() < 1e-7,
            "R and TRT-g on the seam: {on:?}"
        );
        assert!(on[Lobe::TT].value > 0.2, "TT on the seam: {on:?}");
        let side = |s: f32| {
            let turned = Vec3::new(0.0, -y + s * z, -z - s * y);
            bsdf.eval_pdf(turned)
        };
        for s in [0.0, 1e-7, 1e-5, 1e-3] {
            let (left, right) = (side(s), side(-s));
            let difference = (left.pdf / right.pdf - 1.0)
                .abs()
                .max((left.value[0] / right.value[0] - 1.0).abs());
            assert!(
                difference < 2e-6,
                "the sides of the seam at {s}: {left:?} {right:?}"
            );
        }
    }
}

pub fn a_zero_wo_counts_as_the_normal_plane(tested: &Tested) {
    let material = material(tested, HairParams::bright().desc());
    let wi = Vec3::new(0.3, 0.5, 0.7).normalize();
    let zero = material.prepare(Vec3::ZERO).eval_pdf(wi);
    assert_eq!(zero, material.prepare(Vec3::Y).eval_pdf(wi), "wo of zero");
    // The length of a direction does not matter.
    for wo in [Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.28, 0.0, 0.96)] {
        let unit = material.prepare(wo).eval_pdf(wi);
        for length in [1e-20, 0.01, 3.0, 100.0, 1e20, 1e38] {
            let e = material.prepare(wo * length).eval_pdf(wi);
            let off = (e.pdf / unit.pdf - 1.0)
                .abs()
                .max((e.value[1] / unit.value[1] - 1.0).abs());
            assert!(off < 1e-5, "wo times {length}: {e:?} in place of {unit:?}");
        }
    }
}

pub fn lobes_without_energy_are_never_drawn(tested: &Tested) {
    let black = [0.0; 3];
    let base = widths(0.3);
    let cases = [
        (HairDesc { i_r: black, ..base }, [false, true, true, true]),
        (
            HairDesc {
                i_tt: black,
                ..base
            },
            [true, false, true, true],
        ),
        (
            HairDesc {
                i_trt: black,
                ..base
            },
            [true, true, false, false],
        ),
        (HairDesc { i_g: 0.0, ..base }, [true, true, true, false]),
        (
            HairDesc {
                i_r: black,
                i_trt: black,
                ..base
            },
            [false, true, false, false],
        ),
        (
            HairDesc {
                i_tt: black,
                i_trt: black,
                ..base
            },
            [true, false, false, false],
        ),
        (
            HairDesc {
                i_r: black,
                i_tt: black,
                i_g: 0.0,
                ..base
            },
            [false, false, true, false],
        ),
    ];
    for (desc, lit) in cases {
        let bsdf = material(tested, &desc).prepare(Vec3::new(0.28, 0.96, 0.0));
        let mut seen = [false; 4];
        let mut draws = Draws(41);
        let mut take = |sample: Option<Sample>| {
            let Some(sample) = sample else { return };
            assert!(
                lit[sample.lobe.index()],
                "{:?} has no energy: {desc:?}",
                sample.lobe
            );
            seen[sample.lobe.index()] = true;
        };
        for _ in 0..100_000 / 8 {
            let eight = bsdf
                .with_level(Level::detect())
                .sample8(&lanes_of(&core::array::from_fn(|_| draws.xi3())));
            (0..8).for_each(|lane| take(eight.lane(lane)));
        }
        for xi in [0.0, f32::from_bits(1), f32::EPSILON / 2.0, LAST, 1.0] {
            samples(&bsdf, [xi, 0.4, 0.4])
                .into_iter()
                .for_each(&mut take);
        }
        assert_eq!(seen, lit, "lobes seen in 10^5 draws of {desc:?}");
    }
}

pub fn black_hair_scatters_and_samples_nothing(tested: &Tested) {
    let black = [0.0; 3];
    let desc = HairDesc {
        i_r: black,
        i_tt: black,
        i_trt: black,
        ..*HairParams::bright().desc()
    };
    let material = material(tested, &desc);
    let bsdf = material.prepare(Vec3::Y);
    for wi in [Vec3::Y, -Vec3::Y, Vec3::new(0.6, 0.0, 0.8)] {
        let e = bsdf.eval_pdf(wi);
        assert_eq!((e.value, e.pdf), ([0.0; 3], 0.0), "wi {wi:?}");
    }
    for xi in ENDS {
        for sample in samples(&bsdf, [xi, 0.3, 0.6]) {
            assert_eq!(sample, None, "xi {xi}");
        }
    }
    let eight = bsdf
        .with_level(Level::detect())
        .sample8(&lanes_of(&[[0.1, 0.2, 0.3]; 8]));
    assert_eq!(eight.live(), 0, "live lanes");
    assert_eq!(eight.slot.to_array(), [-1.0; 8], "slots");
    assert_eq!(bsdf.albedo().0, [[0.0; 3]; Lobe::COUNT], "albedo");
    assert_eq!(material.conserving_scale(), 1.0, "scale");
}

pub fn grazing_samples_are_discarded(tested: &Tested) {
    // A lobe wider than the sphere, drawn at the end of its range: theta_i is -pi/2.
    for wo in [Vec3::Y, Vec3::new(0.8, 0.6, 0.0)] {
        let bsdf = material(tested, &widths(MAX_WIDTH)).prepare(wo);
        for sample in samples(&bsdf, [0.1, 0.0, 0.3]) {
            assert_eq!(sample, None, "theta_i of -pi/2 was kept");
        }
        let eight = bsdf
            .with_level(Level::detect())
            .sample8(&lanes_of(&[[0.1, 0.0, 0.3]; 8]));
        assert_eq!(
            (eight.live(), eight.slot.to_array()),
            (0, [-1.0; 8]),
            "a discarded lane"
        );
        assert_eq!(
            (eight.pdf.to_array(), eight.weight[0].to_array()),
            ([0.0; 8], [0.0; 8]),
            "a discarded lane"
        );
        for sample in samples(&bsdf, [0.1, 0.001, 0.3]) {
            assert!(sample.is_some(), "a sample off the axis was discarded");
        }
    }
}

/// Products of tiny components once left the range of a float, so that every result was the largest float.
pub fn an_azimuth_next_to_nothing_is_still_an_azimuth(tested: &Tested) {
    let bsdf = material(tested, HairParams::bright().desc()).prepare(Vec3::new(1.0, 1e-15, 0.0));
    let reference =
        material(tested, HairParams::bright().desc()).prepare(Vec3::new(1.0, 1e-6, 0.0));
    for wi in [
        Vec3::new(1.0, 2e-5, 0.0),
        Vec3::new(0.6, 0.8, 0.0),
        Vec3::new(-0.6, 0.0, 0.8),
    ] {
        let (got, want) = (bsdf.eval_pdf(wi), reference.eval_pdf(wi));
        assert!(
            (got.pdf / want.pdf - 1.0).abs() < 1e-4,
            "{wi}: {got:?} against {want:?}"
        );
        for (got, want) in got.value.iter().zip(want.value) {
            assert!((got / want - 1.0).abs() < 0.2, "{wi}: {got} against {want}");
        }
    }
}

/// Squares of tiny components have few digits left if they are denormals.
pub fn a_direction_next_to_the_axis_is_still_a_direction(tested: &Tested) {
    for off in [
        1e-15,
        1e-18,
        1e-19,
        1e-20,
        1e-21,
        3e-22,
        3e-23,
        1e-38,
        f32::from_bits(1),
    ] {
        for wo in [
            Vec3::new(1.0, off, 0.0),
            Vec3::new(-1.0, -off, off),
            Vec3::new(1e3, 0.0, 1e3 * off),
        ] {
            let bsdf = material(tested, &widths(0.3)).prepare(wo);
            for xi in ENDS.iter().flat_map(|a| {
                [
                    [*a, 0.5, 0.3],
                    [0.9, *a, 0.6],
                    [0.1, 0.4, *a],
                    [0.5, 0.4, *a],
                ]
            }) {
                for sample in samples(&bsdf, xi).into_iter().flatten() {
                    assert_sound(&sample, &format!("xi {xi:?} wo {wo:?}"));
                }
            }
        }
    }
}

/// The strength of the glints and their colour may each be extreme although their product is not.
pub fn absurd_glints_of_a_faint_colour_do_not_overflow(tested: &Tested) {
    let usual = HairDesc {
        i_g: 2.0,
        i_trt: [0.15; 3],
        phi_g: PI,
        ..*HairParams::bright().desc()
    };
    let absurd = HairDesc {
        i_g: 3e37,
        i_trt: [1e-38; 3],
        ..usual
    };
    let [usual, absurd] = [usual, absurd].map(|desc| material(tested, &desc).prepare(Vec3::Y));
    let wi = Vec3::new(0.1, -0.99, -0.05).normalize();
    let only = LobeMask::of(&[Lobe::GLINT]);
    let (usual, absurd) = (
        usual.with_lobes(only).eval(wi),
        absurd.with_lobes(only).eval(wi),
    );
    for (usual, absurd) in usual.iter().zip(absurd) {
        assert!(
            (absurd / usual - 1.0).abs() < 1e-4,
            "{absurd} against {usual}"
        );
    }
}
