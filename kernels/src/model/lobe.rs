//! The lobes of a model, their order, and sets of lobes. The order is defined in this file alone.

use crate::simd::Lanes;
use core::ops::{Index, IndexMut};

/// One lobe of a scattering model: a slot from 0 to 4.
///
/// The constants name the lobes of the published model. A model with other lobes names its own slots, for instance
/// `const DIFFUSE: Lobe = Lobe::slot(0)`, and lists them in [`Model::LOBES`](crate::model::Model::LOBES).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Lobe(u8);

impl Lobe {
    /// Number of slots that a model has for lobes.
    pub const COUNT: usize = 5;
    /// Reflection off the surface of the fibre: the primary highlight.
    pub const R: Self = Self(0);
    /// Transmission through the fibre: the light seen on hair lit from behind.
    pub const TT: Self = Self(1);
    /// One reflection inside the fibre: the secondary highlight without its glints (TRT-g in the paper).
    pub const TRT: Self = Self(2);
    /// The two glints of the secondary highlight, which share its longitudinal term.
    pub const GLINT: Self = Self(3);
    /// Lobes of the published model, and slots of any model of four lobes, in slot order.
    pub const FOUR: [Self; 4] = [Self::R, Self::TT, Self::TRT, Self::GLINT];
    /// Every slot, in slot order. The last one is that of a lobe beside four others.
    pub const ALL: [Self; Self::COUNT] = [Self::R, Self::TT, Self::TRT, Self::GLINT, Self::slot(4)];

    /// Returns the lobe in slot `index`.
    ///
    /// # Panics
    ///
    /// Panics if `index` is above 4. In a constant, which is the intended use, this is an error at compile time.
    #[inline]
    #[must_use]
    pub const fn slot(index: u8) -> Self {
        assert!(
            (index as usize) < Self::COUNT,
            "a lobe slot is 0, 1, 2, 3 or 4"
        );
        Self(index)
    }

    /// Returns the number of the slot as an index into arrays such as [`PerLobe`].
    #[inline(always)]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// Returns the lobe of a slot number stored as a float, or `None` for the -1 of a discarded sample.
    #[inline]
    pub(crate) fn from_number(number: f32) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|lobe| f32::from(lobe.0) == number)
    }
}

/// Array of one value per lobe, indexed by [`Lobe`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PerLobe<T>(pub [T; Lobe::COUNT]);

impl<T: Copy> PerLobe<T> {
    /// Makes an array from the values of the first `N` lobes, with `rest` in the slots after them.
    #[inline(always)]
    #[must_use]
    pub fn padded<const N: usize>(values: [T; N], rest: T) -> Self {
        const { assert!(N <= Lobe::COUNT, "a model has at most 5 lobes") };
        // Written out, because compilers that optimise for size keep loops, and with them the array in memory.
        macro_rules! slots {
            ($($l:literal)*) => {
                [$(if const { $l < N } { values[const { if $l < N { $l } else { 0 } }] } else { rest }),*]
            };
        }
        Self(slots!(0 1 2 3 4))
    }
}

/// Multiplies two arrays entry by entry.
#[inline(always)]
pub(crate) fn times<L: Lanes>(x: [L; 4], y: [L; 4]) -> [L; 4] {
    [x[0] * y[0], x[1] * y[1], x[2] * y[2], x[3] * y[3]]
}

impl<T> Index<Lobe> for PerLobe<T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, lobe: Lobe) -> &T {
        &self.0[lobe.index()]
    }
}

impl<T> IndexMut<Lobe> for PerLobe<T> {
    #[inline(always)]
    fn index_mut(&mut self, lobe: Lobe) -> &mut T {
        &mut self.0[lobe.index()]
    }
}

/// Set of lobes, for light-path expressions and AOVs.
///
/// ```
/// use hairis::{Lobe, LobeMask};
/// let highlights = LobeMask::of(&[Lobe::R, Lobe::TRT]);
/// assert!(highlights.contains(Lobe::R) && !highlights.contains(Lobe::TT));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LobeMask(u8);

impl LobeMask {
    /// Set of all lobes.
    pub const ALL: Self = Self(0b1_1111);
    /// Empty set: the BSDF evaluates to zero, and every sample is discarded.
    pub const NONE: Self = Self(0);

    /// Makes the set of the given lobes.
    #[inline]
    #[must_use]
    pub const fn of(lobes: &[Lobe]) -> Self {
        let mut bits = 0;
        let mut i = 0;
        while i < lobes.len() {
            bits |= 1 << lobes[i].0;
            i += 1;
        }
        Self(bits)
    }

    /// Returns true if `lobe` is in the set.
    #[inline]
    #[must_use]
    pub const fn contains(self, lobe: Lobe) -> bool {
        self.0 >> lobe.0 & 1 == 1
    }

    /// Returns 1 for a lobe in the set and 0 for any other.
    #[inline]
    #[must_use]
    pub const fn factor(self, lobe: Lobe) -> f32 {
        if self.contains(lobe) { 1.0 } else { 0.0 }
    }
}

impl LobeMask {
    /// Returns the [`factor`](Self::factor) of each of the first four lobes.
    #[inline(always)]
    pub(crate) fn factors<C: Lanes>(self) -> [C; 4] {
        Lobe::FOUR.map(|lobe| C::splat(self.factor(lobe)))
    }
}

impl Default for LobeMask {
    /// Returns the set of all lobes.
    #[inline]
    fn default() -> Self {
        Self::ALL
    }
}
