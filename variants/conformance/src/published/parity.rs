//! Tests that one lane rounds every product, and that levels that fuse are close to it.

use super::Tested;
use super::support::{Draws, Kind, Point, for_each_point, lanes_of, packet};
use crate::comparison::{LargestError, relative};
use crate::size::cases;
use glam::Vec3;
use hairis::Hit;
use hairis::simd::Level;

/// One lane does not fuse even in builds whose every level fuses.
pub fn one_lane_never_fuses(tested: &Tested) {
    let model = tested.model();
    let mut draws = Draws(16);
    for _ in 0..cases(2000) {
        let (params, wo) = (draws.params(1e3), draws.direction());
        let hit = Hit::from(wo);
        let [one, lane] = model.constants(&params, hit);
        assert_eq!(one, lane, "{hit:?} {params:?}");
    }
}

/// Returns directions where a lane is well conditioned: off the seam and off the axis.
fn tame(point: &Point) -> Vec<Vec3> {
    let mut all = point.directions(cases(256));
    all.retain(|wi| {
        let [theta, phi] = super::support::angles(point.wo, *wi);
        theta.cos() > 0.05 && phi < 3.1
    });
    all.truncate(all.len() & !7);
    all
}

pub fn levels_agree_with_one_lane(tested: &Tested) {
    let mut worst: [LargestError; 3] = Default::default();
    for_each_point(tested, Kind::Wide, |material, _, point| {
        let bsdf = material.prepare(point.wo);
        let mut draws = Draws(point.seed + 7);
        for eight in tame(point).chunks(8) {
            let xi: [_; 8] = core::array::from_fn(|_| draws.xi3());
            for level in Level::available() {
                let (evals, samples) = (
                    bsdf.with_level(level).eval_pdf8(&packet(eight)),
                    bsdf.with_level(level).sample8(&lanes_of(&xi)),
                );
                for (lane, wi) in eight.iter().enumerate() {
                    let at = || format!("{level} wo {:?} wi {wi:?} xi {:?}", point.wo, xi[lane]);
                    let (a, b) = (bsdf.eval_pdf(*wi), evals.lane(lane));
                    worst[0].see(relative(b.value[0], f64::from(a.value[0]), 1e-20), at);
                    worst[1].see(relative(b.pdf, f64::from(a.pdf), 0.0), at);
                    let (Some(a), Some(b)) = (bsdf.sample(xi[lane]), samples.lane(lane)) else {
                        continue;
                    };
                    assert_eq!(a.lobe, b.lobe, "{}", at());
                    worst[2].see(f64::from((a.wi - b.wi).length()), at);
                }
            }
        }
    });
    worst[0].check("S of a level against one lane", tested.rows.levels[0]);
    worst[1].check("pdf of a level against one lane", tested.rows.levels[1]);
    worst[2].check(
        "direction of a level against one lane",
        tested.rows.levels[2],
    );
}
