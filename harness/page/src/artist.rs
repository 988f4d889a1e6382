//! Artist's controls as numbers in a row, and their conversion to and from the parameters.

use crate::memory::NUMBERS;
use crate::slot;
use hairis::params::{ArtistControls, Glints, Highlight, Transmission};
use hairis::{HairParams, ParamError};
use hairis_variants::Parameters;

/// Control: its name in error messages, its count of numbers, its unit, and the range of its slider.
pub(crate) struct Control {
    pub(crate) name: &'static str,
    pub(crate) width: usize,
    pub(crate) unit: &'static str,
    pub(crate) range: [f32; 2],
}

const fn color(name: &'static str) -> Control {
    control(name, 3, "", [0.0, 1.0])
}

const fn intensity(name: &'static str, most: f32) -> Control {
    control(name, 1, "", [0.0, most])
}

const fn shift(name: &'static str) -> Control {
    control(name, 1, "deg", [-20.0, 20.0])
}

const fn width(name: &'static str) -> Control {
    control(name, 1, "deg", [0.5, 45.0])
}

const fn control(name: &'static str, width: usize, unit: &'static str, range: [f32; 2]) -> Control {
    Control {
        name,
        width,
        unit,
        range,
    }
}

/// Controls in the order of the numbers.
pub(crate) const CONTROLS: &[Control] = &[
    color("primary.color"),
    intensity("primary.intensity", 1.0),
    shift("primary.shift_deg"),
    width("primary.width_deg"),
    color("transmission.color"),
    intensity("transmission.intensity", 5.0),
    shift("transmission.shift_deg"),
    width("transmission.width_deg"),
    width("transmission.azimuthal_width_deg"),
    color("secondary.color"),
    intensity("secondary.intensity", 1.0),
    shift("secondary.shift_deg"),
    width("secondary.width_deg"),
    intensity("glints.strength", 5.0),
    control("glints.separation_deg", 1, "deg", [0.0, 180.0]),
    width("glints.azimuthal_width_deg"),
];

/// Replaces the numbers of the controls by the numbers of the corresponding parameters.
pub(crate) fn params(numbers: &mut [f32; NUMBERS]) -> Result<(), ParamError> {
    let [
        r0,
        r1,
        r2,
        ri,
        rs,
        rw,
        t0,
        t1,
        t2,
        ti,
        ts,
        tw,
        ta,
        s0,
        s1,
        s2,
        si,
        ss,
        sw,
        gs,
        gd,
        gw,
        ..,
    ] = *numbers;
    let controls = ArtistControls {
        primary: Highlight {
            color: [r0, r1, r2],
            intensity: ri,
            shift_deg: rs,
            width_deg: rw,
        },
        transmission: Transmission {
            color: [t0, t1, t2],
            intensity: ti,
            shift_deg: ts,
            width_deg: tw,
            azimuthal_width_deg: ta,
        },
        secondary: Highlight {
            color: [s0, s1, s2],
            intensity: si,
            shift_deg: ss,
            width_deg: sw,
        },
        glints: Glints {
            strength: gs,
            separation_deg: gd,
            azimuthal_width_deg: gw,
        },
    };
    let params = HairParams::from_artist(&controls)?;
    slot::write(&params.values(), numbers);
    Ok(())
}

/// Returns the controls of these parameters. The largest channel of a colour is the intensity, and the channels relative to it are the
/// colour.
pub(crate) fn controls(params: &HairParams) -> [f32; 22] {
    let d = params.desc();
    let tint = |rgb: [f32; 3]| {
        let most = rgb[0].max(rgb[1]).max(rgb[2]);
        let by = if most > 0.0 { 1.0 / most } else { 0.0 };
        (rgb.map(|c| (c * by).min(1.0)), most)
    };
    let [(r, ri), (t, ti), (s, si)] = [d.i_r, d.i_tt, d.i_trt].map(tint);
    let deg = f32::to_degrees;
    let [r0, r1, r2] = r;
    let [t0, t1, t2] = t;
    let [s0, s1, s2] = s;
    [
        r0,
        r1,
        r2,
        ri,
        deg(d.alpha[0]),
        deg(d.beta[0]),
        t0,
        t1,
        t2,
        ti,
        deg(d.alpha[1]),
        deg(d.beta[1]),
        deg(d.gamma_tt),
        s0,
        s1,
        s2,
        si,
        deg(d.alpha[2]),
        deg(d.beta[2]),
        d.i_g,
        deg(2.0 * d.phi_g),
        deg(d.gamma_g),
    ]
}
