//! Choice of one of four entries per lane: by bounds that a number is compared with, and from tables.

use super::storage::Shared;

/// Part of [`Lanes`](super::Lanes) that choices are made by. All lanes have it, and other crates cannot name it.
pub trait Select: Copy {
    /// One truth value per lane.
    type Mask: Copy;
    /// An index from 0 to 3 per lane.
    type Index;
    /// Repeats a number in every lane.
    fn splat(x: f32) -> Self;
    /// Returns `yes` where the mask is set and `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
}

/// An index from 0 to 3 per lane of `L`.
pub trait Choice<L: Select<Index = Self>>: Copy {
    /// Counts the first `count` of the ascending `bounds` that are at most `x`.
    fn search(x: L, bounds: [L; 3], count: usize) -> Self;
    /// Returns the masks of the lanes whose index is at least 1, 2 and 3.
    fn masks(self) -> [L::Mask; 3];
    /// Returns the mask of the lanes whose index is `entry`, 0 to 3.
    fn equals(self, entry: usize) -> L::Mask;
    /// Returns the index as a number: 0, 1, 2 or 3.
    fn to_number(self) -> L;

    /// Returns, for each lane, the entry at the lane's index.
    #[inline(always)]
    fn choose(self, table: [L; 4]) -> L {
        let [one, two, three] = self.masks();
        L::select(
            two,
            L::select(three, table[3], table[2]),
            L::select(one, table[1], table[0]),
        )
    }
    /// Returns, for each lane, the entry at the lane's index, where 2 and 3 share the last entry.
    #[inline(always)]
    fn choose_three(self, table: [L; 3]) -> L {
        let [one, two, _] = self.masks();
        L::select(two, table[2], L::select(one, table[1], table[0]))
    }
    /// Returns the entry at half of each lane's index: the first entry for 0 and 1, the second for 2 and 3.
    #[inline(always)]
    fn choose_half(self, [low, high]: [L; 2]) -> L {
        L::select(self.masks()[1], high, low)
    }
    /// Returns the entry like [`choose`](Self::choose), of numbers that all lanes share.
    #[inline(always)]
    fn look_up(self, table: &[f32; 4]) -> L {
        self.choose([
            L::splat(table[0]),
            L::splat(table[1]),
            L::splat(table[2]),
            L::splat(table[3]),
        ])
    }
    /// Returns, for each lane, the entry at the lane's index, which counts 4 more where the mask is set.
    #[doc(hidden)]
    #[inline(always)]
    fn look_up_eight(self, upper: L::Mask, table: &[f32; 8]) -> L {
        let [low, high] = halves(table);
        L::select(upper, self.look_up(&high), self.look_up(&low))
    }
    /// Returns four numbers of the entry at each lane's index, which counts 4 more where the mask is set: the first, second, third
    /// or last four of sixteen, of which the last is 0.
    #[doc(hidden)]
    #[inline(always)]
    fn look_up_four(self, upper: L::Mask, table: &Shared, four: usize) -> [L; 4] {
        let [a, b, c, d] = &table.columns[four];
        [
            self.look_up_eight(upper, a),
            self.look_up_eight(upper, b),
            self.look_up_eight(upper, c),
            self.look_up_eight(upper, d),
        ]
    }
    /// Returns the entry like [`look_up`](Self::look_up), of a table whose last two entries are equal.
    #[inline(always)]
    fn look_up_three(self, table: &[f32; 4]) -> L {
        self.choose_three([L::splat(table[0]), L::splat(table[1]), L::splat(table[2])])
    }
    /// Returns the entry like [`choose_half`](Self::choose_half), of numbers that all lanes share.
    #[inline(always)]
    fn look_up_half(self, table: &[f32; 2]) -> L {
        self.choose_half([L::splat(table[0]), L::splat(table[1])])
    }
}

/// Splits eight entries into the first four and the last four.
#[inline(always)]
fn halves<C: Copy>([a, b, c, d, e, f, g, h]: &[C; 8]) -> [[C; 4]; 2] {
    [[*a, *b, *c, *d], [*e, *f, *g, *h]]
}
