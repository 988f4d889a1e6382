//! References of the estimates: integrals by quadrature over the oracle, and the variance that they predict.

use super::case::Case;
use super::{Reference, ReferenceMethod, SAMPLERS, intensity, stream};
use crate::sampler::Sampler;
use glam::DVec3;
use hairis_instruments::light::{Environment, Light, LightSample, luminance, product};
use hairis_instruments::quadrature::SphereIntegrator;
use hairis_instruments::sequence::{Stratified, XiSource};
use hairis_instruments::stats::{Estimate, Moments};
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};

/// Returns `numerator / pdf`, or 0 if the density is 0, because nothing is drawn there and the contribution is 0 too.
fn over(numerator: f64, pdf: f64) -> f64 {
    if pdf > 0.0 { numerator / pdf } else { 0.0 }
}

/// Returns the integral of `light * S cos theta_i` by the light's own quadrature, without the variances, and whether it converged.
fn mean_by_quadrature(case: &Case, light: &dyn Light) -> (Reference, bool) {
    let integral = light.integrate(
        &|dir| case.oracle_value(dir),
        case.sphere(Sampler::Published),
    );
    (
        Reference::by_quadrature(intensity(integral.value), intensity(integral.error)),
        integral.converged,
    )
}

/// Returns the second moment of a contribution if directions have the given density, by the light's own quadrature.
fn second_moment(
    case: &Case,
    light: &dyn Light,
    sphere: &SphereIntegrator,
    density: &dyn Fn(DVec3) -> f64,
) -> f64 {
    // The light multiplies by its radiance, channel by channel, so the brightest channel carries the integrand divided by its radiance.
    let square = |dir: DVec3| {
        let radiance = light.radiance(dir);
        let y = intensity(product(radiance, case.oracle_value(dir)));
        let brightest = (1..3).fold(0, |b, c| if radiance[c] > radiance[b] { c } else { b });
        let mut carried = [0.0; 3];
        if radiance[brightest] > 0.0 {
            carried[brightest] = over(y * y, density(dir)) / radiance[brightest];
        }
        carried
    };
    light.integrate(&square, sphere).value.iter().sum()
}

/// Integrals that this process has computed before. Programs need each once, but tests run the tables a dozen times, and the integrals
/// would take most of their time.
struct Known<T>(LazyLock<Mutex<HashMap<String, Arc<OnceLock<T>>>>>);

impl<T: Copy> Known<T> {
    const fn new() -> Self {
        Self(LazyLock::new(Mutex::default))
    }

    /// Returns the integral of this name, which `integrate` computes once.
    fn get(&self, name: &str, integrate: impl FnOnce() -> T) -> T {
        // The key has the number of threads, because a test checks that results do not depend on it.
        let key = format!("{} {name}", rayon::current_num_threads());
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let of_key = Arc::clone(known.entry(key).or_default());
        drop(known);
        *of_key.get_or_init(integrate)
    }
}

/// Returns mean and variances by the light's own quadrature, integrating each case under each light once.
pub fn by_quadrature(case: &Case, light: &dyn Light) -> Reference {
    static KNOWN: Known<Reference> = Known::new();
    KNOWN.get(&format!("{case:?} {light:?}"), || integrated(case, light))
}

/// Returns the integrator for second moments with the density of `sampler`, which ends after 500 panels.
///
/// A light that integrates over itself has edges along the jumps of a matched density. Four hundred times as many panels take the area
/// light 20 s and change its figure by 8e-7. Lights that cover the sphere converge before.
fn bounded(case: &Case, sampler: Sampler) -> SphereIntegrator {
    let mut sphere = case.sphere(sampler).clone();
    sphere.tolerance.max_panels = 500;
    sphere
}

fn integrated(case: &Case, light: &dyn Light) -> Reference {
    let (mean, _) = mean_by_quadrature(case, light);
    let v = SAMPLERS.map(|sampler| {
        let sphere = bounded(case, sampler);
        let second = second_moment(case, light, &sphere, &|dir| case.density(sampler, dir));
        second / (mean.value * mean.value) - 1.0
    });
    Reference { v, ..mean }
}

/// Returns V of directions whose density is proportional to the mean of RGB of `S cos theta_i`, by the light's own quadrature.
pub fn perfect_v(case: &Case, light: &dyn Light) -> f64 {
    let hair = |dir| intensity(case.oracle_value(dir));
    let sphere = case.sphere(Sampler::Published);
    let albedo = sphere.integrate_direction(|dir| [hair(dir)]).value[0];
    let second = second_moment(case, light, sphere, &|dir| hair(dir) / albedo);
    second / mean_by_quadrature(case, light).0.value.powi(2) - 1.0
}

/// Returns V of one ray of direct light by one-sample MIS, and V of a ray from `n + n` candidates times `n`, by the light's own quadrature.
/// With h = f / (p + q), of the densities of the sampler and of the light, the estimate from candidates is the mean of `n` values of h
/// drawn by p plus that of `n` drawn by q.
pub fn ray_v(case: &Case, light: &dyn Light, sampler: Sampler) -> [f64; 2] {
    let both = |dir: DVec3| case.density(sampler, dir) + light.pdf(dir);
    let sphere = bounded(case, sampler);
    let share = |dir: DVec3| {
        case.oracle_value(dir)
            .map(|s| over(s * case.density(sampler, dir), both(dir)))
    };
    let by_sampler = intensity(light.integrate(&share, &sphere).value);
    let mean = mean_by_quadrature(case, light).0.value;
    let (second, by_light) = (
        second_moment(case, light, &sphere, &both),
        mean - by_sampler,
    );
    let squares = by_sampler * by_sampler + by_light * by_light;
    [
        2.0 * second / (mean * mean) - 1.0,
        (second - squares) / (mean * mean),
    ]
}

/// Strata of a pass, across and down.
const STRATA: [usize; 2] = [64, 64];

/// Number of directions in a pass.
const PASS: usize = STRATA[0] * STRATA[1];

/// Returns the integral of `y` over the sphere, by stratified passes over directions drawn from a light.
pub fn stratified(
    light: &dyn Light,
    [seed, stream]: [u64; 2],
    passes: usize,
    y: &mut dyn FnMut(&LightSample) -> f64,
) -> Estimate {
    let mut source = Stratified::new(&STRATA, seed, stream);
    let mut term = || {
        let sample = light.sample(source.next_xi());
        over(y(&sample), sample.pdf)
    };
    let means: Moments = (0..passes)
        .map(|_| (0..PASS).map(|_| term()).sum::<f64>() / PASS as f64)
        .collect();
    means.mean_estimate()
}

/// Returns mean and variances under an environment map. The mean is by quadrature if the map has at most `max_texels`; all else is by a
/// stratified run over the oracle.
///
/// Quadrature texel by texel does not resolve lobes much narrower than a texel. Unless it converges, or its error is below that of the run,
/// the mean is that of the run as well.
///
/// The run draws from the map, in `passes` randomisations of 64 x 64 strata. It shares only the map's own sampling with the estimates that
/// it is a reference for.
#[must_use]
pub fn of_environment(
    case: &Case,
    map: &Environment,
    max_texels: usize,
    passes: usize,
    seed: u64,
) -> Reference {
    let id = stream(&[
        stream::REFERENCE,
        case.model.index(),
        case.theta_o_deg.to_bits(),
    ]);
    let (mut squares, mut cubes) = ([0.0; SAMPLERS.len()], [0.0; SAMPLERS.len()]);
    let mean = stratified(map, [seed, id], passes, &mut |s| {
        let y = intensity(product(s.radiance, case.oracle_value(s.dir)));
        for ((square, cube), sampler) in squares.iter_mut().zip(&mut cubes).zip(SAMPLERS) {
            // Contribution of one sample of the sampler in this direction.
            let contribution = over(y, case.density(sampler, s.dir));
            *square += over(y * contribution, s.pdf);
            *cube += over(y * contribution * contribution, s.pdf);
        }
        y
    });
    let n = (passes * PASS) as f64;
    let v = squares.map(|square| square / n / (mean.value * mean.value) - 1.0);
    // The third central moment over the cube of the deviation, both over powers of the mean.
    let skewness = core::array::from_fn(|i| {
        let third = cubes[i] / n / mean.value.powi(3);
        (third - 3.0 * v[i] - 1.0) / v[i].powf(1.5)
    });
    let [width, height] = map.size();
    if width * height <= max_texels {
        let (exact, converged) = mean_by_quadrature(case, map);
        if converged || exact.quadrature_error <= mean.standard_error {
            return Reference {
                v,
                skewness,
                ..exact
            };
        }
    }
    let (standard_error, method) = (mean.standard_error, ReferenceMethod::StratifiedRun);
    Reference {
        standard_error,
        method,
        v,
        skewness,
        ..Reference::by_quadrature(mean.value, 0.0)
    }
}

/// Integral of `S cos theta_i` and V under constant light, by quadrature.
#[derive(Clone, Copy, Debug)]
pub struct ExactVariance {
    /// Integral of the mean of RGB.
    pub mean: Estimate,
    /// V of the mean of RGB, and of the luminance of Rec. 709.
    pub v: [f64; 2],
    /// Whether the tolerance of 1e-7 was met.
    pub converged: bool,
}

/// Returns V under constant light, integrating each case with each sampler once.
pub fn exact_variance(case: &Case, sampler: Sampler) -> ExactVariance {
    static KNOWN: Known<ExactVariance> = Known::new();
    KNOWN.get(&format!("{case:?} {sampler:?}"), || variance(case, sampler))
}

/// Computes `V = E[f^2] / E[f]^2 - 1` with `f = S cos theta_i / pdf`, for both numbers of a colour at once, from the oracle.
fn variance(case: &Case, sampler: Sampler) -> ExactVariance {
    let r = case.sphere(sampler).integrate_direction(|dir| {
        let rgb = case.oracle_value(dir);
        let pdf = case.density(sampler, dir);
        let (m, y) = (intensity(rgb), luminance(rgb));
        [m, y, over(m * m, pdf), over(y * y, pdf)]
    });
    let [m, y, m_sq, y_sq] = r.value;
    ExactVariance {
        mean: Estimate::exact(m),
        v: [m_sq / (m * m) - 1.0, y_sq / (y * y) - 1.0],
        converged: r.converged,
    }
}
