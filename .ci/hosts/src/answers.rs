//! Inputs and answers, as a stream of numbers.

use glam::Vec3;
use hairis::columns::{EvalColumns, HitColumns, SampleColumns};
use hairis::dual_scattering::{Crossed, DualScattering, GAIN, albedo_and_forward};
use hairis::model::Model;
use hairis::resample::{CandidateColumns, Counts, Partition, WeightColumns, choose};
use hairis::{Bsdf, Conserving, FiberFrame, Gaussian, Hit, Lobe, LobeMask, Material, Published};
use hairis_variants::color::{ColorOf, with_color};
use hairis_variants::{ModelId, Parameters, Registered, Values, Visitor};

/// Lengths of columns at one hit: less than a packet, one, pairs of the widest packets, and more than a chunk.
const LENGTHS: [usize; 4] = [1, 9, 75, 600];
/// Lengths of columns of hits.
const HITS: [usize; 4] = [1, 8, 21, 333];
/// Energies, as the header numbers them.
const ENERGIES: [u32; 3] = [0, 1, 2];

/// A material: a model's preset with an energy.
struct Case {
    id: ModelId,
    preset: &'static str,
    values: Values,
    energy: u32,
}

/// Two presets of every model, with each energy.
fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for &id in ModelId::ALL {
        for (preset, values) in id.presets().take(2) {
            cases.extend(ENERGIES.map(|energy| Case {
                id,
                preset,
                values,
                energy,
            }));
        }
    }
    cases
}

/// The stream, and the random numbers of its inputs.
struct Stream {
    bytes: Vec<u8>,
    seed: u64,
}

impl Stream {
    fn word(&mut self, word: u32) {
        self.bytes.extend(word.to_ne_bytes());
    }

    fn count(&mut self, count: usize) {
        self.word(u32::try_from(count).expect("a small count"));
    }

    fn floats(&mut self, floats: &[f32]) {
        self.bytes
            .extend(floats.iter().flat_map(|x| x.to_ne_bytes()));
    }

    fn text(&mut self, text: &str) {
        let mut bytes = [0; 32];
        bytes[..text.len()].copy_from_slice(text.as_bytes());
        self.bytes.extend(bytes);
    }

    fn case(&mut self, case: &Case) {
        self.text(case.id.name());
        self.text(case.id.choice().unwrap_or_default().1);
        self.text(case.preset);
        self.word(case.energy);
    }

    /// A number in `[0, 1)`.
    fn uniform(&mut self) -> f32 {
        self.seed = self
            .seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.seed >> 40) as f32 / 16_777_216.0
    }

    /// A direction: uniform over the sphere, and now and then a special one.
    fn direction(&mut self) -> [f32; 3] {
        let (z, phi) = (
            2.0 * self.uniform() - 1.0,
            core::f32::consts::TAU * self.uniform(),
        );
        let across = (1.0 - z * z).sqrt();
        match (self.uniform() * 40.0) as u32 {
            0 => [1.0, 0.0, 0.0],
            1 => [0.0, 0.0, -1.0],
            2 => [f32::NAN, 0.0, 1.0],
            3 => [0.0, f32::INFINITY, 0.0],
            4 => [0.0; 3],
            _ => [z, across * phi.cos(), across * phi.sin()],
        }
    }

    /// Columns of directions, or of uniform numbers, which are written as well.
    fn columns(&mut self, n: usize, are_directions: bool) -> [Vec<f32>; 3] {
        let mut columns = [const { Vec::new() }; 3];
        for _ in 0..n {
            let row = if are_directions {
                self.direction()
            } else {
                [0; 3].map(|_| self.uniform())
            };
            for (column, x) in columns.iter_mut().zip(row) {
                column.push(x);
            }
        }
        columns.iter().for_each(|column| self.floats(column));
        columns
    }

    fn column(&mut self, n: usize, scale: f32, shift: f32) -> Vec<f32> {
        let column: Vec<f32> = (0..n).map(|_| scale * self.uniform() + shift).collect();
        self.floats(&column);
        column
    }
}

fn refs(columns: &[Vec<f32>; 3]) -> [&[f32]; 3] {
    columns.each_ref().map(Vec::as_slice)
}

/// `N` columns of results.
fn results<const N: usize>(n: usize) -> [Vec<f32>; N] {
    core::array::from_fn(|_| vec![0.0; n])
}

fn evals(columns: &mut [Vec<f32>; 4]) -> EvalColumns<'_> {
    let [r, g, b, pdf] = columns.each_mut().map(Vec::as_mut_slice);
    EvalColumns {
        value: Some([r, g, b]),
        pdf: Some(pdf),
    }
}

fn samples(columns: &mut [Vec<f32>; 11]) -> SampleColumns<'_> {
    let [u, v, w, r, g, b, pdf, wr, wg, wb, slot] = columns.each_mut().map(Vec::as_mut_slice);
    SampleColumns {
        wi: Some([u, v, w]),
        value: Some([r, g, b]),
        pdf: Some(pdf),
        weight: Some([wr, wg, wb]),
        slot: Some(slot),
    }
}

/// Scalar calls at one hit.
fn points<M: Model>(to: &mut Stream, bsdf: &Bsdf<M>) {
    to.floats(bsdf.albedo().0.as_flattened());
    for _ in 0..12 {
        let (wi, xi) = (to.direction(), [0; 3].map(|_| to.uniform()));
        to.floats(&wi);
        to.floats(&xi);
        // As host code calls it, a direction of any length: through the object-safe trait nothing is asserted.
        let eval = hairis::model::DynBsdf::eval_pdf(bsdf, Vec3::from(wi));
        to.floats(&eval.value);
        to.floats(&[eval.pdf]);
        for lobe in hairis::model::DynBsdf::lobes(bsdf, Vec3::from(wi)).0 {
            to.floats(&[
                lobe.value,
                lobe.color[0],
                lobe.color[1],
                lobe.color[2],
                lobe.pdf,
            ]);
        }
        let sample = bsdf.sample(xi);
        to.word(sample.map_or(u32::MAX, |sample| sample.lobe.index() as u32));
        let (wi, pdf) = sample.map_or_else(Default::default, |s| (s.wi.to_array(), s.pdf));
        let (value, weight) = sample.map_or_else(Default::default, |s| (s.value, s.weight));
        to.floats(&[
            wi[0], wi[1], wi[2], pdf, value[0], value[1], value[2], weight[0], weight[1], weight[2],
        ]);
    }
}

/// Columns at one hit, and candidates.
fn columns<M: Model>(to: &mut Stream, bsdf: &Bsdf<M>, n: usize) {
    to.count(n);
    let wi = to.columns(n, true);
    let mut out = results::<4>(n);
    bsdf.eval_columns(refs(&wi), evals(&mut out))
        .expect("one length");
    out.iter().for_each(|column| to.floats(column));

    let xi = to.columns(n, false);
    let mut out = results::<11>(n);
    bsdf.sample_columns(refs(&xi), samples(&mut out))
        .expect("one length");
    out.iter().for_each(|column| to.floats(column));
    let mut proposed = results::<3>(n);
    bsdf.propose_columns(refs(&xi), proposed.each_mut().map(Vec::as_mut_slice))
        .expect("one length");
    proposed.iter().for_each(|column| to.floats(column));

    let radiance = [0; 3].map(|_| to.column(n, 2.0, -0.1));
    let pdf_light = to.column(n, 0.2, 0.0);
    let partition = [Partition::All, Partition::Balance, Partition::Power][n % 3];
    let counts = Counts {
        bsdf: 3,
        light: u32::try_from(n).expect("small"),
    };
    to.word(counts.bsdf);
    to.word(counts.light);
    to.word((n % 3) as u32);
    let (mut contribution, mut weight) = (results::<3>(n), vec![0.0; n]);
    let candidates = CandidateColumns {
        wi: refs(&proposed),
        radiance: refs(&radiance),
        pdf_light: &pdf_light,
    };
    let out = WeightColumns {
        contribution: contribution.each_mut().map(Vec::as_mut_slice),
        weight: &mut weight,
    };
    bsdf.weigh_columns(candidates, counts, partition, out)
        .expect("one length");
    contribution.iter().for_each(|column| to.floats(column));
    to.floats(&weight);
    let (k, u) = (n as u32 % 5, to.uniform());
    to.word(k);
    to.floats(&[u]);
    let choices: Vec<_> = choose(refs(&contribution), &weight, k, u).collect();
    to.count(choices.len());
    for choice in choices {
        to.count(choice.index);
        to.word(choice.count);
        to.floats(&choice.contribution);
    }
}

/// Inputs of calls over hits: `wo`, `h`, `wi` and `xi`.
struct Rows {
    wo: [Vec<f32>; 3],
    h: Vec<f32>,
    wi: [Vec<f32>; 3],
    xi: [Vec<f32>; 3],
}

impl Rows {
    fn new(to: &mut Stream, n: usize) -> Self {
        to.count(n);
        let (wo, h) = (to.columns(n, true), to.column(n, 2.2, -1.1));
        Self {
            wo,
            h,
            wi: to.columns(n, true),
            xi: to.columns(n, false),
        }
    }

    fn row(&self, row: usize) -> Self {
        let of = |columns: &[Vec<f32>; 3]| columns.each_ref().map(|column| vec![column[row]]);
        Self {
            wo: of(&self.wo),
            h: vec![self.h[row]],
            wi: of(&self.wi),
            xi: of(&self.xi),
        }
    }

    /// The answers of a material.
    fn answers<M: Model>(&self, material: &Material<M>) -> ([Vec<f32>; 4], [Vec<f32>; 11]) {
        let n = self.h.len();
        let hits = HitColumns {
            wo: refs(&self.wo),
            h: Some(&self.h),
        };
        let (mut eval, mut sample) = (results::<4>(n), results::<11>(n));
        material
            .eval_hits(hits, refs(&self.wi), evals(&mut eval))
            .expect("one length");
        material
            .sample_hits(hits, refs(&self.xi), samples(&mut sample))
            .expect("one length");
        (eval, sample)
    }
}

/// The parameters as the energy has them: scaled, or as they are.
fn params<M: Registered>(values: &Values, energy: u32) -> M::Params {
    let params = <M::Params as Parameters>::from_values(values).expect("a preset");
    let scale = || Material::new(&M::MODEL, &params).conserving_scale();
    if energy == 2 {
        params.scaled(scale()).expect("a small factor")
    } else {
        params
    }
}

/// The answers over hits of a model by values and energy.
struct OverHits<'a>(&'a Values, u32, &'a Rows);

impl Visitor for OverHits<'_> {
    type Output = ([Vec<f32>; 4], [Vec<f32>; 11]);
    fn visit<M: Registered>(self) -> Self::Output {
        let Self(values, energy, rows) = self;
        let params = params::<M>(values, energy);
        // Raw materials of C have another type: their answers are those of this one to the bit.
        if energy == 1 {
            rows.answers(&Material::new(&Conserving(M::MODEL), &params))
        } else {
            rows.answers(&Material::new(&M::MODEL, &params))
        }
    }
}

/// Calls at some hits, with all lobes and with some.
fn at_hits<M: Model>(to: &mut Stream, material: &Material<M>) {
    for length in LENGTHS {
        let (wo, h) = (to.direction(), 2.2 * to.uniform() - 1.1);
        to.floats(&[wo[0], wo[1], wo[2], h]);
        let bsdf = material.prepare(Hit::new(Vec3::from(wo), h));
        points(to, &bsdf);
        columns(to, &bsdf, length);
        let bits = length as u32 % (1 << Lobe::COUNT);
        to.word(bits);
        let kept: Vec<Lobe> = Lobe::ALL
            .into_iter()
            .filter(|lobe| bits >> lobe.index() & 1 == 1)
            .collect();
        let restricted = bsdf.with_lobes(LobeMask::of(&kept));
        points(to, &restricted);
    }
}

/// Everything of one model, preset and energy.
struct One<'a>(&'a Values, u32, &'a mut Stream);

impl Visitor for One<'_> {
    type Output = ();
    fn visit<M: Registered>(self) {
        let Self(values, energy, to) = self;
        let material = Material::new(&M::MODEL, &params::<M>(values, energy));
        to.floats(&[material.max_albedo()]);
        if energy == 1 {
            at_hits(
                to,
                &Material::new(&Conserving(M::MODEL), &params::<M>(values, energy)),
            );
        } else {
            at_hits(to, &material);
        }
        for n in HITS {
            let rows = Rows::new(to, n);
            let (eval, sample) = OverHits(values, energy, &rows).visit::<M>();
            eval.iter()
                .chain(&sample)
                .for_each(|column| to.floats(column));
        }
    }
}

/// Frames and offsets.
fn frames(to: &mut Stream) {
    for round in 0..40 {
        let (tangent, normal, wo) = (to.direction(), to.direction(), to.direction());
        to.floats(&[tangent, normal, wo].concat());
        let frame = match round % 2 {
            0 => FiberFrame::from_tangent(Vec3::from(tangent)),
            _ => FiberFrame::from_tangent_normal(Vec3::from(tangent), Vec3::from(normal)),
        };
        to.floats(&[frame.u.to_array(), frame.v.to_array(), frame.w.to_array()].concat());
        to.floats(&[frame.offset(Vec3::from(normal), Vec3::from(wo))]);
    }
}

/// Hits on a table of all models, energies and two presets, in runs of several lengths; each hit's answer is its own.
fn table(to: &mut Stream) {
    let all = cases();
    to.count(all.len());
    all.iter().for_each(|case| to.case(case));
    let rows = Rows::new(to, 1500);
    let (mut index, mut eval, mut sample) = (Vec::new(), results::<4>(0), results::<11>(0));
    while index.len() < 1500 {
        let one = (to.uniform() * all.len() as f32) as usize;
        // A run on one material, or several materials of one model next to each other.
        let (length, step) = if to.uniform() < 0.3 {
            (to.uniform() * 20.0, 0)
        } else {
            (to.uniform() * 6.0, 3)
        };
        for place in 0..=length as usize {
            index.push((one + place * step) % all.len());
        }
    }
    index.truncate(1500);
    for (row, one) in index.iter().enumerate() {
        to.count(*one);
        let case = &all[*one];
        let (e, s) = case
            .id
            .visit(OverHits(&case.values, case.energy, &rows.row(row)));
        eval.iter_mut()
            .zip(e)
            .for_each(|(all, one)| all.extend(one));
        sample
            .iter_mut()
            .zip(s)
            .for_each(|(all, one)| all.extend(one));
    }
    eval.iter()
        .chain(&sample)
        .for_each(|column| to.floats(column));
}

/// Dual scattering of one material, under random light.
fn dual(to: &mut Stream) {
    let case = &cases()[0];
    to.case(case);
    let material = Material::new(
        &Published(Gaussian),
        &params::<Published<Gaussian>>(&case.values, case.energy),
    );
    let dual = DualScattering::new(&material);
    to.floats(dual.coefficients.as_flattened().as_flattened());
    let write = |to: &mut Stream, crossed: &Crossed| {
        to.floats(&[crossed.direct]);
        to.floats(&[crossed.scattered, crossed.shift, crossed.variance].concat());
    };
    for _ in 0..40 {
        let (wo, wi) = (to.direction(), to.direction());
        let [theta, count] = [3.0 * to.uniform() - 1.5, 6.0 * to.uniform()];
        to.floats(&[&wo[..], &wi, &[theta, count]].concat());
        let fibre = dual.averages(theta);
        write(to, &Crossed::strands(&fibre, count));
        let crossed = Crossed::depth(&fibre, count);
        write(to, &crossed);
        let crossed = crossed.through(&fibre);
        write(to, &crossed);
        let [wo, wi] = [wo, wi].map(|v| Vec3::from(v).into());
        to.floats(&dual.shade(wo, wi, [0.25, 0.5, 1.0], &crossed, [GAIN; 2]));
    }
}

/// Light that a material scatters at an inclination.
struct Scattered<'a>(&'a Values, f32);

impl Visitor for Scattered<'_> {
    type Output = [[f32; 3]; 2];

    fn visit<M: Registered>(self) -> Self::Output {
        let params = M::Params::from_values(self.0).expect("values in range");
        let material = Material::new(&Conserving(M::MODEL), &params);
        albedo_and_forward(self.1, M::LOBES.len(), &mut |hit, lobe, xi, out| {
            let bsdf = material.prepare(hit).with_lobes(LobeMask::of(&[lobe]));
            bsdf.sample_columns(xi, out).expect("columns of one length");
        })
    }
}

/// Parameters of two materials that have a colour.
fn colors(to: &mut Stream) {
    for name in ["gaussian", "d-eon"] {
        let id = ModelId::find(name, None).expect("a model of the list");
        let color = [to.uniform(), to.uniform(), to.uniform()];
        to.text(name);
        to.floats(&color);
        let measure =
            &mut |id: ModelId, values: &Values, theta| Ok(id.visit(Scattered(values, theta)));
        let colored = with_color(id, &id.defaults(), color, ColorOf::Fibre, measure);
        let values = colored.expect("a model with a colour");
        let mut numbers = Vec::new();
        for index in 0..values.fields().len() {
            numbers.extend(values.numbers_at(index));
        }
        numbers.resize(Values::MOST, 0.0);
        to.floats(&numbers);
    }
}

/// The whole stream.
pub fn all() -> Vec<u8> {
    let mut to = Stream {
        bytes: Vec::new(),
        seed: 1,
    };
    frames(&mut to);
    let cases = cases();
    to.count(cases.len());
    for case in &cases {
        to.case(case);
        case.id.visit(One(&case.values, case.energy, &mut to));
    }
    table(&mut to);
    dual(&mut to);
    colors(&mut to);
    to.bytes
}
