//! Measurements on a scene.

use super::store::Store;
use crate::film::{Crop, Picture};
use crate::hair::{Choice, Energy, MATCHED, PUBLISHED, UNIFORM, check_paths};
use crate::layers::Beside;
use crate::lights::RectangleSampling;
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

/// The model of the scenes' presets.
const MODEL: &str = "gaussian";
/// Rays chosen from candidates, those of the hair drawn by its best sampler.
pub(super) const RESAMPLED: &str = "resampled";
/// All samplers, in the order of the page.
pub(super) const SAMPLERS: [&str; 4] = [UNIFORM, PUBLISHED, RESAMPLED, MATCHED];

/// The samplers of hair; the last is its best, which references are made with and others are
/// compared with.
fn samplers(hair: &Choice) -> Vec<&'static str> {
    let others = SAMPLERS.into_iter().filter(|one| *one != MATCHED);
    let others = others.filter(|one| *one != hair.best());
    others.chain([hair.best()]).collect()
}

/// The hair of a scene where none is asked for.
pub(super) fn preset(name: Name) -> Result<Choice, Error> {
    let preset = name.defaults().preset;
    Choice::find(MODEL, MATCHED, preset)
}

/// Amount of rendering: scenes, samples, repetitions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// Width and height of pictures in pixels.
    pub(super) side: u32,
    /// Strands of hair.
    pub(super) strands: usize,
    /// Samples of shading points, and of paths.
    pub(super) samples: [&'static [u32]; 2],
    /// Samples of each half of the reference, of shading points and of paths.
    pub(super) reference: [u32; 2],
    /// Pictures for each error.
    pub(super) runs: u32,
    /// How light is estimated, in place of the scenes' own ways.
    pub(super) integrator: Option<Integrator>,
    /// Source of the samplers' uniform numbers; references are of Sobol' points.
    pub(super) sequence: Sequence,
    /// How directions towards rectangular lights are drawn.
    pub(super) rectangle_sampling: RectangleSampling,
}

impl Plan {
    /// A first look.
    pub(super) const QUICK: Self = Self {
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
    pub(super) const FULL: Self = Self {
        side: 192,
        strands: 30_000,
        samples: [&[4, 16, 64, 256, 1024], &[4, 16, 64]],
        reference: [16384, 1024],
        runs: 8,
        integrator: None,
        sequence: Sequence::Sobol,
        rectangle_sampling: RectangleSampling::SolidAngle,
    };

    /// Key of a scene with hair, without its light.
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

    /// How the samplers' pictures of a scene are made, but for what is their own.
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

    /// Refuses a scene with hair that paths do not converge in.
    pub(super) fn check(&self, name: Name, hair: &Choice) -> Result<(), Error> {
        let settings = self.settings(name, 1);
        let remedy = format!(
            "leave out scene {}, or use --integrator gather",
            name.word()
        );
        check_paths(&hair.hair(Energy::Raw)?, &settings, &hair.name, &remedy)
    }

    /// Steps of progress for a count of scenes.
    pub(super) fn steps(&self, scenes: usize) -> usize {
        scenes * (2 + SAMPLERS.len() * (self.samples[0].len() + 1))
    }
}

/// One sampler on a scene.
#[derive(Debug)]
pub(super) struct BySampler {
    /// Its name.
    pub(super) name: &'static str,
    /// Renders by ascending count of samples.
    pub(super) runs: Vec<Runs>,
    /// A picture that takes as long as the quickest sampler's at most samples.
    pub(super) equal_time: Runs,
}

/// A scene with all its samplers.
#[derive(Debug)]
pub(super) struct Measured {
    /// The scene.
    pub(super) name: Name,
    /// Name of the map, if it is the caller's.
    map: Option<String>,
    /// How light is estimated.
    pub(super) integrator: Integrator,
    /// Name of the hair.
    pub(super) hair: String,
    /// Settings of the pictures, but for samplers and samples.
    of_scene: String,
    /// Seed of the samples.
    seed: u64,
    /// Samples of each half of the reference.
    halves: u32,
    /// Share of the rays towards lights that reach them, with the best sampler.
    pub(super) visible: f64,
    /// Picture that the others are compared with.
    pub(super) reference: Reference,
    /// The samplers, in the order of [`SAMPLERS`]; the last is the best.
    pub(super) samplers: Vec<BySampler>,
}

impl Measured {
    /// Renders what is not in the store.
    pub(super) fn render(
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
        let strands = scenes::grow(name, plan.strands)?;
        let parts = Parts {
            strands,
            imported: false,
            head: None,
            hair: sampled(hair.best())?,
            env: map,
            size: [plan.side; 2],
            turn: 0.0,
        };
        step(&format!("{}: tree", name.word()));
        let mut scene = Scene {
            rectangle_sampling: plan.rectangle_sampling,
            ..scenes::build(name, parts)?
        };
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
        // The middle count: the largest is kept for the numbers.
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

    /// Name of the scene on the page.
    pub(super) fn title(&self) -> String {
        title(self.name, self.map.as_deref(), &self.hair)
    }

    /// Name of the best sampler.
    pub(super) fn best(&self) -> &'static str {
        self.samplers.last().map_or(MATCHED, |best| best.name)
    }

    /// Place of the count of samples that pictures show.
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

    /// Attributes of a picture's file. Samplers' times are those of the fastest of several pictures.
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

/// Name of a scene on the page, with those of the map and of the hair where they are the caller's.
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

/// Place of the count of samples that pictures show: the second.
fn shown(counts: usize) -> usize {
    1.min(counts - 1)
}
