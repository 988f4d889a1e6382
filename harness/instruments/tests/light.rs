//! Tests of every light against its own density, and of environment maps against files.

mod environment;
mod files;
mod inversion;
mod maps;
mod radiance;
mod rectangle;
mod sky;

use core::f64::consts::PI;
use glam::DVec3;
use hairis_conformance::statistics::chi_square;
use hairis_instruments::light::{
    Constant, Environment, Light, LightError, PixelRepairs, Rectangle, Sky, Smooth, Sun, luminance,
    rounded, tangents,
};
use hairis_instruments::quadrature::{SphereIntegrator, Tolerance};
use hairis_instruments::sequence::{Independent, XiSource, stream_id};
use hairis_instruments::stats::{Moments, sidak};

/// Returns a map of 16 x 8 texels with a black row, a black column and values from 1 to 500, so that every branch of the sampling is
/// taken.
fn small_map() -> Environment {
    let mut xi = Independent::new(77, 0);
    let pixels = (0..128)
        .map(|k| {
            let [a, b, c] = xi.next_xi_f32::<3>();
            let sun = if k == 37 { 500.0 } else { 1.0 };
            if k / 16 == 2 || k % 16 == 5 {
                [0.0; 3]
            } else {
                [sun * a, sun * b, sun * c]
            }
        })
        .collect();
    Environment::from_pixels("small", 16, 8, pixels).expect("valid")
}

fn lights() -> Vec<Box<dyn Light>> {
    vec![
        Box::new(Constant),
        Box::new(Smooth),
        Box::new(Sun::five_degrees(DVec3::new(0.4, 0.7, -0.3))),
        Box::new(Sun::five_degrees(-DVec3::Z)),
        Box::new(Rectangle),
        Box::new(small_map()),
        Box::new(Environment::from_pixels("black", 4, 2, vec![[0.0; 3]; 8]).expect("valid")),
    ]
}

/// Returns the integral of the radiance of a map: the sum over texels of radiance times solid angle.
fn total_radiance(map: &Environment) -> [f64; 3] {
    let [width, height] = map.size();
    let mut sum = [0.0; 3];
    for (i, j) in (0..height).flat_map(|j| (0..width).map(move |i| (i, j))) {
        let edge = |j: usize| (PI * j as f64 / height as f64).cos();
        let solid_angle = 2.0 * PI / width as f64 * (edge(j) - edge(j + 1));
        let [polar, turn] = [
            PI * (j as f64 + 0.5) / height as f64,
            2.0 * PI * ((i as f64 + 0.5) / width as f64 - 0.5),
        ];
        let dir = DVec3::new(
            polar.sin() * turn.sin(),
            polar.cos(),
            -polar.sin() * turn.cos(),
        );
        sum = [0, 1, 2].map(|c: usize| sum[c] + map.radiance(dir)[c] * solid_angle);
    }
    sum
}

fn tight() -> SphereIntegrator {
    SphereIntegrator::new().with_tolerance(Tolerance::relative(1e-10))
}

#[test]
fn densities_integrate_to_one_over_their_support() {
    for light in lights() {
        // The reference integral is that of radiance times f: with f = pdf / radiance it is the mass where the light shines.
        let f = |dir: DVec3| {
            light
                .radiance(dir)
                .map(|l| if l > 0.0 { light.pdf(dir) / l } else { 0.0 })
        };
        let mass = light.integrate(&f, &tight()).value;
        let dark = light.integrate(&|_| [1.0; 3], &tight()).value;
        for c in 0..3 {
            if dark[c] > 0.0 {
                assert!((mass[c] - 1.0).abs() < 1e-8, "{}: {mass:?}", light.name());
            }
        }
    }
}

#[test]
fn densities_integrate_to_one_over_the_sphere() {
    // A plain midpoint sum that uses nothing of what a light states about itself. Its error comes from counting cells on the rims: the
    // sun has about 4800 cells.
    let (rows, columns) = (1_000, 2_000);
    for light in lights() {
        let mut mass = 0.0;
        for j in 0..rows {
            let y = 1.0 - 2.0 * (f64::from(j) + 0.5) / f64::from(rows);
            let r = (1.0 - y * y).sqrt();
            for i in 0..columns {
                let phi = 2.0 * PI * (f64::from(i) + 0.5) / f64::from(columns);
                mass += light.pdf(DVec3::new(r * phi.cos(), y, r * phi.sin()));
            }
        }
        mass *= 4.0 * PI / f64::from(rows * columns);
        assert!((mass - 1.0).abs() < 0.01, "{}: {mass}", light.name());
    }
}

#[test]
fn eight_lanes_see_what_one_sees() {
    let mut xi = Independent::new(5, 0);
    for light in lights() {
        let (mut far, mut lit) = (0, 0);
        for k in 0..2_500 {
            // Half of the directions are drawn from the light, so that small lights are hit.
            let dirs: [DVec3; 8] = core::array::from_fn(|lane| {
                if lane % 2 == 0 {
                    light.sample(xi.next_xi()).dir
                } else {
                    Constant.sample(xi.next_xi()).dir
                }
            });
            let seen = light.see8(&dirs.map(|dir| dir.as_vec3()).into());
            for (lane, dir) in dirs.into_iter().enumerate() {
                let (radiance, pdf) = (light.radiance(dir), light.pdf(dir));
                let got = seen.radiance.map(|c| f64::from(c.as_array()[lane]));
                let close = |a: f64, b: f64| (a - b).abs() <= 2e-5 * b.abs();
                let same = close(f64::from(seen.pdf.as_array()[lane]), pdf)
                    && got.iter().zip(radiance).all(|(a, b)| close(*a, b));
                // Rounding may carry a direction across an edge.
                far += i32::from(!same);
                lit += i32::from(radiance[0] > 0.0);
                assert!(
                    got.iter().all(|c| c.is_finite() && *c >= 0.0),
                    "{}: {got:?} at {k}",
                    light.name()
                );
            }
        }
        assert!(far <= 4, "{}: {far} of 20000 differ", light.name());
        assert!(
            lit > 5_000 || light.name() == "black",
            "{}: only {lit} saw it",
            light.name()
        );
    }
}

#[test]
fn maps_are_told_apart_by_their_digest() {
    let map = small_map();
    let pixels = |k: usize| {
        let mut pixels = vec![[1.0_f32; 3]; 8];
        pixels[k][1] = 2.0;
        pixels
    };
    let of = |w, h, pixels| {
        Environment::from_pixels("m", w, h, pixels)
            .expect("valid")
            .digest()
    };
    assert_eq!(map.digest(), small_map().digest());
    assert_eq!(of(4, 2, pixels(3)), of(4, 2, pixels(3)));
    assert_ne!(of(4, 2, pixels(3)), of(4, 2, pixels(4)), "another pixel");
    assert_ne!(of(4, 2, pixels(3)), of(2, 4, pixels(3)), "another shape");
}

#[test]
fn samples_agree_with_radiance_and_density() {
    let last = 1.0 - f64::EPSILON / 2.0;
    for (k, light) in lights().iter().enumerate() {
        let mut xi = Independent::new(1, stream_id(&[1, k as u64]));
        let edges = [0.0, 1e-300, 0.25, 0.5, 0.75, last];
        let corners = edges
            .iter()
            .flat_map(|&a| edges.iter().map(move |&b| [a, b]));
        let random: Vec<[f64; 2]> = (0..20_000).map(|_| xi.next_xi()).collect();
        for xi in corners.chain(random) {
            let s = light.sample(xi);
            assert!(
                (s.dir.length() - 1.0).abs() < 1e-14,
                "{}: {xi:?} {s:?}",
                light.name()
            );
            assert!(
                s.pdf.is_finite() && s.pdf > 0.0,
                "{}: {xi:?} {s:?}",
                light.name()
            );
            assert_eq!(
                light.radiance(s.dir),
                s.radiance,
                "{}: {xi:?}",
                light.name()
            );
            assert!(
                (light.pdf(s.dir) / s.pdf - 1.0).abs() < 1e-12,
                "{}: {xi:?} {s:?}",
                light.name()
            );
            // Length does not matter.
            assert!(
                (light.pdf(s.dir * 2.0) / s.pdf - 1.0).abs() < 1e-12,
                "{}: {xi:?} {s:?}",
                light.name()
            );
            assert_eq!(
                light.radiance(s.dir * 2.0),
                s.radiance,
                "{}: {xi:?}",
                light.name()
            );
        }
    }
}

#[test]
fn estimates_equal_the_quadrature_of_radiance() {
    // Against f = 1 and against a tilted f, so that a density that is right in total but wrong in place is detected.
    let fs: [fn(DVec3) -> [f64; 3]; 2] = [
        |_| [1.0; 3],
        |d| [1.0 + 0.9 * d.x, (d.z - 0.2).powi(2), (2.0 * d.y).exp()],
    ];
    for (k, light) in lights().iter().enumerate() {
        for (tilt, f) in fs.iter().enumerate() {
            let truth = light.integrate(&f, &tight());
            let mut xi = Independent::new(2, stream_id(&[k as u64, tilt as u64]));
            let mut moments = [Moments::new(); 3];
            for _ in 0..200_000 {
                let s = light.sample(xi.next_xi());
                let y = f(s.dir);
                for c in 0..3 {
                    moments[c].push(s.radiance[c] * y[c] / s.pdf);
                }
            }
            for (c, m) in moments.iter().enumerate() {
                let e = m.mean_estimate();
                let slack = 1e-9 * truth.value[c].abs();
                assert!(
                    (e.value - truth.value[c]).abs() <= 4.0 * e.standard_error + slack,
                    "{} f{tilt} channel {c}: {e:?}, want {:?}",
                    light.name(),
                    truth.value
                );
            }
        }
    }
}

#[test]
fn reference_integrals_have_closed_forms() {
    let one = |_: DVec3| [1.0; 3];
    let constant = Constant.integrate(&one, &tight()).value;
    assert!(
        constant.iter().all(|v| (v - 4.0 * PI).abs() < 1e-10),
        "{constant:?}"
    );
    let smooth = Smooth.integrate(&one, &tight()).value;
    for (v, mean) in smooth.iter().zip([1.0, 0.9, 0.8]) {
        assert!((v - 4.0 * PI * mean).abs() < 1e-9, "{smooth:?}");
    }
    let sun = Sun::five_degrees(DVec3::X).integrate(&one, &tight()).value;
    assert!(sun.iter().all(|v| (v - 1.0).abs() < 1e-10), "{sun:?}");
    let area = Rectangle;
    let got = area.integrate(&one, &tight());
    assert!(
        got.converged && (got.value[0] / area.solid_angle() - 1.0).abs() < 1e-10,
        "{got:?}"
    );
    let map = small_map();
    let got = map.integrate(&one, &tight()).value;
    for (v, want) in got.iter().zip(total_radiance(&map)) {
        assert!((v / want - 1.0).abs() < 1e-12, "{got:?}");
    }
}

/// Returns the p-value of a chi-square test of samples, each of which `cell` sorts into a cell, against the `mass` of each cell.
fn fit(light: &dyn Light, stream: u64, mass: &[f64], cell: impl Fn(DVec3) -> usize) -> f64 {
    let n = 1_000_000;
    let mut counts = vec![0_u64; mass.len()];
    let mut xi = Independent::new(3, stream);
    for _ in 0..n {
        counts[cell(light.sample(xi.next_xi()).dir)] += 1;
    }
    let total: f64 = mass.iter().sum();
    assert!(
        (total - 1.0).abs() < 1e-9,
        "{}: the cells hold {total}",
        light.name()
    );
    let expected: Vec<f64> = mass.iter().map(|m| m * f64::from(n)).collect();
    chi_square(&counts, &expected, 5.0).p_value
}

fn bin(x: f64, n: usize) -> usize {
    (0..n)
        .rev()
        .find(|&i| x >= i as f64 / n as f64)
        .unwrap_or(0)
}

#[test]
fn samples_follow_their_density() {
    let level = sidak(0.01, 6);
    let n = 24;
    let even = vec![1.0 / (n * n) as f64; n * n];
    let turn = |a: f64, b: f64| bin(0.5 + a.atan2(b) / (2.0 * PI), n);
    let p = fit(&Constant, 0, &even, |d| {
        bin(0.5 + 0.5 * d.y, n) * n + turn(d.x, d.z)
    });
    assert!(p > level, "constant: {p}");
    // Smooth: bands of equal height hold the integral of its linear density.
    let smooth = Smooth;
    let axis = DVec3::new(0.36, 0.80, 0.48).normalize();
    let slope = 4.0 * PI * smooth.pdf(axis) - 1.0;
    let mass: Vec<f64> = (0..n * n)
        .map(|k| {
            let t = -1.0 + 2.0 * ((k / n) as f64 + 0.5) / n as f64;
            (1.0 + slope * t) / (n * n) as f64
        })
        .collect();
    let [e1, e2] = tangents(axis);
    let p = fit(&smooth, 1, &mass, |d| {
        bin(0.5 + 0.5 * d.dot(axis), n) * n + turn(d.dot(e1), d.dot(e2))
    });
    assert!(p > level, "smooth: {p}");
    let sun = Sun::five_degrees(DVec3::new(0.4, 0.7, -0.3));
    let axis = DVec3::new(0.4, 0.7, -0.3).normalize();
    let [e1, e2] = tangents(axis);
    let height = 1.0 - 2.5_f64.to_radians().cos();
    let p = fit(&sun, 2, &even, |d| {
        bin(0.5 * (d - axis).length_squared() / height, n) * n + turn(d.dot(e1), d.dot(e2))
    });
    assert!(p > level, "sun: {p}");
    let light = Rectangle;
    let mass: Vec<f64> = (0..n * n)
        .map(|k| {
            let x = |i: usize| 4.0 * (i as f64 / n as f64 - 0.5);
            let z = |j: usize| j as f64 / n as f64 - 0.5;
            let corner = |x: f64, z: f64| (x * z).atan2((x * x + z * z + 1.0).sqrt());
            let (i, j) = (k / n, k % n);
            (corner(x(i + 1), z(j + 1)) - corner(x(i), z(j + 1)) - corner(x(i + 1), z(j))
                + corner(x(i), z(j)))
                / light.solid_angle()
        })
        .collect();
    let p = fit(&light, 4, &mass, |d| {
        bin(0.5 + 0.25 * d.x / d.y, n) * n + bin(0.5 + d.z / d.y, n)
    });
    assert!(p > level, "{}: {p}", light.name());
    // The map: four cells per texel, so that the spread within a texel is tested too.
    let map = small_map();
    let (w, h) = (32, 16);
    let polar = |j: usize| (PI * j as f64 / h as f64).cos();
    let mass: Vec<f64> = (0..w * h)
        .map(|k| {
            let (theta, phi) = (
                PI * ((k / w) as f64 + 0.5) / h as f64,
                2.0 * PI * (((k % w) as f64 + 0.5) / w as f64 - 0.5),
            );
            let dir = DVec3::new(
                theta.sin() * phi.sin(),
                theta.cos(),
                -theta.sin() * phi.cos(),
            );
            map.pdf(dir) * 2.0 * PI / w as f64 * (polar(k / w) - polar(k / w + 1))
        })
        .collect();
    let p = fit(&map, 5, &mass, |d| {
        bin(d.y.clamp(-1.0, 1.0).acos() / PI, h) * w + bin(0.5 + d.x.atan2(-d.z) / (2.0 * PI), w)
    });
    assert!(p > level, "environment: {p}");
}
