//! The interface that the formulas of every model share.

use super::{
    HairReference, MatchedReference, Oracle, Parameters, Real, ReferenceSample, integrate,
};
use crate::{Lobe, PerLobe};

/// One lobe at one direction, in either precision.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LobeAt<T> {
    /// The lobe's part of S without its colour, per steradian.
    pub value: T,
    /// The lobe's colour, linear RGB: `value * color` summed over the lobes is S.
    pub color: [T; 3],
    /// Density of sampling the direction from this lobe alone, per steradian.
    pub pdf: T,
}

/// A model's formulas at one shading point, in either precision: the reference of conformance tests and reports.
///
/// ```
/// use hairis::{HairParams, reference::HairReference, reference::Parameters, reference::Reference, reference::Shape};
/// fn reflected(point: &impl Reference<f64>) -> f64 {
///     point.albedo().0.iter().map(|lobe| lobe[0]).sum()
/// }
/// let brown = HairReference::prepare(&Parameters::from(&HairParams::brown()), Shape::Gaussian, [0.0, 1.0, 0.0]);
/// assert!(reflected(&brown) < 1.0);
/// ```
pub trait Reference<T: Real> {
    /// S, without the cosine, linear RGB, per steradian.
    #[must_use]
    fn eval(&self, wi: [T; 3]) -> [T; 3];

    /// Density of [`sample`](Self::sample) at `wi`, per steradian: the mixture of all lobes.
    #[must_use]
    fn pdf(&self, wi: [T; 3]) -> T;

    /// [`eval`](Self::eval) and [`pdf`](Self::pdf) at once, for less than both where they share terms.
    #[inline]
    #[must_use]
    fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
        (self.eval(wi), self.pdf(wi))
    }

    /// Each lobe's value, colour and own density at `wi`; zeros in the slots the model leaves empty.
    #[must_use]
    fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>>;

    /// The sample of three uniform numbers in `[0, 1)`.
    #[must_use]
    fn sample(&self, xi: [T; 3]) -> ReferenceSample<T>;

    /// Directional albedo of each lobe, linear RGB: the integral of `S cos theta_i` over all `wi`.
    ///
    /// - Accuracy: 1e-6 relative in `f64`; that of its rounding in `f32`.
    #[must_use]
    fn albedo(&self) -> PerLobe<[T; 3]>;
}

macro_rules! reference {
    ($($name:ident $({ $($shared:item)* })?)*) => { $(
        impl<T: Real> Reference<T> for $name<T> {
            #[inline]
            fn eval(&self, wi: [T; 3]) -> [T; 3] {
                self.eval(wi)
            }
            #[inline]
            fn pdf(&self, wi: [T; 3]) -> T {
                self.pdf(wi)
            }
            $($($shared)*)?
            #[inline]
            fn lobes(&self, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
                lobes(self.book(), &self.lobe_pdfs(wi), wi)
            }
            #[inline]
            fn sample(&self, xi: [T; 3]) -> ReferenceSample<T> {
                self.sample(xi)
            }
            #[inline]
            fn albedo(&self) -> PerLobe<[T; 3]> {
                albedo(self.book())
            }
        }
    )* };
}
reference! {
    HairReference {
        #[inline]
        fn eval_pdf(&self, wi: [T; 3]) -> ([T; 3], T) {
            self.eval_pdf(wi)
        }
    }
    MatchedReference
    Oracle
}

/// The colours of the lobes; `lobe_values` has the glint's strength in it.
fn colours<T: Real>(p: &Parameters<T>) -> PerLobe<[T; 3]> {
    PerLobe([
        p.intensity_r,
        p.intensity_tt,
        p.intensity_trt,
        p.intensity_trt,
    ])
}

fn lobes<T: Real>(book: &HairReference<T>, pdfs: &PerLobe<T>, wi: [T; 3]) -> PerLobe<LobeAt<T>> {
    let (values, colours) = (book.lobe_values(wi), colours(&book.parameters));
    let mut lobes = PerLobe::default();
    for lobe in Lobe::ALL {
        lobes[lobe] = LobeAt {
            value: values[lobe],
            color: colours[lobe],
            pdf: pdfs[lobe],
        };
    }
    lobes
}

/// The product of two integrals: `bell(theta_h - alpha) (cos theta_i / cos theta_d)^2` over `theta_i`, and N over `phi`.
fn albedo<T: Real>(book: &HairReference<T>) -> PerLobe<[T; 3]> {
    let (zero, half, two) = (T::default(), T::from_f64(0.5), T::from_f64(2.0));
    let p = &book.parameters;
    let (shape, right) = (book.shape, T::PI * half);
    let inclination = |i: usize| {
        let theta_o = book.theta_o;
        let integrand = |theta_i: T| {
            let ratio = theta_i.cos() / (half * (theta_o - theta_i)).cos();
            ratio * ratio * shape.bell(p.beta[i], half * (theta_i + theta_o) - p.alpha[i])
        };
        integrate(
            [-right, right],
            two * p.alpha[i] - theta_o,
            two * p.beta[i],
            integrand,
        )
    };
    let azimuth = |peak: T, width: T| {
        two * integrate([zero, T::PI], peak, width, |phi| {
            shape.bell(width, phi - peak)
        })
    };
    let cosine = T::from_f64(4.0);
    let areas = [
        cosine,
        azimuth(T::PI, p.gamma_tt),
        cosine,
        p.intensity_g * azimuth(p.phi_g, p.gamma_g),
    ];
    let inclinations = [inclination(0), inclination(1), inclination(2)];
    let colours = colours(p);
    let mut albedo = PerLobe::default();
    for lobe in Lobe::ALL {
        let area = areas[lobe.index()] * inclinations[lobe.index().min(2)];
        albedo[lobe] = colours[lobe].map(|c| c * area);
    }
    albedo
}
