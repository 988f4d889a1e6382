//! Looks of the two models around a fibre: sections, and maps of the sphere.

use super::direction;
use crate::difference::{SIGMA_DEG, blurred_difference};
use crate::plot::{Axis, HeatMap, PolarChart, PolarPanel, PolarSeries, Projection, SphereGrid};
use crate::report::Drawing;
use core::f64::consts::{FRAC_PI_2, PI};
use glam::Vec3;
use hairis::{Bell, Bsdf, Gaussian, Hair, HairParams};
use hairis_variants::{AnyBsdf, Cauchy};

/// Rows and columns of a map.
const CELLS: (u16, u16) = (60, 120);

/// S of the published model or of a variant, the mean of RGB.
type ScatterFn = Box<dyn Fn(Vec3) -> f64>;

fn scatter(bsdf: impl Into<AnyBsdf>, theta_o: f64) -> ScatterFn {
    let gather = bsdf.into().prepare(direction(theta_o, 0.0));
    Box::new(move |wi| gather.eval(wi).into_iter().map(f64::from).sum::<f64>() / 3.0)
}

/// S around the fibre and along it, of the Gaussian model and of Cauchy models by name, seen from the inclination
/// `theta_o` (radians).
///
/// Around it, `wi` turns on the cone of the mirror direction, `theta_i = -theta_o`, which is the normal plane when
/// `theta_o` is 0; along it, `wi` turns in the plane of incidence, that of the fibre and the viewer.
#[must_use]
pub fn polar(params: &HairParams, theta_o: f64, variants: &[(&str, Cauchy)]) -> Drawing {
    const STEPS: i32 = 1440;
    let mut models = vec![("Gaussian (published)".to_owned(), scatter(Bsdf::new(&Hair(Gaussian), params), theta_o))];
    models.extend(
        variants.iter().map(|(name, bell)| ((*name).to_owned(), scatter(Bsdf::new(&bell.model(), params), theta_o))),
    );
    let turn = || (0..=STEPS).map(|i| 2.0 * PI * f64::from(i) / f64::from(STEPS));
    // 90° is the fibre's tip, 0° the side of the viewer.
    let along = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        direction(sin.atan2(cos.abs()).clamp(-FRAC_PI_2, FRAC_PI_2), if cos < 0.0 { PI } else { 0.0 })
    };
    let panel = |panel: PolarPanel, wi: &dyn Fn(f64) -> Vec3| {
        models
            .iter()
            .fold(panel, |panel, (name, s)| panel.series(PolarSeries::new(name.clone(), turn().map(|t| (t, s(wi(t)))))))
    };
    let around =
        panel(PolarPanel::new("around the fibre (θᵢ = −θₒ)", "azimuth φ"), &|phi| direction(-theta_o, phi));
    let along = panel(PolarPanel::new("in the plane of incidence", "inclination; tip at 90°"), &along);
    let degrees = theta_o.to_degrees();
    let chart = PolarChart::new(format!("S, Gaussian and Cauchy, θₒ = {degrees:.0}°"), "radius: S (1/sr), mean of RGB")
        .panel(around.arrow("ωₒ", 0.0))
        .panel(along.arrow("ωₒ", theta_o));
    let caption = format!(
        "The scattering function of the published Gaussian model and of the all-Cauchy variant, seen from θₒ = \
         {degrees:.0}° (ωₒ marks the direction to the viewer). Left: around the fibre, on the cone of the mirror \
         direction. Right: in the plane of the fibre and the viewer, where ±90° are the fibre's ends. Each circle has its \
         own scale. Every lobe has the same peak in all models; with the same widths the Cauchy is the lower one within \
         1.6 widths of its centre and the higher one further out."
    );
    Drawing::new(chart.svg(), caption).named("polar")
}

/// Latitude-longitude maps of S of the Gaussian model, of a Cauchy model and of what the second has more, seen from the
/// inclination `theta_o` (radians) at azimuth 0.
#[must_use]
pub fn maps(params: &HairParams, theta_o: f64, cauchy: Cauchy) -> [Drawing; 3] {
    const DECADES: f64 = 1e3;
    let (a, b) =
        (scatter(Bsdf::new(&Hair(Gaussian), params), theta_o), scatter(Bsdf::new(&cauchy.model(), params), theta_o));
    let map = |s: &dyn Fn(Vec3) -> f64| {
        SphereGrid::sample(Projection::EqualAngle, CELLS, |theta, phi| s(direction(theta, phi)))
    };
    let (gaussian, other, more) = (map(&a), map(&b), map(&|wi| b(wi) - a(wi)));
    let most = [&gaussian, &other].iter().filter_map(|grid| grid.range()).map(|(_, high)| high).fold(0.0, f64::max);
    let degrees = theta_o.to_degrees();
    let value = || Axis::log("S (1/sr)").range(most / DECADES, most);
    // Values below the range take its first colour.
    let shown = |grid: SphereGrid| grid.map(|s| s.max(most / DECADES));
    let heat = |title: &str, grid| HeatMap::new(format!("{title}, θₒ = {degrees:.0}°"), value(), shown(grid)).svg();
    let seen = format!("seen from θₒ = {degrees:.0}° at azimuth 0: the mean of RGB, logarithmic over three decades");
    let k = cauchy.width_factor();
    [
        Drawing::new(heat("S, Gaussian model", gaussian), format!("S of the Gaussian model, {seen}."))
            .named("map-gaussian"),
        Drawing::new(
            heat("S, Cauchy model", other),
            format!("S of the Cauchy model with k = {k}, {seen}; same colours."),
        )
        .named("map-cauchy"),
        Drawing::new(
            HeatMap::new("S, Cauchy less Gaussian", Axis::linear("difference of S (1/sr)"), more).signed().svg(),
            "What the Cauchy model has more (vermilion) and less (blue) than the Gaussian one, linear.",
        )
        .named("map-difference"),
    ]
}

/// A map of what a Cauchy model has more of `S cos theta_i` after the blur of [`difference`](crate::difference).
#[must_use]
pub fn difference_map(params: &HairParams, theta_o: f64, cauchy: Cauchy) -> Drawing {
    let (gaussian, more) = blurred_difference(params, theta_o, f64::from(cauchy.width_factor()));
    let map = SphereGrid::sample(Projection::EqualAngle, CELLS, more);
    let most = SphereGrid::sample(Projection::EqualAngle, CELLS, gaussian).range().map_or(f64::NAN, |(_, high)| high);
    let value = Axis::linear("difference of S cos θᵢ (1/sr)");
    let title = format!("S cos θᵢ blurred by {SIGMA_DEG}°, Cauchy less Gaussian");
    let caption = format!(
        "The difference of S cos θᵢ after a blur of {SIGMA_DEG}°: what is left of it in a light that wide. The Gaussian \
         model alone, blurred, reaches {:.2}.",
        most
    );
    Drawing::new(HeatMap::new(title, value, map).signed().svg(), caption).named("map-blurred-difference")
}
