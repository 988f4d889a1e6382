//! The list of models that the library has, and calls on their types.

use hairis_variants::ModelId;

/// The model of an index.
pub(crate) fn at(index: u32) -> Option<ModelId> {
    let place = usize::try_from(index).ok()?;
    ModelId::ALL.get(place).copied()
}

/// The tag of a model in handles: 0 is no model.
pub(crate) const fn tag(id: ModelId) -> u32 {
    id as u32 + 1
}

/// The model of a tag.
#[inline(always)]
pub(crate) fn tagged(tag: u32) -> Option<ModelId> {
    at(tag.checked_sub(1)?)
}

/// Does work on the type of a model, `visit!(id, M, (arguments) -> Output, body)`: a jump and a call with its arguments in
/// registers. In a struct they would go through memory, and reading across two writes stalls for 10 to 20 ns.
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
