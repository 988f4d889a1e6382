//! Tables of eight entries of fifteen numbers, of which each lane reads the entry of its own index.

use super::lane_struct::{LaneStruct, Path};
use super::lanes::Scalar;
use core::array::from_fn;
use core::fmt::Debug;
use wide::f32x8;

/// Number of entries of a table.
pub(crate) const ENTRIES: usize = 8;
/// Count of numbers in an entry.
pub(crate) const NUMBERS: usize = 15;

/// Numbers of each entry.
pub(crate) type Entries<C> = [[C; NUMBERS]; ENTRIES];

/// Tables of eight entries, one table for each lane of `C`.
#[derive(Clone, Copy, Debug)]
pub struct Table<C: Scalar>(pub(super) C::Table);

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

/// Representation of a table in memory.
pub trait Storage<C>: Copy + Debug + Send + Sync + 'static {
    /// Makes the table of these entries.
    fn new(entries: &Entries<C>) -> Self;
    /// Returns the entries of the table.
    fn entries(&self) -> Entries<C>;
}

/// Tables of lanes that select among all entries, or that have no constants of materials.
impl<C: Scalar> Storage<C> for Entries<C> {
    #[inline]
    fn new(entries: &Self) -> Self {
        *entries
    }
    #[inline]
    fn entries(&self) -> Self {
        *self
    }
}

/// Sixteen numbers, four by four, in place of the fifteen of an entry: the last is 0.
pub(super) type Fours<T> = [[T; 4]; 4];

/// Entries of a table, each as four times four numbers. One lane reads four numbers of one entry; eight lanes read four numbers of
/// eight entries and transpose them.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub struct Rows(pub(super) [Fours<f32>; ENTRIES]);

impl Rows {
    fn new(entries: &Entries<f32>) -> Self {
        Self(entries.map(|entry| from_fn(|four| from_fn(|i| number(&entry, 4 * four + i)))))
    }
    fn entries(&self) -> Entries<f32> {
        self.0
            .map(|fours| from_fn(|number| fours.as_flattened()[number]))
    }
    /// Returns four numbers of an entry from 0 to 7.
    #[inline(always)]
    pub(super) fn four(&self, entry: i32, four: usize) -> &[f32; 4] {
        &self.0[entry.cast_unsigned() as usize & (ENTRIES - 1)][four]
    }
}

/// Returns a number of an entry, and 0 beyond its end.
fn number(entry: &[f32; NUMBERS], number: usize) -> f32 {
    entry.get(number).copied().unwrap_or_default()
}

/// Table that all lanes share, stored by entry and by number, as shuffles read it.
#[derive(Clone, Copy, Debug)]
pub struct Shared {
    pub(super) rows: Rows,
    pub(super) columns: Fours<[f32; ENTRIES]>,
}

impl Storage<f32> for Shared {
    #[inline]
    fn new(entries: &Entries<f32>) -> Self {
        let columns = from_fn(|four| {
            from_fn(|i| entries.each_ref().map(|entry| number(entry, 4 * four + i)))
        });
        Self {
            rows: Rows::new(entries),
            columns,
        }
    }
    #[inline]
    fn entries(&self) -> Entries<f32> {
        self.rows.entries()
    }
}

/// One table per lane, one after the other.
impl Storage<f32x8> for [Rows; 8] {
    #[inline]
    fn new(entries: &Entries<f32x8>) -> Self {
        from_fn(|lane| {
            Rows::new(
                &entries
                    .each_ref()
                    .map(|entry| entry.map(|number| number.as_array()[lane])),
            )
        })
    }
    #[inline]
    fn entries(&self) -> Entries<f32x8> {
        let lanes = self.each_ref().map(Rows::entries);
        from_fn(|entry| from_fn(|number| f32x8::new(lanes.map(|entries| entries[entry][number]))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Broadcast, Choice, Kernel, Lanes, Level, Pair};

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
            C::look_up_four(table, index, upper, 0),
            C::look_up_four(table, index, upper, 1),
            C::look_up_four(table, index, upper, 2),
            C::look_up_four(table, index, upper, 3),
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
        for (entry, x) in numbers.into_iter().enumerate() {
            let pair = found(Pair(x, numbers[0]), &tables[2]);
            for (place, Pair(one, other)) in pair.as_flattened().iter().enumerate() {
                assert_eq!(
                    *one,
                    held(&tables[2], entry, place),
                    "one lane, place {place}"
                );
                assert_eq!(
                    *other,
                    held(&tables[2], 0, place),
                    "the other lane, place {place}"
                );
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
