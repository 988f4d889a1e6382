//! Memory of the module: one static piece, whose arrays are visible to the host.

use crate::slot::Slot;
use core::cell::UnsafeCell;
use core::fmt;
use hairis_variants::Values;

/// Number of `f32` values from the start of a column to the start of the next: a map of 512 by 256, and some more. The excess keeps
/// columns from meeting at the same addresses modulo 4 KiB.
pub(crate) const COLUMN: usize = 512 * 256 + 48;

/// Number of numbers that a material has at most.
pub(crate) const NUMBERS: usize = Values::MOST;

/// Exclusive references to everything that the module keeps between calls.
pub(crate) struct Memory {
    pub(crate) text: &'static mut Text,
    pub(crate) numbers: &'static mut [f32; NUMBERS],
    pub(crate) slots: &'static mut [Slot; 2],
    pub(crate) maps: &'static mut [[[f32; COLUMN]; 7]; 2],
    pub(crate) work: &'static mut [[f32; COLUMN]; 14],
}

/// Text for the host, cut off where the buffer is full.
pub(crate) struct Text {
    pub(crate) bytes: [u8; 1 << 16],
    pub(crate) len: usize,
}

impl Text {
    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    pub(crate) fn say(&mut self, text: &fmt::Arguments<'_>) {
        // Writing never fails.
        let _ = fmt::Write::write_fmt(self, *text);
    }
}

impl fmt::Write for Text {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let free = &mut self.bytes[self.len..];
        let count = text.len().min(free.len());
        free[..count].copy_from_slice(&text.as_bytes()[..count]);
        self.len += count;
        Ok(())
    }
}

/// Memory that starts as zeros and therefore takes no space in the file.
struct Zeros {
    text: Text,
    numbers: [f32; NUMBERS],
    maps: [[[f32; COLUMN]; 7]; 2],
    work: [[f32; COLUMN]; 14],
}

/// Value to which one call at a time holds the only reference.
struct Single<T>(UnsafeCell<T>);

// SAFETY: the module has one thread.
unsafe impl<T> Sync for Single<T> {}

static ZEROS: Single<Zeros> = Single(UnsafeCell::new(Zeros {
    text: Text {
        bytes: [0; 1 << 16],
        len: 0,
    },
    numbers: [0.0; NUMBERS],
    maps: [[[0.0; COLUMN]; 7]; 2],
    work: [[0.0; COLUMN]; 14],
}));
static SLOTS: Single<[Slot; 2]> = Single(UnsafeCell::new([Slot::NONE; 2]));

/// Returns the memory for the duration of one call from the host.
pub(crate) fn memory() -> Memory {
    // SAFETY: each function of the module calls this once, and no function of the module calls another.
    let (zeros, slots) = unsafe { (&mut *ZEROS.0.get(), &mut *SLOTS.0.get()) };
    Memory {
        text: &mut zeros.text,
        numbers: &mut zeros.numbers,
        slots,
        maps: &mut zeros.maps,
        work: &mut zeros.work,
    }
}
