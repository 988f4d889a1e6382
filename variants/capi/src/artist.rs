//! Hair in an artist's terms.

use crate::layout::{ARGUMENT, Artist, Error, Glints, Highlight, OK, Params, Transmission};
use crate::setup::{params_of, refuse_value, values_of};
use crate::text::{Fault, refuse};
use hairis::HairParams;
use hairis::params::{self, ArtistControls};
use hairis_variants::Parameters;

/// `hairis_artist_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_artist_init(to: *mut Artist) {
    let highlight = |from: &params::Highlight| Highlight {
        color: from.color,
        intensity: from.intensity,
        shift_deg: from.shift_deg,
        width_deg: from.width_deg,
    };
    let controls = ArtistControls::default();
    let (tt, glints) = (&controls.transmission, &controls.glints);
    let artist = Artist {
        primary: highlight(&controls.primary),
        transmission: Transmission {
            color: tt.color,
            intensity: tt.intensity,
            shift_deg: tt.shift_deg,
            width_deg: tt.width_deg,
            azimuthal_width_deg: tt.azimuthal_width_deg,
        },
        secondary: highlight(&controls.secondary),
        glints: Glints {
            strength: glints.strength,
            separation_deg: glints.separation_deg,
            azimuthal_width_deg: glints.azimuthal_width_deg,
        },
    };
    // SAFETY: the caller's promise.
    unsafe { to.write(artist) };
}

/// The artist's controls as Rust has them.
fn controls(from: &Artist) -> ArtistControls {
    let highlight = |from: &Highlight| params::Highlight {
        color: from.color,
        intensity: from.intensity,
        shift_deg: from.shift_deg,
        width_deg: from.width_deg,
    };
    let (tt, glints) = (&from.transmission, &from.glints);
    ArtistControls {
        primary: highlight(&from.primary),
        transmission: params::Transmission {
            color: tt.color,
            intensity: tt.intensity,
            shift_deg: tt.shift_deg,
            width_deg: tt.width_deg,
            azimuthal_width_deg: tt.azimuthal_width_deg,
        },
        secondary: highlight(&from.secondary),
        glints: params::Glints {
            strength: glints.strength,
            separation_deg: glints.separation_deg,
            azimuthal_width_deg: glints.azimuthal_width_deg,
        },
    }
}

/// `hairis_params_set_artist`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_params_set_artist(
    params: *mut Params,
    from: *const Artist,
    error: *mut Error,
) -> i32 {
    // SAFETY: the caller's promise.
    let (read, from) = unsafe { (values_of(params, error), from.as_ref()) };
    let id = match read {
        Ok((id, _)) => id,
        Err(code) => return code,
    };
    let has_controls = id.fields() == <HairParams as Parameters>::FIELDS;
    let (Some(from), true) = (from, has_controls) else {
        let message = &format_args!(
            "the model must be gaussian or cauchy, and from not NULL; got {}",
            id.name()
        );
        // SAFETY: the caller's promise.
        return unsafe { refuse(error, ARGUMENT, &Fault::of("model"), message) };
    };
    match HairParams::from_artist(&controls(from)) {
        Ok(hair) => {
            // SAFETY: the caller's promise.
            unsafe { params.write(params_of(id, &hair.values())) };
            OK
        }
        // SAFETY: the caller's promise.
        Err(fault) => unsafe { refuse_value(error, &fault) },
    }
}
