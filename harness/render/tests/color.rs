//! Colours that hair is asked for against those that a head shows under uniform light.

use crate::support::{film, hair_of, scene};
use glam::Vec3;
use hairis_instruments::light::Constant;
use hairis_instruments::record;
use hairis_render::film::Picture;
use hairis_render::hair::{Choice, Energy};
use hairis_render::picture::srgb;
use hairis_render::scene::Scene;
use hairis_render::scenes::Name;
use hairis_render::transport::{Integrator, Mis, Settings};
use hairis_variants::ModelId;
use hairis_variants::color::ColorOf;
use image::{Rgb, RgbImage};
use std::fs;
use std::path::Path;

/// Colours that artists ask for: blacks and browns, red and blond hair, greys, and dyes.
const ASKED: [[f32; 3]; 12] = [
    [0.03, 0.027, 0.025],
    [0.08, 0.05, 0.035],
    [0.16, 0.09, 0.05],
    [0.25, 0.10, 0.05],
    [0.45, 0.18, 0.06],
    [0.35, 0.24, 0.13],
    [0.55, 0.40, 0.22],
    [0.75, 0.66, 0.50],
    [0.40, 0.40, 0.42],
    [0.80, 0.80, 0.78],
    [0.10, 0.22, 0.60],
    [0.70, 0.25, 0.45],
];

/// Head under uniform light, against a background of one radiance.
struct Head {
    scene: Scene,
    settings: Settings,
    samples: u32,
    /// Indices of the pixels that show hair.
    shows: Vec<usize>,
    /// Share of the background in each pixel.
    behind: Vec<f64>,
}

impl Head {
    fn new(name: Name, strands: usize, side: u32, samples: u32) -> Self {
        let hair = hair_of(["chiang", "published", "black"], Energy::PerWo);
        let mut scene = scene(name, hair, strands, side);
        scene.sky = Constant.into();
        scene.rectangles.clear();
        let shows = scene.pixels_of_hair();
        let settings = Settings {
            integrator: Integrator::Path,
            mis: Mis::Resampled,
            ..Settings::default()
        };
        let mut head = Self {
            scene,
            settings,
            samples,
            shows,
            behind: Vec::new(),
        };
        // Camera rays do not depend on what the camera sees.
        let [light, dark] = [1.0, 0.0].map(|radiance| {
            head.scene.backdrop = Some(Vec3::splat(radiance));
            head.picture().pixels
        });
        head.behind = light.iter().zip(&dark).map(|(a, b)| a[1] - b[1]).collect();
        head
    }

    fn picture(&self) -> Picture {
        film(&self.scene, &self.settings, self.samples).picture()
    }

    /// Renders the head with hair of these values. Returns the picture and the mean colour of the hair: of the pixels whose centre shows
    /// hair, without their background.
    fn shown(&mut self, id: ModelId, values: &hairis_variants::Values) -> (Picture, [f64; 3]) {
        let mut choice = Choice::find("chiang", "published", "black").expect("listed");
        let best = ModelId::find(id.name(), Some("matched")).unwrap_or(id);
        (choice.id, choice.values) = (best, *values);
        self.scene.hair = choice.hair(Energy::PerWo).expect("in range");
        let picture = self.picture();
        let of =
            |value: &dyn Fn(usize) -> f64| -> f64 { self.shows.iter().map(|k| value(*k)).sum() };
        let hair = of(&|k| 1.0 - self.behind[k]);
        let mean = [0, 1, 2].map(|c| of(&|k| picture.pixels[k][c]) / hair);
        (picture, mean)
    }
}

/// Returns the values of a model that show a colour in a sense, from its material of brown hair.
fn colored(id: ModelId, color: [f32; 3], of: ColorOf) -> hairis_variants::Values {
    let (_, brown) = id
        .presets()
        .find(|(name, _)| *name == "brown")
        .expect("a preset");
    id.with_color(&brown, color, of)
        .expect("a model with a colour")
}

/// The mean of a small picture is near the asked colour.
#[test]
fn a_head_shows_the_colour_that_is_asked_of_a_mass() {
    let mut head = Head::new(Name::Env, 30_000, 40, 48);
    let asked = [0.45, 0.25, 0.1];
    let (_, shown) = head.shown(ModelId::DEon, &colored(ModelId::DEon, asked, ColorOf::Mass));
    println!("{shown:.3?} for {asked:?}");
    for c in 0..3 {
        let error = shown[c] - f64::from(asked[c]);
        assert!(error.abs() < 0.025, "{shown:?}");
    }
}

/// Part of a picture of 96 pixels square that has the head: left, top, width and height.
const CROP: [u32; 4] = [27, 13, 42, 74];
/// Height of a colour above its heads.
const SWATCH: u32 = 24;

/// Errors are those of the record, within .002. With `HAIRIS_RECORD=write`, writes it and the strip.
#[test]
#[ignore = "slow: ten minutes on two cores"]
fn record_of_colours_on_a_head() {
    let senses = [ColorOf::Chiang, ColorOf::Fibre, ColorOf::Mass];
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let path = root.join("benches/records/color-heads.csv");
    let recorded = fs::read_to_string(&path).unwrap_or_default();
    let mut rows = Vec::new();
    let [left, top, width, height] = CROP;
    let mut strip = RgbImage::new(12 * width, SWATCH + 3 * height);
    for name in [Name::Env, Name::Head] {
        let mut head = Head::new(name, name.defaults().strands, 96, 64);
        for id in [ModelId::Chiang, ModelId::DEon, ModelId::Gaussian] {
            for (row, of) in (0..).zip(senses) {
                if of == ColorOf::Chiang && id != ModelId::Chiang {
                    continue;
                }
                let (mut squares, mut sum, mut worst) = (0.0, 0.0, 0.0_f64);
                for (column, asked) in (0..).zip(ASKED) {
                    let (picture, shown) = head.shown(id, &colored(id, asked, of));
                    for c in 0..3 {
                        let error = shown[c] - f64::from(asked[c]);
                        squares += error * error;
                        sum += error;
                        worst = worst.max(error.abs());
                    }
                    println!(
                        "{} {} {}: {shown:.3?} for {asked:?}",
                        name.word(),
                        id.name(),
                        of.word()
                    );
                    if name != Name::Env || id != ModelId::Chiang {
                        continue;
                    }
                    for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
                        let k = ((top + y) * 96 + left + x) as usize;
                        let grey = 0.35 * head.behind[k];
                        let pixel = picture.pixels[k].map(|channel| srgb(channel + grey));
                        strip.put_pixel(column * width + x, SWATCH + row * height + y, Rgb(pixel));
                        if y < SWATCH {
                            let swatch = asked.map(|channel| srgb(channel.into()));
                            strip.put_pixel(column * width + x, y, Rgb(swatch));
                        }
                    }
                }
                let count = 3.0 * ASKED.len() as f64;
                let key = format!("{},{},{},", name.word(), id.name(), of.word());
                let errors = [(squares / count).sqrt(), worst, sum / count];
                let row = format!("{key}{:.4},{:.4},{:.4}", errors[0], errors[1], errors[2]);
                println!("{row}");
                rows.push(row);
                if !record::is_asked() {
                    let before: [f64; 3] = record::numbers(&recorded, &key);
                    for (now, was) in errors.iter().zip(&before) {
                        let off = (now - was).abs();
                        assert!(off <= 2e-3, "{key} has {before:?} in the record");
                    }
                }
            }
        }
    }
    if record::is_asked() {
        let about = "colours of twelve heads of 96 x 96 pixels and 64 samples, less those asked";
        let columns = "scene,model,sense,rms,largest,mean";
        record::write(
            &path,
            &hairis_instruments::machine!(),
            about,
            columns,
            &rows,
        )
        .expect("a record");
        strip
            .save(root.join("target/color.png"))
            .expect("a picture");
    }
}
