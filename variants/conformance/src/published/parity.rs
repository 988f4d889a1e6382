//! One lane against eight, position by position, and the backends against each other: bit for bit wherever both round
//! alike.

use super::Tested;
use super::handles::{Bsdf8, Material};
use super::support::{Draws, Kind, Point, for_each_point, lanes_of, materials, packet, parameters};
use crate::comparison::LargestError;
use glam::Vec3;
use hairis::model::SampleLanes;
use hairis::simd::{Level, f32x8};
use hairis::{Eval, Hit, Lobe, PerLobe, Sample8};

fn eval_bits(e: Eval) -> [u32; 4] {
    [e.value[0], e.value[1], e.value[2], e.pdf].map(f32::to_bits)
}

/// Every number of one lane of a packet of samples.
fn sample_lane(s: &Sample8, lane: usize) -> [f32; 11] {
    let SampleLanes {
        wi,
        value: [r, g, b],
        pdf,
        weight: [wr, wg, wb],
        slot,
    } = *s;
    [wi.x, wi.y, wi.z, r, g, b, pdf, wr, wg, wb, slot].map(|x: f32x8| x.as_array()[lane])
}

fn sample_bits(s: &Sample8, lane: usize) -> [u32; 11] {
    sample_lane(s, lane).map(f32::to_bits)
}

/// The levels that round as one lane does.
fn unfused() -> impl Iterator<Item = Level> {
    Level::available().filter(|level| !level.fuses())
}

/// Eight different hits and materials, and eight directions and triples of numbers.
struct MixedPacket<'a> {
    material: [Material<'a>; 8],
    wo: [Vec3; 8],
    wi: [Vec3; 8],
    xi: [[f32; 3]; 8],
}

fn mixed<'a>(tested: &'a Tested, draws: &mut Draws) -> MixedPacket<'a> {
    let (model, factor) = tested.first();
    let params: [_; 8] = core::array::from_fn(|_| draws.params(1e3));
    let wo: [_; 8] = core::array::from_fn(|lane| {
        draws
            .near_lobes(&parameters(&params[lane], factor), 0.0, 0.0)
            .normalize()
    });
    let wi = core::array::from_fn(|lane| {
        let (theta_o, phi_o) = (
            f64::from(wo[lane].x.asin()),
            f64::from(wo[lane].z.atan2(wo[lane].y)),
        );
        draws.near_lobes(&parameters(&params[lane], factor), theta_o, phi_o)
    });
    let xi = core::array::from_fn(|_| draws.xi3());
    MixedPacket {
        material: params.map(|p| Material::new(model, &p)),
        wo,
        wi,
        xi,
    }
}

fn bsdfs(m: &MixedPacket<'_>, level: Level) -> Bsdf8 {
    Material::prepare_packed(m.material.each_ref(), level, &packet(&m.wo))
}

pub fn every_lane_position_equals_one_lane(tested: &Tested) {
    assert!(
        Level::available().next() == Some(Level::portable()),
        "the portable level runs everywhere"
    );
    for_each_point(tested, Kind::Wide, |material, _, point| {
        let bsdf = material.prepare(point.wo);
        let mut draws = Draws(point.seed);
        for eight in point.directions(32).chunks(8) {
            let xi: [_; 8] = core::array::from_fn(|_| draws.xi3());
            for level in unfused() {
                let (evals, samples) = (
                    bsdf.with_level(level).eval_pdf8(&packet(eight)),
                    bsdf.with_level(level).sample8(&lanes_of(&xi)),
                );
                for (lane, wi) in eight.iter().enumerate() {
                    let (one, wide) = (bsdf.eval_pdf(*wi), evals.lane(lane));
                    assert_eq!(
                        eval_bits(one),
                        eval_bits(wide),
                        "{level} lane {lane} wi {wi:?}: {one:?} {wide:?}"
                    );
                    let (one, wide) = (bsdf.sample(xi[lane]), samples.lane(lane));
                    assert_eq!(one, wide, "{level} lane {lane} xi {:?}", xi[lane]);
                }
            }
        }
    });
}

pub fn eight_shading_points_equal_one_each(tested: &Tested) {
    let mut draws = Draws(11);
    for _ in 0..2000 {
        let m = mixed(tested, &mut draws);
        for level in unfused() {
            let bsdf = bsdfs(&m, level);
            let (evals, samples) = (
                bsdf.with_level(level).eval_pdf8(&packet(&m.wi)),
                bsdf.with_level(level).sample8(&lanes_of(&m.xi)),
            );
            for lane in 0..8 {
                let one = m.material[lane].prepare(m.wo[lane]);
                let at = || {
                    format!(
                        "{level} lane {lane} wo {:?} {:?}",
                        m.wo[lane], m.material[lane].params
                    )
                };
                assert_eq!(
                    eval_bits(one.eval_pdf(m.wi[lane])),
                    eval_bits(evals.lane(lane)),
                    "{}",
                    at()
                );
                assert_eq!(one.sample(m.xi[lane]), samples.lane(lane), "{}", at());
                assert_eq!(
                    format!("{one:?}"),
                    format!("{:?}", bsdf.lane(lane)),
                    "{}",
                    at()
                );
            }
        }
    }
}

/// Also in builds whose every level fuses.
pub fn one_lane_never_fuses(tested: &Tested) {
    let model = tested.model();
    let mut draws = Draws(16);
    for _ in 0..2000 {
        let (params, wo) = (draws.params(1e3), draws.direction());
        let hit = Hit::from(wo);
        let [one, lane] = model.constants(&params, hit);
        assert_eq!(one, lane, "{hit:?} {params:?}");
    }
}

pub fn one_shading_point_in_every_lane_equals_a_shared_one(tested: &Tested) {
    let model = tested.model();
    let mut draws = Draws(12);
    let random: Vec<_> = (0..200).map(|_| draws.params(10.0)).collect();
    for params in materials(Kind::Wide).into_iter().chain(random) {
        let m = mixed(tested, &mut draws);
        let material = Material::new(model, &params);
        let wo = packet(&[m.wo[0]]);
        for level in Level::available() {
            let eight = Material::prepare_packed([&material; 8], level, &wo);
            let same = material.with_level(level).prepare8(&wo);
            assert_eq!(
                format!("{eight:?}"),
                format!("{same:?}"),
                "{level}: packed and shared material"
            );
            let shared = eight.lane(3);
            let (a, b) = (
                eight.with_level(level).eval_pdf8(&packet(&m.wi)),
                shared.with_level(level).eval_pdf8(&packet(&m.wi)),
            );
            let (s, t) = (
                eight.with_level(level).sample8(&lanes_of(&m.xi)),
                shared.with_level(level).sample8(&lanes_of(&m.xi)),
            );
            for lane in 0..8 {
                assert_eq!(
                    eval_bits(a.lane(lane)),
                    eval_bits(b.lane(lane)),
                    "{level} lane {lane} {params:?}"
                );
                assert_eq!(
                    sample_bits(&s, lane),
                    sample_bits(&t, lane),
                    "{level} lane {lane} {params:?}"
                );
            }
        }
    }
}

pub fn permuted_lanes_permute_the_results(tested: &Tested) {
    let mut draws = Draws(13);
    for _ in 0..500 {
        let m = mixed(tested, &mut draws);
        let mut order = [0, 1, 2, 3, 4, 5, 6, 7];
        for last in (1..8).rev() {
            order.swap(last, draws.below(last + 1));
        }
        let p = MixedPacket {
            material: order.map(|i| m.material[i]),
            wo: order.map(|i| m.wo[i]),
            wi: order.map(|i| m.wi[i]),
            xi: order.map(|i| m.xi[i]),
        };
        for level in Level::available() {
            let (g, h) = (bsdfs(&m, level), bsdfs(&p, level));
            let (a, b) = (
                g.with_level(level).eval_pdf8(&packet(&m.wi)),
                h.with_level(level).eval_pdf8(&packet(&p.wi)),
            );
            let (s, t) = (
                g.with_level(level).sample8(&lanes_of(&m.xi)),
                h.with_level(level).sample8(&lanes_of(&p.xi)),
            );
            for (to, from) in order.into_iter().enumerate() {
                assert_eq!(
                    eval_bits(a.lane(from)),
                    eval_bits(b.lane(to)),
                    "{level}: lane {from} moved to {to}"
                );
                assert_eq!(
                    sample_bits(&s, from),
                    sample_bits(&t, to),
                    "{level}: lane {from} moved to {to}"
                );
            }
        }
    }
}

/// Directions where a lane is well conditioned: off the seam and off the axis.
fn tame(point: &Point) -> Vec<Vec3> {
    let mut all = point.directions(256);
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
                    worst[0].see(
                        crate::comparison::relative(b.value[0], f64::from(a.value[0]), 1e-20),
                        at,
                    );
                    worst[1].see(
                        crate::comparison::relative(b.pdf, f64::from(a.pdf), 0.0),
                        at,
                    );
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

/// The bits of each lane's albedos.
fn albedo_bits(albedo: &PerLobe<[f32x8; 3]>) -> [Vec<u32>; 8] {
    let all = albedo.0.as_flattened();
    core::array::from_fn(|lane| all.iter().map(|x| x.as_array()[lane].to_bits()).collect())
}

pub fn levels_that_round_alike_give_the_same_bits(tested: &Tested) {
    let levels: Vec<_> = Level::available().collect();
    let mut draws = Draws(14);
    for _ in 0..500 {
        let m = mixed(tested, &mut draws);
        for pair in levels
            .windows(2)
            .filter(|pair| pair[0].fuses() == pair[1].fuses())
        {
            let g = bsdfs(&m, pair[0]);
            let h = bsdfs(&m, pair[1]);
            assert_eq!(
                format!("{g:?}"),
                format!("{h:?}"),
                "prepared on {} and {}",
                pair[0],
                pair[1]
            );
            let albedos =
                [pair[0], pair[1]].map(|level| albedo_bits(&g.with_level(level).albedo8()));
            assert_eq!(
                albedos[0], albedos[1],
                "albedos on {} and {}",
                pair[0], pair[1]
            );
            let of = |level| {
                (
                    g.with_level(level).eval_pdf8(&packet(&m.wi)),
                    g.with_level(level).sample8(&lanes_of(&m.xi)),
                )
            };
            let ((a, s), (b, t)) = (of(pair[0]), of(pair[1]));
            for lane in 0..8 {
                assert_eq!(
                    eval_bits(a.lane(lane)),
                    eval_bits(b.lane(lane)),
                    "{} {}",
                    pair[0],
                    pair[1]
                );
                assert_eq!(
                    sample_bits(&s, lane),
                    sample_bits(&t, lane),
                    "{} {}",
                    pair[0],
                    pair[1]
                );
            }
        }
    }
}

pub fn lobes_and_albedo_agree_with_one_lane(tested: &Tested) {
    let mut draws = Draws(15);
    let mut worst = LargestError::default();
    for _ in 0..200 {
        let m = mixed(tested, &mut draws);
        let bsdf = bsdfs(&m, Level::detect());
        let (lobes, albedo) = (
            bsdf.lobes8(&packet(&m.wi)),
            bsdf.with_level(Level::detect()).albedo8(),
        );
        for level in unfused() {
            for (lane, bits) in albedo_bits(&bsdf.with_level(level).albedo8())
                .into_iter()
                .enumerate()
            {
                let one: Vec<u32> = bsdf
                    .lane(lane)
                    .albedo()
                    .0
                    .as_flattened()
                    .iter()
                    .map(|x| x.to_bits())
                    .collect();
                assert_eq!(bits, one, "albedo of lane {lane} on {level}");
            }
        }
        for lane in 0..8 {
            let one = bsdf.lane(lane);
            let (alone, alone_albedo) = (one.lobes8(&packet(&[m.wi[lane]])), one.albedo());
            for lobe in Lobe::ALL {
                let (a, b) = (lobes[lobe], alone[lobe]);
                let bits = |x: f32x8, lane: usize| x.as_array()[lane].to_bits();
                assert_eq!(
                    bits(a.value, lane),
                    bits(b.value, 0),
                    "value of {lobe:?} in lane {lane}"
                );
                assert_eq!(
                    bits(a.pdf, lane),
                    bits(b.pdf, 0),
                    "pdf of {lobe:?} in lane {lane}"
                );
                for c in 0..3 {
                    assert_eq!(
                        bits(a.color[c], lane),
                        bits(b.color[c], 0),
                        "color of {lobe:?} in lane {lane}"
                    );
                    let (wide, scalar) = (albedo[lobe][c].as_array()[lane], alone_albedo[lobe][c]);
                    // A lobe that lies off the sphere returns next to nothing, with the digits of its tail.
                    let floor = 1e-4 * f64::from(a.color[c].as_array()[lane]).max(1e-20);
                    worst.see(
                        crate::comparison::relative(wide, f64::from(scalar), floor),
                        || format!("{lobe:?}: {wide}, one lane {scalar}"),
                    );
                }
            }
        }
    }
    worst.check("albedo of eight against one", tested.rows.albedo_lanes);
}

pub fn a_hit_is_its_direction(tested: &Tested) {
    // The published model ignores the offset across the fibre.
    let model = tested.model();
    let material = Material::new(model, &hairis::HairParams::bright());
    let wo = Vec3::new(0.6, 0.8, 0.0);
    let plain = format!("{:?}", material.prepare(wo));
    assert_eq!(
        plain,
        format!(
            "{:?}",
            material.prepare(Hit {
                wo: wo.into(),
                h: 0.7
            })
        ),
        "h must not matter"
    );
}
