//! Tests that one lane rounds every product, and that levels that fuse are close to it.

use super::Tested;
use super::support::{Draws, Kind, Point, double, for_each_point, packet};
use super::values::FLOOR;
use crate::comparison::{LargestError, over};
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
    let mut worst: [LargestError; 2] = Default::default();
    for_each_point(tested, Kind::Wide, |material, reference, point| {
        let bsdf = material.prepare(point.wo);
        for eight in tame(point).chunks(8) {
            for level in Level::available() {
                let evals = bsdf.with_level(level).eval_pdf8(&packet(eight));
                for (lane, wi) in eight.iter().enumerate() {
                    let at = || format!("{level} wo {:?} wi {wi:?}", point.wo);
                    let (allowed, allowed_pdf) = reference.error_bound(double(*wi)).unwrap();
                    let (a, b) = (bsdf.eval_pdf(*wi), evals.lane(lane));
                    let [s, pdf] = [a.value[0], a.pdf].map(f64::from);
                    worst[0].see(over(b.value[0], s, allowed[0], FLOOR), at);
                    worst[1].see(over(b.pdf, pdf, allowed_pdf, tested.pdf_floor), at);
                }
            }
        }
    });
    // Either of the two numbers may be off by the bound.
    worst[0].check("S of a level against one lane, over its bound", 2.0);
    worst[1].check("pdf of a level against one lane, over its bound", 2.0);
}
