//! The arguments of all calls, drawn before anything is timed.

use crate::sequence::{Independent, stream_id};
use crate::subject::{random_hair, uniform_direction};
use glam::Vec3;
use hairis::{HairDesc, HairParams, ParamError, Vec3x8};
use wide::f32x8;

/// Directions a pass. With their numbers `xi` they take 21 KB.
///
/// Packets of gather points with 16 samples each, and no power of two: columns of 4096 bytes one after the other make loads wait for stores they have nothing to do with,
/// which costs slices up to 40 %.
pub(super) const DIRECTIONS: usize = 896;

/// Half a degree, rad.
const NARROW: f32 = 0.008_726_646;

/// Directions and numbers, all lanes different, and eight heads of hair.
pub(super) struct Inputs {
    pub(super) wi: Vec<Vec3>,
    pub(super) wo: Vec<Vec3>,
    pub(super) xi: Vec<[f32; 3]>,
    pub(super) hair: [HairParams; 8],
    /// The default hair with every width half a degree: almost all directions lie in the far tails of every lobe, where
    /// numbers would be denormal if they were let.
    pub(super) narrow: HairParams,
}

impl Inputs {
    /// Uniform directions and numbers; the first hair is the default, the other seven are drawn.
    pub(super) fn draw(seed: u64) -> Result<Self, ParamError> {
        let mut from = Independent::new(seed, stream_id(&[0x5eed]));
        let mut hair = [HairParams::default(); 8];
        for one in &mut hair[1..] {
            *one = random_hair(&mut from)?;
        }
        Ok(Self {
            wi: (0..DIRECTIONS).map(|_| uniform_direction(&mut from)).collect(),
            wo: (0..DIRECTIONS).map(|_| uniform_direction(&mut from)).collect(),
            xi: (0..DIRECTIONS).map(|_| [from.next_f32(), from.next_f32(), from.next_f32()]).collect(),
            hair,
            narrow: HairParams::new(&HairDesc {
                beta_r: NARROW,
                beta_tt: NARROW,
                beta_trt: NARROW,
                gamma_tt: NARROW,
                gamma_g: NARROW,
                ..*HairParams::default().desc()
            })?,
        })
    }
}

/// The directions as the textbook takes them.
pub(super) fn arrays(v: &[Vec3]) -> Vec<[f32; 3]> {
    v.iter().map(|v| v.to_array()).collect()
}

/// Eight directions a packet.
pub(super) fn packets(v: &[Vec3]) -> Vec<Vec3x8> {
    let (eights, _) = v.as_chunks::<8>();
    eights.iter().map(|eight| (*eight).into()).collect()
}

/// Eight triples of numbers a packet.
pub(super) fn xi_packets(xi: &[[f32; 3]]) -> Vec<[f32x8; 3]> {
    let (eights, _) = xi.as_chunks::<8>();
    eights.iter().map(|eight| core::array::from_fn(|k| f32x8::new(eight.map(|xi| xi[k])))).collect()
}

/// The elements of two lists, paired.
pub(super) fn pairs<A: Clone, B: Clone>(a: &[A], b: &[B]) -> Vec<(A, B)> {
    a.iter().cloned().zip(b.iter().cloned()).collect()
}
