//! Colours, dashes and markers: told apart by people who see colours differently, and on paper without colours.

use plotters::prelude::{ColorMap, RGBColor, ViridisRGB};

/// Text and axes.
pub(super) const INK: RGBColor = RGBColor(34, 34, 34);
/// Tick labels and notes.
pub(super) const FAINT_INK: RGBColor = RGBColor(85, 85, 85);
/// Grid lines.
pub(super) const GRID: RGBColor = RGBColor(222, 222, 222);
/// Grid lines between the labelled ones.
pub(super) const FAINT_GRID: RGBColor = RGBColor(240, 240, 240);
/// The sheet itself: always white, so that a plot stays readable on a dark page.
pub(super) const PAPER: RGBColor = RGBColor(255, 255, 255);

/// The colours of Okabe and Ito (2008), darkest contrasts first; the yellow, too pale for lines on white, is last.
const SERIES: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(34, 34, 34),
    RGBColor(230, 159, 0),
];

/// The colour of the series number `index`.
pub(super) fn series_color(index: usize) -> RGBColor {
    SERIES[index % SERIES.len()]
}

/// Perceptually uniform (viridis), dark to bright as `t` goes from 0 to 1.
pub(super) fn scale_color(t: f64) -> RGBColor {
    let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
    ViridisRGB.get_color(t)
}

/// Blue below 0.5, white there, vermilion above: both ends as dark, and apart for everyone.
pub(super) fn signed_color(t: f64) -> RGBColor {
    let t = if t.is_finite() { 2.0 * t.clamp(0.0, 1.0) - 1.0 } else { 0.0 };
    let end = if t < 0.0 { SERIES[0] } else { SERIES[1] };
    let mix = |full: u8| -> u8 {
        let value = 255.0 + (f64::from(full) - 255.0) * t.abs();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 255")]
        let byte = value as u8;
        byte
    };
    RGBColor(mix(end.0), mix(end.1), mix(end.2))
}

/// A pale background that dark dots stand out from: white to a soft ochre.
pub(super) fn soft_color(t: f64) -> RGBColor {
    let t = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
    let mix = |full: f64| -> u8 {
        let value = 255.0 + (full - 255.0) * t;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 255")]
        let byte = value as u8;
        byte
    };
    RGBColor(mix(240.0), mix(178.0), mix(70.0))
}

/// How a line is broken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dash {
    /// Unbroken.
    #[default]
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

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Inverted,
    Cross,
}

impl Marker {
    /// The marker of the series number `index`.
    pub(crate) const fn of(index: usize) -> Self {
        [Self::Circle, Self::Square, Self::Triangle, Self::Diamond, Self::Cross, Self::Inverted][index % 6]
    }
}
