//! Property that samples of Sobol points have the distribution of the density, to the evenness of the points. This is a far sharper test
//! than random samples.

use crate::erased::{ErasedSubject, Which};
use crate::failure::{Outcome, Worst};
use crate::integral::Integral;
use crate::mesh::{Mesh, Samples};
use crate::probe::{columns, sobol, some_hits};

/// Factor on the tolerance for two dimensions, in which the points are less even than in one.
const BOTH: f64 = 4.0;

/// Checks that the cumulative distribution of samples of Sobol points is that of the density: in inclination, in azimuth, and in both, to
/// four times the tolerance. Each lobe is tested alone and all are tested together, so that a lobe drawn with the wrong probability
/// shows.
///
/// # Errors
///
/// Returns the largest error if a distribution differs by more than the tolerance.
pub fn even_points_invert_density(subject: &dyn ErasedSubject) -> Outcome {
    const NAME: &str = "even points invert the density";
    let claims = subject.claims();
    let (points, mut samples) = (columns(claims.points, sobol), Samples::default());
    let mut worst = Worst::new(
        NAME,
        "the cdf of one angle (`Claims::inversion`)",
        claims.inversion,
    );
    let mut joint = Worst::new(
        NAME,
        "the cdf of both angles (`Claims::inversion`)",
        BOTH * claims.inversion,
    );
    for material in subject.set(Which::Everyday).iter() {
        let name = material.name();
        for hit in some_hits(material.index()) {
            let all = material.prepare(hit);
            for mask in subject.parts() {
                let bsdf = all.with_lobes(mask);
                let mesh = Mesh::new(subject, material, &hit, &*bsdf, mask, &mut samples);
                let [rows, width] = mesh.size();
                // Share of the samples less the expected share.
                let mut mass: Vec<f64> = Integral::density(&*bsdf, &mesh)
                    .mass
                    .iter()
                    .map(|mass| -mass)
                    .collect();
                let share = 1.0 / f64::from(claims.points);
                for direction in samples.draw(&*bsdf, &points).live() {
                    let [i, j] = mesh.find(direction);
                    mass[i * width + j] += share;
                }
                // Sums over all rectangles up to a row and a column.
                let mut above = vec![0.0; width];
                for i in 0..rows {
                    let mut left = 0.0;
                    for j in 0..width {
                        left += mass[i * width + j];
                        above[j] += left;
                        let at = || {
                            format!(
                                "up to theta {:.5} phi {:.5}, {name} {} {hit:?}",
                                mesh.theta[i + 1],
                                mesh.phi[j + 1],
                                subject.lobes(mask)
                            )
                        };
                        joint.see(above[j].abs(), at);
                        if i + 1 == rows || j + 1 == width {
                            worst.see(above[j].abs(), at);
                        }
                    }
                }
            }
        }
    }
    joint.report()?;
    worst.report()
}
