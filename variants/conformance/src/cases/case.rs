//! Cases of properties: shading points with their queries, on materials that were drawn or pasted.

use super::regressions::Regressions;
use crate::probe::Direction;
use core::any::Any;
use core::fmt;
use hairis::{Hit, LobeMask};
use proptest::strategy::BoxedStrategy;
use std::rc::Rc;

/// Parameters of a material that was drawn or pasted, without their type.
#[derive(Clone)]
pub struct Choice {
    pub(crate) params: Rc<dyn Any>,
    pub(crate) name: &'static str,
    pub(crate) code: Rc<str>,
}

/// Name of materials that the subject does not name.
pub(crate) const ANY: &str = "any material";

impl Choice {
    pub(crate) fn pasted(params: Rc<dyn Any>) -> Self {
        let (name, code) = ("the pasted material", "material".into());
        Self { params, name, code }
    }

    pub(crate) fn is_named(&self) -> bool {
        self.name != ANY
    }

    /// Returns the code of the parameters, in which `subject` is the subject of the test.
    pub(crate) fn code(&self) -> &str {
        &self.code
    }
}

impl fmt::Debug for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.code)
    }
}

/// Strategy for the materials of a subject: the named ones, and any legal one.
pub(crate) type Choices = BoxedStrategy<Choice>;

/// Shading point of a case, with the queries that a property makes of it.
#[derive(Clone, Copy, Debug)]
pub struct Row<P> {
    /// Parameters of the material.
    pub material: P,
    /// Hit in the fibre's frame.
    pub hit: Hit,
    /// Direction to evaluate.
    pub wi: Direction,
    /// Uniform numbers to sample with.
    pub xi: [f32; 3],
    /// True if the tolerances of the claims apply, which are stated only for materials that the subject names.
    pub tolerances: bool,
}

/// Case of a property: eight shading points, which fill the lanes of a packet.
#[derive(Clone, Debug)]
pub struct Case<P> {
    /// Shading points, one per lane.
    pub rows: [Row<P>; 8],
    /// Lobes, for properties of masks.
    pub lobes: LobeMask,
    /// Order of the lanes, for the property of permuted lanes.
    pub order: [usize; 8],
}

impl<P> Case<P> {
    /// Makes a case with the same shading point in all lanes, and all lobes.
    pub fn new(row: impl Fn() -> Row<P>) -> Self {
        Self {
            rows: core::array::from_fn(|_| row()),
            lobes: LobeMask::ALL,
            order: [0, 1, 2, 3, 4, 5, 6, 7],
        }
    }
}

/// Origin of the cases of a property.
#[derive(Clone, Debug)]
pub enum Source {
    /// Random numbers.
    Fresh,
    /// The regressions of a test, then random numbers. A failure is added to the regressions.
    Kept(Regressions),
    /// One case that a test contains as code.
    Pasted(Box<Case<Choice>>),
}
