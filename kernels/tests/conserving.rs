//! `Conserving`: materials with a fit and without, alone, packed and in slices.

use core::f64::consts::FRAC_PI_2;
use glam::Vec3;
use hairis::model::Model;
use hairis::params::HairDesc;
use hairis::simd::{Level, f32x8};
use hairis::{
    Conserving, Gaussian, HairParams, Hit8, Matched, Material, PerLobe, Published, Vec3x8,
};
use hairis_conformance::published::support::{DEG, Draws, direction, narrow, packet};
use hairis_conformance::{Materials, Subject, hits, lanes};
use hairis_variants::Cauchy;

/// Materials of each kind: 10,000 in `.ci/long.sh`.
fn materials() -> usize {
    std::env::var("HAIRIS_MATERIALS").map_or(150, |n| n.parse().unwrap())
}

/// Hair as an artist would describe it: tilts of 3 to 15 degrees, widths of 2 to 30, any colour.
fn everyday(draws: &mut Draws) -> HairParams {
    let (tilt, width) = (
        -draws.between(3.0, 10.0) * DEG,
        draws.between(4.0, 12.0) * DEG,
    );
    let mut near = |x: f64| narrow(x * draws.scale(0.67, 1.5));
    let alpha = [near(tilt), near(-0.5 * tilt), near(-1.5 * tilt)];
    let beta = [near(width), near(0.5 * width), near(2.0 * width)];
    let [gamma_tt, gamma_g] = [(); 2].map(|()| narrow(draws.between(5.0, 20.0) * DEG));
    let pigment = [(); 3].map(|()| draws.between(0.3, 0.98));
    let [r, tt, trt] = [(0.01, 0.1), (0.5, 5.0), (0.03, 0.6)].map(|(lo, hi)| draws.between(lo, hi));
    HairParams::new(&HairDesc {
        alpha,
        beta,
        gamma_tt,
        gamma_g,
        phi_g: narrow(draws.between(20.0, 50.0) * DEG),
        i_r: [narrow(r); 3],
        i_tt: pigment.map(|p| narrow(tt * p)),
        i_trt: pigment.map(|p| narrow(trt * p * p)),
        i_g: narrow(draws.between(0.0, 3.0)),
    })
    .unwrap()
}

/// Any legal widths and tilts, with lobes that return up to a few hundred times the light.
fn legal(draws: &mut Draws) -> HairParams {
    let most = [FRAC_PI_2, 0.3][draws.below(2)];
    let alpha = [(); 3].map(|()| narrow(draws.between(-most, most)).clamp(-1.57, 1.57));
    let beta = [(); 3].map(|()| draws.scale(1.001e-4, 3.1));
    let [gamma_tt, gamma_g] = [(); 2].map(|()| draws.scale(1.001e-4, 3.1));
    let mut rgb = |by: f64| {
        let strength = draws.scale(6.7e-3, 150.0) / by;
        [(); 3].map(|()| narrow(strength * draws.between(0.1, 1.0)))
    };
    let i_r = rgb(20.0 * beta[0]);
    let i_tt = rgb(12.5 * beta[1] * gamma_tt.min(1.2));
    let i_trt = rgb(20.0 * beta[2]);
    HairParams::new(&HairDesc {
        alpha,
        beta: beta.map(narrow),
        gamma_tt: narrow(gamma_tt),
        gamma_g: narrow(gamma_g),
        phi_g: narrow(draws.between(0.0, 3.1)),
        i_r,
        i_tt,
        i_trt,
        i_g: narrow(draws.scale(0.05, 20.0)),
    })
    .unwrap()
}

/// 200 directions, from 1e-5 rad off either pole to the normal plane: half of them even, half ever closer.
fn inclinations() -> Vec<Vec3x8> {
    let closer = |i: u32| 1e-5 * (FRAC_PI_2 / 1e-5).powf(f64::from(i) / 51.0);
    let off_pole: Vec<f64> = (0..52)
        .map(closer)
        .chain((0..48).map(|i| FRAC_PI_2 * (f64::from(i) + 0.5) / 48.0))
        .collect();
    let at = |off: &f64, side: f64| Vec3::new(narrow(side * off.cos()), narrow(off.sin()), 0.0);
    let all: Vec<Vec3> = [-1.0, 1.0]
        .iter()
        .flat_map(|side| off_pole.iter().map(move |off| at(off, *side)))
        .collect();
    let (packets, []) = all.as_chunks::<8>() else {
        unreachable!("200 directions")
    };
    packets.iter().map(|eight| Vec3x8::from(*eight)).collect()
}

fn channels(PerLobe(lobes): PerLobe<[f32x8; 3]>) -> [f32x8; 3] {
    [0, 1, 2].map(|c| lobes[0][c] + lobes[1][c] + lobes[2][c] + lobes[3][c])
}

/// Materials of a kind: at most 1.001 returns, the mean is that of the exact factors, and few integrate their lobes. The raw
/// material has the type of the other, which is compiled already.
fn conserves<M: Model<Params = HairParams>>(
    name: &str,
    model: M,
    draw: fn(&mut Draws) -> HairParams,
    integrating_at_most: f64,
) {
    let (directions, mut draws, count) = (inclinations(), Draws(41), materials());
    let (mut largest, mut mean_off, mut integrating) = (0.0_f32, 0.0_f64, 0_usize);
    for _ in 0..count {
        let params = draw(&mut draws);
        let raw = Material::<Conserving<M>>::from(Material::new(&model, &params));
        let hair = Material::new(&Conserving(model), &params);
        integrating += usize::from(hair.integrates());
        let (mut got, mut want) = (0.0_f64, 0.0_f64);
        for wo in &directions {
            let hits = &Hit8::from(wo);
            let albedo = channels(hair.prepare8(hits).albedo8());
            let exact = channels(raw.prepare8(hits).albedo8());
            for (albedo, exact) in albedo.iter().zip(&exact) {
                for lane in 0..8 {
                    let (albedo, exact) = (albedo.as_array()[lane], exact.as_array()[lane]);
                    assert!(
                        albedo <= 1.001,
                        "{name}: {albedo} returns, lane {lane} of {wo:?}: {params:?}"
                    );
                    largest = largest.max(albedo);
                    let weight = f64::from(wo.y.as_array()[lane]);
                    got += weight * f64::from(albedo);
                    want += weight * f64::from(exact.min(1.0));
                }
            }
        }
        if want > 1e-6 {
            let off = (got / want - 1.0).abs();
            assert!(off < 1e-3, "{name}: mean {got} for {want}: {params:?}");
            mean_off = mean_off.max(off);
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "few")]
    let share = integrating as f64 / count as f64;
    println!(
        "{name}: {count} materials, largest albedo {largest}, mean off by {mean_off:.1e}, {:.2}% integrate",
        100.0 * share
    );
    assert!(
        share <= integrating_at_most,
        "{name}: {share} of the materials integrate"
    );
}

#[test]
fn everyday_hair_conserves_energy_by_its_fit() {
    conserves("everyday, Gaussian", Published(Gaussian), everyday, 0.05);
    conserves("everyday, Cauchy", Cauchy::PAPER.model(), everyday, 0.03);
}

#[test]
fn any_legal_hair_conserves_energy() {
    conserves("legal, Gaussian", Published(Gaussian), legal, 0.8);
    conserves("legal, Cauchy", Cauchy::PAPER.model(), legal, 0.8);
}

/// Hair of narrow bright lobes, for which no fit is accurate enough.
fn narrow_bright() -> HairParams {
    let narrow = HairDesc {
        beta: [2e-4, 0.03, 1e-3],
        i_r: [900.0, 500.0, 200.0],
        i_trt: [300.0; 3],
        ..*HairParams::blond().desc()
    };
    HairParams::new(&narrow).unwrap()
}

/// Columns of hits, directions and uniform numbers.
pub(crate) fn columns(len: usize) -> [[Vec<f32>; 3]; 3] {
    let mut draws = Draws(42);
    let mut directions = || {
        let wi: Vec<Vec3> = (0..len)
            .map(|_| direction(draws.between(-1.57, 1.57), draws.between(-3.1, 3.1)))
            .collect();
        [0, 1, 2].map(|i| wi.iter().map(|wi| wi[i]).collect())
    };
    let (wo, wi) = (directions(), directions());
    let xi = [(); 3].map(|()| (0..len).map(|_| narrow(draws.between(0.0, 1.0))).collect());
    [wo, wi, xi]
}

pub(crate) fn slices(columns: &[Vec<f32>; 3]) -> [&[f32]; 3] {
    columns.each_ref().map(Vec::as_slice)
}

/// Hair with a fit, and hair without.
struct Fits<M>(M);

impl<M: Model<Params = HairParams> + Sync + 'static> Subject for Fits<M> {
    type Model = Conserving<M>;

    fn model(&self) -> Self::Model {
        Conserving(self.0)
    }

    fn materials(&self) -> Materials<Self> {
        vec![
            ("with a fit", HairParams::blond()),
            ("without", narrow_bright()),
        ]
    }
}

/// Calls of slices and of packets, on materials with a fit and without, give the same bits.
fn calls_agree<M: Model<Params = HairParams> + Sync + 'static>(model: M) {
    let subject = Fits(model);
    let materials = subject.materials().into_iter();
    let integrate: Vec<_> = materials
        .map(|(_, params)| subject.material(&params).integrates())
        .collect();
    assert_eq!(integrate, [false, true], "a fit, and none");
    for property in [
        hits::hits_equal_packets(&subject),
        lanes::levels_agree(&subject),
        lanes::lanes_permute(&subject),
    ] {
        property.unwrap();
    }
}

// Tests of their own, which run side by side: each integrates tens of thousands of hits.
#[test]
fn packets_and_slices_of_conserving_hair_agree() {
    calls_agree(Published(Gaussian));
}

#[test]
fn packets_and_slices_of_conserving_matched_hair_agree() {
    calls_agree(Matched::new(Gaussian));
}

#[test]
fn packets_and_slices_of_conserving_cauchy_hair_agree() {
    calls_agree(Published(Cauchy::PAPER));
}

/// One lane has the bits of eight that do not fuse.
#[test]
fn one_hit_has_the_bits_of_eight_that_round_alike() {
    let [wo, wi, _] = columns(200);
    for level in Level::available().filter(|level| !level.fuses()) {
        for params in [HairParams::blond(), narrow_bright()] {
            let material = Material::new(&Conserving(Published(Gaussian)), &params);
            for i in 0..200 {
                let at = |columns: &[Vec<f32>; 3]| {
                    Vec3::new(columns[0][i], columns[1][i], columns[2][i])
                };
                let one = material.prepare(at(&wo)).eval_pdf(at(&wi));
                let hits = &Hit8::from(&Vec3x8::from([at(&wo); 8]));
                let eight = material
                    .with_level(level)
                    .prepare8(hits)
                    .eval_pdf8(&Vec3x8::from([at(&wi); 8]));
                assert_eq!(one, eight.lane(5), "{level}: hit {i}");
            }
        }
    }
}

/// Hair that returns less than it receives keeps its bits.
#[test]
fn dark_hair_is_as_it_was() {
    let (raw, hair) = (
        Material::new(&Published(Gaussian), &HairParams::black()),
        Material::new(&Conserving(Published(Gaussian)), &HairParams::black()),
    );
    for wo in inclinations() {
        let hits = &Hit8::from(&wo);
        assert_eq!(
            hair.prepare8(hits).albedo8(),
            raw.prepare8(hits).albedo8(),
            "{wo:?}"
        );
    }
}

/// Compares the calls of a raw material with those of the same material in the type of one that conserves energy, to the bit.
fn types_agree<M: Model<Params = HairParams>>(model: M) {
    let raw = Material::new(&model, &HairParams::blond());
    let other = Material::<Conserving<M>>::from(raw);
    let mut draws = Draws(43);
    let mut some = || direction(draws.between(-1.57, 1.57), draws.between(-3.1, 3.1));
    for _ in 0..40 {
        let [wo, wi] = [(); 2].map(|()| -> [Vec3; 8] { core::array::from_fn(|_| some()) });
        let xi = some().to_array().map(|x| 0.5 * (x + 1.0));
        macro_rules! same {
            ($raw:ident, $other:ident; $($call:ident($argument:expr))*) => { $(
                assert_eq!(
                    format!("{:?}", $raw.$call($argument)),
                    format!("{:?}", $other.$call($argument)),
                    "{} of {wo:?} {wi:?} {xi:?}",
                    stringify!($call),
                );
            )* };
        }
        let hits = &Hit8::from(&packet(&wo));
        let (one, its) = (raw.prepare(wo[0]), other.prepare(wo[0]));
        same!(one, its; eval_pdf(wi[0]) lobes(wi[0]) sample(xi));
        assert_eq!(one.albedo(), its.albedo(), "{wo:?}");
        for level in Level::available() {
            let eight = raw.with_level(level).prepare8(hits);
            let its = other.with_level(level).prepare8(hits);
            let (wi, xi) = (packet(&wi), xi.map(f32x8::splat));
            same!(eight, its; eval_pdf8(&wi) lobes8(&wi) sample8(&xi));
            assert_eq!(eight.albedo8(), its.albedo8(), "{level}: {wo:?}");
        }
    }
}

#[test]
fn raw_materials_have_the_same_bits_in_the_type_of_conserving_ones() {
    types_agree(Published(Gaussian));
    types_agree(Matched::new(Gaussian));
}

/// A material of the raw model has no room for a fit.
#[test]
fn raw_materials_do_not_grow() {
    type Raw = Material<Published<Gaussian>>;
    assert_eq!(size_of::<Raw>(), 180, "44 numbers and a level");
}
