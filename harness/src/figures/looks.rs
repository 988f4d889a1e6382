//! Looks of the two models around a fibre: sections, and maps of the sphere.

use crate::difference::{SIGMA_DEG, blurred};
use crate::plot::{Axis, HeatMap, PolarChart, PolarPanel, Projection, SphereGrid};
use crate::quadrature::fibre_direction;
use crate::report::Drawing;
use core::f64::consts::{FRAC_PI_2, PI};
use glam::Vec3;
use hairis::{Bell, Bsdf, Gaussian, Hair, HairParams};
use hairis_variants::{AnyBsdf, Cauchy};

fn direction(theta: f64, phi: f64) -> Vec3 {
    fibre_direction(theta, phi).as_vec3()
}

/// Values on a map of the inclination and the azimuth, in rad.
fn grid(value: impl FnMut(f64, f64) -> f64) -> SphereGrid {
    SphereGrid::sample(Projection::EqualAngle, (60, 120), value)
}

/// S of the published model or of a variant, the mean of RGB.
fn scatter(bsdf: impl Into<AnyBsdf>, theta_o: f64) -> impl Fn(Vec3) -> f64 {
    let gather = bsdf.into().prepare(direction(theta_o, 0.0));
    move |wi| gather.eval(wi).into_iter().map(f64::from).sum::<f64>() / 3.0
}

/// S around the fibre and along it, of the Gaussian model and of Cauchy models by name, seen from the inclination
/// `theta_o` (radians).
///
/// Around it, `wi` turns on the cone of the mirror direction, `theta_i = -theta_o`, which is the normal plane when
/// `theta_o` is 0; along it, `wi` turns in the plane of incidence, that of the fibre and the viewer.
#[must_use]
pub fn polar(params: &HairParams, theta_o: f64, variants: &[(&str, Cauchy)]) -> Drawing {
    const STEPS: i32 = 1440;
    let mut models = vec![("Gaussian (published)", AnyBsdf::from(Bsdf::new(&Hair(Gaussian), params)))];
    models.extend(variants.iter().map(|(name, bell)| (*name, Bsdf::new(&bell.model(), params).into())));
    let panel = |title: &str, angle: &str, arrow, wi: &dyn Fn(f64) -> Vec3| {
        let line = |(name, bsdf): &(&str, AnyBsdf)| {
            let s = scatter(*bsdf, theta_o);
            let turn = (0..=STEPS).map(|i| 2.0 * PI * f64::from(i) / f64::from(STEPS));
            ((*name).to_owned(), turn.map(|t| (t, s(wi(t)))).collect())
        };
        let series = models.iter().map(line).collect();
        PolarPanel { title: title.to_owned(), angle: angle.to_owned(), series, arrow: ("ωₒ".to_owned(), arrow) }
    };
    // 90° is the fibre's tip, 0° the side of the viewer.
    let along = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        direction(sin.atan2(cos.abs()).clamp(-FRAC_PI_2, FRAC_PI_2), if cos < 0.0 { PI } else { 0.0 })
    };
    let degrees = theta_o.to_degrees();
    let chart = PolarChart {
        title: format!("S, Gaussian and Cauchy, θₒ = {degrees:.0}°"),
        radius: "radius: S (1/sr), mean of RGB".to_owned(),
        panels: vec![
            panel("around the fibre (θᵢ = −θₒ)", "azimuth φ", 0.0, &|phi| direction(-theta_o, phi)),
            panel("in the plane of incidence", "inclination; tip at 90°", theta_o, &along),
        ],
    };
    let caption = format!(
        "The scattering function of the published Gaussian model and of the all-Cauchy variant, seen from θₒ = \
         {degrees:.0}° (ωₒ marks the direction to the viewer). Above: around the fibre, on the cone of the mirror \
         direction. Below: in the plane of the fibre and the viewer, where ±90° are the fibre's ends. Each circle has its \
         own scale. Every lobe has the same peak in all models; with the same widths the Cauchy is the lower one within \
         1.6 widths of its centre and the higher one further out."
    );
    Drawing::new(chart.svg(), caption).named("polar")
}

/// Latitude-longitude maps of S of the Gaussian model, of a Cauchy model and of what the second has more, seen from the
/// inclination `theta_o` (radians) at azimuth 0.
#[must_use]
pub fn maps(params: &HairParams, theta_o: f64, cauchy: Cauchy) -> [Drawing; 3] {
    let (a, b) =
        (scatter(Bsdf::new(&Hair(Gaussian), params), theta_o), scatter(Bsdf::new(&cauchy.model(), params), theta_o));
    let gaussian = grid(|theta, phi| a(direction(theta, phi)));
    let other = grid(|theta, phi| b(direction(theta, phi)));
    let more = grid(|theta, phi| b(direction(theta, phi)) - a(direction(theta, phi)));
    let most = [&gaussian, &other].into_iter().filter_map(SphereGrid::range).map(|(_, high)| high).fold(0.0, f64::max);
    let degrees = theta_o.to_degrees();
    let heat = |model: &str, grid, remark: &str| {
        // Values below the range take its first colour.
        let value = Axis::log("S (1/sr)").range(most / 1e3, most);
        let map = HeatMap::new(format!("S, {model} model, θₒ = {degrees:.0}°"), value, grid);
        let caption = format!(
            "S of the {model} model{remark}, seen from θₒ = {degrees:.0}° at azimuth 0: the mean of RGB, logarithmic over \
             three decades."
        );
        Drawing::new(map.svg(), caption)
    };
    let difference = HeatMap::signed("S, Cauchy less Gaussian", Axis::linear("difference of S (1/sr)"), more);
    let k = format!(" with k = {}, in the same colours", cauchy.width_factor());
    [
        heat("Gaussian", gaussian, "").named("map-gaussian"),
        heat("Cauchy", other, &k).named("map-cauchy"),
        Drawing::new(
            difference.svg(),
            "What the Cauchy model has more (vermilion) and less (blue) than the Gaussian one, linear.",
        )
        .named("map-difference"),
    ]
}

/// A map of what a Cauchy model has more of `S cos theta_i` after the blur of [`difference`](crate::difference).
#[must_use]
pub fn difference_map(params: &HairParams, theta_o: f64, cauchy: Cauchy) -> Drawing {
    let blurred = blurred(params, theta_o, f64::from(cauchy.width_factor()));
    let at = |model: usize, theta, phi| blurred[model].at(theta, phi);
    let most = grid(|theta, phi| at(0, theta, phi)).range().map_or(f64::NAN, |(_, high)| high);
    let more = grid(|theta, phi| at(1, theta, phi) - at(0, theta, phi));
    let title = format!("S cos θᵢ blurred by {SIGMA_DEG}°, Cauchy less Gaussian");
    let map = HeatMap::signed(title, Axis::linear("difference of S cos θᵢ (1/sr)"), more);
    let caption = format!(
        "The difference of S cos θᵢ after a blur of {SIGMA_DEG}°: what is left of it in a light that wide. The Gaussian \
         model alone, blurred, reaches {most:.2}."
    );
    Drawing::new(map.svg(), caption).named("map-blurred-difference")
}
