//! Colours that hosts ask for.

use crate::dual::drawing;
use crate::handles::init;
use crate::layout::{ARGUMENT, ENERGY_CONSERVING, Error, NAME, OK, Params, RawMaterial};
use crate::setup::{params_of, refuse_value, values_of};
use crate::text::{Fault, List, refuse, string};
use core::ffi::c_char;
use core::mem::MaybeUninit;
use hairis::dual_scattering::albedo_and_forward;
use hairis_variants::color::{ColorError, ColorOf, with_color};

/// Implements `hairis_params_set_color`: sets the absorption or the intensities with which hair shows a colour.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_params_set_color(
    params: *mut Params,
    color: *const [f32; 3],
    of: *const c_char,
    error: *mut Error,
) -> i32 {
    // SAFETY: the caller's promise.
    let (word, read) = unsafe { (string(of).unwrap_or_default(), values_of(params, error)) };
    let (id, values) = match read {
        Ok(read) => read,
        Err(code) => return code,
    };
    // SAFETY: the caller's promise.
    let refuse = |code, field, message: &dyn core::fmt::Display| unsafe {
        refuse(error, code, &Fault::of(field), message)
    };
    if color.is_null() {
        return refuse(ARGUMENT, "color", &"color must not be NULL");
    }
    let Some(of) = ColorOf::find(word) else {
        let words = List(ColorOf::ALL.iter().map(|of| of.word()));
        let message = &format_args!("color_of must be one of {words}, got {word:?}");
        return refuse(NAME, "color_of", message);
    };
    // SAFETY: the caller's promise.
    let color = unsafe { *color };
    let colored = with_color(id, &values, color, of, &mut |id, values, theta| {
        let mut material = MaybeUninit::<RawMaterial>::uninit();
        // SAFETY: the material is initialised before it is read.
        unsafe {
            init(material.as_mut_ptr(), id, values, ENERGY_CONSERVING)?;
            let mut draw = drawing(material.as_ptr());
            Ok(albedo_and_forward(theta, id.lobes().len(), &mut draw))
        }
    });
    match colored {
        Ok(values) => {
            // SAFETY: the caller's promise; `values_of` has read parameters from there.
            unsafe { params.write(params_of(id, &values)) };
            OK
        }
        // SAFETY: the caller's promise.
        Err(ColorError::Param(fault)) => unsafe { refuse_value(error, &fault) },
        Err(fault) => refuse(NAME, "color_of", &fault),
    }
}
