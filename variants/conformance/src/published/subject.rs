//! Models of the family as subjects of the suite.

use super::support::{double, oracle, widths};
use super::{FamilyModel, formulas};
use crate::probe::{angles, narrow};
use crate::strategies;
use crate::subject::{AnyMaterial, Claims, Expected, Materials, ParamsOf, Subject, Tolerance};
use core::f64::consts::{FRAC_PI_2, PI};
use core::marker::PhantomData;
use glam::Vec3;
use hairis::params::{HairDesc, MAX_WIDTH, MIN_WIDTH};
use hairis::{HairParams, Hit, LobeMask};
use proptest::prelude::*;

/// Subject of the general suite for a model of the family.
#[derive(Clone, Copy, Debug, Default)]
pub struct Family<P>(PhantomData<P>);

impl<P> Family<P> {
    /// Makes the subject, which has no data.
    #[must_use]
    pub const fn new() -> Self {
        Self(PhantomData)
    }
}

fn material(desc: &HairDesc) -> HairParams {
    HairParams::new(desc).unwrap()
}

fn vector(hit: &Hit) -> Vec3 {
    hit.wo.into()
}

impl<P: FamilyModel> Subject for Family<P> {
    type Model = P::Model;

    fn model(&self) -> P::Model {
        P::forms()[0].0
    }

    fn materials(&self) -> Materials<Self> {
        let tilted = HairDesc {
            alpha: [0.2, -0.15, -0.35],
            phi_g: 0.7,
            ..widths(0.3)
        };
        let black = HairDesc {
            i_r: [0.0; 3],
            i_tt: [0.0; 3],
            i_trt: [0.0; 3],
            ..widths(0.3)
        };
        let narrow = widths(narrow(0.5_f64.to_radians()));
        vec![
            ("default", HairParams::bright()),
            ("brown", HairParams::brown()),
            ("tilted", material(&tilted)),
            ("half a degree", material(&narrow)),
            (
                "sixty degrees",
                material(&HairDesc {
                    i_g: 5.0,
                    ..widths(1.047)
                }),
            ),
            ("all colours black", material(&black)),
        ]
    }

    fn extremes(&self) -> Materials<Self> {
        let right = core::f32::consts::FRAC_PI_2;
        let off = HairDesc {
            alpha: [right, -right, right],
            phi_g: core::f32::consts::PI,
            ..widths(0.01)
        };
        let bright = HairDesc {
            i_r: [f32::MAX, 0.0, 1e-38],
            i_tt: [0.0; 3],
            i_trt: [1e30, 1e-30, 1.0],
            ..widths(0.2)
        };
        vec![
            ("least widths", material(&widths(MIN_WIDTH))),
            ("largest widths", material(&widths(MAX_WIDTH))),
            ("off the sphere", material(&off)),
            ("any brightness", material(&bright)),
        ]
    }

    fn any_material(&self) -> Option<BoxedStrategy<AnyMaterial<HairParams>>> {
        Some(strategies::hair().boxed())
    }

    fn claims(&self) -> Claims {
        let rows = P::ROWS.of_this_run();
        Claims {
            reciprocal: Some(rows.reciprocity),
            lanes: 5e-6,         // 3.3e-6
            sample_eval: 1.7e-6, // 1.3e-6
            weight: 1e-6,        // 4.8e-7
            lobe_sum: 1e-6,      // 3.8e-7
            // Lobes of half a degree at the poles.
            discarded: 1e-2,  // 7.6e-3
            inversion: 2e-4,  // 1.20e-4
            integral: 1.4e-4, // 1.03e-4
            // Lobes of 0.01 rad off the sphere: 157 widths away a Cauchy bell's inverse is 157^2 * 0.01 steep, and four
            // roundings of 6e-8 are 6e-5 rad.
            direction: 6e-5, // 2.2e-5
            albedo: rows.albedo_mesh,
            ..Claims::default()
        }
    }

    fn edges(&self, params: &HairParams, hit: &Hit) -> [Vec<f64>; 2] {
        let theta = oracle(&formulas::<P>(), params, P::forms()[0].1, vector(hit)).jumps();
        let [_, phi_o] = angles(double(vector(hit)));
        let glint = f64::from(params.desc().phi_g);
        let around = [0.0, PI, FRAC_PI_2, -FRAC_PI_2, glint, -glint].map(|phi| {
            let phi = phi_o + phi;
            phi - 2.0 * PI * (phi / (2.0 * PI)).round()
        });
        [theta, around.to_vec()]
    }

    /// Returns three times the bound on the mean of the channels.
    fn weight_bound(&self, params: &HairParams, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        let reference = oracle(&formulas::<P>(), params, P::forms()[0].1, vector(hit));
        Some(3.0 * reference.weight_bound(lobes)?)
    }

    fn reference(&self, params: &ParamsOf<Self>, hit: &Hit) -> Option<Expected> {
        let tolerance = Tolerance {
            // Where lobes are so faint that there is no bound by argument.
            value: 2.5e-4,
            pdf: 2.5e-4,
            lobes: Some(2.5e-4),
            // Normalised, a lobe of the last few powers of two of a Gaussian would show where the Gaussian is cut.
            lobe_floor: P::PDF_FLOOR,
            rounding: 5e-7,
            ..Tolerance::default()
        };
        Some(Expected {
            reference: oracle(&formulas::<P>(), params, P::forms()[0].1, vector(hit)),
            tolerance,
        })
    }
}
