//! Axes, which determine the values that they span, where values lie, and their labels.

use crate::table::number;

/// Scale by which values are spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scale {
    /// Equal steps of the value.
    Linear,
    /// Equal ratios; values of 0 and below have no place on the axis and are left out.
    Log,
    /// Equal steps of the sine of an angle in degrees.
    Sine,
}

/// Axis of a chart: its label, its scale, and optionally its range and step.
///
/// ```
/// use hairis_instruments::plot::Axis;
/// let samples = Axis::log("samples N");
/// let angle = Axis::linear("inclination θ (°)").range(-90.0, 90.0).step(30.0);
/// # let _ = (samples, angle);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Axis {
    pub(super) label: String,
    scale: Scale,
    range: Option<(f64, f64)>,
    step: Option<f64>,
}

impl Axis {
    /// Makes a linear axis, whose label should contain the unit. The axis includes 0 unless the values are close together and far from
    /// 0.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Linear,
            range: None,
            step: None,
        }
    }

    /// Makes a logarithmic axis, whose label should contain the unit.
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label)
        }
    }

    /// Makes an axis of angles in degrees, spread by their sine.
    pub(super) fn sine(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Sine,
            ..Self::linear(label)
        }
    }

    /// Sets the values that the axis spans, in place of the range of the data; values outside are cut off.
    pub fn range(self, low: f64, high: f64) -> Self {
        Self {
            range: Some((low, high)),
            ..self
        }
    }

    /// Sets the distance between the labels of a linear axis.
    pub fn step(self, step: f64) -> Self {
        Self {
            step: Some(step),
            ..self
        }
    }

    /// Sets the range of the axis, unless the axis has one already.
    pub(super) fn or_range(self, low: f64, high: f64) -> Self {
        Self {
            range: self.range.or(Some((low, high))),
            ..self
        }
    }

    /// Returns true if `value` has a place on the axis.
    pub(super) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale != Scale::Log || value > 0.0)
    }

    /// Converts `value` to units that have equal lengths on the axis.
    fn scaled(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => value.max(1e-305).log10(),
            Scale::Sine => value.to_radians().sin(),
        }
    }

    /// Lays the axis along the pixels from `start` to `end`, wide enough for `values`.
    #[must_use]
    pub fn fit(self, values: &[f64], start: f64, end: f64) -> Fitted {
        let (low, high) = self.ends(values);
        Fitted {
            axis: self,
            low,
            high,
            start,
            end,
        }
    }

    /// Returns the ends of an axis wide enough for `values`, in scaled units.
    fn ends(&self, values: &[f64]) -> (f64, f64) {
        let usable = |(low, high): &(f64, f64)| self.shows(*low) && self.shows(*high) && low < high;
        if let Some((low, high)) = self.range.filter(usable) {
            return (self.scaled(low), self.scaled(high));
        }
        let is_log = self.scale == Scale::Log;
        // The difference of the ends must stay finite, and on a logarithmic axis so must their ratio.
        let most = if is_log { 140.0 } else { 1e300 };
        let mut ends: Option<(f64, f64)> = None;
        for value in values.iter().filter(|value| self.shows(**value)) {
            let value = self.scaled(*value).clamp(-most, most);
            ends = Some(ends.map_or((value, value), |(low, high)| {
                (low.min(value), high.max(value))
            }));
        }
        let (mut low, mut high) = ends.unwrap_or((0.0, 1.0));
        if is_log {
            let room = (0.05 * (high - low)).max(0.08);
            return (low - room, high + room);
        }
        let size = low.abs().max(high.abs());
        if high - low > 0.5 * size {
            (low, high) = (low.min(0.0), high.max(0.0));
        }
        let room = if high - low > 1e-9 * size {
            0.05 * (high - low)
        } else {
            (0.5 * size).max(0.5)
        };
        let beyond = |end: f64| if end == 0.0 && high > low { 0.0 } else { room };
        (low - beyond(low), high + beyond(high))
    }
}

/// Axis with its range, in scaled units, and its pixels.
#[derive(Clone, Debug)]
pub struct Fitted {
    pub(super) axis: Axis,
    low: f64,
    high: f64,
    pub(super) start: f64,
    pub(super) end: f64,
}

/// Grid line: its pixel, and its label if it has one.
pub type Tick = (f64, Option<String>);

impl Fitted {
    /// Returns the position of a value, from 0 at the start of the axis to 1 at its end.
    pub(super) fn share(&self, value: f64) -> f64 {
        (self.axis.scaled(value) - self.low) / (self.high - self.low)
    }

    /// Returns the pixel at a share `t` of the way along the axis.
    pub(super) fn along(&self, t: f64) -> f64 {
        self.start + t * (self.end - self.start)
    }

    /// Returns the pixel of a value; values outside are clamped to the ends of the axis.
    #[must_use]
    pub fn pixel(&self, value: f64) -> f64 {
        self.along(self.share(value).clamp(0.0, 1.0))
    }

    /// Returns true if the axis spans a value.
    pub(super) fn spans(&self, value: f64) -> bool {
        self.axis.shows(value) && (0.0..=1.0).contains(&self.share(value))
    }

    /// Returns the values at the ends of a linear or logarithmic axis.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        let ends = [self.low, self.high];
        if self.axis.scale == Scale::Log {
            ends.map(|end| 10.0_f64.powf(end))
        } else {
            ends
        }
    }

    /// Returns the grid lines, of which some have labels.
    #[must_use]
    pub fn ticks(&self) -> Vec<Tick> {
        match self.axis.scale {
            // A shorter axis has too few multiples of powers of ten.
            Scale::Log if self.high - self.low >= 0.9 => self.log_ticks(),
            // The ends of the axis are the poles of the sphere.
            Scale::Sine => self.linear_ticks([-90.0, 90.0]),
            _ => self.linear_ticks(self.ends()),
        }
    }

    fn linear_ticks(&self, [low, high]: [f64; 2]) -> Vec<Tick> {
        let room = (self.end - self.start).abs() / 70.0;
        let step = self
            .axis
            .step
            .filter(|s| *s > 0.0 && (high - low) / s < 100.0);
        let step = step.unwrap_or_else(|| nice_step((high - low) / room.clamp(2.0, 10.0)));
        let first = (low / step - 1e-6).ceil();
        let values = (0..200)
            .map(|n| (first + f64::from(n)) * step)
            .take_while(|v| *v <= high + 1e-6 * step);
        values
            .map(|value| (self.pixel(value), Some(number::tick(value + 0.0, step))))
            .collect()
    }

    fn log_ticks(&self) -> Vec<Tick> {
        let decades = self.high - self.low;
        let room = ((self.end - self.start).abs() / 55.0).max(2.0);
        let every = (decades / room).ceil().max(1.0);
        let labelled: &[i32] = if decades < 2.5 { &[1, 2, 5] } else { &[1] };
        let digits = if decades < 12.0 { 1..10 } else { 1..2 };
        let mut ticks = Vec::new();
        let mut exponent = self.low.floor();
        while exponent <= self.high {
            for digit in digits.clone() {
                let scaled = exponent + f64::from(digit).log10();
                if (self.low - 1e-9..=self.high + 1e-9).contains(&scaled) {
                    let shown = exponent.rem_euclid(every) == 0.0 && labelled.contains(&digit);
                    let label = shown.then(|| number::power(digit, exponent));
                    ticks.push((self.pixel(10.0_f64.powf(scaled)), label));
                }
            }
            exponent += 1.0;
        }
        ticks
    }
}

/// Returns the least of 1, 2, 5, 10 .. times a power of ten that is not much below `step`.
pub(super) fn nice_step(step: f64) -> f64 {
    let power = 10.0_f64.powf(step.log10().floor());
    let digit = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|d| d * power >= step * 0.75)
        .unwrap_or(10.0);
    digit * power
}
