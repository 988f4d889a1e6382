//! Azimuthal terms: Schlick's reflectance over the width of a fibre, TT by its offset, and the three Gaussians of TRT.

use crate::published::{Cut, Shape};
use crate::real::Real;

/// Schlick's reflectance of a surface with the reflectance `f0` at its normal.
pub(super) fn schlick<T: Real>(f0: T, cos: T) -> T {
    let one = T::from_f64(1.0);
    let grazing = one - cos;
    let square = grazing * grazing;
    f0 + (one - f0) * (square * square * grazing)
}

/// Reflectance of the surface at its normal: `((eta - 1) / (eta + 1))^2`.
pub(super) fn normal_reflectance<T: Real>(eta: T) -> T {
    let one = T::from_f64(1.0);
    let root = (eta - one) / (eta + one);
    root * root
}

/// Coefficients, in powers of `1 - k`, of the integral of `(1 - k cos g)^n cos g` over `g` in `[0, pi/2]`, for n = 5 and n = 10.
///
/// They are `binomial(n, j)` times the integral of `(1 - cos g)^(n - j) cos^(j + 1) g`, all positive, so that nothing cancels.
const FIFTH: [f64; 6] = [
    0.024_982_438_741_824_271,
    0.052_818_754_046_854_481,
    0.086_469_468_990_027_762,
    0.132_558_080_048_247_6,
    0.212_297_406_049_640_7,
    0.490_873_852_123_405_17,
];
const TENTH: [f64; 11] = [
    0.007_709_521_850_354_179,
    0.015_707_026_927_251_035,
    0.024_184_145_990_668_086,
    0.033_397_460_893_728_158,
    0.043_717_577_304_142_524,
    0.055_725_345_746_272_803,
    0.070_423_085_422_223_017,
    0.089_772_935_224_302_963,
    0.118_406_639_844_565_99,
    0.171_547_891_388_121_82,
    0.369_408_369_408_369_41,
];

/// Cosine below which the complements of the integrals are series in the cosine.
const GRAZING: f64 = 0.15;

/// Computes the integral of `(1 - (1 - k cos g)^n) cos g` over `g` in `[0, pi/2]`, by the binomial series in `k`. It alternates, so that `k`
/// must be small.
fn complement<T: Real>(n: u32, k: T) -> T {
    let number = |x: u32| T::from_f64(f64::from(x));
    // Integrals of powers of the cosine: of the power before, and of this one.
    let (mut integrals, mut power, mut sum) =
        ([number(1), T::PI / number(4)], -number(1), T::default());
    for j in 1..=n {
        power = -power * k * number(n + 1 - j) / number(j);
        sum = sum + power * integrals[1];
        integrals = [integrals[1], integrals[0] * number(j + 1) / number(j + 2)];
    }
    sum
}

/// Means over the width of the fibre, at `k = cos theta`, of Schlick's reflectance F, of `(1 - F)^2` and of `F (1 - F)`.
pub(super) fn mean_reflectance<T: Real>(f0: T, k: T) -> [T; 3] {
    let (one, two) = (T::from_f64(1.0), T::from_f64(2.0));
    let series = |coefficients: &[f64]| {
        let terms = coefficients.iter().rev();
        terms.fold(T::default(), |sum, c| sum * (one - k) + T::from_f64(*c))
    };
    let (fifth, rest) = (series(&FIFTH), one - f0);
    let mean = f0 + rest * fifth;
    if k < T::from_f64(GRAZING) {
        let (once, twice) = (complement(5, k), complement(10, k));
        let passed = rest * rest * (two * once - twice);
        return [mean, passed, rest * once - passed];
    }
    let square = f0 * f0 + two * f0 * rest * fifth + rest * rest * series(&TENTH);
    [mean, one - two * mean + square, mean - square]
}

/// TT at one inclination: `q = 1 / eta'`, of the projected index `eta'`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Passage<T> {
    q: T,
    /// `1 - q`, without a difference.
    less: T,
}

impl<T: Real> Passage<T> {
    pub(super) fn new(eta: T, k: T) -> Self {
        let one = T::from_f64(1.0);
        let contrast = (eta - one) * (eta + one);
        let root = (contrast + k * k).sqrt();
        Self {
            q: k / root,
            less: contrast / (root * (root + k)),
        }
    }

    /// Computes `N = |dh / dphi| / 2`, and the cosines of `gamma_i` and `gamma_t`, at an azimuth whose half has this sine (its
    /// magnitude) and this cosine. Beyond the last azimuth all are 0.
    pub(super) fn at(&self, half: [T; 2]) -> [T; 3] {
        let [beyond, steepness] = self.beyond(half);
        if beyond <= T::default() {
            return [T::default(); 3];
        }
        let [inner, chord] = self.inner_and_chord(half);
        [beyond * steepness, beyond / chord, inner / chord]
    }

    /// Returns how far the sine of half an azimuth is beyond that of the last azimuth, negative in front of it, and N over that.
    pub(super) fn beyond(&self, half @ [sin_half, _]: [T; 2]) -> [T; 2] {
        let [inner, chord] = self.inner_and_chord(half);
        let steepness = inner / (T::from_f64(4.0) * (chord * chord * chord));
        [sin_half - self.q, steepness]
    }

    /// Returns `1 - q sin(phi / 2)`, and the third side of the triangle of the sides 1 and `q`.
    fn inner_and_chord(&self, [sin_half, cos_half]: [T; 2]) -> [T; 2] {
        let (one, two, q) = (T::from_f64(1.0), T::from_f64(2.0), self.q);
        // gamma_i - gamma_t = (pi - phi) / 2, whose sine and cosine are the cosine and the sine of phi / 2.
        let rest = cos_half * cos_half / (one + sin_half);
        let chord = (self.less * self.less + two * q * rest).sqrt();
        [self.less + q * rest, chord]
    }

    /// Returns `phi` of the ray that enters at `h`.
    pub(super) fn azimuth(&self, h: T) -> T {
        T::PI + T::from_f64(2.0) * ((self.q * h).asin() - h.asin())
    }

    /// Returns the cosine of `gamma_t` of the ray that enters at `h`.
    pub(super) fn cos_gamma_t(&self, h: T) -> T {
        let (one, sin) = (T::from_f64(1.0), self.q * h);
        ((one - sin) * (one + sin)).sqrt()
    }
}

/// Least weight of the Gaussian at the centre of TRT.
const LEAST_CENTRE: f64 = 5e-5;

/// Fit of TRT at one inclination: place of the two outer Gaussians, weights, and variances at a roughness of .06.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit<T> {
    pub(super) place: T,
    pub(super) outer: T,
    pub(super) centre: T,
    pub(super) outer_variance: T,
    pub(super) centre_variance: T,
}

impl<T: Real> Fit<T> {
    /// Evaluates the fit as it is published, at the magnitude of an angle.
    pub(super) fn new(angle: T) -> Self {
        let (c, zero, t) = (T::from_f64, T::default(), angle.abs());
        let (t2, t3) = (t * t, t * t * t);
        if t < c(0.525) {
            let power = (c(1.80972) * t).powf(c(16.7669));
            Self {
                place: t.cos() - c(0.733),
                outer: t.powf(c(15.7265)) + c(0.000_239_39)
                    - c(0.000_111_282) * (t - c(0.103_125)) * t,
                centre: c(0.000_322_755) * ((t - power) * t.tan() + c(0.991_977)),
                outer_variance: c(0.005_975_78) + c(0.000_428_897) * (c(5.41149) * t).cos(),
                centre_variance: c(0.0181) * (c(2.121) * t).cos().tan(),
            }
        } else if t < c(1.1) {
            Self {
                place: zero.max(c(0.00493) + c(0.579) * t - c(0.775) * t2),
                outer: c(0.00108) - c(0.0014) * t + c(0.000_393_7) * t2,
                centre: c(0.00219) * t - c(0.00119),
                outer_variance: c(0.0391) - c(0.0888) * t + c(0.0581) * t2,
                centre_variance: c(0.384) - c(1.14) * t + c(0.942) * t2,
            }
        } else {
            Self {
                place: zero,
                outer: zero,
                centre: c(0.000_239) + c(0.00139) * t3 - c(0.000_531_24) * t3 * t2,
                outer_variance: c(1.0),
                centre_variance: c(2.73) * t - c(1.86) - c(0.7437) * t2,
            }
        }
    }

    /// Returns the fit with each of its terms off by the rounding of single precision, at the magnitude of an angle: that of the largest
    /// number of the polynomial.
    pub(super) fn rounded(&self, angle: T) -> [Self; 5] {
        let (c, fit) = (T::from_f64, *self);
        let (is_low, is_middle) = (angle.abs() < c(0.525), angle.abs() < c(1.1));
        let of = |low: f64, middle: f64, high: f64| {
            c(if is_low {
                low
            } else if is_middle {
                middle
            } else {
                high
            })
        };
        [
            Self {
                place: fit.place + of(1.2e-7, 1.2e-7, 0.0),
                ..fit
            },
            Self {
                outer: fit.outer * (c(1.0) + of(2e-6, 0.0, 0.0)) + of(0.0, 2e-10, 0.0),
                ..fit
            },
            Self {
                centre: fit.centre * (c(1.0) + of(2e-6, 0.0, 5e-7)) + of(0.0, 2e-10, 0.0),
                ..fit
            },
            Self {
                outer_variance: fit.outer_variance + of(2e-9, 1e-8, 0.0),
                ..fit
            },
            Self {
                centre_variance: fit.centre_variance + of(1e-8, 1e-7, 5e-7),
                ..fit
            },
        ]
    }
}

/// Azimuth of TRT: Gaussians at `-p`, `0` and `p`, each cut to one turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ThreeGaussians<T> {
    place: T,
    outer: Gaussian<T>,
    centre: Gaussian<T>,
    /// Share of the two outer Gaussians.
    share: T,
}

/// Gaussian cut to a turn, of the azimuths from its centre at `place`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Gaussian<T> {
    deviation: T,
    cut: Cut<T>,
}

impl<T: Real> Gaussian<T> {
    fn new(place: T, deviation: T) -> Self {
        let [lo, hi] = [-T::PI - place, T::PI - place].map(|end| end / deviation);
        Self {
            deviation,
            cut: Cut::new(Shape::Gaussian, lo, hi),
        }
    }

    fn density(&self, x: T) -> T {
        let z = x / self.deviation;
        (T::from_f64(-0.5) * z * z).exp() / (self.deviation * self.cut.area)
    }

    fn sample(&self, xi: T) -> T {
        self.deviation * self.cut.sample(xi)
    }
}

impl<T: Real> ThreeGaussians<T> {
    pub(super) fn new(roughness: T, theta: T) -> Self {
        Self::of(&Fit::new(theta), roughness)
    }

    /// Makes the Gaussians of a fit.
    pub(super) fn of(fit: &Fit<T>, roughness: T) -> Self {
        let two = T::from_f64(2.0);
        let width = |variance: T| roughness / T::from_f64(0.06) * variance.sqrt();
        // Next to 30 degrees the fit has a negative weight; a least one above 0 also keeps the digits of the tail.
        let (outer, centre) = (two * fit.outer, fit.centre.max(T::from_f64(LEAST_CENTRE)));
        Self {
            place: fit.place,
            outer: Gaussian::new(fit.place, width(fit.outer_variance)),
            centre: Gaussian::new(T::default(), width(fit.centre_variance)),
            share: outer / (outer + centre),
        }
    }

    pub(super) fn density(&self, phi: T) -> T {
        let (one, half) = (T::from_f64(1.0), T::from_f64(0.5));
        let outer = self.outer.density(phi - self.place) + self.outer.density(-phi - self.place);
        half * self.share * outer + (one - self.share) * self.centre.density(phi)
    }

    /// Draws the azimuth: by halves the side, then the Gaussian.
    pub(super) fn sample(&self, xi: T) -> T {
        let (zero, one, half) = (T::default(), T::from_f64(1.0), T::from_f64(0.5));
        let below = xi < half;
        let xi = if below { xi + xi } else { xi + xi - one };
        let phi = if xi < self.share {
            self.place + self.outer.sample(xi / self.share)
        } else {
            let rest = (xi - self.share) / (one - self.share);
            self.centre.sample(rest.max(zero).min(one))
        };
        if below { -phi } else { phi }
    }
}
