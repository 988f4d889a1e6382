//! Samples compared with densities: chi-square on the sphere and Kolmogorov-Smirnov on the line, a million eight-lane samples each, from
//! fixed seeds. A red test here is a bug.

use core::f64::consts::{FRAC_PI_2, PI};
use core::fmt::Write as _;
use glam::Vec3;
use hairis::params::HairDesc;
use hairis::simd::f32x8;
use hairis::{HairParams, Lobe, LobeMask, Sample8};
use hairis_conformance::cases;
use hairis_conformance::statistics::{AngleEdges, ChiSquare, chi_square, ks_statistic};
use hairis_instruments::sequence::Independent;
use hairis_instruments::stats::sidak;
use hairis_reference::{HairReference, MatchedReference, Reference, Shape};
use hairis_variants::{ModelId, Parameters as _};

/// Number of samples of a test in CI, and of the control in every size.
const SAMPLES: usize = 1_000_000;
/// Returns the number of samples of a test in this size, a multiple of eight.
fn samples() -> usize {
    cases(SAMPLES / 8) * 8
}

/// Inclinations of the viewer in degrees. Errors of the bounds show at the tilted and grazing ones.
const THETA_O: [f32; 4] = [0.0, 45.0, 85.0, -80.0];
/// Cosine of the caps in which samples are discarded.
const GRAZING: f64 = 1e-5;
/// Number of chi-square tests of the whole grid: models, samplers, materials, inclinations, four lobes and their mixture.
const TESTS: usize = 2 * SAMPLERS * 3 * 4 * 5;
/// Number of samplers of the registry: the published one and the matched one. The conformance suite tests other numbers of bands.
const SAMPLERS: usize = 2;

/// Returns the default set, the same with every width 0.5 degrees and with every width 60 degrees; all are tilted.
fn materials() -> [(&'static str, HairParams); 3] {
    let all = |degrees: f32| {
        let width = degrees.to_radians();
        let desc = HairDesc {
            beta: [width; 3],
            gamma_tt: width,
            gamma_g: width,
            ..*HairParams::bright().desc()
        };
        HairParams::new(&desc).unwrap()
    };
    [
        ("default", HairParams::bright()),
        ("narrow", all(0.5)),
        ("wide", all(60.0)),
    ]
}

/// Returns the default set with every width times `factor`.
fn widened(factor: f32) -> HairParams {
    let d = *HairParams::bright().desc();
    HairParams::new(&d.with_width_factor(factor)).unwrap()
}

fn wo(degrees: f32) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec3::new(sin, cos * 0.6, cos * -0.8)
}

fn double(v: Vec3) -> [f64; 3] {
    [f64::from(v.x), f64::from(v.y), f64::from(v.z)]
}

/// Returns sine and cosine of `theta_i` and of `phi_o - phi_i`, each pair times a length.
fn sides(wo: Vec3, wi: Vec3) -> [[f64; 2]; 2] {
    let ([_, v_o, w_o], [u, v, w]) = (double(wo), double(wi));
    [
        [u, (v * v + w * w).sqrt()],
        [v * w_o - w * v_o, v * v_o + w * w_o],
    ]
}

/// Returns `theta_i` and `phi_o - phi_i` in (-pi, pi].
fn angles(wo: Vec3, wi: Vec3) -> [f64; 2] {
    sides(wo, wi).map(|[sin, cos]| sin.atan2(cos))
}

/// Function that draws samples of some lobes of a shading point.
type Draw = Box<dyn Fn(&[f32x8; 3]) -> Sample8>;

/// Returns a function that prepares samples of a model of the registry.
fn registered(model: ModelId) -> impl Fn(&HairParams, Vec3, LobeMask) -> Draw {
    move |params, wo, mask| {
        let bsdf = model
            .material(&params.values())
            .unwrap()
            .prepare(wo)
            .with_lobes(mask);
        Box::new(move |xi| bsdf.sample8(xi))
    }
}

/// Calls `f` with each of `count` samples, a multiple of eight, or with `None` for a discarded one.
fn for_each_sample(draw: &Draw, stream: u64, count: usize, mut f: impl FnMut(Option<Vec3>)) {
    let mut xi = Independent::new(2012, stream);
    for _ in 0..count / 8 {
        let packet = core::array::from_fn(|_| f32x8::new(core::array::from_fn(|_| xi.next_f32())));
        let eight = draw(&packet);
        for lane in 0..8 {
            f((eight.live() >> lane & 1 == 1).then(|| eight.wi.lane(lane)));
        }
    }
}

/// Sampler in double precision.
trait ReferenceSampler: Reference<f64> {
    fn sample_theta(&self, lobe: Lobe, xi: f64) -> f64;
    fn sample_phi(&self, lobe: Lobe, xi: f64) -> f64;
    fn cdf_theta(&self, lobe: Lobe, theta_i: f64) -> f64;
    fn cdf_phi(&self, lobe: Lobe, phi: f64) -> f64;
}

macro_rules! reference_sampler {
    ($($Book:ident)*) => { $(
        impl ReferenceSampler for $Book<f64> {
            fn sample_theta(&self, lobe: Lobe, xi: f64) -> f64 {
                self.sample_theta(lobe, xi)
            }
            fn sample_phi(&self, lobe: Lobe, xi: f64) -> f64 {
                self.sample_phi(lobe, xi)
            }
            fn cdf_theta(&self, lobe: Lobe, theta_i: f64) -> f64 {
                self.cdf_theta(lobe, theta_i)
            }
            fn cdf_phi(&self, lobe: Lobe, phi: f64) -> f64 {
                self.cdf_phi(lobe, phi)
            }
        }
    )* };
}
reference_sampler! { HairReference MatchedReference }

/// Returns a function that prepares the published sampler of a shape.
fn published(shape: Shape) -> impl Fn(&HairParams, Vec3) -> HairReference<f64> {
    move |params, wo| HairReference::prepare(&params.desc().map(f64::from), shape, double(wo))
}

/// Returns a function that prepares the matched sampler of a shape.
fn matched(shape: Shape) -> impl Fn(&HairParams, Vec3) -> MatchedReference<f64> {
    move |params, wo| MatchedReference::prepare(&params.desc().map(f64::from), shape, double(wo), 9)
}

/// Cells in `theta_i` and `phi` that resolve every lobe, and the number of samples that each should hold.
struct SphereCells {
    theta: Vec<f64>,
    phi: Vec<f64>,
    /// Edges of the inclinations and azimuths.
    edges: [AngleEdges; 2],
    /// Expected numbers, row by row, then one for the caps, whose samples are discarded.
    expected: Vec<f64>,
    /// Number of samples.
    count: usize,
}

impl SphereCells {
    fn new(reference: &impl ReferenceSampler, mask: LobeMask, count: usize) -> Self {
        let share = reference.probabilities().0;
        let of = |lobe: Lobe| share[lobe.index()] * f64::from(mask.factor(lobe));
        let total: f64 = Lobe::FOUR.into_iter().map(of).sum();
        let inner = FRAC_PI_2 - GRAZING;
        let (mut theta, mut phi) = (
            vec![-inner, inner],
            vec![-PI, -FRAC_PI_2, 0.0, FRAC_PI_2, PI],
        );
        for i in 1..12 {
            let even = f64::from(i) / 12.0;
            theta.push(inner * (2.0 * even - 1.0));
            phi.push(PI * (2.0 * even - 1.0));
            for lobe in Lobe::FOUR.into_iter().filter(|lobe| mask.contains(*lobe)) {
                theta.push(reference.sample_theta(lobe, even));
                let drawn = reference.sample_phi(lobe, even);
                phi.push(if drawn > PI { drawn - 2.0 * PI } else { drawn });
            }
        }
        let tidy = |edges: &mut Vec<f64>, end: f64| {
            edges.retain(|x| x.abs() <= end);
            edges.sort_by(f64::total_cmp);
            // Edges closer than a float resolves are merged.
            edges.dedup_by(|a, b| *a - *b < 1e-5);
        };
        tidy(&mut theta, inner);
        tidy(&mut phi, PI);
        let mut expected = vec![0.0; (theta.len() - 1) * (phi.len() - 1) + 1];
        for lobe in Lobe::FOUR.into_iter().filter(|lobe| mask.contains(*lobe)) {
            let number = count as f64 * of(lobe) / total;
            // Every cdf of phi ascends from -pi to 0 and from 0 to pi, and some cdfs jump between.
            let part = |ends: &[f64]| {
                let end = if ends[1] == 0.0 {
                    -f64::MIN_POSITIVE
                } else {
                    ends[1]
                };
                let start = if ends[0] == -PI { -PI + 1e-15 } else { ends[0] };
                reference.cdf_phi(lobe, end) - reference.cdf_phi(lobe, start)
            };
            let columns: Vec<f64> = phi.windows(2).map(part).collect();
            let mut cells = expected.iter_mut();
            for row in theta.windows(2) {
                let row = reference.cdf_theta(lobe, row[1]) - reference.cdf_theta(lobe, row[0]);
                columns
                    .iter()
                    .zip(&mut cells)
                    .for_each(|(column, cell)| *cell += number * row * column);
            }
            let caps = reference.cdf_theta(lobe, -inner) + 1.0 - reference.cdf_theta(lobe, inner);
            *expected.last_mut().unwrap() += number * caps;
        }
        let edges = [AngleEdges::new(&theta), AngleEdges::new(&phi)];
        Self {
            theta,
            phi,
            edges,
            expected,
            count,
        }
    }

    fn index(&self, wo: Vec3, wi: Vec3) -> usize {
        let [theta, phi] = sides(wo, wi);
        let row = self.edges[0].below(theta);
        let column = self.edges[1].below(phi).clamp(1, self.phi.len() - 1);
        let inside = (1..self.theta.len()).contains(&row);
        if inside {
            (row - 1) * (self.phi.len() - 1) + column - 1
        } else {
            self.expected.len() - 1
        }
    }

    /// Counts the samples and tests them.
    fn test(&self, draw: &Draw, wo: Vec3, stream: u64) -> (ChiSquare, Vec<u64>) {
        let mut observed = vec![0; self.expected.len()];
        for_each_sample(draw, stream, self.count, |wi| {
            let cell = wi.map_or(self.expected.len() - 1, |wi| self.index(wo, wi));
            observed[cell] += 1;
        });
        (chi_square(&observed, &self.expected, 5.0), observed)
    }

    /// Writes both tables to a file for inspection of a failure, and returns its path.
    fn dump(&self, observed: &[u64], name: &str) -> String {
        let mut text = String::from("theta_from,theta_to,phi_from,phi_to,observed,expected\n");
        let mut cells = observed.iter().zip(&self.expected);
        for theta in self.theta.windows(2) {
            for (phi, (o, e)) in self.phi.windows(2).zip(&mut cells) {
                writeln!(
                    text,
                    "{},{},{},{},{o},{e}",
                    theta[0], theta[1], phi[0], phi[1]
                )
                .unwrap();
            }
        }
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"))
            .join(format!("{}.csv", name.replace(' ', "-")));
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    }
}

/// Returns the lobes one by one, and their mixture.
fn masks() -> impl Iterator<Item = (String, LobeMask)> {
    let alone = Lobe::FOUR
        .into_iter()
        .map(|lobe| (format!("{lobe:?}"), LobeMask::of(&[lobe])));
    alone.chain([("mixture".to_owned(), LobeMask::ALL)])
}

fn check<T: ReferenceSampler>(
    draw: impl Fn(&HairParams, Vec3, LobeMask) -> Draw,
    reference: impl Fn(&HairParams, Vec3) -> T,
    shape: &str,
    seed: u64,
) {
    let level = sidak(0.01, TESTS);
    let (mut least, mut least_at, mut stream) = (1.0_f64, String::new(), seed * 1000);
    let count = samples();
    for (name, params) in materials() {
        for degrees in THETA_O {
            let wo = wo(degrees);
            let reference = reference(&params, wo);
            for (lobe, mask) in masks() {
                stream += 1;
                // A Gaussian lobe so far off the sphere is cut to 0 (at 2^-115 of its peak) across its tail, so that part of its samples
                // are discarded, as they must be.
                let share: f64 = Lobe::FOUR
                    .iter()
                    .map(|l| reference.probabilities()[*l] * f64::from(mask.factor(*l)))
                    .sum();
                if share < 1e-25 {
                    continue;
                }
                let cells = SphereCells::new(&reference, mask, count);
                let at = format!("{shape} {name} {degrees} {lobe}");
                let mass: f64 = cells.expected.iter().sum::<f64>() / count as f64;
                assert!(
                    (mass - 1.0).abs() < 1e-9,
                    "{at}: the density has a mass of {mass}"
                );
                let (result, observed) = cells.test(&draw(&params, wo, mask), wo, stream);
                assert!(
                    result.degrees_of_freedom > 60,
                    "{at}: too few cells to tell anything, {result:?}"
                );
                if result.p_value < least {
                    (least, least_at) = (result.p_value, at.clone());
                }
                // NaN is a failure too.
                if result.p_value.is_nan() || result.p_value < level {
                    panic!(
                        "{at}: {result:?} at level {level}, tables in {}",
                        cells.dump(&observed, &at)
                    );
                }
            }
        }
    }
    println!(
        "{shape}: measured least p-value {least:.2e} of {} tests, level {level:.2e}, {least_at}",
        TESTS / (2 * SAMPLERS)
    );
}

#[test]
fn samples_of_the_published_model_follow_its_density() {
    check(
        registered(ModelId::Gaussian),
        published(Shape::Gaussian),
        "Gaussian",
        1,
    );
}

#[test]
fn samples_of_the_cauchy_model_follow_its_density() {
    check(
        registered(ModelId::Cauchy),
        published(Shape::Cauchy),
        "Cauchy",
        2,
    );
}

#[test]
fn samples_of_the_matched_sampler_follow_their_density() {
    check(
        registered(ModelId::GaussianMatched),
        matched(Shape::Gaussian),
        "matched Gaussian",
        3,
    );
    check(
        registered(ModelId::CauchyMatched),
        matched(Shape::Cauchy),
        "matched Cauchy",
        4,
    );
}

#[test]
fn widths_off_by_a_twentieth_are_found() {
    // Control: the same test must reject a sampler whose widths are 5% too large.
    for degrees in [0.0, -80.0] {
        let wo = wo(degrees);
        let reference = HairReference::prepare(
            &HairParams::bright().desc().map(f64::from),
            Shape::Gaussian,
            double(wo),
        );
        for (lobe, mask) in masks() {
            let cells = SphereCells::new(&reference, mask, SAMPLES);
            let (result, _) = cells.test(
                &registered(ModelId::Gaussian)(&widened(1.05), wo, mask),
                wo,
                7,
            );
            assert!(
                result.p_value < sidak(0.01, TESTS),
                "{lobe} at {degrees}: {result:?} passes a wrong width"
            );
        }
    }
}

#[test]
fn every_sampler_on_the_line_follows_its_cdf() {
    let count = samples();
    let limit = 1.95 / (count as f64).sqrt();
    let mut worst = 0.0_f64;
    for (name, params) in materials() {
        for degrees in [0.0, 85.0] {
            let wo = wo(degrees);
            let reference =
                HairReference::prepare(&params.desc().map(f64::from), Shape::Gaussian, double(wo));
            for lobe in Lobe::FOUR {
                let mut uniform = [const { Vec::new() }; 2];
                let stream = 9000 + lobe.index() as u64;
                let draw = registered(ModelId::Gaussian)(&params, wo, LobeMask::of(&[lobe]));
                for_each_sample(&draw, stream, count, |wi| {
                    let Some(wi) = wi else { return };
                    let [theta, phi] = angles(wo, wi);
                    uniform[0].push(reference.cdf_theta(lobe, theta));
                    uniform[1].push(reference.cdf_phi(lobe, phi));
                });
                for (axis, u) in ["theta", "phi"].into_iter().zip(&mut uniform) {
                    assert!(
                        u.len() > count / 100 * 99,
                        "{name} {degrees} {lobe:?}: only {} were kept",
                        u.len()
                    );
                    let d = ks_statistic(u, |x| x);
                    worst = worst.max(d / limit);
                    assert!(
                        d < limit,
                        "{name} {degrees} {lobe:?} {axis}: D = {d:.3e}, limit {limit:.3e}"
                    );
                }
            }
        }
    }
    println!("measured largest D {worst:.3} of its limit");
}
