//! No fireflies: every weight is below its closed-form bound, and that is a small multiple of the mean over all everyday hair.

use super::Tested;
use super::support::{Draws, direction, double, lanes_of, narrow, parameters};
use crate::comparison::LargestError;
use core::f64::consts::PI;
use hairis::params::HairDesc;
use hairis::{HairParams, Lobe, LobeMask};
use hairis_reference::{MatchedReference, Reference};

/// Hair with `beta_r` from 0.5 to 60 degrees and all else as wide as it is found, seen from up to 89.9 degrees.
fn hair(draws: &mut Draws) -> (HairParams, f64) {
    let degrees = draws.scale(0.5, 60.0);
    let beta = [1.0, 0.5, 2.0].map(|k| narrow((k * degrees).to_radians()));
    let mut angle = |lo: f64, hi: f64| narrow(draws.scale(lo, hi).to_radians());
    let (gamma_tt, gamma_g, phi_g) = (angle(1.0, 60.0), angle(1.0, 40.0), angle(10.0, 80.0));
    let i_g = narrow(draws.scale(0.1, 10.0));
    let desc = HairDesc {
        beta,
        gamma_tt,
        gamma_g,
        phi_g,
        i_g,
        ..*HairParams::bright().desc()
    };
    let theta_o = draws.sign() * 89.9_f64.min(draws.between(0.0, 100.0));
    (HairParams::new(&desc).unwrap(), theta_o.to_radians())
}

/// The largest weights over their bound, and the largest bounds over the mean.
fn scan(tested: &Tested, bands: usize, worst: &mut [LargestError; 2]) {
    let mut draws = Draws(81);
    for round in 0..16_000 {
        let (params, theta_o) = hair(&mut draws);
        let wo = direction(theta_o, draws.between(-PI, PI));
        let mask = if round % 4 == 0 {
            LobeMask::of(&[Lobe::ALL[draws.below(4)]])
        } else {
            LobeMask::ALL
        };
        let bsdf = tested.sampler(Some(bands)).prepare(&params, wo, mask);
        let reference = MatchedReference::prepare(
            &parameters(&params, 1.0),
            tested.formulas.shape,
            double(wo),
            bands,
        );
        let limit = reference.weight_bound(mask).unwrap();
        if mask == LobeMask::ALL {
            let mean: f64 = bsdf
                .albedo()
                .0
                .iter()
                .flatten()
                .map(|x| f64::from(*x) / 3.0)
                .sum();
            worst[1].see(limit / mean, || {
                format!("{bands} theta_o {theta_o} {params:?}")
            });
        }
        for _ in 0..4 {
            let eight = bsdf.sample8(&lanes_of(&core::array::from_fn(|_| draws.xi3())));
            for s in (0..8).filter_map(|lane| eight.lane(lane)) {
                let weight = s.weight.iter().map(|x| f64::from(*x) / 3.0).sum::<f64>();
                worst[0].see(weight / limit, || {
                    format!("{bands} theta_o {theta_o} {mask:?} {s:?} {params:?}")
                });
            }
        }
    }
}

pub fn weights_are_below_their_bound_and_close_to_the_mean(tested: &Tested) {
    let mut worst: [[LargestError; 2]; 3] = Default::default();
    for (worst, bands) in worst.iter_mut().zip([5, 9, 25]) {
        scan(tested, bands, worst);
    }
    for ((bands, limit), [bound, mean]) in
        [5, 9, 25].into_iter().zip(tested.rows.weight).zip(&worst)
    {
        bound.check(
            &format!("{bands} bands: largest weight over its bound"),
            1.0 + 1e-4,
        );
        mean.check(
            &format!("{bands} bands: bound on weights over the mean"),
            limit,
        );
        let [.., [stated, _]] = tested.documented(bands);
        mean.check(&format!("{bands} bands: that bound, as documented"), stated);
    }
}
