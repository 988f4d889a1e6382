//! Lights that every experiment compares models under, and their names in sentences.
//!
//! Experiments select lights by name, or by kind. No figure depends on how many lights there are.

use hairis_instruments::direction::fibre_direction;
use hairis_instruments::light::{Constant, Environment, Light, Rectangle, Sky, Smooth, Sun};
use std::sync::LazyLock;

/// Inclination and azimuth of the sun's centre, in degrees.
pub const SUN_DEG: [f64; 2] = [-60.0, 25.0];

/// Lights of a run: those that need no file, the environment, and further ones.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lights<'a> {
    environment: Option<&'a Environment>,
    further: &'a [&'a dyn Light],
}

impl<'a> From<&'a Environment> for Lights<'a> {
    fn from(environment: &'a Environment) -> Self {
        Some(environment).into()
    }
}

impl<'a> From<Option<&'a Environment>> for Lights<'a> {
    fn from(environment: Option<&'a Environment>) -> Self {
        Self {
            environment,
            further: &[],
        }
    }
}

impl<'a> Lights<'a> {
    /// Returns the same lights with `further` ones after all others.
    #[must_use]
    pub const fn with(self, further: &'a [&'a dyn Light]) -> Self {
        Self { further, ..self }
    }

    /// Returns every light of the run, in the order of reports.
    #[must_use]
    pub fn all(&self) -> Vec<&'a dyn Light> {
        static SUN: LazyLock<Sun> = LazyLock::new(|| {
            let [theta, phi] = SUN_DEG.map(f64::to_radians);
            Sun::five_degrees(fibre_direction(theta, phi))
        });
        let mut all: Vec<&dyn Light> = vec![&Constant, &Smooth, &*SUN, &Rectangle];
        all.extend(self.environment.map(|map| map as &dyn Light));
        // Append a new light here, on its own line: streams of random numbers are keyed by place.
        all.extend(self.further);
        all
    }

    /// Returns the environment, if the run has one.
    #[must_use]
    pub const fn environment(&self) -> Option<&'a Environment> {
        self.environment
    }

    /// Returns the environment, if `light` is the environment.
    pub fn as_environment(&self, light: &dyn Light) -> Option<&'a Environment> {
        self.environment.filter(|map| map.name() == light.name())
    }
}

/// Returns the light of a name, if it needs no file.
fn find(name: &str) -> Option<&'static dyn Light> {
    let mut all = Lights::default().all().into_iter();
    all.find(|light| light.name() == name)
}

/// Returns the index of the environment among names of lights: the first name that no light without a file has.
#[must_use]
pub fn environment(names: &[String]) -> Option<usize> {
    names.iter().position(|name| find(name).is_none())
}

/// Returns a light's name in a sentence.
#[must_use]
pub fn in_words(name: &str) -> &str {
    match find(name) {
        Some(light) => light.words(),
        None if name == Sky::NAME => Sky::WORDS,
        None => name,
    }
}
