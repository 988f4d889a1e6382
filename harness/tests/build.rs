//! Record of the build.

#[test]
fn the_build_is_recorded() {
    let machine = hairis_instruments::machine!();
    assert!(
        machine.rustc == "unknown" || machine.rustc.starts_with("rustc "),
        "{}",
        machine.rustc
    );
    let is_hash =
        machine.commit.len() >= 40 && machine.commit.bytes().all(|byte| byte.is_ascii_hexdigit());
    assert!(machine.commit == "unknown" || is_hash, "{}", machine.commit);
    assert_eq!(
        machine.target_features.contains(&"sse2"),
        cfg!(target_feature = "sse2")
    );
}
