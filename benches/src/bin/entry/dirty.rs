//! Cost of entry points for a host that calls them with the upper halves of the vector registers dirty.
//!
//! Code for AVX should end in `vzeroupper`, but the code of some hosts does not (a just-in-time compiler was one). Until the upper
//! halves are clean, every legacy SSE instruction merges its result with the upper half of its register, and waits for the last write
//! to that half. CPUs before Skylake instead save and restore all upper halves once. Before each call the program either leaves all
//! sixteen registers dirty, or writes them in the same way and then zeroes their upper halves. Dirty registers must not slow packets
//! and slices down by more than the factor [`MOST`]; scalar code is not judged, because a plain build compiles it to legacy SSE.
#![allow(
    unsafe_code,
    reason = "assembly that writes the vector registers, where the CPU has them"
)]

use hairis_benches::{Name, Task};
use std::time::Instant;

/// Largest factor by which dirty registers may slow packets and slices down.
const MOST: f64 = 1.3;
/// Number of rounds, each of which times a clean and a dirty stretch.
const ROUNDS: usize = 31;
/// Duration of a stretch, in seconds.
const STRETCH: f64 = 3e-4;

/// Returns true if this CPU has AVX2, and so has upper halves that can be dirty.
pub(crate) fn can_be() -> bool {
    #[cfg(target_arch = "x86_64")]
    let has = std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    let has = false;
    has
}

/// Writes all sixteen registers in full, and zeroes their upper halves if `clean`. Requires a CPU that [has upper halves](can_be).
#[inline(always)]
fn write_registers(clean: bool) {
    #[cfg(target_arch = "x86_64")]
    macro_rules! ones {
        ($end:literal) => {
            // SAFETY: the registers written are clobbered, and no calling convention keeps an upper half.
            unsafe {
                core::arch::asm!(
                    "vpcmpeqd ymm0, ymm0, ymm0", "vpcmpeqd ymm1, ymm1, ymm1", "vpcmpeqd ymm2, ymm2, ymm2",
                    "vpcmpeqd ymm3, ymm3, ymm3", "vpcmpeqd ymm4, ymm4, ymm4", "vpcmpeqd ymm5, ymm5, ymm5",
                    "vpcmpeqd ymm6, ymm6, ymm6", "vpcmpeqd ymm7, ymm7, ymm7", "vpcmpeqd ymm8, ymm8, ymm8",
                    "vpcmpeqd ymm9, ymm9, ymm9", "vpcmpeqd ymm10, ymm10, ymm10", "vpcmpeqd ymm11, ymm11, ymm11",
                    "vpcmpeqd ymm12, ymm12, ymm12", "vpcmpeqd ymm13, ymm13, ymm13", "vpcmpeqd ymm14, ymm14, ymm14",
                    "vpcmpeqd ymm15, ymm15, ymm15", $end,
                    out("xmm0") _, out("xmm1") _, out("xmm2") _, out("xmm3") _, out("xmm4") _, out("xmm5") _,
                    out("xmm6") _, out("xmm7") _, out("xmm8") _, out("xmm9") _, out("xmm10") _, out("xmm11") _,
                    out("xmm12") _, out("xmm13") _, out("xmm14") _, out("xmm15") _,
                    options(nostack, nomem, preserves_flags),
                );
            }
        };
    }
    #[cfg(target_arch = "x86_64")]
    if clean {
        ones!("vzeroupper")
    } else {
        ones!("")
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = clean;
}

/// Times an entry point with clean and with dirty registers in turns, and prints the result. Returns true if it meets [`MOST`].
pub(crate) fn is_harmless<T: Task>(name: &Name, task: &mut T) -> bool {
    stretch(task, 1, true);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 1 to a thousand"
    )]
    let passes = (STRETCH / stretch(task, 1, true)).clamp(1.0, 1e3) as u32;
    let (mut ratios, mut times) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let [clean, dirty] = [true, false].map(|clean| stretch(task, passes, clean));
        ratios.push(dirty / clean);
        #[expect(clippy::cast_precision_loss, reason = "some thousand")]
        let calls = f64::from(passes) * task.calls() as f64;
        times.push(clean * 1e9 / calls);
    }
    let (ratio, ns) = (median(ratios), median(times));
    let verdict = if ratio > MOST { "FAIL" } else { "" };
    println!(
        "{:46} {ns:9.1} ns a call, dirty {:9.1} ns, {ratio:.2} times {verdict}",
        name.to_string(),
        ns * ratio
    );
    ratio <= MOST
}

/// Returns the time of `passes` passes, in seconds.
#[inline(never)]
fn stretch<T: Task>(task: &mut T, passes: u32, clean: bool) -> f64 {
    let start = Instant::now();
    for _ in 0..passes {
        for index in 0..task.calls() {
            write_registers(clean);
            task.call(index);
        }
    }
    // Clean up, so that the next stretch begins with clean registers.
    write_registers(true);
    start.elapsed().as_secs_f64()
}

fn median(mut x: Vec<f64>) -> f64 {
    x.sort_by(f64::total_cmp);
    x[x.len() / 2]
}
