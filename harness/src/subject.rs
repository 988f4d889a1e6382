//! The two models of hair that the experiments compare, and the parameters that comparisons draw.

use hairis::{HairParams, ParamError};
use hairis_instruments::sequence::Independent;
use hairis_reference::{HairFormulas, Shape};
use hairis_variants::{Draw, Kind, ModelId, Parameters as _, Values};
use serde::Serialize;

/// The models compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ModelKind {
    /// The published model.
    Gaussian,
    /// The all-Cauchy variant with the same widths.
    Cauchy,
}

impl ModelKind {
    /// Every model, in the order of reports.
    pub const ALL: [Self; 2] = [Self::Gaussian, Self::Cauchy];

    /// Name in reports.
    pub(crate) const fn name(self) -> &'static str {
        self.id().name()
    }

    /// The model with the published sampler.
    pub(crate) const fn id(self) -> ModelId {
        match self {
            Self::Gaussian => ModelId::Gaussian,
            Self::Cauchy => ModelId::Cauchy,
        }
    }

    /// Name in titles and sentences.
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Gaussian => "Gaussian",
            Self::Cauchy => "Cauchy",
        }
    }

    /// Its bell in the reference.
    pub(crate) const fn shape(self) -> Shape {
        match self {
            Self::Gaussian => Shape::Gaussian,
            Self::Cauchy => Shape::Cauchy,
        }
    }

    /// Its formulas with the matched sampler of so many bands, or with the published one.
    pub(crate) const fn formulas(self, bands: Option<usize>) -> HairFormulas {
        HairFormulas {
            shape: self.shape(),
            bands,
            by_channel: false,
        }
    }

    /// Place among the streams of random numbers.
    pub(crate) const fn index(self) -> u64 {
        self as u64
    }
}

/// Random values of every field that has a range, and a random word of every field of words; the others stay.
#[must_use]
pub fn random(mut values: Values, xi: &mut Independent) -> Values {
    for late in [false, true] {
        for field in values.fields().iter().filter(|field| field.late == late) {
            let mut number = || match (field.kind, field.draw) {
                #[expect(clippy::cast_precision_loss, reason = "a few words")]
                (Kind::Word(words), _) => Some((xi.next_f32() * words.len() as f32).floor()),
                (
                    _,
                    Some(Draw {
                        least,
                        most,
                        unit,
                        log: false,
                    }),
                ) => Some((least + (most - least) * xi.next_f32()) * unit),
                (
                    _,
                    Some(Draw {
                        least, most, unit, ..
                    }),
                ) => Some(least * (most / least).powf(xi.next_f32()) * unit),
                _ => None,
            };
            let numbers: Option<Vec<f32>> = (0..field.kind.width()).map(|_| number()).collect();
            values = numbers.map_or(values, |numbers| values.with(field.name, &numbers));
        }
    }
    values
}

/// Hair drawn over the range of the everyday: widths log-uniform in 1 to 30 degrees, shifts uniform within 15 degrees,
/// glints at 10 to 80 degrees and of strength 0.1 to 10 (log-uniform), colours uniform in `[0, 1)`.
///
/// # Errors
///
/// Never: every range lies within those accepted.
pub fn random_hair(xi: &mut Independent) -> Result<HairParams, ParamError> {
    HairParams::from_values(&random(HairParams::bright().values(), xi))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_hair_is_accepted_and_differs() {
        let mut xi = Independent::new(3, 0);
        let hair: Vec<HairParams> = (0..1_000)
            .map(|_| random_hair(&mut xi).expect("within range"))
            .collect();
        assert!(
            hair.windows(2).all(|pair| pair[0] != pair[1]),
            "two draws are the same hair"
        );
    }
}
