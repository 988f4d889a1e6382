//! Errors of one packet, by code path and quantity.

use super::packet::{Exact, Packet};
use super::{Quantity, Region};
use glam::Vec3;
use hairis::simd::Level;
use hairis::{Eval, Hit, Lobe, ParamError, Sample, Vec3x8};
use hairis_instruments::direction::to_f64;
use hairis_reference::agreement::{azimuth_between, cdf_distance, relative_excess};
use hairis_reference::{Accuracy, Reference, accuracy};
use hairis_variants::{AnyMaterial8, ModelId, Values};
use wide::f32x8;

/// Rounding error of an azimuth, rad: a few units in the last place of a component near 1.
const ROUNDING: f64 = 1.0 / 4_194_304.0;

/// Code path of the kernels, with the instruction set of its lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CodePath {
    /// One direction per call.
    One,
    /// Eight directions at one shading point.
    Shared(Level),
    /// Eight shading points.
    Points(Level),
}

impl CodePath {
    /// Every code path on this CPU.
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

/// Error of one quantity, and where it occurred.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocatedError {
    pub(super) error: f64,
    /// Whether the error is beyond the bound and rounding the azimuth does not explain it.
    pub(super) unexplained: bool,
    pub(super) at: LanePlace,
}

/// Lane of a packet: the shading point and the direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct LanePlace {
    pub(super) values: Values,
    pub(super) wo: Vec3,
    pub(super) h: f32,
    pub(super) wi: Vec3,
    /// Uniform numbers that `wi` was sampled with, if any.
    pub(super) xi: Option<[f32; 3]>,
}

/// Calls `keep` with every error of the packet.
pub(super) fn measure(
    model: ModelId,
    region: Region,
    packet: &mut Packet,
    path: CodePath,
    keep: &mut impl FnMut(Quantity, LocatedError),
) -> Result<(), ParamError> {
    let materials = &packet.materials;
    let hit = |k: usize| Hit {
        wo: packet.wo[k].into(),
        h: packet.h[k],
    };
    let xi: [f32x8; 3] = core::array::from_fn(|k| f32x8::new(packet.xi.map(|xi| xi[k])));
    let answers: [(Eval, Option<Sample>); 8] = match path {
        CodePath::One => core::array::from_fn(|k| {
            let bsdf = materials[k].prepare(hit(k));
            (bsdf.eval_pdf(packet.wi[k]), bsdf.sample(packet.xi[k]))
        }),
        CodePath::Shared(level) => {
            let bsdf = materials[0].prepare(hit(0));
            let eval = bsdf
                .with_level(level)
                .eval_pdf8(&Vec3x8::from(packet.wi_shared));
            let sample = bsdf.with_level(level).sample8(&xi);
            core::array::from_fn(|k| (eval.lane(k), sample.lane(k)))
        }
        CodePath::Points(level) => {
            let hits = Hit {
                wo: Vec3x8::from(packet.wo),
                h: f32x8::new(packet.h),
            };
            let materials = AnyMaterial8::pack(core::array::from_fn(|k| &materials[k]))
                .expect("eight of one model");
            let bsdf = materials.with_level(level).prepare8(hits);
            let eval = bsdf.with_level(level).eval_pdf8(&Vec3x8::from(packet.wi));
            let sample = bsdf.with_level(level).sample8(&xi);
            core::array::from_fn(|k| (eval.lane(k), sample.lane(k)))
        }
    };
    for (k, (eval, sample)) in answers.iter().enumerate() {
        let (point, wi) = if matches!(path, CodePath::Shared(_)) {
            (0, packet.wi_shared[k])
        } else {
            (k, packet.wi[k])
        };
        let drawn = sample.map(|s| {
            (
                s.wi,
                Eval {
                    value: s.value,
                    pdf: s.pdf,
                },
                Some(s),
            )
        });
        let compared = [(wi, *eval, None)].into_iter().chain(drawn);
        let (values, wo, h) = (packet.values[point], packet.wo[point], packet.h[point]);
        for (wi, eval, sample) in compared.filter(|(wi, ..)| region.holds(wo, *wi)) {
            let place = LanePlace {
                values,
                wo,
                h,
                wi,
                xi: sample.map(|_| packet.xi[k]),
            };
            let exact = packet.exact(model, point, wi)?;
            let comparison = AtPlace {
                accuracy: accuracy(model),
                truth: &*packet.truth[point].formulas,
                exact,
                place,
            };
            comparison.errors(&eval, sample, keep);
        }
    }
    Ok(())
}

/// Formulas at one place, which the kernels are compared with.
struct AtPlace<'a> {
    accuracy: Accuracy,
    truth: &'a dyn Reference<f64>,
    exact: Exact,
    place: LanePlace,
}

impl AtPlace<'_> {
    /// Passes to `keep` the errors of value and density at the direction and, if the direction is a sample, those of its weight and cdf.
    fn errors(
        &self,
        eval: &Eval,
        sample: Option<Sample>,
        keep: &mut impl FnMut(Quantity, LocatedError),
    ) {
        use Quantity::{Pdf, SampleCdf, SamplePdf, SampleValue, SampleWeight, Value};
        let [pdf, value] = if sample.is_some() {
            [SamplePdf, SampleValue]
        } else {
            [Pdf, Value]
        };
        let Exact {
            value: exact,
            pdf: density,
            slack,
        } = self.exact;
        let pdf_slack = self.accuracy.pdf_slack(exact, density, slack);
        keep(
            pdf,
            self.compare(pdf, [eval.pdf], [pdf_slack], |_, _, pdf| [pdf]),
        );
        keep(
            value,
            self.compare(value, eval.value, slack, |_, value, _| value),
        );
        let Some(sample) = sample else { return };
        let weight = |wi: [f64; 3], value: [f64; 3], pdf: f64| {
            let over_pdf = wi[1].hypot(wi[2]) / pdf;
            value.map(|s| s * over_pdf)
        };
        let slack = weight(to_f64(self.place.wi), slack, density);
        keep(
            SampleWeight,
            self.compare(SampleWeight, sample.weight, slack, weight),
        );
        if let Some(cdf) = self.cdf(sample.lobe) {
            keep(SampleCdf, cdf);
        }
    }

    /// Returns the error of `got` against what `of` makes of the direction, its value and its density.
    fn compare<const N: usize>(
        &self,
        quantity: Quantity,
        got: [f32; N],
        slack: [f64; N],
        of: impl Fn([f64; 3], [f64; 3], f64) -> [f64; N],
    ) -> LocatedError {
        let wi = to_f64(self.place.wi);
        let want = of(wi, self.exact.value, self.exact.pdf);
        let worst = |slack: [f64; N]| {
            (0..N)
                .map(|c| relative_excess(got[c], want[c], slack[c]))
                .fold(0.0, f64::max)
        };
        let error = worst(slack);
        let bound = quantity.bound(&self.accuracy);
        let unexplained = error > bound && {
            let [low, high] = [-ROUNDING, ROUNDING].map(|angle| {
                let wi = rotate(wi, angle);
                let (value, pdf) = self.truth.eval_pdf(wi);
                of(wi, value, pdf)
            });
            worst(core::array::from_fn(|c| {
                slack[c] + (low[c] - want[c]).abs().max((high[c] - want[c]).abs())
            })) > bound
        };
        LocatedError {
            error,
            unexplained,
            at: self.place,
        }
    }

    /// Returns the distance of the lobe's cdf at the direction from the numbers that the direction was sampled with. Azimuths are compared
    /// on a circle of length 1, because both ends of the cosines' cdf are the same direction.
    fn cdf(&self, lobe: Lobe) -> Option<LocatedError> {
        let (xi, wi) = (self.place.xi?, to_f64(self.place.wi));
        let phi = azimuth_between(to_f64(self.place.wo), wi);
        let theta_i = wi[0].atan2(wi[1].hypot(wi[2]));
        let error = cdf_distance(self.truth.cdf(lobe, theta_i, phi)?, xi);
        Some(LocatedError {
            error,
            unexplained: error > self.accuracy.cdf,
            at: self.place,
        })
    }
}

/// Returns the direction turned about the fibre by `angle` rad.
fn rotate([u, v, w]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [u, v * cos - w * sin, v * sin + w * cos]
}
