//! Measurements of samplers on a scene: a reference, errors by count of samples, and pictures of equal time.

use super::store::Store;
use crate::film::{Crop, Picture};
use crate::hair::{Choice, Energy, MATCHED, PUBLISHED, UNIFORM, check_paths};
use crate::layers::Beside;
use crate::lights::RectangleSampling;
use crate::material::Hair;
use crate::numbers::Sequence;
use crate::part::build;
use crate::picture;
use crate::protocol::{Reference, Runs};
use crate::scene::Scene;
use crate::scenes::{self, Name, Parts};
use crate::transport::{Integrator, Mis, Settings, film};
use hairis_instruments::error::Error;
use hairis_instruments::light::Environment;
use hairis_instruments::machine;
use std::path::Path;

/// Model of the scenes' presets.
const MODEL: &str = "gaussian";
/// Name of the sampler that chooses rays from candidates; the candidates of the hair are drawn by its best sampler.
pub(super) const RESAMPLED: &str = "resampled";
/// Names of all samplers, in the order of the page.
pub const SAMPLERS: [&str; 4] = [UNIFORM, PUBLISHED, RESAMPLED, MATCHED];

/// Returns the samplers of hair. The last is the best: references are rendered with it, and the
/// others are compared with it.
fn samplers(hair: &Choice) -> Vec<&'static str> {
    let others = SAMPLERS.into_iter().filter(|one| *one != MATCHED);
    let others = others.filter(|one| *one != hair.best());
    others.chain([hair.best()]).collect()
}

/// Returns the hair of a scene if the flags name none.
///
/// # Errors
///
/// Returns the errors of [`Choice::find`]; the hair of every scene is listed.
pub fn preset(name: Name) -> Result<Choice, Error> {
    let preset = name.defaults().preset;
    Choice::find(MODEL, MATCHED, preset)
}

/// Amount of rendering: scenes, samples, repetitions.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Width and height of pictures in pixels.
    pub side: u32,
    /// Count of strands of hair.
    pub strands: usize,
    /// Counts of samples per pixel, for shading points and for paths.
    pub samples: [&'static [u32]; 2],
    /// Samples per pixel of each half of the reference, for shading points and for paths.
    pub reference: [u32; 2],
    /// Count of pictures from which each error is estimated.
    pub runs: u32,
    /// Integrator in place of the scenes' own, if the flags name one.
    pub integrator: Option<Integrator>,
    /// Source of the samplers' uniform numbers. References are always rendered with Sobol' points.
    pub sequence: Sequence,
    /// Method that draws directions towards rectangular lights.
    pub rectangle_sampling: RectangleSampling,
}

impl Plan {
    /// Settings for a first look, with small pictures and few samples.
    pub const QUICK: Self = Self {
        side: 96,
        strands: 8_000,
        samples: [&[4, 16, 64], &[4, 16]],
        reference: [1024, 320],
        runs: 8,
        integrator: None,
        sequence: Sequence::Sobol,
        rectangle_sampling: RectangleSampling::SolidAngle,
    };
    /// Settings of the published figures: an hour on two idle cores. A reference has as many samples as 32 of the pictures with the
    /// most, so that it has about 3% of their variance.
    pub const FULL: Self = Self {
        side: 192,
        strands: 30_000,
        samples: [&[4, 16, 64, 256, 1024], &[4, 16, 64]],
        reference: [16384, 1024],
        runs: 8,
        integrator: None,
        sequence: Sequence::Sobol,
        rectangle_sampling: RectangleSampling::SolidAngle,
    };

    /// Returns the line that identifies a scene with its hair, without its light.
    pub(super) fn scene(&self, name: Name, hair: &Choice) -> String {
        let Self {
            side,
            strands,
            rectangle_sampling: rectangles,
            ..
        } = self;
        let (name, hair) = (name.word(), hair.describe());
        format!("scene={name} {hair} side={side} strands={strands} rectangles={rectangles:?}")
    }

    /// Builds a scene with hair, under a map if the scene has one of the caller's.
    pub(super) fn build(
        &self,
        name: Name,
        hair: Hair,
        env: Option<Environment>,
    ) -> Result<Scene, Error> {
        let parts = Parts {
            strands: scenes::grow(name, self.strands)?,
            imported: false,
            head: None,
            hair,
            env,
            size: [self.side; 2],
            turn: 0.0,
        };
        Ok(Scene {
            rectangle_sampling: self.rectangle_sampling,
            ..scenes::build(name, parts)?
        })
    }

    /// Returns the settings of all samplers' pictures of a scene, except what differs between samplers.
    fn settings(&self, name: Name, seed: u64) -> Settings {
        let defaults = name.defaults();
        let integrator = self.integrator.unwrap_or(defaults.integrator);
        Settings {
            integrator,
            multiple: defaults.multiple,
            seed,
            ..Settings::default()
        }
    }

    /// Rejects a scene with hair in which paths do not converge.
    ///
    /// # Errors
    ///
    /// Returns a usage error that names the scene, its hair and the flags that help.
    pub fn check(&self, name: Name, hair: &Choice) -> Result<(), Error> {
        let settings = self.settings(name, 1);
        let remedy = format!(
            "leave out scene {}, or use --integrator gather",
            name.word()
        );
        check_paths(&hair.hair(Energy::Raw)?, &settings, &hair.name, &remedy)
    }

    /// Returns the steps of progress for a count of scenes.
    pub(super) fn steps(&self, scenes: usize) -> usize {
        scenes * (2 + SAMPLERS.len() * (self.samples[0].len() + 1))
    }
}

/// Measurements of one sampler on a scene.
#[derive(Debug)]
pub struct BySampler {
    /// Name of the sampler.
    pub name: &'static str,
    /// Renders by ascending count of samples.
    pub runs: Vec<Runs>,
    /// Renders that take as long as those of the quickest sampler, at the count of samples that pictures show.
    pub equal_time: Runs,
}

/// Measurements of all samplers on a scene.
#[derive(Debug)]
pub struct Measured {
    /// Name of the scene.
    pub name: Name,
    /// Name of the environment map, if it is the caller's.
    map: Option<String>,
    /// Integrator that estimates the light.
    pub integrator: Integrator,
    /// Name of the hair.
    pub hair: String,
    /// Settings of the pictures, except samplers and samples.
    of_scene: String,
    /// Seed of the samples.
    seed: u64,
    /// Samples per pixel of each half of the reference.
    halves: u32,
    /// Share of the rays towards lights that reach them, with the best sampler.
    pub visible: f64,
    /// Picture that the others are compared with.
    pub reference: Reference,
    /// Samplers in the order of [`SAMPLERS`]; the last is the best.
    pub samplers: Vec<BySampler>,
}

impl Measured {
    /// Renders the pictures that the store does not hold yet.
    ///
    /// # Errors
    ///
    /// Returns the errors of the store, and [`Error::Interrupted`] if the run is stopped.
    pub fn render(
        name: Name,
        map: Option<(String, Environment)>,
        hair: &Choice,
        plan: &Plan,
        seed: u64,
        store: &Store,
        step: &dyn Fn(&str),
    ) -> Result<Self, Error> {
        let (map_name, map) = map.unzip();
        let digest = map.as_ref().map_or(0, Environment::digest);
        let sampled = |sampler| hair.sampled(sampler)?.hair(Energy::Raw);
        step(&format!("{}: tree", name.word()));
        let mut scene = plan.build(name, sampled(hair.best())?, map)?;
        let settings = plan.settings(name, seed);
        let integrator = settings.integrator;
        let kind = usize::from(integrator != Integrator::Gather);
        let halves = plan.reference[kind];
        let of_scene = format!(
            "{} env={digest:016x} reference={halves}",
            plan.scene(name, &hair.sampled(hair.best())?)
        );
        step(&format!("{}: reference", name.word()));
        let reference = store.reference(name.word(), &of_scene, &scene, &settings, halves)?;
        let counted = Settings {
            profile: true,
            ..settings
        };
        let visible = film(&scene, &counted, Crop::whole([plan.side; 2]), 4)
            .profile
            .visible();
        let measure = |scene: &mut Scene, sampler: &'static str, samples: u32| {
            let (drawn, mis) = match sampler {
                RESAMPLED => (hair.best(), Mis::Resampled),
                _ => (sampler, Mis::Both),
            };
            scene.hair = sampled(drawn)?;
            let (settings, runs) = (
                Settings {
                    mis,
                    sequence: plan.sequence,
                    ..settings
                },
                plan.runs,
            );
            let file = format!("{}-{sampler}-{samples}", name.word());
            let of_runs =
                format!("{of_scene} sampler={drawn} samples={samples} runs={runs} {settings:?}");
            store.get(&file, &of_runs, |films| {
                Runs::render(&settings, &reference, samples, runs, |settings, picture| {
                    films.render(scene, settings, samples, picture)
                })
            })
        };
        let mut all = Vec::new();
        for sampler in samplers(hair) {
            let run = |samples: &u32| {
                step(&format!("{}: {sampler}, {samples} samples", name.word()));
                measure(&mut scene, sampler, *samples)
            };
            all.push((
                sampler,
                plan.samples[kind]
                    .iter()
                    .map(run)
                    .collect::<Result<Vec<Runs>, Error>>()?,
            ));
        }
        // Pictures show the second count; larger counts are kept for the numbers.
        let shown = shown(plan.samples[kind].len());
        let least = all
            .iter()
            .map(|(_, runs)| runs[shown].seconds)
            .fold(f64::INFINITY, f64::min);
        let mut samplers = Vec::new();
        for (sampler, runs) in all {
            step(&format!("{}: {sampler}, equal time", name.word()));
            let equal_time = measure(&mut scene, sampler, runs[shown].samples_in(least))?;
            samplers.push(BySampler {
                name: sampler,
                runs,
                equal_time,
            });
        }
        let (map, hair) = (map_name, hair.name.clone());
        Ok(Self {
            name,
            map,
            integrator,
            hair,
            of_scene,
            seed,
            halves,
            visible,
            reference,
            samplers,
        })
    }

    /// Returns the name of the scene on the page.
    #[must_use]
    pub fn title(&self) -> String {
        title(self.name, self.map.as_deref(), &self.hair)
    }

    /// Returns the name of the best sampler.
    #[must_use]
    pub fn best(&self) -> &'static str {
        self.samplers.last().map_or(MATCHED, |best| best.name)
    }

    /// Returns the index of the count of samples that pictures show.
    pub(super) fn shown(&self) -> usize {
        shown(self.samplers[0].runs.len())
    }

    /// Writes the pictures as files whose names begin with `stem`: the reference, and each
    /// sampler's at equal samples and at equal time.
    pub(super) fn write_pictures(&self, out: &Path, stem: &str) -> Result<(), Error> {
        let exposure = picture::exposure(&self.reference.picture);
        let write = |what: &str, picture: &Picture, sampler: &str, samples: u32, seconds: f64| {
            let path = out.join(format!("{stem}-{what}.exr"));
            picture::write(
                picture,
                &self.beside(sampler, samples, seconds),
                &path,
                exposure,
            )
        };
        let Reference {
            picture, seconds, ..
        } = &self.reference;
        let best = self.best();
        write("reference", picture, best, 2 * self.halves, *seconds)?;
        for BySampler {
            name,
            runs,
            equal_time,
        } in &self.samplers
        {
            let equal_samples = &runs[self.shown()];
            for (what, runs) in [
                (equal_samples.samples.to_string(), equal_samples),
                ("equal-time".to_owned(), equal_time),
            ] {
                write(
                    &format!("{name}-{what}"),
                    &runs.picture,
                    name,
                    runs.samples,
                    runs.seconds,
                )?;
            }
        }
        Ok(())
    }

    /// Returns the attributes of a picture's file. Times of samplers are those of the fastest of several pictures.
    fn beside(&self, sampler: &str, samples: u32, seconds: f64) -> Beside {
        let machine = machine!();
        let attributes = vec![
            (
                "run",
                format!("{} sampler={sampler} {}", self.of_scene, build()),
            ),
            ("seed", self.seed.to_string()),
            ("commit", machine.commit.to_owned()),
            ("machine", machine.summary()),
            ("samplesPerPixel", samples.to_string()),
            ("secondsOfCpuTime", format!("{seconds:.3}")),
        ];
        Beside {
            attributes,
            ..Beside::default()
        }
    }
}

/// Returns the name of a scene on the page, with the names of the map and of the hair if they are the caller's.
pub(super) fn title(name: Name, map: Option<&str>, hair: &str) -> String {
    let word = name.word();
    let hair = Some(hair).filter(|hair| *hair != name.defaults().preset);
    let parts: Vec<&str> = map.into_iter().chain(hair).collect();
    if parts.is_empty() {
        word.to_owned()
    } else {
        format!("{word} ({})", parts.join(", "))
    }
}

/// Returns the index of the count of samples that pictures show, which is the second.
fn shown(counts: usize) -> usize {
    1.min(counts - 1)
}
