//! Primaries of RGB colours, and the matrices between colour spaces.

use core::fmt;
use glam::{DMat3, DVec3};

/// Largest difference of two chromaticities that count as equal but for rounding.
const SAME: f64 = 5e-4;

/// CIE chromaticities x and y of red, green, blue and white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Primaries(pub(super) [[f64; 2]; 4]);

impl Primaries {
    /// Rec. ITU-R BT.709, the primaries of this crate and of files that name none.
    pub(super) const REC_709: Self =
        Self([[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]]);

    /// Returns the matrix from RGB to XYZ, in which white has a luminance of 1.
    ///
    /// # Errors
    /// Returns a message if the primaries span no colours, or white lies outside the colours that they span.
    pub(super) fn to_xyz(self) -> Result<DMat3, String> {
        let xyz = |[x, y]: [f64; 2]| DVec3::new(x, y, 1.0 - x - y);
        let [red, green, blue, white] = self.0.map(xyz);
        let directions = DMat3::from_cols(red, green, blue);
        let amounts = directions.inverse() * (white / white.y);
        if !(directions.determinant().abs() > 1e-6
            && amounts.is_finite()
            && amounts.min_element() > 0.0)
        {
            return Err(format!(
                "chromaticities must span a triangle around white, got {self}"
            ));
        }
        Ok(directions * DMat3::from_diagonal(amounts))
    }

    /// Returns the matrix to RGB with the Rec. 709 primaries, or `None` if these are the primaries already. Tristimulus values stay the
    /// same, so white becomes another colour unless it is that of Rec. 709.
    ///
    /// # Errors
    /// Returns the errors of [`to_xyz`](Self::to_xyz).
    pub(super) fn to_rec_709(self) -> Result<Option<DMat3>, String> {
        let to_xyz = self.to_xyz()?;
        let pairs = self
            .0
            .iter()
            .flatten()
            .zip(Self::REC_709.0.iter().flatten());
        if pairs.into_iter().all(|(a, b)| (a - b).abs() < SAME) {
            return Ok(None);
        }
        Ok(Some(xyz_to_rec_709() * to_xyz))
    }
}

/// Returns the matrix from XYZ to RGB with the Rec. 709 primaries.
pub(super) fn xyz_to_rec_709() -> DMat3 {
    Primaries::REC_709
        .to_xyz()
        .map_or(DMat3::IDENTITY, |matrix| matrix.inverse())
}

impl fmt::Display for Primaries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b, w] = self.0.map(|[x, y]| format!("{x:.4} {y:.4}"));
        write!(f, "red {r}, green {g}, blue {b}, white {w}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
