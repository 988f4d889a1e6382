//! Parameters of the energy-conserving fibre: the description, its checks and the presets.

use core::f32::consts::{FRAC_PI_4, PI};
use hairis::ParamError;
use hairis::model::Precision;
use hairis::params::{Rule, melanin_absorption, melanin_concentrations};
use hairis::simd::Lanes;

/// Range of accepted roughnesses.
pub(super) const ROUGHNESS: Rule = Rule::Range([1e-3, 1.0]);
/// Range of accepted tilts of the cuticle, in radians.
pub(super) const TILT: Rule = Rule::Range([-FRAC_PI_4, FRAC_PI_4]);
/// Range of accepted indices of refraction.
pub(super) const INDEX: Rule = Rule::Range([1.0, 4.0]);
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
    serde(deny_unknown_fields)
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
        }
    }

    /// Sets the absorption of these concentrations of melanin: see [`melanin_absorption`].
    ///
    /// # Errors
    ///
    /// Returns an error if a concentration is negative or not finite.
    #[inline]
    pub fn with_melanin(self, eumelanin: f32, pheomelanin: f32) -> Result<Self, ParamError> {
        let melanin = [eumelanin, pheomelanin];
        Rule::NotNegative.check("melanin", &melanin)?;
        Ok(Self {
            sigma_a: melanin_absorption(melanin).map(|c| c.min(f32::MAX)),
            ..self
        })
    }

    /// Sets the absorption by an artist's controls of melanin, its `amount` and its `redness`: see [`melanin_concentrations`].
    ///
    /// # Errors
    ///
    /// Returns an error if `amount` or `redness` is outside `[0, 1]`.
    ///
    /// ```
    /// use hairis_variants::{ChiangDesc, ChiangParams};
    /// let auburn = ChiangParams::new(&ChiangDesc::default().with_melanin_amount(0.7, 0.6)?)?;
    /// assert!(auburn.desc().sigma_a[2] > auburn.desc().sigma_a[0]);
    /// # Ok::<(), hairis::ParamError>(())
    /// ```
    #[inline]
    pub fn with_melanin_amount(self, amount: f32, redness: f32) -> Result<Self, ParamError> {
        let [eumelanin, pheomelanin] = melanin_concentrations(amount, redness)?;
        self.with_melanin(eumelanin, pheomelanin)
    }

    /// Sets the absorption with which a mass of such hair has approximately this colour.
    ///
    /// `sigma_a = (ln color / (5.969 - .215 n + 2.532 n^2 - 10.73 n^3 + 5.574 n^4 + .245 n^5))^2`, with `n` the `beta_n`
    ///
    /// - Source: Chiang et al. 2016, section 4. The formula inverts multiple scattering in a mass of hair, not the colour of one fibre.
    /// - Domain: `color` is linear RGB in `[0, 1]`; channels below 1e-3 count as 1e-3. Set `beta_n` first: the result depends on it.
    ///
    /// # Errors
    ///
    /// Returns an error if a channel is outside `[0, 1]`, or if `beta_n` is outside its range.
    #[inline]
    pub fn with_color(self, color: [f32; 3]) -> Result<Self, ParamError> {
        ROUGHNESS.check("beta_n", &[self.beta_n])?;
        SHARE.check("color", &color)?;
        let by = 1.0 / color_denominator(self.beta_n);
        let absorption = |c: f32| {
            let log = libm::logf(c.max(LEAST_COLOR)) * by;
            log * log
        };
        Ok(Self {
            sigma_a: color.map(absorption),
            ..self
        })
    }

    /// Returns the approximate colour of a mass of such hair, as the inverse of [`with_color`](Self::with_color).
    #[inline]
    #[must_use]
    pub fn color(&self) -> [f32; 3] {
        let scale = color_denominator(self.beta_n);
        self.sigma_a
            .map(|sigma| libm::expf(-libm::sqrtf(sigma) * scale))
    }

    /// Returns the longitudinal width of R in degrees: `sqrt(v)` of [`longitudinal_variance`](Self::longitudinal_variance).
    #[inline]
    #[must_use]
    pub fn width_deg(&self) -> f32 {
        libm::sqrtf(self.longitudinal_variance()) * 180.0 / PI
    }

    /// Returns the longitudinal variance v of R: `(.726 m + .812 m^2 + 3.7 m^20)^2`, with `m` the `beta_m`. TT has a quarter of this
    /// variance, and TRT and the rest have four times as much.
    ///
    /// - Source: Chiang et al. 2016, section 4.
    #[inline]
    #[must_use]
    pub fn longitudinal_variance(&self) -> f32 {
        variance(f64::from(self.beta_m)).rounded()
    }

    /// Returns the scale s of the azimuthal logistic in radians: `sqrt(pi / 8) (.265 n + 1.194 n^2 + 5.372 n^22)`, with `n` the `beta_n`.
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
    let c = W::constant;
    let root = m * (c(0.726) + m * (c(0.812) + c(3.7) * m.power(18)));
    root * root
}

/// Returns the scale of the azimuthal logistic for a `beta_n`, in radians.
#[inline]
pub(super) fn scale<W: Precision>(n: W) -> W {
    let c = W::constant;
    c(libm::sqrt(core::f64::consts::PI / 8.0))
        * n
        * (c(0.265) + n * (c(1.194) + c(5.372) * n.power(20)))
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

/// Coefficients of the denominator in the absorption of a colour, by powers of the azimuthal roughness: Chiang et al. 2016, section 4.
pub(super) const COLOR: [f32; 6] = [5.969, -0.215, 2.532, -10.73, 5.574, 0.245];
/// Least channel of a colour that the absorption distinguishes.
pub(super) const LEAST_COLOR: f32 = 1e-3;

/// Returns the denominator in the absorption of a colour.
#[inline]
fn color_denominator(n: f32) -> f32 {
    COLOR.iter().rev().fold(0.0, |sum, c| c + n * sum)
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
