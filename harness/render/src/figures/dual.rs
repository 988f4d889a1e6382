//! Dual scattering beside paths of any length: one head of hair in four colours.

use super::map::Map;
use super::measure::Plan;
use super::panel::{Column, crops, panel};
use super::store::Store;
use crate::hair::{Choice, Energy, default_sampler};
use crate::picture::exposure;
use crate::protocol::Reference;
use crate::scenes::Name;
use crate::transport::{Integrator, Mis, Settings};
use hairis_instruments::error::Error;
use hairis_instruments::report::{Drawing, Section};
use hairis_instruments::table::{Table, number};
use std::collections::BTreeMap;

/// Names of the presets that are compared, from the most light that is scattered more than once to the least.
pub const COLOURS: [&str; 4] = ["white", "blond", "brown", "black"];
/// Names of the models that are compared. The first is the only one of quick figures.
pub(super) const MODELS: [&str; 2] = ["gaussian", "chiang"];
/// Side of blocks in pixels.
const BLOCK: usize = 4;
/// Scene of the page.
pub(super) const SCENE: Name = Name::AreaHead;

/// Dual scattering of one model and one preset beside paths of any length, on the pixels whose centre shows hair.
#[derive(Debug)]
pub struct Pair {
    /// Name of the model.
    pub(super) model: &'static str,
    /// Name of the preset.
    pub(super) preset: &'static str,
    /// Samples per pixel of each picture.
    pub(super) samples: u32,
    paths: Reference,
    dual: Reference,
    /// Mean over that of paths, in red, green and blue.
    pub means: [f64; 3],
    /// Standard error of the ratio of mean luminances.
    pub noise: f64,
    /// Share of the mean of paths that is light scattered once, in red, green and blue.
    pub once: [f64; 3],
    /// Root of the mean squared difference of luminances over the mean luminance, by blocks of four pixels square, whose noise is less than
    /// that of a pixel. Noise of both pictures is subtracted.
    pub by_block: f64,
    /// Processor time of a sample of each pixel in seconds: dual scattering and paths.
    pub times: [f64; 2],
}

impl Pair {
    /// Renders a scene, except for pictures that the store holds, with hair that gives back no more light than it receives.
    ///
    /// # Errors
    ///
    /// Returns the errors of the store, and [`Error::Interrupted`] if the run is stopped.
    pub fn render(
        name: Name,
        [model, preset]: [&'static str; 2],
        plan: &Plan,
        seed: u64,
        store: &Store,
    ) -> Result<Self, Error> {
        // Looks need fewer samples than errors.
        let halves = plan.reference[1] / 4;
        let choice = Choice::find(model, default_sampler(model), preset)?;
        let scene = plan.build(name, choice.hair(Energy::PerWo)?, None)?;
        let of_scene = format!("{} energy=PerWo", plan.scene(name, &choice));
        let render = |integrator: Integrator, mis| {
            let settings = Settings {
                integrator,
                mis,
                seed,
                ..Settings::default()
            };
            let file = format!("{preset}-{model}-{}", integrator.word());
            store.reference(&file, &of_scene, &scene, &settings, halves)
        };
        let paths = render(Integrator::Path, Mis::Resampled)?;
        let once = render(Integrator::Direct, Mis::Resampled)?;
        let dual = render(Integrator::Dual, Mis::Light)?;
        let shown = scene.pixels_of_hair();
        let over = |part: &Reference| {
            let sum = |of: &Reference, c: usize| -> f64 {
                shown.iter().map(|k| of.picture.pixels[*k][c]).sum()
            };
            [0, 1, 2].map(|c| sum(part, c) / sum(&paths, c))
        };
        let samples = 2 * halves;
        Ok(Self {
            model,
            preset,
            samples,
            means: over(&dual),
            noise: dual.noise(&shown).hypot(paths.noise(&shown)),
            once: over(&once),
            by_block: by_block(&paths, &dual, &shown),
            times: [&dual, &paths].map(|of| of.seconds / f64::from(samples)),
            paths,
            dual,
        })
    }

    /// Returns the relative difference of each pixel's luminance.
    fn differences(&self) -> Vec<f64> {
        self.paths.relative(&self.paths.signed(&self.dual.picture))
    }
}

/// Returns [`Pair::by_block`] on some of the pixels.
fn by_block(paths: &Reference, dual: &Reference, shown: &[usize]) -> f64 {
    let columns = paths.picture.size[0] as usize;
    let luminances = paths.picture.luminances();
    let (signed, squares) = (paths.signed(&dual.picture), paths.squares(dual));
    let mut blocks: BTreeMap<_, [f64; 3]> = BTreeMap::new();
    for k in shown {
        let noise = signed[*k] * signed[*k] - squares[*k];
        let block = blocks
            .entry((k % columns / BLOCK, k / columns / BLOCK))
            .or_default();
        for (sum, x) in block.iter_mut().zip([luminances[*k], signed[*k], noise]) {
            *sum += x;
        }
    }
    let count = blocks.len().max(1) as f64;
    let mean = |of: fn(&[f64; 3]) -> f64| blocks.values().map(of).sum::<f64>() / count;
    let square = mean(|[_, signed, noise]| signed * signed - noise);
    square.max(0.0).sqrt() / mean(|[luminance, ..]| *luminance)
}

/// Returns the answer in a sentence: how far means are off, and what is saved.
pub(super) fn sentence(pairs: &[Pair]) -> String {
    let one = |pair: &Pair| {
        let mean = pair.means.iter().sum::<f64>() / 3.0;
        format!("{} {} {mean:.2}", pair.model, pair.preset)
    };
    let list: Vec<String> = pairs.iter().map(one).collect();
    let [dual, paths] = [0, 1].map(|k| pairs.iter().map(|pair| pair.times[k]).sum::<f64>());
    format!(
        "Means over those of paths: {}. A sample takes {:.2} of the time.",
        list.join(", "),
        dual / paths
    )
}

/// Returns the section of the page.
pub(super) fn section(pairs: &[Pair]) -> std::io::Result<Section> {
    let mut table = Table::new("Dual scattering beside paths")
        .texts(["hair", "model"])
        .numbers([
            "red",
            "green",
            "blue",
            "scattered once (%)",
            "by block (%)",
            "time",
        ]);
    let mut section = Section::new("Dual scattering").paragraph(format!(
        "The scene `{}` by paths of any length, and by dual scattering, which takes one ray to a light at each hit that the camera \
         sees. No hair gives back more light than it receives.",
        SCENE.word()
    ));
    for colour in COLOURS {
        let pairs: Vec<&Pair> = pairs.iter().filter(|pair| pair.preset == colour).collect();
        let Some(first) = pairs.first() else {
            continue;
        };
        let mut columns = Vec::new();
        let mut squares = vec![0.0; first.paths.picture.pixels.len()];
        for pair in &pairs {
            let [red, green, blue] = pair.means.map(number::ratio);
            let percent = |share: f64| number::plain(100.0 * share, 3);
            let [dual, paths] = pair.times;
            table.push([
                colour.to_owned(),
                pair.model.to_owned(),
                red,
                green,
                blue,
                percent(pair.once[0]),
                percent(pair.by_block),
                number::ratio(dual / paths),
            ]);
            let differences = pair.differences();
            squares
                .iter_mut()
                .zip(&differences)
                .for_each(|(sum, difference)| *sum += difference * difference);
            let column = |what: &str, of, errors| Column {
                title: format!("{}, {what}", pair.model),
                remark: format!("{colour}, {} samples", pair.samples),
                picture: of,
                errors,
            };
            columns.push(column("paths", &pair.paths.picture, Vec::new()));
            let dual = &pair.dual.picture;
            columns.push(column("dual scattering", dual, vec![differences]));
        }
        let map = Map::signed(
            "relative difference from paths",
            1.0,
            &["blue: darker, red: brighter", "white: none"],
        );
        let picture = &first.paths.picture;
        let drawing = panel(
            &columns,
            &crops(picture, &squares),
            &[map],
            exposure(picture),
        )?;
        let caption = format!("Hair: {colour}. B: where dual scattering differs most.");
        section = section.figures([Drawing::new("", drawing, caption)]);
    }
    let table = table.note(
        "Red, green and blue: ratio of means over the pixels that show hair. Scattered once: share of the light of paths, in red. By \
         block: root of the mean squared difference in luminance of four pixels square over the mean, the noise of both pictures subtracted. Time: of a \
         sample, over that of paths.",
    );
    Ok(section.tables([table]))
}
