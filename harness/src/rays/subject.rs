//! Models and samplers whose rays are measured, and their shading points.

use crate::efficiency::{PHI_O_DEG, THETA_O_DEG};
use crate::sampler::{Sampler, Scatter};
use glam::Vec3;
use hairis::{Hit, ParamError};
use hairis_instruments::direction::fibre_direction;
use hairis_reference::{Reference, reference};
use hairis_variants::{ModelId, Values};

/// Offset of the ray from the fibre's axis, for models that read it, one for each of [`THETA_O_DEG`].
const OFFSETS: [f32; 4] = [0.0, 0.5, -0.75, 0.25];

/// Model with one of its samplers, whose rays are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RaySubject {
    id: ModelId,
    is_uniform: bool,
}

impl RaySubject {
    /// Returns every model of the registry with each of its samplers, and the two bells with uniform directions as well.
    pub fn all() -> impl Iterator<Item = Self> {
        let with_uniform = |id: ModelId| {
            let uniform = matches!(id, ModelId::Gaussian | ModelId::Cauchy).then_some(Self {
                id,
                is_uniform: true,
            });
            uniform.into_iter().chain([Self {
                id,
                is_uniform: false,
            }])
        };
        ModelId::ALL.iter().copied().flat_map(with_uniform)
    }

    /// Returns every sampler of an entry's model, uniform directions first.
    pub fn of_model(model: ModelId) -> impl Iterator<Item = Self> {
        let uniform = Self {
            id: model,
            is_uniform: true,
        };
        let entries = ModelId::ALL.iter().copied();
        let own = entries.filter(move |id| id.name() == model.name());
        let own = own.map(|id| Self {
            id,
            is_uniform: false,
        });
        [uniform].into_iter().chain(own)
    }

    /// Returns the entry of the registry, unless directions are uniform.
    #[must_use]
    pub fn own(self) -> Option<ModelId> {
        (!self.is_uniform).then_some(self.id)
    }

    /// Prepares a material at a hit.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of its range.
    pub fn at(self, values: &Values, hit: Hit) -> Result<Scatter, ParamError> {
        let material = self.id.material(values)?;
        Ok(Scatter::at(material.prepare(hit), self.is_uniform))
    }

    /// Returns the name of the model in the registry.
    #[must_use]
    pub const fn model(self) -> &'static str {
        self.id.name()
    }

    /// Returns the name of the sampler in rows and reports.
    #[must_use]
    pub fn sampler(self) -> &'static str {
        match self {
            Self {
                is_uniform: true, ..
            } => Sampler::Uniform.name(),
            Self {
                id: ModelId::Gaussian | ModelId::Cauchy,
                ..
            } => Sampler::Published.name(),
            Self { id, .. } => id.choice().map_or("its own", |(_, word)| word),
        }
    }

    /// Returns the number of the subject among streams of random numbers.
    pub(super) fn index(self) -> u64 {
        2 * self.id as u64 + u64::from(self.is_uniform)
    }

    /// Prepares the default hair, seen from [`THETA_O_DEG`] at index `pose`.
    ///
    /// # Panics
    ///
    /// Never panics, because default parameters are within their ranges.
    #[must_use]
    pub fn scatter(self, pose: usize) -> Scatter {
        let hit = Hit::new(viewer(pose), OFFSETS[pose]);
        self.at(&self.id.measured(), hit)
            .expect("defaults are accepted")
    }

    /// Prepares the formulas of the same hair in double precision.
    ///
    /// # Panics
    ///
    /// Never panics, because default parameters are within their ranges.
    pub(super) fn formulas(self, pose: usize) -> Box<dyn Reference<f64>> {
        let wo = viewer(pose).as_dvec3().to_array();
        reference(self.id, &self.id.measured(), wo, f64::from(OFFSETS[pose]))
            .expect("defaults are accepted")
    }
}

fn viewer(pose: usize) -> Vec3 {
    fibre_direction(THETA_O_DEG[pose].to_radians(), PHI_O_DEG.to_radians()).as_vec3()
}
