//! Prints every model, and dual scattering, as functions over arrays, which the modules for frameworks run.

use hairis_shaders::{Call, Language, Program, Target, print};
use hairis_variants::ModelId;
use std::path::Path;
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let folder = env::var_os("OUT_DIR").expect("cargo sets it");
    for id in ModelId::ALL {
        let mut program = Program::of_id(*id, Target::GpuNative);
        let calls = [Call::Material, Call::EvalHit, Call::SampleHit];
        program.keep(calls.map(|call| program.function(call).clone()).to_vec());
        let file = Path::new(&folder).join(format!("{id:?}.py"));
        fs::write(file, print(&program, Language::Python)).expect("cargo makes the folder");
    }
    let dual = Program::dual_scattering(Target::GpuNative);
    let file = Path::new(&folder).join("dual_scattering.py");
    fs::write(file, print(&dual, Language::Python)).expect("cargo makes the folder");
}
