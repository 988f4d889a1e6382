//! Tables of eight entries of fifteen numbers, of which each lane reads the entry of its own index.

use super::lane_struct::{LaneStruct, Path};
use super::lanes::Scalar;
use core::array::from_fn;
use core::fmt::Debug;
use wide::f32x8;

/// Entries of a table.
pub(crate) const ENTRIES: usize = 8;
/// Numbers of an entry.
pub(crate) const NUMBERS: usize = 15;

/// The numbers of each entry.
pub(crate) type Entries<C> = [[C; NUMBERS]; ENTRIES];

/// A table for each lane of `C`.
#[derive(Clone, Copy, Debug)]
pub struct Table<C: Scalar>(pub(super) C::Table);

impl<C: Scalar> Table<C> {
    /// The table of these entries.
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

/// A table in memory.
pub trait Storage<C>: Copy + Debug + Send + Sync + 'static {
    /// The table of these entries.
    fn new(entries: &Entries<C>) -> Self;
    /// Entries of the table.
    fn entries(&self) -> Entries<C>;
}

/// Tables of lanes whose constants are not looked up by index.
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

/// The fours of numbers of an entry, the last number of which is 0.
pub(super) type Fours<T> = [[T; 4]; 4];

/// The numbers of each entry, four by four, as one lane reads them and lanes that no shuffle chooses for.
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
    /// Four numbers of an entry from 0 to 7.
    #[inline(always)]
    pub(super) fn four(&self, entry: u32, four: usize) -> &[f32; 4] {
        &self.0[entry as usize & (ENTRIES - 1)][four]
    }
}

/// A number of an entry, 0 beyond its end.
fn number(entry: &[f32; NUMBERS], number: usize) -> f32 {
    entry.get(number).copied().unwrap_or_default()
}

/// A table that all lanes share: by entry, and by number, as shuffles choose.
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

/// A table of each lane, one after the other.
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
