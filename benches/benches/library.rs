//! The C library, opened at run time.

#[path = "../../variants/capi/src/layout.rs"]
#[allow(
    dead_code,
    unreachable_pub,
    reason = "the structs of the library: some are not used here"
)]
pub(crate) mod layout;

use core::ffi::c_char;
use core::mem::{MaybeUninit, forget};
use core::ptr::{null, null_mut};
use glam::Vec3;
use hairis_variants::Registered;
use layout::{EvalResult, Evals, Hits, OK, Params, RawBsdf, RawMaterial, SampleResult, Samples};
use std::ffi::CString;

macro_rules! library {
    ($($name:ident: ($($argument:ty),*) $(-> $out:ty)?;)*) => {
        /// Functions of the library.
        #[derive(Clone, Copy)]
        pub(crate) struct Library {
            $(pub(crate) $name: unsafe extern "C" fn($($argument),*) $(-> $out)?,)*
        }

        impl Library {
            pub(crate) fn open(path: &str) -> Self {
                // SAFETY: the library runs nothing when it is loaded, and has these functions: its header's test says so.
                unsafe {
                    let library = libloading::Library::new(path).unwrap_or_else(|e| panic!("HAIRIS_LIBRARY must be a library: {e}"));
                    let found = Self {
                        $($name: *library.get(stringify!($name)).unwrap_or_else(|e| panic!("HAIRIS_LIBRARY must be libhairis.so: {e}")),)*
                    };
                    // The functions live as long as the program.
                    forget(library);
                    found
                }
            }
        }
    };
}

type Text = *const c_char;
type Columns = *const [*const f32; 3];
library! {
    hairis_params_init: (*mut Params, Text, Text, Text, *mut layout::Error) -> i32;
    hairis_material_init: (*mut RawMaterial, *const Params, u32, *mut layout::Error) -> i32;
    hairis_prepare: (*mut RawBsdf, *const RawMaterial, f32, f32, f32, f32);
    hairis_eval_pdf: (*const RawBsdf, f32, f32, f32) -> EvalResult;
    hairis_sample: (*const RawBsdf, f32, f32, f32) -> SampleResult;
    hairis_eval_columns: (*const RawBsdf, usize, Columns, *const Evals) -> i32;
    hairis_sample_columns: (*const RawBsdf, usize, Columns, *const Samples) -> i32;
    hairis_eval_hits: (*const RawMaterial, usize, usize, *const Hits, Columns, *const Evals) -> i32;
    hairis_sample_hits: (*const RawMaterial, usize, usize, *const Hits, Columns, *const Samples) -> i32;
}

impl Library {
    /// A preset with an energy.
    pub(crate) fn material<M: Registered>(&self, preset: &str, energy: u32) -> RawMaterial {
        let text = |text: &str| CString::new(text).expect("a name");
        let (name, preset) = (text(M::NAME), text(preset));
        let word = M::CHOICE.map(|(_, word)| text(word));
        let word = word.as_ref().map_or(null(), |word| word.as_ptr());
        let (mut params, mut material) = (MaybeUninit::uninit(), MaybeUninit::uninit());
        // SAFETY: both are written unless a status says otherwise.
        unsafe {
            let status = (self.hairis_params_init)(
                params.as_mut_ptr(),
                name.as_ptr(),
                word,
                preset.as_ptr(),
                null_mut(),
            );
            assert_eq!(status, OK, "{} {preset:?}", M::NAME);
            let params = params.assume_init();
            let status =
                (self.hairis_material_init)(material.as_mut_ptr(), &params, energy, null_mut());
            assert_eq!(status, OK, "{} {preset:?}", M::NAME);
            material.assume_init()
        }
    }

    #[inline(always)]
    /// A BSDF, at the offset 0.
    pub(crate) fn prepare(&self, material: &RawMaterial, wo: Vec3) -> RawBsdf {
        let mut bsdf = MaybeUninit::uninit();
        // SAFETY: the call writes the BSDF.
        unsafe {
            (self.hairis_prepare)(bsdf.as_mut_ptr(), material, wo.x, wo.y, wo.z, 0.0);
            bsdf.assume_init()
        }
    }
}
