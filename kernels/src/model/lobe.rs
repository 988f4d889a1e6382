//! The four lobes of a model. Their order is defined in this file alone.

use crate::simd::Lanes;
use core::ops::{Index, IndexMut};

/// One lobe of a scattering model: a slot from 0 to 3.
///
/// The constants name the lobes of the published model. A model with other lobes names its own slots, for
/// instance `const DIFFUSE: Lobe = Lobe::slot(0)`, and lists them in its [`Model::LOBES`](crate::model::Model::LOBES).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Lobe(u8);

impl Lobe {
    /// Number of slots.
    pub const COUNT: usize = 4;
    /// Reflection off the surface, the primary highlight.
    pub const R: Self = Self(0);
    /// Transmission through the fibre.
    pub const TT: Self = Self(1);
    /// One internal reflection, the secondary highlight without its glints (TRT-g in the paper).
    pub const TRT: Self = Self(2);
    /// The two glints of the secondary highlight; they share its longitudinal term.
    pub const GLINT: Self = Self(3);
    /// Every slot, in order.
    pub const ALL: [Self; Self::COUNT] = [Self::R, Self::TT, Self::TRT, Self::GLINT];

    /// The lobe in slot `index`.
    ///
    /// # Panics
    ///
    /// If `index` is above 3: at compile time when used for a constant, as it is meant to be.
    #[inline]
    #[must_use]
    pub const fn slot(index: u8) -> Self {
        assert!(
            (index as usize) < Self::COUNT,
            "a lobe slot is 0, 1, 2 or 3"
        );
        Self(index)
    }

    /// The slot as an index.
    #[inline(always)]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The lobe of a slot number stored as a float; `None` for the -1 of a discarded sample.
    #[inline]
    pub(crate) fn from_number(number: f32) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|lobe| f32::from(lobe.0) == number)
    }
}

/// One value per lobe.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PerLobe<T>(pub [T; Lobe::COUNT]);

impl<T: Copy> PerLobe<T> {
    /// The values of the first `N` lobes, and `rest` in the slots after them.
    #[inline(always)]
    #[must_use]
    pub fn padded<const N: usize>(values: [T; N], rest: T) -> Self {
        const { assert!(N <= Lobe::COUNT, "a model has at most 4 lobes") };
        let mut all = [rest; Lobe::COUNT];
        let mut l = 0;
        while l < N {
            all[l] = values[l];
            l += 1;
        }
        Self(all)
    }
}

/// Product, entry by entry.
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

/// A subset of the lobes, for light-path expressions and AOVs.
///
/// ```
/// use hairis::{Lobe, LobeMask};
/// let highlights = LobeMask::of(&[Lobe::R, Lobe::TRT]);
/// assert!(highlights.contains(Lobe::R) && !highlights.contains(Lobe::TT));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LobeMask(u8);

impl LobeMask {
    /// Every lobe.
    pub const ALL: Self = Self(0b1111);
    /// No lobe: evaluates to zero, and every sample is discarded.
    pub const NONE: Self = Self(0);

    /// The given lobes.
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

    /// Whether `lobe` is in the set.
    #[inline]
    #[must_use]
    pub const fn contains(self, lobe: Lobe) -> bool {
        self.0 >> lobe.0 & 1 == 1
    }

    /// 1 for a lobe in the set, 0 for one that is not.
    #[inline]
    #[must_use]
    pub const fn factor(self, lobe: Lobe) -> f32 {
        if self.contains(lobe) { 1.0 } else { 0.0 }
    }
}

impl LobeMask {
    /// [`factor`](Self::factor) of each lobe.
    #[inline(always)]
    pub(crate) fn factors<C: Lanes>(self) -> [C; Lobe::COUNT] {
        Lobe::ALL.map(|lobe| C::splat(self.factor(lobe)))
    }
}

impl Default for LobeMask {
    /// Every lobe.
    #[inline]
    fn default() -> Self {
        Self::ALL
    }
}
