//! List of the models in the library, and calls on their types.

use hairis::ParamError;
use hairis_variants::chiang::Likeness;
use hairis_variants::{Field, ModelId, Values};

/// Returns the model of an index, or `None` if the index is out of range.
pub(crate) fn at(index: u32) -> Option<ModelId> {
    let place = usize::try_from(index).ok()?;
    ModelId::ALL.get(place).copied()
}

/// Number of models that the library can have, which is the step between the indices of renderers.
const MODELS: u32 = 1 << 8;

/// Subject of parameters: a model, in its own fields or in those of another renderer.
#[derive(Clone, Copy)]
pub(crate) struct Subject {
    /// Model of the material.
    pub id: ModelId,
    like: Option<&'static Likeness>,
}

impl Subject {
    /// Returns the subject of an index: that of the model, and `MODELS` times the place of the renderer, counted from 1.
    pub(crate) fn at(index: u32) -> Option<Self> {
        let id = at(index % MODELS)?;
        let like = match usize::try_from(index / MODELS).ok()? {
            0 => None,
            place => Some(Likeness::ALL.get(place - 1)?),
        };
        Some(Self { id, like })
    }

    /// Returns the index of the model, for a renderer at this place of the list.
    pub(crate) const fn index_like(id: ModelId, place: u32) -> u32 {
        (place + 1) * MODELS + id as u32
    }

    /// Returns the fields of the parameters.
    #[must_use]
    pub(crate) fn fields(self) -> &'static [Field] {
        self.like
            .map_or_else(|| self.id.fields(), |like| like.fields)
    }

    /// Returns the model, and the values of its own fields.
    pub(crate) fn own(self, values: Values) -> Result<(ModelId, Values), ParamError> {
        self.like
            .map_or(Ok((self.id, values)), |like| like.entry(&values))
    }
}

/// Returns the tag of a model in handles, in which 0 stands for no model.
pub(crate) const fn tag(id: ModelId) -> u32 {
    id as u32 + 1
}

/// Returns the model of a tag, or `None` if no model has the tag.
#[inline(always)]
pub(crate) fn tagged(tag: u32) -> Option<ModelId> {
    at(tag.checked_sub(1)?)
}

/// Runs `body` for the type of a model: `visit!(id, M, (arguments) -> Output, body)`. This is a jump and a call with its arguments
/// in registers. In a struct they would go through memory, and a read across two writes stalls for 10 to 20 ns.
macro_rules! visit {
    ($id:expr, $M:ident, ($($argument:ident: $type:ty),* $(,)?) -> $out:ty, $body:expr) => {{
        #[inline(never)]
        fn work<$M: hairis_variants::Registered>($($argument: $type),*) -> $out {
            $body
        }
        struct Work {
            $($argument: $type),*
        }
        impl hairis_variants::Visitor for Work {
            type Output = $out;
            #[inline(always)]
            fn visit<$M: hairis_variants::Registered>(self) -> $out {
                work::<$M>($(self.$argument),*)
            }
        }
        $id.visit(Work { $($argument),* })
    }};
}
pub(crate) use visit;
