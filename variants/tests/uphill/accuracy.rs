//! Errors against the formulas in double precision, over those that `Formulas::ACCURACY` allows.

use crate::energy::any_hair;
use crate::point::{Coordinates, Point};
use crate::{Arithmetic, Bound};
use glam::Vec3;
use hairis::simd::f32x8;
use hairis::{Eval, Lobe, Sample, Vec3x8};
use hairis_conformance::published::support::{double, narrow};
use hairis_reference::agreement::{
    AXIS, azimuth_between, cdf_distance, from_axis, is_bounded, relative_excess,
};
use hairis_reference::{Reference, accuracy, slack};
use hairis_variants::{ModelId, Values};

/// Angle to the axis from which directions are drawn: rounding leaves it above [`AXIS`].
pub(crate) const DRAWN: f64 = 1.001e-3;
/// Value and density below which bells come to their end.
const LEAST: f64 = 1e-22;

/// Returns true if the bounds apply to these directions.
fn holds(wo: [f64; 3], wi: [f64; 3]) -> bool {
    from_axis(wo) > AXIS && is_bounded(wo, wi)
}

/// Evaluates a direction on every path of an arithmetic.
pub(crate) fn evals(point: &Point, wi: Vec3, arithmetic: Arithmetic) -> Vec<Eval> {
    let Arithmetic::Fused(level) = arithmetic else {
        return vec![point.prepare().eval_pdf(wi)];
    };
    let wi = Vec3x8::from([wi; 8]);
    let shared = point.prepare().with_level(level).eval_pdf8(&wi);
    let each = point.material.with_level(level).prepare8(point.hits());
    vec![shared.lane(0), each.eval_pdf8(&wi).lane(0)]
}

/// Draws a sample on every path of an arithmetic.
pub(crate) fn samples(point: &Point, xi: [f32; 3], arithmetic: Arithmetic) -> Vec<Option<Sample>> {
    let Arithmetic::Fused(level) = arithmetic else {
        return vec![point.prepare().sample(xi)];
    };
    let xi = xi.map(f32x8::splat);
    let shared = point.prepare().with_level(level).sample8(&xi);
    let each = point.material.with_level(level).prepare8(point.hits());
    vec![shared.lane(0), each.sample8(&xi).lane(0)]
}

/// Formulas at a direction.
struct Truth {
    wi: [f64; 3],
    value: [f64; 3],
    pdf: f64,
    /// Absolute errors that the model allows by design.
    slack: [f64; 3],
    pdf_slack: f64,
}

impl Truth {
    fn new(point: &Point, formulas: &dyn Reference<f64>, wi: Vec3) -> Self {
        let wi = double(wi);
        let (value, pdf) = formulas.eval_pdf(wi);
        let slack = slack(point.model, &point.values, point.wo(), wi)
            .unwrap_or_else(|error| panic!("{error}"));
        Self {
            wi,
            value,
            pdf,
            slack,
            pdf_slack: accuracy(point.model).pdf_slack(value, pdf, slack),
        }
    }

    fn value_error(&self, got: [f32; 3]) -> f64 {
        self.error(got, 1.0)
    }

    fn pdf_error(&self, got: f32) -> f64 {
        relative_excess(got, self.pdf, self.pdf_slack)
    }

    fn weight_error(&self, got: [f32; 3]) -> f64 {
        self.error(got, self.wi[1].hypot(self.wi[2]) / self.pdf)
    }

    fn error(&self, got: [f32; 3], by: f64) -> f64 {
        (0..3)
            .map(|c| relative_excess(got[c], by * self.value[c], by * self.slack[c]))
            .fold(0.0, f64::max)
    }
}

/// Returns a random material for which the bounds are stated.
pub(crate) fn everyday(model: ModelId, at: &mut Coordinates<'_>) -> Point {
    let mut values = at.values(model);
    if values.index("kd").is_some() {
        // A darker diffuse lobe leaves the far tail of the other alone.
        let kd: [f32; 3] = values.get("kd");
        // Below 2 the density is conditioned worse: see the documentation of the model.
        let exponent = narrow(at.scale(1.0, 1e3)).clamp(2.0, 1e3);
        at.note("exponent from 2 to 1000", &exponent);
        values = values
            .with("kd", &kd.map(|kd| kd.max(0.02)))
            .with("exponent", &[exponent]);
    }
    Point::new(model, values, at.hit(DRAWN))
}

/// Returns any legal material, for which errors are bounded by argument.
fn any(model: ModelId, at: &mut Coordinates<'_>) -> Point {
    let values = match model {
        ModelId::KajiyaKay => any_kajiya_kay(at),
        ModelId::Chiang => any_chiang(at),
        ModelId::DEon => any_d_eon(at),
        _ => any_hair(at),
    };
    Point::new(model, values, at.hit(DRAWN))
}

fn any_kajiya_kay(at: &mut Coordinates<'_>) -> Values {
    let exponent = narrow(at.scale(1.0, 1e4)).clamp(1.0, 1e4);
    // Down to next to nothing, so that the highlight is seen alone.
    let dark = narrow(at.scale(1e-20, 1.0));
    let values = at.values(ModelId::KajiyaKay);
    let kd: [f32; 3] = values.get("kd");
    at.note("exponent, factor on kd", &(exponent, dark));
    values
        .with("exponent", &[exponent])
        .with("kd", &kd.map(|kd| kd * dark))
}

/// Returns fibres of any roughness, each lobe up to twice as wide or narrow, with absorptions up to 6.
fn any_chiang(at: &mut Coordinates<'_>) -> Values {
    let mut values = at.values(ModelId::Chiang);
    let quarter = f64::from(core::f32::consts::FRAC_PI_4);
    for (name, count, [lo, hi], is_log) in [
        ("beta_m", 1, [1e-3, 1.0], true),
        ("beta_n", 1, [1e-3, 1.0], true),
        ("tilt", 1, [-quarter, quarter], false),
        ("eta", 1, [1.0, 4.0], false),
        ("sigma_a", 3, [1e-3, 6.0], true),
        ("width_m", 3, [0.5, 2.0], true),
        ("width_n", 3, [0.5, 2.0], true),
    ] {
        values = at.numbers(values, name, count, [lo, hi], is_log);
    }
    values
}

/// Returns fibres of any roughness, tilt and index, with absorptions up to 6.
fn any_d_eon(at: &mut Coordinates<'_>) -> Values {
    let mut values = at.values(ModelId::DEon);
    let quarter = f64::from(core::f32::consts::FRAC_PI_4);
    for (name, count, [lo, hi], is_log) in [
        ("roughness", 1, [0.01, 1.0], true),
        ("tilt", 1, [-quarter, quarter], false),
        ("eta", 1, [1.1, 3.0], false),
        ("sigma_a", 3, [1e-3, 6.0], true),
        ("diffuse", 1, [0.0, 1.0], false),
    ] {
        values = at.numbers(values, name, count, [lo, hi], is_log);
    }
    values
}

/// Returns true if the formulas of a model bound its errors by argument.
fn has_error_bound(model: ModelId) -> bool {
    let point = Point::new(model, model.measured(), Vec3::Y.into());
    point.reference().error_bound([0.0, 0.0, 1.0]).is_some()
}

/// Returns the largest error of a random material at a direction.
fn of_direction(
    model: ModelId,
    at: &mut Coordinates<'_>,
    arithmetic: Arithmetic,
    error: fn(&Truth, &Eval) -> f64,
) -> f64 {
    let point = everyday(model, at);
    let wi = at.direction(DRAWN, &point.hit);
    if !holds(point.wo(), double(wi)) {
        return 0.0;
    }
    let truth = Truth::new(&point, &*point.reference(), wi);
    let errors = evals(&point, wi, arithmetic).into_iter();
    errors.map(|eval| error(&truth, &eval)).fold(0.0, f64::max)
}

/// Returns the largest errors of S and of the density over those of `Reference::error_bound`, for any material.
fn over_bound(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> [f64; 2] {
    let point = any(model, at);
    let wi = at.direction(DRAWN, &point.hit);
    if !holds(point.wo(), double(wi)) {
        return [0.0; 2];
    }
    let formulas = point.reference();
    let is_black = || formulas.albedo().0.iter().flatten().all(|x| *x < 1e-20);
    if model == ModelId::Chiang && is_black() {
        // A fibre that absorbs everything scatters nothing.
        return [0.0; 2];
    }
    let mut truth = Truth::new(&point, &*formulas, wi);
    if matches!(model, ModelId::KajiyaKay | ModelId::Chiang | ModelId::DEon) {
        // The end of the bells alone: the bound by argument grows with their exponents.
        (truth.slack, truth.pdf_slack) = ([LEAST; 3], LEAST);
    }
    let Some((allowed, allowed_pdf)) = formulas.error_bound(truth.wi) else {
        return [0.0; 2];
    };
    // The bound is exactly 1 for a lobe that is not sampled, whose density is missing as a whole: nothing is left to search there.
    let (errors, lobes, shares) = (
        formulas.lobe_errors(truth.wi).unwrap(),
        formulas.lobes(truth.wi),
        formulas.probabilities(),
    );
    let is_lost = Lobe::ALL
        .into_iter()
        .any(|lobe| errors[lobe][1] == 1.0 && shares[lobe] * lobes[lobe].pdf > 1e-3 * truth.pdf);
    let mut worst = [0.0_f64; 2];
    for got in evals(&point, wi, arithmetic) {
        let over = |got: f32, want: f64, allowed: f64, cut: f64| {
            // A denormal has no more digits than its distance from 0.
            let error = (f64::from(got) - want).abs() - cut - f64::from(f32::MIN_POSITIVE);
            if error > 0.0 { error / allowed } else { 0.0 }
        };
        for (c, allowed) in allowed.into_iter().enumerate() {
            let of = over(got.value[c], truth.value[c], allowed, truth.slack[c]);
            worst[0] = worst[0].max(of);
        }
        if !is_lost {
            worst[1] = worst[1].max(over(got.pdf, truth.pdf, allowed_pdf, truth.pdf_slack));
        }
    }
    worst
}

/// Returns the largest error of a random material's sample.
fn of_sample(
    model: ModelId,
    at: &mut Coordinates<'_>,
    arithmetic: Arithmetic,
    error: fn(&Truth, &Sample, &SampledBy<'_>) -> f64,
) -> f64 {
    let point = everyday(model, at);
    let xi = at.xi3();
    let formulas = point.reference();
    let drawn = samples(&point, xi, arithmetic).into_iter().flatten();
    let errors = drawn
        .filter(|sample| holds(point.wo(), double(sample.wi)))
        .map(|sample| {
            let by = SampledBy {
                wo: point.wo(),
                formulas: &*formulas,
                xi,
            };
            error(&Truth::new(&point, &*formulas, sample.wi), &sample, &by)
        });
    errors.fold(0.0, f64::max)
}

/// Formulas and numbers of a sample.
struct SampledBy<'a> {
    wo: [f64; 3],
    formulas: &'a dyn Reference<f64>,
    xi: [f32; 3],
}

impl SampledBy<'_> {
    /// Returns the distance of the numbers from the distribution at the sample's direction, 0 for a model without one.
    fn cdf_error(&self, sample: &Sample) -> f64 {
        let wi = double(sample.wi);
        let theta_i = wi[0].atan2(wi[1].hypot(wi[2]));
        let phi = azimuth_between(self.wo, wi);
        let cdf = self.formulas.cdf(sample.lobe, theta_i, phi);
        cdf_distance(cdf.unwrap_or_default(), self.xi)
    }
}

/// Returns the bounds on the accuracy of a model. S does not depend on the sampler.
pub(crate) fn bounds(model: ModelId) -> Vec<Bound> {
    let allowed = accuracy(model);
    let direction = |quantity, stated, error| {
        Bound::new(quantity, model, stated, move |at, arithmetic| {
            of_direction(model, at, arithmetic, error)
        })
    };
    let sample = |quantity, stated, error| {
        Bound::new(quantity, model, stated, move |at, arithmetic| {
            of_sample(model, at, arithmetic, error)
        })
    };
    let mut all = Vec::new();
    if model.is_default() {
        all.push(direction("S", allowed.value, |truth, eval| {
            truth.value_error(eval.value)
        }));
    }
    all.extend([
        direction("density", allowed.pdf, |truth, eval| {
            truth.pdf_error(eval.pdf)
        }),
        sample("S of a sample", allowed.sample_value, |truth, sample, _| {
            truth.value_error(sample.value)
        }),
        sample(
            "density of a sample",
            allowed.sample_pdf,
            |truth, sample, _| truth.pdf_error(sample.pdf),
        ),
        sample(
            "weight of a sample",
            allowed.sample_weight,
            |truth, sample, _| truth.weight_error(sample.weight),
        ),
    ]);
    if has_error_bound(model) {
        for (result, quantity) in ["S over its error bound", "density over its error bound"]
            .into_iter()
            .enumerate()
            .skip(usize::from(!model.is_default()))
        {
            all.push(Bound::new(quantity, model, 1.0, move |at, arithmetic| {
                over_bound(model, at, arithmetic)[result]
            }));
        }
    }
    if allowed.cdf > 0.0 {
        all.push(sample(
            "numbers of a sample",
            allowed.cdf,
            |_, sample, by| by.cdf_error(sample),
        ));
    }
    all
}
