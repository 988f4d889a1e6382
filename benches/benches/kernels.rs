//! Evaluation, sampling and preparation: the textbook in `f32`, one lane, eight lanes on every level, and slices.
//!
//! `cargo bench -p hairis-benches`, or `-- eval/gaussian` for one group. Throughput is in directions.

use core::hint::black_box;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use hairis::textbook::{Parameters, Shape, Textbook};
use hairis::{Bsdf, Bsdf8, EvalSlices, Gaussian, Hair, HairParams, Level, Model};
use hairis_benches::{DIRECTIONS, columns, direction_packets, materials, xi_packets};
use hairis_variants::Cauchy;

/// Runs `f` on every input and keeps what it gives.
fn each<T, R>(inputs: &[T], mut f: impl FnMut(&T) -> R) {
    for input in inputs {
        black_box(f(black_box(input)));
    }
}

fn eval<M: Model<Params = HairParams>>(c: &mut Criterion, name: &str, model: &M, shape: Shape) {
    let wi = direction_packets();
    let wo = wi[0].lane(0);
    let params = HairParams::default();
    let gather = Bsdf::new(model, &params).prepare(wo);
    let textbook = Textbook::<f32>::prepare(&Parameters::from(&params), shape, wo.to_array());
    let flat: Vec<glam::Vec3> = wi.iter().flat_map(|packet| <[glam::Vec3; 8]>::from(*packet)).collect();
    for (i, wi) in flat.iter().enumerate() {
        let (want, got) = (textbook.pdf(wi.to_array()), gather.pdf(*wi));
        assert!((got / want - 1.0).abs() < 1e-2, "direction {i}: the kernel gives {got}, the textbook {want}");
    }
    let mut group = c.benchmark_group(format!("eval/{name}"));
    group.throughput(Throughput::Elements(DIRECTIONS as u64));
    group.bench_function("textbook f32", |b| {
        b.iter(|| each(&flat, |wi| textbook.eval_pdf(wi.to_array())));
    });
    group.bench_function("one lane", |b| {
        b.iter(|| each(&flat, |wi| gather.eval_pdf(*wi)));
    });
    let xyz = columns(&wi.iter().map(|v| [v.x, v.y, v.z]).collect::<Vec<_>>());
    let mut out = vec![vec![0.0; DIRECTIONS]; 4];
    for level in Level::available() {
        group.bench_function(BenchmarkId::new("x8", level), |b| {
            b.iter(|| each(&wi, |wi| gather.eval_pdf8_at(level, wi)));
        });
        group.bench_function(BenchmarkId::new("slices", level), |b| {
            b.iter(|| {
                let [r, g, b, pdf] = &mut out[..] else { unreachable!("four columns were made") };
                let to = EvalSlices { value: [r, g, b], pdf };
                black_box(gather.eval_pdf_batch_at(level, [&xyz[0], &xyz[1], &xyz[2]], to))
            });
        });
    }
    group.finish();
}

fn sample<M: Model<Params = HairParams>>(c: &mut Criterion, name: &str, model: &M, shape: Shape) {
    let xi = xi_packets();
    let wo = direction_packets()[0].lane(0);
    let params = HairParams::default();
    let gather = Bsdf::new(model, &params).prepare(wo);
    let textbook = Textbook::<f32>::prepare(&Parameters::from(&params), shape, wo.to_array());
    let [lobe, theta, phi] = columns(&xi);
    let flat: Vec<[f32; 3]> = (0..DIRECTIONS).map(|i| [lobe[i], theta[i], phi[i]]).collect();
    let mut group = c.benchmark_group(format!("sample/{name}"));
    group.throughput(Throughput::Elements(DIRECTIONS as u64));
    group.bench_function("textbook f32", |b| {
        b.iter(|| each(&flat, |xi| textbook.sample(*xi)));
    });
    group.bench_function("one lane", |b| {
        b.iter(|| each(&flat, |xi| gather.sample(*xi)));
    });
    for level in Level::available() {
        group.bench_function(BenchmarkId::new("x8", level), |b| {
            b.iter(|| each(&xi, |xi| gather.sample8_at(level, xi)));
        });
    }
    group.finish();
}

fn prepare<M: Model<Params = HairParams>>(c: &mut Criterion, name: &str, model: &M, shape: Shape) {
    let wo = direction_packets();
    let materials = materials(model);
    let eight = Bsdf8::pack(core::array::from_fn(|lane| &materials[lane % materials.len()]));
    let parameters = Parameters::<f32>::from(&HairParams::default());
    let flat: Vec<[f32; 3]> =
        wo.iter().flat_map(|packet| <[glam::Vec3; 8]>::from(*packet)).map(|v| v.to_array()).collect();
    let mut group = c.benchmark_group(format!("prepare/{name}"));
    group.throughput(Throughput::Elements(DIRECTIONS as u64));
    group.bench_function("textbook f32", |b| {
        b.iter(|| each(&flat, |wo| Textbook::prepare(&parameters, shape, *wo)));
    });
    for level in Level::available() {
        group.bench_function(BenchmarkId::new("x8", level), |b| {
            b.iter(|| each(&wo, |wo| eight.prepare8_at(level, wo)));
        });
    }
    group.finish();
}

fn both(c: &mut Criterion) {
    println!("eight lanes run on {}", Level::detect());
    let (gaussian, cauchy) = (Hair(Gaussian), Cauchy::PAPER.model());
    eval(c, "gaussian", &gaussian, Shape::Gaussian);
    eval(c, "cauchy", &cauchy, Shape::Cauchy);
    sample(c, "gaussian", &gaussian, Shape::Gaussian);
    sample(c, "cauchy", &cauchy, Shape::Cauchy);
    prepare(c, "gaussian", &gaussian, Shape::Gaussian);
    prepare(c, "cauchy", &cauchy, Shape::Cauchy);
}

criterion_group!(benches, both);
criterion_main!(benches);
