//! Named presets: everyday hair to start from, and the parameters of the paper's efficiency figures.

use super::{HairDesc, HairParams};
use core::f32::consts::PI;

/// Values that differ between presets, in degrees; the other shifts and widths follow from R (Marschner et al. 2003,
/// table 1): `alpha_tt = -alpha_r / 2`, `alpha_trt = -3 alpha_r / 2`, `beta_tt = beta_r / 2`, `beta_trt = 2 beta_r`.
struct Look {
    alpha: f32,
    beta: f32,
    gamma_tt: f32,
    gamma_g: f32,
    phi_g: f32,
    /// Transmittance of one passage through the fibre: red, green and blue.
    pigment: [f32; 3],
    reflected: f32,
    /// Intensity of TT before the pigment, which it passes once.
    transmitted: f32,
    /// Intensity of TRT before the pigment, which it passes twice.
    returned: f32,
    glint: f32,
}

impl Look {
    const fn params(self) -> HairParams {
        let deg = PI / 180.0;
        let [r, g, b] = self.pigment;
        let (tt, trt) = (self.transmitted, self.returned);
        HairParams(HairDesc {
            alpha: [
                self.alpha * deg,
                -0.5 * self.alpha * deg,
                -1.5 * self.alpha * deg,
            ],
            beta: [
                self.beta * deg,
                0.5 * self.beta * deg,
                2.0 * self.beta * deg,
            ],
            gamma_tt: self.gamma_tt * deg,
            gamma_g: self.gamma_g * deg,
            phi_g: self.phi_g * deg,
            i_r: [self.reflected; 3],
            i_tt: [tt * r, tt * g, tt * b],
            i_trt: [trt * r * r, trt * g * g, trt * b * b],
            i_g: self.glint,
        })
    }
}

/// Base of the presets, each of which states its differences.
const BASE: Look = Look {
    alpha: -7.5,
    beta: 7.5,
    gamma_tt: 10.0,
    gamma_g: 10.0,
    phi_g: 35.0,
    pigment: [1.0; 3],
    reflected: 0.025,
    transmitted: 3.0,
    returned: 0.1,
    glint: 0.5,
};

const BLOND: HairParams = Look {
    alpha: -7.0,
    beta: 8.0,
    gamma_g: 14.0,
    pigment: [0.92, 0.76, 0.48],
    reflected: 0.02,
    transmitted: 2.5,
    glint: 0.6,
    ..BASE
}
.params();
const BROWN: HairParams = Look {
    pigment: [0.6, 0.4, 0.24],
    glint: 0.8,
    ..BASE
}
.params();
const RED: HairParams = Look {
    alpha: -7.0,
    gamma_g: 12.0,
    pigment: [0.8, 0.36, 0.14],
    glint: 0.7,
    ..BASE
}
.params();
const BLACK: HairParams = Look {
    alpha: -6.0,
    beta: 6.0,
    pigment: [0.14, 0.1, 0.08],
    reflected: 0.03,
    returned: 0.2,
    ..BASE
}
.params();
const WHITE: HairParams = Look {
    alpha: -8.0,
    beta: 9.0,
    gamma_tt: 12.0,
    gamma_g: 18.0,
    phi_g: 40.0,
    pigment: [0.97, 0.96, 0.94],
    reflected: 0.02,
    transmitted: 1.6,
    ..BASE
}
.params();

/// Parameters with which Ou et al. measure efficiency; not an everyday look.
const BRIGHT: HairParams = {
    let deg = PI / 180.0;
    HairParams(HairDesc {
        alpha: [-7.5 * deg, 3.75 * deg, 11.25 * deg],
        beta: [7.5 * deg, 3.75 * deg, 15.0 * deg],
        gamma_tt: 10.0 * deg,
        gamma_g: 10.0 * deg,
        phi_g: 35.0 * deg,
        i_r: [0.3; 3],
        i_tt: [0.8, 0.6, 0.4],
        i_trt: [0.7, 0.5, 0.3],
        i_g: 0.5,
    })
};

/// Presets. Shifts and widths are in the range that Marschner et al. 2003 (table 1) measured on everyday hair, and glints in the
/// range of Sadeghi et al. 2010. Intensities are ours: except for [`bright`](Self::bright), the light a fibre returns, averaged over
/// directions, is below what it receives in every channel. The figures beside each preset are for the Gaussian model (test
/// `params::presets_return_less_than_they_receive`). From grazing directions the fibre may still return up to twice as much, because
/// the model does not conserve energy: see [`Material::conserving_scale`](crate::Material::conserving_scale).
impl HairParams {
    /// Returns blond hair: bright, warm and translucent, with soft glints; `beta_r` is 8 degrees. The fibre returns (.81 .62 .34) of
    /// the light.
    #[inline]
    #[must_use]
    pub const fn blond() -> Self {
        BLOND
    }

    /// Returns brown hair: clear glints in a warm secondary highlight; `beta_r` is 7.5 degrees. The fibre returns (.48 .30 .19) of
    /// the light.
    #[inline]
    #[must_use]
    pub const fn brown() -> Self {
        BROWN
    }

    /// Returns red hair: copper when lit from behind; `beta_r` is 7.5 degrees. The fibre returns (.70 .27 .13) of the light.
    #[inline]
    #[must_use]
    pub const fn red() -> Self {
        RED
    }

    /// Returns black hair: sleek, and all but the white primary highlight is absorbed; `beta_r` is 6 degrees. The fibre
    /// returns (.12 .10 .09) of the light.
    #[inline]
    #[must_use]
    pub const fn black() -> Self {
        BLACK
    }

    /// Returns white hair of an elderly person: rough, with hardly any pigment; `beta_r` is 9 degrees. The fibre
    /// returns (.87 .85 .83) of the light.
    #[inline]
    #[must_use]
    pub const fn white() -> Self {
        WHITE
    }

    /// Returns bright hair, with the parameters of the efficiency figures: brown, with highlights as strong as an artist sets them under
    /// direct light alone. It returns about (3.9 3.0 2.1) times the light, so scale it for path tracing.
    #[inline]
    #[must_use]
    pub const fn bright() -> Self {
        BRIGHT
    }

    /// Returns every preset with its name, for menus and test grids. The figures of this project use the first preset.
    ///
    /// ```
    /// use hairis::HairParams;
    /// assert!(HairParams::presets().contains(&("red", HairParams::red())));
    /// ```
    #[inline]
    #[must_use]
    pub const fn presets() -> [(&'static str, Self); 6] {
        [
            ("bright", BRIGHT),
            ("blond", BLOND),
            ("brown", BROWN),
            ("red", RED),
            ("black", BLACK),
            ("white", WHITE),
        ]
    }
}

impl Default for HairParams {
    /// Returns [`HairParams::brown`].
    #[inline]
    fn default() -> Self {
        BROWN
    }
}
