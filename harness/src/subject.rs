//! Subjects of the experiments: the two models of hair that they compare, and the parameters that comparisons draw.

use hairis::{HairParams, ParamError};
use hairis_instruments::sequence::Independent;
use hairis_reference::{HairFormulas, Shape};
use hairis_variants::{Draw, Kind, ModelId, Parameters as _, Values};
use serde::Serialize;

/// Hair model of the experiments, which differ in the bell of their lobes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ModelKind {
    /// Published model, whose lobes are Gaussian.
    Gaussian,
    /// All-Cauchy variant with the same widths.
    Cauchy,
}

impl ModelKind {
    /// Both models, in the order of reports.
    pub const ALL: [Self; 2] = [Self::Gaussian, Self::Cauchy];

    /// Returns the name of the model in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.id().name()
    }

    /// Returns the registry's entry of the model with the published sampler.
    #[must_use]
    pub const fn id(self) -> ModelId {
        match self {
            Self::Gaussian => ModelId::Gaussian,
            Self::Cauchy => ModelId::Cauchy,
        }
    }

    /// Returns the name of the model in titles and sentences.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Gaussian => "Gaussian",
            Self::Cauchy => "Cauchy",
        }
    }

    /// Returns the model's bell in the reference.
    #[must_use]
    pub const fn shape(self) -> Shape {
        match self {
            Self::Gaussian => Shape::Gaussian,
            Self::Cauchy => Shape::Cauchy,
        }
    }

    /// Returns the formulas of the model with the matched sampler of so many bands, or with the published one.
    #[must_use]
    pub const fn formulas(self, bands: Option<usize>) -> HairFormulas {
        HairFormulas {
            shape: self.shape(),
            bands,
            by_channel: false,
        }
    }

    /// Returns the model's number among the streams of random numbers.
    #[must_use]
    pub const fn index(self) -> u64 {
        self as u64
    }
}

/// Draws random values for every field that has a range, and a random word for every field of words. Other fields keep their values.
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

/// Draws hair over the everyday range: widths log-uniform in 1 to 30 degrees, shifts uniform within 15 degrees, glints at 10 to 80 degrees
/// and of strength 0.1 to 10 (log-uniform), colours uniform in `[0, 1)`.
///
/// # Errors
///
/// Returns an error only if drawn parameters are rejected, which does not happen because every range lies within the accepted one.
pub fn random_hair(xi: &mut Independent) -> Result<HairParams, ParamError> {
    HairParams::from_values(&random(HairParams::bright().values(), xi))
}
