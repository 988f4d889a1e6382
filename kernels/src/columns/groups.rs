//! Grouping of rows by the material of their hit.

/// Number of rows that are grouped at once; with half as many, six materials take 30% longer.
const ROWS: usize = 256;
/// Smallest number of rows of one material for which a call of its own is faster than one lane per row.
const FEW: usize = 3;

/// Calls `run` with the rows of one index at a time. If `mixed` is above 1, up to that many rows of several indices share a call,
/// where each index has at most two rows.
///
/// Rows are those of `index`; a column of `inputs` or `outputs` that is empty stays empty. Long runs of one index are passed on as
/// they are. Other rows are copied in chunks of 256, by index, and their results copied back, so that hits in any order on a few
/// materials take little longer than hits in the order of their materials. The call takes 28 kB of stack for 10 inputs and 15
/// outputs.
///
/// For hosts whose tables hold materials of several models: `run` finds the material of the index, and makes the call.
///
/// ```
/// use hairis::columns::in_groups;
/// let (index, inputs, mut outputs) = ([7, 9, 7, 7, 9], [1.0, 2.0, 3.0, 4.0, 5.0], [0.0; 5]);
/// in_groups(&index, [&inputs], [&mut outputs], 1, |index, [input], [output]| {
///     let sum: f32 = input.iter().sum();
///     output.fill(sum + 100.0 * index[0] as f32);
/// });
/// assert_eq!(outputs, [708.0, 907.0, 708.0, 708.0, 907.0]);
/// ```
#[inline]
pub fn in_groups<const I: usize, const N: usize>(
    index: &[u32],
    inputs: [&[f32]; I],
    mut outputs: [&mut [f32]; N],
    mixed: usize,
    mut run: impl FnMut(&[u32], [&[f32]; I], [&mut [f32]; N]),
) {
    if alike(index) == index.len() {
        if !index.is_empty() {
            run(index, inputs, outputs);
        }
        return;
    }
    // Not for calls on one material, because clearing 28 kB takes as long as a hundred hits.
    let (mut from, mut to) = ([[0.0; ROWS]; I], [[0.0; ROWS]; N]);
    let mut at = 0;
    while let Some(rest) = index.get(at..).filter(|rest| !rest.is_empty()) {
        let alike = alike(rest);
        // A run of half a chunk gains little from rows of its material further on.
        if alike >= ROWS / 2 || alike == rest.len() {
            let outputs = outputs.each_mut().map(|column| part_mut(column, at, alike));
            run(
                part(rest, 0, alike),
                inputs.map(|column| part(column, at, alike)),
                outputs,
            );
            at += alike;
            continue;
        }
        let order = Order::of(rest);
        let rows = order.rows();
        let mut lens = [0; I];
        for ((column, from), len) in inputs.iter().zip(&mut from).zip(&mut lens) {
            *len = order.gather(part(column, at, rows.len()), from);
        }
        let mut first = 0;
        while let Some(rest) = rows.get(first..).filter(|rest| !rest.is_empty()) {
            let count = together(rest, mixed);
            let mut lens = lens.iter();
            let inputs = from.each_ref().map(|column| {
                let len = lens.next().copied().unwrap_or(0);
                part(part(column, 0, len), first, count)
            });
            let mut columns = outputs.iter();
            let outputs = to.each_mut().map(|column| {
                let is_there = columns.next().is_some_and(|column| !column.is_empty());
                part_mut(column, first, if is_there { count } else { 0 })
            });
            run(part(rest, 0, count), inputs, outputs);
            first += count;
        }
        for (column, to) in outputs.iter_mut().zip(&to) {
            order.scatter(to, part_mut(column, at, rows.len()));
        }
        at += rows.len();
    }
}

/// Returns a range of rows of a column, or no rows if the column is left out.
#[inline]
fn part<T>(column: &[T], first: usize, count: usize) -> &[T] {
    column.get(first..first + count).unwrap_or_default()
}

#[inline]
fn part_mut(column: &mut [f32], first: usize, count: usize) -> &mut [f32] {
    column.get_mut(first..first + count).unwrap_or_default()
}

/// Returns the number of rows, from the first on, that have the index of the first.
#[inline]
fn alike(index: &[u32]) -> usize {
    let is_first = |other: &&u32| index.first() == Some(*other);
    index.iter().take_while(is_first).count()
}

/// Returns the number of rows, sorted by index, that one call computes: the rows of the first index, or up to `mixed` rows of
/// indices with few.
#[inline]
fn together(index: &[u32], mixed: usize) -> usize {
    let first = alike(index);
    let mut count = first;
    while count < mixed {
        let next = alike(index.get(count..).unwrap_or_default());
        if first >= FEW || next == 0 || next >= FEW || count + next > mixed {
            break;
        }
        count += next;
    }
    count
}

/// Order of the next rows of a call in groups of one index; groups are in the order of their first rows.
struct Order {
    index: [u32; ROWS],
    /// Row of the call for each row of the order, below `ROWS`.
    places: [u8; ROWS],
    count: usize,
}

impl Order {
    #[inline]
    fn of(index: &[u32]) -> Self {
        const SLOTS: usize = 2 * ROWS;
        let count = index.len().min(ROWS);
        let mut order = Self {
            index: [0; ROWS],
            places: [0; ROWS],
            count,
        };
        // The group of each index is found by its hash. Half of the slots stay empty, so that every search ends.
        let (mut slots, mut known) = ([u16::MAX; SLOTS], [0_u32; ROWS]);
        let (mut group_of, mut sizes, mut groups) = ([0_u16; ROWS], [0_u16; ROWS], 0_u16);
        for (index, of) in index.iter().zip(&mut group_of) {
            let mut slot = (index.wrapping_mul(0x9e37_79b1) >> 16) as usize % SLOTS;
            let group = loop {
                let group = slots[slot];
                if group == u16::MAX {
                    slots[slot] = groups;
                    known[usize::from(groups) % ROWS] = *index;
                    groups += 1;
                    break groups - 1;
                }
                if known[usize::from(group) % ROWS] == *index {
                    break group;
                }
                slot = (slot + 1) % SLOTS;
            };
            *of = group;
            sizes[usize::from(group) % ROWS] += 1;
        }
        // The position of the next row of each group.
        let mut next = 0;
        for size in &mut sizes {
            (*size, next) = (next, next + *size);
        }
        for ((place, index), group) in (0..=u8::MAX).zip(index).zip(group_of) {
            let next = &mut sizes[usize::from(group) % ROWS];
            order.index[usize::from(*next) % ROWS] = *index;
            order.places[usize::from(*next) % ROWS] = place;
            *next += 1;
        }
        order
    }

    /// Returns the indices of the rows, in this order.
    #[inline]
    fn rows(&self) -> &[u32] {
        part(&self.index, 0, self.count)
    }

    /// Copies a column in this order. Returns the count of numbers copied, which is 0 for a column that is left out.
    #[inline]
    fn gather(&self, column: &[f32], to: &mut [f32; ROWS]) -> usize {
        let mut chunk = [0.0; ROWS];
        if let Some(chunk) = chunk.get_mut(..column.len()) {
            chunk.copy_from_slice(column);
        }
        for (to, place) in to.iter_mut().zip(&self.places) {
            *to = chunk[usize::from(*place) % ROWS];
        }
        column.len()
    }

    /// Copies results back to the order of the call.
    #[inline]
    fn scatter(&self, from: &[f32; ROWS], column: &mut [f32]) {
        let mut chunk = [0.0; ROWS];
        for (from, place) in from.iter().zip(part(&self.places, 0, self.count)) {
            chunk[usize::from(*place) % ROWS] = *from;
        }
        let len = column.len();
        if let Some(chunk) = chunk.get(..len) {
            column.copy_from_slice(chunk);
        }
    }
}
