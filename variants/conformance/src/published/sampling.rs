//! Tests of samples against the reference: cdf of the drawn angle, value, density and weight at the drawn direction.

use super::Tested;
use super::support::{Draws, Kind, Point, angles, double, for_each_point, lanes_of};
use super::values::FLOOR;
use crate::comparison::{LargestError, over};
use crate::probe::LAST;
use crate::size::cases;
use core::f64::consts::PI;
use hairis::simd::Level;
use hairis::{Lobe, LobeMask, Sample};
use hairis_reference::Reference;

/// Draws eight triples of uniform numbers, with the ends of their range in between.
fn draw8(draws: &mut Draws) -> [[f32; 3]; 8] {
    let mut one = || match draws.below(16) {
        0 => 0.0,
        1 => LAST,
        2 => 0.5,
        _ => draws.xi(),
    };
    core::array::from_fn(|_| [one(), one(), one()])
}

/// Returns the distance on the circle of circumference 1, where a cdf of an azimuth may start anywhere.
fn around(a: f64, b: f64) -> f64 {
    let d = (a - b).abs();
    d.min(1.0 - d)
}

/// Returns `phi_o - phi_i` in (-pi, pi].
fn phi(point: &Point, sample: &Sample) -> f64 {
    let ([_, v_o, w_o], [_, v, w]) = (double(point.wo), double(sample.wi));
    (v * w_o - w * v_o).atan2(v * v_o + w * w_o)
}

/// Takes the errors of a sample at the direction it returned into account: S, density, weight, and the length of the direction.
fn see(
    tested: &Tested,
    worst: &mut [LargestError; 4],
    reference: &dyn Reference<f64>,
    point: &Point,
    sample: &Sample,
) {
    let at = || format!("{sample:?} wo {:?} {:?}", point.wo, point.params);
    let d = double(sample.wi);
    worst[3].see(
        (d.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0).abs(),
        at,
    );
    let [theta, phi] = angles(point.wo, sample.wi);
    if theta.cos() < 1e-3 || (phi - 0.5 * PI).abs() < 1e-6 {
        return;
    }
    let (value, pdf) = (reference.eval(d), reference.pdf(d));
    let (allowed, allowed_pdf) = reference.error_bound(d).unwrap();
    // On the seam R and TRT-g vanish, and only the rounding of the direction is left of them.
    let seam = PI - phi < 1e-3;
    if !(seam && tested.formulas.bands.is_some()) {
        worst[1].see(over(sample.pdf, pdf, allowed_pdf, tested.pdf_floor), at);
    }
    if seam {
        return;
    }
    for (c, want) in value.into_iter().enumerate() {
        worst[0].see(over(sample.value[c], want, allowed[c], FLOOR), at);
        let weight = want * theta.cos() / pdf;
        let both = allowed[c] / want + allowed_pdf / pdf;
        worst[2].see(over(sample.weight[c], weight, weight * both, FLOOR), at);
    }
}

fn check(tested: &Tested, kind: Kind, per_point: usize, cdf: [f64; 2]) {
    let mut worst: [LargestError; 4] = Default::default();
    let (mut theta, mut azimuth) = (LargestError::default(), LargestError::default());
    for_each_point(tested, kind, |material, reference, point| {
        let bsdf = material.prepare(point.wo);
        let mut draws = Draws(point.seed);
        for _ in 0..per_point {
            let xi = draw8(&mut draws);
            let wide: Vec<_> = Level::available()
                .map(|level| bsdf.with_level(level).sample8(&lanes_of(&xi)))
                .collect();
            for (lane, xi) in xi.iter().enumerate() {
                let all = wide
                    .iter()
                    .map(|eight| eight.lane(lane))
                    .chain([bsdf.sample(*xi)]);
                for sample in all.flatten() {
                    see(tested, &mut worst, reference, point, &sample);
                    let chosen = reference.sample(xi.map(f64::from)).lobe;
                    let mut edge = 0.0;
                    let edges = reference.probabilities().0.map(|p| {
                        edge += p;
                        (edge - f64::from(xi[0])).abs()
                    });
                    // Within a rounding of the next lobe, or so close to the axis that either may be discarded.
                    let grazing = chosen.is_none() && angles(point.wo, sample.wi)[0].cos() < 1e-3;
                    // At the very end of a Gaussian, either may have no density left.
                    let end = chosen.is_none()
                        && tested.formulas.bands.is_some()
                        && (xi[1] == 0.0 || xi[1] == LAST);
                    let near = grazing || end || edges.iter().any(|d| *d < 1e-6);
                    assert!(
                        near || chosen == Some(sample.lobe),
                        "{chosen:?} {sample:?} xi {xi:?} {point:?}"
                    );
                }
            }
            // The cdf of the angles that each lobe draws is the number they were drawn with.
            for lobe in Lobe::FOUR {
                let alone = bsdf.with_lobes(LobeMask::of(&[lobe]));
                let wide: Vec<_> = Level::available()
                    .map(|level| alone.with_level(level).sample8(&lanes_of(&xi)))
                    .collect();
                for (lane, xi) in xi.iter().enumerate() {
                    let all = wide
                        .iter()
                        .map(|eight| eight.lane(lane))
                        .chain([alone.sample(*xi)]);
                    for sample in all.flatten() {
                        let at = || {
                            format!(
                                "{lobe:?} xi {xi:?} {sample:?} wo {:?} {:?}",
                                point.wo, point.params
                            )
                        };
                        assert_eq!(sample.lobe, lobe, "only this lobe may be drawn");
                        let theta_i = angles(point.wo, sample.wi)[0];
                        let cdf = reference.cdf(lobe, theta_i, phi(point, &sample));
                        let [got_theta, got_phi] = cdf.unwrap();
                        theta.see((got_theta - f64::from(xi[1])).abs(), at);
                        azimuth.see(around(got_phi, f64::from(xi[2])), at);
                    }
                }
            }
        }
    });
    for (worst, name) in worst.iter().zip(["S", "pdf", "weight"]) {
        worst.check(&format!("{kind:?} {name} of a sample over its bound"), 1.0);
    }
    worst[3].check(
        &format!("{kind:?} length of a sample"),
        tested.rows.sample_length,
    );
    theta.check(&format!("{kind:?} cdf of theta"), cdf[0]);
    azimuth.check(&format!("{kind:?} cdf of phi"), cdf[1]);
}

pub fn samples_on_the_grid(tested: &Tested) {
    check(tested, Kind::Grid, 3, tested.rows.grid_cdf);
}

pub fn samples_of_narrow_lobes(tested: &Tested) {
    check(tested, Kind::Narrow, cases(256), tested.rows.narrow_cdf);
}

pub fn samples_of_wide_lobes(tested: &Tested) {
    check(tested, Kind::Wide, cases(256), tested.rows.wide_cdf);
}
