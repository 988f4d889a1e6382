//! `hairis fit`: finds the parameters of a model whose look is nearest to that of another, and plots the residuals.

use crate::args::{Fit, FitNorm, FitOver};
use crate::fit::page::Shown;
use crate::fit::{self, FitConfig, Look, Norm, Points, residuals};
use crate::study::Grid;
use core::f64::consts::FRAC_PI_2;
use hairis_harness::materials::{self, NamedMaterial, find_model};
use hairis_instruments::error::Error;
use hairis_instruments::files::{whole, writable, write_json};
use hairis_instruments::machine;
use hairis_instruments::program::print;
use hairis_instruments::progress::{Progress, share_bar, show_share};
use hairis_instruments::report::Report;
use hairis_instruments::terminal::{conclude, width};
use hairis_materials::material::{in_place_of, values_json};
use hairis_variants::{Field, ModelId, Values};
use serde_json::json;
use std::fs;

/// Fits the model, prints the fitted material on standard output, and writes the report.
///
/// # Errors
///
/// Returns [`Error::Usage`] if there is no such model, preset, material or field, and [`Error::Output`] before any work is done, if the
/// folder cannot be written.
pub fn run(flags: &Fit) -> Result<(), Error> {
    if let Some(over) = flags.over {
        return run_over(flags, over);
    }
    let from = source(flags)?;
    let to = find_model("--to", &flags.to)?;
    let config = config(flags, to)?;
    let look = Look {
        model: from.model,
        values: from.values,
    };
    refuse_replaced(&config, &fit::first_start(&look, to))?;
    fs::create_dir_all(&flags.out).map_err(Error::output(&flags.out))?;
    let [found_path, json_path, page] =
        ["fitted.json", "fit.json", "report.html"].map(|name| flags.out.join(name));
    for path in [&found_path, &json_path] {
        writable(path)?;
    }
    Report::writable(&flags.out)?;

    if Points::new(&look, to, &config, 0)?.is_black() {
        return Err(Error::Usage(format!(
            "{} must reflect light towards the views, got S of 0 in all directions; change its intensities or --theta-o-deg",
            from.name
        )));
    }
    let bar = share_bar("starts {wide_bar} {percent:>3}% {elapsed} (left {eta})");
    let show = |done: usize, of: usize| show_share(&bar, done as f64 / of as f64);
    let found = fit::fit(&look, to, &config, &show)?;
    bar.finish_and_clear();
    let start = Look {
        model: found.found.model,
        values: fit::first_start(&look, to),
    };
    let [before, after] = [start, found.found].map(|other| residuals(&look, &other, &found.points));
    let (before, after) = (before?, after?);

    let fitted = json!({
        "model": to.name(),
        "params": values_json(&found.found.values),
    });
    write_json(&found_path, &fitted)?;
    let end = |end: &fit::End| {
        json!({
            "start": values_json(&end.start),
            "end": values_json(&end.values),
            "distance_of_start": end.distance_of_start,
            "distance": end.distance,
            "iterations": end.iterations,
        })
    };
    let ends: Vec<_> = found.ends.iter().map(end).collect();
    let rules = fit::RULES.iter().zip(&found.distances_of_rules);
    let rules: serde_json::Map<_, _> = rules
        .map(|(name, distance)| ((*name).to_owned(), json!(distance)))
        .collect();
    let all = json!({
        "from": { "name": from.name, "model": from.model.name(), "params": values_json(&from.values) },
        "to": fitted,
        "norm": config.norm,
        "seed": config.seed,
        "distance_of_start": found.distance_of_start,
        "distance": found.distance,
        "distance_error": found.error,
        "distances_of_rules": rules,
        "views": after,
        "views_of_start": before,
        "starts": ends,
        "machine": machine!(),
    });
    write_json(&json_path, &all)?;
    let shown = Shown {
        from: &from,
        start: &start,
        fit: &found,
        norm: config.norm,
        before: &before,
        after: &after,
    };
    let report = shown.report()?;
    report.write(&flags.out, "fit")?;
    let files = format!(
        "{}; the material is in {}",
        page.display(),
        found_path.display()
    );
    eprint!("{}", report.headline(width(), &files));
    print(format!("{fitted}\n"))
}

/// Fits to many looks, writes their rows, and prints the verdicts, or their table.
fn run_over(flags: &Fit, over: FitOver) -> Result<(), Error> {
    let from = find_model("--from", flags.from.as_deref().unwrap_or_default())?;
    let to = find_model("--to", &flags.to)?;
    let mut config = config(flags, to)?;
    let grid = match over {
        FitOver::Presets => None,
        FitOver::Quick => Some(Grid::QUICK),
        FitOver::Full => Some(Grid::FULL),
    };
    let looks = if let Some(grid) = grid {
        if from.fields() != ModelId::Gaussian.fields() {
            return Err(Error::Usage(format!(
                "--from must be gaussian or cauchy, whose hair the grid has, got {:?}",
                from.name()
            )));
        }
        if flags.theta_o_deg.is_empty() {
            let FitConfig { views, weights, .. } = FitConfig::of_grid(&grid);
            (config.views, config.weights) = (views, weights);
        }
        fit::hair_of(grid, from)?
    } else {
        let presets = from.presets();
        let look = |(name, values): (&str, Values)| {
            (
                name.to_owned(),
                Look {
                    model: from,
                    values,
                },
            )
        };
        presets.map(look).collect()
    };
    for (_, look) in &looks {
        refuse_replaced(&config, &fit::first_start(look, to))?;
    }
    fs::create_dir_all(&flags.out).map_err(Error::output(&flags.out))?;
    let path = flags.out.join("fits.csv");
    writable(&path)?;
    let bar = share_bar("fits {wide_bar} {percent:>3}% {elapsed} (left {eta})");
    let show = |done: usize, of: usize| show_share(&bar, done as f64 / of as f64);
    let refits = fit::refits(&looks, to, &config, &Progress::new(looks.len(), &show))?;
    bar.finish_and_clear();
    whole(&path, |out| fit::columns(&refits).write_csv(out))?;
    let title = format!(
        "{} fitted to {} looks of {}",
        to.name(),
        looks.len(),
        from.name()
    );
    let table = fit::table(&title, &refits);
    let report = Report {
        title,
        subtitle: format!("hairis fit, norm {}", config.norm.name()),
        verdicts: fit::verdicts(&refits).into(),
        ..Report::default()
    };
    let tables = flags.tables.then_some(core::slice::from_ref(&table));
    conclude(&report, &path.display().to_string(), tables)
}

/// Returns the material that is fitted to.
fn source(flags: &Fit) -> Result<NamedMaterial, Error> {
    if let Some(path) = &flags.material {
        let mut all = materials::of_flags(&[], core::slice::from_ref(path))?;
        return if all.len() == 1 {
            Ok(all.remove(0))
        } else {
            Err(Error::Usage(format!(
                "--material must have one material, got {} in {}",
                all.len(),
                path.display()
            )))
        };
    }
    let name = flags.from.as_deref().unwrap_or_default();
    let model = find_model("--from", name)?;
    let presets: Vec<_> = model.presets().collect();
    let preset = flags.preset.as_deref().unwrap_or(presets[0].0);
    let Some((preset, values)) = presets.iter().find(|(one, _)| *one == preset) else {
        let names: Vec<&str> = presets.iter().map(|(name, _)| *name).collect();
        return Err(Error::Usage(format!(
            "--preset must be one of {}, got {preset:?}",
            names.join(", ")
        )));
    };
    Ok(NamedMaterial {
        name: format!("{name}-{preset}"),
        model,
        values: *values,
    })
}

/// Rejects fixed fields for which the start has another field in their place.
fn refuse_replaced(config: &FitConfig, start: &Values) -> Result<(), Error> {
    let is_fixed = |field: &&Field| config.fixed.iter().any(|name| name == field.name);
    for field in start.fields().iter().filter(is_fixed) {
        if !start.has(field.name)
            && let Some(other) = in_place_of(field, start)
        {
            return Err(Error::Usage(format!(
                "--fix must be a field that the start has, got {:?}; fix {}, which the start has in its place",
                field.name, other.name
            )));
        }
    }
    Ok(())
}

/// Converts the flags to the settings of a fit, and checks them.
fn config(flags: &Fit, to: ModelId) -> Result<FitConfig, Error> {
    let names: Vec<&str> = to.fields().iter().map(|field| field.name).collect();
    if let Some(name) = flags
        .fix
        .iter()
        .find(|name| !names.contains(&name.as_str()))
    {
        return Err(Error::Usage(format!(
            "--fix must be one of {}, got {name:?}",
            names.join(", ")
        )));
    }
    let mut config = FitConfig {
        norm: match flags.norm {
            FitNorm::L1 => Norm::L1,
            FitNorm::L2 => Norm::L2,
            FitNorm::Blurred => Norm::Blurred,
        },
        fixed: flags.fix.clone(),
        starts: usize::from(flags.starts),
        seed: flags.seed,
        ..FitConfig::default()
    };
    if !flags.theta_o_deg.is_empty() {
        config.views = flags
            .theta_o_deg
            .iter()
            .map(|angle| angle.to_radians())
            .collect();
        config.weights = vec![1.0; config.views.len()];
    }
    if !flags.weight.is_empty() {
        if flags.weight.len() != config.views.len() {
            return Err(Error::Usage(format!(
                "--weight must be given for each of {} views, got {}",
                config.views.len(),
                flags.weight.len()
            )));
        }
        config.weights.clone_from(&flags.weight);
    }
    if let Some(angle) = config
        .views
        .iter()
        .find(|angle| angle.is_nan() || angle.abs() > FRAC_PI_2 - 1e-3)
    {
        return Err(Error::Usage(format!(
            "--theta-o-deg must be an inclination within -89.9 and 89.9 degrees, got {}",
            angle.to_degrees()
        )));
    }
    if let Some(weight) = config
        .weights
        .iter()
        .find(|weight| !(**weight > 0.0 && weight.is_finite()))
    {
        return Err(Error::Usage(format!(
            "--weight must be finite and above 0, got {weight}"
        )));
    }
    Ok(config)
}
