//! The kernels as a WebAssembly module: numbers in linear memory, and functions of numbers.
//!
//! The host writes parameters, directions and random numbers into the arrays that `numbers`, `map` and `work` point to, calls a
//! function, and reads results from the same arrays. Every function runs to its end before the host calls the next.
#![cfg_attr(target_arch = "wasm32", no_std)]

mod artist;
mod calls;
mod describe;
mod memory;
mod slot;

use calls::{Calls, model_at};
use hairis::Hit;
use memory::{COLUMN, Memory, memory};

/// No input panics, but `core` has code for it.
#[cfg(target_arch = "wasm32")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}

/// The list of models, their fields and presets, and the artist's controls, as JSON; returns the length of the text.
#[unsafe(no_mangle)]
pub extern "C" fn describe() -> usize {
    let text = memory().text;
    text.clear();
    describe::write(text);
    text.len
}

/// Text that the last call left: UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    memory().text.bytes.as_ptr()
}

/// Numbers of parameters, in the order of the fields.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() -> *mut f32 {
    memory().numbers.as_mut_ptr()
}

/// Columns of the map of slot 0 or 1: three of directions, three of values, one of densities.
#[unsafe(no_mangle)]
pub extern "C" fn map(slot: usize) -> *mut f32 {
    memory().maps[slot & 1].as_flattened_mut().as_mut_ptr()
}

/// Columns of everything else, as the functions below use them.
#[unsafe(no_mangle)]
pub extern "C" fn work() -> *mut f32 {
    memory().work.as_flattened_mut().as_mut_ptr()
}

/// Numbers from the start of a column to that of the next.
#[unsafe(no_mangle)]
pub extern "C" fn column() -> usize {
    COLUMN
}

/// Sets the material of a slot: a model of the list with the `numbers` of the fields whose bit is set in `given`.
///
/// Returns 0, or the length of a refusal; the slot keeps its material then.
#[unsafe(no_mangle)]
pub extern "C" fn set_material(slot: usize, model: usize, given: u32) -> usize {
    let Memory {
        slots,
        numbers,
        text,
        ..
    } = memory();
    text.clear();
    let slot = &mut slots[slot & 1];
    if let Err(error) = slot.set(model_at(model), numbers, given) {
        text.say(&format_args!("{error}"));
    }
    text.len
}

/// The parameters of an artist's controls, which are read from `numbers` and replaced by the numbers of the fields.
///
/// Returns 0, or the length of a refusal.
#[unsafe(no_mangle)]
pub extern "C" fn from_artist() -> usize {
    let Memory { numbers, text, .. } = memory();
    text.clear();
    if let Err(error) = artist::params(numbers) {
        text.say(&format_args!("{error}"));
    }
    text.len
}

/// The artist's controls of a slot's material, in `numbers`; of the default hair if its model has none.
#[unsafe(no_mangle)]
pub extern "C" fn to_artist(slot: usize) {
    let Memory { slots, numbers, .. } = memory();
    let controls = artist::controls(&slots[slot & 1].hair());
    numbers[..controls.len()].copy_from_slice(&controls);
}

/// Sets the view of a slot: `wo` in the frame of the fibre, the offset `h`, and the lobes as bits.
#[unsafe(no_mangle)]
pub extern "C" fn set_view(slot: usize, x: f32, y: f32, z: f32, h: f32, lobes: u32) {
    let slot = &mut memory().slots[slot & 1];
    slot.hit = Hit::new(glam::Vec3::new(x, y, z), h);
    slot.lobes = lobes;
}

/// Values and densities of `count` directions of a slot's map, or of `work` with columns in the same order.
///
/// `model` may have another sampler than the slot's.
#[unsafe(no_mangle)]
pub extern "C" fn eval(slot: usize, model: usize, of_map: bool, count: usize) {
    let Memory {
        slots, maps, work, ..
    } = memory();
    let columns = if of_map {
        &mut maps[slot & 1][..]
    } else {
        &mut work[..]
    };
    (Calls::of(model_at(model)).eval)(&slots[slot & 1], columns, count.min(COLUMN));
}

/// Samples of `count` triples of uniform numbers in the first three columns of `work`; then follow direction, weight, density and
/// slot of the lobe, in eight columns.
#[unsafe(no_mangle)]
pub extern "C" fn sample(slot: usize, model: usize, count: usize) {
    let Memory { slots, work, .. } = memory();
    (Calls::of(model_at(model)).sample)(&slots[slot & 1], work, count.min(COLUMN));
}

/// Values of `count` hits on a slot's material, each with a view and a direction of its own: `wo` in the first three columns of
/// `work`, then `h`, `wi`, and the results.
#[unsafe(no_mangle)]
pub extern "C" fn eval_hits(slot: usize, count: usize) {
    let Memory { slots, work, .. } = memory();
    let slot = &slots[slot & 1];
    (Calls::of(slot.first()).hits)(slot, work, count.min(COLUMN));
}

/// Directional albedos of all four lobes, linear RGB, for `count` inclinations of the view, whose sines are in the first column of
/// `work`: twelve columns follow, by lobe and channel.
#[unsafe(no_mangle)]
pub extern "C" fn albedos(slot: usize, count: usize) {
    let Memory { slots, work, .. } = memory();
    let slot = &slots[slot & 1];
    (Calls::of(slot.first()).albedos)(slot, work, count.min(COLUMN));
}

/// Constants of a slot's material, in the order in which generated shaders take them, in the first column of `work`; returns their
/// count.
#[unsafe(no_mangle)]
pub extern "C" fn constants(slot: usize) -> usize {
    let Memory { slots, work, .. } = memory();
    let slot = &slots[slot & 1];
    (Calls::of(slot.first()).constants)(slot, &mut work[0])
}
