//! Tables of eight entries of fifteen numbers, of which each lane reads the entry of its own index.

use super::lane_struct::{LaneStruct, Path};
use super::lanes::Scalar;
use super::storage::{Entries, Storage};
use wide::f32x8;

/// Tables of eight entries, one table for each lane of `C`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Table<C: Scalar>(pub(crate) C::Table);

impl<C: Scalar> Table<C> {
    /// Makes the table of these entries.
    #[inline]
    pub(crate) fn new(entries: &Entries<C>) -> Self {
        Self(C::Table::new(entries))
    }
}

impl<C: Scalar + PartialEq> PartialEq for Table<C> {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.0.entries() == other.0.entries()
    }
}

impl<C: Scalar> LaneStruct for Table<C> {
    type Number = C;
    type One = Table<f32>;
    type Eight = Table<f32x8>;

    #[inline]
    fn make(path: &Path<'_>, next: &mut dyn FnMut(&Path<'_>) -> C) -> Self {
        Self::new(&LaneStruct::make(path, next))
    }
    #[inline]
    fn visit(&self, path: &Path<'_>, see: &mut dyn FnMut(&Path<'_>, C)) {
        self.0.entries().visit(path, see);
    }
    #[inline]
    fn pack(items: [&Table<f32>; 8]) -> Table<f32x8> {
        Table(items.map(|item| item.0.rows))
    }
    #[inline]
    fn lane(eight: &Table<f32x8>, lane: usize) -> Table<f32> {
        Table::new(&eight.0[lane].entries())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::storage::{ENTRIES, Fours, NUMBERS};
    use crate::simd::{Broadcast, Choice, Kernel, Lanes, Level, Pair};
    use core::array::from_fn;

    /// Kernel that reads all numbers of an entry per lane: the entry of a number's magnitude, and four entries on where the number
    /// is above 0.
    struct Find<'a, C: Scalar> {
        x: f32x8,
        table: &'a Table<C>,
    }

    #[inline(always)]
    fn found<L: Lanes, C: Broadcast<L>>(x: L, table: &Table<C>) -> [[L; 4]; 4] {
        let one = L::splat(1.0);
        let index = L::Index::search(x.abs(), [one, one + 1.0, one + 2.0], 3);
        let upper = L::splat(0.0).lt(x);
        [
            C::look_up_four(&table.0, index, upper, 0),
            C::look_up_four(&table.0, index, upper, 1),
            C::look_up_four(&table.0, index, upper, 2),
            C::look_up_four(&table.0, index, upper, 3),
        ]
    }

    macro_rules! find {
        ($($C:ty)*) => { $(
            impl Kernel for Find<'_, $C> {
                type Output = Fours<f32x8>;

                #[inline(always)]
                fn run<L: Lanes<Stored = f32x8>>(self) -> Fours<f32x8> {
                    found::<L, $C>(self.x.lanes(), self.table).map(|four| four.map(L::store))
                }
            }
        )* };
    }
    find! { f32 f32x8 }

    /// Table whose numbers encode table, entry and place.
    fn table(number: usize) -> Table<f32> {
        let place = |entry: usize, place: usize| 1000 * number + 100 * entry + place;
        Table::new(&from_fn(|entry| {
            from_fn(|i| u16::try_from(place(entry, i)).unwrap_or_default().into())
        }))
    }

    #[test]
    fn lanes_read_the_entry_of_their_index() {
        let numbers = [-0.5, -1.5, -2.5, -3.5, 0.5, 1.5, 2.5, 3.5_f32];
        let tables: [Table<f32>; 8] = from_fn(table);
        let packed = Table::<f32>::pack(tables.each_ref());
        let x = f32x8::new(numbers);
        // What the entry `entry` of a table holds at a place.
        let held = |table: &Table<f32>, entry: usize, place: usize| {
            table.0.entries()[entry].get(place).copied().unwrap_or(0.0)
        };
        for level in Level::available() {
            let shared = level.run(Find {
                x,
                table: &tables[1],
            });
            let apart = level.run(Find { x, table: &packed });
            for (place, [shared, apart]) in
                (0..16).map(|i| (i, [&shared, &apart].map(|t| t[i / 4][i % 4])))
            {
                let expected = f32x8::new(from_fn(|lane| held(&tables[1], lane, place)));
                assert_eq!(shared, expected, "{level}, shared, place {place}");
                let expected = f32x8::new(from_fn(|lane| held(&tables[lane], lane, place)));
                assert_eq!(apart, expected, "{level}, a table each, place {place}");
            }
        }
        // Lanes that are their own constants: each lane reads its own table.
        let each: Table<Pair<f32>> = Table::new(&from_fn(|entry| {
            from_fn(|i| Pair(held(&tables[2], entry, i), held(&tables[3], entry, i)))
        }));
        for (entry, x) in numbers.into_iter().enumerate() {
            let at = Pair(x, numbers[0]);
            for (found, [first, second]) in
                [(found(at, &tables[2]), [2, 2]), (found(at, &each), [2, 3])]
            {
                for (place, Pair(one, other)) in found.as_flattened().iter().enumerate() {
                    let expected = [
                        held(&tables[first], entry, place),
                        held(&tables[second], 0, place),
                    ];
                    assert_eq!([*one, *other], expected, "entry {entry}, place {place}");
                }
            }
        }
    }

    #[test]
    fn tables_are_packed_and_flattened() {
        let tables: [Table<f32>; 8] = from_fn(table);
        let packed = Table::<f32>::pack(tables.each_ref());
        for (lane, table) in tables.iter().enumerate() {
            assert_eq!(Table::<f32>::lane(&packed, lane), *table, "lane {lane}");
        }
        let mut numbers = [f32x8::ZERO; ENTRIES * NUMBERS];
        let mut seen = numbers.iter_mut();
        packed.visit(&Path::Root, &mut |_, number| {
            *seen.next().expect("a place for each number") = number;
        });
        assert!(seen.next().is_none(), "fewer numbers than places");
        let mut next = numbers.into_iter();
        let made: Table<f32x8> =
            LaneStruct::make(&Path::Root, &mut |_| next.next().expect("a number"));
        assert_eq!(made, packed);
    }
}
