//! Tests of a ray against a segment.

use glam::{DVec3, Vec3};
use hairis_render::geometry::{Builder, Strands};
use hairis_render::tree::{Meet, Ray, Tree};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

fn cone(start: Vec3, end: Vec3, radii: [f32; 2]) -> Strands {
    let mut builder = Builder::default();
    builder
        .push([(start, radii[0]), (end, radii[1])])
        .expect("a cone");
    builder.finish()
}

#[test]
fn offset_has_the_sign_of_the_kernels() {
    let tree = Tree::build(&cone(Vec3::NEG_X, Vec3::X, [0.1, 0.1])).expect("a small scene");
    let frame = hairis::FiberFrame {
        u: Vec3::X,
        v: Vec3::Y,
        w: Vec3::Z,
    };
    for z in [-0.09_f32, -0.02, 0.0, 0.05, 0.08] {
        let hit = tree
            .closest(&Ray::new(Vec3::new(0.5, 2.0, z), Vec3::NEG_Y))
            .expect("within the radius");
        let normal = Vec3::new(0.0, (0.01 - z * z).sqrt(), z);
        let expected = frame.offset(normal, Vec3::Y);
        assert!(
            (hit.h - expected).abs() < 1e-5,
            "at z = {z}: {} and {expected}",
            hit.h
        );
        assert!(
            (hit.t - 2.0).abs() < 1e-6 && (hit.s - 0.75).abs() < 1e-6,
            "{hit:?}"
        );
    }
}

#[test]
fn tubes_are_met_where_rays_enter_them() {
    // Joints are nowhere special: some of the rays pass close to one.
    let mut builder = Builder::default();
    let nodes = [-2.0, -0.5, 0.0, 0.2, 0.25, 0.5, 2.0].map(|x| (Vec3::new(x, 0.0, 0.0), 0.1));
    builder.push(nodes).expect("a tube");
    let tree = Tree::build(&builder.finish()).expect("a small scene");
    let tree = tree.with_meet(Meet::Surface);
    let slants = [0.0, 0.5, 1.0, 2.0, -3.0, -5.0];
    let places = [0.0_f32, 0.06, -0.099];
    for (slant, z) in slants
        .into_iter()
        .flat_map(|slant| places.map(|z| (slant, z)))
    {
        let direction = Vec3::new(slant, -1.0, 0.0).normalize();
        let through = Vec3::new(0.2, 0.0, z);
        let hit = tree
            .closest(&Ray::new(through - 2.0 * direction, direction))
            .expect("within the radius");
        let point = through + (hit.t - 2.0) * direction;
        let enters = Vec3::new(point.x, (0.01 - z * z).sqrt(), z);
        assert!(point.distance(enters) < 1e-5, "{slant} {z}: {point}");
        // From there, and from within, the tube is not met again.
        for start in [point, point + 0.001 * direction] {
            for to in [direction, Vec3::Y, Vec3::new(0.9, 0.3, -0.3).normalize()] {
                let ray = Ray::new(start + 1e-4 * to, to);
                assert_eq!(tree.closest(&ray), None, "{start} {to}");
            }
        }
    }
}

/// Finds the nearest points of two lines in closed form from both conditions of perpendicularity: distance along the ray, place on
/// the segment, signed offset across it, and how far the lines are apart beyond the radius there.
fn nearest(
    start: DVec3,
    edge: DVec3,
    radii: [f64; 2],
    origin: DVec3,
    direction: DVec3,
) -> [f64; 4] {
    let between = origin - start;
    let (aa, ab, bb) = (
        direction.dot(direction),
        direction.dot(edge),
        edge.dot(edge),
    );
    let (ac, bc) = (direction.dot(between), edge.dot(between));
    let s = ((aa * bc - ab * ac) / (aa * bb - ab * ab)).clamp(0.0, 1.0);
    let t = (s * ab - ac) / aa;
    let offset = origin + t * direction - (start + s * edge);
    let side = edge.cross(direction).normalize().dot(offset);
    [
        t,
        s,
        side,
        offset.length() - (radii[0] + s * (radii[1] - radii[0])),
    ]
}

#[test]
fn hits_are_those_of_the_closed_form() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut number = || (random.next_u32() >> 8) as f32 / (1 << 24) as f32;
    let mut vector = || 2.0 * Vec3::new(number(), number(), number()) - 1.0;
    let (mut hits, mut misses, mut grazing) = (0, 0, 0);
    let mut worst = [0.0_f64; 3];
    for i in 0..100_000 {
        let (start, end) = (vector(), vector());
        let radii = if i % 2 == 0 {
            [0.05; 2]
        } else {
            [0.08 * vector().x.abs(), 0.08 * vector().x.abs()]
        };
        // Near and far: up to 100 times the length.
        let away = 10.0_f32.powf(1.0 + vector().x);
        let direction = vector().normalize();
        let target = start + (0.5 + 0.6 * vector().x) * (end - start) + 0.1 * vector();
        let origin = target - away * direction;
        let (edge, along) = ((end - start).as_dvec3(), direction.as_dvec3().normalize());
        let [t, s, side, gap] = nearest(
            start.as_dvec3(),
            edge,
            radii.map(f64::from),
            origin.as_dvec3(),
            along,
        );
        let hit = Tree::build(&cone(start, end, radii))
            .ok()
            .and_then(|tree| tree.closest(&Ray::new(origin, direction)));
        let distance = t.abs().max(1.0);
        if gap.abs() < distance * 0.5_f64.powi(20) {
            grazing += 1;
            continue;
        }
        assert_eq!(
            hit.is_some(),
            gap < 0.0 && t > 0.0,
            "ray {i}: gap {gap}, t {t}, {hit:?}"
        );
        let Some(hit) = hit else {
            misses += 1;
            continue;
        };
        hits += 1;
        let radius = f64::from(radii[0]) + s * f64::from(radii[1] - radii[0]);
        // A ray along the segment meets it nowhere in particular: places are as sure as the ray crosses it.
        let sine = edge.normalize().cross(along).length();
        let off = [
            (f64::from(hit.t) - t).abs() * sine,
            (f64::from(hit.s) - s).abs() * edge.length() * sine,
            (f64::from(hit.h) - side / radius).abs() * radius,
        ];
        for (worst, off) in worst.iter_mut().zip(off) {
            *worst = worst.max(off / distance);
        }
    }
    assert!(
        hits > 20_000 && misses > 20_000 && grazing < 80,
        "{hits} hits, {misses} misses, {grazing} grazing"
    );
    assert!(
        worst.iter().all(|&worst| worst < 1e-6),
        "t, s and h are off by {worst:?} of the distance"
    );
}
