//! Ellipsoid of skin that is fitted to the roots of hair.

use crate::geometry::{HEAD, Strands};
use crate::linear::solve;
use crate::scene::Ellipsoid;
use clap::ValueEnum;
use glam::{DVec3, Vec3};

/// Source of the ellipsoid under hair from a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Scalp {
    /// Fitted to the roots
    Auto,
}

/// Least number of roots that make a surface.
const FEWEST: usize = 10;
/// Largest number of roots that are used, evenly spread.
const MOST: usize = 20_000;
/// Multiple of the median distance from their median, beyond which roots are not on the scalp.
const STRAY: f64 = 3.0;
/// Weight of the proportions of a head against the mean squared distance of the roots, in units of
/// their spread. It decides where roots cover too little of a head to show its shape, and moves the
/// axes of a covered head by less than a hundredth.
const PRIOR: f64 = 1e-3;
/// Logarithm of the largest factor between the proportions of a scalp and those of a head. A limit is
/// needed because strips of roots, as of a mohawk, fit long and narrow ellipsoids better than any head.
const DISPROPORTION: f64 = 0.3;
/// Weight of proportions beyond that limit.
const BARRIER: f64 = 10.0;
/// Distances in units of the spread up to which roots count in full. Farther roots count less and less,
/// because some are not on the scalp. Each is used in turn, as the fit comes nearer.
const OUTLIERS: [f64; 2] = [1.0, 0.2];
/// Largest number of rounds of least squares, which end sooner once gains are negligible.
const ROUNDS: usize = 200;
/// Share of the roots that may lie below the surface ...
const BELOW: f64 = 0.02;
/// ... which is this much smaller than the ellipsoid through them, so that strands begin above it.
const CLEARANCE: f64 = 0.995;
/// Largest median distance of roots from the surface of a scalp, relative to its radius.
const WORST: f64 = 0.15;
/// Largest half axis of a scalp in units of the spread of the roots, which is about 1.3 for a covered head.
/// It is larger if the roots are on a plane, or go down a back.
const FLATTEST: f64 = 2.5;

/// Ellipsoid that was fitted to the roots of hair, with its distance from them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Ellipsoid of skin, a little below the roots.
    pub ellipsoid: Ellipsoid,
    /// Median distance of the roots from the ellipsoid through them, in centimetres.
    pub distance: f32,
    /// Number of roots that were fitted.
    pub roots: usize,
}

/// Fits an ellipsoid along the axes to the roots of strands.
///
/// # Errors
///
/// Returns a line of text if there are too few roots, or if they do not lie on an ellipsoid.
pub fn fit(strands: &Strands) -> Result<Fit, String> {
    let root = |strand| strands.node_position(strands.nodes_of(strand).start);
    let mut roots: Vec<DVec3> = (0..)
        .take(strands.strands())
        .step_by(strands.strands() / MOST + 1)
        .map(|strand| root(strand).as_dvec3())
        .collect();
    if roots.len() < FEWEST {
        return Err(format!(
            "--scalp auto must have at least {FEWEST} strands, got {}",
            roots.len()
        ));
    }
    let middle = median(&roots);
    let mut distances: Vec<f64> = roots.iter().map(|root| root.distance(middle)).collect();
    distances.sort_by(f64::total_cmp);
    let reach = STRAY * part(&distances, 0.5);
    roots.retain(|root| root.distance(middle) <= reach);
    let mean = roots.iter().sum::<DVec3>() / roots.len() as f64;
    let spread = roots
        .iter()
        .map(|root| root.distance_squared(mean))
        .sum::<f64>();
    let size = (spread / roots.len() as f64).sqrt();
    let refused = |what: &str| {
        Err(format!(
            "--scalp auto must have roots on an ellipsoid, {what}: use --head, or check that strands begin at their roots"
        ))
    };
    if size.is_nan() || size < 1e-6 {
        return refused("got all at one place");
    }
    // Measure in units of the spread of the roots.
    let places: Vec<DVec3> = roots.iter().map(|root| (*root - mean) / size).collect();
    // Roots lie on the upper side, so begin below them.
    let proportions = HEAD.as_dvec3() / HEAD.as_dvec3().element_product().cbrt();
    let start = Surface {
        centre: DVec3::new(0.0, -0.5, 0.0),
        logs: proportions.map(|p| (1.2 * p).ln()),
    };
    let improved = OUTLIERS.into_iter().try_fold(start, |surface, outlier| {
        surface.improve(&places, proportions, outlier)
    });
    let Some(surface) = improved else {
        return refused("got a surface without a bound");
    };
    let radii = surface.radii();
    let mut depths: Vec<f64> = places.iter().map(|place| surface.depth(*place)).collect();
    depths.sort_by(f64::total_cmp);
    let mut distances: Vec<f64> = depths.iter().map(|depth| (depth - 1.0).abs()).collect();
    distances.sort_by(f64::total_cmp);
    let distance = part(&distances, 0.5);
    if distance > WORST {
        return refused(&format!(
            "got a median distance of {distance:.2} of its radius"
        ));
    }
    if radii.max_element() > FLATTEST {
        return refused("got roots on a plane, or on a small part of a surface");
    }
    let shrink = part(&depths, BELOW).min(1.0) * CLEARANCE * size;
    let length = radii.element_product().cbrt() * size;
    #[expect(clippy::cast_possible_truncation, reason = "rounded to the nearest")]
    let distance = (distance * length) as f32;
    Ok(Fit {
        ellipsoid: Ellipsoid {
            centre: (mean + size * surface.centre).as_vec3(),
            radii: (shrink * radii).as_vec3(),
        },
        distance,
        roots: roots.len(),
    })
}

/// Returns the number below which a share of sorted numbers lies.
fn part(sorted: &[f64], share: f64) -> f64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a place in a list"
    )]
    let place = (share * (sorted.len() - 1) as f64).round() as usize;
    sorted[place]
}

/// Returns the median along each axis.
fn median(places: &[DVec3]) -> DVec3 {
    let along = |axis: usize| {
        let mut all: Vec<f64> = places.iter().map(|place| place[axis]).collect();
        all.sort_by(f64::total_cmp);
        part(&all, 0.5)
    };
    DVec3::new(along(0), along(1), along(2))
}

impl core::fmt::Display for Fit {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Ellipsoid { centre, radii } = self.ellipsoid;
        let three = |v: Vec3| format!("{:.2} x {:.2} x {:.2}", v.x, v.y, v.z);
        write!(
            f,
            "scalp: an ellipsoid of {} cm about ({:.2}, {:.2}, {:.2}), a median of {:.3} cm from {} roots",
            three(radii),
            centre.x,
            centre.y,
            centre.z,
            self.distance,
            self.roots
        )
    }
}

/// Ellipsoid, by its centre and the logarithms of its half axes.
#[derive(Clone, Copy)]
struct Surface {
    centre: DVec3,
    logs: DVec3,
}

impl Surface {
    fn radii(&self) -> DVec3 {
        self.logs.map(f64::exp)
    }

    /// Returns the distance from the centre in radii, which is 1 on the surface.
    fn depth(&self, place: DVec3) -> f64 {
        ((place - self.centre) / self.radii()).length()
    }

    /// Returns the approximate distance from the surface. In radii, the distance would be least for the largest ellipsoid.
    fn off(&self, place: DVec3) -> f64 {
        (self.depth(place) - 1.0) * self.size()
    }

    /// Returns the geometric mean of the half axes.
    fn size(&self) -> f64 {
        (self.logs.element_sum() / 3.0).exp()
    }

    /// Returns the cost that the fit minimises.
    fn cost(&self, places: &[DVec3], proportions: DVec3, outlier: f64) -> f64 {
        let of = |place: &DVec3| {
            let off = self.off(*place) / outlier;
            outlier * outlier * (off * off).ln_1p()
        };
        places.iter().map(of).sum::<f64>() / places.len() as f64
            + PRIOR * self.disproportion(proportions).length_squared()
            + BARRIER * excess(self.disproportion(proportions)).length_squared()
    }

    /// Returns the differences of the logarithms from those of a head of any size.
    fn disproportion(&self, proportions: DVec3) -> DVec3 {
        let off = self.logs - proportions.map(f64::ln);
        off - off.element_sum() / 3.0
    }

    /// Minimises the cost by Levenberg and Marquardt's method, or returns `None` if there is no finite solution.
    fn improve(mut self, places: &[DVec3], proportions: DVec3, outlier: f64) -> Option<Self> {
        let mut damping = 1e-2;
        let mut cost = self.cost(places, proportions, outlier);
        for _ in 0..ROUNDS {
            let (mut matrix, slope) = self.normal_equations(places, proportions, outlier);
            for (k, row) in matrix.iter_mut().enumerate() {
                row[k] *= 1.0 + damping;
                row[k] += 1e-12;
            }
            let step = solve(&mut matrix, &slope)?;
            let next = Self {
                centre: self.centre - DVec3::new(step[0], step[1], step[2]),
                logs: self.logs
                    - DVec3::new(step[3], step[4], step[5])
                        .clamp(DVec3::splat(-0.5), DVec3::splat(0.5)),
            };
            let next_cost = next.cost(places, proportions, outlier);
            if next_cost < cost {
                let gain = (cost - next_cost) / cost;
                (self, cost, damping) = (next, next_cost, damping * 0.3);
                if gain < 1e-12 {
                    break;
                }
            } else {
                damping *= 4.0;
                if damping > 1e12 {
                    break;
                }
            }
        }
        (self.centre.is_finite() && self.logs.is_finite()).then_some(self)
    }

    /// Returns the matrix and the right side of the linear problem.
    fn normal_equations(
        &self,
        places: &[DVec3],
        proportions: DVec3,
        outlier: f64,
    ) -> ([[f64; 6]; 6], [f64; 6]) {
        let (mut matrix, mut slope) = ([[0.0; 6]; 6], [0.0; 6]);
        let mut add = |row: [f64; 6], off: f64, weight: f64| {
            for i in 0..6 {
                slope[i] += weight * row[i] * off;
                for j in 0..6 {
                    matrix[i][j] += weight * row[i] * row[j];
                }
            }
        };
        let radii = self.radii();
        for place in places {
            let scaled = (*place - self.centre) / radii;
            let depth = scaled.length().max(1e-9);
            let off = self.off(*place);
            let centre = -self.size() * scaled / radii / depth;
            let logs = -self.size() * scaled * scaled / depth + off / 3.0;
            let weight = 1.0 / (1.0 + (off / outlier).powi(2)) / places.len() as f64;
            let row = [centre.x, centre.y, centre.z, logs.x, logs.y, logs.z];
            add(row, off, weight);
        }
        for (axis, off) in self
            .disproportion(proportions)
            .to_array()
            .into_iter()
            .enumerate()
        {
            let mut row = [0.0; 6];
            row[3..].fill(-1.0 / 3.0);
            row[3 + axis] += 1.0;
            add(row, off, PRIOR);
            let off = excess(DVec3::splat(off)).x;
            if off != 0.0 {
                add(row, off, BARRIER);
            }
        }
        (matrix, slope)
    }
}

/// Returns the parts of differences of logarithms beyond the limit.
fn excess(off: DVec3) -> DVec3 {
    off - off.clamp(DVec3::splat(-DISPROPORTION), DVec3::splat(DISPROPORTION))
}
