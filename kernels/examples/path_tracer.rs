//! A path tracer's loop over a tuft of straight hairs under a sky with a sun: writes `tuft.ppm`, or the file that is named.

use core::f32::consts::PI;
use glam::Vec3;
use hairis::{Bsdf, Conserving, FiberFrame, Gaussian, HairParams, Hit, Matched, Material, random};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use std::io::Write;

const SIDE: usize = 96;
const SAMPLES: usize = 16;
const BOUNCES: usize = 8;
const RADIUS: f32 = 0.012;
const SUN: f32 = 0.98; // cosine of its half angle

/// Root and unit tangent of each hair; all have the length 1.
fn grow(rng: &mut ChaCha8Rng) -> Vec<(Vec3, Vec3)> {
    let hair = |_| {
        let ([x, z, _], [a, b, _]) = (random::xi(rng), random::xi(rng));
        let lean = Vec3::new(a - 0.5, 2.5, b - 0.5);
        (Vec3::new(x - 0.5, 0.0, z - 0.5), lean.normalize())
    };
    (0..400).map(hair).collect()
}

/// Distance to the nearest hair along a ray, and its tangent and surface normal.
fn meet(hairs: &[(Vec3, Vec3)], origin: Vec3, ray: Vec3) -> Option<(f32, Vec3, Vec3)> {
    let mut nearest: Option<(f32, Vec3, Vec3)> = None;
    for &(root, tangent) in hairs {
        let across = |v: Vec3| v - v.dot(tangent) * tangent;
        let (d, o) = (across(ray), across(origin - root));
        let (a, b, c) = (d.dot(d), d.dot(o), o.dot(o) - RADIUS * RADIUS);
        let discriminant = b * b - a * c;
        if discriminant <= 0.0 || c <= 0.0 {
            continue; // beside this hair, or leaving it
        }
        let t = (-b - discriminant.sqrt()) / a;
        let along = (origin + t * ray - root).dot(tangent);
        if t > 0.0 && (0.0..1.0).contains(&along) && nearest.is_none_or(|(near, ..)| t < near) {
            nearest = Some((t, tangent, (o + t * d) / RADIUS));
        }
    }
    nearest
}

fn sun() -> Vec3 {
    Vec3::new(0.5, 0.6, 0.6).normalize()
}

fn sky(ray: Vec3) -> Vec3 {
    let glow = if ray.dot(sun()) > SUN { 20.0 } else { 0.0 };
    Vec3::new(0.3, 0.4, 0.6) * (0.6 + 0.4 * ray.y) + glow
}

/// A direction towards the sun; [`sun_pdf`] is its density.
fn towards_sun([u, v, _]: [f32; 3]) -> Vec3 {
    let (cos, phi) = (1.0 - u * (1.0 - SUN), 2.0 * PI * v);
    let sin = (1.0 - cos * cos).sqrt();
    FiberFrame::from_tangent(sun()).to_world(Vec3::new(cos, sin * phi.cos(), sin * phi.sin()))
}

fn sun_pdf(ray: Vec3) -> f32 {
    f32::from(u8::from(ray.dot(sun()) > SUN)) / (2.0 * PI * (1.0 - SUN))
}

#[expect(clippy::cast_possible_truncation, reason = "at most 255")]
fn encode(x: f32) -> u8 {
    (255.0 * x.clamp(0.0, 1.0).powf(1.0 / 2.2)) as u8
}

fn main() -> std::io::Result<()> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let hairs = grow(&mut rng);
    let material = Material::new(&Conserving(Matched::new(Gaussian)), &HairParams::blond());
    let mut pixels = Vec::with_capacity(3 * SIDE * SIDE);
    for pixel in 0..SIDE * SIDE {
        let mut mean = Vec3::ZERO;
        for _ in 0..SAMPLES {
            let [x, y, _] = random::xi(&mut rng);
            let place = |i: usize, shift: f32| (i as f32 + shift) / SIDE as f32 - 0.5;
            let (x, y) = (place(pixel % SIDE, x), place(pixel / SIDE, y));
            let mut origin = Vec3::new(0.0, 0.8, 4.0);
            let mut ray = Vec3::new(0.5 * x, -0.5 * y - 0.08, -1.0).normalize();
            let (mut throughput, mut pdf) = (Vec3::ONE, f32::INFINITY);
            for _ in 0..BOUNCES {
                let Some((t, tangent, normal)) = meet(&hairs, origin, ray) else {
                    // The balance heuristic: light sampling has found a part of the sun already.
                    let share = if pdf.is_finite() {
                        pdf / (pdf + sun_pdf(ray))
                    } else {
                        1.0
                    };
                    mean += throughput * sky(ray) * share;
                    break;
                };
                origin += t * ray + 1e-4 * normal;
                let frame = FiberFrame::from_tangent_normal(tangent, normal);
                let wo = frame.to_local(-ray);
                let bsdf: Bsdf<_> = material.prepare(Hit::new(wo, frame.offset(normal, -ray)));
                let light = towards_sun(random::xi(&mut rng));
                if meet(&hairs, origin, light).is_none() {
                    let wi = frame.to_local(light);
                    let eval = bsdf.eval_pdf(wi);
                    let share = FiberFrame::cos_theta(wi) / (sun_pdf(light) + eval.pdf);
                    mean += throughput * Vec3::from(eval.value) * sky(light) * share;
                }
                let Some(sample) = bsdf.sample(random::xi(&mut rng)) else {
                    break; // discarded: the path carries no light
                };
                throughput *= Vec3::from(sample.weight);
                (ray, pdf) = (frame.to_world(sample.wi), sample.pdf);
            }
        }
        pixels.extend((mean / SAMPLES as f32).to_array().map(encode));
    }
    let path = std::env::args_os().nth(1).unwrap_or("tuft.ppm".into());
    let mut file = std::fs::File::create(&path)?;
    writeln!(file, "P6 {SIDE} {SIDE} 255")?;
    file.write_all(&pixels)?;
    println!("wrote {}", path.display());
    Ok(())
}
