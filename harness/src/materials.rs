//! Materials that are measured beside the hair of the grid, of any model of the registry, with each of its samplers.

use crate::efficiency::PHI_O_DEG;
use crate::lights::Lights;
use crate::rays::RaySubject;
use crate::sampler::Sampler;
use crate::variance::check::{self, Checked};
use crate::variance::{
    self, MAX_RELATIVE_ERROR, Measured, RAYS, SOURCE, SampleBudget, Subject, figures_of, ray_v,
};
use core::iter;
use glam::Vec3;
use hairis::{Hit, LobeMask, ParamError};
use hairis_instruments::columns::Columns;
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::error::Error;
use hairis_instruments::light::Constant;
use hairis_instruments::progress::Progress;
use hairis_instruments::sequence::stream_id;
use hairis_instruments::stats::Estimate;
use hairis_instruments::table::{Table, number};
use hairis_materials::material::{self, values_json};
use hairis_materials::{MaterialSpec, files, numbered};
use hairis_reference::reference;
use hairis_variants::{ModelId, Values};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Offset of a ray from the fibre's axis, for models that read it.
pub const OFFSET: f32 = 0.5;

/// Name of perfect sampling in rows and reports; see [`variance`].
pub const PERFECT: &str = "perfect";

/// Value below which V is only rounding of single precision.
const NOTHING: f64 = 1e-9;

/// Material with its name in reports.
#[derive(Clone, Debug)]
pub struct NamedMaterial {
    /// Name of the material in reports.
    pub name: String,
    /// Model of the material, with its first sampler.
    pub model: ModelId,
    /// Parameters of the material.
    pub values: Values,
}

/// Key of a material, as headers and reports have it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialKey {
    /// Name of the material in reports.
    pub name: String,
    /// Name of the model in the registry.
    pub model: String,
    /// Names of the samplers, in the order of the rows.
    pub samplers: Vec<String>,
    /// Parameters, as `hairis eval` reads them.
    pub params: Value,
}

impl MaterialKey {
    /// Returns the names of the samplers and of perfect sampling, in the order of the rows.
    pub fn strategies(&self) -> impl Iterator<Item = &str> {
        let samplers = self.samplers.iter().map(String::as_str);
        samplers.chain([PERFECT])
    }
}

/// Returns the first entry of a model's name.
///
/// # Errors
///
/// Returns [`Error::Usage`], which names `flag`, if there is no such model.
pub fn find_model(flag: &str, name: &str) -> Result<ModelId, Error> {
    material::find_model(name).map_err(|problem| Error::Usage(format!("{flag} {problem}")))
}

/// Returns the materials that names of models and files stand for. A model stands for each of its presets.
///
/// # Errors
///
/// Returns [`Error::Usage`] if there is no such model, or if a file cannot be read or has no legal material.
pub fn of_flags(models: &[String], paths: &[PathBuf]) -> Result<Vec<NamedMaterial>, Error> {
    let mut all: Vec<(String, ModelId, Values)> = Vec::new();
    for name in models {
        let model = find_model("--model", name)?;
        let presets = model.presets();
        all.extend(presets.map(|(preset, values)| (format!("{name}-{preset}"), model, values)));
    }
    let materials = files::read(paths);
    for (name, spec) in
        materials.map_err(|problem| Error::Usage(format!("--material {problem}")))?
    {
        let model = ModelId::find(spec.model.name(), None).unwrap_or(spec.model);
        all.push((name, model, spec.values));
    }
    let names = numbered(all.iter().map(|(name, ..)| name.clone()));
    let named = names.into_iter().zip(all);
    Ok(named
        .map(|(name, (_, model, values))| NamedMaterial {
            name,
            model,
            values,
        })
        .collect())
}

impl NamedMaterial {
    /// Returns the material's name, model, samplers and parameters.
    #[must_use]
    pub fn key(&self) -> MaterialKey {
        let samplers = RaySubject::of_model(self.model);
        MaterialKey {
            name: self.name.clone(),
            model: self.model.name().to_owned(),
            samplers: samplers.map(|of| of.sampler().to_owned()).collect(),
            params: values_json(&self.values),
        }
    }

    /// Returns the material of a key, the inverse of [`key`](Self::key).
    ///
    /// # Errors
    ///
    /// Returns the reason, in words, if this program has no such material.
    pub fn of_key(key: &MaterialKey) -> Result<Self, String> {
        let text = json!({ "model": key.model, "params": key.params }).to_string();
        let read = MaterialSpec::parse_all(&text)?;
        let [spec] = &read[..] else {
            return Err("is not one material".to_owned());
        };
        let found = Self {
            name: key.name.clone(),
            model: spec.model,
            values: spec.values,
        };
        if found.key() == *key {
            Ok(found)
        } else {
            Err(format!("{} has other samplers in this version", key.model))
        }
    }

    /// Returns a number that materials of one model and equal parameters share; 0 and -0 are equal.
    pub fn digest(&self) -> u64 {
        let values = self.values.map(|x| x + 0.0);
        let text = format!("{} {}", self.model.name(), values_json(&values));
        stream_id(&text.bytes().map(u64::from).collect::<Vec<_>>())
    }

    /// Measures the figures from an inclination: samplers outermost, uniform directions first, then lights; after them those of perfect
    /// sampling, by light.
    ///
    /// # Errors
    ///
    /// Returns an error if the material's parameters are rejected.
    pub fn measure(
        &self,
        seed: u64,
        budget: SampleBudget,
        lights: Lights<'_>,
        theta_o_deg: f64,
    ) -> Result<Vec<Measured>, ParamError> {
        let hit = Hit::new(viewer(theta_o_deg), OFFSET);
        let samplers: Vec<RaySubject> = RaySubject::of_model(self.model).collect();
        let source = samplers.iter().position(|of| of.sampler() == SOURCE.name());
        // A model without that sampler uses its first one, which comes after uniform directions.
        let source = source.unwrap_or(1);
        let subject = |(place, of): (usize, &RaySubject)| {
            Ok(Subject {
                scatter: of.at(&self.values, hit)?,
                stream: [self.model as u64, place as u64],
                is_source: place == source,
            })
        };
        let subjects = samplers.iter().enumerate().map(subject);
        let subjects = subjects.collect::<Result<Vec<Subject>, ParamError>>()?;
        let key = stream_id(&[self.digest(), theta_o_deg.to_bits()]);
        let found = variance::measure([seed, key], budget, &lights.all(), &subjects);
        let rows = found.iter().flat_map(|of| &of.sampler);
        let perfect = found.iter().flat_map(|of| &of.perfect);
        Ok(rows.chain(perfect).copied().collect())
    }

    /// Sets the proven bounds on the weights, given the figures of [`measure`](Self::measure) under so many lights.
    ///
    /// # Errors
    ///
    /// Returns an error if the material's parameters are rejected.
    pub fn set_bounds(
        &self,
        theta_o_deg: f64,
        measured: &mut [Measured],
        lights: usize,
    ) -> Result<(), ParamError> {
        let wo = viewer(theta_o_deg).as_dvec3().to_array();
        let samplers = RaySubject::of_model(self.model);
        for (of, rows) in samplers.zip(measured.chunks_mut(lights.max(1))) {
            let Some(id) = of.own() else { continue };
            let formulas = reference(id, &self.values, wo, f64::from(OFFSET))?;
            let bound = formulas.weight_bound(LobeMask::ALL);
            rows.iter_mut().for_each(|row| row.weight_bound = bound);
        }
        Ok(())
    }
}

/// Returns the direction to a viewer at this inclination, in degrees.
#[must_use]
pub fn viewer(theta_o_deg: f64) -> Vec3 {
    fibre_direction(theta_o_deg.to_radians(), PHI_O_DEG.to_radians()).as_vec3()
}

/// Row of results: one sampler of a material under one light, from one inclination.
#[derive(Clone, Copy, Debug)]
pub struct MaterialRow<'a> {
    /// Material.
    pub material: &'a MaterialKey,
    /// Name of the sampler.
    pub sampler: &'a str,
    /// Name of the light.
    pub light: &'a str,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Figures of the row.
    pub measured: &'a Measured,
}

impl<'a> MaterialRow<'a> {
    /// Returns the names of material, sampler and light.
    fn key(&self) -> [&'a str; 3] {
        [&self.material.name, self.sampler, self.light]
    }
}

/// Returns the rows of a material from an inclination, given its figures in the order of [`NamedMaterial::measure`].
pub fn rows<'a>(
    material: &'a MaterialKey,
    lights: &'a [String],
    theta_o_deg: f64,
    measured: &'a [Measured],
) -> impl Iterator<Item = MaterialRow<'a>> {
    let of_sampler = move |sampler| lights.iter().map(move |light| (sampler, &**light));
    let keys = material.strategies().flat_map(of_sampler);
    iter::zip(keys, measured).map(move |((sampler, light), measured)| MaterialRow {
        material,
        sampler,
        light,
        theta_o_deg,
        measured,
    })
}

/// Returns the rows as columns: `material`, `model`, `theta_o_deg`, `sampler` and `light`, then the figures of a study.
#[must_use]
pub fn columns(rows: &[MaterialRow<'_>]) -> Columns {
    let text = |of: fn(&MaterialRow<'_>) -> String| rows.iter().map(of);
    let columns = Columns::default()
        .text("material", text(|row| row.material.name.clone()))
        .text("model", text(|row| row.material.model.clone()))
        .number("theta_o_deg", rows.iter().map(|row| row.theta_o_deg))
        .text("sampler", text(|row| row.sampler.to_owned()))
        .text("light", text(|row| row.light.to_owned()));
    figures_of(
        columns,
        &rows.iter().map(|row| row.measured).collect::<Vec<_>>(),
    )
}

/// Groups the rows by material, sampler and light, in the order of the first row of each group.
fn by_estimator<'a>(rows: &[MaterialRow<'a>]) -> Vec<Vec<MaterialRow<'a>>> {
    let mut groups: Vec<Vec<MaterialRow<'a>>> = Vec::new();
    for row in rows {
        match groups.iter_mut().find(|group| group[0].key() == row.key()) {
            Some(group) => group.push(*row),
            None => groups.push(vec![*row]),
        }
    }
    groups
}

/// Returns the geometric mean of a figure over some rows. The mean is NaN if any of them is 0, as V of a perfect sampler under constant
/// light, or too uncertain.
fn mean(rows: &[MaterialRow<'_>], figure: &dyn Fn(&Measured) -> Estimate) -> Estimate {
    let figures: Vec<Estimate> = rows.iter().map(|row| figure(row.measured)).collect();
    let is_known =
        |of: &Estimate| of.value > NOTHING && of.standard_error <= MAX_RELATIVE_ERROR * of.value;
    if figures.iter().all(is_known) {
        Estimate::geometric_mean(&figures)
    } else {
        Estimate::UNKNOWN
    }
}

/// Returns the table of V of every sampler of every material, as geometric means over the inclinations.
pub fn table(rows: &[MaterialRow<'_>]) -> Table {
    let mut table = Table::new("V of one sample of other materials")
        .texts(["material", "model", "sampler", "light"])
        .numbers(["V", "uniform / V", "largest weight"])
        .numbers(RAYS.each_ref().map(|by| format!("V of a ray, {}", by.name)));
    let shown = |of: Estimate| {
        let text = of.value.is_finite().then(|| number::estimate(&of));
        text.unwrap_or_default()
    };
    let v = |rows: &[MaterialRow<'_>]| mean(rows, &|of| of.figures.v);
    let groups = by_estimator(rows);
    for group in &groups {
        let [name, _, light] = group[0].key();
        let base = [name, Sampler::Uniform.name(), light];
        let uniform = groups.iter().find(|other| other[0].key() == base);
        let ratio = uniform.map_or(Estimate::UNKNOWN, |uniform| v(uniform).ratio(&v(group)));
        let weights = group.iter().map(|row| row.measured.max_weight);
        let [name, sampler, light] = group[0].key().map(str::to_owned);
        table.push(
            [name, group[0].material.model.clone(), sampler, light]
                .into_iter()
                .chain([v(group), ratio].map(shown))
                .chain([number::plain(weights.fold(0.0, f64::max), 3)])
                .chain((0..RAYS.len()).map(|by| shown(mean(group, &|of| ray_v(of, by))))),
        );
    }
    table.note(
        "Geometric means over the inclinations of the viewer. Rays meet fibres of models that read the offset halfway between \
         axis and rim. perfect: directions in proportion to S cos θᵢ. Empty: 0, or known to no better than \
         25%. ±: one standard error.",
    )
}

/// Returns a line for each figure that cannot be right, by the rules of a study.
#[must_use]
pub fn failures(rows: &[MaterialRow<'_>]) -> Vec<String> {
    let checked = rows.iter().map(|row| {
        let [name, sampler, light] = row.key();
        Checked {
            place: format!("{name} seen from {}°, {sampler}, {light}", row.theta_o_deg),
            group: format!("{name} {}", row.theta_o_deg),
            is_constant: light == Constant::NAME && sampler != PERFECT,
            measured: row.measured,
        }
    });
    check::failures(&checked.collect::<Vec<_>>())
}

/// Figures of a material, with each of its samplers under each light, from one inclination.
#[derive(Clone, Debug, Serialize)]
pub struct MaterialPose {
    /// Name, model, samplers and parameters of the material.
    pub material: MaterialKey,
    /// Inclination of the viewer, in degrees.
    pub theta_o_deg: f64,
    /// Figures: samplers outermost, then lights.
    pub rows: Vec<MaterialEntry>,
}

/// Figures of a sampler under a light.
#[derive(Clone, Debug, Serialize)]
pub struct MaterialEntry {
    /// Name of the sampler.
    pub sampler: String,
    /// Name of the light.
    pub light: String,
    /// Figures.
    #[serde(flatten)]
    pub measured: Measured,
}

impl MaterialPose {
    /// Returns the rows of the material from this inclination.
    pub fn rows(&self) -> impl Iterator<Item = MaterialRow<'_>> {
        self.rows.iter().map(|row| MaterialRow {
            material: &self.material,
            sampler: &row.sampler,
            light: &row.light,
            theta_o_deg: self.theta_o_deg,
            measured: &row.measured,
        })
    }
}

/// Measures materials from some inclinations, on all cores. Workers call `progress` with the number of poses done and of all poses.
///
/// # Errors
///
/// Returns an error if the parameters of a material are rejected.
pub fn run(
    materials: &[NamedMaterial],
    seed: u64,
    budget: SampleBudget,
    lights: Lights<'_>,
    inclinations: &[f64],
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<MaterialPose>, ParamError> {
    let names: Vec<String> = lights.all().iter().map(|of| of.name().to_owned()).collect();
    let of_material = |material| inclinations.iter().map(move |theta_o| (material, *theta_o));
    let poses: Vec<(&NamedMaterial, f64)> = materials.iter().flat_map(of_material).collect();
    let measure = |&(material, theta_o_deg): &(&NamedMaterial, f64)| {
        let key = material.key();
        let mut measured = material.measure(seed, budget, lights, theta_o_deg)?;
        material.set_bounds(theta_o_deg, &mut measured, names.len())?;
        let entry = |row: MaterialRow<'_>| MaterialEntry {
            sampler: row.sampler.to_owned(),
            light: row.light.to_owned(),
            measured: *row.measured,
        };
        Ok(MaterialPose {
            rows: rows(&key, &names, theta_o_deg, &measured)
                .map(entry)
                .collect(),
            material: key,
            theta_o_deg,
        })
    };
    let found = Progress::new(poses.len(), progress).map(&poses, measure);
    found.into_iter().collect()
}
