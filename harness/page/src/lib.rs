//! Kernels as a WebAssembly module, whose functions take numbers and exchange arrays through linear memory.
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

/// Traps. No input leads to a panic, but `core` contains code that panics.
#[cfg(target_arch = "wasm32")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}

/// Writes the list of models, their fields and presets, and the artist's controls as JSON. Returns the length of the text.
#[unsafe(no_mangle)]
pub extern "C" fn describe() -> usize {
    let text = memory().text;
    text.clear();
    describe::write(text);
    text.len
}

/// Returns the address of the text that the last call wrote, as UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    memory().text.bytes.as_ptr()
}

/// Returns the address of the numbers of parameters, in the order of the fields.
#[unsafe(no_mangle)]
pub extern "C" fn numbers() -> *mut f32 {
    memory().numbers.as_mut_ptr()
}

/// Returns the address of the columns of a slot's map: three of directions, three of values, and one of densities. Only the lowest bit
/// of `slot` counts.
#[unsafe(no_mangle)]
pub extern "C" fn map(slot: usize) -> *mut f32 {
    memory().maps[slot & 1].as_flattened_mut().as_mut_ptr()
}

/// Returns the address of the columns for everything else, which each function below uses in its own way.
#[unsafe(no_mangle)]
pub extern "C" fn work() -> *mut f32 {
    memory().work.as_flattened_mut().as_mut_ptr()
}

/// Returns the number of `f32` values from the start of a column to the start of the next.
#[unsafe(no_mangle)]
pub extern "C" fn column() -> usize {
    COLUMN
}

/// Sets the material of a slot: a model of the list, with those fields of `numbers` whose bit is set in `given`.
///
/// Returns 0, or the length of an error message, in which case the slot keeps its material.
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

/// Converts an artist's controls to parameters: reads the controls from `numbers` and replaces them by the numbers of the fields.
///
/// Returns 0, or the length of an error message.
#[unsafe(no_mangle)]
pub extern "C" fn from_artist() -> usize {
    let Memory { numbers, text, .. } = memory();
    text.clear();
    if let Err(error) = artist::params(numbers) {
        text.say(&format_args!("{error}"));
    }
    text.len
}

/// Writes the artist's controls of a slot's material to `numbers`, or those of the default hair if the model has no such controls.
#[unsafe(no_mangle)]
pub extern "C" fn to_artist(slot: usize) {
    let Memory { slots, numbers, .. } = memory();
    let controls = artist::controls(&slots[slot & 1].hair());
    numbers[..controls.len()].copy_from_slice(&controls);
}

/// Sets the view of a slot: `wo` in the frame of the fibre, the offset `h`, and one bit per lobe that is switched on.
#[unsafe(no_mangle)]
pub extern "C" fn set_view(slot: usize, x: f32, y: f32, z: f32, h: f32, lobes: u32) {
    let slot = &mut memory().slots[slot & 1];
    slot.hit = Hit::new(glam::Vec3::new(x, y, z), h);
    slot.lobes = lobes;
}

/// Evaluates values and densities of `count` directions in a slot's map, or in columns of `work` in the same order.
///
/// The sampler of `model` may differ from that of the slot's model.
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

/// Draws samples with `count` triples of uniform numbers from the first three columns of `work`. The next eight columns receive
/// direction, weight, density and slot of the lobe.
#[unsafe(no_mangle)]
pub extern "C" fn sample(slot: usize, model: usize, count: usize) {
    let Memory { slots, work, .. } = memory();
    (Calls::of(model_at(model)).sample)(&slots[slot & 1], work, count.min(COLUMN));
}

/// Evaluates `count` hits on a slot's material, each with a view and a direction of its own. The columns of `work` are `wo`, `h` and
/// `wi`, followed by the values.
#[unsafe(no_mangle)]
pub extern "C" fn eval_hits(slot: usize, count: usize) {
    let Memory { slots, work, .. } = memory();
    let slot = &slots[slot & 1];
    (Calls::of(slot.first()).hits)(slot, work, count.min(COLUMN));
}

/// Computes the directional albedos of all lobes in linear RGB, for `count` inclinations of the view. The first column of `work`
/// holds the sines of the inclinations; up to twelve columns follow, by lobe and channel.
#[unsafe(no_mangle)]
pub extern "C" fn albedos(slot: usize, count: usize) {
    let Memory { slots, work, .. } = memory();
    let slot = &slots[slot & 1];
    (Calls::of(slot.first()).albedos)(slot, work, count.min(COLUMN));
}

/// Writes the constants of a slot's material to the first column of `work`, in the order in which generated shaders take them. Returns
/// the number of constants.
#[unsafe(no_mangle)]
pub extern "C" fn constants(slot: usize) -> usize {
    let Memory { slots, work, .. } = memory();
    let slot = &slots[slot & 1];
    (Calls::of(slot.first()).constants)(slot, &mut work[0])
}

/// Measures dual scattering of a slot's material, scaled so that no viewer gets back more light than arrives, and writes its averages to the
/// first column of `work`, in the order in which the generated shader takes them. Returns their number.
#[cfg(feature = "dual")]
#[unsafe(no_mangle)]
pub extern "C" fn dual_scattering(slot: usize) -> usize {
    let Memory { slots, work, .. } = memory();
    let slot = &slots[slot & 1];
    (Calls::of(slot.first()).dual)(slot, &mut work[0])
}
