//! Orientation, repairs and degenerate maps.

use super::*;

#[test]
fn rows_run_from_the_zenith_and_columns_from_behind() {
    // Four columns seen from above: +z to +x side, ... the middle is -z, a quarter to its right is +x.
    let pixels: Vec<[f32; 3]> = (1..=8_u8).map(|k| [f32::from(k); 3]).collect();
    let map = Environment::from_pixels("eight", 4, 2, pixels).expect("valid");
    let value = |x, y, z| map.radiance(DVec3::new(x, y, z))[0];
    assert_eq!(
        [value(-0.1, 1.0, 0.2), value(-0.1, 1.0, -0.2), value(0.1, 1.0, -0.2), value(0.1, 1.0, 0.2)],
        [1.0, 2.0, 3.0, 4.0]
    );
    assert_eq!([value(-0.1, -1.0, 0.2), value(0.1, -1.0, -0.2)], [5.0, 7.0]);
    // Poles, the seam and a direction that is none give a texel, not a panic.
    for d in [DVec3::Y, -DVec3::Y, DVec3::Z, DVec3::new(-0.0, 0.0, 1.0), DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
        assert!(map.radiance(d)[0] >= 1.0, "{d}");
        assert!(map.pdf(d) > 0.0, "{d}");
    }
}

#[test]
fn bad_pixels_are_repaired_counted_and_noted() {
    let pixels = vec![[f32::NAN, 1.0, f32::INFINITY], [-1.0, f32::NEG_INFINITY, 2.0], [-0.0, 0.0, f32::MAX]];
    let map = Environment::from_pixels("bad", 3, 1, pixels).expect("valid");
    assert_eq!(map.repairs(), PixelRepairs { nan: 1, negative: 2, infinite: 1 });
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
    for (m, want) in moments.iter().zip(map.total_radiance()) {
        assert!(m.mean_estimate().z_score(want).abs() < 4.0, "{:?} {want}", m.mean_estimate());
    }
}
