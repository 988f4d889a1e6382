//! Latitude-longitude environment maps with exact importance sampling.

use super::{Light, LightSample, Seen8, luminance, rounded};
use crate::quadrature::{GaussLegendre, Integral, SphereIntegrator};
use crate::sequence::mix;
use core::f64::consts::PI;
use glam::DVec3;
use hairis::Vec3x8;
use serde::Serialize;
use wide::f32x8;

/// The radiance that replaces an infinite pixel: the largest half float of `OpenEXR`.
const INFINITE_PIXEL: f32 = 65_504.0;

/// Repaired channels of an environment, by kind of repair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PixelRepairs {
    /// NaN channels, set to 0.
    pub nan: usize,
    /// Negative channels (negative infinity among them), set to 0.
    pub negative: usize,
    /// Positive infinite channels, set to 65504.
    pub infinite: usize,
}

/// A latitude-longitude environment map of piecewise constant radiance.
///
/// Row 0 is at the zenith (+y), the last row at the nadir. The middle column looks along -z, and +x is a quarter of the width to its right.
///
/// A texel is drawn with probability proportional to its luminance times its exact solid angle (the sine weighting, integrated), by a marginal cdf of rows
/// and a conditional cdf of columns; the direction is uniform in solid angle within the texel. So the density is constant on each texel and its integral is
/// exactly the texel's probability. A black map is sampled uniformly over the sphere.
///
/// # Examples
/// ```
/// use glam::DVec3;
/// use hairis_harness::light::{Environment, Light};
/// let map = Environment::from_pixels("two", 2, 1, vec![[1.0; 3], [3.0; 3]]).expect("valid");
/// assert_eq!(map.radiance(DVec3::X), [3.0; 3]);
/// assert!((map.pdf(DVec3::X) - 0.75 / (2.0 * core::f64::consts::PI)).abs() < 1e-15);
/// ```
#[derive(Clone, Debug)]
pub struct Environment {
    name: String,
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
    /// Cosine of the polar angle at the upper edge of each row, and at the bottom: 1 down to -1.
    edges: Vec<f64>,
    /// Cumulative weights over rows, and within each row over its columns; both start after the first element.
    rows: Vec<f64>,
    columns: Vec<f64>,
    /// Where the searches in them begin: see [`guide`].
    row_guide: Vec<u32>,
    column_guide: Vec<u32>,
    repairs: PixelRepairs,
}

impl Environment {
    /// A map from linear RGB pixels, row by row from the zenith. Channels that are no radiances are repaired and counted.
    ///
    /// # Errors
    /// A message when a side is 0 or `pixels` does not hold `width * height` of them.
    pub fn from_pixels(
        name: impl Into<String>,
        width: usize,
        height: usize,
        pixels: Vec<[f32; 3]>,
    ) -> Result<Self, String> {
        if width == 0 || height == 0 {
            return Err(format!("the map has no pixels: {width} x {height}"));
        }
        if width.checked_mul(height) != Some(pixels.len()) {
            return Err(format!("{width} x {height} pixels expected, {} given", pixels.len()));
        }
        Ok(Self::from_size(name, [width, height], pixels))
    }

    /// The map of a size already known to fit its pixels and to be at least 1 x 1.
    pub(super) fn from_size(name: impl Into<String>, [width, height]: [usize; 2], mut pixels: Vec<[f32; 3]>) -> Self {
        let mut repairs = PixelRepairs::default();
        for channel in pixels.iter_mut().flatten() {
            if channel.is_nan() {
                repairs.nan += 1;
                *channel = 0.0;
            } else if *channel < 0.0 {
                repairs.negative += 1;
                *channel = 0.0;
            } else if channel.is_infinite() {
                repairs.infinite += 1;
                *channel = INFINITE_PIXEL;
            }
        }
        let edges: Vec<f64> =
            (0..=height).map(|j| if 2 * j == height { 0.0 } else { (PI * j as f64 / height as f64).cos() }).collect();
        let mut columns = Vec::with_capacity(pixels.len());
        let mut rows = Vec::with_capacity(height);
        let mut total = 0.0;
        for (j, row) in pixels.chunks_exact(width).enumerate() {
            let mut sum = 0.0;
            for rgb in row {
                sum += luminance(rgb.map(f64::from));
                columns.push(sum);
            }
            total += sum * (edges[j] - edges[j + 1]);
            rows.push(total);
        }
        let row_guide = guide(&rows).collect();
        let column_guide = columns.chunks_exact(width).flat_map(guide).collect();
        Self { name: name.into(), width, height, pixels, edges, rows, columns, row_guide, column_guide, repairs }
    }

    /// Width and height in texels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The channels that had to be repaired.
    #[must_use]
    pub fn repairs(&self) -> PixelRepairs {
        self.repairs
    }

    /// Warnings about the map for reports, one line each: a shape other than 2:1, repaired channels, no light at all.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.width != 2 * self.height {
            notes.push(format!(
                "{}: {} x {} is not 2:1; it is stretched over the sphere",
                self.name, self.width, self.height
            ));
        }
        let PixelRepairs { nan, negative, infinite } = self.repairs;
        if nan + negative + infinite > 0 {
            notes.push(format!("{}: repaired channels: {nan} NaN and {negative} negative set to 0, {infinite} infinite set to {INFINITE_PIXEL}", self.name));
        }
        if self.is_black() {
            notes.push(format!("{}: the map is black", self.name));
        }
        notes
    }

    /// Whether the map gives no light at all.
    #[must_use]
    pub fn is_black(&self) -> bool {
        self.total() == 0.0
    }

    /// Integral of the radiance over the sphere: the sum over texels of radiance times solid angle, linear RGB.
    #[must_use]
    pub fn total_radiance(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (j, row) in self.pixels.chunks_exact(self.width).enumerate() {
            let solid_angle = self.texel_solid_angle(j);
            for rgb in row {
                for c in 0..3 {
                    sum[c] += f64::from(rgb[c]) * solid_angle;
                }
            }
        }
        sum
    }

    /// Digest of the map: a hash of the size and of every pixel, not of the name.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let start = mix(mix(self.width as u64) ^ self.height as u64);
        self.pixels.iter().flatten().fold(start, |hash, channel| mix(hash ^ u64::from(channel.to_bits())))
    }

    fn total(&self) -> f64 {
        self.rows[self.height - 1]
    }

    /// Solid angle of a texel of row `j`, in sr.
    fn texel_solid_angle(&self, j: usize) -> f64 {
        2.0 * PI / self.width as f64 * (self.edges[j] - self.edges[j + 1])
    }

    /// Column and row of the texel that covers `dir`.
    fn texel(&self, dir: DVec3) -> [usize; 2] {
        let polar = dir.x.hypot(dir.z).atan2(dir.y) / PI;
        let turn = 0.5 + dir.x.atan2(-dir.z) / (2.0 * PI);
        [cell(turn, self.width), cell(polar, self.height)]
    }

    /// The direction at fraction `turn` of the width and polar cosine `cosine`.
    fn direction(turn: f64, cosine: f64) -> DVec3 {
        let r = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
        let (sin, cos) = (2.0 * PI * (turn - 0.5)).sin_cos();
        DVec3::new(r * sin, cosine, -r * cos)
    }

    fn radiance_of(&self, [i, j]: [usize; 2]) -> [f64; 3] {
        self.pixels[j * self.width + i].map(f64::from)
    }

    fn density_of(&self, texel: [usize; 2]) -> f64 {
        let total = self.total();
        if total == 0.0 {
            return 0.25 / PI;
        }
        // Probability luminance * (edge difference) / total, over the solid angle 2 pi / width * (edge difference).
        luminance(self.radiance_of(texel)) / total * self.width as f64 / (2.0 * PI)
    }
}

/// The cell of [0, 1] cut in `n` that holds `x`.
fn cell(x: f64, n: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 0..=n; NaN becomes 0")]
    let i = (x * n as f64).clamp(0.0, n as f64) as usize;
    i.min(n - 1)
}

/// The whole part of `x` as an index below `n`; NaN and what is below 0 become 0.
fn index(x: f32, n: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates; NaN becomes 0")]
    let i = x as usize;
    i.min(n - 1)
}

/// For each of as many equal parts of the total as there are indices, the index that the part begins in: a search that starts there takes a step or two, on
/// average, where bisection takes a dozen. The inversion stays monotone, unlike that of alias tables, so that stratified numbers stay stratified.
fn guide(cumulative: &[f64]) -> impl Iterator<Item = u32> + '_ {
    let (parts, total) = (cumulative.len(), cumulative.last().copied().unwrap_or(0.0));
    let mut index = 0;
    (0..parts).map(move |part| {
        while index + 1 < parts && cumulative[index] <= part as f64 / parts as f64 * total {
            index += 1;
        }
        u32::try_from(index).unwrap_or(u32::MAX)
    })
}

/// Draws an index from a cumulative sum, and what is left of `xi` in [0, 1). Indices of no weight are never drawn while some have weight.
fn draw(cumulative: &[f64], guide: &[u32], xi: f64) -> (usize, f64) {
    let last = cumulative.len() - 1;
    let total = cumulative[last];
    // Strictly below the total, or rounding could fall off the end into indices of no weight.
    let target = (xi * total).min(total * (1.0 - f64::EPSILON / 2.0));
    let mut index = guide[cell(xi, guide.len())] as usize;
    // Rounding may have put the start one too far.
    while index > 0 && cumulative[index - 1] > target {
        index -= 1;
    }
    while index < last && cumulative[index] <= target {
        index += 1;
    }
    let before = if index == 0 { 0.0 } else { cumulative[index - 1] };
    let rest = (target - before) / (cumulative[index] - before);
    (index, if rest.is_finite() { rest.clamp(0.0, 1.0) } else { 0.5 })
}

impl Light for Environment {
    fn name(&self) -> &str {
        &self.name
    }

    fn radiance(&self, dir: DVec3) -> [f64; 3] {
        self.radiance_of(self.texel(dir))
    }

    fn sample(&self, xi: [f64; 2]) -> LightSample {
        let dir = if self.is_black() {
            Self::direction(xi[1], 1.0 - 2.0 * xi[0])
        } else {
            let (j, down) = draw(&self.rows, &self.row_guide, xi[0]);
            let row = j * self.width..(j + 1) * self.width;
            let (i, across) = draw(&self.columns[row.clone()], &self.column_guide[row], xi[1]);
            Self::direction(
                (i as f64 + across) / self.width as f64,
                self.edges[j] + down * (self.edges[j + 1] - self.edges[j]),
            )
        };
        // Looked up again: on an edge between texels rounding may land in the next one, and value and density must be of one texel.
        let texel = self.texel(dir);
        LightSample { dir, radiance: self.radiance_of(texel), pdf: self.density_of(texel) }
    }

    fn pdf(&self, dir: DVec3) -> f64 {
        self.density_of(self.texel(dir))
    }

    fn see8(&self, dir: &Vec3x8) -> Seen8 {
        let splat = |x: f64| f32x8::splat(rounded(x));
        let flat = (dir.x * dir.x + dir.z * dir.z).sqrt();
        let row = (flat.atan2(dir.y) * splat(self.height as f64 / PI)).to_array();
        let turn = dir.x.atan2(-dir.z) * splat(0.5 / PI) + splat(0.5);
        let column = (turn * splat(self.width as f64)).to_array();
        let (mut radiance, mut pdf) = ([[0.0; 8]; 3], [0.0; 8]);
        let scale = if self.is_black() { 0.0 } else { self.width as f64 / (2.0 * PI * self.total()) };
        for lane in 0..8 {
            let rgb = self.pixels[index(row[lane], self.height) * self.width + index(column[lane], self.width)];
            for (of, c) in radiance.iter_mut().zip(rgb) {
                of[lane] = c;
            }
            pdf[lane] = if scale > 0.0 { rounded(luminance(rgb.map(f64::from)) * scale) } else { rounded(0.25 / PI) };
        }
        Seen8 { radiance: radiance.map(f32x8::new), pdf: f32x8::new(pdf) }
    }

    /// Gauss-Legendre in each texel, 4 by 4 nodes and 3 by 3 for the error; texels of no light are skipped. Exact edges, but lobes of `f` much narrower than
    /// a texel are not resolved: `converged` compares the error with the tolerance.
    fn integrate(&self, f: &dyn Fn(DVec3) -> [f64; 3], sphere: &SphereIntegrator) -> Integral<3> {
        let rules = [GaussLegendre::new(4), GaussLegendre::new(3)];
        let (mut value, mut error, mut evaluations) = ([0.0; 3], [0.0; 3], 0);
        for j in 0..self.height {
            for i in 0..self.width {
                let radiance = self.radiance_of([i, j]);
                if radiance == [0.0; 3] {
                    continue;
                }
                let mut sums = [[0.0; 3]; 2];
                for (rule, sum) in rules.iter().zip(&mut sums) {
                    for [cosine, w] in rule.on(self.edges[j + 1], self.edges[j]) {
                        for [turn, v] in rule.on(i as f64 / self.width as f64, (i + 1) as f64 / self.width as f64) {
                            let y = f(Self::direction(turn, cosine));
                            evaluations += 1;
                            for c in 0..3 {
                                sum[c] += 2.0 * PI * w * v * radiance[c] * y[c];
                            }
                        }
                    }
                }
                for c in 0..3 {
                    value[c] += sums[0][c];
                    error[c] += (sums[0][c] - sums[1][c]).abs();
                }
            }
        }
        let tolerance = sphere.tolerance();
        let largest = value.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
        let allowed = tolerance.absolute.max(tolerance.relative * largest);
        Integral { value, error, evaluations, converged: error.iter().all(|e| *e <= allowed) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::Independent;

    #[test]
    fn guided_searches_find_what_bisection_finds() {
        let mut xi = Independent::new(11, 0);
        for length in [1, 2, 3, 100, 1024] {
            for kind in 0..4 {
                let mut sum = 0.0;
                let weight = |xi: &mut Independent| match kind {
                    0 => 1.0,
                    1 => xi.next_f64().powi(20),
                    2 if xi.next_f64() < 0.9 => 0.0,
                    2 => 1.0,
                    _ => 1.0 / 3.0,
                };
                let cumulative: Vec<f64> = (0..length)
                    .map(|_| {
                        sum += weight(&mut xi);
                        sum
                    })
                    .collect();
                if sum == 0.0 {
                    continue;
                }
                let guide: Vec<u32> = guide(&cumulative).collect();
                let edges =
                    (0..=length).map(|k| f64::from(k) / f64::from(length)).chain([f64::EPSILON, 1.0 - f64::EPSILON]);
                for xi in edges.chain((0..1000).map(|_| xi.next_f64())) {
                    let xi = xi.min(1.0 - f64::EPSILON / 2.0);
                    let target = (xi * sum).min(sum * (1.0 - f64::EPSILON / 2.0));
                    let expected = cumulative.partition_point(|c| *c <= target).min(cumulative.len() - 1);
                    assert_eq!(draw(&cumulative, &guide, xi).0, expected, "{length} of kind {kind} at {xi}");
                }
            }
        }
    }
}
