//! Registry entries of the published model and its variants: the fields of their parameters, and their names.

use crate::{Cauchy, Field, Kind, Parameters, Registered, Values};
use hairis::model::{MatchedBell, Precision};
use hairis::params::{HairDesc, Rule};
use hairis::{Gaussian, HairParams, Matched, ParamError, Published};

/// Shape of a field with one number for each of R, TT and TRT.
const LOBES: Kind = Kind::Numbers(&["R", "TT", "TRT"]);
/// Half a degree in radians: the width of the lobes in narrow materials.
const NARROW: f32 = 0.008_726_646;

/// Random materials cover everyday hair: widths of 1 to 30 degrees, shifts within 15 degrees, glints at 10 to 80 degrees and
/// of strength 0.1 to 10, and colours in `[0, 1)`.
impl Parameters for HairParams {
    const FIELDS: &'static [Field] = &[
        Field::new(
            "alpha",
            LOBES,
            Rule::Shift,
            "Longitudinal shifts of the lobes.",
        )
        .radians()
        .uniform(-15.0, 15.0)
        .degrees(),
        Field::new(
            "beta",
            LOBES,
            Rule::Width,
            "Longitudinal widths of the lobes.",
        )
        .radians()
        .log_uniform(1.0, 30.0)
        .degrees()
        .narrow(NARROW),
        Field::new(
            "gamma_tt",
            Kind::Number,
            Rule::Width,
            "Azimuthal width of TT.",
        )
        .radians()
        .log_uniform(1.0, 30.0)
        .degrees()
        .narrow(NARROW),
        Field::new(
            "gamma_g",
            Kind::Number,
            Rule::Width,
            "Azimuthal width of each glint.",
        )
        .radians()
        .log_uniform(1.0, 30.0)
        .degrees()
        .narrow(NARROW),
        Field::new(
            "phi_g",
            Kind::Number,
            Rule::Azimuth,
            "Half angle between the glints.",
        )
        .radians()
        .uniform(10.0, 80.0)
        .degrees()
        .late(),
        Field::new("i_r", Kind::Rgb, Rule::NotNegative, "Intensity of R.").uniform(0.0, 1.0),
        Field::new("i_tt", Kind::Rgb, Rule::NotNegative, "Intensity of TT.").uniform(0.0, 1.0),
        Field::new(
            "i_trt",
            Kind::Rgb,
            Rule::NotNegative,
            "Intensity of TRT, which the glints share.",
        )
        .uniform(0.0, 1.0),
        Field::new(
            "i_g",
            Kind::Number,
            Rule::NotNegative,
            "Strength of the glints, a factor on i_trt.",
        )
        .log_uniform(0.1, 10.0)
        .late(),
    ];
    const PRESETS: &'static [(&'static str, Self)] = &Self::presets();

    #[inline]
    fn values(&self) -> Values {
        let d = self.desc();
        Values::none(Self::FIELDS)
            .with("alpha", &d.alpha)
            .with("beta", &d.beta)
            .with("gamma_tt", &[d.gamma_tt])
            .with("gamma_g", &[d.gamma_g])
            .with("phi_g", &[d.phi_g])
            .with("i_r", &d.i_r)
            .with("i_tt", &d.i_tt)
            .with("i_trt", &d.i_trt)
            .with("i_g", &[d.i_g])
    }

    #[inline]
    fn from_values(values: &Values) -> Result<Self, ParamError> {
        Self::new(&hair_desc(values))
    }

    #[inline]
    fn scaled(&self, factor: f32) -> Result<Self, ParamError> {
        Self::scaled(self, factor)
    }
}

/// Returns the description that the values of the fields of [`HairParams`] form, in any type of number. Nothing is checked.
///
/// # Panics
///
/// Panics if the values belong to the fields of another model.
#[inline]
#[must_use]
pub fn hair_desc<T: Copy>(values: &Values<T>) -> HairDesc<T> {
    HairDesc {
        alpha: values.get_at(0),
        beta: values.get_at(1),
        gamma_tt: values.number_at(2),
        gamma_g: values.number_at(3),
        phi_g: values.number_at(4),
        i_r: values.get_at(5),
        i_tt: values.get_at(6),
        i_trt: values.get_at(7),
        i_g: values.number_at(8),
    }
}

/// Bell whose models are in the registry, with the published and with the matched sampler.
pub trait RegisteredBell: MatchedBell + Send + Sync + 'static {
    /// Name of the models that are made of the bell.
    const NAME: &'static str;
    /// Bell of the registered models.
    const BELL: Self;
}

impl RegisteredBell for Gaussian {
    const NAME: &'static str = "gaussian";
    const BELL: Self = Self;
}

impl RegisteredBell for Cauchy {
    const NAME: &'static str = "cauchy";
    const BELL: Self = Self::PAPER;
}

impl<B: RegisteredBell> Registered for Published<B> {
    const NAME: &'static str = B::NAME;
    const CHOICE: Option<(&'static str, &'static str)> = Some(("sampler", "published"));
    const MODEL: Self = Self(B::BELL);

    #[inline]
    fn constants<W: Precision>(values: &Values<W::Lane>) -> Self::Material<W::Lane> {
        Self::MODEL.constants::<W>(&hair_desc(values))
    }
}

/// Word of the matched sampler: `matched` for the default of nine bands, and `matched-` followed by the number of bands otherwise.
struct Word<const BANDS: usize>;

impl<const BANDS: usize> Word<BANDS> {
    const DIGITS: &'static [u8] = b"0123456789";
    const BYTES: [u8; 10] = {
        let [tens, ones] = [Self::DIGITS[BANDS / 10], Self::DIGITS[BANDS % 10]];
        let [first, second] = if BANDS < 10 { [ones, 0] } else { [tens, ones] };
        [
            b'm', b'a', b't', b'c', b'h', b'e', b'd', b'-', first, second,
        ]
    };
    const WORD: &'static str = {
        let len = if BANDS == 9 {
            7
        } else {
            9 + (BANDS >= 10) as usize
        };
        match core::str::from_utf8(Self::BYTES.split_at(len).0) {
            Ok(word) => word,
            Err(_) => panic!("the bytes are ASCII"),
        }
    };
}

impl<B: RegisteredBell, const BANDS: usize> Registered for Matched<B, BANDS> {
    const NAME: &'static str = B::NAME;
    const CHOICE: Option<(&'static str, &'static str)> = Some(("sampler", Word::<BANDS>::WORD));
    const MODEL: Self = Self(B::BELL);

    #[inline]
    fn constants<W: Precision>(values: &Values<W::Lane>) -> Self::Material<W::Lane> {
        Self::MODEL.constants::<W>(&hair_desc(values))
    }
}
