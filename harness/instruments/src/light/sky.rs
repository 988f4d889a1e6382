//! Clear sky, an environment that needs no file.

use super::{Environment, luminance, rounded};
use core::array::from_fn;
use core::f64::consts::PI;
use glam::DVec3;

/// Width and height of the rendered map, in texels.
const SIZE: [usize; 2] = [512, 256];

/// Reflectance of the ground, in each channel.
const GROUND: f64 = 0.2;

/// Turbidity of a clear day.
const TURBIDITY: f64 = 3.0;

/// Elevation of the sun above the horizon and its azimuth to the right of -z, in degrees.
const SUN_DEG: [f64; 2] = [40.0, 35.0];

/// Perez coefficients of Y, x and y, five each: every coefficient is `slope * turbidity + offset`.
const PEREZ: [[[f64; 2]; 5]; 3] = [
    [
        [0.1787, -1.4630],
        [-0.3554, 0.4275],
        [-0.0227, 5.3251],
        [0.1206, -2.5771],
        [-0.0670, 0.3703],
    ],
    [
        [-0.0193, -0.2592],
        [-0.0665, 0.0008],
        [-0.0004, 0.2125],
        [-0.0641, -0.8989],
        [-0.0033, 0.0452],
    ],
    [
        [-0.0167, -0.2608],
        [-0.0950, 0.0092],
        [-0.0079, 0.2102],
        [-0.0441, -1.6537],
        [-0.0109, 0.0529],
    ],
];

/// Coefficients of the zenith chromaticities x and y. Rows belong to the turbidity squared, to the first power and constant; columns to
/// the sun's angle, cubed down to constant.
const ZENITH: [[[f64; 4]; 3]; 2] = [
    [
        [0.00166, -0.00375, 0.00209, 0.0],
        [-0.02903, 0.06377, -0.03202, 0.00394],
        [0.11693, -0.21196, 0.06052, 0.25886],
    ],
    [
        [0.00275, -0.00610, 0.00317, 0.0],
        [-0.04214, 0.08970, -0.04153, 0.00516],
        [0.15346, -0.26756, 0.06670, 0.26688],
    ],
];

/// Clear sky with a sun, above a grey ground.
///
/// The sky is the analytic daylight of Preetham, with Perez' distribution and the zenith luminance and chromaticity of its appendix.
/// The illuminance of the sun above the atmosphere is 133.8 klx. Rayleigh and aerosol extinction dim the sun, computed at 610, 550 and
/// 465 nm. The disc of the sun is narrower than a texel, so it is blurred to a bell of deviation 0.6 degrees that holds the same
/// illuminance. Below the horizon lies a Lambertian ground of reflectance 0.2, which is lit by the sky and the sun.
///
/// - Source: Preetham, Shirley and Smits 1999, A practical analytic model for daylight, section 3 and appendix; the relative optical
///   mass is Kasten's.
/// - Units: radiance is linear RGB whose luminance is in kcd/m^2 (the spectral shape is reduced to three channels, a simplification).
/// - Accuracy: the model is known to be too bright around a sun near the horizon; it is meant as a plausible light, not as a
///   measurement.
///
/// # Examples
/// ```
/// use hairis_instruments::light::Sky;
/// let map = Sky::default().environment();
/// assert_eq!(map.size(), [512, 256]);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sky {
    sun: DVec3,
    sun_polar: f64,
}

impl Default for Sky {
    /// Returns the sky of a clear day with turbidity 3. The sun is 40 degrees high and 35 degrees to the right of -z.
    fn default() -> Self {
        let [elevation, azimuth] = SUN_DEG.map(f64::to_radians);
        let [(sin_e, cos_e), (sin_a, cos_a)] = [elevation, azimuth].map(f64::sin_cos);
        Self {
            sun: DVec3::new(cos_e * sin_a, sin_e, -cos_e * cos_a),
            sun_polar: 0.5 * PI - elevation,
        }
    }
}

impl Sky {
    /// Name of the environment in tables and files.
    pub const NAME: &'static str = "clear sky";

    /// Name of the environment as it reads in a sentence.
    pub const WORDS: &'static str = "a procedural sky";

    /// Returns the unit vector towards the sun.
    #[must_use]
    pub fn sun(&self) -> DVec3 {
        self.sun
    }

    /// Returns the radiance of the sky without its sun at `dir` above the horizon, linear RGB in kcd/m^2. Colours outside the gamut
    /// have their negative channels set to 0.
    #[must_use]
    pub fn sky_radiance(&self, dir: DVec3) -> [f64; 3] {
        // The fit diverges at the horizon, so its value half a degree above the horizon is used below that angle.
        let cos_theta = dir.y.max(0.01);
        let cos_gamma = dir.dot(self.sun).clamp(-1.0, 1.0);
        let [luminance, x, y] = from_fn(|k| {
            let [a, b, c, d, e] = PEREZ[k].map(|[slope, offset]| slope * TURBIDITY + offset);
            let perez = |cos_t: f64, cos_g: f64| {
                (1.0 + a * (b / cos_t).exp())
                    * (1.0 + c * (d * cos_g.acos()).exp() + e * cos_g * cos_g)
            };
            self.zenith(k) * perez(cos_theta, cos_gamma) / perez(1.0, self.sun_polar.cos())
        });
        xyy_to_rgb(x, y, luminance.max(0.0))
    }

    /// Returns the zenith luminance in kcd/m^2 for `k` 0, and the chromaticities x and y for 1 and 2.
    fn zenith(&self, k: usize) -> f64 {
        let (t, s) = (TURBIDITY, self.sun_polar);
        if k == 0 {
            let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * s);
            return (4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192;
        }
        let row = |c: [f64; 4]| ((c[0] * s + c[1]) * s + c[2]) * s + c[3];
        let [square, first, constant] = ZENITH[k - 1].map(row);
        (square * t + first) * t + constant
    }

    /// Returns the illuminance of the sun on a plane that faces the sun, linear RGB in klx.
    #[must_use]
    pub fn sun_irradiance(&self) -> [f64; 3] {
        let degrees = self.sun_polar.to_degrees();
        let mass = 1.0 / (self.sun_polar.cos() + 0.15 * (93.885 - degrees).powf(-1.253));
        let aerosol = 0.04608 * TURBIDITY - 0.04586;
        [0.610_f64, 0.550, 0.465].map(|micrometres| {
            let depth = 0.008_735 * micrometres.powf(-4.08) + aerosol * micrometres.powf(-1.3);
            133.8 * (-depth * mass).exp()
        })
    }

    /// Renders the sky as a map of 512 by 256 texels, whose bits are the same each time on one machine.
    ///
    /// # Panics
    ///
    /// Never, because there is a pixel for each texel.
    #[must_use]
    pub fn environment(&self) -> Environment {
        let [width, height] = SIZE;
        let upper = height / 2 * width;
        let edge = |j: usize| (PI * j as f64 / height as f64).cos();
        let deviation = 0.6_f64.to_radians();
        let mut sky_and_bell = Vec::with_capacity(upper);
        let (mut irradiance, mut bell_sum, mut bell_cosine) = ([0.0; 3], 0.0, 0.0);
        for k in 0..upper {
            let (i, j) = (k % width, k / width);
            let polar = PI * (j as f64 + 0.5) / height as f64;
            let azimuth = 2.0 * PI * ((i as f64 + 0.5) / width as f64 - 0.5);
            let dir = DVec3::new(
                polar.sin() * azimuth.sin(),
                polar.cos(),
                -polar.sin() * azimuth.cos(),
            );
            let solid_angle = 2.0 * PI / width as f64 * (edge(j) - edge(j + 1));
            let sky = self.sky_radiance(dir);
            // |dir - sun|^2 is the squared angle to first order, and exact enough over a bell of half a degree.
            let bell = (-0.5 * (dir - self.sun).length_squared() / (deviation * deviation)).exp();
            bell_sum += bell * solid_angle;
            bell_cosine += bell * solid_angle * dir.y;
            for c in 0..3 {
                irradiance[c] += sky[c] * dir.y * solid_angle;
            }
            sky_and_bell.push((sky, bell));
        }
        let sun = self.sun_irradiance().map(|e| e / bell_sum);
        let lit = sky_and_bell
            .iter()
            .map(|(sky, bell)| from_fn(|c| rounded(sky[c] + sun[c] * bell)));
        let ground = from_fn(|c| rounded(GROUND / PI * (irradiance[c] + sun[c] * bell_cosine)));
        let pixels = lit
            .chain(core::iter::repeat_n(ground, width * height - upper))
            .collect();
        Environment::from_pixels(Self::NAME, width, height, pixels).expect("a pixel for each texel")
    }
}

/// Converts a colour of chromaticity (x, y) and luminance `big_y` to linear RGB with the Rec. 709 primaries and the D65 white. Negative
/// channels become 0, and the others are scaled so that the luminance stays.
#[must_use]
pub fn xyy_to_rgb(x: f64, y: f64, big_y: f64) -> [f64; 3] {
    let (cap_x, cap_z) = (x / y * big_y, (1.0 - x - y) / y * big_y);
    let rgb = [
        3.240_969_94 * cap_x - 1.537_383_18 * big_y - 0.498_610_76 * cap_z,
        -0.969_243_64 * cap_x + 1.875_967_50 * big_y + 0.041_555_06 * cap_z,
        0.055_630_08 * cap_x - 0.203_976_96 * big_y + 1.056_971_51 * cap_z,
    ]
    .map(|v| v.max(0.0));
    let now = luminance(rgb);
    if now > 0.0 {
        rgb.map(|v| v * big_y / now)
    } else {
        [0.0; 3]
    }
}
