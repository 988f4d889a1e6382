//! Looks of the two models around a fibre, as sections.

use core::f64::consts::{FRAC_PI_2, PI};
use glam::Vec3;
use hairis::{Gaussian, HairParams, Material, Published};
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::plot::PolarPanel;
use hairis_instruments::report::Drawing;
use hairis_variants::{AnyMaterial, Cauchy};

fn direction(theta: f64, phi: f64) -> Vec3 {
    fibre_direction(theta, phi).as_vec3()
}

/// Returns S of the published model or of a variant, as the mean of RGB, seen from the inclination `theta_o` (radians) at azimuth 0.
pub fn scatter(material: impl Into<AnyMaterial>, theta_o: f64) -> impl Fn(Vec3) -> f64 {
    let bsdf = material.into().prepare(direction(theta_o, 0.0));
    move |wi| bsdf.eval(wi).into_iter().map(f64::from).sum::<f64>() / 3.0
}

/// Draws S around the fibre and along it, for the Gaussian model and for the named Cauchy models, seen from the inclination `theta_o`
/// (radians).
///
/// Around the fibre, `wi` turns on the cone of the mirror direction, `theta_i = -theta_o`, which is the normal plane if `theta_o` is 0.
/// Along the fibre, `wi` turns in the plane of incidence, which holds the fibre and the viewer.
#[must_use]
pub fn polar(params: &HairParams, theta_o: f64, variants: &[(&str, Cauchy)]) -> Drawing {
    const STEPS: i32 = 1440;
    let mut models = vec![(
        "Gaussian (published)",
        AnyMaterial::from(Material::new(&Published(Gaussian), params)),
    )];
    models.extend(
        variants
            .iter()
            .map(|(name, bell)| (*name, Material::new(&bell.model(), params).into())),
    );
    let panel = |title: &str, angle: &str, arrow, wi: &dyn Fn(f64) -> Vec3| {
        let line = |(_, material): &(&str, AnyMaterial)| {
            let s = scatter(*material, theta_o);
            (0..=STEPS)
                .map(|i| 2.0 * PI * f64::from(i) / f64::from(STEPS))
                .map(|t| (t, s(wi(t))))
                .collect()
        };
        let (lines, arrow) = (models.iter().map(line).collect(), ("ωₒ".to_owned(), arrow));
        PolarPanel {
            title: title.to_owned(),
            angle: angle.to_owned(),
            lines,
            arrow,
        }
    };
    // The fibre's tip is at 90°, and the side of the viewer at 0°.
    let along = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        direction(
            sin.atan2(cos.abs()).clamp(-FRAC_PI_2, FRAC_PI_2),
            if cos < 0.0 { PI } else { 0.0 },
        )
    };
    let degrees = theta_o.to_degrees();
    let panels = [
        panel(
            "around the fibre (θᵢ = −θₒ)",
            "azimuth φ",
            0.0,
            &|phi| direction(-theta_o, phi),
        ),
        panel(
            "in the plane of incidence",
            "inclination; tip at 90°",
            theta_o,
            &along,
        ),
    ];
    let names: Vec<&str> = models.iter().map(|(name, _)| *name).collect();
    let title = format!("S, Gaussian and Cauchy, θₒ = {degrees:.0}°");
    let chart =
        hairis_instruments::plot::polar(&title, "radius: S (1/sr), mean of RGB", &names, &panels);
    let caption = format!(
        "The scattering function of the published Gaussian model and of the all-Cauchy variant, seen from θₒ = \
         {degrees:.0}° (ωₒ marks the direction to the viewer). Above: around the fibre, on the cone of the mirror \
         direction. Below: in the plane of the fibre and the viewer, where ±90° are the fibre's ends. Each circle has its \
         own scale. Every lobe has the same peak in all models; with the same widths the Cauchy is the lower one within \
         1.6 widths of its centre and the higher one further out."
    );
    Drawing::new("polar", chart, caption)
}
