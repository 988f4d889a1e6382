//! Colours, dashes and markers: told apart by people who see colours differently, and on paper without colours.

use core::fmt;

/// A colour of sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Color(u8, u8, u8);

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02X}{:02X}{:02X}", self.0, self.1, self.2)
    }
}

impl Color {
    /// From this colour at 0 to `end` at 1.
    fn mix(self, end: Self, t: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 255")]
        let channel = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * t).round() as u8;
        Self(channel(self.0, end.0), channel(self.1, end.1), channel(self.2, end.2))
    }
}

/// Text and axes.
pub(super) const INK: Color = Color(34, 34, 34);
/// Tick labels and notes.
pub(super) const FAINT_INK: Color = Color(85, 85, 85);
/// The sheet itself: always white, so that a plot stays readable on a dark page.
pub(super) const PAPER: Color = Color(255, 255, 255);
/// Marks one direction on a map.
pub(super) const MARK: Color = Color(170, 0, 60);

/// The colours of Okabe and Ito (2008), darkest contrasts first; the yellow, too pale for lines on white, is last.
const SERIES: [Color; 7] = [
    Color(0, 114, 178),
    Color(213, 94, 0),
    Color(0, 158, 115),
    Color(204, 121, 167),
    Color(86, 180, 233),
    Color(34, 34, 34),
    Color(230, 159, 0),
];

/// The colour of the series number `index`.
pub(super) fn series_color(index: usize) -> Color {
    SERIES[index % SERIES.len()]
}

/// Matplotlib's viridis at nine equal steps.
const VIRIDIS: [Color; 9] = [
    Color(68, 1, 84),
    Color(71, 44, 122),
    Color(59, 81, 139),
    Color(44, 113, 142),
    Color(33, 144, 141),
    Color(39, 173, 129),
    Color(92, 200, 99),
    Color(170, 220, 50),
    Color(253, 231, 37),
];

/// Perceptually uniform (viridis), dark to bright as `t` goes from 0 to 1.
pub(super) fn scale_color(t: f64) -> Color {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 7")]
    let step = (8.0 * t).clamp(0.0, 7.0) as usize;
    VIRIDIS[step].mix(VIRIDIS[step + 1], 8.0 * t - step as f64)
}

/// Blue below 0.5, white there, vermilion above: both ends as dark, and apart for everyone.
pub(super) fn signed_color(t: f64) -> Color {
    PAPER.mix(SERIES[usize::from(t >= 0.5)], (2.0 * t - 1.0).abs())
}

/// A pale background that dark dots stand out from: white to a soft ochre.
pub(super) fn soft_color(t: f64) -> Color {
    PAPER.mix(Color(240, 178, 70), t)
}

/// How a line is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    /// Unbroken.
    Solid,
    /// Long strokes.
    Dashed,
    /// Points.
    Dotted,
    /// Strokes and points in turn.
    DashDot,
    /// Very long strokes.
    Long,
}

impl Dash {
    /// The dash of the series number `index`.
    pub(crate) const fn of(index: usize) -> Self {
        [Self::Solid, Self::Dashed, Self::DashDot, Self::Dotted, Self::Long][index % 5]
    }

    /// Pixels drawn and left out in turn.
    pub(super) const fn pattern(self) -> &'static [f64] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[8.0, 4.0],
            Self::Dotted => &[2.0, 3.0],
            Self::DashDot => &[9.0, 3.0, 2.0, 3.0],
            Self::Long => &[16.0, 5.0],
        }
    }
}

/// The number of the marker that is a cross.
pub(super) const CROSS: usize = 4;

/// Corners of the markers, x and y in turn: disc (without corners), square, triangle, diamond, cross, inverted triangle.
pub(super) const MARKERS: [&[f64]; 6] = [
    &[],
    &[-0.9, -0.9, 0.9, -0.9, 0.9, 0.9, -0.9, 0.9],
    &[0.0, -1.2, 1.1, 0.8, -1.1, 0.8],
    &[0.0, -1.3, 1.3, 0.0, 0.0, 1.3, -1.3, 0.0],
    &[
        0.0, -0.4, 0.7, -1.1, 1.1, -0.7, 0.4, 0.0, 1.1, 0.7, 0.7, 1.1, 0.0, 0.4, -0.7, 1.1, -1.1, 0.7, -0.4, 0.0, -1.1,
        -0.7, -0.7, -1.1,
    ],
    &[0.0, 1.2, 1.1, -0.8, -1.1, -0.8],
];
