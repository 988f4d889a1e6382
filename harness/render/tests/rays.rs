//! Share of the tree that rays visit, and rays per second.

use glam::Vec3;
use hairis_render::geometry::{Flattening, Groom, Kind, Strands};
use hairis_render::tree::{Meet, Ray, Skip, Tree, Visits};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use std::time::Instant;

/// Returns the rays of a camera, in tiles of 8 by 8, and rays in all directions from what they meet, `bounces` times over.
fn rays(strands: &Strands, tree: &Tree, side: usize, bounces: usize) -> [Vec<Ray>; 2] {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut number = || (random.next_u32() >> 8) as f32 / (1 << 24) as f32;
    let mut primary = Vec::with_capacity(side * side);
    for i in 0..side * side {
        let (tile, pixel) = (i / 64, i % 64);
        let (x, y) = (
            tile % (side / 8) * 8 + pixel % 8,
            tile / (side / 8) * 8 + pixel / 8,
        );
        let on_image =
            |pixel: usize, number: f32| 2.0 * (pixel as f32 + number) / side as f32 - 1.0;
        let direction = Vec3::new(
            0.268 * on_image(x, number()),
            -0.05 - 0.268 * on_image(y, number()),
            -1.0,
        );
        primary.push(Ray::new(Vec3::new(0.0, 2.0, 60.0), direction.normalize()));
    }
    let mut secondary: Vec<Ray> = Vec::new();
    let mut last = primary.clone();
    for _ in 0..bounces {
        let hits = last.iter().filter_map(|ray| tree.closest(ray));
        last = hits
            .map(|hit| {
                let (z, azimuth) = (2.0 * number() - 1.0, core::f32::consts::TAU * number());
                let across = (1.0 - z * z).max(0.0).sqrt();
                let direction =
                    Vec3::new(across * azimuth.cos(), across * azimuth.sin(), z).normalize();
                let cos_theta = strands
                    .tangent(hit.segment, hit.s)
                    .cross(direction)
                    .length();
                let skip = Skip::leaving(
                    hit.strand,
                    strands.radius(hit.segment, hit.s),
                    cos_theta,
                    Meet::Axis,
                );
                Ray {
                    skip: Some(skip),
                    ..Ray::new(strands.position(hit.segment, hit.s), direction)
                }
            })
            .collect();
        secondary.extend(&last);
    }
    [primary, secondary]
}

/// Returns the nodes and blocks that a search visits per ray.
fn visits(tree: &Tree, rays: &[Ray]) -> [f64; 2] {
    let mut visits = Visits::default();
    for ray in rays {
        let closest = tree.closest_counted(ray, &mut visits);
        assert_eq!(
            tree.occluded(ray),
            closest.is_some(),
            "any hit and the closest: {ray:?}"
        );
    }
    [visits.nodes, visits.blocks].map(|n| n as f64 / rays.len() as f64)
}

/// Checks work in place of time. A change of more than 3 % must be intended, and recorded here.
#[test]
fn rays_look_at_as_much_as_recorded() {
    let strands = Groom::new(Kind::Wavy, 1000)
        .grow(&Flattening::default())
        .expect("settings in range");
    let tree = Tree::build(&strands).expect("a head");
    let per_ray = rays(&strands, &tree, 128, 1).map(|rays| visits(&tree, &rays));
    let recorded = [[5.640, 2.214], [9.711, 5.031]];
    for (got, recorded) in per_ray.iter().flatten().zip(recorded.iter().flatten()) {
        assert!(
            (got / recorded - 1.0).abs() < 0.03,
            "{per_ray:?} nodes and blocks per primary and secondary ray"
        );
    }
}

/// Prints the numbers that `benches/records/rays.csv` records.
#[test]
#[ignore = "slow: half a minute, and its figures mean something with --release only"]
fn rays_per_second() {
    println!(
        "groom,strands,segments,build s,bytes/segment,rays,nodes/ray,blocks/ray,Mrays/s closest,Mrays/s any"
    );
    for (kind, strands) in [
        (Kind::Wavy, 30_000),
        (Kind::Straight, 100_000),
        (Kind::Curly, 30_000),
        (Kind::Fur, 100_000),
    ] {
        let hair = Groom::new(kind, strands)
            .grow(&Flattening::default())
            .expect("settings in range");
        let start = Instant::now();
        let tree = Tree::build(&hair).expect("a head");
        let build = start.elapsed().as_secs_f64();
        let bytes = tree.memory() as f64 / hair.segments() as f64;
        for (which, rays) in ["primary", "secondary"]
            .iter()
            .zip(rays(&hair, &tree, 384, 3))
        {
            let fastest = |mut search: Box<dyn FnMut(&Ray) -> bool + '_>| {
                let run = |_| {
                    let start = Instant::now();
                    let hits = rays.iter().filter(|ray| search(ray)).count();
                    assert!(hits > rays.len() / 5, "{hits} hits");
                    rays.len() as f64 * 1e-6 / start.elapsed().as_secs_f64()
                };
                (0..5).map(run).fold(0.0, f64::max)
            };
            let closest = fastest(Box::new(|ray| tree.closest(ray).is_some()));
            let any = fastest(Box::new(|ray| tree.occluded(ray)));
            let [nodes, blocks] = visits(&tree, &rays);
            println!(
                "{},{strands},{},{build:.2},{bytes:.1},{which},{nodes:.1},{blocks:.1},{closest:.3},{any:.3}",
                kind.name(),
                hair.segments()
            );
        }
    }
}
