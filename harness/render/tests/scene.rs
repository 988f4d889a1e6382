//! Tests of `scene`.

mod head;

use hairis_instruments::sequence::{Independent, XiSource as _};
use hairis_render::hair::{Choice, Energy};
use hairis_render::lights::{RectangleSampling, uniform_direction};
use hairis_render::scene::{Met, Scene};
use hairis_render::scenes::{self, Name, Parts};
use hairis_render::tree::Ray;

#[test]
fn a_direction_has_one_density() {
    let hair = Choice::find("gaussian", "matched", "blond")
        .and_then(|hair| hair.hair(Energy::Raw))
        .expect("listed");
    let strands = scenes::grow(Name::Area, 1).expect("one");
    let parts = Parts {
        strands,
        imported: false,
        head: None,
        hair,
        env: None,
        size: [1; 2],
        turn: 0.0,
    };
    let scene = scenes::build(Name::Area, parts).expect("a scene");
    let mut numbers = Independent::new(8, 0);
    for rectangle_sampling in [RectangleSampling::SolidAngle, RectangleSampling::Area] {
        let scene = Scene {
            rectangle_sampling,
            ..scene.clone()
        };
        for _ in 0..1000 {
            let origin = 5.0 * uniform_direction(numbers.next_xi_f32());
            // Off the rim, which rounding may miss.
            let xi = numbers.next_xi_f32::<3>().map(|x| 0.001 + 0.998 * x);
            let one = scene.sample_light(origin, xi).expect("in front");
            let seen = scene
                .see(&Ray::new(origin, one.direction), &Met::Light(0))
                .expect("in front");
            let eight = scene.sample_lights8(|_| origin, &xi.map(|x| [x; 8]), None);
            let along = scene.lights_along(origin, &[one.direction; 8].into());
            for pdf in [seen.pdf, eight.pdf.as_array()[0], along.pdf.as_array()[0]] {
                assert!(
                    (pdf / one.pdf - 1.0).abs() < 1e-4,
                    "{rectangle_sampling:?}: {pdf} for {}",
                    one.pdf
                );
            }
        }
    }
}
