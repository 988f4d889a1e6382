//! Colours, dashes and markers that people with any colour vision can tell apart, also on paper without colours.

use core::fmt;

/// Colour in sRGB, as `0xRRGGBB`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Color(u32);

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:06X}", self.0)
    }
}

/// Mixes two colours, from `start` at `t` = 0 to `end` at 1.
fn mix(start: u32, end: u32, t: f64) -> Color {
    let channel = |shift: u32| {
        let [a, b] = [start, end].map(|color| f64::from((color >> shift) & 0xFF));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and 255"
        )]
        let mixed = (a + (b - a) * t).round() as u32;
        mixed << shift
    };
    Color(channel(16) | channel(8) | channel(0))
}

const WHITE: u32 = 0xFF_FFFF;

/// Colour of text and axes.
pub(super) const INK: Color = Color(0x22_2222);
/// Colour of tick labels and notes.
pub(super) const FAINT_INK: Color = Color(0x55_5555);
/// Colour of the sheet, which is always white so that a plot stays readable on a dark page.
pub(super) const PAPER: Color = Color(WHITE);
/// Colour of the mark of one direction on a map.
pub(super) const MARK: Color = Color(0xAA_003C);

/// Colours of Okabe and Ito (2008), darkest contrasts first; the yellow, too pale for lines on white, is last.
const SERIES: [u32; 7] = [
    0x00_72B2, 0xD5_5E00, 0x00_9E73, 0xCC_79A7, 0x56_B4E9, 0x22_2222, 0xE6_9F00,
];

/// Returns the colour of the series with number `index`.
pub(super) const fn series_color(index: usize) -> Color {
    Color(SERIES[index % SERIES.len()])
}

/// Matplotlib's viridis at nine equal steps.
const VIRIDIS: [u32; 9] = [
    0x44_0154, 0x47_2C7A, 0x3B_518B, 0x2C_718E, 0x21_908D, 0x27_AD81, 0x5C_C863, 0xAA_DC32,
    0xFD_E725,
];

/// Returns a colour of viridis, which is perceptually uniform, from dark to bright as `t` goes from 0 to 1.
pub(super) fn scale_color(t: f64) -> Color {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 0 to 7"
    )]
    let step = (8.0 * t).clamp(0.0, 7.0) as usize;
    mix(VIRIDIS[step], VIRIDIS[step + 1], 8.0 * t - step as f64)
}

/// Returns blue below 0.5, white at 0.5 and vermilion above. Both ends are equally dark, and everyone can tell them apart.
pub(super) fn signed_color(t: f64) -> Color {
    mix(WHITE, SERIES[usize::from(t >= 0.5)], (2.0 * t - 1.0).abs())
}

/// Returns a pale background, from white to a soft ochre, from which dark dots stand out.
pub(super) fn soft_color(t: f64) -> Color {
    mix(WHITE, 0xF0_B246, t)
}

/// Lengths that are drawn and left out in turn, in tenths of a pixel: none, dashes, dashes and dots, dots, long dashes.
pub(super) const DASHES: [&str; 5] = ["none", "80 40", "90 30 20 30", "20 30", "160 50"];

/// Index of the dots among the dashes.
pub(super) const DOTS: usize = 3;

/// Index of the cross among the markers.
pub(super) const CROSS: usize = 4;

/// Corners of the markers, x and y in turn: disc (without corners), square, triangle, diamond, cross, inverted triangle.
pub(super) const MARKERS: [&[f64]; 6] = [
    &[],
    &[-0.9, -0.9, 0.9, -0.9, 0.9, 0.9, -0.9, 0.9],
    &[0.0, -1.2, 1.1, 0.8, -1.1, 0.8],
    &[0.0, -1.3, 1.3, 0.0, 0.0, 1.3, -1.3, 0.0],
    &[
        0.0, -0.4, 0.7, -1.1, 1.1, -0.7, 0.4, 0.0, 1.1, 0.7, 0.7, 1.1, 0.0, 0.4, -0.7, 1.1, -1.1,
        0.7, -0.4, 0.0, -1.1, -0.7, -0.7, -1.1,
    ],
    &[0.0, 1.2, 1.1, -0.8, -1.1, -0.8],
];
