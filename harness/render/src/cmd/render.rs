//! `hairis-render render`.

use crate::args::Render;
use crate::film::{Crop, Film};
use crate::hair::{Choice, Energy, MOST_MEAN_ALBEDO};
use crate::material::Hair;
use crate::picture;
use crate::scene::Scene;
use crate::scenes::{self, Name, Parts};
use crate::transport::{self, Integrator, Settings};
use hairis_harness::error::Error;
use hairis_harness::light::Environment;
use indicatif::{ProgressBar, ProgressStyle};
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time between two previews.
const PREVIEW: Duration = Duration::from_secs(10);
/// Samples of a pass over all tiles.
const PASS: u32 = 4;

/// Renders a scene.
///
/// # Errors
///
/// If a flag is out of its range, or a file cannot be read or written; before anything is rendered.
pub(super) fn run(flags: &Render) -> Result<(), Error> {
    flags.check()?;
    let crop = flags.part()?;
    let defaults = flags.scene.defaults();
    let settings = Settings {
        integrator: flags.integrator.unwrap_or(defaults.integrator),
        sequence: flags.xi,
        seed: flags.seed,
        mis: flags.mis,
        depth: flags.depth,
        multiple: defaults.multiple && !flags.no_multiple,
        rays: flags.aa,
        ..Settings::default()
    };
    let hair = hair(flags, &settings)?;
    let out = flags.out.clone().unwrap_or_else(|| PathBuf::from(format!("out/render/{}.exr", flags.scene.word())));
    prepare(&out)?;
    let env = flags.env.as_deref().map(environment).transpose()?;
    let strands = match &flags.import {
        Some(path) => import(path)?,
        None => scenes::grow(flags.scene, flags.strands)?,
    };
    let parts = Parts { strands, imported: flags.import.is_some(), hair, env, size: flags.size.0 };
    let scene = scenes::build(flags.scene, parts)?;
    let samples = flags.spp.unwrap_or(defaults.samples);
    let film = passes(flags, &scene, &settings, crop, samples, &out)?;
    let picture = film.picture();
    picture::write(&picture, &out, flags.exposure.unwrap_or_else(|| picture::exposure(&picture)))?;
    let [r, g, b] = picture.mean();
    let seconds = film.seconds();
    let line = format!("wrote {}: mean {r:.5} {g:.5} {b:.5}, {seconds:.1} s of CPU time\n", out.display());
    io::stdout().write_all(line.as_bytes()).map_err(Error::Write)
}

/// The hair that the flags ask for.
fn hair(flags: &Render, settings: &Settings) -> Result<Hair, Error> {
    if flags.scene == Name::FurnaceIso && flags.hair.is_none() {
        return Ok(Hair::Isotropic);
    }
    let preset = flags.hair.as_deref().unwrap_or_else(|| flags.scene.defaults().preset);
    let sampler = match &flags.sampler {
        Some(word) => word,
        None if crate::hair::samplers(&flags.model).contains(&"matched") => "matched",
        None => crate::hair::PUBLISHED,
    };
    let choice = Choice::find(&flags.model, sampler, preset)?;
    let energy = flags.energy.unwrap_or(Energy::Raw);
    let hair = choice.hair(energy)?;
    let [mean, worst] = hair.mean_and_worst_albedo();
    // Ignore write errors: this is a remark.
    let _ = writeln!(io::stderr(), "albedo of the hair: mean {mean:.3}, largest {worst:.3}");
    let bounces = settings.integrator == Integrator::Path && settings.multiple;
    if bounces && mean >= MOST_MEAN_ALBEDO && flags.energy.is_none() {
        return Err(Error::Usage(format!(
            "paths need hair of a mean albedo below {MOST_MEAN_ALBEDO}, got {mean:.3} of {preset}: use --energy scaled"
        )));
    }
    Ok(hair)
}

/// Makes the folder of a file, and sees that the file can be written.
fn prepare(path: &Path) -> Result<(), Error> {
    let refuse = |source| Error::Output { path: path.to_owned(), source };
    if path.extension().is_none_or(|end| end != "exr") {
        return Err(Error::Usage(format!("--out must end in .exr, got {}", path.display())));
    }
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(refuse)?;
    }
    fs::File::options().append(true).create(true).open(path).map(drop).map_err(refuse)
}

/// Reads an environment map, and remarks on what is odd about it.
pub(crate) fn environment(path: &Path) -> Result<Environment, Error> {
    let map = Environment::load(path).map_err(Error::Environment)?;
    for note in map.notes() {
        let _ = writeln!(io::stderr(), "{note}");
    }
    Ok(map)
}

/// Reads hair.
fn import(path: &Path) -> Result<crate::geometry::Strands, Error> {
    Err(Error::Usage(format!("{}: no importer yet", path.display())))
}

/// Renders pass by pass, and writes a preview from time to time.
fn passes(
    flags: &Render,
    scene: &Scene,
    settings: &Settings,
    crop: Crop,
    samples: u32,
    out: &Path,
) -> Result<Film, Error> {
    let mut film = Film::new(crop);
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("{msg:>12} {wide_bar} {percent:>3}% {elapsed} (left {eta})") {
        bar.set_style(style);
    }
    let show = |share: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        bar.set_position((share * 1000.0) as u64);
    };
    if settings.integrator == Integrator::Gather {
        transport::render(scene, settings, &mut film, samples, &show);
        bar.finish_and_clear();
        return Ok(film);
    }
    let start = Instant::now();
    let mut written = start;
    let mut done = 0;
    loop {
        let next = if flags.time.is_some() { done + PASS } else { (done + PASS).min(samples) };
        let share = |part: f64| match flags.time {
            Some(time) => (start.elapsed().as_secs_f64() / time).min(1.0),
            None => (f64::from(done) + part * f64::from(next - done)) / f64::from(samples),
        };
        bar.set_message(format!("{done} samples"));
        transport::render(scene, settings, &mut film, next, &|part| show(share(part)));
        done = next;
        let over = flags.time.map_or(done >= samples, |time| start.elapsed().as_secs_f64() >= time);
        if over {
            bar.finish_and_clear();
            return Ok(film);
        }
        if written.elapsed() >= PREVIEW {
            let picture = film.picture();
            picture::write(&picture, out, flags.exposure.unwrap_or_else(|| picture::exposure(&picture)))?;
            written = Instant::now();
        }
    }
}
