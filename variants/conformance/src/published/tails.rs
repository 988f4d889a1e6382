//! Tests of samples far from the centres of their lobes, at the ends of the uniform numbers: they report value and density of the
//! direction they return.

use super::Tested;
use super::edge::{ENDS, material, samples};
use super::handles::Material;
use super::support::{DEG, angles, direction, double, lanes_of, narrow, oracle, widths};
use crate::comparison::{LargestError, relative};
use crate::environment::{MODES, with_mode};
use crate::probe::LAST;
use crate::size::{cases, is_kept};
use core::f64::consts::PI;
use glam::Vec3;
use hairis::params::HairDesc;
use hairis::simd::Level;
use hairis::{HairParams, Lobe, LobeMask};

/// Numbers next to the ends of their range, and some between.
const NUMBERS: [f32; 15] = [
    0.0,
    f32::EPSILON / 2.0,
    f32::EPSILON,
    3e-7,
    1e-6,
    1e-5,
    1e-3,
    0.137,
    0.295,
    0.5,
    0.81,
    0.999,
    0.999_99,
    0.999_999_5,
    LAST,
];

/// Returns the errors of S, density and weight of samples at these numbers, further than 1e-3 rad from the axis and from the seam. For TT
/// and the glints, it also returns the error of the density next to the seam.
fn errors(
    tested: &Tested,
    descs: &[HairDesc],
    theta_o: impl Iterator<Item = f64> + Clone,
) -> ([LargestError; 4], usize) {
    let mut worst: [LargestError; 4] = Default::default();
    let mut seen = 0;
    let materials = descs.iter().map(|desc| HairParams::new(desc).unwrap());
    for (index, params) in materials.enumerate() {
        let inclinations = theta_o.clone().enumerate();
        for (turn, theta_o) in inclinations.filter(|(turn, _)| is_kept(index + turn)) {
            let wo = direction(theta_o, 0.7 * turn as f64 - 3.0);
            let bsdf = Material::new(tested.model(), &params).prepare(wo);
            let reference = oracle(&tested.formulas, &params, 1.0, wo);
            let ends = NUMBERS.iter().flat_map(|a| NUMBERS.map(|b| [*a, b]));
            for [theta, phi] in ends {
                let xi = core::array::from_fn(|lane| [(lane as f32 + 0.5) / 8.0, theta, phi]);
                let wide = Level::available().flat_map(|level| {
                    let eight = bsdf.with_level(level).sample8(&lanes_of(&xi));
                    (0..8).map(move |lane| eight.lane(lane))
                });
                for sample in wide.chain(xi.iter().map(|xi| bsdf.sample(*xi))).flatten() {
                    let d = double(sample.wi);
                    let [theta_i, angle] = angles(wo, sample.wi);
                    if theta_i.cos() < 1e-3 {
                        continue;
                    }
                    let at = || format!("{sample:?} wo {wo:?} xi {theta} {phi} {params:?}");
                    let (value, pdf) = (reference.eval(d), reference.pdf(d));
                    // A Gaussian is cut where it is 1e-35.
                    if value[0] < 1e-20 {
                        continue;
                    }
                    seen += 1;
                    let error = relative(sample.pdf, pdf, tested.pdf_floor);
                    if PI - angle < 1e-3 {
                        // R and TRT-g vanish there, and only the rounding of the direction is left of them.
                        if sample.lobe == Lobe::TT || sample.lobe == Lobe::GLINT {
                            worst[3].see(error, at);
                        }
                        continue;
                    }
                    worst[1].see(error, at);
                    for ((got, weight), want) in
                        sample.value.into_iter().zip(sample.weight).zip(value)
                    {
                        worst[0].see(relative(got, want, tested.pdf_floor), at);
                        worst[2].see(relative(weight, want * theta_i.cos() / pdf, 1e-20), at);
                    }
                }
            }
        }
    }
    (worst, seen)
}

/// Returns materials whose widths are a degree or a little more.
fn degrees() -> Vec<HairDesc> {
    let default = *HairParams::bright().desc();
    let mut all = Vec::new();
    for base in [
        widths(narrow(DEG)),
        widths(0.019_24),
        widths(0.05),
        HairDesc {
            beta: [0.019_24, default.beta[1], default.beta[2]],
            ..default
        },
    ] {
        all.extend([
            base,
            HairDesc {
                alpha: [0.2, -0.15, -0.35],
                phi_g: 0.7,
                ..base
            },
        ]);
    }
    all
}

pub fn samples_in_the_tails_report_their_own_direction(tested: &Tested) {
    let (worst, seen) = errors(
        tested,
        &degrees(),
        (0..40).map(|i| 0.077 * f64::from(i) - 1.5),
    );
    assert!(
        seen > cases(50_000).min(50_000),
        "hardly any sample: {seen}"
    );
    for ((worst, bound), what) in worst.iter().zip(tested.rows.tail_sample).zip([
        "S",
        "pdf",
        "weight",
        "pdf next to the seam",
    ]) {
        worst.check(&format!("{what} of a sample in the tails"), bound);
    }
}

/// No lobe has its centre on the sphere, so that all samples are of tails, up to nine widths out.
pub fn samples_of_lobes_off_the_sphere_report_their_own_direction(tested: &Tested) {
    let off: Vec<HairDesc> = degrees()
        .into_iter()
        .flat_map(|base| {
            [0.1, 0.15, 0.2].map(|by| HairDesc {
                alpha: [by; 3],
                ..base
            })
        })
        .collect();
    let (worst, seen) = errors(tested, &off, (0..32).map(|i| -1.56 + 0.006 * f64::from(i)));
    assert!(
        seen > cases(10_000).min(10_000),
        "hardly any sample: {seen}"
    );
    for ((worst, bound), what) in worst.iter().zip(tested.rows.off_sphere_sample).zip([
        "S",
        "pdf",
        "weight",
        "pdf next to the seam",
    ]) {
        worst.check(
            &format!("{what} of a sample of a lobe off the sphere"),
            bound,
        );
    }
}

/// Rounded up, the integral of an azimuth whose bell ends at its centre once came to 0 at the far end, thirteen widths out.
pub fn ends_of_an_azimuth_are_sound_however_results_are_rounded(tested: &Tested) {
    let widths_kept = (1..=60_u8).filter(|i| is_kept(usize::from(*i)));
    for width in widths_kept.map(|i| 0.01 * f32::from(i)) {
        let desc = HairDesc {
            phi_g: 0.0,
            ..widths(width)
        };
        for mode in MODES {
            let bsdf = with_mode(mode, || {
                material(tested, &desc).prepare(Vec3::new(0.6, 0.8, 0.0))
            });
            for lobe in [Lobe::TT, Lobe::GLINT] {
                let alone = bsdf.with_lobes(LobeMask::of(&[lobe]));
                for xi in ENDS.map(|xi| [0.5, 0.5, xi]) {
                    for sample in with_mode(mode, || samples(&alone, xi)) {
                        let at = format!("{lobe:?} of width {width}, mode {mode:#x}, xi {xi:?}");
                        let sample = sample.unwrap_or_else(|| panic!("no sample: {at}"));
                        assert!((sample.wi.length() - 1.0).abs() < 1e-5, "{at}: {sample:?}");
                    }
                }
            }
        }
    }
}
