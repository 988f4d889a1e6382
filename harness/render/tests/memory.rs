//! Tests of `memory`.

use hairis_render::memory::{check_within, of_machine};

#[test]
fn what_does_not_fit_is_refused_with_both_sizes() {
    assert!(
        check_within(1_000_000, 1_000_000, 500_000_000).is_ok(),
        "half a gigabyte holds it"
    );
    let problem = check_within(1_000_000, 1_000_000, 400_000_000)
        .expect_err("more than there is")
        .to_string();
    assert!(
        problem.contains("0.4 GB") && problem.contains("1000000 segments"),
        "{problem}"
    );
    assert!(
        check_within(u64::MAX, u64::MAX, u64::MAX - 1).is_err(),
        "the sum saturates"
    );
}

#[test]
fn the_memory_of_the_machine_is_read() {
    assert_eq!(
        of_machine("MemTotal: 9 kB\nMemAvailable:       2 kB\n"),
        Some(2048)
    );
    assert_eq!(of_machine("MemAvailable: many\n"), None);
    assert_eq!(of_machine(""), None);
}
