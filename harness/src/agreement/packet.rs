//! Packets of eight shading points, with directions and numbers that fall into a region.

use super::Region;
use crate::subject::random;
use core::f64::consts::{PI, TAU};
use glam::Vec3;
use hairis::ParamError;
use hairis_instruments::direction::{direction, to_f64, uniform_direction};
use hairis_instruments::sequence::{Independent, stream_id};
use hairis_reference::agreement::{self, azimuth_between, from_axis, is_bounded};
use hairis_reference::{Reference, reference, slack};
use hairis_variants::{AnyMaterial, ModelId, Values};

/// Least and largest angle to the axis, rad, of a direction that counts as near the axis.
pub(super) const AXIS: [f64; 2] = [agreement::AXIS, 1e-2];
/// Largest distance from pi, rad, of a `|phi|` that counts as near pi.
pub(super) const BACK: f64 = 1e-2;

/// Function that prepares the formulas of given values, seen from `wo` at the offset `h`.
pub type Formulas<'a> =
    dyn Fn(&Values, Vec3, f32) -> Result<Box<dyn Reference<f64>>, ParamError> + Sync + 'a;

/// Returns the function that prepares the formulas of a model.
pub fn formulas(
    model: ModelId,
) -> impl Fn(&Values, Vec3, f32) -> Result<Box<dyn Reference<f64>>, ParamError> {
    move |values, wo, h| reference(model, values, to_f64(wo), f64::from(h))
}

/// Eight materials seen from eight directions, with the directions to evaluate and the numbers to sample.
pub(super) struct Packet {
    pub(super) values: [Values; 8],
    pub(super) wo: [Vec3; 8],
    /// Offsets across the fibre, 0 for a far-field model.
    pub(super) h: [f32; 8],
    /// Directions, one for each shading point.
    pub(super) wi: [Vec3; 8],
    /// Directions, all eight for the first shading point.
    pub(super) wi_shared: [Vec3; 8],
    pub(super) xi: [[f32; 3]; 8],
    pub(super) materials: Vec<AnyMaterial>,
    pub(super) truth: Vec<Truth>,
}

/// Formulas of a shading point, with what they have answered: many code paths draw the same sample to the bit.
pub(super) struct Truth {
    pub(super) formulas: Box<dyn Reference<f64>>,
    known: Vec<([u32; 3], Exact)>,
}

/// Answers of the formulas in one direction.
#[derive(Clone, Copy)]
pub(super) struct Exact {
    pub(super) value: [f64; 3],
    pub(super) pdf: f64,
    /// Absolute error of the value that is allowed, by channel.
    pub(super) slack: [f64; 3],
}

impl Packet {
    /// Returns the formulas' answers at shading point `k`.
    pub(super) fn exact(
        &mut self,
        model: ModelId,
        k: usize,
        wi: Vec3,
    ) -> Result<Exact, ParamError> {
        let Truth { formulas, known } = &mut self.truth[k];
        let bits = wi.to_array().map(f32::to_bits);
        if let Some((_, exact)) = known.iter().find(|(at, _)| *at == bits) {
            return Ok(*exact);
        }
        let (value, pdf) = formulas.eval_pdf(to_f64(wi));
        let slack = slack(model, &self.values[k], to_f64(self.wo[k]), to_f64(wi))?;
        let exact = Exact { value, pdf, slack };
        known.push((bits, exact));
        Ok(exact)
    }

    /// Draws packet `index` of a run, which does not depend on what other packets are drawn.
    pub(super) fn draw(
        model: ModelId,
        formulas: &Formulas<'_>,
        region: Region,
        seed: u64,
        index: u64,
    ) -> Result<Self, ParamError> {
        let mut from = Independent::new(seed, stream_id(&[0xa9ee, region as u64, index]));
        let values = [(); 8].map(|()| random(model.measured(), &mut from));
        let wo = core::array::from_fn(|_| match region {
            // Half of the viewers look along the fibre's axis as well.
            Region::Axis if from.next_f64() < 0.5 => near_axis(&mut from),
            _ => uniform_direction(&mut from),
        });
        let wi = wo.map(|wo| region.direction(wo, &mut from));
        let wi_shared = core::array::from_fn(|_| region.direction(wo[0], &mut from));
        let xi = core::array::from_fn(|_| region.numbers(&mut from));
        let h = [(); 8].map(|()| {
            if model.is_near_field() {
                2.0 * from.next_f32() - 1.0
            } else {
                0.0
            }
        });
        let truth = (0..8)
            .map(|k| {
                Ok(Truth {
                    formulas: formulas(&values[k], wo[k], h[k])?,
                    known: Vec::new(),
                })
            })
            .collect::<Result<_, _>>()?;
        let materials = values
            .iter()
            .map(|values| model.material(values))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            values,
            wo,
            h,
            wi,
            wi_shared,
            xi,
            materials,
            truth,
        })
    }
}

impl Region {
    /// Draws a direction in the region.
    fn direction(self, wo: Vec3, from: &mut Independent) -> Vec3 {
        match self {
            Self::General => uniform_direction(from),
            Self::Axis => near_axis(from),
            Self::Back => {
                let sin_theta = 2.0 * from.next_f64() - 1.0;
                let off = BACK * log_uniform(from, 1e-6) * sign(from);
                let phi_o = f64::from(wo.z).atan2(f64::from(wo.y));
                direction(
                    sin_theta,
                    (1.0 - sin_theta * sin_theta).sqrt(),
                    phi_o + PI + off,
                )
            }
        }
    }

    /// Draws uniform numbers whose samples often fall into the region.
    fn numbers(self, from: &mut Independent) -> [f32; 3] {
        let mut xi = [from.next_f32(), from.next_f32(), from.next_f32()];
        #[expect(
            clippy::cast_possible_truncation,
            reason = "rounding to f32 is the purpose"
        )]
        let mut edge = || 1e-2 * log_uniform(from, 1e-5) as f32;
        match self {
            Self::General => {}
            // Both ends of the inclination's distribution.
            Self::Axis => xi[1] = if xi[1] < 0.5 { edge() } else { 1.0 - edge() },
            // Both ends for the cosines of R and TRT, and the middle for TT.
            Self::Back => {
                xi[2] = match xi[2] {
                    low if low < 0.25 => edge(),
                    high if high < 0.5 => 1.0 - edge(),
                    mid => 0.5 + (if mid < 0.75 { edge() } else { -edge() }),
                };
            }
        }
        xi
    }

    /// Returns true if the pair of directions is in the region and the bounds apply to it: further than 1e-3 rad from the axis, off the cut
    /// of the glints, and not so close to pi that the oracle fails.
    pub(super) fn holds(self, wo: Vec3, wi: Vec3) -> bool {
        let (wo, wi) = (to_f64(wo), to_f64(wi));
        is_bounded(wo, wi)
            && match self {
                Self::General => true,
                Self::Axis => from_axis(wi) < AXIS[1],
                Self::Back => PI - azimuth_between(wo, wi).abs() < BACK,
            }
    }
}

/// Draws a direction near either end of the axis, at a log-uniform angle to it.
fn near_axis(from: &mut Independent) -> Vec3 {
    let angle = AXIS[1] * log_uniform(from, AXIS[0] / AXIS[1]);
    direction(sign(from) * angle.cos(), angle.sin(), TAU * from.next_f64())
}

/// Draws a log-uniform number in `(least, 1]`.
fn log_uniform(from: &mut Independent, least: f64) -> f64 {
    least.powf(from.next_f64())
}

fn sign(from: &mut Independent) -> f64 {
    if from.next_f64() < 0.5 { -1.0 } else { 1.0 }
}
