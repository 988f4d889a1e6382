//! Distance of models from the truth: light that is traced through fibres.
//!
//! Light is compared by cell of inclination and azimuth, integrated over the cell on both sides, so that no lobe is too narrow to be measured.
//! Fibres are symmetric to the plane of axis and viewer, and cells of equal magnitude of azimuth are joined.

use super::objective::minimise;
use super::points::Points;
use super::{FitConfig, starts};
use glam::Vec3;
use hairis::params::melanin_absorption;
use hairis::{Hit, ParamError};
use hairis_instruments::direction::fibre_direction;
use hairis_instruments::sequence::Independent;
use hairis_reference::truth::{Fiber, Histogram, Lobe, Medulla};
use hairis_variants::{AnyBsdf, ModelId, Values};
use rayon::prelude::*;

/// Parts of the light that models and fibres share: R, TT and everything else, which is TRT, further passages, diffuse lobes and light from the
/// medulla.
pub const PARTS: [&str; 3] = ["R", "TT", "further"];

/// Number of offsets over which near-field models are averaged, as the middles of as many equal parts of the width.
const OFFSETS: u8 = 32;
/// Number of random streams of a view.
const BATCHES: u32 = 64;

/// Returns the fibres of the chapter, with their names.
#[must_use]
pub fn fibers() -> [(&'static str, Fiber); 12] {
    let white = Fiber {
        roughness: 0.15,
        tilt: 2.5_f64.to_radians(),
        ..Fiber::default()
    };
    let colored = |eumelanin, pheomelanin| Fiber {
        sigma_a: melanin_absorption([eumelanin, pheomelanin]).map(f64::from),
        ..white
    };
    let (blond, brown) = (colored(0.3, 0.0), colored(1.3, 0.0));
    let core = |ratio, sigma_s, g| Medulla {
        ratio,
        sigma_s,
        g,
        sigma_a: [0.0; 3],
    };
    [
        ("white", white),
        ("blond", blond),
        ("red", colored(0.2, 1.2)),
        ("brown", brown),
        ("black", colored(8.0, 0.0)),
        (
            "brown, smooth",
            Fiber {
                roughness: 0.08,
                ..brown
            },
        ),
        (
            "brown, rough",
            Fiber {
                roughness: 0.3,
                ..brown
            },
        ),
        (
            "brown, steep scales",
            Fiber {
                tilt: 5.0_f64.to_radians(),
                ..brown
            },
        ),
        (
            "blond, oval",
            Fiber {
                aspect: 1.0 / 1.4,
                ..blond
            },
        ),
        (
            "brown, flat",
            Fiber {
                aspect: 1.0 / 1.89,
                ..brown
            },
        ),
        (
            "white, medulla",
            Fiber {
                medulla: core(0.3, 3.0, 0.6),
                ..white
            },
        ),
        (
            "blond fur",
            Fiber {
                medulla: core(0.75, 2.0, 0.4),
                ..blond
            },
        ),
    ]
}

/// Light that leaves a fibre towards the light sources by view, cell, part and channel, as shares of the light that meets the fibre.
#[derive(Clone, Debug)]
pub struct Lights {
    /// Inclinations of the viewer, rad.
    views: Vec<f64>,
    /// Number of cells of inclination, and of azimuth from 0 to pi.
    size: [usize; 2],
    /// Cells of the whole sphere.
    cells: Histogram,
    light: Vec<Vec<[[f64; 3]; PARTS.len()]>>,
}

/// Difference of the light of two fibres, relative to the light of the first: in all, and for each part to the light of that part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Difference of the sums of all parts.
    pub total: f64,
    /// Differences of the [parts](PARTS).
    pub parts: [f64; PARTS.len()],
}

impl Lights {
    fn new(views: &[f64], size @ [rows, columns]: [usize; 2]) -> Self {
        Self {
            views: views.to_vec(),
            size,
            cells: Histogram::new([rows, 2 * columns]),
            light: Vec::new(),
        }
    }

    /// Traces `paths` paths per view through a fibre, on all cores. `size` is the number of cells of inclination, and of azimuth from 0 to pi.
    #[must_use]
    pub fn traced(fiber: &Fiber, views: &[f64], size: [usize; 2], paths: u32, seed: u64) -> Self {
        let mut lights = Self::new(views, size);
        let empty = || vec![[[0.0; 3]; Lobe::COUNT]; 2 * size[0] * size[1]];
        let added = |mut sums: Vec<[[f64; 3]; Lobe::COUNT]>, batch: Vec<_>| {
            let batch = batch.as_flattened().as_flattened();
            for (sum, x) in sums
                .as_flattened_mut()
                .as_flattened_mut()
                .iter_mut()
                .zip(batch)
            {
                *sum += x / f64::from(BATCHES);
            }
            sums
        };
        for (place, view) in (0..).zip(views) {
            let wo = fibre_direction(*view, 0.0).to_array();
            let batch = |batch: u32| {
                let stream = u64::from(place * BATCHES + batch);
                let mut xi = Independent::new(seed, stream);
                let mut light = lights.cells.clone();
                light.add(paths.div_ceil(BATCHES), &mut || {
                    fiber.trace(wo, &mut || xi.next_f64())
                });
                light.means()
            };
            // A sum in order, so that equal seeds give equal bits.
            let batches: Vec<_> = (0..BATCHES).into_par_iter().map(batch).collect();
            let sphere = batches.into_iter().fold(empty(), added);
            let mut folded = vec![[[0.0; 3]; PARTS.len()]; size[0] * size[1]];
            for (cell, light) in sphere.into_iter().enumerate() {
                let (row, column) = (cell / (2 * size[1]), cell % (2 * size[1]));
                let away = if column < size[1] {
                    size[1] - 1 - column
                } else {
                    column - size[1]
                };
                for (lobe, light) in light.into_iter().enumerate() {
                    let part = &mut folded[row * size[1] + away][lobe.min(PARTS.len() - 1)];
                    for (sum, x) in part.iter_mut().zip(light) {
                        *sum += x;
                    }
                }
            }
            lights.light.push(folded);
        }
        lights
    }

    /// Integrates a model over the cells, by two Gauss nodes in either direction.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of its range.
    pub fn of_model(
        model: ModelId,
        values: &Values,
        views: &[f64],
        size: [usize; 2],
    ) -> Result<Self, ParamError> {
        let mut lights = Self::new(views, size);
        let material = model.material(values)?;
        let part_of = |name: &&str| match *name {
            "r" => 0,
            "tt" => 1,
            _ => 2,
        };
        let parts: Vec<usize> = model.lobes().iter().map(part_of).collect();
        for view in views {
            let wo = fibre_direction(*view, 0.0).as_vec3();
            let offsets = offsets(model);
            let bsdfs: Vec<AnyBsdf> = offsets
                .iter()
                .map(|h| material.prepare(Hit::new(wo, *h)))
                .collect();
            let cell = |place: usize| {
                let [[low, high], [from, to]] = lights.cells.ends(lights.place(place));
                let mut light = [[0.0; 3]; PARTS.len()];
                for [s, t] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
                    let node = |low: f64, high: f64, sign: f64| {
                        0.5 * (low + high) + sign * (high - low) / 12.0_f64.sqrt()
                    };
                    let theta = node(low, high, s);
                    // Both sides of the plane, and a quarter per node.
                    let cos = theta.cos();
                    let weight = 0.5 * (high - low) * (to - from) * cos * cos;
                    let wi = fibre_direction(theta, node(from, to, t)).as_vec3();
                    for bsdf in &bsdfs {
                        for (lobe, part) in bsdf.lobes(wi).0.iter().zip(&parts) {
                            for (sum, color) in light[*part].iter_mut().zip(lobe.color) {
                                *sum += weight * f64::from(lobe.value) * f64::from(color)
                                    / bsdfs.len() as f64;
                            }
                        }
                    }
                }
                light
            };
            let light = (0..size[0] * size[1]).into_par_iter().map(cell).collect();
            lights.light.push(light);
        }
        Ok(lights)
    }

    /// Returns the number on the whole sphere of a joined cell, on the side of positive azimuths.
    fn place(&self, cell: usize) -> usize {
        let [_, columns] = self.size;
        cell / columns * 2 * columns + columns + cell % columns
    }

    /// Returns the light of a view by cell, part and channel.
    #[must_use]
    pub fn view(&self, view: usize) -> &[[[f64; 3]; PARTS.len()]] {
        &self.light[view]
    }

    /// Returns the light of each part, as the mean over views and channels.
    #[must_use]
    pub fn energies(&self) -> [f64; PARTS.len()] {
        core::array::from_fn(|part| {
            let cells = self.light.iter().flatten();
            let sum: f64 = cells.flat_map(|cell| cell[part]).sum();
            sum / 3.0 / self.light.len() as f64
        })
    }

    /// Returns the difference of the light of `other`, summed over views, cells and channels.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Difference {
        let pairs = || {
            self.light
                .iter()
                .flatten()
                .zip(other.light.iter().flatten())
        };
        let ratio = |of: &dyn Fn(&[[f64; 3]; PARTS.len()], usize) -> f64| {
            let (mut apart, mut own) = (0.0, 0.0);
            for (a, b) in pairs() {
                for channel in 0..3 {
                    let (a, b) = (of(a, channel), of(b, channel));
                    apart += (a - b).abs();
                    own += a;
                }
            }
            apart / own
        };
        Difference {
            total: ratio(&|cell, channel| cell.iter().map(|part| part[channel]).sum()),
            parts: core::array::from_fn(|part| ratio(&|cell, channel| cell[part][channel])),
        }
    }

    /// Returns the values of a model that are nearest in L1, found from `count` starts: the measured preset, the others, and values around
    /// those. The optimiser compares the means of S of the cells with S in their middles; of the ends and starts, that with the least
    /// [`difference`](Self::difference) is returned, with the light of the model.
    ///
    /// # Errors
    ///
    /// Returns no error for models of the registry, whose presets are in their ranges.
    ///
    /// # Panics
    ///
    /// Panics if `count` is 0.
    pub fn fit(&self, to: ModelId, count: usize) -> Result<(Values, Self), ParamError> {
        let config = FitConfig {
            starts: count,
            ..FitConfig::default()
        };
        let measured = to.measured();
        let mut given = vec![measured];
        let presets = to.presets().map(|(_, values)| values);
        given.extend(presets.filter(|values| *values != measured));
        let starts = starts(&given, &config);
        let points = self.points(to);
        let candidates = starts.par_iter().map(|start| {
            let (end, _) = minimise(to, start, &points, &config)?;
            let at = |values: Values| {
                let light = Self::of_model(to, &values, &self.views, self.size)?;
                Ok((self.difference(&light).total, values, light))
            };
            Ok([at(*start)?, at(end)?])
        });
        let candidates = candidates.collect::<Result<Vec<_>, ParamError>>()?;
        let nearest = candidates.into_iter().flatten();
        let (_, values, light) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)).expect("a start");
        Ok((values, light))
    }

    /// Returns the middles of the cells as points of the optimiser, with the mean of S of each cell.
    fn points(&self, to: ModelId) -> Points {
        let mut points = Points {
            views: Vec::new(),
            offsets: offsets(to),
            wi: Vec::new(),
            weights: Vec::new(),
            view_weights: vec![1.0; self.views.len()],
            look: Vec::new(),
            blurs: None,
        };
        for (view, light) in self.views.iter().zip(&self.light) {
            let directions = (0..light.len()).map(|cell| {
                let [theta, phi] = self
                    .cells
                    .ends(self.place(cell))
                    .map(|[low, high]| 0.5 * (low + high));
                fibre_direction(theta, phi).as_vec3()
            });
            let directions: Vec<Vec3> = directions.collect();
            points.views.push(fibre_direction(*view, 0.0).as_vec3());
            points
                .wi
                .push([0, 1, 2].map(|k| directions.iter().map(|wi| wi[k]).collect()));
            let measure = |cell: usize| 2.0 * self.cells.measure(self.place(cell));
            let weights = directions
                .iter()
                .enumerate()
                .map(|(cell, wi)| [measure(cell), f64::from(wi.y).hypot(f64::from(wi.z))]);
            points.weights.push(weights.collect());
            let values = light.iter().enumerate().map(|(cell, parts)| {
                let sum = |c: usize| parts.iter().map(|part| part[c]).sum::<f64>();
                [0, 1, 2].map(|c| sum(c) / measure(cell))
            });
            points.look.push(values.collect());
        }
        points
    }
}

/// Returns the offsets over which a model is averaged.
fn offsets(model: ModelId) -> Vec<f32> {
    let middle = |i: u8| 2.0 * (f32::from(i) + 0.5) / f32::from(OFFSETS) - 1.0;
    if model.is_near_field() {
        (0..OFFSETS).map(middle).collect()
    } else {
        vec![0.0]
    }
}
