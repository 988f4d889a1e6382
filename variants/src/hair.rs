//! The published model and its variants in the registry: parameters and names.

use crate::{Cauchy, Field, Kind, Parameters, Registered, Values};
use hairis::model::MatchedBell;
use hairis::params::HairDesc;
use hairis::{Gaussian, HairParams, Matched, ParamError, Published};

/// Half a degree, rad.
const NARROW: f32 = 0.008_726_646;

/// Random hair is that of everyday: widths of 1 to 30 degrees, shifts within 15 degrees, glints at 10 to 80 degrees and
/// of strength 0.1 to 10, colours in `[0, 1)`.
impl Parameters for HairParams {
    const FIELDS: &'static [Field] = &[
        Field::new(
            "alpha",
            Kind::Numbers(&["alpha_r", "alpha_tt", "alpha_trt"]),
        )
        .uniform(-15.0, 15.0)
        .degrees(),
        Field::new("beta", Kind::Numbers(&["beta_r", "beta_tt", "beta_trt"]))
            .log_uniform(1.0, 30.0)
            .degrees()
            .narrow(NARROW),
        Field::new("gamma_tt", Kind::Number)
            .log_uniform(1.0, 30.0)
            .degrees()
            .narrow(NARROW),
        Field::new("gamma_g", Kind::Number)
            .log_uniform(1.0, 30.0)
            .degrees()
            .narrow(NARROW),
        Field::new("phi_g", Kind::Number)
            .uniform(10.0, 80.0)
            .degrees()
            .late(),
        Field::new("i_r", Kind::Rgb)
            .alias("intensity_r")
            .uniform(0.0, 1.0),
        Field::new("i_tt", Kind::Rgb)
            .alias("intensity_tt")
            .uniform(0.0, 1.0),
        Field::new("i_trt", Kind::Rgb)
            .alias("intensity_trt")
            .uniform(0.0, 1.0),
        Field::new("i_g", Kind::Number)
            .alias("intensity_g")
            .log_uniform(0.1, 10.0)
            .late(),
    ];
    const PRESETS: &'static [(&'static str, Self)] = &Self::presets();

    #[inline]
    fn values(&self) -> Values {
        let d = self.desc();
        Values::none(Self::FIELDS)
            .with("alpha", &[d.alpha_r, d.alpha_tt, d.alpha_trt])
            .with("beta", &[d.beta_r, d.beta_tt, d.beta_trt])
            .with("gamma_tt", &[d.gamma_tt])
            .with("gamma_g", &[d.gamma_g])
            .with("phi_g", &[d.phi_g])
            .with("i_r", &d.intensity_r)
            .with("i_tt", &d.intensity_tt)
            .with("i_trt", &d.intensity_trt)
            .with("i_g", &[d.intensity_g])
    }

    #[inline]
    fn from_values(values: &Values) -> Result<Self, ParamError> {
        let [alpha_r, alpha_tt, alpha_trt] = values.get("alpha");
        let [beta_r, beta_tt, beta_trt] = values.get("beta");
        let number = |name| {
            let [number] = values.get(name);
            number
        };
        Self::new(&HairDesc {
            alpha_r,
            alpha_tt,
            alpha_trt,
            beta_r,
            beta_tt,
            beta_trt,
            gamma_tt: number("gamma_tt"),
            gamma_g: number("gamma_g"),
            phi_g: number("phi_g"),
            intensity_r: values.get("i_r"),
            intensity_tt: values.get("i_tt"),
            intensity_trt: values.get("i_trt"),
            intensity_g: number("i_g"),
        })
    }
}

/// A bell that the registry has models of.
pub trait RegisteredBell: MatchedBell + Send + Sync + 'static {
    /// Name of the models.
    const NAME: &'static str;
    /// The bell as it is registered.
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
}

/// Word of the matched sampler: `matched` for nine bands, the default, and `matched-` with their
/// number for others.
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
}
