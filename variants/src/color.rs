#![doc = include_str!("guide/color.md")]

mod solve;

use crate::{Chiang, ChiangDesc, ModelId, Values};
use core::f32::consts::{FRAC_PI_3, FRAC_PI_6};
use core::fmt;
use hairis::ParamError;
use hairis::params::Rule;
use hairis::simd::Lanes;

/// Subject that has an asked colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ColorOf {
    /// Mass of hair, by the fit that Chiang et al. 2016 published: see [`ChiangDesc::with_color`]. Only their model has it.
    Chiang,
    /// One fibre, seen from its side under uniform light: the directional albedo at normal incidence, as a mean over the fibre's width.
    Fibre,
    /// Mass of hair under uniform light, as on a head: many scatterings, by the model's own averages and a fitted curve.
    Mass,
}

impl ColorOf {
    /// Every subject, in the order of lists.
    pub const ALL: [Self; 3] = [Self::Chiang, Self::Fibre, Self::Mass];

    /// Returns the word of the subject in files and in other languages: "chiang", "fibre" or "mass".
    #[inline]
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Chiang => "chiang",
            Self::Fibre => "fibre",
            Self::Mass => "mass",
        }
    }

    /// Finds the subject of a word.
    #[inline]
    #[must_use]
    pub fn find(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|of| of.word() == word)
    }
}

/// Reason for which a material cannot have an asked colour.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ColorError {
    /// A parameter is out of its range, or the colour itself.
    Param(ParamError),
    /// No quantity of the model depends on a colour in this sense.
    Model(ModelId, ColorOf),
    /// The model has no field of this name with so many numbers.
    Field,
}

impl fmt::Display for ColorError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Param(error) => error.fmt(f),
            Self::Model(id, of) => {
                let (model, of) = (id.name(), of.word());
                write!(f, "color_of must be a sense that {model} has, got {of:?}")
            }
            Self::Field => f.write_str("the model has no such number"),
        }
    }
}

impl core::error::Error for ColorError {}

impl From<ParamError> for ColorError {
    #[inline]
    fn from(error: ParamError) -> Self {
        Self::Param(error)
    }
}

/// Function that makes the material of these values, which conserves energy, and measures it at an inclination of the light: see
/// [`albedo_and_forward`](hairis::dual_scattering::albedo_and_forward). Libraries whose materials are not
/// [`AnyMaterial`](crate::AnyMaterial) give their own.
pub type Measure<'a> = dyn FnMut(ModelId, &Values, f32) -> Result<[[f32; 3]; 2], ParamError> + 'a;

/// Derivatives of the absorption that a colour asks for, by channel: see [`derivatives`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColorDerivatives {
    /// By the same channel of the colour. Other channels have no influence.
    pub by_color: [f32; 3],
    /// By a number of a field, at a constant colour.
    pub by_number: [f32; 3],
}

/// Largest channel of a colour that is distinguished from white.
const MOST: f32 = 0.9999;
/// Absorption of black: beyond, light that enters a fibre does not leave it in single precision.
const MOST_ABSORPTION: f32 = 16.0;
/// Least divisor.
const LEAST: f32 = 1e-12;
/// Inclinations of a mass, rad, and their weights: Gauss's rule for the weight `cos^2 theta`, which hits under isotropic light have.
const INCLINATIONS: [[f32; 2]; 5] = [
    [-FRAC_PI_3, 1.0 / 12.0],
    [-FRAC_PI_6, 0.25],
    [0.0, 1.0 / 3.0],
    [FRAC_PI_6, 0.25],
    [FRAC_PI_3, 1.0 / 12.0],
];
/// Coefficients of the curve of a mass, by powers of `1 - s` from the first, fitted to the head with straight hair of `hairis-render` under
/// uniform light: 60 materials of three models, to 1.2% of the light (rms).
const CURVE: [f32; 3] = [0.453, 0.814, -0.33];
/// Share of the light that goes on which hair of a head treats as if it had met no fibre, from the same fit: 1 if hair had no end.
const FORWARD: f32 = 0.685;

/// Fields that a colour decides, by their indices.
#[derive(Clone, Copy)]
enum Dye {
    /// Absorption per radius.
    Absorption(usize),
    /// Intensities of TT, whose light passes the pigment once, and of TRT, whose light passes it twice.
    Intensities([usize; 2]),
}

impl Dye {
    fn of(id: ModelId, values: &Values, of: ColorOf) -> Result<Self, ColorError> {
        let found = match (of, values.index("sigma_a"), values.index("i_tt")) {
            (ColorOf::Chiang, Some(sigma_a), _) if id.name() == ModelId::of::<Chiang>().name() => {
                Some(Self::Absorption(sigma_a))
            }
            (ColorOf::Chiang, ..) => None,
            (_, Some(sigma_a), _) => Some(Self::Absorption(sigma_a)),
            (_, None, Some(tt)) => values
                .index("i_trt")
                .map(|trt| Self::Intensities([tt, trt])),
            _ => None,
        };
        found.ok_or(ColorError::Model(id, of))
    }

    /// Returns the values without pigment. Intensities are then as grey as their largest channel.
    fn without(self, values: &Values) -> Values {
        let mut base = *values;
        // The fields are of the model, and have three numbers.
        match self {
            Self::Absorption(index) => {
                let _ = base.set_at(index, &[0.0; 3]);
            }
            Self::Intensities(indices) => {
                for index in indices {
                    let most = values.get_at::<3>(index).into_iter().fold(0.0, f32::max);
                    let _ = base.set_at(index, &[most; 3]);
                }
            }
        }
        base
    }

    /// Returns the values with pigment that absorbs these shares of the light on its way through a radius; below 0, light is added.
    fn with(self, values: &Values, absorbed: [f32; 3]) -> Values {
        let mut dyed = *values;
        let mut set = |index, by: &dyn Fn(f32, f32) -> f32| {
            let before = values.get_at::<3>(index);
            let after = [0, 1, 2].map(|c| by(before[c], absorbed[c]));
            let _ = dyed.set_at(index, &after);
        };
        match self {
            Self::Absorption(index) => set(index, &|sigma, share| {
                (sigma - libm::log1pf(-share)).clamp(0.0, f32::MAX)
            }),
            Self::Intensities([tt, trt]) => {
                set(tt, &|i, share| (i * (1.0 - share)).min(f32::MAX));
                set(trt, &|i, share| {
                    (i * (1.0 - share) * (1.0 - share)).min(f32::MAX)
                });
            }
        }
        dyed
    }
}

/// Returns true if an absorption or intensities of the model follow from the colour that hair shows.
#[inline]
#[must_use]
pub fn has_color(id: ModelId) -> bool {
    Dye::of(id, &id.defaults(), ColorOf::Fibre).is_ok()
}

/// Computes the colour of a mass of fibres from their albedo and its share that goes on, which is the mean of the albedo times the cosine of the
/// azimuth by which light turns.
///
/// The curve rises with `1 - s`, and with `s = sqrt((1 - albedo) / (1 - FORWARD forward))` it falls where any part of the light is absorbed:
/// where `a_k` falls by `d_k`, the numerator grows by the sum of `d_k`, and the denominator by at most as much, while it is the larger one.
fn mass(albedo: f32, forward: f32) -> f32 {
    let rest = (1.0 - albedo).max(0.0);
    let square = f32::quotient(rest, (1.0 - FORWARD * forward).max(LEAST));
    let lit = 1.0 - libm::sqrtf(square.min(1.0));
    let [first, second, third] = CURVE;
    lit * (first + lit * (second + lit * third))
}

/// Returns the colour that hair of these values shows, linear RGB.
///
/// # Errors
///
/// Returns an error if a value is out of its range, or if the model has no colour in this sense.
#[inline(never)]
pub fn shown(
    id: ModelId,
    values: &Values,
    of: ColorOf,
    measure: &mut Measure<'_>,
) -> Result<[f32; 3], ColorError> {
    Dye::of(id, values, of)?;
    // Weights of samples are constant with the matched sampler, so that their sums converge faster.
    let best = ModelId::find(id.name(), Some("matched")).unwrap_or(id);
    match of {
        ColorOf::Chiang => Ok(ChiangDesc::of_values(values).color()),
        ColorOf::Fibre => Ok(measure(best, values, 0.0)?[0]),
        ColorOf::Mass => {
            let mut means = [[0.0_f32; 3]; 2];
            for [theta, weight] in INCLINATIONS {
                let measured = measure(best, values, theta)?;
                for (mean, measured) in means.iter_mut().zip(measured) {
                    for c in 0..3 {
                        mean[c] += weight * measured[c];
                    }
                }
            }
            let [albedo, forward] = means;
            Ok([0, 1, 2].map(|c| mass(albedo[c], forward[c])))
        }
    }
}

/// Returns the values with the absorption, or the intensities of TT and TRT, with which hair shows a colour, linear RGB. All other fields
/// stay as they are: set widths and tints before.
///
/// - Colours that the hair cannot show become the nearest that it can, channel by channel: the surface reflects light whatever the
///   absorption, and channels above .9999 count as .9999. Black is an absorption of 16.
/// - Intensities: those of TT are multiplied by the share of light that a pigment lets through, and those of TRT by its square, from grey
///   intensities as large as the largest channel of `values`. R stays.
///
/// # Errors
///
/// Returns an error if a value is out of its range, if a channel of the colour is negative or not finite ([`ColorOf::Chiang`]: or above 1),
/// or if the model has no colour in this sense.
#[inline(never)]
pub fn with_color(
    id: ModelId,
    values: &Values,
    color: [f32; 3],
    of: ColorOf,
    measure: &mut Measure<'_>,
) -> Result<Values, ColorError> {
    let dye = Dye::of(id, values, of)?;
    if of == ColorOf::Chiang {
        let desc = ChiangDesc::of_values(values).with_color(color)?;
        let mut colored = *values;
        let _ = colored.set("sigma_a", &desc.sigma_a);
        return Ok(colored);
    }
    Rule::NotNegative.check("color", &color)?;
    let asked = color.map(|channel| channel.min(MOST));
    let base = dye.without(values);
    let black = -libm::expm1f(-MOST_ABSORPTION);
    let can_add = matches!(dye, Dye::Intensities(_));
    let absorbed = solve::solve(asked, black, can_add, &mut |absorbed| {
        shown(id, &dye.with(&base, absorbed), of, measure)
    })?;
    Ok(dye.with(&base, absorbed))
}

/// Returns derivatives of the absorption per radius that [`with_color`] chooses, from the values that it returned.
///
/// By the theorem of implicit functions, with the shown colour C and the absorption s, they are `1 / (dC/ds)` and `-(dC/dx) / (dC/ds)`, where
/// x is number `number` of the field `field`. Derivatives of C are central differences. For intensities s is minus the logarithm of the
/// pigment's share: `di_tt = -i_tt ds` and `di_trt = -2 i_trt ds`.
///
/// - Accuracy: a percent of the largest, for absorptions in `[1e-3, 4]`; a test compares with differences of [`with_color`].
/// - Domain: a channel whose colour does not depend on absorption, as black, has derivatives of 0.
///
/// # Errors
///
/// Returns an error as [`shown`] does, or if there is no such number.
#[inline(never)]
pub fn derivatives(
    id: ModelId,
    values: &Values,
    of: ColorOf,
    (field, number): (&str, usize),
    measure: &mut Measure<'_>,
) -> Result<ColorDerivatives, ColorError> {
    let dye = Dye::of(id, values, of)?;
    let index = values.index(field).ok_or(ColorError::Field)?;
    let (numbers, range) = (values.numbers_at(index), values.fields()[index].range());
    let (Some(at), Some([least, most])) = (numbers.get(number).copied(), range) else {
        return Err(ColorError::Field);
    };
    // Steps of absorption: a share of it, as a mass near white depends on its root.
    let steps = match dye {
        Dye::Absorption(index) => values
            .get_at::<3>(index)
            .map(|sigma| (0.05 * sigma).min(0.03)),
        Dye::Intensities(_) => [0.03; 3],
    };
    let mut dyed = |sign: f32| {
        let absorbed = steps.map(|step| -libm::expm1f(-sign * step));
        shown(id, &dye.with(values, absorbed), of, measure)
    };
    let (more, less) = (dyed(1.0)?, dyed(-1.0)?);
    let step = (0.02 * at.abs()).max(1e-3);
    let ends = [(at - step).max(least), (at + step).min(most)];
    let mut moved = |to: f32| {
        let mut all = [0.0; Values::MOST];
        let all = &mut all[..numbers.len()];
        all.copy_from_slice(numbers);
        all[number] = to;
        let mut moved = *values;
        let _ = moved.set_at(index, all);
        shown(id, &moved, of, measure)
    };
    let (before, after) = (moved(ends[0])?, moved(ends[1])?);
    let width = (ends[1] - ends[0]).max(LEAST);
    let mut derivatives = ColorDerivatives::default();
    for c in 0..3 {
        let fall = less[c] - more[c];
        // Below, the difference is that of roundings.
        if fall > 1e-6 {
            let by_color = -f32::quotient(2.0 * steps[c], fall.max(1e-6));
            derivatives.by_color[c] = by_color;
            derivatives.by_number[c] = -by_color * f32::quotient(after[c] - before[c], width);
        }
    }
    Ok(derivatives)
}

#[cfg(feature = "any")]
impl ModelId {
    /// Returns the values with the absorption, or the intensities of TT and TRT, with which hair shows a colour: see
    /// [`color::with_color`](with_color). Takes a tenth of a second for a mass.
    ///
    /// # Errors
    ///
    /// Returns an error as [`color::with_color`](with_color) does.
    ///
    /// ```
    /// use hairis_variants::color::ColorOf;
    /// use hairis_variants::{DEonParams, ModelId, Parameters};
    /// let auburn = [0.28, 0.13, 0.07];
    /// let values = ModelId::DEon.with_color(&DEonParams::default().values(), auburn, ColorOf::Mass)?;
    /// let hair = DEonParams::from_values(&values)?;
    /// let [red, _, blue] = hair.desc().sigma_a;
    /// assert!(red < 0.3 && blue > 0.5);
    /// let shown = ModelId::DEon.shown_color(&values, ColorOf::Mass)?;
    /// assert!((shown[1] - auburn[1]).abs() < 1e-3);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[inline]
    pub fn with_color(
        self,
        values: &Values,
        color: [f32; 3],
        of: ColorOf,
    ) -> Result<Values, ColorError> {
        with_color(self, values, color, of, &mut measured)
    }

    /// Returns the colour that hair of these values shows, linear RGB: see [`color::shown`](shown).
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of its range, or if the model has no colour in this sense.
    #[inline]
    pub fn shown_color(self, values: &Values, of: ColorOf) -> Result<[f32; 3], ColorError> {
        shown(self, values, of, &mut measured)
    }

    /// Returns derivatives of the absorption that [`with_color`](Self::with_color) chooses, by the colour and by a number of a field: see
    /// [`color::derivatives`](derivatives).
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of its range, if the model has no colour in this sense, or if it has no such number.
    ///
    /// ```
    /// use hairis_variants::ModelId;
    /// use hairis_variants::color::ColorOf;
    /// let id = ModelId::Chiang;
    /// let values = id.with_color(&id.defaults(), [0.5, 0.3, 0.2], ColorOf::Mass)?;
    /// let by = id.color_derivatives(&values, ColorOf::Mass, ("beta_n", 0))?;
    /// assert!(by.by_color.iter().all(|by| *by < 0.0)); // less absorption for a lighter colour
    /// # Ok::<(), hairis_variants::color::ColorError>(())
    /// ```
    #[inline]
    pub fn color_derivatives(
        self,
        values: &Values,
        of: ColorOf,
        number: (&str, usize),
    ) -> Result<ColorDerivatives, ColorError> {
        derivatives(self, values, of, number, &mut measured)
    }
}

/// Measures a material that conserves energy.
#[cfg(feature = "any")]
fn measured(id: ModelId, values: &Values, theta: f32) -> Result<[[f32; 3]; 2], ParamError> {
    let material = id.material(values)?.conserving();
    Ok(material.albedo_and_forward(theta))
}
