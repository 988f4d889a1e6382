//! A tuft drawn twice by one path tracer: on a GPU, by generated WGSL through wgpu, and on the CPU, by the library. Writes both pictures
//! and a hundred times their difference side by side, and prints how much they differ.
//!
//! `cargo run -- [FILE.png]`

mod cpu;
mod gpu;

use glam::Vec3;
use hairis::model::Model as _;
use hairis::{Gaussian, HairParams, Matched, Material};
use hairis_shaders::{Call, Language, Program, Target, numbers, print};
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::time::Instant;

/// Pixels on each side of a picture, as in `tuft.wgsl`.
const SIDE: usize = 160;
/// Samples of a pixel, as in `tuft.wgsl`.
const SAMPLES: usize = 32;

/// Returns the root and the unit tangent of each hair; all hairs have the length 1.
fn grow() -> Vec<(Vec3, Vec3)> {
    let mut random = cpu::Random(7);
    let hair = |_| {
        let [x, z, a] = random.three();
        let lean = Vec3::new(a - 0.5, 2.5, random.unit() - 0.5);
        (Vec3::new(x - 0.5, 0.0, z - 0.5), lean.normalize())
    };
    (0..400).map(hair).collect()
}

/// Returns the module with the model's functions, followed by the path tracer that calls them.
fn module() -> String {
    let mut program = Program::of::<Matched<Gaussian>>(Target::Gpu);
    let call = program.function(Call::EvalSampleHit).clone();
    program.keep(vec![call]);
    print(&program, Language::Wgsl) + include_str!("tuft.wgsl")
}

fn encode(sum: f32) -> u8 {
    let x = sum / SAMPLES as f32;
    (255.0 * x.clamp(0.0, 1.0).powf(1.0 / 2.2)) as u8
}

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args_os().nth(1).unwrap_or("tuft.png".into());
    let (model, params) = (Matched::new(Gaussian), HairParams::blond());
    // Scaled so that no more light is returned than arrives.
    let scale = Material::new(&model, &params).conserving_scale();
    let params = params.scaled(scale)?;
    let (hairs, constants) = (grow(), numbers(&model.material(&params)));

    let start = Instant::now();
    let (gpu, is_software) = gpu::draw(&module(), &hairs, &constants)?;
    println!("on the GPU: {:.2?}, compiling included", start.elapsed());
    let start = Instant::now();
    let cpu = cpu::draw(&Material::new(&model, &params), &hairs);
    println!("on the CPU: {:.2?}, one thread", start.elapsed());

    let mean = |picture: &[Vec3]| picture.iter().sum::<Vec3>().element_sum() / picture.len() as f32;
    let difference: Vec<Vec3> = gpu.iter().zip(&cpu).map(|(a, b)| (*a - *b).abs()).collect();
    let (bright, shift) = (mean(&cpu), (mean(&gpu) / mean(&cpu) - 1.0).abs());
    let mut errors: Vec<f32> = difference
        .iter()
        .map(|x| x.element_sum() / bright)
        .collect();
    errors.sort_by(f32::total_cmp);
    let quantiles =
        [0.9, 0.99, 0.999, 1.0].map(|share| errors[(share * (errors.len() - 1) as f64) as usize]);
    println!(
        "difference of the means: {shift:.1e}; of pixels, relative to the mean, in 90%, 99%, 99.9% and all of them: at most {}",
        quantiles.map(|x| format!("{x:.1e}")).join(", ")
    );

    let mut bytes = Vec::with_capacity(9 * SIDE * SIDE);
    for row in 0..SIDE {
        for picture in [&gpu, &cpu] {
            let pixels = &picture[row * SIDE..][..SIDE];
            bytes.extend(pixels.iter().flat_map(|pixel| pixel.to_array().map(encode)));
        }
        let pixels = &difference[row * SIDE..][..SIDE];
        bytes.extend(
            pixels
                .iter()
                .flat_map(|x| (100.0 * *x).to_array().map(encode)),
        );
    }
    let out = BufWriter::new(File::create(&file)?);
    let side = u32::try_from(SIDE)?;
    let mut png = png::Encoder::new(out, 3 * side, side);
    png.set_color(png::ColorType::Rgb);
    png.write_header()?.write_image_data(&bytes)?;
    println!(
        "GPU, CPU and 100 times their difference: {}",
        file.display()
    );
    // Paths diverge where rounding moves them past the edge of a hair, and each changes one sample of a pixel. More paths diverge on a
    // GPU, which rounds divisions differently, than on lavapipe: 1.4e-4 and 2.7e-2 on an H100.
    let bounds = if is_software {
        [1e-5, 1e-6]
    } else {
        [3e-4, 0.05]
    };
    let is_same = shift < bounds[0] && quantiles[1] < bounds[1];
    if is_same {
        Ok(())
    } else {
        Err("the pictures differ".into())
    }
}
