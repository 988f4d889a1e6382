//! Latitude-longitude environment maps with importance sampling that follows the map exactly.

mod places;

use super::inversion::{cell, guide, search};
use super::{Light, LightSample, Seen8, luminance, rounded};
use crate::pixels::INFINITE_PIXEL;
use crate::quadrature::{GaussLegendre, Integral, SphereIntegrator};
use crate::sequence::mix;
use core::array;
use core::f64::consts::PI;
use glam::DVec3;
use hairis::Vec3x8;
use hairis::simd::Level;
use places::{Places, in_doubt};
use serde::Serialize;
use wide::f32x8;

/// Distance from the edges of a texel, as a share of the texel, below which a sample's texel is looked up once more.
const EDGE: f64 = 1e-6;

/// Counts of repaired channels of an environment, by kind of repair.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct PixelRepairs {
    /// Number of NaN channels, which were set to 0.
    pub nan: usize,
    /// Number of negative channels (negative infinity among them), which were set to 0.
    pub negative: usize,
    /// Number of positive infinite channels, which were set to 65504.
    pub infinite: usize,
}

/// Latitude-longitude environment map whose radiance is constant on each texel.
///
/// The first row is at the zenith (+y), the last row at the nadir. The middle column faces -z, and +x lies a quarter of the width to
/// its right.
///
/// A texel is drawn with probability proportional to its luminance times its exact solid angle (the sine weighting, integrated), by a
/// marginal cdf of rows and a conditional cdf of columns. Within the texel the direction is uniform in solid angle. The density is
/// therefore constant on each texel, and its integral is exactly the texel's probability. A black map is sampled uniformly over the
/// sphere.
///
/// # Examples
/// ```
/// use glam::DVec3;
/// use hairis_instruments::light::{Environment, Light};
/// let map = Environment::from_pixels("two", 2, 1, vec![[1.0; 3], [3.0; 3]]).expect("valid");
/// assert_eq!(map.radiance(DVec3::X), [3.0; 3]);
/// assert!((map.pdf(DVec3::X) - 0.75 / (2.0 * core::f64::consts::PI)).abs() < 1e-15);
/// ```
#[derive(Clone, Debug)]
pub struct Environment {
    name: String,
    width: usize,
    height: usize,
    /// Radiance of each texel and the density of drawing a direction in it, side by side as a look-up reads them.
    texels: Vec<[f32; 4]>,
    /// Cosine of the polar angle at the upper edge of each row, and at the bottom: 1 down to -1.
    edges: Vec<f64>,
    /// Cumulative weights over rows, and within each row over its columns; both begin with the first element's weight, not with 0.
    rows: Vec<f64>,
    columns: Vec<f64>,
    /// Starting points of the searches in the cumulative weights: see [`guide`](super::inversion::guide).
    row_guide: Vec<u32>,
    column_guide: Vec<u32>,
    repairs: PixelRepairs,
    /// Remarks of the reader on how it changed the values of a file.
    remarks: Vec<String>,
}

impl Environment {
    /// Makes a map from linear RGB pixels, row by row from the zenith. Channels that are not valid radiances are repaired and counted.
    ///
    /// # Errors
    /// Returns a message if a side is 0 or `pixels` does not hold `width * height` elements.
    pub fn from_pixels(
        name: impl Into<String>,
        width: usize,
        height: usize,
        mut pixels: Vec<[f32; 3]>,
    ) -> Result<Self, String> {
        if width == 0 || height == 0 {
            return Err(format!("the map has no pixels: {width} x {height}"));
        }
        if width.checked_mul(height) != Some(pixels.len()) {
            return Err(format!(
                "{width} x {height} pixels expected, {} given",
                pixels.len()
            ));
        }
        let mut repairs = PixelRepairs::default();
        for channel in pixels.iter_mut().flatten() {
            let (count, repaired) = match *channel {
                x if x.is_nan() => (&mut repairs.nan, 0.0),
                x if x < 0.0 => (&mut repairs.negative, 0.0),
                f32::INFINITY => (&mut repairs.infinite, INFINITE_PIXEL),
                _ => continue,
            };
            *count += 1;
            *channel = repaired;
        }
        let edges: Vec<f64> = (0..=height)
            .map(|j| {
                if 2 * j == height {
                    0.0
                } else {
                    (PI * j as f64 / height as f64).cos()
                }
            })
            .collect();
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
        let texels = pixels.iter().map(|&[r, g, b]| [r, g, b, 0.0]).collect();
        let name = name.into();
        let mut map = Self {
            name,
            width,
            height,
            texels,
            edges,
            rows,
            columns,
            row_guide,
            column_guide,
            repairs,
            remarks: Vec::new(),
        };
        for place in 0..map.texels.len() {
            map.texels[place][3] = rounded(map.density(colour(map.texels[place])));
        }
        Ok(map)
    }

    /// Sets the remarks of a reader, which [`notes`](Self::notes) returns first.
    pub(super) fn with_remarks(self, remarks: Vec<String>) -> Self {
        Self { remarks, ..self }
    }

    /// Returns the width and the height of the map in texels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Returns the counts of channels that had to be repaired.
    #[must_use]
    pub fn repairs(&self) -> PixelRepairs {
        self.repairs
    }

    /// Returns remarks on the map for reports, one line each: conversions of the file, a shape other than 2:1, repaired channels, and a
    /// map that is black.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let remark = |remark| format!("{}: {remark}", self.name);
        let mut notes: Vec<String> = self.remarks.iter().map(remark).collect();
        if self.width != 2 * self.height {
            notes.push(format!(
                "{}: {} x {} is not 2:1; it is stretched over the sphere",
                self.name, self.width, self.height
            ));
        }
        let PixelRepairs {
            nan,
            negative,
            infinite,
        } = self.repairs;
        if nan + negative + infinite > 0 {
            notes.push(format!("{}: repaired channels: {nan} NaN and {negative} negative set to 0, {infinite} infinite set to {INFINITE_PIXEL}", self.name));
        }
        if self.is_black() {
            notes.push(format!("{}: the map is black", self.name));
        }
        notes
    }

    /// Returns true if the map emits no light at all.
    #[must_use]
    pub fn is_black(&self) -> bool {
        self.total() == 0.0
    }

    /// Returns a hash of the size and of every pixel of the map, but not of its name.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let start = mix(mix(self.width as u64) ^ self.height as u64);
        self.texels
            .iter()
            .flat_map(|texel| &texel[..3])
            .fold(start, |hash, channel| {
                mix(hash ^ u64::from(channel.to_bits()))
            })
    }

    fn total(&self) -> f64 {
        self.rows[self.height - 1]
    }

    /// Returns the index of the texel that covers `dir`.
    fn texel(&self, dir: DVec3) -> usize {
        let polar = dir.x.hypot(dir.z).atan2(dir.y) / PI;
        let turn = 0.5 + dir.x.atan2(-dir.z) / (2.0 * PI);
        cell(polar, self.height) * self.width + cell(turn, self.width)
    }

    /// Returns the direction at fraction `turn` of the width and polar cosine `cosine`.
    fn direction(turn: f64, cosine: f64) -> DVec3 {
        let r = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
        let (sin, cos) = (2.0 * PI * (turn - 0.5)).sin_cos();
        DVec3::new(r * sin, cosine, -r * cos)
    }

    /// Returns the density of drawing a direction in a texel with this radiance.
    fn density(&self, radiance: [f64; 3]) -> f64 {
        let total = self.total();
        if total == 0.0 {
            return 0.25 / PI;
        }
        // Probability luminance * (edge difference) / total, over the solid angle 2 pi / width * (edge difference).
        luminance(radiance) / total * self.width as f64 / (2.0 * PI)
    }
}

/// Returns the radiance of a texel in double precision.
fn colour([r, g, b, _]: [f32; 4]) -> [f64; 3] {
    [r, g, b].map(f64::from)
}

impl Environment {
    /// Draws directions from pairs of numbers. The tables of a large map are in no cache, so reads of one kind are made side by side
    /// and wait together.
    fn draw<const N: usize>(&self, xi: [[f64; 2]; N]) -> [LightSample; N] {
        if self.is_black() {
            let dir = |[a, b]: [f64; 2]| Self::direction(b, 1.0 - 2.0 * a);
            return xi.map(|xi| LightSample {
                dir: dir(xi),
                radiance: [0.0; 3],
                pdf: 0.25 / PI,
            });
        }
        let rows = xi.map(|[xi, _]| {
            let index = self.row_guide[cell(xi, self.height)] as usize;
            search(&self.rows, self.total(), (index, self.rows[index]), xi)
        });
        let of_row = |k: usize| rows[k].0 * self.width..(rows[k].0 + 1) * self.width;
        let totals: [f64; N] = array::from_fn(|k| self.columns[of_row(k).end - 1]);
        let starts: [usize; N] = array::from_fn(|k| {
            self.column_guide[of_row(k).start + cell(xi[k][1], self.width)] as usize
        });
        let sums: [f64; N] = array::from_fn(|k| self.columns[of_row(k).start + starts[k]]);
        let columns: [(usize, f64); N] = array::from_fn(|k| {
            search(
                &self.columns[of_row(k)],
                totals[k],
                (starts[k], sums[k]),
                xi[k][1],
            )
        });
        let drawn: [[f32; 4]; N] = array::from_fn(|k| self.texels[of_row(k).start + columns[k].0]);
        array::from_fn(|k| {
            let ((j, down), (i, across)) = (rows[k], columns[k]);
            let cosine = self.edges[j] + down * (self.edges[j + 1] - self.edges[j]);
            let dir = Self::direction((i as f64 + across) / self.width as f64, cosine);
            // Near an edge between texels, rounding may move the direction into the next texel, but value and density must belong to
            // one texel.
            let inside = |x: f64| (EDGE..1.0 - EDGE).contains(&x);
            let texel = if inside(down) && inside(across) {
                drawn[k]
            } else {
                self.texels[self.texel(dir)]
            };
            let radiance = colour(texel);
            LightSample {
                dir,
                radiance,
                pdf: self.density(radiance),
            }
        })
    }
}

impl Light for Environment {
    fn name(&self) -> &str {
        &self.name
    }

    fn see(&self, dir: DVec3) -> ([f64; 3], f64) {
        let radiance = colour(self.texels[self.texel(dir)]);
        (radiance, self.density(radiance))
    }

    fn sample(&self, xi: [f64; 2]) -> LightSample {
        let [sample] = self.draw([xi]);
        sample
    }

    fn sample8(&self, xi: [[f64; 2]; 8]) -> [LightSample; 8] {
        self.draw(xi)
    }

    /// Returns [`radiance`](Light::radiance) and [`pdf`](Light::pdf) bit for bit as double precision gives them, rounded.
    fn see8(&self, dir: &Vec3x8) -> Seen8 {
        let [row, column] = Level::detect().run(Places {
            dir,
            texels: [self.height as f32, self.width as f32],
        });
        let [rows, columns] = [
            row.fast_trunc_int().to_array(),
            column.fast_trunc_int().to_array(),
        ];
        let doubt = in_doubt(row, self.height as f32) | in_doubt(column, self.width as f32);
        let mut seen = [[0.0; 8]; 4];
        for lane in 0..8 {
            let texel = if doubt >> lane & 1 == 1 {
                self.texel(dir.lane(lane).as_dvec3())
            } else {
                // The places are above 0 and below the size, because all others are in doubt.
                rows[lane].unsigned_abs() as usize * self.width
                    + columns[lane].unsigned_abs() as usize
            };
            for (of, number) in seen.iter_mut().zip(self.texels[texel]) {
                of[lane] = number;
            }
        }
        let [r, g, b, pdf] = seen.map(f32x8::new);
        Seen8 {
            radiance: [r, g, b],
            pdf,
        }
    }

    /// Integrates by Gauss-Legendre rules in each texel, with 4 by 4 nodes for the value and 3 by 3 for the error; black texels are
    /// skipped. Edges of texels are exact, but lobes of `f` much narrower than a texel are not resolved: `converged` compares the error
    /// with the tolerance.
    fn integrate(&self, f: &dyn Fn(DVec3) -> [f64; 3], sphere: &SphereIntegrator) -> Integral<3> {
        let rules = [GaussLegendre::new(4), GaussLegendre::new(3)];
        let (mut value, mut error) = ([0.0; 3], [0.0; 3]);
        for (k, texel) in self.texels.iter().enumerate() {
            let (i, j, radiance) = (k % self.width, k / self.width, colour(*texel));
            if radiance == [0.0; 3] {
                continue;
            }
            let sums = rules.each_ref().map(|rule| {
                let mut sum = [0.0; 3];
                for [cosine, w] in rule.on(self.edges[j + 1], self.edges[j]) {
                    for [turn, v] in rule.on(
                        i as f64 / self.width as f64,
                        (i + 1) as f64 / self.width as f64,
                    ) {
                        let y = f(Self::direction(turn, cosine));
                        for c in 0..3 {
                            sum[c] += 2.0 * PI * w * v * radiance[c] * y[c];
                        }
                    }
                }
                sum
            });
            for c in 0..3 {
                value[c] += sums[0][c];
                error[c] += (sums[0][c] - sums[1][c]).abs();
            }
        }
        let converged = sphere.tolerance.is_met(&value, &error);
        Integral {
            value,
            error,
            converged,
        }
    }
}
