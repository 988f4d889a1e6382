//! Cases of the tests: random shading points and directions over realistic hair.

use core::f64::consts::{FRAC_PI_2, PI, TAU};
use glam::Vec3;
use hairis::params::HairDesc;
use hairis_harness::subject::random_hair;
use hairis_instruments::direction::direction;
use hairis_instruments::sequence::Independent;

/// Region that `wi` was drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Region {
    /// Directions uniform on the sphere, as `wo` is.
    Sphere,
    /// Directions within a few widths of the centre of a lobe, in inclination and azimuth.
    Peaks,
    /// Directions of which `wo`, `wi` or both are between 1e-3 and 0.1 rad from the axis.
    Grazing,
    /// Directions with `|phi|` within 1e-4 to 1e-2 of pi.
    Back,
    /// Directions with `|phi|` within 1e-5 to 1e-2 of pi/2, where the glints' pdf is cut.
    GlintCut,
}

impl Region {
    pub(crate) const ALL: [Self; 5] = [
        Self::Sphere,
        Self::Peaks,
        Self::Grazing,
        Self::Back,
        Self::GlintCut,
    ];
}

/// Shading point and direction, with the region that the direction was drawn from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Case {
    pub(crate) region: Region,
    pub(crate) desc: HairDesc,
    pub(crate) wo: Vec3,
    pub(crate) wi: Vec3,
}

/// Least distance from the axis of the directions compared, rad.
const FROM_AXIS: f64 = 1e-3;

/// Least distance of a case from the jump of the pdf, rad. The pdf jumps by the glints' if `|phi|` is pi/2, and single precision resolves
/// `phi` only to some 1e-7 rad.
const CUT_BAND: f64 = 1e-6;

/// Sequence of cases, all from one seed.
pub(crate) struct Cases(Independent);

impl Cases {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Independent::new(seed, 0))
    }

    /// Draws the next case; the regions take turns.
    pub(crate) fn case(&mut self, i: usize) -> Case {
        let region = Region::ALL[i % Region::ALL.len()];
        let desc = self.desc();
        loop {
            let (wo, wi) = self.directions(region, &desc);
            let phi = angles(wo).1 - angles(wi).1;
            let from_cut = (phi.cos().asin()).abs();
            let off_axis = |w: Vec3| w.as_dvec3().y.hypot(w.as_dvec3().z) > FROM_AXIS;
            if from_cut > CUT_BAND && off_axis(wo) && off_axis(wi) {
                return Case {
                    region,
                    desc,
                    wo,
                    wi,
                };
            }
        }
    }

    /// Draws uniform numbers of 24 bits, exact in single precision; one in eight is at an end of the interval.
    pub(crate) fn xi(&mut self) -> [f64; 3] {
        const STEP: f64 = 1.0 / 16_777_216.0;
        [(); 3].map(|()| match self.0.next_below(16) {
            0 => 0.0,
            1 => 1.0 - STEP,
            _ => f64::from(self.0.next_f32()),
        })
    }

    fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.0.next_f64()
    }

    fn log_between(&mut self, lo: f64, hi: f64) -> f64 {
        self.between(lo.ln(), hi.ln()).exp()
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.0.next_f64() < probability
    }

    fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// Draws random hair, some of whose colours, channels and glints are 0.
    fn desc(&mut self) -> HairDesc {
        let mut desc = *random_hair(&mut self.0).expect("within range").desc();
        for color in [&mut desc.i_r, &mut desc.i_tt, &mut desc.i_trt] {
            let black = self.chance(0.2);
            for channel in color {
                if black || self.chance(0.1) {
                    *channel = 0.0;
                }
            }
        }
        if self.chance(0.1) {
            desc.i_g = 0.0;
        }
        desc
    }

    fn directions(&mut self, region: Region, desc: &HairDesc) -> (Vec3, Vec3) {
        let (mut cos_o, mut sin_o) = self.inclination();
        let phi_o = self.between(-PI, PI);
        let (mut cos_i, mut sin_i) = self.inclination();
        let mut phi = self.between(-PI, PI);
        match region {
            Region::Sphere => {}
            Region::Peaks => {
                let (alpha, beta) = [
                    (desc.alpha[0], desc.beta[0]),
                    (desc.alpha[1], desc.beta[1]),
                    (desc.alpha[2], desc.beta[2]),
                ][self.0.next_below(3)];
                let theta_h = f64::from(alpha) + f64::from(beta) * self.between(-4.0, 4.0);
                let theta_i = (2.0 * theta_h - sin_o.atan2(cos_o)).clamp(-FRAC_PI_2, FRAC_PI_2);
                (cos_i, sin_i) = (theta_i.cos(), theta_i.sin());
                phi = match self.0.next_below(3) {
                    0 => PI - f64::from(desc.gamma_tt) * self.between(-4.0, 4.0),
                    1 => {
                        self.sign()
                            * (f64::from(desc.phi_g)
                                + f64::from(desc.gamma_g) * self.between(-4.0, 4.0))
                    }
                    _ => phi,
                };
            }
            Region::Grazing => {
                let which = self.0.next_below(3);
                if which != 0 {
                    (cos_o, sin_o) = self.near_axis();
                }
                if which != 1 {
                    (cos_i, sin_i) = self.near_axis();
                }
            }
            Region::Back => phi = self.sign() * (PI - self.log_between(1e-4, 1e-2)),
            Region::GlintCut => {
                phi = self.sign() * (FRAC_PI_2 + self.sign() * self.log_between(1e-5, 1e-2))
            }
        }
        (
            direction(sin_o, cos_o, phi_o),
            direction(sin_i, cos_i, (phi_o - phi) % TAU),
        )
    }

    /// Returns cosine and sine of the inclination of a direction uniform on the sphere.
    fn inclination(&mut self) -> (f64, f64) {
        let sin: f64 = self.between(-1.0, 1.0);
        ((1.0 - sin * sin).sqrt(), sin)
    }

    /// Returns cosine and sine of an inclination 1e-3 to 0.1 rad from either end of the axis.
    fn near_axis(&mut self) -> (f64, f64) {
        let from_axis = self.log_between(FROM_AXIS, 0.1);
        (from_axis.sin(), from_axis.cos() * self.sign())
    }
}

/// Returns inclination and azimuth, in double precision.
pub(crate) fn angles(w: Vec3) -> (f64, f64) {
    let w = w.as_dvec3();
    (w.x.atan2(w.y.hypot(w.z)), w.z.atan2(w.y))
}
