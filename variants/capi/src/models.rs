//! The list of models that the library has, and calls on their types.

use hairis_variants::{ModelId, Registered, Visitor};

/// Whether the library has the model.
const fn has(id: ModelId) -> bool {
    !cfg!(feature = "few") || id.is_essential()
}

/// Models of the library, in the order of their indices.
pub(crate) fn all() -> impl Iterator<Item = ModelId> + Clone {
    ModelId::ALL.iter().copied().filter(|id| has(*id))
}

/// The model of an index.
pub(crate) fn at(index: u32) -> Option<ModelId> {
    all().nth(usize::try_from(index).ok()?)
}

/// The index of a model.
pub(crate) fn index(id: ModelId) -> u32 {
    (0..)
        .zip(all())
        .find(|(_, one)| *one == id)
        .map_or(0, |(index, _)| index)
}

/// The model of a name and of a word of its choice.
pub(crate) fn find(name: &str, word: Option<&str>) -> Option<ModelId> {
    ModelId::find(name, word).filter(|id| has(*id))
}

/// The tag of a model in handles: 0 is no model.
pub(crate) const fn tag(id: ModelId) -> u32 {
    id as u32 + 1
}

/// The model of a tag.
#[inline(always)]
pub(crate) fn tagged(tag: u32) -> Option<ModelId> {
    let place = usize::try_from(tag).ok()?.checked_sub(1)?;
    ModelId::ALL.get(place).copied()
}

/// Calls `visitor` with the model's type, if the library has it: the code of other models is not compiled.
#[inline(always)]
pub(crate) fn dispatch<V: Visitor>(id: ModelId, visitor: V) -> Option<V::Output> {
    struct Present<V>(V);
    impl<V: Visitor> Visitor for Present<V> {
        type Output = Option<V::Output>;
        #[inline(always)]
        fn visit<M: Registered>(self) -> Self::Output {
            if const { has(ModelId::of::<M>()) } {
                Some(self.0.visit::<M>())
            } else {
                None
            }
        }
    }
    id.visit(Present(visitor))
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
        $crate::models::dispatch($id, Work { $($argument),* })
    }};
}
pub(crate) use visit;
