//! Steps that the formulas of several models share, in either precision.

use crate::interface::{LobeAt, ReferenceSample};
use crate::real::Real;
use hairis::{Lobe, PerLobe};

/// Inclination and azimuth of a fixed direction.
pub(crate) struct Fixed<T> {
    pub(crate) sin_theta_o: T,
    pub(crate) cos_theta_o: T,
    /// Azimuth, rad; 0 along the fibre, whatever the signs of the zeros.
    pub(crate) phi_o: T,
}

/// Computes inclination and azimuth of `wo`, of any length; zero counts as a direction in the normal plane.
pub(crate) fn fixed<T: Real>(wo: [T; 3]) -> Fixed<T> {
    let zero = T::default();
    let across = wo[1].hypot(wo[2]);
    let length = wo[0].hypot(across);
    let (sin_theta_o, cos_theta_o) = if length > zero {
        (wo[0] / length, across / length)
    } else {
        (zero, T::from_f64(1.0))
    };
    let phi_o = if across > zero {
        wo[2].atan2(wo[1])
    } else {
        zero
    };
    Fixed {
        sin_theta_o,
        cos_theta_o,
        phi_o,
    }
}

/// Computes sine and cosine of the inclination of `wi`, whatever the rounding of its length.
pub(crate) fn inclination<T: Real>([u, v, w]: [T; 3]) -> [T; 2] {
    let across = v.hypot(w);
    let length = (u * u + across * across).sqrt();
    if length > T::default() {
        [u / length, across / length]
    } else {
        [u, across]
    }
}

/// Cosine of `theta_i` below which a direction is too close to the fibre axis to have value or density: section 3.3 of the paper.
pub(crate) const GRAZING: f64 = 1e-5;

/// Divides the parts by their sum; all are 0 if the sum is 0.
pub(crate) fn sum_to_one<T: Real>(PerLobe(parts): PerLobe<T>) -> PerLobe<T> {
    let zero = T::default();
    // Divided by the largest first, because the sum of large parts may overflow.
    let largest = parts.into_iter().fold(zero, T::max);
    if largest <= zero {
        return PerLobe::default();
    }
    let parts = parts.map(|part| part / largest);
    let sum = parts.into_iter().fold(zero, |sum, part| sum + part);
    PerLobe(parts.map(|part| part / sum))
}

/// Computes the share of each part in the sum; all are 0 if the sum is 0.
pub(crate) fn shares<T: Real>(parts: &PerLobe<T>) -> PerLobe<T> {
    let total = sum(parts);
    let share = |part| {
        if total > T::default() {
            part / total
        } else {
            T::default()
        }
    };
    PerLobe(parts.0.map(share))
}

/// Pads the values of four lobes with a zero.
pub(crate) fn four<T: Copy + Default>(values: [T; 4]) -> PerLobe<T> {
    PerLobe::padded(values, T::default())
}

/// Sums the parts of all lobes.
pub(crate) fn sum<T: Real>(parts: &PerLobe<T>) -> T {
    parts
        .0
        .into_iter()
        .fold(T::default(), |sum, part| sum + part)
}

/// Computes the density of the mixture.
pub(crate) fn mix_pdfs<T: Real>(probabilities: &PerLobe<T>, pdfs: &PerLobe<T>) -> T {
    Lobe::ALL.into_iter().fold(T::default(), |sum, lobe| {
        sum + probabilities[lobe] * pdfs[lobe]
    })
}

/// Chooses the first lobe whose cumulative probability exceeds `xi`. Returns the lobe and how far into its share `xi` is, in
/// `[0, 1)`.
pub(crate) fn choose<T: Real>(probabilities: &PerLobe<T>, xi: T) -> Option<(Lobe, T)> {
    let zero = T::default();
    let (mut below, mut chosen) = (zero, None);
    for lobe in Lobe::ALL {
        let probability = probabilities[lobe];
        // Rounding may leave the last sum below xi, but a lobe without probability is not drawn even then.
        if probability > zero {
            chosen = Some((lobe, (xi - below) / probability));
        }
        below = below + probability;
        if xi < below {
            break;
        }
    }
    let largest = T::from_f64(1.0 - 0.5 * f64::from(f32::EPSILON));
    chosen.map(|(lobe, rest)| (lobe, rest.max(zero).min(largest)))
}

/// Sums S and the density of the mixture over the lobes.
pub(crate) fn mix<T: Real>(lobes: &PerLobe<LobeAt<T>>, probabilities: &PerLobe<T>) -> ([T; 3], T) {
    let zero = T::default();
    let (mut value, mut pdf) = ([zero; 3], zero);
    for lobe in Lobe::ALL {
        let at = &lobes[lobe];
        for (sum, color) in value.iter_mut().zip(at.color) {
            *sum = *sum + at.value * color;
        }
        pdf = pdf + probabilities[lobe] * at.pdf;
    }
    (value, pdf)
}

/// Makes the sample of `lobe` at this inclination and azimuth, with the value and density of [`mix`].
pub(crate) fn finish_sample<T: Real>(
    lobe: Lobe,
    [sin_theta_i, cos_theta_i]: [T; 2],
    phi_i: T,
    (value, pdf): ([T; 3], T),
) -> ReferenceSample<T> {
    if pdf <= T::default() {
        return ReferenceSample::default();
    }
    ReferenceSample {
        wi: [
            sin_theta_i,
            cos_theta_i * phi_i.cos(),
            cos_theta_i * phi_i.sin(),
        ],
        value,
        pdf,
        weight: value.map(|s| s * cos_theta_i / pdf),
        lobe: Some(lobe),
    }
}
