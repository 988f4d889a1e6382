//! `hairis-render render`.

mod description;

use crate::args::Render;
use crate::film::{self, Crop, Film};
use crate::formats::{self, Follow, Import, Imported, import, import_head, write_hair};
use crate::geometry::Strands;
use crate::hair::{Choice, Energy, check_paths, default_sampler};
use crate::layers::{self, Beside};
use crate::material::Hair;
use crate::memory;
use crate::part::{self, Part};
use crate::picture;
use crate::saver::Saver;
use crate::scalp;
use crate::scene::{Head, Scene};
use crate::scenes::{self, Name, Parts};
use crate::transport::{self, CutOff, Integrator, Settings};
use core::time::Duration;
use description::describe;
pub(crate) use description::picture_size;
use hairis_instruments::error::Error;
use hairis_instruments::files::{whole, writable};
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::light::Environment;
use hairis_instruments::program::say;
use hairis_instruments::progress::{share_bar, show_share};
use hairis_instruments::shard::Shard;
use hairis_materials::files;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Bounds of the time between two previews, which is half of the time since the start.
const PREVIEW: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(10)];
/// Least time between previews, in times of the last preview.
const PREVIEW_SHARE: u32 = 10;

/// The model of presets where none is asked for.
const MODEL: &str = "gaussian";

/// Renders a scene, with each hair that is asked for.
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
        profile: flags.profile,
        ..Settings::default()
    };
    let out = flags
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from(format!("out/render/{}.exr", flags.scene.word())));
    let hairs = hairs(flags, &settings)?;
    let outs = outs(&out, &hairs)?;
    let read = |path| environment(path, flags.layer.as_deref());
    let env = flags.env.as_deref().map(read).transpose()?;
    let pixels = crop.len() as u64;
    let (strands, head) = match &flags.import {
        Some(path) => {
            let Imported { strands, scale, .. } = read_hair(flags, path)?;
            let head = read_head(flags, &strands, scale)?;
            let triangles = head.as_ref().map_or(0, Head::triangles);
            memory::check((strands.segments() + triangles) as u64, pixels)?;
            (strands, head)
        }
        None => {
            memory::check(
                scenes::estimate_segments(flags.scene, flags.strands)?,
                pixels,
            )?;
            (scenes::grow(flags.scene, flags.strands)?, None)
        }
    };
    if let Some(path) = &flags.export {
        whole(path, |out| write_hair(path, &strands, out))?;
    }
    let describe = |hair: &Named| describe(flags, &hair.line, &settings, crop, env.as_ref());
    let runs = hairs.iter().map(describe).collect::<Result<Vec<_>, _>>()?;
    let parts = Parts {
        strands,
        imported: flags.import.is_some(),
        head,
        hair: hairs[0].hair,
        env,
        size: flags.size.0,
        turn: flags.turn,
    };
    let backdrop = flags.backdrop.map(glam::Vec3::splat);
    let mut scene = Scene {
        backdrop,
        rectangle_sampling: flags.rectangles,
        ..scenes::build(flags.scene, parts)?
    };
    outs.iter().try_for_each(|out| check_out(out))?;
    let interrupt = Interrupt::watch();
    for ((hair, out), run) in hairs.iter().zip(&outs).zip(runs) {
        scene.hair = hair.hair;
        picture(flags, &scene, &settings, crop, run, out, &interrupt)?;
    }
    Ok(())
}

/// Renders a picture of a scene, which `run` describes, and writes it.
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
        Integrator::Direct | Integrator::Path => 1,
    };
    writable(&part_path)?;
    let fresh = Part {
        run,
        film: Film::with_tiles(crop, film::side(rays)).shard(shard),
        finished: false,
    };
    let samples = flags.spp.unwrap_or(flags.scene.defaults().samples);
    let most = flags.time.is_none().then_some(samples);
    let (mut part, log) = Part::resume(&part_path, fresh, most)?;
    let mut saver = Saver::new(log, interrupt);
    // The file is there, and this run's, from the beginning.
    saver.save(&part)?;
    saver.work(&mut part, |film, stop| {
        layers::look(scene, film, stop);
        film.tiles.iter().all(|tile| !tile.first.is_empty())
    })?;
    passes(flags, scene, settings, samples, &mut part, &mut saver)?;
    if let Some(lost) = transport::cut_off(scene, settings, &part.film).filter(CutOff::is_notable) {
        say(&lost.to_string());
    }
    if flags.profile {
        writeln!(io::stdout(), "time: {}", part.film.profile).map_err(Error::Write)?;
    }
    let mut log = saver.end();
    if flags.shard.is_some() {
        log.write(&part)?;
        for preview in ["exr", "png"] {
            // Ignore errors: a short run has left none.
            let _ = fs::remove_file(part_path.with_extension(preview));
        }
        let line = format!(
            "wrote {}: join the parts by `hairis-render merge`\n",
            part_path.display()
        );
        return io::stdout()
            .write_all(line.as_bytes())
            .map_err(Error::Write);
    }
    finish(
        &part.film,
        &Beside::film(&part.film, &part.run),
        out,
        flags.exposure,
    )?;
    // A larger --spp goes on from it.
    part.finished = true;
    log.write(&part)
}

/// Writes a picture that is whole, and says so.
pub(super) fn finish(
    film: &Film,
    beside: &Beside,
    out: &Path,
    exposure: Option<f64>,
) -> Result<(), Error> {
    let picture = film.picture();
    picture::write(
        &picture,
        beside,
        out,
        exposure.unwrap_or_else(|| picture::exposure(&picture)),
    )?;
    let [r, g, b] = picture.mean();
    let (samples, seconds) = (film.samples(), film.seconds());
    let line = format!(
        "wrote {}: {samples} samples, mean {r:.5} {g:.5} {b:.5}, {seconds:.1} s of CPU time\n",
        out.display()
    );
    io::stdout()
        .write_all(line.as_bytes())
        .map_err(Error::Write)
}

/// Hair of a picture.
struct Named {
    hair: Hair,
    /// Its name: of several pictures each file has that of its hair.
    name: String,
    /// Everything that its scattering depends on.
    line: String,
}

/// The hair that the flags ask for: a picture each, at least one.
fn hairs(flags: &Render, settings: &Settings) -> Result<Vec<Named>, Error> {
    let is_chosen = flags.hair.is_some() || flags.model.is_some() || flags.sampler.is_some();
    let is_made = !flags.material.is_empty() || !flags.set.is_empty();
    if flags.scene == Name::FurnaceIso && !is_chosen && !is_made {
        return Ok(vec![Named {
            hair: Hair::Isotropic,
            name: "isotropic".to_owned(),
            line: "hair=isotropic".to_owned(),
        }]);
    }
    let mut choices = Vec::new();
    if flags.material.is_empty() {
        let preset = flags.scene.defaults().preset;
        let preset = flags.hair.as_deref().unwrap_or(preset);
        let model = flags.model.as_deref().unwrap_or(MODEL);
        let sampler = flags.sampler.as_deref();
        let sampler = sampler.unwrap_or_else(|| default_sampler(model));
        choices.push(Choice::find(model, sampler, preset)?);
    }
    for (name, material) in files::read(&flags.material)
        .map_err(|problem| Error::Usage(format!("--material {problem}")))?
    {
        let sampler = flags.sampler.as_deref();
        choices.push(Choice::of_material(&name, &material, sampler)?);
    }
    let named = |choice: Choice| {
        let choice = choice.set(&flags.set)?;
        let energy = flags.energy.unwrap_or(Energy::Raw);
        let hair = choice.hair(energy)?;
        let [mean, worst] = hair.mean_and_worst_albedo();
        let whose = if flags.material.is_empty() {
            "the hair"
        } else {
            &choice.name
        };
        say(&format!(
            "albedo of {whose}: mean {mean:.3}, largest {worst:.3}"
        ));
        // Without --energy it is refused; with it, as long as its paths have an end.
        let remedy = match flags.energy {
            None => "use --energy per-wo",
            Some(_) => "use --energy per-wo, or end paths by --depth",
        };
        if flags.energy.is_none() || flags.depth.is_none() {
            check_paths(&hair, settings, &choice.name, remedy)?;
        }
        let line = format!("{} energy={energy:?}", choice.describe());
        Ok(Named {
            hair,
            name: choice.name,
            line,
        })
    };
    choices.into_iter().map(named).collect()
}

/// The files of the pictures: of several, each with the name of its hair.
fn outs(out: &Path, hairs: &[Named]) -> Result<Vec<PathBuf>, Error> {
    if let [_] = hairs {
        return Ok(vec![out.to_owned()]);
    }
    // What `check_out` refuses is refused by the name that was given.
    let Some(stem) = out.file_stem().filter(|_| has_ending(out)) else {
        return Err(wrong_ending(out));
    };
    let named = |hair: &Named| {
        let mut name = stem.to_owned();
        name.push(format!("-{}.exr", hair.name));
        out.with_file_name(name)
    };
    Ok(hairs.iter().map(named).collect())
}

/// Makes the folder of a file, and sees that files can be written there.
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

/// Reads an environment map, and remarks on what is odd about it.
pub(crate) fn environment(path: &Path, layer: Option<&str>) -> Result<Environment, Error> {
    let map = Environment::load_layer(path, layer).map_err(Error::Environment)?;
    for note in map.notes() {
        say(&note);
    }
    Ok(map)
}

/// Reads hair, and remarks on what is odd about it.
fn read_hair(flags: &Render, path: &Path) -> Result<Imported, Error> {
    let follow = Follow {
        strands: flags.follow,
        spread: flags.spread,
    };
    let options = Import {
        radius: flags.radius,
        scale: flags.scale,
        up: flags.up,
        curve: flags.curve,
        follow,
    };
    let imported = import(path, &options).map_err(|problem| Error::Usage(problem.to_string()))?;
    for remark in &imported.remarks {
        say(&format!("{}: {remark}", path.display()));
    }
    if imported.strands.strands() == 0 {
        return Err(Error::Usage(format!(
            "{}: there is no strand to render",
            path.display()
        )));
    }
    Ok(imported)
}

/// The head under hair from a file of this scale, if flags ask for one.
fn read_head(flags: &Render, strands: &Strands, scale: f32) -> Result<Option<Head>, Error> {
    if flags.scalp.is_some() {
        let fit = scalp::fit(strands).map_err(Error::Usage)?;
        say(&fit.to_string());
        return Ok(Some(Head::ellipsoid(fit.ellipsoid)));
    }
    let Some(path) = &flags.head else {
        return Ok(None);
    };
    let options = formats::Head {
        scale: flags.head_scale.unwrap_or(scale),
        up: flags.up,
    };
    let mesh = import_head(path, &options).map_err(|problem| Error::Usage(problem.to_string()))?;
    let [head, hair] = [mesh.bounds(), strands.bounds()].map(|bounds| bounds.size().length());
    if !(0.1..=10.0).contains(&(head / hair)) {
        say(&format!(
            "{}: warning: the head is {head} cm across and the hair {hair} cm: --head-scale sets centimetres per unit of the \
             head (here {})",
            path.display(),
            options.scale
        ));
    }
    Ok(Some(Head::mesh(mesh)))
}

/// Renders pass by pass, saving what there is; from time to time writes the picture so far, with
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
