//! Tests of `record`.

use hairis_instruments::machine::Machine;
use hairis_instruments::record;

#[test]
fn a_record_names_what_it_depends_on() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("some.csv");
    let commit = "0123456789abcdef0123456789abcdef01234567";
    let machine = Machine::of_build([commit, "no", "rustc 1.89.0", "3", "sse2"]);
    let rows = ["1,2", "3,4"].map(str::to_owned);
    record::write(&path, &machine, "numbers", "a,b", &rows).expect("written");
    let text = std::fs::read_to_string(&path).expect("written");
    let [cpu, commit, date, rest @ ..] = &text.lines().collect::<Vec<_>>()[..] else {
        panic!("{text}")
    };
    assert_eq!(*cpu, format!("# CPU: {}", machine.cpu));
    assert_eq!(*commit, "# commit: 01234567");
    assert!(
        date.starts_with("# date: 2") && date.len() == "# date: 2026-11-30".len(),
        "{date}"
    );
    assert_eq!(rest, ["# numbers", "a,b", "1,2", "3,4"]);
}
