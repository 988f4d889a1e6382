//! Environment maps in files.

use hairis_instruments::error::Error;
use hairis_instruments::light::Environment;
use hairis_instruments::program::say;
use std::path::Path;

/// Reads an environment map, and logs what is odd about it.
pub(crate) fn environment(path: &Path, layer: Option<&str>) -> Result<Environment, Error> {
    let map = Environment::load_layer(path, layer)?;
    for note in map.notes() {
        say(&note);
    }
    Ok(map)
}
