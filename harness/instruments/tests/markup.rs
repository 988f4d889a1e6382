//! Tests of `markup`.

use hairis_instruments::markup::{escape, well_formed};

#[test]
fn hostile_text_is_inert() {
    let hostile = "</svg><script>alert('x' & \"y\")</script>\u{0}\u{1b}[31m]]>\nend";
    let safe = escape(hostile);
    assert!(
        !safe.contains(['<', '>', '"', '\'', '\u{0}', '\u{1b}']),
        "{safe}"
    );
    assert!(
        safe.ends_with(" end") && safe.starts_with("&lt;/svg&gt;&lt;script&gt;"),
        "{safe}"
    );
    assert_eq!(escape("θ ± 1°"), "θ ± 1°", "ordinary text stays as it is");
    assert_eq!(
        escape("&lt;"),
        "&amp;lt;",
        "nothing is taken for escaped already"
    );
}

#[test]
fn the_check_sees_faults() {
    assert!(
        well_formed("<a><b x=\"1\"/>text<br></a>").is_ok(),
        "this nests"
    );
    for bad in [
        "<a>",
        "</a>",
        "<a><b></a></b>",
        "<a x=\"1>",
        "a > b",
        "<a <b></b>",
    ] {
        assert!(well_formed(bad).is_err(), "{bad} does not nest");
    }
}
