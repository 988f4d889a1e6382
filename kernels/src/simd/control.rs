//! Floating-point control register of x86-64, for tests: rounding, denormals, and flags of exceptions.
#![allow(unsafe_code, reason = "the register has no safe access")]

/// Returns the bits of the control register, and 0 on targets other than x86-64.
#[inline(never)]
#[must_use]
pub fn control() -> u32 {
    #[cfg_attr(
        not(target_arch = "x86_64"),
        expect(unused_mut, reason = "there is no register to read")
    )]
    let mut register = 0;
    #[cfg(target_arch = "x86_64")]
    // SAFETY: every x86-64 CPU has the register.
    unsafe {
        core::arch::asm!("stmxcsr [{}]", in(reg) &raw mut register, options(nostack));
    }
    register
}

/// Sets rounding, denormals and flags; exceptions stay masked. The compiler moves no write to memory across the call.
#[inline(never)]
pub fn set_control(register: u32) {
    let register = register | 0x1f80;
    #[cfg(target_arch = "x86_64")]
    // SAFETY: as above. The caller restores the register before it depends on results.
    unsafe {
        core::arch::asm!("ldmxcsr [{}]", in(reg) &raw const register, options(nostack));
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = register;
}
