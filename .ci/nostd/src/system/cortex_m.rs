//! Cortex-M under QEMU: a vector table, and output and exit by semihosting.

use core::arch::{asm, global_asm};

global_asm!(
    ".section .vectors,\"a\"",
    ".word _stack_top",
    ".word reset",
    ".rept 14",
    ".word fault",
    ".endr",
    ".section .text.reset,\"ax\"",
    ".thumb_func",
    ".globl reset",
    "reset:",
    // The FPU on: CPACR.
    "ldr r0, =0xE000ED88",
    "ldr r1, [r0]",
    "orr r1, r1, #0xf00000",
    "str r1, [r0]",
    "dsb",
    "isb",
    // QEMU loads .data in place; .bss is zeroed here.
    "ldr r0, =_sbss",
    "ldr r1, =_ebss",
    "movs r2, #0",
    "1:",
    "cmp r0, r1",
    "bhs 2f",
    "str r2, [r0], #4",
    "b 1b",
    "2:",
    "bl {main}",
    ".thumb_func",
    "fault:",
    "b {fault}",
    main = sym main,
    fault = sym fault,
);

extern "C" fn main() -> ! {
    exit(crate::start())
}

extern "C" fn fault() -> ! {
    write(b"fault\n");
    exit(102)
}

fn host(operation: usize, argument: usize) {
    // SAFETY: the host reads memory of ours, and writes r0 alone.
    unsafe { asm!("bkpt #0xab", inlateout("r0") operation => _, in("r1") argument) };
}

pub fn exit(code: i32) -> ! {
    /// The reason that stands for an end of the program's own.
    const APPLICATION_EXIT: usize = 0x20026;
    let block = [APPLICATION_EXIT, code as usize];
    loop {
        host(0x20, block.as_ptr() as usize);
    }
}

pub fn write(text: &[u8]) {
    for byte in text {
        host(3, core::ptr::from_ref(byte) as usize);
    }
}
