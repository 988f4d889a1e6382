//! Tests of the orientation of environment maps, of repairs, and of degenerate maps.

use super::*;

#[test]
fn rows_run_from_the_zenith_and_columns_from_behind() {
    // Four columns seen from above: +z to +x side, ... the middle is -z, a quarter to its right is +x.
    let pixels: Vec<[f32; 3]> = (1..=8_u8).map(|k| [f32::from(k); 3]).collect();
    let map = Environment::from_pixels("eight", 4, 2, pixels).expect("valid");
    let value = |x, y, z| map.radiance(DVec3::new(x, y, z))[0];
    assert_eq!(
        [
            value(-0.1, 1.0, 0.2),
            value(-0.1, 1.0, -0.2),
            value(0.1, 1.0, -0.2),
            value(0.1, 1.0, 0.2)
        ],
        [1.0, 2.0, 3.0, 4.0]
    );
    assert_eq!([value(-0.1, -1.0, 0.2), value(0.1, -1.0, -0.2)], [5.0, 7.0]);
    // The poles, the seam and a vector without direction lead to a texel, not to a panic.
    for d in [
        DVec3::Y,
        -DVec3::Y,
        DVec3::Z,
        DVec3::new(-0.0, 0.0, 1.0),
        DVec3::ZERO,
        DVec3::NAN,
        DVec3::INFINITY,
    ] {
        assert!(map.radiance(d)[0] >= 1.0, "{d}");
        assert!(map.pdf(d) > 0.0, "{d}");
    }
}

#[test]
fn bad_pixels_are_repaired_counted_and_noted() {
    let pixels = vec![
        [f32::NAN, 1.0, f32::INFINITY],
        [-1.0, f32::NEG_INFINITY, 2.0],
        [-0.0, 0.0, f32::MAX],
    ];
    let map = Environment::from_pixels("bad", 3, 1, pixels).expect("valid");
    assert_eq!(
        map.repairs(),
        PixelRepairs {
            nan: 1,
            negative: 2,
            infinite: 1
        }
    );
    assert_eq!(map.notes().len(), 2, "shape and repairs: {:?}", map.notes());
    assert!(map.notes().iter().all(|n| n.starts_with("bad: ")));
    for k in 0..100 {
        let s = map.sample([f64::from(k) / 100.0, 0.5]);
        assert!(s.pdf.is_finite() && s.radiance.iter().all(|v| v.is_finite() && *v >= 0.0));
    }
}

#[test]
fn black_maps_are_sampled_uniformly() {
    let map = Environment::from_pixels("black", 4, 2, vec![[0.0; 3]; 8]).expect("valid");
    assert!(map.is_black() && map.notes() == ["black: the map is black"]);
    let s = map.sample([0.3, 0.6]);
    assert_eq!((s.pdf, s.radiance), (0.25 / PI, [0.0; 3]));
}

#[test]
fn sizes_are_checked() {
    assert!(Environment::from_pixels("x", 0, 2, vec![]).is_err());
    assert!(Environment::from_pixels("x", 2, 0, vec![]).is_err());
    assert!(Environment::from_pixels("x", 2, 1, vec![[0.0; 3]]).is_err());
    assert!(Environment::from_pixels("x", usize::MAX, 2, vec![]).is_err());
    let one = Environment::from_pixels("one", 1, 1, vec![[2.0; 3]]).expect("valid");
    assert!((one.pdf(DVec3::X) - 0.25 / PI).abs() < 1e-15);
}

#[test]
fn black_texels_are_never_drawn() {
    let map = small_map();
    let mut xi = Independent::new(4, 0);
    for _ in 0..200_000 {
        assert!(luminance(map.sample(xi.next_xi()).radiance) > 0.0);
    }
}

#[test]
fn sky_estimates_match_its_sum() {
    let map = Sky::default().environment();
    let mut xi = Independent::new(6, 0);
    let mut moments = [Moments::new(); 3];
    for _ in 0..100_000 {
        let s = map.sample(xi.next_xi());
        for (m, radiance) in moments.iter_mut().zip(s.radiance) {
            m.push(radiance / s.pdf);
        }
    }
    for (m, want) in moments.iter().zip(total_radiance(&map)) {
        assert!(
            m.mean_estimate().z_score(want).abs() < 4.0,
            "{:?} {want}",
            m.mean_estimate()
        );
    }
}

/// Returns radiance and density, rounded to single precision, as bits.
fn bits(radiance: [f64; 3], pdf: f64) -> [u32; 4] {
    let [r, g, b] = radiance;
    [r, g, b, pdf].map(|x| rounded(x).to_bits())
}

#[test]
fn eight_lanes_find_the_texels_of_one() {
    let mut xi = Independent::new(8, 0);
    for [width, height] in [
        [1, 1],
        [3, 1],
        [1, 4],
        [7, 5],
        [16, 8],
        [1024, 512],
        [4096, 2048],
    ] {
        let pixels = (0..width * height).map(|_| xi.next_xi_f32::<3>()).collect();
        let map = Environment::from_pixels("random", width, height, pixels).expect("valid");
        let mut dirs: Vec<DVec3> = (0..40_000)
            .map(|_| Constant.sample(xi.next_xi()).dir)
            .collect();
        // Corners of texels, rounded to either side; meridians and parallels; the poles and their neighbourhood.
        for k in 0..20_000 {
            let [a, b] = xi.next_xi::<2>();
            let whole = |x: f64, n: usize| {
                if k % 3 == 0 {
                    x
                } else {
                    (x * n as f64).floor() / n as f64
                }
            };
            let (turn, polar) = (2.0 * PI * (whole(a, width) - 0.5), PI * whole(b, height));
            dirs.push(DVec3::new(
                polar.sin() * turn.sin(),
                polar.cos(),
                -polar.sin() * turn.cos(),
            ));
        }
        for (x, y, z) in [
            (0, 0, 1),
            (0, 1, 0),
            (1, 0, 0),
            (1, 0, 1),
            (1, 1, 0),
            (0, 1, 1),
            (0, 0, 0),
        ] {
            let zero_or =
                |is: i32, sign: u32| f64::from(is).copysign(if sign % 2 == 1 { -1.0 } else { 1.0 });
            for signs in 0..8 {
                let axis = DVec3::new(
                    zero_or(x, signs),
                    zero_or(y, signs / 2),
                    zero_or(z, signs / 4),
                );
                let tiny = DVec3::new(zero_or(1, signs), 0.0, zero_or(1, signs / 4));
                dirs.extend([
                    axis,
                    axis + 1e-7 * tiny,
                    axis + 1e-20 * tiny,
                    axis + 1e-40 * tiny,
                    axis + 1e-45 * tiny,
                ]);
            }
        }
        dirs.extend([
            DVec3::NAN,
            DVec3::INFINITY,
            DVec3::NEG_INFINITY,
            DVec3::new(f64::NAN, 1.0, 0.0),
        ]);
        for eight in dirs.chunks(8) {
            let eight: [glam::Vec3; 8] =
                core::array::from_fn(|lane| eight[lane % eight.len()].as_vec3());
            let seen = map.see8(&eight.into());
            for (lane, dir) in eight.into_iter().enumerate() {
                let [r, g, b] = seen
                    .radiance
                    .map(|channel| channel.as_array()[lane].to_bits());
                let expected = bits(map.radiance(dir.as_dvec3()), map.pdf(dir.as_dvec3()));
                assert_eq!(
                    [r, g, b, seen.pdf.as_array()[lane].to_bits()],
                    expected,
                    "{width} x {height}: {dir}"
                );
            }
        }
    }
}

#[test]
fn samples_have_the_texel_of_their_direction() {
    let mut xi = Independent::new(9, 0);
    for [width, height] in [[1, 1], [5, 3], [1024, 512]] {
        let pixels = (0..width * height).map(|_| xi.next_xi_f32::<3>()).collect();
        let map = Environment::from_pixels("random", width, height, pixels).expect("valid");
        for _ in 0..100_000 {
            let sample = map.sample(xi.next_xi());
            assert_eq!(
                (sample.radiance, sample.pdf),
                (map.radiance(sample.dir), map.pdf(sample.dir)),
                "{sample:?}"
            );
        }
    }
}
