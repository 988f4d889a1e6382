//! Tests of `scene::head`.

use glam::Vec3;
use hairis::simd::f32x8;
use hairis_instruments::sequence::{Independent, XiSource as _};
use hairis_render::lights::uniform_direction;
use hairis_render::scene::Ellipsoid;

#[test]
fn eight_rays_meet_the_head_as_one_does() {
    let head = Ellipsoid {
        centre: Vec3::new(1.0, 150.0, -3.0),
        radii: Vec3::new(7.5, 10.0, 8.8),
    };
    let mut xi = Independent::new(6, 0);
    let mut met = 0;
    for turn in 0..20_000 {
        // Inside, on the surface and outside.
        let origin =
            [0.5, 1.0, 1.01, 3.0][turn % 4] * head.radii * uniform_direction(xi.next_xi_f32());
        let origin = head.centre + origin;
        let dirs: [Vec3; 8] = core::array::from_fn(|_| uniform_direction(xi.next_xi_f32()));
        let t_max = if turn % 3 == 0 { 12.0 } else { f32::INFINITY };
        let lanes = head
            .blocks8(origin, &dirs.into(), &f32x8::splat(t_max))
            .to_bitmask();
        for (lane, dir) in dirs.into_iter().enumerate() {
            let one = head.meet(origin, dir, 0.0).is_some_and(|t| t < t_max);
            assert_eq!(lanes >> lane & 1 == 1, one, "{origin} {dir}");
            met += u32::from(one);
        }
    }
    assert!(met > 10_000, "{met} met");
}
