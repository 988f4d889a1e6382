//! Tests of `columns`.

use hairis_instruments::columns::Columns;

fn example() -> Columns {
    Columns::default()
        .text("light", ["sun", "a \"sky\", cloudy"])
        .whole("cell", [0, 3023])
        .number("v", [1e-40, f64::NAN])
        .number("beta", [2.5, 1.0 / 3.0])
}

#[test]
fn csv_is_quoted_and_exact_and_what_is_missing_is_empty() {
    let mut out = Vec::new();
    example().write_csv(&mut out).expect("written");
    let text = String::from_utf8(out).expect("UTF-8");
    let want =
        "light,cell,v,beta\nsun,0,1e-40,2.5\n\"a \"\"sky\"\", cloudy\",3023,,0.3333333333333333\n";
    assert_eq!(text, want);
}

#[test]
fn names_of_columns_are_quoted_as_well() {
    let columns = Columns::default()
        .number("a, \"b\"", [1.0])
        .estimate("V\n", [hairis_instruments::stats::Estimate::exact(2.0)]);
    let mut out = Vec::new();
    columns.write_csv(&mut out).expect("written");
    let text = String::from_utf8(out).expect("UTF-8");
    assert_eq!(text, "\"a, \"\"b\"\"\",\"V\n\",\"V\n_se\"\n1.0,2.0,0.0\n");
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_is_the_same_bytes_each_time() {
    let bytes = || {
        let mut out = Vec::new();
        example()
            .write_parquet(vec![("a".to_owned(), "b".to_owned())], &mut out)
            .expect("written");
        out
    };
    let first = bytes();
    assert!(
        first.starts_with(b"PAR1") && first.ends_with(b"PAR1"),
        "the format's mark"
    );
    assert_eq!(first, bytes());
}
