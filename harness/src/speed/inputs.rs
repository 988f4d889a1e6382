//! The arguments of all calls, drawn before anything is timed.

use crate::sequence::{Independent, stream_id};
use crate::subject::{random, uniform_direction};
use glam::Vec3;
use hairis::ParamError;
use hairis_variants::Parameters;

/// Directions per pass: packets of shading points with 16 samples each. With their numbers `xi` they take 21 KB.
pub(super) const DIRECTIONS: usize = 896;

/// Directions and numbers, all lanes different, and eight sets of parameters.
pub(super) struct Inputs<P> {
    pub(super) wi: Vec<Vec3>,
    pub(super) wo: Vec<Vec3>,
    pub(super) xi: Vec<[f32; 3]>,
    pub(super) params: [P; 8],
    /// The default with lobes so narrow, half a degree on hair, that almost all directions lie in their far tails, where
    /// numbers would be denormal if they were let.
    pub(super) narrow: P,
}

impl<P: Parameters> Inputs<P> {
    /// Uniform directions and numbers; the first parameters are the default, the other seven are drawn.
    pub(super) fn draw(seed: u64) -> Result<Self, ParamError> {
        let mut from = Independent::new(seed, stream_id(&[0x5eed]));
        let (mut params, default) = ([P::default(); 8], P::default().values());
        for one in &mut params[1..] {
            *one = P::from_values(&random(default, &mut from))?;
        }
        let narrow = P::FIELDS.iter().filter_map(|field| Some((field, field.narrow?)));
        let narrow =
            narrow.fold(default, |values, (field, narrow)| values.with(field.name, &vec![narrow; field.kind.width()]));
        Ok(Self {
            wi: (0..DIRECTIONS).map(|_| uniform_direction(&mut from)).collect(),
            wo: (0..DIRECTIONS).map(|_| uniform_direction(&mut from)).collect(),
            xi: (0..DIRECTIONS).map(|_| [from.next_f32(), from.next_f32(), from.next_f32()]).collect(),
            params,
            narrow: P::from_values(&narrow)?,
        })
    }
}

/// The elements of two lists, paired.
pub(super) fn pairs<A: Clone, B: Clone>(a: &[A], b: &[B]) -> Vec<(A, B)> {
    a.iter().cloned().zip(b.iter().cloned()).collect()
}
