//! Primaries of RGB colours, and the matrices between colour spaces.

use core::fmt;
use glam::{DMat3, DVec3};

/// Largest difference of two chromaticities that count as equal but for rounding.
const SAME: f64 = 5e-4;

/// CIE chromaticities x and y of red, green, blue and white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primaries(pub [[f64; 2]; 4]);

impl Primaries {
    /// Rec. ITU-R BT.709, the primaries of this crate and of files that name none.
    pub const REC_709: Self = Self([[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]]);

    /// Returns the matrix from RGB to XYZ, in which white has a luminance of 1.
    ///
    /// # Errors
    /// Returns a message if the primaries span no colours, or white lies outside the colours that they span.
    pub fn to_xyz(self) -> Result<DMat3, String> {
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
    pub fn to_rec_709(self) -> Result<Option<DMat3>, String> {
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
