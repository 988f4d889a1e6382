//! One head of hair rendered with every model, side by side.

use super::map::Map;
use super::measure::Plan;
use super::panel::{Column, crops, panel};
use super::store::Store;
use crate::hair::{Choice, Energy, check_paths, default_sampler};
use crate::picture::exposure;
use crate::protocol::Reference;
use crate::scenes::Name;
use crate::transport::Settings;
use hairis_instruments::error::Error;
use hairis_instruments::report::{Drawing, Section};
use hairis_instruments::table::{Table, number};
use hairis_variants::ModelId;

/// Names of the presets that every compared model has.
pub(super) const PRESETS: [&str; 4] = ["blond", "brown", "black", "red"];

/// Pictures of one preset, one for each model; the first model is the published one.
#[derive(Debug)]
pub struct Preset {
    name: &'static str,
    samples: u32,
    models: Vec<(&'static str, Reference)>,
}

impl Preset {
    /// Renders the scene `head` with every model, except for pictures that the store holds.
    ///
    /// # Errors
    ///
    /// Returns the errors of the store, and [`Error::Interrupted`] if the run is stopped.
    pub fn render(
        name: &'static str,
        plan: &Plan,
        seed: u64,
        store: &Store,
        step: &dyn Fn(&str),
    ) -> Result<Self, Error> {
        // A quarter of the samples of references of paths, because looks need fewer samples than errors.
        let samples = plan.reference[1] / 4;
        let hair = |model: &str| {
            let choice = Choice::find(model, default_sampler(model), name)?;
            Ok::<_, Error>((choice.hair(Energy::Raw)?, choice))
        };
        let names = ModelId::defaults_of_names().map(ModelId::name);
        let hairs = names
            .map(|model| Ok((model, hair(model)?)))
            .collect::<Result<Vec<_>, Error>>()?;
        let Some((_, (first, _))) = hairs.first() else {
            return Ok(Self {
                name,
                samples,
                models: Vec::new(),
            });
        };
        let mut scene = plan.build(Name::Head, *first, None)?;
        let defaults = Name::Head.defaults();
        let settings = Settings {
            integrator: defaults.integrator,
            multiple: defaults.multiple,
            seed,
            ..Settings::default()
        };
        let mut models = Vec::new();
        for (model, (hair, choice)) in hairs {
            check_paths(
                &hair,
                &settings,
                name,
                &format!("model {model} cannot be compared"),
            )?;
            step(&format!("{name}: {model}"));
            scene.hair = hair;
            let of_model = plan.scene(Name::Head, &choice);
            models.push((
                model,
                store.reference(
                    &format!("{name}-{model}"),
                    &of_model,
                    &scene,
                    &settings,
                    samples,
                )?,
            ));
        }
        Ok(Self {
            name,
            samples,
            models,
        })
    }

    /// Returns the name of the preset.
    pub(super) fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the samples per pixel of each model's picture.
    pub(super) fn samples(&self) -> u32 {
        2 * self.samples
    }

    /// Returns the name, the relative brightness and the difference of the look of each model beside the first.
    pub(super) fn differences(&self) -> impl Iterator<Item = (&'static str, f64, f64)> {
        let first = self.models.first().map(|(_, first)| first);
        let rest = self.models.iter().skip(1);
        rest.filter_map(move |(name, other)| {
            let (brightness, look) = first?.difference(other);
            Some((*name, brightness, look))
        })
    }
}

/// Returns the section of the page that compares models.
pub(super) fn section(presets: &[Preset]) -> std::io::Result<Section> {
    let mut table = Table::new("Models beside the published one")
        .texts(["hair", "model"])
        .numbers(["brightness", "difference of the look (%)"]);
    let mut section = Section::new("Models").paragraph(
        "One head of wavy hair under an area light, by paths: the published model, its all-Cauchy variant, and the other models \
         with presets of the same names. The presets of a colour are tuned by eye, model by model: the all-Cauchy variant alone \
         has the parameters of the published model.",
    );
    for preset in presets {
        for (model, brightness, look) in preset.differences() {
            table.push([
                preset.name.to_owned(),
                model.to_owned(),
                number::ratio(brightness),
                number::plain(100.0 * look, 3),
            ]);
        }
        let Some((_, first)) = preset.models.first() else {
            continue;
        };
        let mut columns = Vec::new();
        let mut squares = vec![0.0; first.picture.pixels.len()];
        for (name, of) in &preset.models {
            let signed = first.relative(&first.signed(&of.picture));
            squares
                .iter_mut()
                .zip(&signed)
                .for_each(|(sum, difference)| *sum += difference * difference);
            let remark = format!("{}, {} samples", preset.name, preset.samples());
            // Legends take the place of the first picture's difference from itself.
            let errors = if columns.is_empty() {
                Vec::new()
            } else {
                vec![signed]
            };
            columns.push(Column {
                title: (*name).to_owned(),
                remark,
                picture: &of.picture,
                errors,
            });
        }
        let map = Map::signed(
            "relative difference from the published model",
            1.0,
            &["blue: darker, red: brighter", "white: none"],
        );
        let places = crops(&first.picture, &squares);
        let drawing = panel(&columns, &places, &[map], exposure(&first.picture))?;
        let caption = format!("Hair: {}. B: where the models differ most.", preset.name);
        section = section.figures([Drawing::new("", drawing, caption)]);
    }
    table = table.note(
        "Brightness: ratio of mean luminances. Look: root of the mean of (a − b)² / (b² + (0.1 mean)²) in luminance, the noise of \
         both pictures subtracted.",
    );
    Ok(section.tables([table]))
}
