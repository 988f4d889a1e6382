//! Error maps: a colour per pixel, on a scale that all samplers of a scene share.

use hairis_instruments::table::number;
use image::RgbImage;

/// Decades of squared error that a map tells apart.
const DECADES: f64 = 4.0;
/// Share of the nonzero values that a scale covers.
const COVERED: f64 = 0.995;

/// Map of errors: its scale, and the text that explains it.
#[derive(Clone, Debug)]
pub struct Map {
    /// Name of the error.
    pub name: &'static str,
    /// Lines that explain the colours.
    pub remarks: &'static [&'static str],
    most: f64,
    is_signed: bool,
}

impl Map {
    /// Creates a map of signed errors: blue below 0, red above, white at 0, with full colours at `most`.
    #[must_use]
    pub fn signed(name: &'static str, most: f64, remarks: &'static [&'static str]) -> Self {
        Self {
            name,
            remarks,
            most,
            is_signed: true,
        }
    }

    /// Creates a map of squared errors on a logarithmic scale, which is yellow at `most`.
    #[must_use]
    pub fn squared(name: &'static str, most: f64, remarks: &'static [&'static str]) -> Self {
        Self {
            name,
            remarks,
            most,
            is_signed: false,
        }
    }

    /// Returns the place of an error on the scale: from -1, or 0 for squares, to 1.
    fn place(&self, error: f64) -> f64 {
        if self.is_signed {
            (error / self.most).clamp(-1.0, 1.0)
        } else {
            (1.0 + (error / self.most).max(1e-99).log10() / DECADES).clamp(0.0, 1.0)
        }
    }

    fn color(&self, place: f64) -> image::Rgb<u8> {
        const DARK: [[f64; 3]; 2] = [[5.0, 48.0, 97.0], [103.0, 0.0, 31.0]];
        const HEAT: [[f64; 3]; 5] = [
            [0.0, 0.0, 4.0],
            [87.0, 16.0, 110.0],
            [188.0, 55.0, 84.0],
            [249.0, 142.0, 9.0],
            [252.0, 255.0, 164.0],
        ];
        let (from, to, share) = if self.is_signed {
            (
                [255.0; 3],
                DARK[usize::from(place > 0.0)],
                place.abs().sqrt(),
            )
        } else {
            let at = place * (HEAT.len() - 1) as f64;
            let stop = (0..HEAT.len() - 2)
                .rev()
                .find(|stop| *stop as f64 <= at)
                .unwrap_or(0);
            (HEAT[stop], HEAT[stop + 1], at - stop as f64)
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a byte"
        )]
        image::Rgb(core::array::from_fn(|c| {
            (from[c] + (to[c] - from[c]) * share).round() as u8
        }))
    }

    /// Draws errors as colours, row by row.
    #[must_use]
    pub fn image(&self, errors: &[f64], [width, height]: [u32; 2]) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| {
            self.color(self.place(errors[(y * width + x) as usize]))
        })
    }

    /// Draws the colours of the scale, from its lower end to its upper end.
    #[must_use]
    pub fn legend(&self, width: u32) -> RgbImage {
        RgbImage::from_fn(width, 1, |x, _| {
            let share = f64::from(x) / f64::from(width.max(2) - 1);
            self.color(if self.is_signed {
                2.0 * share - 1.0
            } else {
                share
            })
        })
    }

    /// Returns the numbers below the legend, each as share of its width, anchor of the text, and text.
    #[must_use]
    pub fn ticks(&self) -> [(f64, &'static str, String); 3] {
        let most = self.most;
        let values = if self.is_signed {
            [-most, 0.0, most]
        } else {
            [0.0, 0.5, 1.0].map(|share| most * 10.0_f64.powf(DECADES * (share - 1.0)))
        };
        let [low, middle, high] = values.map(|value| number::plain(value, 1));
        [
            (0.0, "start", low),
            (0.5, "middle", middle),
            (1.0, "end", high),
        ]
    }
}

/// Returns the upper end of a scale that covers all but a few of the nonzero values: 1, 2 or 5 times a power of ten.
pub fn scale<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    let mut values: Vec<f64> = values
        .map(|value| value.abs())
        .filter(|value| *value > 0.0)
        .collect();
    values.sort_by(f64::total_cmp);
    if values.is_empty() {
        return 1.0;
    }
    let covered = hairis_instruments::stats::percentile(&values, COVERED);
    let power = 10.0_f64.powf(covered.log10().floor());
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| factor * power >= covered)
        .unwrap_or(10.0);
    factor * power
}
