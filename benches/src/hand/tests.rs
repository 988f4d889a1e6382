//! The hand-written kernels against the formulas in `f64`, within the bounds of the kernels.

use super::{Constants, Set};
use hairis::reference::{HairReference, Parameters, Shape};
use hairis::{HairDesc, HairParams, Level};
use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;

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
        if plane < 1e-3 { self.direction() } else { [u, plane * cos, plane * sin].map(single) }
    }

    /// Hair of some widths, from the least to the most, in degrees.
    fn hair(&mut self, [least, most]: [f32; 2]) -> HairDesc {
        let mut between = |lo: f32, hi: f32| self.numbers()[0].mul_add(hi - lo, lo);
        let mut width = || between(least, most).to_radians();
        let [beta_r, beta_tt, beta_trt, gamma_tt, gamma_g] = [width(), width(), width(), width(), width()];
        let mut shift = || between(-15.0, 15.0).to_radians();
        let [alpha_r, alpha_tt, alpha_trt] = [shift(), shift(), shift()];
        let phi_g = between(20.0, 70.0).to_radians();
        let intensity_g = between(0.2, 5.0);
        let mut color = || [between(0.05, 1.0), between(0.05, 1.0), between(0.05, 1.0)];
        let [intensity_r, intensity_tt, intensity_trt] = [color(), color(), color()];
        HairDesc {
            alpha_r,
            alpha_tt,
            alpha_trt,
            beta_r,
            beta_tt,
            beta_trt,
            gamma_tt,
            gamma_g,
            phi_g,
            intensity_r,
            intensity_tt,
            intensity_trt,
            intensity_g,
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounded to single precision")]
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
    if want < NEGLIGIBLE { 0.0 } else { (f64::from(got) / want - 1.0).abs() }
}

/// Calls `visit` with every instruction set, and hits: the reference, the constants, and three columns of `rows`.
fn visit(
    shape: Shape,
    widths: [f32; 2],
    rows: fn(&mut Random) -> [f32; 3],
    visit: impl Fn(Set, &HairReference<f64>, &Constants, [&[f32]; 3], &mut Worst),
    check: impl Fn(Set, &Worst),
) {
    for set in Level::available().filter_map(Set::of) {
        let (mut random, mut worst) = (Random::new(), Worst::default());
        for _ in 0..HITS {
            let (desc, wo) = (random.hair(widths), random.direction());
            let params = HairParams::new(&desc).expect("legal parameters");
            let reference = HairReference::prepare(&Parameters::from(&params), shape, wo.map(f64::from));
            let mut columns = [[0.0; ROWS]; 3];
            for i in 0..ROWS {
                let row = rows(&mut random);
                for (column, x) in columns.iter_mut().zip(row) {
                    column[i] = x;
                }
            }
            visit(
                set,
                &reference,
                &Constants::new(&desc, wo),
                columns.each_ref().map(|column| &column[..]),
                &mut worst,
            );
        }
        println!("{set:?} {shape:?}: {worst:?}");
        check(set, &worst);
    }
}

fn row<const N: usize>(columns: &[[f32; ROWS]; N], i: usize) -> [f32; N] {
    columns.each_ref().map(|column| column[i])
}

fn eval<const CAUCHY: bool>(shape: Shape, widths: [f32; 2], bounds: [f64; 2]) {
    visit(
        shape,
        widths,
        Random::direction,
        |set, reference, constants, wi, worst| {
            let mut out = [[0.0; ROWS]; 4];
            set.eval::<CAUCHY>(constants, wi, out.each_mut().map(|column| &mut column[..]));
            for i in 0..ROWS {
                let (value, pdf) = reference.eval_pdf(wi.map(|column| f64::from(column[i])));
                let [r, g, b, got] = row(&out, i);
                for (got, want) in [r, g, b].into_iter().zip(value) {
                    worst.value = worst.value.max(relative(got, want));
                }
                worst.pdf = worst.pdf.max(relative(got, pdf));
            }
            // The kernels of eight.
            let mut eight = [[0.0; 8]; 4];
            let first = wi.map(|column| column.first_chunk().expect("at least eight"));
            set.eval8::<CAUCHY>(constants, first, eight.each_mut());
            for (column, eight) in out.iter().zip(eight) {
                for (a, b) in column.iter().zip(eight) {
                    assert!((a / b - 1.0).abs() < 1e-4 || *a < 1e-20, "{set:?}: {a} of a slice, {b} of a packet");
                }
            }
        },
        |set, worst| assert!(worst.value < bounds[0] && worst.pdf < bounds[1], "{set:?} {shape:?}: {worst:?}"),
    );
}

#[test]
fn gaussian_values_and_densities_are_within_the_bounds() {
    eval::<false>(Shape::Gaussian, EVERYDAY, [1e-4, 1e-5]);
}

/// Wide lobes have no tails to lose digits in: the bound of the package's own tests.
#[test]
fn values_of_wide_lobes_are_within_the_bounds() {
    eval::<false>(Shape::Gaussian, WIDE, [1e-6, 9.2e-7]);
    eval::<true>(Shape::Cauchy, WIDE, [1e-6, 9.2e-7]);
}

#[test]
fn cauchy_values_and_densities_are_within_the_bounds() {
    eval::<true>(Shape::Cauchy, EVERYDAY, [1e-5, 1e-5]);
}

/// Density and weight at the direction that a sample reports; the direction against that of the formulas.
#[test]
fn samples_are_within_the_bounds() {
    visit(
        Shape::Gaussian,
        EVERYDAY,
        Random::numbers,
        |set, reference, constants, xi, worst| {
            let mut out = [[0.0; ROWS]; 7];
            set.sample::<false>(constants, xi, out.each_mut().map(|column| &mut column[..]));
            for i in 0..ROWS {
                let [u, v, w, pdf, r, g, b] = row(&out, i);
                let wi = [u, v, w].map(f64::from);
                let want = reference.sample(xi.map(|column| f64::from(column[i])));
                let apart = wi.iter().zip(want.wi).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                worst.apart = worst.apart.max(apart);
                let plane = wi[1].hypot(wi[2]);
                if plane > 1e-3 {
                    let (value, density) = reference.eval_pdf(wi);
                    worst.pdf = worst.pdf.max(relative(pdf, density));
                    for (got, value) in [r, g, b].into_iter().zip(value) {
                        worst.value = worst.value.max(relative(got, value * plane / density));
                    }
                }
            }
        },
        |set, worst| assert!(worst.value < 1e-4 && worst.pdf < 1e-5 && worst.apart < 1e-4, "{set:?}: {worst:?}"),
    );
}
