//! Frames of eight hits at a time.

use glam::Vec3;
use hairis::wide::f32x8;
use hairis::{FiberFrame8, Vec3x8};

/// Frames of eight fibres with unit tangents `u`, in which the azimuth of `wo` is 0: as
/// [`FiberFrame::from_tangent_normal`](hairis::FiberFrame::from_tangent_normal) does for one.
///
/// - Domain: unit vectors. Where `wo` lies along the fibre, any frame of the tangent.
#[must_use]
pub fn frames8(u: &Vec3x8, wo: &Vec3x8) -> FiberFrame8 {
    let across = reject(wo, u);
    let along = across.dot(across).simd_lt(f32x8::splat(1e-10));
    let mut v = unit(&across);
    if along.any() {
        let lanes = along.to_bitmask();
        v = Vec3x8::from(core::array::from_fn::<Vec3, 8, _>(|lane| {
            if lanes >> lane & 1 == 1 { u.lane(lane).any_orthonormal_vector() } else { v.lane(lane) }
        }));
    }
    // Once more: the first difference leaves up to 1e-2 of u where wo is almost along it.
    let v = unit(&reject(&v, u));
    FiberFrame8 { u: *u, v, w: cross(u, &v) }
}

/// The part of `a` across the unit vector `u`.
#[inline]
fn reject(a: &Vec3x8, u: &Vec3x8) -> Vec3x8 {
    a.plus(u.scale(-a.dot(*u)))
}

/// At unit length; zero stays short.
#[inline]
fn unit(a: &Vec3x8) -> Vec3x8 {
    a.scale(f32x8::splat(1.0) / a.dot(*a).max(f32x8::splat(1e-30)).sqrt())
}

/// Cross product.
#[inline]
fn cross(a: &Vec3x8, b: &Vec3x8) -> Vec3x8 {
    Vec3x8::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairis::FiberFrame;
    use hairis_harness::sequence::{Independent, XiSource as _};

    #[test]
    fn frames_are_those_of_one_at_a_time() {
        let mut xi = Independent::new(7, 0);
        let mut unit = || Vec3::from_array(xi.next_xi_f32::<3>().map(|x| 2.0 * x - 1.0)).normalize();
        for turn in 0..1000 {
            let u: [Vec3; 8] = core::array::from_fn(|_| unit());
            let mut wo: [Vec3; 8] = core::array::from_fn(|_| unit());
            if turn % 10 == 0 {
                (wo[3], wo[5]) = (u[3], (u[5] + 1e-3 * wo[5]).normalize());
            }
            let frames = frames8(&u.into(), &wo.into());
            for lane in 0..8 {
                let (u8, v8, w8) = (frames.u.lane(lane), frames.v.lane(lane), frames.w.lane(lane));
                let orthonormal = v8.is_normalized() && u8.dot(v8).abs() < 1e-6 && (u8.cross(v8) - w8).length() < 1e-6;
                assert!(orthonormal, "{u8} {v8} {w8}");
                let one = FiberFrame::from_tangent_normal(u[lane], wo[lane]);
                let along = (wo[lane] - u[lane]).length() < 1e-2;
                assert!(along || (one.v - v8).length() < 1e-4, "{} {v8}", one.v);
            }
        }
    }
}
