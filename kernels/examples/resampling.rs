//! Estimates the direct light of one hit by rays that are chosen from many candidates, and compares the estimate with one
//! ray per BSDF sample.

use glam::Vec3;
use hairis::resample::{Counts, Partition, Pool};
use hairis::{Conserving, FiberFrame, Gaussian, HairParams, Matched, Material, random};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

const ESTIMATES: usize = 4096;
/// Density of a direction that is uniform over the sphere.
const UNIFORM: f32 = 0.25 / core::f32::consts::PI;

/// Radiance of a sky that is brighter above, and the density that its sampler has.
fn sky(wi: Vec3) -> ([f32; 3], f32) {
    ([1.0 + wi.y, 1.0, 1.0 - 0.5 * wi.y], UNIFORM)
}

/// Stands for a ray: the lower half of the sky is hidden.
fn visible(wi: Vec3) -> bool {
    wi.y > 0.0
}

fn uniform([_, u, v]: [f32; 3]) -> Vec3 {
    let (y, phi) = (2.0 * u - 1.0, core::f32::consts::TAU * v);
    let r = (1.0 - y * y).sqrt();
    Vec3::new(r * phi.cos(), y, r * phi.sin())
}

/// Mean and variance.
fn moments(estimates: &[f32]) -> (f32, f32) {
    let n = estimates.len() as f32;
    let mean = estimates.iter().sum::<f32>() / n;
    let square = estimates.iter().map(|x| (x - mean).powi(2)).sum::<f32>() / n;
    (mean, square)
}

fn main() -> Result<(), hairis::columns::LengthError> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let hair = Material::new(&Conserving(Matched::new(Gaussian)), &HairParams::brown());
    let frame = FiberFrame::from_tangent(Vec3::Z);
    let bsdf = hair.prepare(frame.to_local(Vec3::new(0.6, 0.8, 0.0)));
    let to_world = |wi: Vec3| frame.to_world(wi);

    let mut chosen = Vec::new();
    let counts = Counts { bsdf: 8, light: 8 };
    let mut pool = Pool::<16>::new(counts, Partition::All).expect("16 candidates fit");
    for _ in 0..ESTIMATES {
        let xi: [[f32; 3]; 8] = core::array::from_fn(|_| random::xi(&mut rng));
        let [a, b, c] = core::array::from_fn(|row| xi.map(|xi| xi[row]));
        pool.propose(&bsdf, [&a, &b, &c])?;
        for i in 0..8 {
            let wi = uniform(random::xi(&mut rng));
            let (radiance, pdf) = sky(wi);
            pool.set_light(i, frame.to_local(wi), radiance, pdf);
        }
        pool.look_up(|wi| sky(to_world(wi)));
        pool.weigh(&bsdf);
        let [u, ..] = random::xi(&mut rng);
        let one_ray = pool.choose(1, u);
        let light = |(wi, choice): (Vec3, hairis::resample::Choice)| {
            if visible(to_world(wi)) {
                choice.contribution[0]
            } else {
                0.0
            }
        };
        chosen.push(one_ray.map(light).sum());
    }

    let mut plain = Vec::new();
    for _ in 0..ESTIMATES {
        let sample = bsdf.sample(random::xi(&mut rng));
        let seen = sample.filter(|sample| visible(to_world(sample.wi)));
        plain.push(seen.map_or(0.0, |sample| {
            sample.weight[0] * sky(to_world(sample.wi)).0[0]
        }));
    }
    let ((mean, variance), (plain_mean, plain_variance)) = (moments(&chosen), moments(&plain));
    println!("one ray of 8 + 8 candidates: mean {mean:.4}, variance {variance:.4}");
    println!("one ray of a BSDF sample:    mean {plain_mean:.4}, variance {plain_variance:.4}");
    Ok(())
}
