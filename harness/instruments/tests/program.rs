//! Tests of `program`.

use hairis_instruments::program::remark_on_threads;
use std::ffi::OsStr;

#[test]
fn odd_counts_of_threads_are_reported() {
    let remark = |text: &str| remark_on_threads(OsStr::new(text), 4);
    for text in ["0", "1", "4"] {
        assert_eq!(remark(text), None, "{text}");
    }
    for text in ["", "four", "-1", "2.5", "1e1"] {
        let remark = remark(text).expect("no number");
        assert!(
            remark.contains(&format!("got {text:?}: using 4")),
            "{remark}"
        );
    }
    let above = remark("64").expect("too many");
    assert!(
        above.contains("at most 4") && above.contains("got 64"),
        "{above}"
    );
}
