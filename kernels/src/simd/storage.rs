//! Tables in memory: eight entries of fifteen numbers, laid out as the lanes that read them need them.

use core::array::from_fn;
use core::fmt::Debug;
use wide::f32x8;

/// Number of entries of a table.
pub(crate) const ENTRIES: usize = 8;
/// Count of numbers in an entry.
pub(crate) const NUMBERS: usize = 15;

/// Numbers of each entry.
pub(crate) type Entries<C> = [[C; NUMBERS]; ENTRIES];

/// Representation of a table in memory.
pub trait Storage<C>: Copy + Debug + Send + Sync + 'static {
    /// Makes the table of these entries.
    fn new(entries: &Entries<C>) -> Self;
    /// Returns the entries of the table.
    fn entries(&self) -> Entries<C>;
}

/// Tables of lanes that select among all entries, or that have no constants of materials.
impl<C: Copy + Debug + Send + Sync + 'static> Storage<C> for Entries<C> {
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
    pub(super) fn entries(&self) -> Entries<f32> {
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
