//! The lights that every experiment compares models under, and what reports call them.

use hairis_instruments::direction::fibre_direction;
use hairis_instruments::light::{Constant, Environment, Light, Rectangle, Smooth, Sun};
use std::sync::LazyLock;

/// Places in the list of [`lights`].
pub(crate) const CONSTANT: usize = 0;
pub(crate) const SUN: usize = 2;
pub(crate) const AREA: usize = 3;
pub(crate) const ENVIRONMENT: usize = 4;

/// Inclination and azimuth of the sun's centre, in degrees.
pub const SUN_DEG: [f64; 2] = [-60.0, 25.0];

/// The lights in the order of reports: those that need no file, then the environment, if there is one.
pub(crate) fn lights(environment: Option<&Environment>) -> Vec<&dyn Light> {
    static SUN: LazyLock<Sun> = LazyLock::new(|| {
        let [theta, phi] = SUN_DEG.map(f64::to_radians);
        Sun::five_degrees(fibre_direction(theta, phi))
    });
    let lights: [&dyn Light; 4] = [&Constant, &Smooth, &*SUN, &Rectangle];
    lights
        .into_iter()
        .chain(environment.map(|map| map as &dyn Light))
        .collect()
}

/// A light's name in a sentence.
pub(crate) fn in_words(name: &str) -> &str {
    match name {
        "constant" => "constant light",
        "smooth" => "smooth light",
        "sun" => "a 5° sun",
        "rectangle" => "a large area light",
        "clear sky" | "sky" => "a procedural sky",
        _ => name,
    }
}
