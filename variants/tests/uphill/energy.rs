//! Bounds on energy: albedos, energy conservation and its fits, weights, reciprocity and integrals of densities.

use crate::accuracy::{DRAWN, evals, everyday, samples};
use crate::point::{Coordinates, Point};
use crate::{Arithmetic, Bound};
use core::f64::consts::{FRAC_PI_2, PI};
use glam::Vec3;
use hairis::params::{HairDesc, MAX_WIDTH, MIN_WIDTH};
use hairis::{Lobe, LobeMask, PerLobe};
use hairis_conformance::published::albedo::{exact, unexplained};
use hairis_conformance::published::quadrature::{integrate, panels};
use hairis_conformance::published::support::{direction, double, narrow};
use hairis_reference::{ChiangFormulas as _, ChiangReference, Selection, Shape};
use hairis_variants::{AnyBsdf, ChiangParams, ModelId, Parameters as _, Values, hair_desc};

/// Least angle of `wo` to the axis, in rad.
const POLE: f64 = 1.001e-5;
/// Relative error of the albedo of a lobe of any width, by the documentation of `Bsdf::albedo`.
const ALBEDO: f64 = 1e-4;

/// Returns the albedo of each channel.
fn channels<T: Into<f64> + Copy>(PerLobe(lobes): PerLobe<[T; 3]>) -> [f64; 3] {
    [0, 1, 2].map(|c| lobes.iter().map(|lobe| lobe[c].into()).sum())
}

fn most(numbers: impl IntoIterator<Item = f64>) -> f64 {
    // A maximum ignores NaN, which is the largest of all errors.
    numbers.into_iter().max_by(f64::total_cmp).unwrap_or(0.0)
}

/// Returns any legal hair, with intensities from 1e-4 to 1e4.
pub(crate) fn any_hair(at: &mut Coordinates<'_>) -> Values {
    let [least, widest] = [MIN_WIDTH, MAX_WIDTH].map(f64::from);
    let right = f64::from(core::f32::consts::FRAC_PI_2);
    let mut values = ModelId::Gaussian.measured();
    for (name, count, range, is_log) in [
        ("alpha", 3, [-right, right], false),
        ("beta", 3, [least, widest], true),
        ("gamma_tt", 1, [least, widest], true),
        ("gamma_g", 1, [least, widest], true),
        ("phi_g", 1, [0.0, f64::from(core::f32::consts::PI)], false),
        ("i_r", 3, [1e-4, 1e4], true),
        ("i_tt", 3, [1e-4, 1e4], true),
        ("i_trt", 3, [1e-4, 1e4], true),
        ("i_g", 1, [1e-4, 1e4], true),
    ] {
        values = at.numbers(values, name, count, range, is_log);
    }
    values
}

/// Returns a point of any legal hair.
fn any_point(model: ModelId, at: &mut Coordinates<'_>) -> Point {
    let values = any_hair(at);
    Point::new(model, values, at.hit(POLE))
}

/// Returns the shading point, prepared by an arithmetic.
fn prepared(point: &Point, arithmetic: Arithmetic) -> AnyBsdf {
    match arithmetic {
        Arithmetic::OneLane => point.prepare(),
        Arithmetic::Fused(level) => {
            let eight = point.material.with_level(level).prepare8(point.hits());
            eight.lane(0)
        }
    }
}

/// Returns the description of hair with which the formulas compute, and the inclination of `wo`.
fn described(point: &Point) -> (HairDesc<f64>, f64) {
    let [u, v, w] = point.wo();
    (hair_desc(&point.values.map(f64::from)), u.atan2(v.hypot(w)))
}

fn shape(model: ModelId) -> Shape {
    if model == ModelId::Gaussian {
        Shape::Gaussian
    } else {
        Shape::Cauchy
    }
}

/// Returns the largest error of a lobe's albedo, beyond what the rounding of an angle explains.
fn hair_albedo_error(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let point = any_point(model, at);
    let got = prepared(&point, arithmetic).albedo();
    let (p, theta_o) = described(&point);
    let colors = [p.i_r, p.i_tt, p.i_trt, p.i_trt].map(|rgb| rgb[0]);
    most(Lobe::FOUR.map(|lobe| {
        let got = f64::from(got[lobe][0]) / colors[lobe.index()];
        unexplained((shape(model), &p, theta_o), (lobe, got), 0.0)
    }))
}

/// Returns the largest error of a lobe's albedo, relative to at least 1e-3.
fn albedo_error(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let point = Point::random(model, at, POLE);
    let got = prepared(&point, arithmetic).albedo().0;
    let want = point.reference().albedo().0;
    let errors = got.iter().flatten().zip(want.iter().flatten());
    most(errors.map(|(got, want)| (f64::from(*got) - want).abs() / want.max(1e-3)))
}

/// Returns the relative error of a conserving material's albedo against the light that the formulas return, at most 1.
fn conserving_error(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let raw = any_point(model, at);
    let (p, theta_o) = described(&raw);
    let PerLobe([r, tt, trt, glint, _]) = exact(shape(model), &p, theta_o);
    let point = Point {
        material: raw.material.conserving(),
        ..raw
    };
    let got = channels(prepared(&point, arithmetic).albedo());
    most((0..3).map(|c| {
        let sum = r * p.i_r[c] + tt * p.i_tt[c] + (trt + glint) * p.i_trt[c];
        let want = sum.min(1.0);
        (got[c] - want).abs() / want.max(1e-6)
    }))
}

fn conserved(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let raw = any_point(model, at);
    let point = Point {
        material: raw.material.conserving(),
        ..raw
    };
    most(channels(prepared(&point, arithmetic).albedo()))
}

/// Returns the largest albedo of any direction over the bound of `max_albedo`.
fn over_max_albedo(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let point = any_point(model, at);
    let albedo = most(channels(prepared(&point, arithmetic).albedo()));
    albedo / f64::from(point.material.max_albedo())
}

/// Returns the relative difference of S with its directions exchanged, beyond what the model cuts off.
fn asymmetry(point: &Point, wi: Vec3, arithmetic: Arithmetic) -> f64 {
    let back = Point {
        hit: wi.into(),
        ..*point
    };
    let [forth, back] = [(point, wi), (&back, point.hit.wo.into())]
        .map(|(point, wi)| evals(point, wi, arithmetic).swap_remove(0).value);
    let slack = hairis_reference::slack(point.model, &point.values, point.wo(), double(wi))
        .unwrap_or_else(|error| panic!("{error}"));
    let errors = (0..3).map(|c| {
        let [forth, back] = [forth[c], back[c]].map(f64::from);
        let excess = ((forth - back).abs() - 2.0 * slack[c]).max(0.0);
        if excess > 0.0 {
            excess / forth.max(back)
        } else {
            excess
        }
    });
    most(errors)
}

/// Returns the peaks and widths of a lobe in inclination and in azimuth, relative to that of `wo`.
fn bells(point: &Point, lobe: Lobe) -> [Vec<(f64, f64)>; 2] {
    let number = |name: &str, k: usize| f64::from(point.values.numbers(name)[k]);
    let [u, v, w] = point.wo();
    let theta_o = u.atan2(v.hypot(w));
    let l = lobe.index().min(2);
    if point.values.index("alpha").is_some() {
        let centre = 2.0 * number("alpha", l) - theta_o;
        let azimuth = match lobe {
            Lobe::TT => (PI, number("gamma_tt", 0)),
            Lobe::GLINT => (number("phi_g", 0), number("gamma_g", 0)),
            _ => (0.0, 1.0),
        };
        let opposite = (azimuth.0 - 2.0 * azimuth.0, azimuth.1);
        return [vec![(centre, number("beta", l))], vec![azimuth, opposite]];
    }
    if point.model.name() == ModelId::Chiang.name() {
        let desc = ChiangParams::from_values(&point.values)
            .unwrap_or_else(|error| panic!("{error}"))
            .desc()
            .map(f64::from);
        let h = f64::from(point.hit.h);
        let formulas = ChiangReference::prepare(&desc, Selection::Mean, point.wo(), h);
        let (centre, scale) = (formulas.centre(lobe), desc.scales()[lobe]);
        let centre = (-centre.sin()).atan2(centre.cos());
        // The trimmed logistic has a kink half a turn from its centre.
        let azimuths = [0.0, -2.0 * PI, 2.0 * PI, PI, -PI].map(|turn| (centre + turn, scale));
        let width = desc.variances()[lobe].sqrt();
        return [vec![(formulas.cone(lobe), width)], azimuths.to_vec()];
    }
    let width = number("exponent", 0).sqrt().recip();
    let ends = [FRAC_PI_2, -FRAC_PI_2].map(|end| (end - 2.0 * theta_o, width));
    let mut inclination = vec![(-theta_o, width)];
    inclination.extend(ends);
    [inclination, Vec::new()]
}

/// Returns how far the integral of a lobe's density is from 1: a product of two line integrals, as the density is a product. A lobe whose
/// peak lies off the sphere counts as exact.
fn integral_error(point: &Point, lobe: Lobe, arithmetic: Arithmetic) -> f64 {
    let [_, v, w] = point.wo();
    let phi_o = w.atan2(v);
    let bsdf = prepared(point, arithmetic).with_lobes(LobeMask::of(&[lobe]));
    let at = |theta: f64, phi: f64| f64::from(bsdf.eval_pdf(direction(theta, phi_o - phi)).pdf);
    let [inclinations, azimuths] = bells(point, lobe);
    let theta_0 = inclinations[0].0;
    if theta_0.abs() > FRAC_PI_2 - 1e-2 {
        return 0.0;
    }
    let phi_0 = azimuths.first().map_or(0.0, |bell| bell.0);
    let largest = at(theta_0, phi_0) * theta_0.cos();
    if largest == 0.0 {
        return 0.0;
    }
    let inner = FRAC_PI_2 - 1e-5;
    let mut theta = panels(-inner, inner, &inclinations);
    theta.extend(
        point
            .reference()
            .jumps()
            .into_iter()
            .filter(|x| x.abs() < inner),
    );
    theta.sort_by(f64::total_cmp);
    let mut phi = panels(-PI, PI, &azimuths);
    // The glints have a kink in the plane of `wo`, and their density by the published sampler ends at a right angle to it.
    phi.extend([-FRAC_PI_2, 0.0, FRAC_PI_2]);
    phi.sort_by(f64::total_cmp);
    let inclination = integrate(&theta, |theta| at(theta, phi_0) * theta.cos());
    let azimuth = integrate(&phi, |phi| at(theta_0, phi) * theta_0.cos());
    // Closer to the axis samples are discarded.
    let caps = [-inner, inner]
        .map(|theta| 1e-5 * at(theta * (1.0 - 1e-6), phi_0) * (FRAC_PI_2 * 1e-6 + 1e-5).sin());
    let inclination = inclination + caps[0] + caps[1];
    (inclination * azimuth / largest - 1.0).abs()
}

/// Returns the error of a random material's integral, of its worst lobe.
fn integral_of_any(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let point = Point::random(model, at, DRAWN);
    let lobes = Lobe::ALL.into_iter().take(model.lobes().len());
    most(lobes.map(|lobe| integral_error(&point, lobe, arithmetic)))
}

/// Returns hair of the range in which the weights are documented.
fn weighed_hair(at: &mut Coordinates<'_>) -> Values {
    let mut degrees = |lo, hi| at.scale(lo, hi).to_radians();
    let beta = degrees(0.5, 60.0);
    let one = [("gamma_tt", 60.0), ("gamma_g", 40.0)].map(|(name, hi)| (name, degrees(1.0, hi)));
    let phi_g = degrees(10.0, 80.0);
    let mut values = ModelId::Gaussian
        .measured()
        .with("beta", &[1.0, 0.5, 2.0].map(|k| narrow(k * beta)))
        .with("phi_g", &[narrow(phi_g)])
        .with("i_g", &[narrow(at.scale(0.1, 10.0))]);
    for (name, width) in one {
        values = values.with(name, &[narrow(width)]);
    }
    for field in values.fields() {
        at.note(field.name, &values.numbers(field.name));
    }
    values
}

/// Returns a point of such hair, seen from up to 89.9 degrees.
fn weighed_point(model: ModelId, at: &mut Coordinates<'_>) -> Point {
    let values = weighed_hair(at);
    Point::new(model, values, at.hit(0.1_f64.to_radians()))
}

fn bound_over_mean(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let point = weighed_point(model, at);
    let mean = channels(prepared(&point, arithmetic).albedo());
    let bound = point.reference().weight_bound(LobeMask::ALL);
    bound.unwrap_or_default() / (mean.iter().sum::<f64>() / 3.0)
}

/// Returns the mean weight of a sample over its bound.
fn over_bound(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let point = if model == ModelId::DEon {
        Point::random(model, at, POLE)
    } else {
        weighed_point(model, at)
    };
    let bound = point.reference().weight_bound(LobeMask::ALL);
    let drawn = samples(&point, at.xi3(), arithmetic).into_iter().flatten();
    most(drawn.map(|sample| {
        let mean = sample
            .weight
            .iter()
            .map(|x| f64::from(*x) / 3.0)
            .sum::<f64>();
        mean / bound.unwrap_or_default()
    }))
}

/// Returns the largest weight of a random material's sample over its documented bound.
fn over_stated(
    model: ModelId,
    at: &mut Coordinates<'_>,
    arithmetic: Arithmetic,
    bounds: fn(&Point) -> [f64; 3],
) -> f64 {
    let point = Point::random(model, at, POLE);
    let bounds = bounds(&point);
    let drawn = samples(&point, at.xi3(), arithmetic).into_iter().flatten();
    most(drawn.flat_map(|sample| [0, 1, 2].map(|c| f64::from(sample.weight[c]) / bounds[c])))
}

/// Returns the bounds on the weights of Kajiya and Kay's model, by channel.
fn kajiya_kay_weights(point: &Point) -> [f64; 3] {
    let [kd, ks]: [[f32; 3]; 2] = ["kd", "ks"].map(|name| point.values.get(name));
    let [p] = point.values.get("exponent").map(f64::from);
    let PerLobe([diffuse, specular, ..]) = point.reference().probabilities();
    let part = |color: f32, share: f64| {
        if share > 0.0 {
            f64::from(color) / share
        } else {
            0.0
        }
    };
    [0, 1, 2].map(|c| part(kd[c], diffuse) + part(ks[c], specular) * (p + 2.0) / (p + 1.0))
}

/// Returns how far the albedos of a fibre without absorption sum from 1.
fn furnace_error(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let mut values = at.values(model).with("sigma_a", &[0.0; 3]);
    if values.index("diffuse_color").is_some() {
        values = values.with("diffuse_color", &[1.0; 3]);
    }
    let point = Point::new(model, values, at.hit(POLE));
    let sums = channels(prepared(&point, arithmetic).albedo());
    most(sums.map(|sum| (sum - 1.0).abs()))
}

/// Returns the asymmetry of a random material.
fn asymmetry_of_any(model: ModelId, at: &mut Coordinates<'_>, arithmetic: Arithmetic) -> f64 {
    let mut point = everyday(model, at);
    if point.values.index("form").is_some() {
        // The other form is not reciprocal.
        let values = point.values.with_word("form", "reciprocal");
        point = Point::new(model, values, point.hit);
    }
    let wi = at.direction(DRAWN, &point.hit);
    asymmetry(&point, wi, arithmetic)
}

/// Returns the bounds on the energy of a model.
pub(crate) fn bounds(model: ModelId) -> Vec<Bound> {
    let bound = |quantity, stated, figure: fn(ModelId, &mut Coordinates<'_>, Arithmetic) -> f64| {
        Bound::new(quantity, model, stated, move |at, arithmetic| {
            figure(model, at, arithmetic)
        })
    };
    let is_hair = model.fields().iter().any(|field| field.name == "alpha");
    // Four to six times what was found.
    let of_density = match model {
        ModelId::KajiyaKay => 1e-4,
        _ if is_hair => 1e-5,
        _ => 5e-6,
    };
    let integral = bound("integral of the density", of_density, integral_of_any);
    // Either of the two values has the error of a value.
    let exchanged = 2.0 * hairis_reference::accuracy(model).value;
    // The width of d'Eon's R depends on the azimuth, so that its density is no product.
    let is_product = model != ModelId::DEon;
    let mut all = if is_product {
        vec![integral]
    } else {
        Vec::new()
    };
    match (is_hair, model.is_default()) {
        (true, true) => all.extend([
            bound("albedo", ALBEDO, hair_albedo_error),
            bound("albedo with Conserving", 1.001, conserved),
            bound("fit of Conserving", 1e-3, conserving_error),
            bound("albedo over max_albedo", 1.0, over_max_albedo),
            bound("reciprocity", exchanged, asymmetry_of_any),
        ]),
        (true, false) => all.extend([
            bound("weight over its bound", 1.0 + 1e-4, over_bound),
            bound(
                "bound of weights over the mean",
                if model == ModelId::GaussianMatched {
                    7.0
                } else {
                    4.0
                },
                bound_over_mean,
            ),
        ]),
        (false, _) if model == ModelId::KajiyaKay => all.extend([
            bound("albedo", 5e-6, albedo_error),
            bound("reciprocity", exchanged, asymmetry_of_any),
            Bound::new(
                "weight over its bound",
                model,
                1.0 + 1e-5,
                move |at, arithmetic| over_stated(model, at, arithmetic, kajiya_kay_weights),
            ),
        ]),
        (false, _) if model == ModelId::DEon => all.extend([
            bound("albedo", 1e-5, albedo_error),
            bound("albedo without absorption: off 1", 1.5e-6, furnace_error),
            bound("weight over its bound", 1.0 + 1e-4, over_bound),
        ]),
        (false, _) => all.extend([
            bound("albedo", 1e-5, albedo_error),
            bound("albedo without absorption: off 1", 1.5e-6, furnace_error),
            Bound::new(
                "weight",
                model,
                3.0 * (1.0 + 1e-6),
                move |at, arithmetic| over_stated(model, at, arithmetic, |_| [1.0; 3]),
            ),
        ]),
    }
    all
}
