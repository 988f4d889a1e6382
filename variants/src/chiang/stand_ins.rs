//! Melanin, dyes and colours, which stand in for the absorption, and derivatives by them.

use super::ChiangDesc;
use super::params::{ROUGHNESS, SHARE};
use hairis::ParamError;
use hairis::params::{Pigments, Rule, melanin_concentrations};

/// Coefficients of the denominator in the absorption of a colour, by powers of the azimuthal roughness: Chiang et al. 2016, section 4.
const COLOR: [f32; 6] = [5.969, -0.215, 2.532, -10.73, 5.574, 0.245];
/// Least channel of a colour that the absorption distinguishes.
const LEAST_COLOR: f32 = 1e-3;

/// Returns the denominator in the absorption of a colour.
#[inline]
fn color_denominator(n: f32) -> f32 {
    COLOR.iter().rev().fold(0.0, |sum, c| c + n * sum)
}

impl ChiangDesc {
    /// Sets the pigments, of which later calls make melanin: see [`with_melanin`](Self::with_melanin).
    ///
    /// ```
    /// use hairis::params::Pigments;
    /// use hairis_variants::ChiangDesc;
    /// let auburn = ChiangDesc::default().with_pigments(Pigments::CYCLES).with_melanin_amount(0.7, 0.6)?;
    /// assert!((auburn.sigma_a[0] - 0.491_46).abs() < 1e-4);
    /// # Ok::<(), hairis::ParamError>(())
    /// ```
    #[inline]
    #[must_use]
    pub const fn with_pigments(self, pigments: Pigments) -> Self {
        Self {
            eumelanin: pigments.eumelanin,
            pheomelanin: pigments.pheomelanin,
            ..self
        }
    }

    /// Returns the pigments.
    #[inline]
    #[must_use]
    pub const fn pigments(&self) -> Pigments {
        Pigments {
            eumelanin: self.eumelanin,
            pheomelanin: self.pheomelanin,
        }
    }

    /// Sets the absorption of these concentrations of melanin: see [`Pigments::absorption`]. Set the pigments first.
    ///
    /// # Errors
    ///
    /// Returns an error if a concentration is negative or not finite.
    #[inline]
    pub fn with_melanin(self, eumelanin: f32, pheomelanin: f32) -> Result<Self, ParamError> {
        let melanin = [eumelanin, pheomelanin];
        Rule::NotNegative.check("melanin", &melanin)?;
        Ok(Self {
            sigma_a: self.pigments().absorption(melanin).map(|c| c.min(f32::MAX)),
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

    /// Sets the absorption by an artist's melanin whose amount varies from strand to strand: `amount (1 + 2 randomize (random - 1/2))`,
    /// between 0 and 1.
    ///
    /// - Domain: `random` is the number of the strand, which the host draws; at .5 the amount is as given.
    /// - Source: Cycles' `random_color`, which other renderers call `melanin_randomize`.
    ///
    /// # Errors
    ///
    /// Returns an error if a number is outside `[0, 1]`.
    ///
    /// ```
    /// use hairis_variants::ChiangDesc;
    /// let strand = |random| ChiangDesc::default().with_random_melanin(0.5, 0.3, 0.2, random);
    /// assert!(strand(0.1)?.sigma_a[0] < strand(0.9)?.sigma_a[0]);
    /// # Ok::<(), hairis::ParamError>(())
    /// ```
    #[inline]
    pub fn with_random_melanin(
        self,
        amount: f32,
        redness: f32,
        randomize: f32,
        random: f32,
    ) -> Result<Self, ParamError> {
        SHARE.check("amount", &[amount])?;
        SHARE.check("randomize", &[randomize])?;
        SHARE.check("random", &[random])?;
        let varied = amount * varied(random, randomize);
        self.with_melanin_amount(varied.clamp(0.0, 1.0), redness)
    }

    /// Adds the absorption of a dye, which is that of [`with_color`](Self::with_color), to the fibre's own: white is no dye. Set `beta_n`
    /// and the melanin first.
    ///
    /// - Source: the `tint` of Cycles, which other renderers call a dye.
    ///
    /// # Errors
    ///
    /// Returns an error if a channel is outside `[0, 1]`, or if `beta_n` is outside its range.
    ///
    /// ```
    /// use hairis_variants::ChiangDesc;
    /// let hair = ChiangDesc::default().with_melanin_amount(0.3, 0.5)?;
    /// let dyed = hair.with_dye([1.0, 0.2, 0.6])?; // absorbs green most, and no red
    /// assert!(dyed.sigma_a[1] > hair.sigma_a[1] && dyed.sigma_a[0] == hair.sigma_a[0]);
    /// # Ok::<(), hairis::ParamError>(())
    /// ```
    #[inline]
    pub fn with_dye(self, dye: [f32; 3]) -> Result<Self, ParamError> {
        SHARE.check("dye", &dye)?;
        let dye = self.with_color(dye)?.sigma_a;
        Ok(Self {
            sigma_a: [0, 1, 2].map(|c| (self.sigma_a[c] + dye[c]).min(f32::MAX)),
            ..self
        })
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
}

/// Returns the factor by which the number of a strand varies what a share of it is random.
#[inline]
pub(super) fn varied(random: f32, share: f32) -> f32 {
    1.0 + 2.0 * (random - 0.5) * share
}

/// Returns the derivatives by concentrations of melanin, of which the absorption is a sum, given those by the absorption.
#[inline]
pub(crate) fn by_melanin(pigments: &Pigments, by_absorption: [f64; 3]) -> [f64; 2] {
    [pigments.eumelanin, pigments.pheomelanin].map(|unit| dot(unit.map(f64::from), by_absorption))
}

/// Returns the derivatives by an artist's amount and redness of melanin, given those by the absorption.
///
/// With `q = -ln(1 - amount)`, the concentrations are `q (1 - redness)` and `q redness`. Where `q` is largest, the amount has no effect.
#[inline]
pub(super) fn by_melanin_amount(
    pigments: &Pigments,
    [amount, redness]: [f32; 2],
    by_absorption: [f64; 3],
) -> [f64; 2] {
    let [eumelanin, pheomelanin] = by_melanin(pigments, by_absorption);
    // A legal amount is never refused.
    let quantity = |amount| melanin_concentrations(amount, 0.0).map_or(0.0, |[all, _]| all);
    let (q, most) = (quantity(amount), quantity(1.0));
    let slope = if q < most {
        (1.0 - f64::from(amount)).recip()
    } else {
        0.0
    };
    let redness = f64::from(redness);
    [
        slope * (eumelanin * (1.0 - redness) + pheomelanin * redness),
        f64::from(q) * (pheomelanin - eumelanin),
    ]
}

/// Returns the derivatives by the colour of a mass of hair, and the derivative by `beta_n` through the absorption of that colour, given
/// those by the absorption.
///
/// The absorption is `(ln color / d)^2`, with `d` a polynomial in `beta_n`. A channel below the least one has no effect.
#[inline]
pub(super) fn by_color(color: [f32; 3], beta_n: f32, by_absorption: [f64; 3]) -> ([f64; 3], f64) {
    let n = f64::from(beta_n);
    let [d, d_slope] = COLOR.iter().rev().fold([0.0; 2], |[sum, slope], c| {
        [f64::from(*c) + n * sum, sum + n * slope]
    });
    let log = color.map(|c| libm::log(f64::from(c.max(LEAST_COLOR))) / d);
    let by_color = core::array::from_fn(|channel| {
        let c = color[channel];
        if c < LEAST_COLOR {
            return 0.0;
        }
        2.0 * log[channel] / (d * f64::from(c)) * by_absorption[channel]
    });
    let by_beta_n = log.map(|log| -2.0 * log * log * d_slope / d);
    (by_color, dot(by_beta_n, by_absorption))
}

#[inline]
fn dot([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> f64 {
    a * x + b * y + c * z
}
