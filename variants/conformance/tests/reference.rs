//! Tests of the sound model beside the fibre in double precision, with right and wrong formulas.

use crate::broken::{Broken, Fiber, Params, SOUND};
use core::f64::consts::PI;
use hairis::model::Model;
use hairis::{Hit, Lobe, PerLobe};
use hairis_conformance::reference::agrees_with_reference;
use hairis_conformance::{
    Claims, Expected, LobeAt, Materials, Reference, ReferenceSample, Subject, Tolerance,
};

/// Relative errors of a reference in the value, the density and a lobe, and the error in the number that a lobe is chosen by.
#[derive(Clone, Copy, Debug, Default)]
struct Errors {
    value: f64,
    pdf: f64,
    lobe: f64,
    choice: f64,
}

/// Formulas of the fibre in double precision.
#[derive(Debug)]
struct Formulas {
    kd: [f64; 3],
    ks: [f64; 3],
    width: f64,
    sin_theta_o: f64,
    errors: Errors,
}

impl Formulas {
    fn share(&self) -> f64 {
        let (d, s) = (self.kd.iter().sum::<f64>(), self.ks.iter().sum::<f64>());
        if d + s > 0.0 { d / (d + s) } else { 0.0 }
    }

    fn lit(&self) -> bool {
        self.kd.iter().chain(&self.ks).any(|x| *x > 0.0)
    }

    /// Returns the angle that the interval from 0 to this sine subtends at the cone's bell.
    fn angle(&self, sin: f64) -> f64 {
        ((sin + self.sin_theta_o) / self.width).atan()
    }
}

impl Reference<f64> for Formulas {
    fn eval_pdf(&self, wi: [f64; 3]) -> ([f64; 3], f64) {
        let [diffuse, cone] = self.both(wi);
        let value = [0, 1, 2].map(|c| self.kd[c] * diffuse[0] + self.ks[c] * cone[0]);
        let mixed = self.share() * diffuse[1] + (1.0 - self.share()) * cone[1];
        let pdf = if self.lit() { mixed } else { 0.0 };
        (
            value.map(|s| s * (1.0 + self.errors.value)),
            pdf * (1.0 + self.errors.pdf),
        )
    }

    fn lobes(&self, wi: [f64; 3]) -> PerLobe<LobeAt<f64>> {
        let [diffuse, cone] = self.both(wi);
        let cone = cone.map(|x| x * (1.0 + self.errors.lobe));
        let lobe = |[value, pdf]: [f64; 2], color| LobeAt { value, color, pdf };
        let lobes = [lobe(diffuse, self.kd), lobe(cone, self.ks)];
        PerLobe::padded(lobes, LobeAt::default())
    }

    fn sample(&self, xi: [f64; 3]) -> ReferenceSample<f64> {
        let (lo, hi) = (self.angle(-1.0), self.angle(1.0));
        let diffuse = xi[0] < self.share() + self.errors.choice;
        let cone = self.width * (lo + xi[1] * (hi - lo)).tan() - self.sin_theta_o;
        let sin = if diffuse {
            2.0 * xi[1] - 1.0
        } else {
            cone.clamp(-1.0, 1.0)
        };
        let (cos, phi) = (((1.0 - sin) * (1.0 + sin)).sqrt(), 2.0 * PI * (xi[2] - 0.5));
        if !self.lit() || cos < 1e-5 {
            return ReferenceSample::default();
        }
        ReferenceSample {
            wi: [sin, cos * phi.cos(), cos * phi.sin()],
            lobe: Some(Lobe::slot(u8::from(!diffuse))),
            ..ReferenceSample::default()
        }
    }
}

impl Formulas {
    /// Returns value and density of both lobes.
    fn both(&self, [u, ..]: [f64; 3]) -> [[f64; 2]; 2] {
        let off = u + self.sin_theta_o;
        let bell = self.width / (off * off + self.width * self.width);
        let span = self.angle(1.0) - self.angle(-1.0);
        [
            [1.0 / (PI * PI), 0.25 / PI],
            [bell / (2.0 * PI * PI), bell / (2.0 * PI * span)],
        ]
    }
}

/// Sound fibre whose reference are these formulas.
struct Beside(Errors);

impl Subject for Beside {
    type Model = Fiber;

    fn model(&self) -> Self::Model {
        Fiber
    }

    fn materials(&self) -> Materials<Self> {
        Broken(SOUND).materials()
    }

    fn claims(&self) -> Claims {
        Broken(SOUND).claims()
    }

    fn random_materials(&self) -> Vec<Params> {
        vec![Params {
            fault: SOUND,
            kd: [0.3, 0.0, 0.9],
            ks: [0.0, 0.7, 0.2],
            width: 0.4,
        }]
    }

    fn reference(&self, params: &<Self::Model as Model>::Params, hit: &Hit) -> Option<Expected> {
        let [u, v, w] = [hit.wo.x, hit.wo.y, hit.wo.z].map(f64::from);
        let formulas = Formulas {
            kd: params.kd.map(f64::from),
            ks: params.ks.map(f64::from),
            width: f64::from(params.width),
            sin_theta_o: u / u.hypot(v).hypot(w),
            errors: self.0,
        };
        // The cone inverts the difference of two arc tangents, rounded to 1e-7 rad, over its width: 2.1e-4 where it is narrow.
        let tolerance = Tolerance {
            direction: Some(3e-4),
            ..Tolerance::default()
        };
        Some(Expected {
            reference: Box::new(formulas),
            tolerance,
        })
    }
}

#[test]
fn the_sound_model_agrees() {
    agrees_with_reference(&Beside(Errors::default())).unwrap();
}

#[test]
fn each_error_is_found() {
    let none = Errors::default();
    let cases = [
        (
            Errors {
                value: 1e-4,
                ..none
            },
            "S is off",
        ),
        (Errors { pdf: -1e-4, ..none }, "density is off"),
        (Errors { lobe: 1e-4, ..none }, "lobe is off"),
        (
            Errors {
                choice: 0.01,
                ..none
            },
            "sample",
        ),
    ];
    for (errors, why) in cases {
        let failure = agrees_with_reference(&Beside(errors)).expect_err("the formulas are off");
        assert!(failure.message.contains(why), "{failure}");
    }
}
