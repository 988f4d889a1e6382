//! Tests of `transport::profile`.

use hairis_render::transport::profile::{Phase, Profile, count_ray, lap, start, stop};
use std::time::Instant;

#[test]
fn laps_add_up_to_the_whole() {
    lap(Phase::Rays);
    assert_eq!(
        stop(),
        Profile::default(),
        "nothing is measured before the start"
    );
    let begin = Instant::now();
    start();
    std::thread::sleep(core::time::Duration::from_millis(3));
    lap(Phase::Light);
    (0..4).for_each(|ray| count_ray(ray == 3));
    lap(Phase::Rest);
    let profile = stop();
    let (whole, sum) = (begin.elapsed().as_secs_f64(), profile.seconds());
    assert!(sum >= 3e-3 && sum <= whole, "{sum} of {whole}");
    assert!(
        profile.share(Phase::Light) > 0.5 && profile.share(Phase::Rays) == 0.0,
        "{profile}"
    );
    assert_eq!(profile.visible(), 0.25);
    let mut twice = profile;
    twice.add(profile);
    assert!((twice.share(Phase::Light) - profile.share(Phase::Light)).abs() < 1e-12);
}
