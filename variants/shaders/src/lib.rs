//! Translates the scattering models of hairis into source code of other languages.
//!
//! A [`Model`](hairis::model::Model) is run once on lanes that record its operations. The recorded graph is a [`Function`], which
//! computes the bits of one lane, is printed in a [`Language`], and has a [`gradient`](Function::gradient).
//!
//! ```
//! use hairis_shaders::{Call, Language, Program, Target, print};
//! use hairis_variants::KajiyaKay;
//!
//! let program = Program::of::<KajiyaKay>(Target::Exact);
//! let header = print(&program, Language::C);
//! assert!(header.contains("hairis_kajiya_kay_eval_hit(HairisKajiyaKayMaterial material, HairisVec3 wo, float h"));
//! assert!(program.function(Call::Eval).operations() < program.function(Call::EvalHit).operations());
//! ```

#[cfg(all(test, not(feature = "spirv")))]
compile_error!(
    "tests of hairis-shaders need the feature `spirv`: run cargo test -p hairis-shaders --features spirv"
);

mod call;
mod double;
mod function;
mod gradient;
mod graph;
#[cfg(any(doc, doctest))]
pub mod guide;
mod material;
mod name;
mod print;
mod program;
mod record;
#[cfg(feature = "spirv")]
pub mod spirv;

pub use call::Call;
pub use function::{Argument, Function};
pub use graph::{Graph, Kind, Node, Origin, Rounding};
pub use hairis::simd::trace::Target;
pub use material::parameters;
pub use name::check_name;
pub use print::{Language, driver, print};
pub use program::Program;
#[doc(hidden)]
pub use program::every_operation;
pub use record::{Field, Record, Shape, numbers};
