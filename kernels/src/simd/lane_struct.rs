//! Structs of lanes: constants of a material or of a shading point, as one number each or as one number per lane.

use super::lanes::{Broadcast, Lanes, Scalar};
use core::fmt::{self, Debug};
use wide::f32x8;

/// Number, array of numbers, or struct of both, as [`lane_struct!`](crate::simd::lane_struct) declares it. Eight structs of one lane
/// pack into one struct of eight lanes.
///
/// [`visit`](Self::visit) and [`make`](Self::make) flatten and rebuild the struct, for hosts that keep its numbers in arrays:
///
/// ```
/// use hairis::simd::{LaneStruct, Path, lane_struct};
/// lane_struct! {
///     /// Constants.
///     pub struct Bells<const N: usize> {
///         /// Widths.
///         pub width: [[C; 2]; N],
///     }
/// }
/// let bells = Bells { width: [[1.0_f32, 2.0], [3.0, 4.0]] };
/// let (mut names, mut numbers) = (Vec::new(), Vec::new());
/// bells.visit(&Path::Root, &mut |path, number| {
///     names.push(path.to_string());
///     numbers.push(number);
/// });
/// assert_eq!(names, ["width[0][0]", "width[0][1]", "width[1][0]", "width[1][1]"]);
/// let mut next = numbers.into_iter();
/// assert_eq!(Bells::make(&Path::Root, &mut |_| next.next().unwrap()), bells);
/// ```
pub trait LaneStruct: Copy + Debug + Send + Sync + 'static {
    /// Type of the numbers in the struct.
    type Number: Scalar;
    /// Struct of one lane: the same fields with one number each.
    type One;
    /// Struct of eight lanes: the same fields with one number per lane.
    type Eight;
    /// Builds the struct at `path` from the numbers that `next` returns for each place, in order of declaration.
    fn make(path: &Path<'_>, next: &mut dyn FnMut(&Path<'_>) -> Self::Number) -> Self;
    /// Calls `see` with each place below `path` and its number, in order of declaration.
    fn visit(&self, path: &Path<'_>, see: &mut dyn FnMut(&Path<'_>, Self::Number));
    /// Packs eight structs into one: lane `i` holds the numbers of `items[i]`.
    fn pack(items: [&Self::One; 8]) -> Self::Eight;
    /// Returns the numbers of one lane, 0 to 7.
    fn lane(eight: &Self::Eight, lane: usize) -> Self::One;
}

/// Place of a number in a struct of lanes, which is displayed as in Rust: `view.shift[2]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path<'a> {
    /// The whole struct.
    Root,
    /// A field of a struct, by its name.
    Field(&'a Path<'a>, &'static str),
    /// An entry of an array: its index, and the length of the array.
    Entry(&'a Path<'a>, usize, usize),
}

impl fmt::Display for Path<'_> {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Root => Ok(()),
            Self::Field(Self::Root, name) => f.write_str(name),
            Self::Field(parent, name) => write!(f, "{parent}.{name}"),
            Self::Entry(parent, index, _) => write!(f, "{parent}[{index}]"),
        }
    }
}

impl<C: Scalar> LaneStruct for C {
    type Number = C;
    type One = f32;
    type Eight = f32x8;
    #[inline]
    fn make(path: &Path<'_>, next: &mut dyn FnMut(&Path<'_>) -> C) -> C {
        next(path)
    }
    #[inline]
    fn visit(&self, path: &Path<'_>, see: &mut dyn FnMut(&Path<'_>, C)) {
        see(path, *self);
    }
    #[inline(always)]
    fn pack(items: [&f32; 8]) -> f32x8 {
        f32x8::new(items.map(|number| *number))
    }
    #[inline(always)]
    fn lane(eight: &f32x8, lane: usize) -> f32 {
        eight.as_array()[lane]
    }
}

impl<T: LaneStruct, const N: usize> LaneStruct for [T; N] {
    type Number = T::Number;
    type One = [T::One; N];
    type Eight = [T::Eight; N];
    #[inline]
    fn make(path: &Path<'_>, next: &mut dyn FnMut(&Path<'_>) -> T::Number) -> Self {
        core::array::from_fn(|i| T::make(&Path::Entry(path, i, N), next))
    }
    #[inline]
    fn visit(&self, path: &Path<'_>, see: &mut dyn FnMut(&Path<'_>, T::Number)) {
        for (i, entry) in self.iter().enumerate() {
            entry.visit(&Path::Entry(path, i, N), see);
        }
    }
    #[inline(always)]
    fn pack(items: [&Self::One; 8]) -> Self::Eight {
        core::array::from_fn(|i| T::pack(items.map(|item| &item[i])))
    }
    #[inline(always)]
    fn lane(eight: &Self::Eight, lane: usize) -> Self::One {
        core::array::from_fn(|i| T::lane(&eight[i], lane))
    }
}

/// Conversion of numbers, arrays and structs to the storage of `L`: one number for all lanes becomes one number per lane.
#[doc(hidden)]
pub trait Spread<L: Lanes> {
    type Stored: Copy;
    fn spread(&self) -> Self::Stored;
}

impl<L: Lanes, C: Broadcast<L>> Spread<L> for C {
    type Stored = L::Stored;
    #[inline(always)]
    fn spread(&self) -> L::Stored {
        self.lanes().store()
    }
}

impl<L: Lanes, T: Spread<L>, const N: usize> Spread<L> for [T; N] {
    type Stored = [T::Stored; N];
    #[inline(always)]
    fn spread(&self) -> [T::Stored; N] {
        // Not `map`: closures over lanes are not inlined into functions of target features. Without a loop where arrays are short,
        // because compilers that optimise for size keep loops.
        macro_rules! chunk {
            ($($i:literal)*) => {
                if const { [$($i),*].len() == N } {
                    let chunk = [$(self[const { if $i < N { $i } else { 0 } }].spread()),*];
                    if let Some(stored) = chunk.first_chunk() {
                        return *stored;
                    }
                }
            };
        }
        chunk!(0);
        chunk!(0 1);
        chunk!(0 1 2);
        chunk!(0 1 2 3);
        let mut stored = [self[0].spread(); N];
        let mut i = 1;
        while i < N {
            stored[i] = self[i].spread();
            i += 1;
        }
        stored
    }
}

/// Declares a struct of lanes, `Name<C>`: a [`LaneStruct`](crate::simd::LaneStruct) with a method
/// `spread`, which returns the same numbers in the storage of lanes.
///
/// Every field is a `C`, another such struct, or an array of either. The struct may have lengths of
/// arrays as parameters: `struct Name<const N: usize>` is `Name<C, N>`.
///
/// ```
/// use hairis::simd::LaneStruct;
/// hairis::simd::lane_struct! {
///     /// Constants of one shading point.
///     pub struct Constants {
///         /// Exponent of the highlight.
///         pub exponent: C,
///         /// Colour, linear RGB.
///         pub color: [C; 3],
///     }
/// }
/// let one = Constants { exponent: 8.0_f32, color: [0.1, 0.2, 0.3] };
/// let two = Constants { exponent: 2.0_f32, color: [0.4, 0.5, 0.6] };
/// let eight = Constants::<f32>::pack([&one, &two, &one, &one, &one, &one, &one, &one]);
/// assert_eq!(Constants::<f32>::lane(&eight, 1), two);
/// ```
#[macro_export]
macro_rules! lane_struct {
    (
        $(#[$meta:meta])*
        $vis:vis struct $name:ident $(<$(const $N:ident: usize),+>)? {
            $($(#[$field_meta:meta])* $field_vis:vis $field:ident: $Field:ty,)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        $vis struct $name<C $($(, const $N: usize)+)?> { $($(#[$field_meta])* $field_vis $field: $Field,)* }

        impl<C: Copy $($(, const $N: usize)+)?> $name<C $($(, $N)+)?> {
            /// Spreads the numbers to the storage of `L`: one number for all lanes becomes one per
            /// lane.
            #[inline(always)]
            #[must_use]
            $vis fn spread<L: $crate::simd::Lanes>(&self) -> $name<L::Stored $($(, $N)+)?>
            where
                C: $crate::simd::Broadcast<L>,
            {
                $name { $($field: <$Field as $crate::simd::Spread<L>>::spread(&self.$field),)* }
            }
        }

        impl<L: $crate::simd::Lanes, C: $crate::simd::Broadcast<L> $($(, const $N: usize)+)?>
            $crate::simd::Spread<L> for $name<C $($(, $N)+)?>
        {
            type Stored = $name<L::Stored $($(, $N)+)?>;
            #[inline(always)]
            fn spread(&self) -> Self::Stored {
                self.spread::<L>()
            }
        }

        $crate::simd::lane_struct! {
            @impl {C: $crate::simd::Scalar $($(, const $N: usize)+)?} C, $name
            {C $($(, $N)+)?} {f32 $($(, $N)+)?} {$crate::simd::f32x8 $($(, $N)+)?}
            $($field: $Field),*
        }
    };
    (
        @impl {$($generics:tt)*} $Number:ty, $name:ident {$($own:tt)*} {$($one:tt)*} {$($eight:tt)*}
        $($field:ident: $Field:ty),*
    ) => {
        impl<$($generics)*> $crate::simd::LaneStruct for $name<$($own)*> {
            type Number = $Number;
            type One = $name<$($one)*>;
            type Eight = $name<$($eight)*>;
            #[inline]
            fn make(
                path: &$crate::simd::Path<'_>,
                next: &mut dyn FnMut(&$crate::simd::Path<'_>) -> $Number,
            ) -> Self {
                $name { $($field: <$Field as $crate::simd::LaneStruct>::make(
                    &$crate::simd::Path::Field(path, stringify!($field)),
                    next,
                ),)* }
            }
            #[inline]
            fn visit(
                &self,
                path: &$crate::simd::Path<'_>,
                see: &mut dyn FnMut(&$crate::simd::Path<'_>, $Number),
            ) {
                $($crate::simd::LaneStruct::visit(
                    &self.$field,
                    &$crate::simd::Path::Field(path, stringify!($field)),
                    see,
                );)*
            }
            #[inline]
            fn pack(items: [&Self::One; 8]) -> Self::Eight {
                $name { $($field: <$Field as $crate::simd::LaneStruct>::pack(
                    items.map(|item| &item.$field),
                ),)* }
            }
            #[inline]
            fn lane(eight: &Self::Eight, lane: usize) -> Self::One {
                $name { $($field: <$Field as $crate::simd::LaneStruct>::lane(&eight.$field, lane),)* }
            }
        }
    };
}
