//! Subcommand `hairis-render render`, which renders a scene into an EXR file and a PNG preview.

mod description;

use super::place::{Ground, choices, has_own_materials, strands};
use crate::args::Render;
use crate::film::{self, Crop, Film};
use crate::formats::write_hair;
use crate::hair::{Choice, Energy, check_paths};
use crate::layers::{self, Beside};
use crate::material::Hair;
use crate::part::{self, Part};
use crate::picture;
use crate::portrait;
use crate::saver::Saver;
use crate::scene::Scene;
use crate::scenes::Name;
use crate::transport::{self, CutOff, Integrator, Settings};
use core::time::Duration;
use description::describe;
use hairis_instruments::error::Error;
use hairis_instruments::files::{whole, writable};
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::program::{print, say};
use hairis_instruments::progress::{share_bar, show_share};
use hairis_instruments::shard::Shard;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Shortest and longest time between two previews, which otherwise is half of the time since the start.
const PREVIEW: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(10)];
/// Least time between previews, as a multiple of the time that the last preview took.
const PREVIEW_SHARE: u32 = 10;

/// Renders a scene, once for each hair that the flags select.
///
/// # Errors
///
/// Returns an error if a flag is out of its range, or a file cannot be read or written. Both are checked before anything is rendered.
pub(super) fn run(flags: &Render) -> Result<(), Error> {
    flags.check()?;
    let crop = flags.part()?;
    let defaults = flags.place.scene.defaults();
    let settings = Settings {
        integrator: flags.integrator.unwrap_or(defaults.integrator),
        sequence: flags.xi,
        seed: flags.seed,
        mis: flags.mis,
        depth: flags.depth,
        multiple: defaults.multiple && !flags.no_multiple,
        rays: flags.aa,
        profile: flags.profile,
        ..Settings::default()
    };
    let out = flags
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from(format!("out/render/{}.exr", flags.place.scene.word())));
    let hairs = hairs(flags, &settings)?;
    let outs = outs(&out, &hairs)?;
    let ground = Ground::read(&flags.place, crop.len())?;
    if let Some(path) = &flags.export {
        whole(path, |out| write_hair(path, &ground.strands, out))?;
    }
    let describe = |hair: &Named| describe(flags, &hair.line, &settings, crop, &ground);
    let runs: Vec<String> = hairs.iter().map(describe).collect();
    let mut scene = ground.scene(&flags.place, hairs[0].hairs[0], flags.size.0)?;
    outs.iter().try_for_each(|out| check_out(out))?;
    let interrupt = Interrupt::watch();
    for ((hair, out), run) in hairs.iter().zip(&outs).zip(runs) {
        scene.hair = hair.hairs[0];
        let heads = hair.hairs[1..].iter().copied();
        scene.others = portrait::firsts(strands(&flags.place)).zip(heads).collect();
        picture(flags, &scene, &settings, crop, run, out, &interrupt)?;
    }
    Ok(())
}

/// Renders a picture of a scene and writes it. `run` is the line that describes everything the sums depend on.
fn picture(
    flags: &Render,
    scene: &Scene,
    settings: &Settings,
    crop: Crop,
    run: String,
    out: &Path,
    interrupt: &Interrupt,
) -> Result<(), Error> {
    let shard = flags.shard.unwrap_or(Shard::WHOLE);
    let part_path = match flags.shard {
        Some(shard) => out.with_extension(format!("{}-of-{}.part", shard.index(), shard.of())),
        None => part::path(out),
    };
    let rays = match settings.integrator {
        Integrator::Gather => settings.rays,
        Integrator::Direct | Integrator::Path | Integrator::Dual => 1,
    };
    writable(&part_path)?;
    let fresh = Part {
        run,
        film: Film::with_tiles(crop, film::side(rays)).shard(shard),
        finished: false,
    };
    let samples = flags.spp.unwrap_or(flags.place.scene.defaults().samples);
    let most = flags.time.is_none().then_some(samples);
    let (mut part, log) = Part::resume(&part_path, fresh, most)?;
    let mut saver = Saver::new(log, interrupt);
    // Save first, so that the file exists and belongs to this run from the beginning.
    saver.save(&part)?;
    saver.work(&mut part, |film, stop| {
        layers::look(scene, film, stop);
        film.tiles.iter().all(|tile| !tile.first.is_empty())
    })?;
    passes(flags, scene, settings, samples, &mut part, &mut saver)?;
    if let Some(lost) = transport::cut_off(scene, settings, &part.film).filter(CutOff::is_notable) {
        say(&lost.to_string());
    }
    let profile = if flags.profile {
        format!("time: {}\n", part.film.profile)
    } else {
        String::new()
    };
    let mut log = saver.end();
    if flags.shard.is_some() {
        log.write(&part)?;
        for preview in ["exr", "png"] {
            // Ignore errors: a short run has left none.
            let _ = fs::remove_file(part_path.with_extension(preview));
        }
        return print(format!(
            "{profile}wrote {}: join the parts by `hairis-render merge`\n",
            part_path.display()
        ));
    }
    let wrote = finish(
        &part.film,
        &Beside::film(&part.film, &part.run),
        out,
        flags.exposure,
    )?;
    // A run with a larger --spp continues this part. It is marked before anything is printed, because printing may fail.
    part.finished = true;
    log.write(&part)?;
    print(format!("{profile}{wrote}"))
}

/// Writes a finished picture, and returns the line that reports it.
pub(super) fn finish(
    film: &Film,
    beside: &Beside,
    out: &Path,
    exposure: Option<f64>,
) -> Result<String, Error> {
    let picture = film.picture();
    picture::write(
        &picture,
        beside,
        out,
        exposure.unwrap_or_else(|| picture::exposure(&picture)),
    )?;
    let [r, g, b] = picture.mean();
    let (samples, seconds) = (film.samples(), film.seconds());
    Ok(format!(
        "wrote {}: {samples} samples, mean {r:.5} {g:.5} {b:.5}, {seconds:.1} s of CPU time\n",
        out.display()
    ))
}

/// Hair of a picture, with its name and its description.
struct Named {
    /// Material of the hair of each head, or of all hair.
    hairs: Vec<Hair>,
    /// Name of the hair, which is part of the name of the file if there are several pictures.
    name: String,
    /// Description of everything that the scattering of the hair depends on.
    line: String,
}

/// Returns the hair that the flags select, at least one; each has a picture of its own.
fn hairs(flags: &Render, settings: &Settings) -> Result<Vec<Named>, Error> {
    let is_chosen =
        flags.looks.hair.is_some() || flags.looks.model.is_some() || flags.looks.sampler.is_some();
    let is_made = !flags.looks.material.is_empty() || !flags.looks.set.is_empty();
    if flags.place.scene == Name::FurnaceIso && !is_chosen && !is_made {
        return Ok(vec![Named {
            hairs: vec![Hair::Isotropic],
            name: "isotropic".to_owned(),
            line: "hair=isotropic".to_owned(),
        }]);
    }
    let named = |choice: Choice| {
        let energy = flags.energy.unwrap_or(Energy::Raw);
        let hair = choice.hair(energy)?;
        let [mean, worst] = hair.mean_and_worst_albedo();
        let whose = if flags.looks.material.is_empty() && flags.place.scene.portraits().is_empty() {
            "the hair"
        } else {
            &choice.name
        };
        say(&format!(
            "albedo of {whose}: mean {mean:.3}, largest {worst:.3}"
        ));
        // Reject hair whose paths do not converge, unless --energy is given and --depth ends the paths.
        let remedy = match flags.energy {
            None => "use --energy per-wo",
            Some(_) => "use --energy per-wo, or end paths by --depth",
        };
        if flags.energy.is_none() || flags.depth.is_none() {
            check_paths(&hair, settings, &choice.name, remedy)?;
        }
        let line = format!("{} energy={energy:?}", choice.describe());
        Ok(Named {
            hairs: vec![hair],
            name: choice.name,
            line,
        })
    };
    let all = choices(&flags.looks, &flags.place)?
        .into_iter()
        .map(named)
        .collect::<Result<Vec<_>, Error>>()?;
    if !has_own_materials(&flags.looks, &flags.place) {
        return Ok(all);
    }
    // One picture of all heads.
    let line: Vec<&str> = all.iter().map(|hair| hair.line.as_str()).collect();
    Ok(vec![Named {
        line: line.join(" "),
        name: flags.place.scene.word().to_owned(),
        hairs: all.into_iter().flat_map(|hair| hair.hairs).collect(),
    }])
}

/// Returns the file of each picture. If there are several, each name contains the name of the hair.
fn outs(out: &Path, hairs: &[Named]) -> Result<Vec<PathBuf>, Error> {
    // Reject here what `check_out` would reject, before hair is grown, so that the message has the name that was given.
    let Some(stem) = out.file_stem().filter(|_| has_ending(out)) else {
        return Err(wrong_ending(out));
    };
    if let [_] = hairs {
        return Ok(vec![out.to_owned()]);
    }
    let named = |hair: &Named| {
        let mut name = stem.to_owned();
        name.push(format!("-{}.exr", hair.name));
        out.with_file_name(name)
    };
    Ok(hairs.iter().map(named).collect())
}

/// Makes the folder of a file, and checks that files can be written into it.
pub(super) fn check_out(path: &Path) -> Result<(), Error> {
    if !has_ending(path) {
        return Err(wrong_ending(path));
    }
    if let Some(folder) = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
    {
        fs::create_dir_all(folder).map_err(Error::output(path))?;
    }
    writable(path)
}

fn has_ending(path: &Path) -> bool {
    path.extension().is_some_and(|end| end == "exr")
}

fn wrong_ending(path: &Path) -> Error {
    let path = path.display();
    Error::Usage(format!("the picture must end in .exr, got {path}"))
}

/// Renders pass by pass and saves the sums; from time to time, also writes the picture so far with
/// its preview.
fn passes(
    flags: &Render,
    scene: &Scene,
    settings: &Settings,
    samples: u32,
    part: &mut Part,
    saver: &mut Saver<'_>,
) -> Result<(), Error> {
    let bar = share_bar("{msg:>12} {wide_bar} {percent:>3}% {elapsed} (left {eta})");
    let show = |share: f64| show_share(&bar, share);
    let pass = settings.integrator.pass();
    let start = Instant::now();
    let (mut written, mut took) = (start, Duration::ZERO);
    let mut done = part.film.samples();
    let is_over = |done: u32| {
        flags.time.map_or(done >= samples, |time| {
            start.elapsed().as_secs_f64() >= time
        })
    };
    while !is_over(done) {
        let next = if flags.time.is_some() {
            done + pass
        } else {
            (done + pass).min(samples)
        };
        let share = |part: f64| match flags.time {
            Some(time) => (start.elapsed().as_secs_f64() / time).min(1.0),
            None => (f64::from(done) + part * f64::from(next - done)) / f64::from(samples),
        };
        bar.set_message(format!("{done} samples"));
        saver.render(part, scene, settings, next, &|part| show(share(part)))?;
        done = next;
        let [least, most] = PREVIEW;
        let wait = (start.elapsed() / 2)
            .clamp(least, most)
            .max(took * PREVIEW_SHARE);
        if written.elapsed() >= wait && !is_over(done) {
            let begin = Instant::now();
            saver.save(part)?;
            let picture = part.film.picture();
            let exposure = flags
                .exposure
                .unwrap_or_else(|| picture::exposure(&picture));
            let growing = saver.path().with_extension("exr");
            picture::write(
                &picture,
                &Beside::film(&part.film, &part.run),
                &growing,
                exposure,
            )?;
            (written, took) = (Instant::now(), begin.elapsed());
        }
    }
    bar.finish_and_clear();
    Ok(())
}
