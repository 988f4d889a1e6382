//! Maps of how different the models look, over the sphere.

use crate::difference::{SIGMA_DEG, blurred};
use glam::Vec3;
use hairis::model::Bell;
use hairis::{Gaussian, HairParams, Material, Published};
use hairis_harness::figures::scatter;
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::plot::{Axis, SphereGrid, heat_map};
use hairis_instruments::report::Drawing;
use hairis_variants::Cauchy;

/// Cells of a map, in inclination and in azimuth.
const CELLS: (u16, u16) = (60, 120);

fn direction(theta: f64, phi: f64) -> Vec3 {
    fibre_direction(theta, phi).as_vec3()
}

/// Draws maps of S of the Gaussian model, of a Cauchy model and of the second less the first, seen from the inclination `theta_o` (radians)
/// at azimuth 0. The last map shows the same difference of `S cos theta_i` after the blur of [`difference`](crate::difference).
pub(super) fn maps(params: &HairParams, theta_o: f64, cauchy: Cauchy) -> [Drawing; 4] {
    let a = scatter(Material::new(&Published(Gaussian), params), theta_o);
    let b = scatter(Material::new(&cauchy.model(), params), theta_o);
    let gaussian = SphereGrid::sample(CELLS, &mut |theta, phi| a(direction(theta, phi)));
    let other = SphereGrid::sample(CELLS, &mut |theta, phi| b(direction(theta, phi)));
    let more = SphereGrid::sample(CELLS, &mut |theta, phi| {
        b(direction(theta, phi)) - a(direction(theta, phi))
    });
    let most = [&gaussian, &other]
        .into_iter()
        .filter_map(SphereGrid::range)
        .map(|(_, high)| high)
        .fold(0.0, f64::max);
    let degrees = theta_o.to_degrees();
    let heat = |name: &str, model: &str, grid, remark: &str| {
        // Values below the range get its first colour.
        let value = Axis::log("S (1/sr)").range(most / 1e3, most);
        let map = heat_map(
            &format!("S, {model} model, θₒ = {degrees:.0}°"),
            value,
            grid,
        );
        let caption = format!(
            "S of the {model} model{remark}, seen from θₒ = {degrees:.0}° at azimuth 0: the mean of RGB, logarithmic over \
             three decades. Equal areas of the map are equal solid angles."
        );
        Drawing::new(name, map, caption)
    };
    let k = format!(" with k = {}, in the same colours", cauchy.width_factor());
    let blurred = blurred(params, theta_o, f64::from(cauchy.width_factor()));
    let at = |model: usize, theta, phi| blurred[model].at(theta, phi);
    let blurred_more = SphereGrid::sample(CELLS, &mut |theta, phi| {
        at(1, theta, phi) - at(0, theta, phi)
    });
    let blurred_gaussian = SphereGrid::sample(CELLS, &mut |theta, phi| at(0, theta, phi));
    let most_blurred = blurred_gaussian.range().map_or(f64::NAN, |(_, high)| high);
    [
        heat("map-gaussian", "Gaussian", &gaussian, ""),
        heat("map-cauchy", "Cauchy", &other, &k),
        Drawing::new(
            "map-difference",
            heat_map(
                "S, Cauchy less Gaussian",
                Axis::linear("difference of S (1/sr)"),
                &more,
            ),
            "What the Cauchy model has more (vermilion) and less (blue) than the Gaussian one, linear.",
        ),
        Drawing::new(
            "map-blurred-difference",
            heat_map(
                &format!("S cos θᵢ blurred by {SIGMA_DEG}°, Cauchy less Gaussian"),
                Axis::linear("difference of S cos θᵢ (1/sr)"),
                &blurred_more,
            ),
            format!(
                "The difference of S cos θᵢ after a blur of {SIGMA_DEG}°: what is left of it in a light that wide. The \
                 Gaussian model alone, blurred, reaches {most_blurred:.2}."
            ),
        ),
    ]
}
