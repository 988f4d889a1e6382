//! Tests of `machine`.

use hairis_instruments::machine::{Machine, name_in_cpuinfo};

const COMMIT: &str = "0123456789abcdef0123456789abcdef01234567";

fn current() -> Machine {
    Machine::of_build([COMMIT, "no", "rustc 1.89.0", "3", "fxsr,sse2,avx2"])
}

#[test]
fn cpu_names_are_found_in_the_dialects_of_cpuinfo() {
    let x86 = "processor\t: 0\nvendor_id\t: X\nmodel\t\t: 85\nmodel name\t: Some(R)   CPU @ 2.70GHz\nflags\t: a b\n";
    assert_eq!(
        name_in_cpuinfo(x86).as_deref(),
        Some("Some(R) CPU @ 2.70GHz")
    );
    let arm = "processor\t: 0\nBogoMIPS\t: 108.00\nHardware\t: BCM2711\nModel\t: Raspberry Pi 4 Model B\n";
    assert_eq!(
        name_in_cpuinfo(arm).as_deref(),
        Some("Raspberry Pi 4 Model B")
    );
    assert_eq!(
        name_in_cpuinfo("cpu\t\t: POWER9, altivec supported\n").as_deref(),
        Some("POWER9, altivec supported")
    );
    assert_eq!(name_in_cpuinfo("model name\t:\nprocessor\t: 0\n"), None);
    assert_eq!(name_in_cpuinfo(""), None);
}

#[test]
fn the_current_machine_is_complete() {
    let m = current();
    assert!(!m.cpu.is_empty() && !m.os.is_empty() && !m.arch.is_empty() && m.logical_cores > 0);
    assert_eq!(
        (m.dirty, m.target_features.as_slice()),
        (Some(false), ["sse2", "avx2"].as_slice())
    );
    let summary = m.summary();
    assert!(
        summary.contains(&m.cpu) && summary.ends_with("rustc 1.89.0, commit 0123456789ab"),
        "{summary}"
    );
    assert_eq!(
        Machine::of_build([COMMIT, "unknown", "", "", ""]).dirty,
        None
    );
}

#[test]
fn it_serialises() {
    let json = serde_json::to_value(current()).expect("plain data");
    for key in [
        "cpu",
        "logical_cores",
        "os",
        "arch",
        "rustc",
        "opt_level",
        "commit",
        "dirty",
        "target_features",
    ] {
        assert!(json.get(key).is_some(), "{key}");
    }
}

#[test]
fn summaries_mark_changes_and_baseline() {
    let mut m = current();
    m.dirty = Some(true);
    m.target_features.clear();
    assert!(
        m.summary().ends_with("commit 0123456789ab+changes"),
        "{}",
        m.summary()
    );
    assert!(m.summary().contains("compiled for baseline"));
}
