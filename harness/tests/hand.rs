//! The hand-written kernels of the benches and those of the package against the formulas in `f64`, within the same bounds.
//!
//! They are here and not in the benches: `cargo test` would compile Criterion for them alone.

use core::f64::consts::PI;
use glam::Vec3;
use hairis::columns::{EvalColumns, SampleColumns};
use hairis::model::Bell;
use hairis::params::HairDesc;
use hairis::simd::Level;
use hairis::{Gaussian, HairParams, Material, Published};
use hairis_benches::hand::{Constants, Set};
use hairis_reference::{HairReference, Reference, Shape};
use hairis_variants::Cauchy;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng as _;

/// Rows per hit.
const ROWS: usize = 64;
/// Hits, each on hair of its own.
const HITS: usize = 300;
/// Gaussians end at `2^-115`, and the reference next to denormals.
const NEGLIGIBLE: f64 = 1e-20;

/// Widths of everyday hair, degrees, and of hair that is all one sheen.
const EVERYDAY: [f32; 2] = [1.0, 30.0];
const WIDE: [f32; 2] = [60.0, 60.0];

/// Random hair, directions and numbers.
struct Random(ChaCha8Rng);

impl Random {
    fn new() -> Self {
        Self(ChaCha8Rng::seed_from_u64(0x68_616e_6431))
    }

    fn numbers(&mut self) -> [f32; 3] {
        hairis::random::xi(&mut self.0)
    }

    /// Further than 1e-3 rad from the axis.
    fn direction(&mut self) -> [f32; 3] {
        let [height, turn, _] = self.numbers();
        let u = 2.0 * f64::from(height) - 1.0;
        let (sin, cos) = (f64::from(turn) * core::f64::consts::TAU).sin_cos();
        let plane = (1.0 - u * u).sqrt();
        if plane < 1e-3 {
            self.direction()
        } else {
            [u, plane * cos, plane * sin].map(single)
        }
    }

    /// As far from the opposite side of `wo`: down to 1e-9 rad.
    fn beside_seam(&mut self, wo: [f32; 3]) -> [f32; 3] {
        let [u, v, w] = self.direction().map(f64::from);
        let [log, side, _] = self.numbers().map(f64::from);
        let phi = f64::from(wo[2]).atan2(f64::from(wo[1]))
            + PI
            + 10_f64.powf(-9.0 * log) * (side - 0.5).signum();
        [u, v.hypot(w) * phi.cos(), v.hypot(w) * phi.sin()].map(single)
    }

    /// Numbers whose last is next to an end or to the middle: `phi` next to pi, of R and TRT-g, and of TT.
    fn numbers_beside_seam(&mut self) -> [f32; 3] {
        let ([a, b, _], [log, side, middle]) = (self.numbers(), self.numbers());
        let step = (-24.0 * log).exp2();
        let c = if middle < 0.5 {
            0.5 + 0.5 * step * (side - 0.5).signum()
        } else {
            step
        };
        [
            a,
            b,
            if middle > 0.75 { 1.0 - c } else { c }.min(1.0 - f32::EPSILON / 2.0),
        ]
    }

    /// Hair of some widths, from the least to the most, in degrees. Every third has no TT, which outshines the others at the seam.
    fn hair(&mut self, [least, most]: [f32; 2]) -> HairDesc {
        let mut between = |lo: f32, hi: f32| self.numbers()[0].mul_add(hi - lo, lo);
        let mut width = || between(least, most).to_radians();
        let (beta, gamma_tt, gamma_g) = ([width(), width(), width()], width(), width());
        let mut shift = || between(-15.0, 15.0).to_radians();
        let alpha = [shift(), shift(), shift()];
        let phi_g = between(20.0, 70.0).to_radians();
        let i_g = between(0.2, 5.0);
        let mut color = || [between(0.05, 1.0), between(0.05, 1.0), between(0.05, 1.0)];
        let [i_r, i_tt, i_trt] = [color(), color(), color()];
        let i_tt = if self.numbers()[0] < 1.0 / 3.0 {
            [0.0; 3]
        } else {
            i_tt
        };
        HairDesc {
            alpha,
            beta,
            gamma_tt,
            gamma_g,
            phi_g,
            i_r,
            i_tt,
            i_trt,
            i_g,
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded to single precision"
)]
fn single(x: f64) -> f32 {
    x as f32
}

/// Largest relative errors of values, or weights, and of densities; and largest distance from the sampled direction.
#[derive(Debug, Default)]
struct Worst {
    value: f64,
    pdf: f64,
    apart: f64,
}

fn relative(got: f32, want: f64) -> f64 {
    let error = if want < NEGLIGIBLE {
        0.0
    } else {
        (f64::from(got) / want - 1.0).abs()
    };
    // `max` does not see NaN.
    if got.is_finite() {
        error
    } else {
        f64::INFINITY
    }
}

/// A hit of the tests, with some rows at it.
struct Rows<'a> {
    set: Set,
    level: Level,
    reference: &'a HairReference<f64>,
    constants: &'a Constants,
    params: &'a HairParams,
    wo: [f32; 3],
    columns: [&'a [f32]; 3],
}

/// Calls `visit` with every instruction set and hits, and `check` with the worst errors: of the kernels by hand, and of the package's.
fn visit(
    shape: Shape,
    widths: [f32; 2],
    rows: Draw,
    visit: impl Fn(&Rows<'_>, &mut [Worst; 2]),
    check: impl Fn(&Worst) -> bool,
) {
    for level in Level::available() {
        let Some(set) = Set::of(level) else { continue };
        let (mut random, mut worst) = (Random::new(), <[Worst; 2]>::default());
        for _ in 0..HITS {
            let (desc, wo) = (random.hair(widths), random.direction());
            let params = &HairParams::new(&desc).expect("legal parameters");
            let reference =
                &HairReference::prepare(&params.desc().map(f64::from), shape, wo.map(f64::from));
            let mut columns = [[0.0; ROWS]; 3];
            for i in 0..ROWS {
                for (column, x) in columns.iter_mut().zip(rows(&mut random, wo)) {
                    column[i] = x;
                }
            }
            let columns = columns.each_ref().map(|column| &column[..]);
            let constants = &Constants::new(&desc, wo);
            visit(
                &Rows {
                    set,
                    level,
                    reference,
                    constants,
                    params,
                    wo,
                    columns,
                },
                &mut worst,
            );
        }
        println!("{level} {shape:?}: {worst:?}");
        assert!(
            worst.iter().all(&check),
            "{level} {shape:?}: {worst:?}, by hand and of the package"
        );
    }
}

fn row<const N: usize>(columns: &[[f32; ROWS]; N], i: usize) -> [f32; N] {
    columns.each_ref().map(|column| column[i])
}

/// Draws a row for a shading point seen from a direction.
type Draw = fn(&mut Random, [f32; 3]) -> [f32; 3];

/// Half of the directions anywhere, the others beside the seam.
fn anywhere(random: &mut Random, wo: [f32; 3]) -> [f32; 3] {
    if random.numbers()[0] < 0.5 {
        random.direction()
    } else {
        random.beside_seam(wo)
    }
}

fn eval<B: Bell, const CAUCHY: bool>(
    bell: B,
    shape: Shape,
    (widths, rows): ([f32; 2], Draw),
    bounds: [f64; 2],
) {
    visit(
        shape,
        widths,
        rows,
        |hit, worst| {
            let (mut by_hand, mut ours) = ([[0.0; ROWS]; 4], [[0.0; ROWS]; 4]);
            hit.set.eval::<CAUCHY>(
                hit.constants,
                hit.columns,
                by_hand.each_mut().map(|column| &mut column[..]),
            );
            let [r, g, b, pdf] = ours.each_mut().map(|column| &mut column[..]);
            let bsdf =
                Material::new(&Published(bell), hit.params).prepare(Vec3::from_array(hit.wo));
            let out = EvalColumns {
                value: Some([r, g, b]),
                pdf: Some(pdf),
            };
            bsdf.with_level(hit.level)
                .eval_columns(hit.columns, out)
                .expect("one length");
            for i in 0..ROWS {
                let (value, pdf) = hit
                    .reference
                    .eval_pdf(hit.columns.map(|column| f64::from(column[i])));
                for (out, worst) in [&by_hand, &ours].into_iter().zip(&mut *worst) {
                    let [r, g, b, got] = row(out, i);
                    for (got, want) in [r, g, b].into_iter().zip(value) {
                        worst.value = worst.value.max(relative(got, want));
                    }
                    worst.pdf = worst.pdf.max(relative(got, pdf));
                }
            }
            // The kernels of eight.
            let mut eight = [[0.0; 8]; 4];
            let first = hit
                .columns
                .map(|column| column.first_chunk().expect("at least eight"));
            hit.set
                .eval8::<CAUCHY>(hit.constants, first, eight.each_mut());
            for (column, eight) in by_hand.iter().zip(eight) {
                for (a, b) in column.iter().zip(eight) {
                    assert!(
                        (a / b - 1.0).abs() < 1e-4 || *a < 1e-20,
                        "{a} of a slice, {b} of a packet"
                    );
                }
            }
        },
        |worst| worst.value < bounds[0] && worst.pdf < bounds[1],
    );
}

#[test]
fn gaussian_values_and_densities_are_within_the_bounds() {
    eval::<_, false>(
        Gaussian,
        Shape::Gaussian,
        (EVERYDAY, anywhere),
        [1e-4, 1e-5],
    );
}

/// Wide lobes have no tails to lose digits in. Measured: 7.5e-7 and 4.5e-7 by hand, 1.08e-6 and 6.3e-7 of the package.
#[test]
fn values_of_wide_lobes_are_within_the_bounds() {
    let off_seam = (WIDE, (|random, _| random.direction()) as Draw);
    eval::<_, false>(Gaussian, Shape::Gaussian, off_seam, [1.4e-6, 9.2e-7]);
    eval::<_, true>(Cauchy::PAPER, Shape::Cauchy, off_seam, [1.4e-6, 9.2e-7]);
}

#[test]
fn cauchy_values_and_densities_are_within_the_bounds() {
    eval::<_, true>(
        Cauchy::PAPER,
        Shape::Cauchy,
        (EVERYDAY, anywhere),
        [1e-5, 1e-5],
    );
}

/// Density and weight at the direction that a sample reports; the direction against that of the formulas.
#[test]
fn samples_are_within_the_bounds() {
    visit(
        Shape::Gaussian,
        EVERYDAY,
        |random, _| {
            if random.numbers()[0] < 0.5 {
                random.numbers()
            } else {
                random.numbers_beside_seam()
            }
        },
        |hit, worst| {
            let (mut by_hand, mut ours) = ([[0.0; ROWS]; 7], [[0.0; ROWS]; 7]);
            hit.set.sample::<false>(
                hit.constants,
                hit.columns,
                by_hand.each_mut().map(|column| &mut column[..]),
            );
            let [u, v, w, pdf, r, g, b] = ours.each_mut().map(|column| &mut column[..]);
            let bsdf =
                Material::new(&Published(Gaussian), hit.params).prepare(Vec3::from_array(hit.wo));
            let out = SampleColumns {
                wi: Some([u, v, w]),
                pdf: Some(pdf),
                weight: Some([r, g, b]),
                ..SampleColumns::default()
            };
            bsdf.with_level(hit.level)
                .sample_columns(hit.columns, out)
                .expect("one length");
            // The kernels of eight.
            let mut eight = [[0.0; 8]; 7];
            let first = hit
                .columns
                .map(|column| column.first_chunk().expect("at least eight"));
            hit.set
                .sample8::<false>(hit.constants, first, eight.each_mut());
            for (column, eight) in by_hand.iter().zip(eight) {
                for (a, b) in column.iter().zip(eight) {
                    assert!(
                        (a - b).abs() <= 1e-4 * a.abs() + 1e-6,
                        "{a} of a slice, {b} of a packet"
                    );
                }
            }
            for i in 0..ROWS {
                let xi = hit.columns.map(|column| f64::from(column[i]));
                let want = hit.reference.sample(xi);
                for (out, worst) in [&by_hand, &ours].into_iter().zip(&mut *worst) {
                    let [u, v, w, pdf, r, g, b] = row(out, i);
                    let wi = [u, v, w].map(f64::from);
                    assert!(wi.iter().all(|x| x.is_finite()), "{wi:?}");
                    let apart = wi
                        .iter()
                        .zip(want.wi)
                        .map(|(a, b)| (a - b).powi(2))
                        .sum::<f64>()
                        .sqrt();
                    // Next to its ends 1 less twice the last number has few digits of the angle.
                    if (1e-3..0.999).contains(&xi[2]) {
                        worst.apart = worst.apart.max(apart);
                    }
                    let plane = wi[1].hypot(wi[2]);
                    // The density jumps where the glints are cut, at pi/2.
                    let dot = wi[1] * f64::from(hit.wo[1]) + wi[2] * f64::from(hit.wo[2]);
                    if plane > 1e-3 && dot.abs() > 1e-6 * plane {
                        let (value, density) = hit.reference.eval_pdf(wi);
                        worst.pdf = worst.pdf.max(relative(pdf, density));
                        for (got, value) in [r, g, b].into_iter().zip(value) {
                            worst.value = worst.value.max(relative(got, value * plane / density));
                        }
                    }
                }
            }
        },
        |worst| worst.value < 1e-4 && worst.pdf < 1e-5 && worst.apart < 1e-4,
    );
}
