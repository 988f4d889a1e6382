//! Two registers side by side: while one waits for a result, the other computes.

#![allow(unsafe_code, reason = "reads and writes what its two registers do")]

use super::vector::{Table, Vector};
use core::ops::{Add, Div, Mul, Sub};

/// Two registers side by side.
#[derive(Clone, Copy)]
pub(super) struct Two<V>(V, V);

macro_rules! two_operators {
    ($($Trait:ident $method:ident;)*) => { $(
        impl<V: Vector> $Trait for Two<V> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    )* };
}
two_operators! { Add add; Sub sub; Mul mul; Div div; }

macro_rules! two {
    ($($name:ident($($arg:ident),*);)*) => { $(
        #[inline(always)]
        fn $name(self, $($arg: Self),*) -> Self {
            Self(self.0.$name($($arg.0),*), self.1.$name($($arg.1),*))
        }
    )* };
}
macro_rules! two_masked {
    ($($name:ident($($arg:ident),*);)*) => { $(
        #[inline(always)]
        fn $name(mask: Self::Mask, $($arg: Self),*) -> Self {
            Self(V::$name(mask.0, $($arg.0),*), V::$name(mask.1, $($arg.1),*))
        }
    )* };
}

impl<V: Vector> Vector for Two<V> {
    type Mask = (V::Mask, V::Mask);
    type Index = (V::Index, V::Index);
    const LANES: usize = 2 * V::LANES;
    two! { mul_add(a, b); mul_sub(a, b); sub_from(a, b); sqrt(); over(other); abs(); min(other); max(other); times_sign(sign); shift_23(); }
    two_masked! { select(yes, no); clear(x); negate(x); }
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(V::splat(x), V::splat(x))
    }
    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the caller's.
        unsafe { Self(V::load(from), V::load(from.add(V::LANES))) }
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        // SAFETY: the caller's.
        unsafe {
            self.0.store(to);
            self.1.store(to.add(V::LANES));
        }
    }
    #[inline(always)]
    fn reciprocals([a, b, c, d]: [Self; 4], few: bool) -> [Self; 4] {
        let first = V::reciprocals([a.0, b.0, c.0, d.0], few);
        let second = V::reciprocals([a.1, b.1, c.1, d.1], few);
        [
            Self(first[0], second[0]),
            Self(first[1], second[1]),
            Self(first[2], second[2]),
            Self(first[3], second[3]),
        ]
    }
    #[inline(always)]
    fn rest_of_square(x: Self) -> Self {
        Self(V::rest_of_square(x.0), V::rest_of_square(x.1))
    }
    #[inline(always)]
    fn cross(a: Self, b: Self, c: Self, d: Self) -> Self {
        Self(V::cross(a.0, b.0, c.0, d.0), V::cross(a.1, b.1, c.1, d.1))
    }
    #[inline(always)]
    fn together(self) -> Self {
        let (a, b) = V::pair(self.0, self.1);
        Self(a, b)
    }
    #[inline(always)]
    fn below_zero(self) -> Self::Mask {
        (self.0.below_zero(), self.1.below_zero())
    }
    #[inline(always)]
    fn either(a: Self::Mask, b: Self::Mask) -> Self::Mask {
        (V::either(a.0, b.0), V::either(a.1, b.1))
    }
    #[inline(always)]
    fn search(x: Self, [a, b, c]: [Self; 3]) -> Self::Index {
        (
            V::search(x.0, [a.0, b.0, c.0]),
            V::search(x.1, [a.1, b.1, c.1]),
        )
    }
    #[inline(always)]
    fn is_tt(index: Self::Index) -> Self::Mask {
        (V::is_tt(index.0), V::is_tt(index.1))
    }
    #[inline(always)]
    fn is_glint(index: Self::Index) -> Self::Mask {
        (V::is_glint(index.0), V::is_glint(index.1))
    }
    #[inline(always)]
    fn look_up(table: &Table, index: Self::Index) -> Self {
        Self(V::look_up(table, index.0), V::look_up(table, index.1))
    }
    #[inline(always)]
    fn look_up_half(table: &Table, index: Self::Index) -> Self {
        Self(
            V::look_up_half(table, index.0),
            V::look_up_half(table, index.1),
        )
    }
}
