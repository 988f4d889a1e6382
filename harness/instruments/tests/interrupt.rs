//! Tests of `interrupt`.

use hairis_instruments::interrupt::{Interrupt, Signal};

#[test]
fn the_first_signal_gives_the_exit_code_of_shells() {
    let interrupt = Interrupt::default();
    assert!(interrupt.check(|| unreachable!("no signal")).is_ok());
    interrupt.clone().raise(Signal::Terminate);
    interrupt.raise(Signal::Interrupt);
    let error = interrupt
        .check(|| "half is saved".to_owned())
        .expect_err("a signal");
    assert_eq!(error.exit_code(), 143);
    assert_eq!(error.to_string(), "interrupted by SIGTERM: half is saved");
}
