//! Models that have entry points, and the subset that is compiled.

use hairis_variants::ModelId;
use std::sync::LazyLock;

/// Models that take part, with the names of their entry points: `gaussian`, and `gaussian-matched` for another sampler.
pub static MODELS: LazyLock<Vec<(String, ModelId)>> = LazyLock::new(|| {
    let name = |id: ModelId| match id.choice() {
        Some((_, word)) if !id.is_default() => (format!("{}-{word}", id.name()), id),
        _ => (id.name().to_owned(), id),
    };
    ModelId::ALL.iter().copied().map(name).collect()
});

/// Returns true if the entry points of a model are compiled, which is decided at compile time.
#[must_use]
pub const fn is_compiled(id: ModelId) -> bool {
    // These cover both bells, both samplers of the published model, and a model that is written lobe by lobe.
    !cfg!(feature = "three-models")
        || matches!(
            id,
            ModelId::Gaussian | ModelId::CauchyMatched | ModelId::Chiang
        )
}
