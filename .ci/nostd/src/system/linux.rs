//! Linux without libc: an entry point and two system calls per architecture.

use core::arch::{asm, global_asm};

/// Numbers of `write` and `exit_group`.
#[cfg(target_arch = "x86_64")]
const CALLS: [usize; 2] = [1, 231];
#[cfg(target_arch = "x86")]
const CALLS: [usize; 2] = [4, 252];
#[cfg(any(target_arch = "aarch64", target_arch = "riscv64"))]
const CALLS: [usize; 2] = [64, 94];
#[cfg(any(target_arch = "arm", target_arch = "s390x"))]
const CALLS: [usize; 2] = [4, 248];

#[cfg(target_arch = "x86_64")]
global_asm!(".globl _start", "_start:", "xor ebp, ebp", "and rsp, -16", "call {main}", "ud2", main = sym main);
#[cfg(target_arch = "x86")]
global_asm!(".globl _start", "_start:", "xor ebp, ebp", "and esp, -16", "call {main}", "ud2", main = sym main);
#[cfg(target_arch = "aarch64")]
global_asm!(".globl _start", "_start:", "bl {main}", main = sym main);
#[cfg(target_arch = "arm")]
global_asm!(".globl _start", "_start:", "bic sp, sp, #7", "bl {main}", main = sym main);
#[cfg(target_arch = "riscv64")]
global_asm!(
    ".globl _start",
    "_start:",
    ".option push",
    ".option norelax",
    "la gp, __global_pointer$",
    ".option pop",
    "andi sp, sp, -16",
    "call {main}",
    main = sym main,
);
#[cfg(target_arch = "s390x")]
global_asm!(".globl _start", "_start:", "aghi %r15, -160", "brasl %r14, {main}", main = sym main);

extern "C" fn main() -> ! {
    exit(crate::start())
}

/// A system call of three arguments.
fn call(number: usize, arguments: [usize; 3]) {
    let [a, b, c] = arguments;
    // SAFETY: the two calls made here read memory of ours or do not return; the registers that the kernel writes are named.
    unsafe {
        #[cfg(target_arch = "x86_64")]
        asm!("syscall", inlateout("rax") number => _, in("rdi") a, in("rsi") b, in("rdx") c, lateout("rcx") _, lateout("r11") _);
        #[cfg(target_arch = "x86")]
        asm!("int 0x80", inlateout("eax") number => _, in("ebx") a, in("ecx") b, in("edx") c);
        #[cfg(target_arch = "aarch64")]
        asm!("svc 0", in("x8") number, inlateout("x0") a => _, in("x1") b, in("x2") c);
        #[cfg(target_arch = "arm")]
        asm!("svc 0", in("r7") number, inlateout("r0") a => _, in("r1") b, in("r2") c);
        #[cfg(target_arch = "riscv64")]
        asm!("ecall", in("a7") number, inlateout("a0") a => _, in("a1") b, in("a2") c);
        #[cfg(target_arch = "s390x")]
        asm!("svc 0", in("r1") number, inlateout("r2") a => _, in("r3") b, in("r4") c);
    }
}

pub fn exit(code: i32) -> ! {
    loop {
        call(CALLS[1], [code as usize, 0, 0]);
    }
}

pub fn write(text: &[u8]) {
    call(CALLS[0], [1, text.as_ptr() as usize, text.len()]);
}
