//! Tests of `light::sky`.

use glam::DVec3;
use hairis_instruments::light::{Light, Sky, luminance, xyy_to_rgb};

#[test]
fn white_of_the_chromaticity_diagram_is_white() {
    let rgb = xyy_to_rgb(0.312_7, 0.329_0, 2.0);
    assert!(rgb.iter().all(|v| (v - 2.0).abs() < 2e-3), "{rgb:?}");
    let blue = xyy_to_rgb(0.15, 0.02, 1.0);
    assert!(
        blue.iter().all(|v| *v >= 0.0) && (luminance(blue) - 1.0).abs() < 1e-12,
        "{blue:?}"
    );
}

#[test]
fn zenith_luminance_matches_the_paper_formula() {
    // T = 3, sun at 50 degrees from the zenith: chi = (4/9 - 3/120)(180 - 100) degrees = 33.5556 degrees.
    let sky = Sky::default();
    let want =
        (4.0453 * 3.0 - 4.9710) * 33.555_555_555_6_f64.to_radians().tan() - 0.2155 * 3.0 + 2.4192;
    assert!((luminance(sky.sky_radiance(DVec3::Y)) - want).abs() < 1e-9);
}

#[test]
fn the_sky_is_plausible() {
    let sky = Sky::default();
    let zenith = sky.sky_radiance(DVec3::Y);
    assert!(zenith[2] > zenith[0], "blue overhead: {zenith:?}");
    let sun = sky.sun_irradiance();
    assert!(
        sun[0] > sun[1] && sun[1] > sun[2] && (60.0..110.0).contains(&luminance(sun)),
        "{sun:?}"
    );
    let map = sky.environment();
    assert_eq!(
        map.repairs(),
        hairis_instruments::light::PixelRepairs::default()
    );
    assert!(map.notes().is_empty(), "{:?}", map.notes());
    let at_sun = luminance(map.radiance(sky.sun()));
    assert!(at_sun > 1e4, "the sun shines: {at_sun}");
    let down = map.radiance(-DVec3::Y);
    assert!(
        luminance(down) > 1.0 && luminance(down) < 10.0,
        "the ground reflects some klx: {down:?}"
    );
    assert_eq!(map.digest(), sky.environment().digest());
}
