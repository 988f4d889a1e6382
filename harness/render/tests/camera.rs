//! Tests of `camera`.

use glam::Vec3;
use hairis_render::camera::Camera;

#[test]
fn rays_go_through_the_corners_of_the_view() {
    let camera = Camera::new(Vec3::new(0.0, 0.0, 10.0), Vec3::ZERO, 90.0, [200, 100]);
    assert!((camera.ray(100.0, 50.0).direction - Vec3::NEG_Z).length() < 1e-6);
    let corner = camera.ray(0.0, 0.0).direction;
    assert!(
        (corner - Vec3::new(-2.0, 1.0, -1.0).normalize()).length() < 1e-6,
        "{corner}"
    );
}

#[test]
fn a_mirrored_camera_sees_the_mirror_image() {
    let camera = Camera::new(
        Vec3::new(3.0, 1.0, 10.0),
        Vec3::new(1.0, 0.0, 0.0),
        40.0,
        [64, 48],
    );
    let (ray, other) = (camera.ray(10.0, 7.0), camera.mirrored().ray(54.0, 7.0));
    let mirror = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
    assert!(
        (mirror(ray.direction) - other.direction).length() < 1e-6
            && mirror(ray.origin) == other.origin
    );
}

#[test]
fn a_turned_camera_looks_from_the_side() {
    let camera = Camera::new(
        Vec3::new(1.0, 2.0, 13.0),
        Vec3::new(1.0, 2.0, 3.0),
        40.0,
        [64, 48],
    );
    let ray = camera.orbit(Vec3::new(1.0, 2.0, 3.0), 90.0).ray(32.0, 24.0);
    assert!(
        (ray.origin - Vec3::new(11.0, 2.0, 3.0)).length() < 1e-5,
        "{}",
        ray.origin
    );
    assert!(
        (ray.direction - Vec3::NEG_X).length() < 1e-6,
        "{}",
        ray.direction
    );
}

#[test]
fn looking_straight_down_is_possible() {
    let ray = Camera::new(Vec3::Y, Vec3::ZERO, 40.0, [10, 10]).ray(3.0, 3.0);
    assert!(ray.direction.is_normalized());
}
