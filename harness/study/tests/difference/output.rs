//! Rows and summaries of differences.

use hairis_study::difference::output::*;

#[test]
fn summaries_are_of_all_the_figures() {
    let found = Summary::of([8.0, 1.0, 2.0].into_iter());
    assert!(
        (found.geometric_mean - 16.0_f64.cbrt()).abs() < 1e-12,
        "{found:?}"
    );
    assert_eq!((found.median, found.least, found.most), (2.0, 1.0, 8.0));
}

#[test]
fn every_row_has_every_column() {
    let found = &*super::QUICK;
    let mut csv = Vec::new();
    found.columns().write_csv(&mut csv).expect("written");
    let fields: Vec<usize> = csv
        .split(|byte| *byte == b'\n')
        .map(|row| row.split(|b| *b == b',').count())
        .collect();
    assert_eq!(
        fields.len(),
        found.rows.len() + 2,
        "names, rows and the end"
    );
    assert!(
        fields[..=found.rows.len()]
            .iter()
            .all(|count| *count == fields[0]),
        "ragged"
    );
    for table in found.tables() {
        let text = table.to_text(Some(u16::MAX));
        assert!(text.lines().count() > 4 && !text.contains("n/a"), "{text}");
    }
}
