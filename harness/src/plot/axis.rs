//! Axes: which values they span, where they put them, and how they label them.

use crate::table::number;

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps.
    Linear,
    /// Equal ratios; values of 0 and below have no place on it and are left out.
    Log,
}

/// One axis of a chart.
///
/// ```
/// use hairis_harness::plot::Axis;
/// let samples = Axis::log("samples N");
/// let angle = Axis::linear("inclination θ (°)").range(-90.0, 90.0).step(30.0);
/// # let _ = (samples, angle);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub(super) label: String,
    pub(super) scale: Scale,
    range: Option<(f64, f64)>,
    step: Option<f64>,
    from_zero: bool,
}

impl Axis {
    /// A linear axis. Put the unit in the label.
    #[must_use]
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None, step: None, from_zero: false }
    }

    /// A logarithmic axis. Put the unit in the label.
    #[must_use]
    pub fn log(label: impl Into<String>) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label) }
    }

    /// The values to span, in place of those of the data; what lies outside is cut off.
    #[must_use]
    pub fn range(mut self, low: f64, high: f64) -> Self {
        self.range = Some((low, high));
        self
    }

    /// The distance between labels of a linear axis.
    #[must_use]
    pub fn step(mut self, step: f64) -> Self {
        self.step = Some(step);
        self
    }

    /// Spans 0 whatever the data.
    #[must_use]
    pub fn from_zero(mut self) -> Self {
        self.from_zero = true;
        self
    }

    /// The axis with a range if it has none yet.
    pub(super) fn or_range(mut self, low: f64, high: f64) -> Self {
        self.range = self.range.or(Some((low, high)));
        self
    }

    /// Whether `value` has a place on the axis.
    pub(super) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale == Scale::Linear || value > 0.0)
    }

    /// The axis laid along the pixels from `start` to `end`, wide enough for `values`.
    pub(super) fn fit(&self, values: impl Iterator<Item = f64>, start: f64, end: f64) -> Fitted {
        let usable = |(low, high): &(f64, f64)| {
            let spans = self.shows(*low) && self.shows(*high) && low < high && (high - low).is_finite();
            spans && (self.scale == Scale::Linear || (high / low).is_finite())
        };
        if let Some((low, high)) = self.range.filter(usable) {
            return Fitted { scale: self.scale, low, high, start, end, step: self.step };
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|v| self.shows(*v)) {
            (low, high) = (low.min(value), high.max(value));
        }
        if low > high {
            (low, high) = if self.scale == Scale::Log { (1.0, 10.0) } else { (0.0, 1.0) };
        }
        match self.scale {
            Scale::Log => {
                // The ratio of the ends must stay finite.
                (low, high) = (low.clamp(1e-140, 1e140), high.clamp(1e-140, 1e140));
                let room = ((high / low).log10() * 0.05).max(0.08);
                (low, high) = (low * 10.0_f64.powf(-room), high * 10.0_f64.powf(room));
            }
            Scale::Linear => {
                (low, high) = (low.max(-1e300), high.min(1e300));
                if self.from_zero {
                    (low, high) = (low.min(0.0), high.max(0.0));
                }
                let size = low.abs().max(high.abs());
                let room = if high - low > 1e-9 * size { 0.05 * (high - low) } else { (0.5 * size).max(0.5) };
                let (floor, ceiling) = (self.from_zero && low == 0.0, self.from_zero && high == 0.0);
                low -= if floor { 0.0 } else { room };
                high += if ceiling { 0.0 } else { room };
            }
        }
        Fitted { scale: self.scale, low, high, start, end, step: self.step }
    }
}

/// An axis with its values and its pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fitted {
    scale: Scale,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) start: f64,
    pub(super) end: f64,
    step: Option<f64>,
}

/// A grid line: where, and its label if it has one.
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) label: Option<String>,
}

impl Fitted {
    /// The pixel of a value, which may lie outside of the axis, but not by more than a thousand lengths.
    pub(super) fn pixel(&self, value: f64) -> f64 {
        let t = match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Log => (value.max(1e-305) / self.low).ln() / (self.high / self.low).ln(),
        };
        self.start + t.clamp(-1e3, 1e3) * (self.end - self.start)
    }

    /// The pixel of a value, moved onto the axis.
    pub(super) fn within(&self, value: f64) -> f64 {
        self.pixel(value.clamp(self.low, self.high))
    }

    pub(super) fn ticks(&self) -> Vec<Tick> {
        match self.scale {
            Scale::Linear => self.linear_ticks(),
            Scale::Log => self.log_ticks(),
        }
    }

    fn linear_ticks(&self) -> Vec<Tick> {
        let room = (self.end - self.start).abs() / 70.0;
        let step = self.step.filter(|s| *s > 0.0 && (self.high - self.low) / s < 100.0);
        let step = step.unwrap_or_else(|| nice_step((self.high - self.low) / room.clamp(2.0, 10.0)));
        let (first, last) = ((self.low / step - 1e-6).ceil(), (self.high / step + 1e-6).floor());
        let mut ticks = Vec::new();
        let mut at = first;
        while at <= last && ticks.len() < 200 {
            let value = if at == 0.0 { 0.0 } else { at * step };
            ticks.push(Tick { value, label: Some(number::tick(value, step)) });
            at += 1.0;
        }
        ticks
    }

    fn log_ticks(&self) -> Vec<Tick> {
        let decades = (self.high / self.low).log10();
        let room = ((self.end - self.start).abs() / 55.0).max(2.0);
        let every = (decades / room).ceil().max(1.0);
        // With few decades 2 and 5 are labelled too, with less than one every digit.
        let labelled: &[f64] = match decades {
            d if d < 0.9 => &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0],
            d if d < 2.5 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let mut ticks = Vec::new();
        let mut exponent = self.low.log10().floor();
        while exponent <= self.high.log10() {
            let digits: &[f64] = if decades < 12.0 { &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0] } else { &[1.0] };
            for digit in digits {
                let value = digit * 10.0_f64.powf(exponent);
                if value < self.low * (1.0 - 1e-9) || value > self.high * (1.0 + 1e-9) {
                    continue;
                }
                let wanted = labelled.contains(digit) && exponent.rem_euclid(every) == 0.0;
                ticks.push(Tick { value, label: wanted.then(|| number::power(*digit, exponent)) });
            }
            exponent += 1.0;
        }
        ticks
    }
}

/// The least of 1, 2, 5, 10 .. times a power of ten that is not much below `step`.
pub(super) fn nice_step(step: f64) -> f64 {
    let power = 10.0_f64.powf(step.log10().floor());
    let digit = [1.0, 2.0, 5.0].into_iter().find(|d| d * power >= step * 0.75).unwrap_or(10.0);
    digit * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, values: &[f64]) -> Vec<String> {
        axis.fit(values.iter().copied(), 0.0, 500.0).ticks().into_iter().filter_map(|t| t.label).collect()
    }

    #[test]
    fn labels_are_round_numbers() {
        assert_eq!(labels(&Axis::linear("x").from_zero(), &[0.0, 0.93]), ["0.0", "0.2", "0.4", "0.6", "0.8"], "fifths");
        assert_eq!(
            labels(&Axis::linear("x").range(-90.0, 90.0).step(45.0), &[]),
            ["−90", "−45", "0", "45", "90"],
            "given"
        );
        assert_eq!(labels(&Axis::log("x"), &[1.0, 1e5]), ["1", "10", "100", "1000", "10⁴", "10⁵"], "decades");
    }

    #[test]
    fn any_data_gives_a_usable_axis() {
        let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0, 1e308, -1e308, 1e-308, 5e-324];
        for axis in [Axis::linear("x"), Axis::log("x"), Axis::linear("x").from_zero(), Axis::log("x").range(0.0, 1.0)] {
            for n in 0..odd.len() {
                let fitted = axis.fit(odd[n..].iter().copied(), 10.0, 90.0);
                assert!(fitted.low < fitted.high && (fitted.high - fitted.low).is_finite(), "{axis:?} {fitted:?}");
                for value in odd {
                    assert!(value.is_nan() || fitted.pixel(value).is_finite(), "{value} {fitted:?}");
                }
                assert!(fitted.ticks().len() < 400, "{fitted:?}");
            }
        }
    }
}
