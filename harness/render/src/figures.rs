//! Subcommand `hairis-render figures`, which compares samplers side by side, as pictures and as numbers, on one page.

pub mod csv;
pub mod done;
pub mod dual;
pub mod map;
pub mod measure;
pub mod models;
pub mod names;
pub mod page;
pub mod panel;
mod rates;
pub mod store;
pub mod verdict;

use crate::args::Figures;
use crate::environment::environment;
use crate::hair::Choice;
use crate::scenes::Name;
use done::Done;
use dual::Pair;
use hairis_instruments::error::Error;
use hairis_instruments::interrupt::Interrupt;
use hairis_instruments::program::{print, say};
use hairis_instruments::progress::bar;
use hairis_instruments::terminal::conclude;
use hairis_materials::files;
use hairis_variants::ModelId;
use measure::{Measured, Plan};
use models::Preset;
use std::fs;
use std::path::Path;
use store::Store;

/// Scenes that are compared if the flags name none. Maps of the caller take the place of the light of [`Name::Env`].
pub const SCENES: [Name; 7] = [
    Name::Area,
    Name::AreaSoft,
    Name::AreaHead,
    Name::Env,
    Name::BoxSingle,
    Name::Box,
    Name::Head,
];

/// Compares samplers on every scene, and writes `report.html` with its figures as `figures.csv`,
/// its settings as `figures.json` and an EXR file of each picture beside it. A run that was stopped
/// continues from what it had saved.
///
/// # Errors
///
/// Returns an error if paths do not converge in a scene, a map cannot be read or a file cannot be written. All of these are checked
/// before anything is rendered.
pub(crate) fn run(flags: &Figures) -> Result<(), Error> {
    let plan = if flags.quick { Plan::QUICK } else { Plan::FULL };
    let plan = Plan {
        integrator: flags.integrator,
        sequence: flags.xi,
        rectangle_sampling: flags.rectangles,
        ..plan
    };
    let mut chosen = if flags.scene.is_empty() {
        SCENES.to_vec()
    } else {
        flags.scene.clone()
    };
    let mut known = Vec::new();
    // Drop repeated names, because a scene that is named twice is rendered once.
    chosen.retain(|name| {
        let is_new = !known.contains(name);
        known.push(*name);
        is_new
    });
    let materials = files::read(&flags.material)
        .map_err(|problem| Error::Usage(format!("--material {problem}")))?;
    let hairs = |name: Name| -> Result<Vec<Choice>, Error> {
        let of_file = |(name, spec): &(String, _)| Choice::of_material(name, spec, None);
        let hairs = if materials.is_empty() {
            vec![measure::preset(name)?]
        } else {
            materials.iter().map(of_file).collect::<Result<_, _>>()?
        };
        hairs
            .into_iter()
            .map(|hair| set(hair, &flags.set))
            .collect()
    };
    let names = names::of_files(&flags.env)?;
    let maps = names
        .iter()
        .zip(&flags.env)
        .map(|(name, path)| Ok((name.clone(), environment(path, flags.layer.as_deref())?)))
        .collect::<Result<Vec<_>, Error>>()?;
    let mut scenes = Vec::new();
    for name in chosen {
        for hair in hairs(name)? {
            plan.check(name, &hair)?;
            if name == Name::Env && !maps.is_empty() {
                let with_map = |map: &(_, _)| (name, Some(map.clone()), hair.clone());
                scenes.extend(maps.iter().map(with_map));
            } else {
                scenes.push((name, None, hair));
            }
        }
    }
    prepare(&flags.out)?;
    let store = Store::new(&flags.out, Interrupt::watch())?;
    // Models, and dual scattering with paths, are compared where the scenes are not chosen one by one.
    type Names = [&'static str];
    let (presets, models): (&Names, &Names) =
        match (flags.scene.is_empty() || flags.models, flags.quick) {
            (false, _) => (&[], &[]),
            (true, true) => (&models::PRESETS[..1], &dual::MODELS[..1]),
            (true, false) => (&models::PRESETS, &dual::MODELS),
        };
    let pairs = dual::COLOURS
        .into_iter()
        .flat_map(|preset| models.iter().map(move |model| [*model, preset]));
    // Each shard owns every n-th of the scenes and models.
    let owns = |place: usize| flags.shard.is_none_or(|shard| shard.owns(place));
    let count = scenes.len();
    let scenes: Vec<_> = (0..)
        .zip(scenes)
        .filter(|(place, _)| owns(*place))
        .map(|(_, scene)| scene)
        .collect();
    let after = count + presets.len();
    let presets: Vec<_> = (count..)
        .zip(presets)
        .filter(|(place, _)| owns(*place))
        .map(|(_, name)| *name)
        .collect();
    let pairs: Vec<_> = (after..)
        .zip(pairs)
        .filter(|(place, _)| owns(*place))
        .map(|(_, pair)| pair)
        .collect();
    let steps = plan.steps(scenes.len())
        + presets.len() * ModelId::defaults_of_names().count()
        + pairs.len();
    let bar = bar(
        steps as u64,
        "{msg:>30} {wide_bar} {percent:>3}% {elapsed} (left {eta})",
    );
    let step = |what: &str| {
        bar.set_message(what.to_owned());
        bar.inc(1);
    };
    let titles: Vec<String> = scenes
        .iter()
        .map(|(name, map, hair)| {
            let map = map.as_ref().map(|(name, _)| name.as_str());
            measure::title(*name, map, &hair.name)
        })
        .collect();
    let settings = csv::settings(&plan, flags, &names);
    let (mut done, mut written) = (Done::default(), None);
    // Write after every scene, so that a run that is stopped leaves a page.
    let mut write = |done: &Done| {
        if flags.shard.is_none() {
            written = Some(page::write(done, &plan, flags, &flags.out)?);
            csv::write(done, &settings, &flags.out)?;
        }
        Ok::<_, Error>(())
    };
    for ((name, map, hair), stem) in scenes.into_iter().zip(names::of_pictures(&titles)) {
        let measured = Measured::render(name, map, &hair, &plan, flags.seed, &store, &step)?;
        if flags.shard.is_none() {
            measured.write_pictures(&flags.out, &stem)?;
        }
        done.scenes.push(measured);
        write(&done)?;
    }
    for name in presets {
        done.presets
            .push(Preset::render(name, &plan, flags.seed, &store, &step)?);
        write(&done)?;
    }
    for [model, preset] in pairs {
        step(&format!("{preset}: {model}, dual scattering"));
        let pair = Pair::render(dual::SCENE, [model, preset], &plan, flags.seed, &store)?;
        done.dual.push(pair);
        write(&done)?;
    }
    bar.finish_and_clear();
    if let Some(shard) = flags.shard {
        return print(format!(
            "shard {shard}: measurements are in {}\n",
            store.folder().display()
        ));
    }
    if store.resumed() > 0 {
        say(&format!(
            "{} measurements are of a run that was stopped",
            store.resumed()
        ));
    }
    store.remove();
    let Some((report, table)) = written else {
        return Ok(());
    };
    let page = flags.out.join("report.html");
    let tables = flags.tables.then_some(core::slice::from_ref(&table));
    conclude(&report, &page.display().to_string(), tables)
}

/// Sets values of the hair, and adds the assignments to its name.
fn set(hair: Choice, assignments: &[String]) -> Result<Choice, Error> {
    if assignments.is_empty() {
        return Ok(hair);
    }
    let name = format!("{} with {}", hair.name, assignments.join(" "));
    Ok(Choice {
        name,
        ..hair.set(assignments)?
    })
}

/// Makes the folder, and checks that files can be written into it.
fn prepare(out: &Path) -> Result<(), Error> {
    let refuse = |source| Error::Output {
        path: out.to_owned(),
        source,
    };
    fs::create_dir_all(out).map_err(refuse)?;
    let probe = out.join("report.html.new");
    fs::write(&probe, "")
        .and_then(|()| fs::remove_file(&probe))
        .map_err(refuse)
}
