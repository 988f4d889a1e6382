//! Parameters of the energy-conserving fibre: the description, its checks and the presets.

use core::f32::consts::{FRAC_PI_4, PI};
use hairis::ParamError;
use hairis::model::Precision;
use hairis::params::{Pigments, Rule, melanin_absorption};
use hairis::simd::Lanes;

/// Range of accepted roughnesses.
pub(super) const ROUGHNESS: Rule = Rule::Range([1e-3, 1.0]);
/// Range of accepted tilts of the cuticle, in radians.
pub(super) const TILT: Rule = Rule::Range([-FRAC_PI_4, FRAC_PI_4]);
/// Range of accepted indices of refraction.
pub(super) const INDEX: Rule = Rule::Range([1.0, 4.0]);
/// Range of accepted cuticle angles of `MaterialX`, whose ends are those of the tilt.
pub(super) const CUTICLE: Rule = Rule::Range([0.25, 0.75]);
/// Range of the factors on a lobe's width.
pub(super) const WIDTH: Rule = Rule::Range([0.1, 10.0]);
/// Range of accepted colours and of the artist's amounts.
pub(super) const SHARE: Rule = Rule::Range([0.0, 1.0]);

/// Formula that turns the tilt of the cuticle's scales into the shifts of the lobes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "kebab-case")
)]
pub enum Shifts {
    /// Shifts of `theta_i + theta_o` by -2, +1 and +4 tilts for R, TT and TRT, after d'Eon et al. 2011.
    #[default]
    DEon,
    /// Shifts by `2 p eta - 2` tilts, which is the limit of small angles for any index of refraction and equals [`DEon`](Self::DEon) at
    /// an index of 1.5.
    SmallAngle,
}

/// Unchecked parameters of the model of Chiang et al. 2016. Set the fields that differ from the default, and pass the description to
/// [`ChiangParams::new`].
///
/// - Default: warm brown hair (eumelanin 1.3, pheomelanin .2), a `beta_m` and a `beta_n` of .3, a tilt of 2 degrees, an `eta` of 1.55.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        deny_unknown_fields,
        bound(deserialize = "T: Copy + From<f32> + serde::Deserialize<'de>")
    )
)]
pub struct ChiangDesc<T = f32> {
    /// Longitudinal roughness, in `[1e-3, 1]`; .3 is a width of 16.7 degrees, see [`width_deg`](Self::width_deg).
    pub beta_m: T,
    /// Azimuthal roughness, in `[1e-3, 1]`.
    pub beta_n: T,
    /// Tilt of the cuticle's scales, rad in `[-pi/4, pi/4]`. Positive moves the primary highlight towards the root.
    pub tilt: T,
    /// Index of refraction, in `[1, 4]`.
    pub eta: T,
    /// Absorption per fibre radius, linear RGB, each finite and at least 0.
    pub sigma_a: [T; 3],
    /// Formula of the lobes' shifts.
    #[cfg_attr(feature = "serde", serde(default))]
    pub shifts: Shifts,
    /// Tint of R, linear RGB in `[0, 1]`, which multiplies the attenuation of the lobe.
    #[cfg_attr(feature = "serde", serde(default = "no_tint"))]
    pub tint_r: [T; 3],
    /// Tint of TT, linear RGB in `[0, 1]`.
    #[cfg_attr(feature = "serde", serde(default = "no_tint"))]
    pub tint_tt: [T; 3],
    /// Tint of TRT and of the rest, linear RGB in `[0, 1]`.
    #[cfg_attr(feature = "serde", serde(default = "no_tint"))]
    pub tint_trt: [T; 3],
    /// Longitudinal widths of R, TT and TRT in multiples of [`width_deg`](Self::width_deg), each in `[.1, 10]`. The rest is as wide as TRT.
    #[cfg_attr(feature = "serde", serde(default = "width_m"))]
    pub width_m: [T; 3],
    /// Azimuthal widths of R, TT and TRT in multiples of [`azimuthal_scale`](Self::azimuthal_scale), each in `[.1, 10]`.
    #[cfg_attr(feature = "serde", serde(default = "width_n"))]
    pub width_n: [T; 3],
    /// Absorption per fibre radius of a unit of eumelanin, linear RGB, each finite and at least 0:
    /// [`with_melanin`](Self::with_melanin) and [`with_melanin_amount`](Self::with_melanin_amount) read it.
    #[cfg_attr(feature = "serde", serde(default = "eumelanin"))]
    pub eumelanin: [T; 3],
    /// Absorption of a unit of pheomelanin, as that of eumelanin.
    #[cfg_attr(feature = "serde", serde(default = "pheomelanin"))]
    pub pheomelanin: [T; 3],
}

/// Defaults of the fields that files may leave out, for serde.
#[cfg(feature = "serde")]
macro_rules! defaults {
    ($($name:ident: $field:ident;)*) => { $(
        fn $name<T: From<f32>>() -> [T; 3] {
            ChiangDesc::DEFAULT.$field.map(T::from)
        }
    )* };
}
#[cfg(feature = "serde")]
defaults! {
    no_tint: tint_r;
    width_m: width_m;
    width_n: width_n;
    eumelanin: eumelanin;
    pheomelanin: pheomelanin;
}

impl<T: Copy> ChiangDesc<T> {
    /// Converts every number of the description, for instance to another precision.
    #[inline]
    #[must_use]
    pub fn map<U>(&self, convert: impl Fn(T) -> U) -> ChiangDesc<U> {
        ChiangDesc {
            beta_m: convert(self.beta_m),
            beta_n: convert(self.beta_n),
            tilt: convert(self.tilt),
            eta: convert(self.eta),
            sigma_a: self.sigma_a.map(&convert),
            shifts: self.shifts,
            tint_r: self.tint_r.map(&convert),
            tint_tt: self.tint_tt.map(&convert),
            tint_trt: self.tint_trt.map(&convert),
            width_m: self.width_m.map(&convert),
            width_n: self.width_n.map(&convert),
            eumelanin: self.eumelanin.map(&convert),
            pheomelanin: self.pheomelanin.map(&convert),
        }
    }
}

impl ChiangDesc {
    const DEFAULT: Self = Self::look(1.3, 0.2);

    /// Returns the default with this melanin, for use in constants.
    const fn look(eumelanin: f32, pheomelanin: f32) -> Self {
        Self {
            beta_m: 0.3,
            beta_n: 0.3,
            tilt: 2.0 * PI / 180.0,
            eta: 1.55,
            sigma_a: melanin_absorption([eumelanin, pheomelanin]),
            shifts: Shifts::DEon,
            tint_r: [1.0; 3],
            tint_tt: [1.0; 3],
            tint_trt: [1.0; 3],
            // After Marschner et al. 2003.
            width_m: [1.0, 0.5, 2.0],
            width_n: [1.0; 3],
            eumelanin: Pigments::D_EON.eumelanin,
            pheomelanin: Pigments::D_EON.pheomelanin,
        }
    }

    /// Sets the tilt from a cuticle angle as `MaterialX` has it: `pi (angle - 1/2)` radians.
    ///
    /// # Errors
    ///
    /// Returns an error if `angle` is outside `[.25, .75]`, which are the ends of the range of [`tilt`](Self::tilt).
    #[inline]
    pub fn with_cuticle_angle(self, angle: f32) -> Result<Self, ParamError> {
        CUTICLE.check("cuticle_angle", &[angle])?;
        Ok(Self {
            tilt: (PI * (angle - 0.5)).clamp(-FRAC_PI_4, FRAC_PI_4),
            ..self
        })
    }

    /// Returns the longitudinal width of `beta_m` in degrees: `sqrt(v)` of [`longitudinal_variance`](Self::longitudinal_variance).
    #[inline]
    #[must_use]
    pub fn width_deg(&self) -> f32 {
        libm::sqrtf(self.longitudinal_variance()) * 180.0 / PI
    }

    /// Returns the longitudinal variance v of `beta_m`: `(.726 m + .812 m^2 + 3.7 m^20)^2`, with `m` the `beta_m`. A lobe has this variance
    /// times the square of its [`width_m`](Self::width_m): by default R all, TT a quarter, and TRT and the rest four times as much.
    ///
    /// - Source: Chiang et al. 2016, section 4.
    #[inline]
    #[must_use]
    pub fn longitudinal_variance(&self) -> f32 {
        variance(f64::from(self.beta_m)).rounded()
    }

    /// Returns the scale s of the azimuthal logistic in radians: `sqrt(pi / 8) (.265 n + 1.194 n^2 + 5.372 n^22)`, with `n` the `beta_n`. A
    /// lobe has this scale times its [`width_n`](Self::width_n).
    ///
    /// - Source: Chiang et al. 2016, section 4.
    #[inline]
    #[must_use]
    pub fn azimuthal_scale(&self) -> f32 {
        scale(f64::from(self.beta_n)).rounded()
    }

    /// Returns the shifts of `theta_i + theta_o` for R, TT, TRT and the rest, in radians.
    #[inline]
    #[must_use]
    pub fn shifts_rad(&self) -> [f32; 4] {
        let small_angle = self.shifts == Shifts::SmallAngle;
        shifts(f64::from(self.tilt), f64::from(self.eta), small_angle).map(f64::rounded)
    }
}

/// Returns the longitudinal variance of R for a `beta_m`. Hosts use double precision, because narrow lobes magnify rounding in their
/// tails.
#[inline]
pub(super) fn variance<W: Precision>(m: W) -> W {
    let root = root(m);
    root * root
}

/// Returns the longitudinal width of R for a `beta_m`, which is the root of its variance.
#[inline]
pub(super) fn root<W: Precision>(m: W) -> W {
    m * ALONG.over(m)
}

/// Returns the scale of the azimuthal logistic for a `beta_n`, in radians.
#[inline]
pub(super) fn scale<W: Precision>(n: W) -> W {
    W::constant(ABOUT_BY) * n * ABOUT.over(n)
}

/// Width of a lobe by its roughness `x`: `a x + b x^2 + c x^n`, after Chiang et al. 2016, section 4.
pub(super) struct Width {
    pub(super) terms: [f64; 3],
    pub(super) power: u8,
}

/// Width along the fibre.
pub(super) const ALONG: Width = Width {
    terms: [0.726, 0.812, 3.7],
    power: 20,
};
/// Width about the fibre, over the root of pi / 8.
pub(super) const ABOUT: Width = Width {
    terms: [0.265, 1.194, 5.372],
    power: 22,
};
/// Root of pi / 8, which has no constant function.
pub(super) const ABOUT_BY: f64 = 0.626_657_068_657_750_1;

impl Width {
    /// Returns the width over the roughness.
    #[inline]
    pub(super) fn over<W: Precision>(&self, x: W) -> W {
        let [a, b, c] = self.terms.map(W::constant);
        a + x * (b + c * x.power(self.power - 2))
    }

    /// Returns the roughness of a width, which may be that of a roughness of 1.2.
    #[inline]
    pub(super) fn roughness<W: Precision>(&self, width: W) -> W {
        let n = f64::from(self.power);
        let [a, b, c] = self.terms;
        let [a, b, b_slope, c, c_slope] = [a, b, 2.0 * b, (n - 1.0) * c, n * c].map(W::constant);
        // Newton's steps come from above. Where the last term is the largest each is a twentieth, and there are no more than ten of them.
        let (most, linear) = (W::constant(1.2), width / a);
        let mut x = W::select(linear.lt(most), linear, most);
        for _ in 0..15 {
            let power = x.power(self.power - 2);
            x = (width + x * x * (b + c * power)) / (a + x * (b_slope + c_slope * power));
        }
        x
    }
}

/// Returns the shifts of the lobes in radians; the mask is set for [`Shifts::SmallAngle`].
#[inline]
pub(super) fn shifts<W: Precision>(
    tilt: W,
    eta: W,
    small_angle: <W::Lane as Lanes>::Mask,
) -> [W; 4] {
    let c = W::constant;
    let factors = [
        c(-2.0),
        W::select(small_angle, c(2.0) * eta - c(2.0), c(1.0)),
        W::select(small_angle, c(4.0) * eta - c(2.0), c(4.0)),
        c(0.0),
    ];
    factors.map(|factor| factor * tilt)
}

impl Default for ChiangDesc {
    #[inline]
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Parameters of the energy-conserving fibre that have passed all checks.
///
/// ```
/// use hairis_variants::{ChiangDesc, ChiangParams};
/// let refused = ChiangParams::new(&ChiangDesc { beta_m: 0.0, ..ChiangDesc::default() });
/// assert_eq!(refused.unwrap_err().to_string(), "beta_m must be in [0.001, 1], got 0");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "ChiangDesc", into = "ChiangDesc")
)]
pub struct ChiangParams(ChiangDesc);

impl ChiangParams {
    /// Checks `desc` and makes parameters of the model from it.
    ///
    /// # Errors
    ///
    /// Returns an error for the first field outside its range (see [`ChiangDesc`]), with its value; NaN and infinities are always rejected.
    #[inline]
    pub fn new(desc: &ChiangDesc) -> Result<Self, ParamError> {
        ROUGHNESS.check("beta_m", &[desc.beta_m])?;
        ROUGHNESS.check("beta_n", &[desc.beta_n])?;
        TILT.check("tilt", &[desc.tilt])?;
        INDEX.check("eta", &[desc.eta])?;
        Rule::NotNegative.check("sigma_a", &desc.sigma_a)?;
        SHARE.check("tint_r", &desc.tint_r)?;
        SHARE.check("tint_tt", &desc.tint_tt)?;
        SHARE.check("tint_trt", &desc.tint_trt)?;
        WIDTH.check("width_m", &desc.width_m)?;
        WIDTH.check("width_n", &desc.width_n)?;
        Rule::NotNegative.check("eumelanin", &desc.eumelanin)?;
        Rule::NotNegative.check("pheomelanin", &desc.pheomelanin)?;
        Ok(Self(*desc))
    }

    /// Returns the description with the values that were checked.
    #[inline]
    #[must_use]
    pub const fn desc(&self) -> &ChiangDesc {
        &self.0
    }
}

/// Presets, which are the default with the melanin of d'Eon et al. 2011; the melanin of white hair is this project's own.
impl ChiangParams {
    /// Returns the preset of blond hair, with .3 of eumelanin.
    #[inline]
    #[must_use]
    pub const fn blond() -> Self {
        Self(ChiangDesc::look(0.3, 0.0))
    }

    /// Returns the preset of brown hair, with 1.3 of eumelanin.
    #[inline]
    #[must_use]
    pub const fn brown() -> Self {
        Self(ChiangDesc::look(1.3, 0.0))
    }

    /// Returns the preset of red hair, with .25 of eumelanin and 1.1 of pheomelanin.
    #[inline]
    #[must_use]
    pub const fn red() -> Self {
        Self(ChiangDesc::look(0.25, 1.1))
    }

    /// Returns the preset of black hair, with 8 of eumelanin.
    #[inline]
    #[must_use]
    pub const fn black() -> Self {
        Self(ChiangDesc::look(8.0, 0.0))
    }

    /// Returns the preset of white hair, with .02 of eumelanin.
    #[inline]
    #[must_use]
    pub const fn white() -> Self {
        Self(ChiangDesc::look(0.02, 0.0))
    }

    /// Returns every preset with its name, for menus and test grids.
    #[inline]
    #[must_use]
    pub const fn presets() -> [(&'static str, Self); 6] {
        [
            ("default", Self(ChiangDesc::DEFAULT)),
            ("blond", Self::blond()),
            ("brown", Self::brown()),
            ("red", Self::red()),
            ("black", Self::black()),
            ("white", Self::white()),
        ]
    }
}

impl Default for ChiangParams {
    #[inline]
    fn default() -> Self {
        Self(ChiangDesc::DEFAULT)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<ChiangDesc> for ChiangParams {
    type Error = ParamError;

    #[inline]
    fn try_from(desc: ChiangDesc) -> Result<Self, ParamError> {
        Self::new(&desc)
    }
}

#[cfg(feature = "serde")]
impl From<ChiangParams> for ChiangDesc {
    #[inline]
    fn from(params: ChiangParams) -> Self {
        params.0
    }
}
