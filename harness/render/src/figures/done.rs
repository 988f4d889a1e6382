//! Measurements of a run that are finished.

use super::dual::Pair;
use super::measure::Measured;
use super::models::Preset;

/// Measurements that are finished.
#[derive(Debug, Default)]
pub struct Done {
    /// Samplers by scene.
    pub scenes: Vec<Measured>,
    /// Models by preset.
    pub presets: Vec<Preset>,
    /// Dual scattering by preset and model.
    pub dual: Vec<Pair>,
}
