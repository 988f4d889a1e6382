//! Subcommand `hairis-render fit`, which recovers the material of hair from a picture.

use super::place::{Ground, choices};
use crate::args::Fit as Flags;
use crate::film::{Film, Picture};
use crate::fit::{Fit, FitSettings, Target, fit};
use crate::hair::{Choice, Energy};
use crate::picture;
use crate::scene::Scene;
use crate::transport::{self, Integrator, Settings};
use hairis_instruments::columns::Columns;
use hairis_instruments::error::Error;
use hairis_instruments::files::{whole, writable, write_json};
use hairis_instruments::plot::{Axis, Series, lines};
use hairis_instruments::program::{print, say};
use hairis_instruments::progress::{share_bar, show_share};
use hairis_instruments::table::{Table, number};
use hairis_instruments::terminal;
use hairis_materials::material::{in_place_of, values_json};
use hairis_variants::Field;
use image::{Rgb, RgbImage};
use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::Path;

/// Samples per pixel of the pictures before and after the fit.
const SAMPLES: u32 = 64;
/// Width of the gap between pictures side by side, in pixels.
const GAP: u32 = 4;
/// Relative standard error above which the table says that the picture hardly determines a number.
const UNKNOWN: f64 = 0.1;

/// Recovers the material of hair from a picture.
///
/// # Errors
///
/// Returns an error if a flag is out of its range, or a file cannot be read or written. Both are checked before any work is done.
pub(super) fn run(flags: &Flags) -> Result<(), Error> {
    flags.check()?;
    let start = start(flags)?;
    let target = target(flags)?;
    let settings = FitSettings {
        fixed: flags.fix.clone(),
        free: flags.free.clone(),
        iterations: flags.iterations,
        samples: flags.spp,
        depth: flags.depth,
        seed: flags.seed,
        multiple: flags.place.scene.defaults().multiple && !flags.no_multiple,
    };
    warn(&target, &settings);
    let ground = Ground::read(&flags.place, target.crop().len())?;
    let scene = ground.scene(&flags.place, start.hair(Energy::Raw)?, target.size())?;
    fs::create_dir_all(&flags.out).map_err(Error::output(&flags.out))?;
    let names = [
        "material.json",
        "parameters.csv",
        "parameters.svg",
        "pictures.png",
    ];
    let [material, csv, plot, pictures] = names.map(|name| flags.out.join(name));
    for path in [&material, &csv, &plot, &pictures] {
        writable(path)?;
    }

    let bar = share_bar("{wide_bar} {percent:>3}% {elapsed} (left {eta})");
    let found = fit(&scene, &start, &target, &settings, &|done| {
        show_share(&bar, f64::from(done) / f64::from(flags.iterations));
    })?;
    bar.finish_and_clear();

    let params = values_json(&found.values);
    write_json(
        &material,
        &BTreeMap::from([("model", start.id.name().into()), ("params", params)]),
    )?;
    whole(&csv, |out| columns(&found).write_csv(out))?;
    whole(&plot, |out| out.write_all(drawing(&found).as_bytes()))?;
    let end = Choice {
        values: found.values,
        ..start.clone()
    };
    let before = render(&scene, &start, &target, &settings)?;
    let after = render(&scene, &end, &target, &settings)?;
    let target = target.picture();
    let exposure = flags.exposure.unwrap_or_else(|| picture::exposure(&target));
    write_pictures(&[before, after, target], exposure, &pictures)?;
    let text = table(&found).to_text(terminal::columns());
    print(format!("{text}wrote {}\n", material.display()))
}

/// Reads the target, and logs how its values were changed.
fn target(flags: &Flags) -> Result<Target, Error> {
    let problem = |problem| Error::Usage(format!("--target {}: {problem}", flags.target.display()));
    let target = Target::read(&flags.target, flags.target_layer()).map_err(problem)?;
    for remark in target.remarks() {
        say(&format!("{}: {remark}", flags.target.display()));
    }
    Ok(target)
}

/// Returns the material that the fit starts from.
fn start(flags: &Flags) -> Result<Choice, Error> {
    let mut all = choices(&flags.looks, &flags.place)?;
    let start = all.swap_remove(0);
    if !all.is_empty() {
        return Err(Error::Usage(format!(
            "--material must have one material to begin with, got {}",
            all.len() + 1
        )));
    }
    let fields = start.values.fields();
    for (flag, names) in [("--fix", &flags.fix), ("--free", &flags.free)] {
        let is_unknown = |name: &&String| fields.iter().all(|field| field.name != **name);
        if let Some(name) = names.iter().find(is_unknown) {
            let known: Vec<&str> = fields.iter().map(|field| field.name).collect();
            return Err(Error::Usage(format!(
                "{flag} must be one of {}, the fields of {}, got {name}",
                known.join(", "),
                start.id.name()
            )));
        }
        let given = |field: &&Field| start.values.has(field.name);
        let is_missing = |field: &&Field| names.contains(&field.name.to_owned()) && !given(field);
        if let Some(field) = fields.iter().find(is_missing) {
            let instead = in_place_of(field, &start.values).map(|other| {
                let name = other.name;
                format!("; give {name}, which the start has in its place")
            });
            return Err(Error::Usage(format!(
                "{flag} must be a field that the start has, got {}{}",
                field.name,
                instead.unwrap_or_default()
            )));
        }
    }
    Ok(start)
}

/// Warns if the target was rendered with light that the fit does not follow.
fn warn(target: &Target, settings: &FitSettings) {
    let expected = [
        "integrator=Path".to_owned(),
        format!("depth=Some({})", settings.depth),
        format!("multiple={}", settings.multiple),
        "energy=Raw".to_owned(),
    ];
    let differences = target.differences(&expected);
    if !differences.is_empty() {
        say(&format!(
            "warning: the target was rendered with {}: the fit follows other light, and the material makes up for the difference",
            differences.join(", ")
        ));
    }
}

/// Renders the part of the picture that the target covers, with the hair of a material.
fn render(
    scene: &Scene,
    hair: &Choice,
    target: &Target,
    settings: &FitSettings,
) -> Result<Picture, Error> {
    let scene = Scene {
        hair: hair.hair(Energy::Raw)?,
        ..scene.clone()
    };
    let settings = Settings {
        integrator: Integrator::Path,
        depth: Some(settings.depth),
        multiple: settings.multiple,
        seed: settings.seed,
        ..Settings::default()
    };
    let mut film = Film::new(target.crop());
    transport::render(&scene, &settings, &mut film, SAMPLES, &|_| ());
    Ok(film.picture())
}

/// Writes pictures side by side into one PNG file.
fn write_pictures(pictures: &[Picture], exposure: f64, path: &Path) -> Result<(), Error> {
    let [width, height] = pictures[0].size;
    let step = width + GAP;
    let count = u32::try_from(pictures.len()).unwrap_or_default();
    let mut sheet = RgbImage::from_pixel(count * step - GAP, height, Rgb([255; 3]));
    for (place, one) in (0..).zip(pictures) {
        image::imageops::replace(
            &mut sheet,
            &picture::preview(one, exposure),
            place * i64::from(step),
            0,
        );
    }
    whole(path, |out| out.write_all(&picture::png(&sheet)?))
}

/// Returns the numbers and the error of the picture by iteration, as columns of a CSV file.
fn columns(fit: &Fit) -> Columns {
    let mut columns = Columns::default()
        .whole("iteration", 0..fit.history.len())
        .number("error", fit.distances.iter().copied().chain([f64::NAN]));
    for (k, name) in fit.names.iter().enumerate() {
        columns = columns.number(name.clone(), fit.history.iter().map(|numbers| numbers[k]));
    }
    columns
}

/// Draws the numbers by iteration, relative to the values that were found, with one colour per field.
fn drawing(fit: &Fit) -> String {
    let mut fields: Vec<&str> = Vec::new();
    let mut series = Vec::new();
    for (k, name) in fit.names.iter().enumerate() {
        let field = name.split('.').next().unwrap_or(name);
        let dash = series.len();
        let color = fields
            .iter()
            .position(|one| *one == field)
            .unwrap_or_else(|| {
                fields.push(field);
                fields.len() - 1
            });
        let points = fit.history.iter().enumerate();
        let relative = points.map(|(i, numbers)| (i as f64, numbers[k] / fit.numbers[k]));
        series.push(Series::curve(name.clone(), relative).styled(color, dash));
    }
    let y = Axis::linear("relative to the last value").range(0.5, 1.5);
    lines(
        "Parameters by iteration",
        Axis::linear("iteration"),
        y,
        &series,
    )
}

/// Returns the table of the numbers before and after the fit, with standard errors.
fn table(fit: &Fit) -> Table {
    let mut table = Table::new("Fitted parameters")
        .texts(["parameter"])
        .numbers(["start", "fitted", "standard error"])
        .texts([""]);
    for (k, name) in fit.names.iter().enumerate() {
        let (value, error) = (fit.numbers[k], fit.errors[k]);
        let remark = if error.abs() > UNKNOWN * value.abs() {
            "the picture hardly tells it"
        } else {
            ""
        };
        table.push([
            name.clone(),
            number::plain(fit.history[0][k], 5),
            number::plain(value, 5),
            number::plain(error, 2),
            remark.to_owned(),
        ]);
    }
    table.note(
        "Standard errors are those of the fit's own paths; the noise of the target comes on top.",
    )
}
