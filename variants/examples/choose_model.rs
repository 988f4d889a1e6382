//! Chooses a model by its name: `choose_model chiang` prints the fields of a model, and shades a hit with its presets.

use glam::Vec3;
use hairis_variants::ModelId;
use std::process::ExitCode;

fn main() -> ExitCode {
    let name = std::env::args().nth(1).unwrap_or("chiang".to_owned());
    let Some(id) = ModelId::find(&name, None) else {
        let names: Vec<_> = ModelId::defaults_of_names().map(ModelId::name).collect();
        eprintln!("model must be one of {}, got {name}", names.join(", "));
        return ExitCode::from(2);
    };
    for field in id.fields() {
        println!("{:<14} {}", field.name, field.doc);
    }
    let (wo, wi) = (Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.28, 0.96, 0.0));
    for (preset, values) in id.presets() {
        match id.material(&values) {
            Ok(material) => println!("{preset:<14} {:?}", material.prepare(wo).eval(wi)),
            Err(error) => eprintln!("{preset}: {error}"),
        }
    }
    ExitCode::SUCCESS
}
