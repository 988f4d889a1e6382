//! A host without an operating system, in Rust: a material, a hit, a direction and a sample.
#![no_std]
#![no_main]

use core::ffi::{CStr, c_char};
use glam::Vec3;
use hairis::{Conserving, Gaussian, HairParams, Matched, Material};

core::arch::global_asm!(include_str!("start.s"), options(raw));

unsafe extern "C" {
    safe fn paint_stack();
    safe fn stack_used() -> u32;
    safe fn quit(code: i32) -> !;
    // The text ends with a zero.
    unsafe fn say(text: *const c_char);
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    quit(101)
}

fn print(name: &CStr, bits: u32) {
    let mut digits = *b"00000000\n\0";
    for (i, digit) in digits[..8].iter_mut().enumerate() {
        *digit = b"0123456789abcdef"[(bits >> (28 - 4 * i) & 15) as usize];
    }
    // SAFETY: both texts end with a zero.
    unsafe {
        say(name.as_ptr());
        say(digits.as_ptr().cast());
    }
}

#[unsafe(no_mangle)]
extern "C" fn host() -> i32 {
    let hair = Material::new(&Conserving(Matched::new(Gaussian)), &HairParams::brown());
    print(c"set-up, bytes of stack ", stack_used());

    paint_stack();
    let bsdf = hair.prepare(Vec3::new(0.6, 0.0, 0.8));
    let eval = bsdf.eval_pdf(Vec3::new(-0.6, 0.8, 0.0));
    let sample = bsdf.sample([0.3, 0.6, 0.9]);
    print(c"hit, bytes of stack ", stack_used());
    let Some(sample) = sample else { return 1 };
    print(c"value ", eval.value[0].to_bits());
    print(c"pdf ", eval.pdf.to_bits());
    print(c"wi.x ", sample.wi.x.to_bits());
    print(c"weight ", sample.weight[0].to_bits());
    0
}
