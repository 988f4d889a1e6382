//! Choice of lobes by channel: its gain on coloured hair, and exactness of its values and densities.

use crate::hair::Bands;
use crate::support::{Draws, direction, double, lanes_of, oracle};
use core::f64::consts::PI;
use hairis::model::Model;
use hairis::params::HairDesc;
use hairis::{Gaussian, HairParams, LobeMask, Matched, Material, PerLobe};
use hairis_conformance::published::formulas;

/// The model.
type Tested = Matched<Gaussian, 9, true>;

/// Red hair: what it transmits has next to no blue, and what it reflects has no colour.
fn red() -> HairParams {
    HairParams::new(&HairDesc {
        i_r: [0.05; 3],
        i_tt: [0.9, 0.35, 0.08],
        i_trt: [0.6, 0.12, 0.01],
        ..*HairParams::bright().desc()
    })
    .unwrap()
}

/// Relative variance of one sample's weight in each channel, and of their mean; means of the channels and of the directional
/// albedo. Numbers are drawn one in each cell of a lattice.
fn measure<M: Model<Params = HairParams>>(
    model: M,
    params: &HairParams,
    theta_o: f64,
) -> ([f64; 4], [f64; 3], [f64; 3]) {
    const CELLS: usize = 64;
    let bsdf = Material::new(&model, params).prepare(direction(theta_o, 0.3));
    let mut draws = Draws(17);
    let (mut first, mut second) = ([0.0; 4], [0.0; 4]);
    for cell in 0..CELLS * CELLS * CELLS / 8 {
        let xi: [[f32; 3]; 8] = core::array::from_fn(|lane| {
            let i = 8 * cell + lane;
            [i / (CELLS * CELLS), i / CELLS % CELLS, i % CELLS]
                .map(|at| (at as f32 + draws.xi()) / CELLS as f32)
        });
        let sample = bsdf.sample8(&lanes_of(&xi));
        for lane in 0..8 {
            let w = sample
                .lane(lane)
                .map_or([0.0; 3], |s| s.weight)
                .map(f64::from);
            for (i, x) in [w[0], w[1], w[2], (w[0] + w[1] + w[2]) / 3.0]
                .into_iter()
                .enumerate()
            {
                first[i] += x;
                second[i] += x * x;
            }
        }
    }
    let n = (CELLS * CELLS * CELLS) as f64;
    let PerLobe(lobes) = bsdf.albedo();
    let albedo = core::array::from_fn(|c| lobes.iter().map(|lobe| f64::from(lobe[c])).sum());
    let v = core::array::from_fn(|i| n * second[i] / (first[i] * first[i]) - 1.0);
    (v, core::array::from_fn(|c| first[c] / n), albedo)
}

#[test]
fn coloured_hair_gains_over_its_channels() {
    for degrees in [0.0_f64, 30.0, 60.0, 80.0] {
        let by_mean: Matched<Gaussian> = Matched(Gaussian);
        let by_channel: Tested = Matched(Gaussian);
        let ([red_m, green_m, blue_m, mean_m], ..) = measure(by_mean, &red(), degrees.to_radians());
        let ([r, g, b, mean], got, albedo) = measure(by_channel, &red(), degrees.to_radians());
        println!(
            "{degrees}: by mean {red_m:.4} {green_m:.4} {blue_m:.4} {mean_m:.4}, by channel {r:.4} {g:.4} {b:.4} {mean:.4}"
        );
        for c in 0..3 {
            assert!(
                (got[c] / albedo[c] - 1.0).abs() < 2e-3,
                "channel {c}: mean weight {} of {}",
                got[c],
                albedo[c]
            );
        }
        assert!(
            1.3 * (r + g + b) < red_m + green_m + blue_m,
            "the channels together"
        );
        assert!(3.0 * b < blue_m, "the weakest channel");
        assert!(
            mean < 12.0 * mean_m && mean < 0.15,
            "what it costs the mean"
        );
    }
}

#[test]
fn weights_are_below_their_bound() {
    let mut draws = Draws(29);
    let model: Tested = Matched(Gaussian);
    let mut closest = 0.0_f64;
    for round in 0..400 {
        let params = draws.params(10.0);
        let wo = direction(draws.between(-1.5, 1.5), draws.between(-PI, PI));
        let mask = if round % 3 == 0 {
            LobeMask::of(&[hairis::Lobe::FOUR[draws.below(4)]])
        } else {
            LobeMask::ALL
        };
        let reference = oracle(&formulas::<Bands<9, true>>(), &params, 1.0, wo);
        let limit = reference.weight_bound(mask).unwrap();
        let bsdf = Material::new(&model, &params).prepare(wo).with_lobes(mask);
        for _ in 0..500 {
            if let Some(s) = bsdf.sample(draws.xi3()) {
                let mean = s.weight.iter().map(|x| f64::from(*x)).sum::<f64>() / 3.0;
                closest = closest.max(mean / limit);
                assert!(
                    mean <= limit * (1.0 + 1e-4),
                    "{mean} above {limit} at {s:?} wo {:?} {params:?}",
                    double(wo)
                );
            }
        }
    }
    assert!(closest > 0.5, "the bound is loose: {closest}");
}
