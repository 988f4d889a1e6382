//! One hash per entry point, model and level, over fixed inputs.
//!
//! A line is `ROUNDING ENTRY/MODEL HASH LEVEL`. ROUNDING is `scalar` for calls that take no level, and `fused` or `plain` for
//! those that do. Lines that agree in the first two fields agree in the third, on every target and in every build.

mod hash;

use crate::numbers::Numbers;
use core::array::from_fn;
use glam::Vec3;
use hairis::columns::{EvalColumns, SampleColumns};
use hairis::model::{Model, math};
use hairis::simd::{Broadcast, Kernel, Lanes, Level, Vec3x, f32x8};
use hairis::{
    Bsdf, Bsdf8, Conserving, FiberFrame, FiberFrame8, Gaussian, HairParams, Hit, Hit8, Lobe,
    LobeMask, Matched, Material, Material8, Published, Vec3x8, random,
};
use hairis_variants::chiang::{FarField, OffsetNodes};
use hairis_variants::{
    Cauchy, Chiang, ChiangDesc, ChiangParams, DEon, KajiyaKay, KajiyaKayDesc, Parameters,
};
use hash::Hash;

/// Hits per material: eight at a time, the materials of the lanes all different.
const HITS: usize = 4;
/// Packets of eight directions, and of eight triples of numbers, per hit.
const PACKETS: usize = 4;
/// Length of the slices: packets of every width, and a rest.
const LEN: usize = 77;

/// Whether the level rounds once, in a word.
fn rounding(level: Level) -> &'static str {
    if level.fuses() { "fused" } else { "plain" }
}

/// Directions in the fibre's frame: any, and those at the edges of the domain.
fn direction(numbers: &mut Numbers) -> Vec3 {
    let [kind, which, _] = random::xi(numbers);
    let v = 2.0 * Vec3::from(random::xi(numbers)) - Vec3::ONE;
    let v = match (kind * 16.0) as u32 {
        0 => return [Vec3::X, -Vec3::X, Vec3::Y, Vec3::ZERO, Vec3::NAN][(which * 5.0) as usize],
        1 => Vec3::new(0.0, v.y, v.z),
        2 => Vec3::new(1.0, 1e-3 * v.y, 1e-3 * v.z),
        3 => Vec3::new(-1.0, 1e-5 * v.y, 1e-5 * v.z),
        _ => v,
    };
    v.normalize_or_zero()
}

fn directions8(numbers: &mut Numbers) -> Vec3x8 {
    Vec3x8::from(from_fn(|_| direction(numbers)))
}

/// Eight gather points, lane by lane, at a level.
struct Hits<M: Model<Params: Parameters>> {
    materials: [Material<M>; 8],
    hits: [Hit8; HITS],
    wi: [Vec3x8; PACKETS],
    xi: [[f32x8; 3]; PACKETS],
}

impl<M: Model<Params: Parameters>> Hits<M> {
    /// The presets, and a material with narrow lobes.
    fn new(model: M) -> Self {
        let narrow = M::Params::FIELDS.iter().fold(
            M::Params::PRESETS[0].1.values(),
            |values, field| match (field.narrow, field.kind.width()) {
                (Some(x), width) => values.with(field.name, &[x; 4][..width]),
                (None, _) => values,
            },
        );
        let narrow = M::Params::from_values(&narrow).unwrap_or_default();
        let presets = M::Params::PRESETS;
        let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
        Self {
            materials: from_fn(|lane| match lane {
                7 => Material::new(&model, &narrow),
                _ => Material::new(&model, &presets[lane % presets.len()].1),
            }),
            hits: from_fn(|_| {
                let wo = directions8(&mut numbers);
                Hit::new(
                    wo,
                    random::xi8(&mut numbers)[0] * f32x8::splat(2.0) - f32x8::splat(1.0),
                )
            }),
            wi: from_fn(|_| directions8(&mut numbers)),
            xi: from_fn(|_| random::xi8(&mut numbers)),
        }
    }

    fn hit(&self, index: usize, lane: usize) -> Hit {
        let Hit { wo, h } = &self.hits[index];
        Hit::new(wo.lane(lane), h.as_array()[lane])
    }

    fn each_scalar(&self, mut f: impl FnMut(&Bsdf<M>)) {
        for index in 0..HITS {
            for lane in 0..8 {
                f(&self.materials[lane].prepare(self.hit(index, lane)));
            }
        }
    }

    /// Calls that take no level.
    fn scalar(&self, model: &str) {
        let [mut eval, mut lobes, mut sample, mut albedo, mut some] = [Hash::NEW; 5];
        let mask = LobeMask::of(&[Lobe::slot(1), Lobe::slot(0)]);
        self.each_scalar(|bsdf| {
            for (wi, xi) in self.wi.iter().zip(&self.xi) {
                for lane in 0..8 {
                    let (wi, xi) = (wi.lane(lane), from_fn(|i| xi[i].as_array()[lane]));
                    eval.eval(bsdf.eval_pdf(wi));
                    eval.numbers(&bsdf.eval(wi));
                    eval.number(bsdf.pdf(wi));
                    lobes.lobes(&bsdf.lobes(wi));
                    sample.sample(bsdf.sample(xi));
                    some.sample(bsdf.with_lobes(mask).sample(xi));
                    some.eval(bsdf.with_lobes(mask).eval_pdf(wi));
                }
            }
            for bsdf in [bsdf, &bsdf.conserving()] {
                bsdf.albedo().0.iter().for_each(|lobe| albedo.numbers(lobe));
            }
        });
        let print = |hash: Hash, entry| hash.print("scalar", entry, model, "one-lane");
        print(eval, "eval_pdf");
        print(lobes, "lobes");
        print(sample, "sample");
        print(some, "with_lobes");
        print(albedo, "albedo");
        let mut most = Hash::NEW;
        self.materials[..2].iter().for_each(|material| {
            most.numbers(&[material.max_albedo(), material.conserving_scale()])
        });
        print(most, "max_albedo");
    }

    /// Calls on one gather point, at a level.
    fn one_point(&self, level: Level, model: &str) {
        let [mut eval, mut lobes, mut sample, mut slices, mut samples] = [Hash::NEW; 5];
        self.each_scalar(|bsdf| {
            for (wi, xi) in self.wi.iter().zip(&self.xi) {
                eval.eval8(&bsdf.with_level(level).eval_pdf8(wi));
                lobes.lobes8(&bsdf.with_level(level).lobes8(wi));
                sample.sample8(&bsdf.with_level(level).sample8(xi));
            }
        });
        let mut numbers = Numbers(0x2545_f491_4f6c_dd1d);
        let (mut wi, mut xi) = ([[0.0; LEN]; 3], [[0.0; LEN]; 3]);
        for i in 0..LEN {
            let (direction, uniform): ([f32; 3], _) =
                (direction(&mut numbers).into(), random::xi(&mut numbers));
            for row in 0..3 {
                (wi[row][i], xi[row][i]) = (direction[row], uniform[row]);
            }
        }
        self.each_scalar(|bsdf| {
            hash_slices(bsdf, level, &wi, &mut slices);
            hash_samples(bsdf, level, &xi, &mut samples);
        });
        let print = |hash: Hash, entry| hash.print(rounding(level), entry, model, level.name());
        print(eval, "Bsdf::eval_pdf8");
        print(lobes, "Bsdf::lobes8");
        print(sample, "Bsdf::sample8");
        print(slices, "eval_batch");
        print(samples, "sample_batch");
    }

    /// Calls on eight gather points, at a level: of one material, and of eight.
    fn eight_points(&self, level: Level, model: &str) {
        let mut prepare = [Hash::NEW; 2];
        let [mut eval, mut lobes, mut sample, mut albedo, mut some] = [Hash::NEW; 5];
        let packed = Material8::pack(from_fn(|lane| &self.materials[lane]));
        for hits in &self.hits {
            let points: [Bsdf8<M>; 2] = [
                self.materials[0].with_level(level).prepare8(hits),
                packed.with_level(level).prepare8(hits),
            ];
            for (points, prepare) in points.iter().zip(&mut prepare) {
                // Scalar calls add no rounding that depends on the level.
                (0..8).for_each(|lane| prepare.sample(points.lane(lane).sample([0.3, 0.6, 0.9])));
                for (wi, xi) in self.wi.iter().zip(&self.xi) {
                    eval.eval8(&points.with_level(level).eval_pdf8(wi));
                    lobes.lobes8(&points.with_level(level).lobes8(wi));
                    sample.sample8(&points.with_level(level).sample8(xi));
                    some.eval8(
                        &points
                            .with_lobes(LobeMask::of(&[Lobe::slot(0)]))
                            .with_level(level)
                            .eval_pdf8(wi),
                    );
                }
                for points in [points, &points.with_level(level).conserving()] {
                    points
                        .with_level(level)
                        .albedo8()
                        .0
                        .iter()
                        .for_each(|lobe| albedo.lanes(lobe));
                }
            }
        }
        let print = |hash: Hash, entry| hash.print(rounding(level), entry, model, level.name());
        print(prepare[0], "Material::prepare8");
        print(prepare[1], "Material8::prepare8");
        print(eval, "Bsdf8::eval_pdf8");
        print(lobes, "Bsdf8::lobes8");
        print(sample, "Bsdf8::sample8");
        print(some, "Bsdf8::with_lobes");
        print(albedo, "Bsdf8::albedo8");
    }
}

fn hash_slices<M: Model<Params: Parameters>>(
    bsdf: &Bsdf<M>,
    level: Level,
    wi: &[[f32; LEN]; 3],
    hash: &mut Hash,
) {
    let wi = [&wi[0][..], &wi[1][..], &wi[2][..]];
    let (mut value, mut pdf) = ([[0.0; LEN]; 3], [0.0; LEN]);
    let mut passed = bsdf.with_level(level).eval_columns(
        wi,
        EvalColumns {
            value: Some(value.each_mut().map(|x| &mut x[..])),
            pdf: Some(&mut pdf),
        },
    );
    value.iter().for_each(|row| hash.numbers(row));
    hash.numbers(&pdf);
    let values = EvalColumns {
        value: Some(value.each_mut().map(|x| &mut x[..])),
        pdf: None,
    };
    let densities = EvalColumns {
        value: None,
        pdf: Some(&mut pdf),
    };
    passed = passed.and(bsdf.with_level(level).eval_columns(wi, values));
    passed = passed.and(bsdf.with_level(level).eval_columns(wi, densities));
    value.iter().for_each(|row| hash.numbers(row));
    hash.numbers(&pdf);
    assert!(passed.is_ok(), "slices of one length");
}

fn hash_samples<M: Model<Params: Parameters>>(
    bsdf: &Bsdf<M>,
    level: Level,
    xi: &[[f32; LEN]; 3],
    hash: &mut Hash,
) {
    let mut rows = [[0.0; LEN]; 11];
    let [u, v, w, r, g, b, pdf, wr, wg, wb, slot] = rows.each_mut().map(|row| &mut row[..]);
    let out = SampleColumns {
        wi: Some([u, v, w]),
        value: Some([r, g, b]),
        pdf: Some(pdf),
        weight: Some([wr, wg, wb]),
        slot: Some(slot),
    };
    assert!(
        bsdf.with_level(level)
            .sample_columns([&xi[0], &xi[1], &xi[2]], out)
            .is_ok(),
        "slices of one length"
    );
    rows.iter().for_each(|row| hash.numbers(row));
}

/// Every entry point of a model.
fn every_entry<M: Model<Params: Parameters>>(model: M, name: &str) {
    let hits = Hits::new(model);
    hits.scalar(name);
    for level in Level::available() {
        hits.one_point(level, name);
        hits.eight_points(level, name);
    }
}

/// Samplers matched in other numbers of bands are the same code.
fn models() {
    every_entry(Published(Gaussian), "gaussian");
    every_entry(Matched::<_>(Gaussian), "gaussian/matched");
    every_entry(
        Matched::<_, 9, true>(Gaussian),
        "gaussian/matched-by-channel",
    );
    every_entry(Cauchy::PAPER.model(), "cauchy");
    every_entry(Cauchy::PAPER.matched(), "cauchy/matched");
    every_entry(Conserving(Published(Gaussian)), "gaussian/conserving");
    every_entry(
        Conserving(Cauchy::PAPER.matched()),
        "cauchy/matched-conserving",
    );
    every_entry(KajiyaKay, "kajiya-kay");
    every_entry(Chiang::<false>, "chiang");
    every_entry(Chiang::<true>, "chiang/by-channel");
    every_entry(DEon, "d-eon");
}

/// The elementary functions, on eight lanes.
struct Math(f32x8, f32x8);

impl Kernel for Math {
    type Output = [f32x8; 18];

    #[inline(always)]
    fn run<L: Lanes<Stored = f32x8>>(self) -> [f32x8; 18] {
        // In [-1, 1), in [0, 1) and above 0.
        let (x, y): (L, L) = (self.0.lanes(), self.1.lanes());
        let (gaussian, complement) = math::gaussian_and_complement(y * 90.0);
        let [(a, b), (c, d), (e, f)] = [
            math::sin_cos_half_turn(x),
            math::sin_cos_twice(x * 0.5),
            math::sin_cos_absolute(x),
        ];
        let (tan, over) = math::tan_half_turn(x);
        let above = y + 1e-7;
        [
            math::gaussian(y * 170.0).store(),
            gaussian.store(),
            complement.store(),
            math::atan_unit(x).store(),
            math::half_atan2(y, x, (x * x + y * y).sqrt()).store(),
            math::atan2_upper(y, x).store(),
            a.store(),
            b.store(),
            c.store(),
            d.store(),
            (e + f).store(),
            L::quotient(tan, over).store(),
            math::half_angle(x, y).store(),
            math::sin_half_turn(x).store(),
            math::log2(above).store(),
            math::log2_one_plus(x * 0.2).store(),
            math::normal_tail(y * 9.0).store(),
            math::normal_tail_inverse(above * 0.5).store(),
        ]
    }
}

fn functions() {
    for level in Level::available() {
        let (mut hash, mut numbers) = (Hash::NEW, Numbers(7));
        for _ in 0..64 {
            let [x, y, _] = random::xi8(&mut numbers);
            hash.lanes(&level.run(Math(x * f32x8::splat(2.0) - f32x8::splat(1.0), y)));
        }
        hash.print(rounding(level), "math", "-", level.name());
    }
}

fn frames() {
    let (mut one, mut eight, mut numbers) = (Hash::NEW, Hash::NEW, Numbers(11));
    for _ in 0..16 {
        let frames: [FiberFrame; 8] = from_fn(|_| {
            let (tangent, normal) = (direction(&mut numbers), direction(&mut numbers));
            let frame = FiberFrame::from_tangent_normal(tangent, normal);
            one.number(frame.offset(normal, direction(&mut numbers)));
            if frame.u.is_finite() {
                frame
            } else {
                FiberFrame::from_tangent(Vec3::X)
            }
        });
        let v = directions8(&mut numbers);
        for (lane, frame) in frames.iter().enumerate() {
            [
                frame.u,
                frame.v,
                frame.w,
                frame.to_local(v.lane(lane)),
                frame.to_world(v.lane(lane)),
            ]
            .into_iter()
            .for_each(|v| one.vec3(v));
        }
        let eight_frames = FiberFrame8::splat(&frames[0]);
        for Vec3x { x, y, z } in [eight_frames.to_local(&v), eight_frames.to_world(&v)] {
            eight.lanes(&[x, y, z]);
        }
    }
    one.print("scalar", "FiberFrame", "-", "one-lane");
    eight.print("scalar", "FiberFrame8", "-", "eight-lanes");
}

/// Parameters that are computed, and not only stored.
fn parameters() {
    let mut hash = Hash::NEW;
    let mut values = |values: hairis_variants::Values| {
        values
            .fields()
            .iter()
            .for_each(|field| hash.numbers(values.numbers(field.name)));
    };
    values(
        HairParams::from_artist(&Default::default())
            .unwrap_or_default()
            .values(),
    );
    for i in 1_u8..8 {
        let x = f32::from(i) / 9.0;
        let chiang = ChiangDesc {
            beta_n: x,
            ..ChiangDesc::default()
        };
        for desc in [
            chiang.with_color([x, x * x, 0.5]),
            chiang.with_melanin_amount(x, 0.3),
        ]
        .into_iter()
        .flatten()
        {
            values(ChiangParams::new(&desc).unwrap_or_default().values());
            hash_color(&desc, &mut values);
        }
        let glossy = KajiyaKayDesc::default()
            .with_width_deg(50.0 * x)
            .unwrap_or_default();
        values(
            hairis_variants::KajiyaKayParams::new(&glossy)
                .unwrap_or_default()
                .values(),
        );
    }
    hash.print("scalar", "parameters", "-", "one-lane");
}

/// The derived figures of a fibre, as a colour among values.
fn hash_color(desc: &ChiangDesc, values: &mut impl FnMut(hairis_variants::Values)) {
    let fibre = ChiangParams::default().values();
    values(fibre.with("sigma_a", &desc.color()));
    let derived = [
        desc.width_deg(),
        desc.longitudinal_variance(),
        desc.azimuthal_scale(),
    ];
    values(fibre.with("sigma_a", &derived));
}

/// The far field, which runs on the best level.
fn far_field() {
    let level = Level::detect();
    let (mut hash, mut numbers) = (Hash::NEW, Numbers(13));
    let nodes = OffsetNodes::<4>::new();
    for (_, params) in ChiangParams::presets() {
        let point = FarField::prepare(
            &Material::new(&Chiang::<false>, &params),
            &nodes,
            direction(&mut numbers),
        );
        for _ in 0..8 {
            hash.eval(point.eval_pdf(direction(&mut numbers)));
            hash.sample(point.sample(random::xi(&mut numbers)));
        }
        point.albedo().0.iter().for_each(|lobe| hash.numbers(lobe));
    }
    hash.print(rounding(level), "FarField", "chiang", level.name());
}

/// Prints every line.
pub fn print() {
    models();
    far_field();
    functions();
    frames();
    parameters();
}
