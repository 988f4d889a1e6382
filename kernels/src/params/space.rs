//! Spaces of linear RGB, between which colours of pigment are converted.

use super::Pigments;
use super::error::ParamError;

/// Space of linear RGB: CIE 1931 chromaticities of its primaries and of its white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbSpace {
    /// Chromaticities x and y of red, green and blue.
    pub primaries: [[f64; 2]; 3],
    /// Chromaticity of white.
    pub white: [f64; 2],
}

/// Bradford's responses of cones to CIE XYZ.
const CONES: Matrix = [
    [0.8951, 0.2664, -0.1614],
    [-0.7502, 1.7135, 0.0367],
    [0.0389, -0.0685, 1.0296],
];

/// Rows of a matrix.
type Matrix = [[f64; 3]; 3];

impl RgbSpace {
    /// Linear RGB of ITU-R BT.709 and sRGB, with the white D65.
    pub const REC_709: Self = Self {
        primaries: [[0.64, 0.33], [0.3, 0.6], [0.15, 0.06]],
        white: [0.3127, 0.329],
    };
    /// `ACEScg`: AP1 with the white of ACES, of SMPTE ST 2065-1 and S-2014-004.
    pub const ACES_CG: Self = Self {
        primaries: [[0.713, 0.293], [0.165, 0.83], [0.128, 0.044]],
        white: [0.32168, 0.33767],
    };

    /// Returns the rows of the matrix that converts colours of this space to those of another. Where the whites differ, cones adapt after
    /// Bradford, so that white stays white.
    ///
    /// - Domain: primaries that form a triangle, and chromaticities y above 0.
    /// - Accuracy: 1e-12.
    ///
    /// ```
    /// use hairis::params::RgbSpace;
    /// let [red, ..] = RgbSpace::REC_709.to(&RgbSpace::ACES_CG);
    /// assert!((red[0] - 0.613_1).abs() < 1e-4 && (red.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    /// ```
    #[inline]
    #[must_use]
    pub fn to(&self, other: &Self) -> [[f64; 3]; 3] {
        let [from, to] = [self, other].map(|space| applied(&CONES, xyz(space.white)));
        let adapted = [0, 1, 2].map(|cone| CONES[cone].map(|x| x * to[cone] / from[cone]));
        let adapt = product(&inverse(&CONES), &adapted);
        product(&inverse(&other.xyz()), &product(&adapt, &self.xyz()))
    }

    /// Returns the matrix from colours to CIE XYZ.
    fn xyz(&self) -> Matrix {
        let [r, g, b] = self.primaries.map(xyz);
        let columns = [0, 1, 2].map(|row| [r[row], g[row], b[row]]);
        // White has one of each primary.
        let amounts = applied(&inverse(&columns), xyz(self.white));
        columns.map(|row| [0, 1, 2].map(|c| row[c] * amounts[c]))
    }
}

impl Pigments {
    /// Converts the pigments of one space to those of another: the colours of a unit of each are converted, and are clipped to
    /// `[1e-30, 1]`. Colours of other amounts then differ by what absorption in three channels leaves out.
    ///
    /// # Errors
    ///
    /// Returns an error if a colour is not a number, as those of negative absorption or of spaces without a triangle may be.
    ///
    /// ```
    /// use hairis::params::{Pigments, RgbSpace};
    /// let pigments = Pigments::D_EON.converted(&RgbSpace::REC_709, &RgbSpace::ACES_CG)?;
    /// assert!((pigments.eumelanin[0] - Pigments::D_EON_ACES_CG.eumelanin[0]).abs() < 1e-6);
    /// # Ok::<(), hairis::ParamError>(())
    /// ```
    #[expect(clippy::cast_possible_truncation, reason = "rounds to f32")]
    #[inline]
    pub fn converted(&self, from: &RgbSpace, to: &RgbSpace) -> Result<Self, ParamError> {
        let matrix = from.to(to);
        let convert = |color: [f32; 3]| {
            applied(&matrix, color.map(f64::from)).map(|x| (x as f32).clamp(0.0, 1.0))
        };
        Self::from_colors(self.colors().map(convert))
    }
}

fn xyz([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

fn applied(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|[a, b, c]| a * v[0] + b * v[1] + c * v[2])
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| [0, 1, 2].map(|c| row[0] * b[0][c] + row[1] * b[1][c] + row[2] * b[2][c]))
}

/// Returns the inverse by cofactors.
fn inverse(m: &Matrix) -> Matrix {
    let next = |k: usize| [(k + 1) % 3, (k + 2) % 3];
    let cofactor = |row: usize, column: usize| {
        let ([a, b], [c, d]) = (next(row), next(column));
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * cofactor(0, c)).sum();
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| cofactor(column, row) / determinant))
}
