//! Hair in an artist's terms: colours and intensities of the highlights, with angles in degrees.

use crate::layout::{ARGUMENT, Artist, Error, Glints, Highlight, OK, Params, Transmission};
use crate::setup::{params_of, refuse_value, values_of};
use crate::text::{Fault, refuse};
use hairis::HairParams;
use hairis::params::{self, ArtistControls};
use hairis_variants::Parameters;

/// Converts structs of C to the structs of Rust with the same fields, and back.
macro_rules! same_fields {
    ($($of_c:ident = $of_rust:ident { $($field:ident),* })*) => {$(
        impl From<params::$of_rust> for $of_c {
            fn from(from: params::$of_rust) -> Self {
                Self { $($field: from.$field.into()),* }
            }
        }

        impl From<$of_c> for params::$of_rust {
            fn from(from: $of_c) -> Self {
                Self { $($field: from.$field.into()),* }
            }
        }
    )*};
}
same_fields! {
    Highlight = Highlight { color, intensity, shift_deg, width_deg }
    Transmission = Transmission { color, intensity, shift_deg, width_deg, azimuthal_width_deg }
    Glints = Glints { strength, separation_deg, azimuthal_width_deg }
    Artist = ArtistControls { primary, transmission, secondary, glints }
}

/// Implements `hairis_artist_init`: writes the default controls.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_artist_init(to: *mut Artist) {
    // SAFETY: the caller's promise.
    unsafe { to.write(ArtistControls::default().into()) };
}

/// Implements `hairis_params_set_artist`: replaces parameters by the hair that an artist's controls describe.
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
        let got = if has_controls { "NULL" } else { id.name() };
        let message =
            &format_args!("the model must be gaussian or cauchy, and from not NULL; got {got}");
        // SAFETY: the caller's promise.
        return unsafe { refuse(error, ARGUMENT, &Fault::of("model"), message) };
    };
    match HairParams::from_artist(&(*from).into()) {
        Ok(hair) => {
            // SAFETY: the caller's promise.
            unsafe { params.write(params_of(id, &hair.values())) };
            OK
        }
        // SAFETY: the caller's promise.
        Err(fault) => unsafe { refuse_value(error, &fault) },
    }
}
