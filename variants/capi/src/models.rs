//! List of the models in the library, and calls on their types.

use hairis_variants::ModelId;

/// Returns the model of an index, or `None` if the index is out of range.
pub(crate) fn at(index: u32) -> Option<ModelId> {
    let place = usize::try_from(index).ok()?;
    ModelId::ALL.get(place).copied()
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
