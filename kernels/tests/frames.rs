//! Frames of fibres: orthonormal and right-handed for any tangent and normal.

use crate::support::Draws;
use crate::tolerance as bound;
use glam::Vec3;
use hairis::{FiberFrame, FiberFrame8, Vec3x8};
use hairis_conformance::proptest::array::{uniform3, uniform8};
use hairis_conformance::proptest::prelude::*;
use hairis_conformance::strategies::{config, vectors};

#[test]
fn frames_are_orthonormal_and_right_handed() {
    proptest!(config(file!(), 20_000), |(tangent in vectors(), normal in vectors())| {
        for frame in [
            FiberFrame::from_tangent(tangent),
            FiberFrame::from_tangent_normal(tangent, normal),
        ] {
            let FiberFrame { u, v, w } = frame;
            let off = [
                u.dot(v),
                v.dot(w),
                w.dot(u),
                u.length() - 1.0,
                v.length() - 1.0,
                w.length() - 1.0,
            ];
            let worst = off.iter().fold(0.0, |a: f32, x| a.max(x.abs()));
            assert!(worst <= bound::FRAME, "{frame:?} is off by {worst}");
            assert!(
                (u.cross(v) - w).length() <= bound::FRAME,
                "{frame:?} is left-handed"
            );
            let largest = tangent.abs().max_element();
            let along = largest == 0.0 || u.dot((tangent / largest).normalize()) > 0.999_999;
            assert!(along, "u is not along {tangent:?}");
            let x = Vec3::new(0.3, -0.5, 0.8);
            assert!(
                (frame.to_world(frame.to_local(x)) - x).length() < 1e-6,
                "there and back in {frame:?}"
            );
        }
    });
}

#[test]
fn eight_lanes_round_as_sums_do_in_every_build() {
    let inside = uniform8(uniform3(0.0..1.0_f32).prop_map(Vec3::from_array));
    proptest!(config(file!(), 2000), |(tangents in uniform8(vectors()), vectors in inside)| {
        let frames = tangents.map(FiberFrame::from_tangent);
        let eight = FiberFrame8::from(frames);
        let (local, world) = (
            eight.to_local(&vectors.into()),
            eight.to_world(&vectors.into()),
        );
        for lane in 0..8 {
            let (FiberFrame { u, v, w }, x) = (frames[lane], vectors[lane]);
            let dot = |axis: Vec3| x.x * axis.x + (x.y * axis.y + x.z * axis.z);
            assert_eq!(
                local.lane(lane),
                Vec3::new(dot(u), dot(v), dot(w)),
                "{x} in {:?}",
                frames[lane]
            );
            assert_eq!(
                world.lane(lane),
                frames[lane].to_world(x),
                "{x} out of {:?}",
                frames[lane]
            );
        }
    });
}

#[test]
fn frames_and_offsets_of_eight_hits_are_those_of_one() {
    let mut draws = Draws(59);
    let mut unit = || {
        Vec3::from_array(core::array::from_fn(|_| 2.0 * draws.xi() - 1.0))
            .try_normalize()
            .unwrap_or(Vec3::Z)
    };
    for round in 0..2000 {
        let [mut tangents, normals, wo]: [[Vec3; 8]; 3] =
            core::array::from_fn(|_| core::array::from_fn(|_| unit()));
        tangents[round % 8] = [Vec3::Z, -Vec3::Z, Vec3::X, -Vec3::Y][round / 8 % 4];
        let eight = FiberFrame8::from_tangents(&tangents.into());
        let offset = eight.offset(&normals.into(), &wo.into());
        for lane in 0..8 {
            let frame = FiberFrame::from_tangent(tangents[lane]);
            for (got, want) in [(eight.v, frame.v), (eight.w, frame.w)] {
                let error = (got.lane(lane) - want).length();
                assert!(error < bound::FRAME, "{frame:?} is off by {error}");
            }
            let want = frame.offset(normals[lane], wo[lane]);
            let error = (offset.to_array()[lane] - want).abs();
            // Both lose digits next to the axis.
            let across =
                [normals[lane], wo[lane]].map(|v| FiberFrame::cos_theta(frame.to_local(v)));
            let most = 2.0 * bound::FRAME / across[0].min(across[1]).max(1e-3);
            assert!(error < most, "{error} at {frame:?}");
        }
    }
    let axis = FiberFrame8::from_tangents(&Vec3x8::splat(Vec3::X));
    let along = axis.offset(&Vec3x8::splat(Vec3::X), &Vec3x8::splat(Vec3::Y));
    assert_eq!(along.to_array(), [0.0; 8], "a normal along the fibre");
}

#[test]
fn frames_of_eight_hits_are_those_of_one_at_a_time() {
    let mut draws = Draws(58);
    let mut unit = || loop {
        let v = Vec3::from_array([draws.xi(), draws.xi(), draws.xi()].map(|x| 2.0 * x - 1.0));
        if v.length_squared() > 1e-6 {
            return v.normalize();
        }
    };
    for turn in 0..2000 {
        let u: [Vec3; 8] = core::array::from_fn(|_| unit());
        let mut wo: [Vec3; 8] = core::array::from_fn(|_| unit());
        if turn % 10 == 0 {
            (wo[2], wo[3], wo[5]) = (-u[2], u[3], (u[5] + 1e-3 * wo[5]).normalize());
        }
        let frames = FiberFrame8::from_tangents_normals(&u.into(), &wo.into());
        for lane in 0..8 {
            let (tangent, v, w) = (
                frames.u.lane(lane),
                frames.v.lane(lane),
                frames.w.lane(lane),
            );
            let off = [
                v.length() - 1.0,
                tangent.dot(v),
                (tangent.cross(v) - w).length(),
            ];
            assert!(
                tangent == u[lane] && off.iter().all(|x| x.abs() < 1e-6),
                "{tangent} {v} {w}"
            );
            let one = FiberFrame::from_tangent_normal(u[lane], wo[lane]);
            let along = u[lane].cross(wo[lane]).length() < 1e-2;
            assert!(along || (one.v - v).length() < 1e-4, "{} {v}", one.v);
        }
    }
}
