//! The models that have entry points.

use hairis_variants::ModelId;
use std::sync::LazyLock;

/// The models that take part, by the names of their entry points: `gaussian`, and `gaussian-matched` for another sampler.
pub static MODELS: LazyLock<Vec<(String, ModelId)>> = LazyLock::new(|| {
    let name = |id: ModelId| match id.choice() {
        Some((_, word)) if !id.is_default() => (format!("{}-{word}", id.name()), id),
        _ => (id.name().to_owned(), id),
    };
    ModelId::ALL.iter().copied().map(name).collect()
});

/// Whether the entry points of a model are compiled, at compile time.
#[must_use]
pub const fn is_compiled(id: ModelId) -> bool {
    // Both bells, both samplers of the published model, and a model that is written by lobes.
    !cfg!(feature = "three-models")
        || matches!(
            id,
            ModelId::Gaussian | ModelId::CauchyMatched | ModelId::Chiang
        )
}
