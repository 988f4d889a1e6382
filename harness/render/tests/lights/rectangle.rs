//! Tests of `lights::rectangle`.

use glam::Vec3;
use hairis_conformance::statistics::chi_square;
use hairis_instruments::sequence::{Independent, XiSource as _};
use hairis_instruments::stats::Moments;
use hairis_render::lights::Rectangle;
use hairis_render::lights::RectangleSampling::{Area, SolidAngle};

fn tilted() -> Rectangle {
    let (a, b) = (
        Vec3::new(3.0, 1.0, 0.0),
        Vec3::new(-1.0, 3.0, 2.0)
            .cross(Vec3::new(3.0, 1.0, 0.0))
            .normalize(),
    );
    Rectangle::light(Vec3::new(-2.0, 2.0, 1.0), a, 1.5 * b, Vec3::ONE)
}

fn solid_angle(lamp: &Rectangle, origin: Vec3) -> f64 {
    1.0 / f64::from(
        lamp.view(origin, SolidAngle)
            .expect("in front")
            .pdf(Vec3::Y),
    )
}

#[test]
fn the_solid_angle_is_the_integral_over_the_area() {
    for origin in [
        Vec3::ZERO,
        Vec3::new(-1.0, 0.5, 0.7),
        Vec3::new(0.0, -300.0, 10.0),
    ] {
        let lamp = tilted();
        let [a, b] = lamp.edges();
        let mut sum = 0.0;
        let steps = 400;
        for i in 0..steps {
            for j in 0..steps {
                let part = |k: u16| (f32::from(k) + 0.5) / f32::from(steps);
                let towards = lamp.corner() + part(i) * a + part(j) * b - origin;
                let cos = f64::from(-towards.normalize().dot(lamp.normal()));
                sum += cos / f64::from(towards.length_squared());
            }
        }
        let area = f64::from(a.length() * b.length());
        let expected = sum * area / f64::from(steps).powi(2);
        let got = solid_angle(&lamp, origin);
        assert!(
            (got / expected - 1.0).abs() < 2e-4,
            "{origin}: {got} for {expected}"
        );
    }
}

#[test]
fn samples_follow_their_density() {
    let lamp = tilted();
    let origin = Vec3::new(-1.0, 0.5, 0.7);
    let whole = solid_angle(&lamp, origin);
    for sampling in [SolidAngle, Area] {
        // Share of a part of the rectangle, and of samples that fall on it.
        let mut expected = Vec::new();
        for i in 0..6 {
            for j in 0..6 {
                let share = |k: u16| f32::from(k) / 6.0;
                let corner =
                    lamp.corner() + share(i) * lamp.edges()[0] + share(j) * lamp.edges()[1];
                let [a, b] = lamp.edges().map(|edge| edge / 6.0);
                let part = Rectangle::light(corner, a, b, Vec3::ONE);
                let share = if sampling == Area {
                    1.0 / 36.0
                } else {
                    solid_angle(&part, origin) / whole
                };
                expected.push(60_000.0 * share);
            }
        }
        let mut counts = vec![0; 36];
        let mut inverse = Moments::new();
        let mut xi = Independent::new(5, 0);
        let view = lamp.view(origin, sampling).expect("in front");
        for _ in 0..60_000 {
            let sample = view.sample(xi.next_xi_f32());
            let place = origin + sample.distance * sample.direction - lamp.corner();
            let cell = |edge: Vec3| {
                (0..6_usize)
                    .rev()
                    .find(|k| place.dot(edge) / edge.length_squared() * 6.0 >= *k as f32)
            };
            counts[6 * cell(lamp.edges()[0]).unwrap_or(0) + cell(lamp.edges()[1]).unwrap_or(0)] +=
                1;
            // Rounding may put a sample of the rim outside.
            let on_rim = [lamp.edges()[0], lamp.edges()[1]].iter().any(|edge| {
                let share = place.dot(*edge) / edge.length_squared();
                share.min(1.0 - share) < 1e-5
            });
            let met = lamp.meet(origin, sample.direction, 0.0);
            assert!(
                on_rim || met.is_some_and(|t| (t / sample.distance - 1.0).abs() < 1e-4),
                "{sample:?} misses"
            );
            assert!(
                (view.pdf(sample.direction) / sample.pdf - 1.0).abs() < 1e-5,
                "{sample:?}"
            );
            inverse.push(1.0 / f64::from(sample.pdf));
        }
        let p = chi_square(&counts, &expected, 5.0).p_value;
        assert!(p > 1e-3, "{sampling:?}: p {p}");
        let mean = inverse.mean_estimate();
        let apart = (mean.value - whole).abs();
        assert!(
            apart < 4.0 * mean.standard_error + 1e-6 * whole,
            "{sampling:?}: {mean:?} for {whole}"
        );
    }
}

#[test]
fn a_tiny_solid_angle_has_the_density_of_its_area() {
    let lamp = Rectangle::light(
        Vec3::new(-1.0, 9000.0, -1.0),
        2.0 * Vec3::X,
        2.0 * Vec3::Z,
        Vec3::ONE,
    );
    let [by_angle, by_area] =
        [SolidAngle, Area].map(|sampling| lamp.view(Vec3::ZERO, sampling).expect("in front"));
    assert_eq!(by_angle.sample([0.25, 0.75]), by_area.sample([0.25, 0.75]));
    assert!((by_angle.pdf(Vec3::Y) / (9000.0_f32.powi(2) / 4.0) - 1.0).abs() < 1e-6);
    assert_eq!(by_area.pdf(Vec3::NEG_Y), 0.0);
}

#[test]
fn a_light_is_black_from_behind_and_mirrors() {
    let lamp = tilted();
    let behind = lamp.corner() - 5.0 * lamp.normal();
    let mirrored = lamp.mirrored();
    let mirror = |v: Vec3| Vec3::new(-v.x, v.y, v.z);
    for sampling in [SolidAngle, Area] {
        assert!(lamp.view(behind, sampling).is_none(), "{sampling:?}");
        let [a, b] = [
            lamp.view(Vec3::X, sampling),
            mirrored.view(Vec3::NEG_X, sampling),
        ]
        .map(Option::unwrap);
        let (a, b) = (a.sample([0.3, 0.6]), b.sample([0.7, 0.6]));
        assert!(
            (mirror(a.direction) - b.direction).length() < 1e-5,
            "{a:?} {b:?}"
        );
        assert!((a.pdf / b.pdf - 1.0).abs() < 1e-5, "{a:?} {b:?}");
    }
}
