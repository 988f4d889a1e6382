//! Shades one hit on a hair: prints the light it scatters towards the viewer, and a direction for the next ray.

use glam::Vec3;
use hairis::{Conserving, FiberFrame, Gaussian, HairParams, Matched, Material};

fn main() {
    let hair = Material::new(&Conserving(Matched::new(Gaussian)), &HairParams::brown());
    let frame = FiberFrame::from_tangent(Vec3::new(0.1, 0.9, 0.2));
    let bsdf = hair.prepare(frame.to_local(Vec3::new(0.6, 0.0, 0.8)));

    let wi = frame.to_local(Vec3::new(0.0, 0.6, 0.8));
    let eval = bsdf.eval_pdf(wi);
    let scattered = eval
        .value
        .map(|channel| channel * FiberFrame::cos_theta(wi));
    println!("scattered per unit of light: {scattered:?}");

    match bsdf.sample([0.3, 0.6, 0.9]) {
        Some(sample) => println!(
            "next ray: {}, weight {:?}, density {}",
            frame.to_world(sample.wi),
            sample.weight,
            sample.pdf
        ),
        None => println!("the sample is discarded: the path ends"),
    }
}
