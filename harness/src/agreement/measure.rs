//! The errors of one packet, by way of computing and quantity.

use super::packet::Packet;
use super::{Quantity, Region};
use crate::sampler::Sampler;
use crate::subject::{Subject, to_f64};
use core::f64::consts::TAU;
use glam::Vec3;
use hairis::textbook::{Oracle, Shape};
use hairis::{Bsdf, Bsdf8, Eval, Gather, HairParams, Level, Lobe, Model, Sample, Vec3x8};
use wide::f32x8;

/// What rounding may do to an azimuth, rad: a few units in the last place of a component near 1.
const ROUNDING: f64 = 1.0 / 4_194_304.0;

/// Below this the kernels' Gaussians are 0, which they reach between `2^-114` and `2^-115`.
const FLOOR: f64 = 1.0 / (1_u128 << 114) as f64;

/// Who computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// One direction a call.
    One,
    /// Eight directions at one gather point.
    Shared(Level),
    /// Eight gather points.
    Points(Level),
}

impl Way {
    /// Every way on this CPU.
    pub(super) fn all() -> Vec<Self> {
        let mut all = vec![Self::One];
        all.extend(Level::available().flat_map(|level| [Self::Shared(level), Self::Points(level)]));
        all
    }

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::One => "one lane",
            Self::Shared(_) => "eight lanes, one point",
            Self::Points(_) => "eight lanes, eight points",
        }
    }

    pub(super) const fn level(self) -> &'static str {
        match self {
            Self::One => "scalar",
            Self::Shared(level) | Self::Points(level) => level.name(),
        }
    }
}

/// One error, and where it was made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    pub(super) error: f64,
    /// Beyond the bound, and not because the azimuth is rounded.
    pub(super) unexplained: bool,
    pub(super) at: Place,
}

/// A lane of a packet: the gather point, and the direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) hair: HairParams,
    pub(super) wo: Vec3,
    pub(super) wi: Vec3,
    /// What `wi` was drawn with, if it was.
    pub(super) xi: Option<[f32; 3]>,
}

/// Calls `keep` with every error of the packet.
pub(super) fn measure<M>(
    subject: &Subject<M>,
    region: Region,
    packet: &Packet,
    way: Way,
    keep: &mut impl FnMut(Quantity, Measured),
) where
    M: Model<Params = HairParams>,
{
    let bsdfs = packet.hair.map(|hair| Bsdf::new(&subject.model, &hair));
    let xi: [f32x8; 3] = core::array::from_fn(|k| f32x8::new(packet.xi.map(|xi| xi[k])));
    let answers = |k: usize, gather: &Gather<M>| (gather.eval_pdf(packet.wi[k]), gather.sample(packet.xi[k]));
    let answers: [(Eval, Option<Sample>); 8] = match way {
        Way::One => core::array::from_fn(|k| answers(k, &bsdfs[k].prepare(packet.wo[k]))),
        Way::Shared(level) => {
            let gather = bsdfs[0].prepare(packet.wo[0]);
            let eval = gather.eval_pdf8_at(level, &Vec3x8::from(packet.wi_shared));
            let sample = gather.sample8_at(level, &xi);
            core::array::from_fn(|k| (eval.lane(k), sample.lane(k)))
        }
        Way::Points(level) => {
            let gather = Bsdf8::pack(bsdfs.each_ref()).prepare8_at(level, &Vec3x8::from(packet.wo));
            let eval = gather.eval_pdf8_at(level, &Vec3x8::from(packet.wi));
            let sample = gather.sample8_at(level, &xi);
            core::array::from_fn(|k| (eval.lane(k), sample.lane(k)))
        }
    };
    for (k, (eval, sample)) in answers.iter().enumerate() {
        let (point, wi) = if matches!(way, Way::Shared(_)) { (0, packet.wi_shared[k]) } else { (k, packet.wi[k]) };
        let exact = Exact {
            oracle: &packet.oracle[point],
            shape: subject.shape,
            sampler: subject.sampler,
            place: Place { hair: packet.hair[point], wo: packet.wo[point], wi, xi: None },
        };
        if region.holds(exact.place.wo, wi) {
            exact.of_eval(eval, keep);
        }
        if let Some(sample) = sample.filter(|sample| region.holds(exact.place.wo, sample.wi)) {
            let place = Place { wi: sample.wi, xi: Some(packet.xi[k]), ..exact.place };
            Exact { place, ..exact }.of_sample(packet.xi[k], &sample, keep);
        }
    }
}

/// The oracle at one place.
struct Exact<'a> {
    oracle: &'a Oracle<f64>,
    shape: Shape,
    sampler: Sampler,
    place: Place,
}

impl Exact<'_> {
    fn of_eval(&self, eval: &Eval, keep: &mut impl FnMut(Quantity, Measured)) {
        let value = self.compare(Quantity::Value, eval.value, |wi| self.oracle.eval(wi), self.floor());
        keep(Quantity::Pdf, self.compare(Quantity::Pdf, [eval.pdf], |wi| [self.oracle.pdf(wi)], self.pdf_floor()));
        keep(Quantity::Value, value);
    }

    fn of_sample(&self, xi: [f32; 3], sample: &Sample, keep: &mut impl FnMut(Quantity, Measured)) {
        let over_pdf = |wi: [f64; 3]| wi[1].hypot(wi[2]) / self.oracle.pdf(wi);
        let (floor, scale) = (self.floor(), over_pdf(to_f64(self.place.wi)));
        let pdf = self.compare(Quantity::SamplePdf, [sample.pdf], |wi| [self.oracle.pdf(wi)], self.pdf_floor());
        let value = self.compare(Quantity::SampleValue, sample.value, |wi| self.oracle.eval(wi), floor);
        let weight = |wi: [f64; 3]| self.oracle.eval(wi).map(|s| s * over_pdf(wi));
        let weight = self.compare(Quantity::SampleWeight, sample.weight, weight, floor.map(|f| f * scale));
        keep(Quantity::SamplePdf, pdf);
        keep(Quantity::SampleValue, value);
        keep(Quantity::SampleWeight, weight);
        keep(Quantity::SampleCdf, self.cdf(xi, sample.lobe));
    }

    /// The error of `got` against `truth` at the direction.
    fn compare<const N: usize>(
        &self,
        quantity: Quantity,
        got: [f32; N],
        truth: impl Fn([f64; 3]) -> [f64; N],
        floor: [f64; N],
    ) -> Measured {
        let wi = to_f64(self.place.wi);
        let want = truth(wi);
        let worst = |slack: [f64; N]| (0..N).map(|c| relative(got[c], want[c], slack[c])).fold(0.0, f64::max);
        let error = worst(floor);
        let bound = quantity.bound(self.shape, self.sampler);
        let unexplained = error > bound && {
            let (low, high) = (truth(turned(wi, -ROUNDING)), truth(turned(wi, ROUNDING)));
            worst(core::array::from_fn(|c| floor[c] + (low[c] - want[c]).abs().max((high[c] - want[c]).abs()))) > bound
        };
        Measured { error, unexplained, at: self.place }
    }

    /// How far the cdf of the lobe at the direction is from the numbers it was drawn with, on the circle of length 1:
    /// both ends of the cosines' cdf are the same direction.
    fn cdf(&self, xi: [f32; 3], lobe: Lobe) -> Measured {
        let wi = to_f64(self.place.wi);
        let turn = azimuth(to_f64(self.place.wo)) - azimuth(wi);
        let phi = turn - TAU * (turn / TAU).round();
        let cdf = self.oracle.cdf(lobe, inclination(wi), phi);
        let off = |k: usize| (cdf[k] - f64::from(xi[k + 1])).abs();
        let error = off(0).max(off(1).min((1.0 - off(1)).abs()));
        Measured { error, unexplained: error > Quantity::SampleCdf.bound(self.shape, self.sampler), at: self.place }
    }

    /// How far a Gaussian value may be off by design: the kernel's bells end at `2^-114`, each of the four lobes.
    fn floor(&self) -> [f64; 3] {
        if self.shape != Shape::Gaussian {
            return [0.0; 3];
        }
        let [theta_o, theta_i] = [self.place.wo, self.place.wi].map(|v| inclination(to_f64(v)));
        let cos_theta_d = (0.5 * (theta_o - theta_i)).cos();
        let d = self.place.hair.desc();
        core::array::from_fn(|c| {
            let intensity = d.intensity_r[c] + d.intensity_tt[c] + d.intensity_trt[c] * (1.0 + d.intensity_g);
            f64::from(intensity) * FLOOR / (cos_theta_d * cos_theta_d)
        })
    }

    /// How far a density may be off by design: a matched one is S, as the mean of RGB, times what depends on the
    /// inclination alone, and ends with it.
    fn pdf_floor(&self) -> [f64; 1] {
        if self.sampler.bands().is_none() || self.shape != Shape::Gaussian {
            return [0.0];
        }
        let wi = to_f64(self.place.wi);
        let (floor, value): (f64, f64) = (self.floor().iter().sum(), self.oracle.eval(wi).iter().sum());
        // Where S is too small for a double, the density may end altogether.
        let share = if value > 0.0 { floor / value } else { 1.0 };
        [share * self.oracle.pdf(wi)]
    }
}

/// Relative error beyond an absolute one of `floor`; NaN counts as infinite.
fn relative(got: f32, want: f64, floor: f64) -> f64 {
    let excess = (f64::from(got) - want).abs() - floor;
    if excess <= 0.0 {
        0.0
    } else if excess.is_finite() {
        excess / want
    } else {
        f64::INFINITY
    }
}

fn inclination([u, v, w]: [f64; 3]) -> f64 {
    u.atan2(v.hypot(w))
}

fn azimuth([_, v, w]: [f64; 3]) -> f64 {
    w.atan2(v)
}

/// The direction turned about the fibre by `angle` rad.
fn turned([u, v, w]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [u, v * cos - w * sin, v * sin + w * cos]
}
