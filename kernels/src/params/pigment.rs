//! Colours of pigment: the share of the light that a fibre of some melanin or absorption transmits.

use super::{ArtistControls, Rule};
use crate::params::error::ParamError;

/// Mean length of a passage through the fibre, in radii: `2 mean(cos gamma_t)` over offsets `h` across the fibre, with
/// `sin gamma_t = h / eta` and an index of refraction of 1.55 at normal incidence, `sqrt(1 - 1/eta^2) + eta asin(1 / eta)`.
const PASSAGE: f32 = 1.850_959_7;

/// Absorption per fibre radius, linear RGB, of a unit of each pigment of hair.
///
/// - Domain: each channel finite and at least 0; models check it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pigments {
    /// Absorption of a unit of eumelanin, which is brown to black.
    pub eumelanin: [f32; 3],
    /// Absorption of a unit of pheomelanin, which is red.
    pub pheomelanin: [f32; 3],
}

impl Pigments {
    /// Pigments of d'Eon et al. 2011, for Rec. 709: the default of pbrt and `MaterialX`.
    pub const D_EON: Self = Self {
        eumelanin: [0.419, 0.697, 1.37],
        pheomelanin: [0.187, 0.4, 1.05],
    };
    /// Pigments of Cycles and RTXCR, for Rec. 709.
    pub const CYCLES: Self = Self {
        eumelanin: [0.506, 0.841, 1.653],
        pheomelanin: [0.343, 0.733, 1.924],
    };
    /// [`D_EON`](Self::D_EON) [`converted`](Self::converted) to `ACEScg`.
    pub const D_EON_ACES_CG: Self = Self {
        eumelanin: [0.537_195_3, 0.681_218_4, 1.240_778_1],
        pheomelanin: [0.284_090_1, 0.389_818_73, 0.929_053_66],
    };
    /// [`CYCLES`](Self::CYCLES) [`converted`](Self::converted) to `ACEScg`.
    pub const CYCLES_ACES_CG: Self = Self {
        eumelanin: [0.644_092_2, 0.820_753_4, 1.486_195_3],
        pheomelanin: [0.502_320_4, 0.709_169_15, 1.638_424_4],
    };

    /// Makes pigments of the colours that a unit of eumelanin and of pheomelanin have, linear RGB: `-ln color`. In the working space of a
    /// renderer, the colours are those of that space.
    ///
    /// # Errors
    ///
    /// Returns an error if a channel is outside `[0, 1]`. Channels below 1e-30 count as 1e-30.
    ///
    /// ```
    /// use hairis::params::Pigments;
    /// let [eumelanin, pheomelanin] = Pigments::D_EON.colors();
    /// assert!((eumelanin[2] - 0.254_1).abs() < 1e-4 && (pheomelanin[0] - 0.829_4).abs() < 1e-4);
    /// # Ok::<(), hairis::ParamError>(())
    /// ```
    #[inline]
    pub fn from_colors([eumelanin, pheomelanin]: [[f32; 3]; 2]) -> Result<Self, ParamError> {
        const COLOR: Rule = Rule::Range([0.0, 1.0]);
        COLOR.check("eumelanin_color", &eumelanin)?;
        COLOR.check("pheomelanin_color", &pheomelanin)?;
        let absorption = |color: f32| 0.0_f32.max(-libm::logf(color.max(1e-30)));
        Ok(Self {
            eumelanin: eumelanin.map(absorption),
            pheomelanin: pheomelanin.map(absorption),
        })
    }

    /// Returns the colours of a unit of eumelanin and of pheomelanin: `exp(-absorption)`, as [`from_colors`](Self::from_colors) takes
    /// them.
    #[inline]
    #[must_use]
    pub fn colors(&self) -> [[f32; 3]; 2] {
        [self.eumelanin, self.pheomelanin].map(|unit| unit.map(|sigma| libm::expf(-sigma)))
    }

    /// Computes the absorption per fibre radius of concentrations of eumelanin and pheomelanin: their weighted sum.
    #[inline]
    #[must_use]
    pub const fn absorption(&self, [eumelanin, pheomelanin]: [f32; 2]) -> [f32; 3] {
        let (e, f) = (&self.eumelanin, &self.pheomelanin);
        [
            e[0] * eumelanin + f[0] * pheomelanin,
            e[1] * eumelanin + f[1] * pheomelanin,
            e[2] * eumelanin + f[2] * pheomelanin,
        ]
    }
}

/// Computes the absorption per fibre radius, linear RGB, of concentrations of eumelanin and pheomelanin, with
/// [`Pigments::D_EON`].
///
/// - Source: d'Eon et al. 2011. Blond hair has .3 and 0, brown 1.3 and 0, black 8 and 0, red .25 and 1.1.
#[inline]
#[must_use]
pub const fn melanin_absorption(concentrations: [f32; 2]) -> [f32; 3] {
    Pigments::D_EON.absorption(concentrations)
}

/// Computes the concentrations of eumelanin and pheomelanin from an artist's melanin: how dark the hair is, and how red.
///
/// `q = -ln max(1 - amount, 1e-4)`, eumelanin `q (1 - redness)`, pheomelanin `q redness`
///
/// - Source: `deon_hair_absorption_from_melanin` of the `MaterialX` standard library.
///
/// # Errors
///
/// Returns an error if `amount` or `redness` is outside `[0, 1]`.
#[inline]
pub fn melanin_concentrations(amount: f32, redness: f32) -> Result<[f32; 2], ParamError> {
    Rule::Range([0.0, 1.0]).check("melanin_amount", &[amount, redness])?;
    let quantity = -libm::logf((1.0 - amount).max(1e-4));
    Ok([quantity * (1.0 - redness), quantity * redness])
}

/// Computes the share of the light that one passage through a fibre transmits, for an absorption per radius: `exp(-1.851 sigma_a)`.
///
/// - Derivation: Beer's law over the mean length of a passage, `sqrt(1 - 1/eta^2) + eta asin(1 / eta)` radii for an index of refraction
///   eta of 1.55 at normal incidence.
/// - Range: `[0, 1]`, decreasing in `sigma_a`.
///
/// # Errors
///
/// Returns an error if a channel is negative or not finite.
///
/// ```
/// use hairis::params::{melanin_absorption, transmittance};
/// let [r, g, b] = transmittance(melanin_absorption([0.65, 0.0]))?;
/// assert!(r > g && g > b && r < 0.61); // brown
/// # Ok::<(), hairis::ParamError>(())
/// ```
#[inline]
pub fn transmittance(sigma_a: [f32; 3]) -> Result<[f32; 3], ParamError> {
    Rule::NotNegative.check("sigma_a", &sigma_a)?;
    Ok(sigma_a.map(|sigma| libm::expf(-PASSAGE * sigma)))
}

impl ArtistControls {
    /// Sets the colours from an absorption per fibre radius, of pigment or dye. The transmission gets the [`transmittance`], and the
    /// secondary highlight, whose light passes twice, its square. Intensities stay.
    ///
    /// # Errors
    ///
    /// Returns an error if a channel is negative or not finite.
    #[inline]
    pub fn with_absorption(mut self, sigma_a: [f32; 3]) -> Result<Self, ParamError> {
        let color = transmittance(sigma_a)?;
        self.transmission.color = color;
        self.secondary.color = color.map(|c| c * c);
        Ok(self)
    }

    /// Sets the colours from an artist's melanin: see [`melanin_concentrations`].
    ///
    /// # Errors
    ///
    /// Returns an error if `amount` or `redness` is outside `[0, 1]`.
    ///
    /// ```
    /// use hairis::HairParams;
    /// use hairis::params::ArtistControls;
    /// let auburn = HairParams::from_artist(&ArtistControls::default().with_melanin(0.6, 0.7)?)?;
    /// assert!(auburn.desc().i_trt[0] > 2.0 * auburn.desc().i_trt[1]);
    /// # Ok::<(), hairis::ParamError>(())
    /// ```
    #[inline]
    pub fn with_melanin(self, amount: f32, redness: f32) -> Result<Self, ParamError> {
        self.with_absorption(melanin_absorption(melanin_concentrations(amount, redness)?))
    }
}
