//! Frames of fibres: orthonormal and right-handed for any tangent and normal.

use crate::support::Draws;
use crate::tolerance as bound;
use glam::Vec3;
use hairis::FiberFrame;
use hairis_conformance::published::props::{finite, three};

#[test]
fn frames_are_orthonormal_and_right_handed() {
    let mut draws = Draws(56);
    for _ in 0..20_000 {
        let [tangent, normal] = [three(&mut draws, finite), three(&mut draws, finite)].map(Vec3::from_array);
        for frame in [FiberFrame::from_tangent(tangent), FiberFrame::from_tangent_normal(tangent, normal)] {
            let FiberFrame { u, v, w } = frame;
            let off = [u.dot(v), v.dot(w), w.dot(u), u.length() - 1.0, v.length() - 1.0, w.length() - 1.0];
            let worst = off.iter().fold(0.0, |a: f32, x| a.max(x.abs()));
            assert!(worst <= bound::FRAME, "{frame:?} is off by {worst}");
            assert!((u.cross(v) - w).length() <= bound::FRAME, "{frame:?} is left-handed");
            let largest = tangent.abs().max_element();
            let along = largest == 0.0 || u.dot((tangent / largest).normalize()) > 0.999_999;
            assert!(along, "u is not along {tangent:?}");
            let x = Vec3::new(0.3, -0.5, 0.8);
            assert!((frame.to_world(frame.to_local(x)) - x).length() < 1e-6, "there and back in {frame:?}");
        }
    }
}
