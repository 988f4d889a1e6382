//! Tests of `lights`.

mod rectangle;
mod table;

use glam::Vec3;
use hairis::simd::f32x8;
use hairis_instruments::light::{Constant, Smooth, Sun};
use hairis_render::lights::Sky;

#[test]
fn a_sky_is_any_light_and_samples_what_it_shows() {
    let sun = Sun::five_degrees(glam::DVec3::new(0.3, 1.0, 0.2));
    for sky in [Sky::from(Constant), Sky::from(Smooth), Sky::from(sun)] {
        let xi = [0, 1].map(|axis| {
            core::array::from_fn(|lane| [0.07 + 0.11 * lane as f32, 0.83 - 0.1 * lane as f32][axis])
        });
        let eight = sky.sample8(&xi);
        let seen8 = sky.see8(&eight.direction);
        for lane in 0..8 {
            let pair = xi.each_ref().map(|axis: &[f32; 8]| axis[lane]);
            let sample = sky.sample(pair).expect("lit");
            assert_eq!(eight.lane(lane, 1.0), Some(sample));
            let seen = sky.see(sample.direction);
            let near = |a: f32, b: f32| (a / b - 1.0).abs() < 1e-5;
            let pdf8 = seen8.pdf.as_array()[lane];
            assert!(
                near(seen.pdf, sample.pdf) && near(pdf8, sample.pdf),
                "{sky:?}: {sample:?} {seen:?}"
            );
            assert!(
                near(seen.radiance.y, sample.radiance.y),
                "{sky:?}: {seen:?}"
            );
        }
    }
    let black = Sky::BLACK;
    assert_eq!(black.sample([0.5; 2]), None);
    assert_eq!(black.see(Vec3::Y).pdf, 0.0);
    assert_eq!(black.see8(&[Vec3::Y; 8].into()).radiance, [f32x8::ZERO; 3]);
}
