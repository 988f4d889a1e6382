//! Hair chosen by the names of a model, a sampler and a preset.

use crate::material::{Hair, Sampling};
use crate::transport::{Integrator, Settings};
use core::fmt::Write as _;
use hairis_instruments::error::Error;
use hairis_materials::MaterialSpec;
use hairis_variants::{ModelId, Values};

/// Name of the sampler whose directions are uniform over the sphere.
pub const UNIFORM: &str = "uniform";
/// Name of the first sampler of a model, which for the published model is the published one.
pub const PUBLISHED: &str = "published";
/// Name of the samplers that are made for the bells of a model.
pub const MATCHED: &str = "matched";
/// Name of a preset beside those of the models: the published model's `bright` with the narrow lobes of glossy hair.
pub const GLOSSY: &str = "glossy";

/// Largest mean albedo with which paths converge as they are, even if single directions return more
/// than they receive.
pub const MOST_MEAN_ALBEDO: f32 = 0.98;
/// Largest albedo with which paths converge whatever the mean: hair that returns no more than it
/// receives, apart from rounding.
pub const MOST_ALBEDO: f32 = 1.001;

/// Whether hair scatters what the model says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Energy {
    /// As the model says
    Raw,
    /// Scaled by one factor so that no direction gives back more light than it receives: reciprocal, but dark
    Scaled,
    /// Scaled per viewing direction and channel so that none gives back more light than it receives: keeps light hair light
    PerWo,
}

/// Choice of hair by name: model, sampler, parameters and the name in reports.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Entry of the registry: a model with one of its samplers.
    pub id: ModelId,
    /// Method that draws directions.
    pub sampling: Sampling,
    /// Parameters of the model.
    pub values: Values,
    /// Name in reports, which is that of the preset or of the file.
    pub name: String,
}

impl Choice {
    /// Finds a model, a sampler and a preset by their names.
    ///
    /// # Errors
    ///
    /// Returns a usage error that names the unknown model, sampler or preset and lists the valid ones.
    pub fn find(model: &str, sampler: &str, preset: &str) -> Result<Self, Error> {
        let (id, sampling) = find_sampler(model, sampler)?;
        let Some(values) = preset_of(id, preset) else {
            let mut names: Vec<&str> = id.presets().map(|(name, _)| name).collect();
            names.extend(preset_of(id, GLOSSY).map(|_| GLOSSY));
            return Err(Error::Usage(format!(
                "--hair of {model} must be one of {}, got {preset}",
                names.join(", ")
            )));
        };
        Ok(Self {
            id,
            sampling,
            values,
            name: preset.to_owned(),
        })
    }

    /// Chooses a material of a file. It is sampled as `sampler` says, or else as the file does, or else by
    /// [`default_sampler`].
    ///
    /// # Errors
    ///
    /// Returns an error if the model has no such sampler.
    pub fn of_material(
        name: &str,
        material: &MaterialSpec,
        sampler: Option<&str>,
    ) -> Result<Self, Error> {
        let model = material.model;
        let (id, sampling) = match sampler {
            None if material.is_chosen => (model, Sampling::Own),
            word => find_sampler(
                model.name(),
                word.unwrap_or_else(|| default_sampler(model.name())),
            )?,
        };
        Ok(Self {
            id,
            sampling,
            values: material.values,
            name: name.to_owned(),
        })
    }

    /// Selects another sampler by name. For models without matched samplers, the published one
    /// is the hair's own.
    ///
    /// # Errors
    ///
    /// Returns an error if the model has no such sampler.
    pub fn sampled(&self, sampler: &str) -> Result<Self, Error> {
        let (id, sampling) = match sampler {
            UNIFORM => (self.id, Sampling::Uniform),
            PUBLISHED if self.best() == PUBLISHED => (self.id, Sampling::Own),
            word => find_sampler(self.id.name(), word)?,
        };
        Ok(Self {
            id,
            sampling,
            ..self.clone()
        })
    }

    /// Returns the name of the best sampler of the hair: see [`default_sampler`].
    #[must_use]
    pub fn best(&self) -> &'static str {
        default_sampler(self.id.name())
    }

    /// Sets other values for some parameters, each given as `NAME=VALUE`.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such parameter, or if a value is not legal.
    pub fn set(self, assignments: &[String]) -> Result<Self, Error> {
        let refuse = |problem: String| Error::Usage(format!("--set {problem}"));
        let material = MaterialSpec::new(self.id, self.values)?
            .set(assignments)
            .map_err(refuse)?;
        Ok(Self {
            values: material.values,
            ..self
        })
    }

    /// Creates the material with these parameters, scaled to conserve energy as `energy` says.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of its range.
    pub fn hair(&self, energy: Energy) -> Result<Hair, Error> {
        let material = self.id.material(&self.values)?;
        let (material, factor) = match energy {
            Energy::Raw => (material, 1.0),
            Energy::Scaled => (material, material.conserving_scale()),
            Energy::PerWo => (material.conserving(), 1.0),
        };
        Ok(Hair::Model(material, self.sampling, factor))
    }

    /// Returns a line of everything that scattering depends on, without the name.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut line = format!("model={} sampler={}", self.id.name(), self.sampler());
        let fields = self.values.fields();
        for field in fields.iter().filter(|field| self.values.has(field.name)) {
            let numbers = self.values.numbers(field.name).iter();
            let numbers: Vec<String> = numbers.map(f32::to_string).collect();
            // Writing into a string does not fail.
            let _ = write!(line, " {}={}", field.name, numbers.join(","));
        }
        line
    }

    /// Returns the name of the sampler as reports write it.
    #[must_use]
    pub fn sampler(&self) -> &'static str {
        match (self.sampling, self.id.choice()) {
            (Sampling::Uniform, _) => UNIFORM,
            (Sampling::Own, Some((_, word))) if !self.id.is_default() => word,
            (Sampling::Own, _) => PUBLISHED,
        }
    }
}

/// Finds a model and its sampler by their names.
fn find_sampler(model: &str, sampler: &str) -> Result<(ModelId, Sampling), Error> {
    let Some(first) = ModelId::find(model, None) else {
        let names: Vec<&str> = ModelId::defaults_of_names().map(ModelId::name).collect();
        return Err(Error::Usage(format!(
            "--model must be one of {}, got {model}",
            names.join(", ")
        )));
    };
    match sampler {
        UNIFORM => Ok((first, Sampling::Uniform)),
        PUBLISHED => Ok((first, Sampling::Own)),
        word => match ModelId::find(model, Some(word)) {
            Some(id) => Ok((id, Sampling::Own)),
            None => {
                let words = samplers(model).join(", ");
                Err(Error::Usage(format!(
                    "--sampler of {model} must be one of {words}, got {word}"
                )))
            }
        },
    }
}

/// Returns the sampler of a model that is used if none is named: the matched one, or else the model's own.
#[must_use]
pub fn default_sampler(model: &str) -> &'static str {
    if samplers(model).contains(&MATCHED) {
        MATCHED
    } else {
        PUBLISHED
    }
}

/// Returns the names of the samplers of a model.
#[must_use]
pub fn samplers(model: &str) -> Vec<&'static str> {
    let own = ModelId::ALL.iter().filter(|id| id.name() == model);
    let words = own.filter_map(|id| id.choice().map(|(_, word)| word));
    // The first sampler of the published model has the name that stands for the first sampler of any model.
    let others = words.filter(|word| *word != PUBLISHED);
    [UNIFORM, PUBLISHED].into_iter().chain(others).collect()
}

/// Returns true if paths that scatter several times in hair come to an end in the mean.
#[must_use]
pub fn converges(hair: &Hair) -> bool {
    let [mean, worst] = hair.mean_and_worst_albedo();
    mean < MOST_MEAN_ALBEDO || worst <= MOST_ALBEDO
}

/// Rejects hair in which paths do not converge. `remedy` ends the line of the error.
///
/// # Errors
///
/// Returns a usage error if paths scatter several times in hair that returns more than it receives
/// from single directions, and whose mean albedo is [`MOST_MEAN_ALBEDO`] or above.
pub fn check_paths(
    hair: &Hair,
    settings: &Settings,
    preset: &str,
    remedy: &str,
) -> Result<(), Error> {
    if settings.integrator == Integrator::Path && settings.multiple && !converges(hair) {
        let [mean, worst] = hair.mean_and_worst_albedo();
        return Err(Error::Usage(format!(
            "paths need hair of a mean albedo below {MOST_MEAN_ALBEDO}, or of albedos up to 1, got a mean of {mean:.3} and \
             {worst:.3} of {preset}: {remedy}"
        )));
    }
    Ok(())
}

/// Returns the parameters of a preset.
fn preset_of(id: ModelId, name: &str) -> Option<Values> {
    if name != GLOSSY {
        // The first preset is the default of this program, whatever its name.
        let mut presets = id.presets().enumerate();
        return presets
            .find(|(place, (preset, _))| *preset == name || (*place == 0 && name == "default"))
            .map(|(_, (_, values))| values);
    }
    let published = ModelId::find("gaussian", None)?;
    if id.fields() != published.fields() {
        return None;
    }
    let deg = |angle: f32| angle.to_radians();
    let values = id
        .measured()
        .with("beta", &[deg(2.5), deg(1.25), deg(5.0)])
        .with("gamma_tt", &[deg(5.0)]);
    Some(values.with("gamma_g", &[deg(5.0)]).with("i_g", &[5.0]))
}
