//! Times of samples and of look-ups.

use hairis_harness::sampler::Sampler;
use hairis_harness::subject::ModelKind;
use hairis_harness::times::*;
use hairis_instruments::light::{Constant, Smooth};
use hairis_instruments::sequence::Independent;
use hairis_instruments::stats::Estimate;

#[test]
fn every_sampler_and_light_is_timed() {
    let times = Times {
        of_samples: measure(1, 3, &[&Constant, &Smooth]),
        of_rays: Vec::new(),
    };
    assert_eq!(
        times.of_samples.len(),
        ModelKind::ALL.len() * Sampler::ALL.len() * PER_POINT.len() + 2
    );
    for (of, time) in &times.of_samples {
        let [q1, median, q3] = time.quartiles;
        assert!(
            q1 > 0.0 && q1 <= median && median <= q3 && time.standard_error >= 0.0,
            "{time:?}"
        );
        let found = match of {
            Timed::Sample(model, sampler, per_point) => times.ns(*model, *sampler, *per_point),
            Timed::LookUp(light) => times.look_up(light),
        };
        assert_eq!(
            found,
            Estimate {
                value: median,
                standard_error: time.standard_error
            }
        );
    }
    assert!(
        times
            .ns(ModelKind::Gaussian, Sampler::Published, 2)
            .value
            .is_nan(),
        "not measured"
    );
    assert!(times.look_up("sun").value.is_nan(), "no such light");
}

#[test]
fn look_ups_are_in_many_directions_all_over_the_sphere() {
    let seen = directions(&mut Independent::new(1, 0));
    assert_eq!(seen.len() * 8, 1 << 16);
    // Patches of equal size: steps along the axis, and of 10 degrees around it.
    let mut cells = std::collections::BTreeSet::new();
    for wi in seen.iter().flat_map(|wi| (0..8).map(|lane| wi.lane(lane))) {
        assert!((wi.length() - 1.0).abs() < 1e-5, "{wi}");
        let patch = [10.0 * wi.x, wi.z.atan2(wi.y).to_degrees() / 10.0];
        cells.insert(patch.map(|place| place.floor().to_string()));
    }
    assert!(cells.len() > 700, "{} of 720 patches", cells.len());
}
