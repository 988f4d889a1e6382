//! Tests of `tree::triangles`.

use glam::{DVec3, Vec3};
use hairis_instruments::sequence::{Independent, XiSource as _};
use hairis_render::geometry::Mesh;
use hairis_render::lights::uniform_direction;
use hairis_render::tree::{MeshTree, Ray};

/// A ball of triangles about a place, of radius 1.
fn ball(rings: u32, centre: Vec3) -> Mesh {
    let around = 2 * rings;
    let place = |ring: u32, k: u32| {
        let theta = core::f32::consts::PI * ring as f32 / rings as f32;
        let phi = core::f32::consts::TAU * (k % around) as f32 / around as f32;
        let across = if ring.is_multiple_of(rings) {
            0.0
        } else {
            theta.sin()
        };
        centre + Vec3::new(across * phi.cos(), theta.cos(), across * phi.sin())
    };
    let places = (0..=rings).flat_map(|ring| (0..around).map(move |k| place(ring, k)));
    let number = |ring: u32, k: u32| ring * around + k % around;
    let quads = (0..rings).flat_map(|ring| (0..around).map(move |k| (ring, k)));
    let triangles = quads.flat_map(|(ring, k)| {
        let [a, b] = [number(ring, k), number(ring, k + 1)];
        let [c, d] = [number(ring + 1, k), number(ring + 1, k + 1)];
        [[a, b, c], [b, d, c]]
    });
    Mesh::new(places.collect(), triangles.collect()).expect("a ball")
}

/// Returns the distance in `f64`, and how far inside its edges the triangle is met, as parts of its
/// heights.
fn meet(corners: [Vec3; 3], ray: &Ray) -> (f64, f64) {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let normal = (b - a).cross(c - a);
    let t = normal.dot(a - origin) / normal.dot(direction);
    let p = origin + t * direction;
    let side = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(normal) / normal.length_squared();
    (t, side(a, b).min(side(b, c)).min(side(c, a)))
}

#[test]
fn the_tree_finds_what_a_search_of_all_finds() {
    let mesh = ball(24, Vec3::new(3.0, -2.0, 1.0));
    let tree = MeshTree::build(&mesh);
    let mut xi = Independent::new(2, 0);
    let (mut met, mut unclear) = (0, 0);
    for turn in 0..4000 {
        let centre = Vec3::new(3.0, -2.0, 1.0);
        let away = uniform_direction(xi.next_xi_f32());
        let origin = centre + [0.3, 5.0, 60.0][turn % 3] * away;
        let aim = centre + 1.1 * uniform_direction(xi.next_xi_f32());
        let ray = Ray {
            t_max: if turn % 5 == 0 { 4.0 } else { f32::INFINITY },
            ..Ray::new(origin, (aim - origin).normalize())
        };
        let all = (0..)
            .take(mesh.triangles())
            .map(|k| meet(mesh.corners(k), &ray));
        let ahead = all.filter(|(t, _)| *t > 0.0 && *t < f64::from(ray.t_max));
        let (sure, near): (Vec<_>, Vec<_>) = ahead
            .filter(|(_, inside)| *inside > -1e-3)
            .partition(|(_, inside)| *inside > 1e-3);
        let nearest = sure.iter().map(|hit| hit.0).fold(f64::INFINITY, f64::min);
        assert_eq!(tree.closest(&ray).is_some(), tree.occluded(&ray), "{ray:?}");
        match tree.closest(&ray) {
            Some((t, triangle)) if near.is_empty() => {
                // Off the surface by some roundings of the distance: along a ray that grazes it by more.
                let cos = f64::from(mesh.normal(triangle).dot(ray.direction).abs());
                let off = cos * (f64::from(t) - nearest).abs();
                let bound = 4.0 * f64::from(f32::EPSILON) * (1.0 + nearest);
                assert!(off < bound, "{t} for {nearest}, where cos is {cos}");
                met += 1;
            }
            None if near.is_empty() => assert!(sure.is_empty(), "{ray:?} is lost"),
            _ => unclear += 1,
        }
    }
    assert!(met > 2000 && unclear < 600, "{met} met, {unclear} at edges");
}

#[test]
fn no_ray_slips_between_triangles() {
    for (rings, distance) in [(8, 3.0), (200, 3.0), (60, 90.0)] {
        let centre = Vec3::new(1.0, 7.0, -3.0);
        let mesh = ball(rings, centre);
        let tree = MeshTree::build(&mesh);
        let mut xi = Independent::new(5, u64::from(rings));
        for _ in 0..3000 {
            // From outside through corners and edges, and from inside anywhere.
            let [pick, along, ..] = xi.next_xi_f32::<3>();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "below the count"
            )]
            let triangle = (0.999 * pick * mesh.triangles() as f32) as u32;
            let [a, b, _] = mesh.corners(triangle);
            let target = if along < 0.3 { a } else { a.lerp(b, along) };
            let outward = (target - centre).normalize();
            let tilt = 0.3 * uniform_direction(xi.next_xi_f32());
            let direction = (tilt - outward).normalize();
            let ray = Ray::new(target - distance * direction, direction);
            assert!(tree.occluded(&ray), "{ray:?} passes {target}");
            let inside = Ray::new(centre, uniform_direction(xi.next_xi_f32()));
            assert!(tree.occluded(&inside), "{inside:?} leaves");
        }
    }
}
