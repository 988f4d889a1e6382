//! Tests of `pixels::primaries`.

use glam::{DMat3, DVec3};
use hairis_instruments::pixels::Primaries;

#[test]
fn matrices_are_those_of_the_standards() {
    // SMPTE RP 177 for Rec. 709; ACES S-2014-004 for AP1 to XYZ.
    let rec_709 = Primaries::REC_709.to_xyz().expect("valid");
    assert!(
        rec_709
            .row(1)
            .abs_diff_eq(DVec3::new(0.212_639, 0.715_169, 0.072_192), 1e-6)
    );
    let ap1 = Primaries([
        [0.713, 0.293],
        [0.165, 0.83],
        [0.128, 0.044],
        [0.32168, 0.33767],
    ]);
    let to_xyz = ap1.to_xyz().expect("valid");
    let published = DMat3::from_cols_array_2d(&[
        [0.662_454_181_1, 0.272_228_716_8, -0.005_574_649_5],
        [0.134_004_206_5, 0.674_081_765_8, 0.004_060_733_5],
        [0.156_187_687_0, 0.053_689_517_4, 1.010_339_100_3],
    ]);
    assert!(to_xyz.abs_diff_eq(published, 1e-9), "{to_xyz}");
    assert_eq!(Primaries::REC_709.to_rec_709(), Ok(None));
    assert!(ap1.to_rec_709().expect("valid").is_some());
    // XYZ written as primaries.
    let xyz = Primaries([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0; 2]]);
    assert!(
        xyz.to_xyz()
            .expect("valid")
            .abs_diff_eq(DMat3::IDENTITY, 1e-12)
    );
}

#[test]
fn primaries_without_colours_are_refused() {
    let [r, g, b, w] = Primaries::REC_709.0;
    for primaries in [
        [[0.0; 2]; 4],
        [r, g, r, w],
        [r, g, b, [0.3, 0.0]],
        [r, g, b, [f64::NAN; 2]],
        [r, g, b, [0.7, 0.3]],
        [r, [f64::INFINITY, 0.6], b, w],
    ] {
        let error = Primaries(primaries).to_rec_709().expect_err("refused");
        assert!(
            error.contains("must span a triangle around white"),
            "{error}"
        );
    }
}
