//! Property that the density of all lobes, and of each alone, integrates to the share of samples that are kept.

use crate::erased::{ErasedBsdf, ErasedSubject, Which};
use crate::failure::{Failure, Outcome, Worst};
use crate::mesh::{Mesh, Samples};
use crate::probe::{Direction, columns, narrow, sobol, some_hits};
use hairis::simd::Level;

/// Kronrod's extension of Gauss' rule of three points, from -1 to 1: node, weight, and Gauss' weight.
const RULE: [[f64; 3]; 7] = [
    [-0.960_491_268_708_020_3, 0.104_656_226_026_467_27, 0.0],
    [
        -0.774_596_669_241_483_4,
        0.268_488_089_868_333_44,
        5.0 / 9.0,
    ],
    [-0.434_243_749_346_802_56, 0.401_397_414_775_962_2, 0.0],
    [0.0, 0.450_916_538_658_474_14, 8.0 / 9.0],
    [0.434_243_749_346_802_56, 0.401_397_414_775_962_2, 0.0],
    [0.774_596_669_241_483_4, 0.268_488_089_868_333_44, 5.0 / 9.0],
    [0.960_491_268_708_020_3, 0.104_656_226_026_467_27, 0.0],
];
const POINTS: usize = RULE.len() * RULE.len();
/// Largest error of a rectangle that is not divided further. The rule is far more accurate than this estimate of its error.
const ERROR: f64 = 1e-7;
/// Largest number of times that a rectangle is halved.
const DEPTH: u32 = 24;
/// Number of rectangles that are integrated in one call.
const ROW: usize = 16;

/// Integral of a function over each rectangle of a mesh.
pub(crate) struct Integral {
    /// Integrals of the rectangles, by inclination, then azimuth.
    pub(crate) mass: Vec<f64>,
    /// Error of the rectangles that could not be resolved.
    pub(crate) unresolved: f64,
}

/// Rectangle to integrate, with the rectangle of the mesh it is part of, and the number of times that was halved.
#[derive(Clone, Copy)]
struct Rectangle {
    theta: [f64; 2],
    phi: [f64; 2],
    of: usize,
    depth: u32,
}

impl Integral {
    /// Integrates `f`, which takes directions by component, times the cosine of their inclination.
    ///
    /// Each rectangle is halved along the angle with the larger error, until its error is small.
    pub(crate) fn new(mesh: &Mesh, mut f: impl FnMut([&[f32]; 3], &mut [f32])) -> Self {
        let [rows, width] = mesh.size();
        let mut todo: Vec<Rectangle> = (0..rows * width)
            .map(|of| {
                let (i, j) = (of / width, of % width);
                let (theta, phi) = (
                    [mesh.theta[i], mesh.theta[i + 1]],
                    [mesh.phi[j], mesh.phi[j + 1]],
                );
                Rectangle {
                    theta,
                    phi,
                    of,
                    depth: 0,
                }
            })
            .collect();
        let mut integral = Self {
            mass: vec![0.0; rows * width],
            unresolved: 0.0,
        };
        let mut buffers = [[0.0; ROW * POINTS]; 4];
        while !todo.is_empty() {
            let some = todo.split_off(todo.len().saturating_sub(ROW));
            let [u, v, w, out] = &mut buffers;
            let mut cosines = [[0.0; RULE.len()]; ROW];
            for (n, rectangle) in some.iter().enumerate() {
                cosines[n] = rectangle.nodes(
                    [&mut *u, &mut *v, &mut *w].map(|x| &mut x[n * POINTS..(n + 1) * POINTS]),
                );
            }
            let used = some.len() * POINTS;
            f([&u[..used], &v[..used], &w[..used]], &mut out[..used]);
            for (n, rectangle) in some.iter().enumerate() {
                integral.add(
                    rectangle,
                    &out[n * POINTS..(n + 1) * POINTS],
                    &cosines[n],
                    &mut todo,
                );
            }
        }
        integral
    }

    /// Adds the integral of a rectangle, or queues its halves.
    fn add(
        &mut self,
        rectangle: &Rectangle,
        values: &[f32],
        cosines: &[f64; RULE.len()],
        todo: &mut Vec<Rectangle>,
    ) {
        let [theta, phi] = [rectangle.theta, rectangle.phi].map(|ends| 0.5 * (ends[1] - ends[0]));
        let (mut fine, mut coarse_theta, mut coarse_phi) = (0.0, 0.0, 0.0);
        for ((row, cos), [_, w_theta, gauss_theta]) in
            values.chunks(RULE.len()).zip(cosines).zip(RULE)
        {
            let (mut sum, mut gauss) = (0.0, 0.0);
            for (value, [_, w, g]) in row.iter().zip(RULE) {
                sum += w * f64::from(*value);
                gauss += g * f64::from(*value);
            }
            fine += w_theta * cos * sum;
            coarse_theta += gauss_theta * cos * sum;
            coarse_phi += w_theta * cos * gauss;
        }
        let area = theta * phi;
        let [by_theta, by_phi] =
            [coarse_theta, coarse_phi].map(|coarse| area * (fine - coarse).abs());
        let error = by_theta.max(by_phi);
        // NaN is not divided, so that the sum becomes NaN.
        if error > ERROR && rectangle.depth < DEPTH {
            let halves = |[lo, hi]: [f64; 2]| [[lo, 0.5 * (lo + hi)], [0.5 * (lo + hi), hi]];
            let depth = rectangle.depth + 1;
            if by_theta > by_phi {
                todo.extend(halves(rectangle.theta).map(|theta| Rectangle {
                    theta,
                    depth,
                    ..*rectangle
                }));
            } else {
                todo.extend(halves(rectangle.phi).map(|phi| Rectangle {
                    phi,
                    depth,
                    ..*rectangle
                }));
            }
            return;
        }
        self.mass[rectangle.of] += area * fine;
        self.unresolved += if error > ERROR { error } else { 0.0 };
    }

    /// Integrates the density of a shading point.
    pub(crate) fn density(bsdf: &dyn ErasedBsdf, mesh: &Mesh) -> Self {
        Self::new(mesh, |wi, out| {
            let written = bsdf.with_level(Level::detect()).pdf_array(wi, out);
            assert!(
                written.is_ok(),
                "slices of one length are accepted: {written:?}"
            );
        })
    }

    /// Returns the whole integral.
    pub(crate) fn total(&self) -> f64 {
        self.mass.iter().sum()
    }
}

impl Rectangle {
    /// Writes the directions of the rule's points, and returns the cosines of their inclinations.
    fn nodes(&self, [u, v, w]: [&mut [f32]; 3]) -> [f64; RULE.len()] {
        let at = |[lo, hi]: [f64; 2], x: f64| 0.5 * (lo + hi) + 0.5 * (hi - lo) * x;
        let azimuths = RULE.map(|[x, ..]| at(self.phi, x).sin_cos());
        let mut cosines = [0.0; RULE.len()];
        for (i, [x, ..]) in RULE.into_iter().enumerate() {
            let (sin, cos) = at(self.theta, x).sin_cos();
            cosines[i] = cos;
            for (j, (sin_phi, cos_phi)) in azimuths.into_iter().enumerate() {
                let Direction { x, y, z } =
                    Direction::new(narrow(sin), narrow(cos * cos_phi), narrow(cos * sin_phi));
                let point = i * RULE.len() + j;
                (u[point], v[point], w[point]) = (x, y, z);
            }
        }
        cosines
    }
}

/// Checks that the density of each lobe alone, and of all together, integrates to the share of samples that are not discarded, and that
/// few samples are discarded.
///
/// # Errors
///
/// Returns the largest error if an integral differs from that share by more than the tolerance or if too many samples are discarded, or a
/// failure if quadrature cannot resolve the density.
pub fn density_integrates_to_one(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "the density integrates to 1";
    let claims = subject.claims();
    let (points, mut samples) = (columns(claims.points, sobol), Samples::default());
    let mut worst = Worst::new(NAME, "the integral (`Claims::integral`)", claims.integral);
    let mut discarded = Worst::new(
        NAME,
        "the share of samples that are kept (`Claims::discarded`)",
        claims.discarded,
    );
    for material in subject.set(Which::Everyday).iter() {
        let name = material.name();
        for hit in some_hits(material.index()) {
            let all = material.prepare(hit);
            for mask in subject.parts() {
                let bsdf = all.with_lobes(mask);
                let at = || format!("{name} {} {hit:?}", subject.lobes(mask));
                let mesh = Mesh::new(subject, material, &hit, &*bsdf, mask, &mut samples);
                let integral = Integral::density(&*bsdf, &mesh);
                if integral.unresolved > claims.integral {
                    let message = format!(
                        "quadrature left {:.1e} unresolved: state the edges. {}",
                        integral.unresolved,
                        at()
                    );
                    return Err(Failure::new(NAME, message));
                }
                let kept = samples.draw(&*bsdf, &points).kept();
                let got = integral.total();
                // A lobe without energy scatters nothing.
                if got == 0.0 && kept == 0.0 {
                    continue;
                }
                discarded.see(1.0 - kept, at);
                worst.see((got - kept).abs(), || {
                    format!("got {got}, kept {kept}. {}", at())
                });
            }
        }
    }
    discarded.report()?;
    worst.report()
}
