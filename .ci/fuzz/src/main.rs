//! One fuzzer for everything that takes input: the first byte of an input chooses the target, the rest is its data.
//!
//! A panic, an overflow, a result that is not finite or is negative, a run that takes too long and one that takes too much
//! memory are findings. See .ci/fuzz.sh.
#![no_main]

mod kernels;
#[cfg(feature = "readers")]
mod readers;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let Some((target, data)) = input.split_first() else {
        return;
    };
    match target {
        b'k' => kernels::fuzz(data),
        #[cfg(feature = "readers")]
        b'e' => readers::lines(data),
        #[cfg(feature = "readers")]
        b'p' => readers::parts(data),
        #[cfg(feature = "readers")]
        b'm' => readers::map(data),
        #[cfg(feature = "readers")]
        b'h' => readers::hair(data),
        #[cfg(feature = "readers")]
        b'r' => readers::picture(data),
        _ => {}
    }
});
