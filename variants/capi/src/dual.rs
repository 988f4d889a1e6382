//! Dual scattering: averages of materials, and light that other fibres scattered.

use crate::columns::hairis_sample_columns;
use crate::handles::model_of;
use crate::layout::{ARGUMENT, Crossed, DualScattering, OK, RawBsdf, RawMaterial, Samples};
use crate::points::{hairis_prepare, hairis_restrict};
use core::mem::MaybeUninit;
use core::ptr;
use hairis::columns::SampleColumns;
use hairis::dual_scattering as dual;
use hairis::simd::Vec3x;
use hairis::{Hit, Lobe};

/// Returns a function that draws samples of one lobe of a material at a hit, by the calls of the interface, which are compiled for every model
/// already.
///
/// # Safety
///
/// The material must be initialised, and live as long as the function.
pub(crate) unsafe fn drawing(
    from: *const RawMaterial,
) -> impl Fn(Hit, Lobe, [&[f32]; 3], SampleColumns<'_>) {
    move |hit, lobe, xi, out| {
        let mut bsdf = MaybeUninit::<RawBsdf>::zeroed();
        let columns = |vector: Option<[&mut [f32]; 3]>| {
            vector.map_or([ptr::null_mut(); 3], |columns| {
                columns.map(|column| column.as_mut_ptr())
            })
        };
        let xi = xi.map(|column| (column.as_ptr(), column.len()));
        let samples = Samples {
            wi: columns(out.wi),
            value: [ptr::null_mut(); 3],
            pdf: ptr::null_mut(),
            weight: columns(out.weight),
            lobe: ptr::null_mut(),
        };
        let wo = hit.wo;
        // SAFETY: the material is initialised, the BSDF is written before it is read, and columns have one length.
        unsafe {
            hairis_prepare(bsdf.as_mut_ptr(), from, wo.x, wo.y, wo.z, hit.h);
            hairis_restrict(bsdf.as_mut_ptr(), 1 << lobe.index());
            hairis_sample_columns(
                bsdf.as_ptr(),
                xi[0].1,
                &xi.map(|(column, _)| column),
                &samples,
            );
        }
    }
}

/// Implements `hairis_dual_init`: measures the averages of a material.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_dual_init(
    to: *mut DualScattering,
    from: *const RawMaterial,
) -> i32 {
    if to.is_null() || from.is_null() {
        return ARGUMENT;
    }
    // SAFETY: the caller's promise.
    let Some(id) = (unsafe { model_of(from) }) else {
        return ARGUMENT;
    };
    // SAFETY: the material is initialised.
    let mut draw = unsafe { drawing(from) };
    let measured = dual::DualScattering::measured(id.lobes().len(), &mut draw);
    // SAFETY: the caller's promise.
    unsafe { (*to).coefficients = measured.coefficients };
    OK
}

/// Returns the averages of a struct of the header, or those of a fibre that scatters nothing.
unsafe fn averages(from: *const DualScattering, theta_i: f32) -> dual::Averages {
    let mut coefficients = [[[0.0; dual::TERMS]; 3]; dual::QUANTITIES];
    if !from.is_null() {
        // SAFETY: the caller's promise.
        coefficients = unsafe { (*from).coefficients };
    }
    dual::DualScattering { coefficients }.averages(theta_i)
}

fn to_header(crossed: &dual::Crossed) -> Crossed {
    Crossed {
        direct: crossed.direct,
        scattered: crossed.scattered,
        shift: crossed.shift,
        variance: crossed.variance,
    }
}

const fn from_header(crossed: &Crossed) -> dual::Crossed {
    dual::Crossed {
        direct: crossed.direct,
        scattered: crossed.scattered,
        shift: crossed.shift,
        variance: crossed.variance,
    }
}

/// Implements `hairis_dual_strands`: light that crossed so many fibres.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_dual_strands(
    from: *const DualScattering,
    theta_i: f32,
    count: f32,
) -> Crossed {
    // SAFETY: the caller's promise.
    to_header(&dual::Crossed::strands(
        &unsafe { averages(from, theta_i) },
        count,
    ))
}

/// Implements `hairis_dual_depth`: light that came through an optical depth.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_dual_depth(
    from: *const DualScattering,
    theta_i: f32,
    depth: f32,
) -> Crossed {
    // SAFETY: the caller's promise.
    to_header(&dual::Crossed::depth(
        &unsafe { averages(from, theta_i) },
        depth,
    ))
}

/// Implements `hairis_dual_through`: light after one more fibre.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_dual_through(
    crossed: *mut Crossed,
    from: *const DualScattering,
    theta_i: f32,
) {
    if crossed.is_null() {
        return;
    }
    // SAFETY: the caller's promise.
    unsafe {
        let after = from_header(&*crossed).through(&averages(from, theta_i));
        *crossed = to_header(&after);
    }
}

/// Implements `hairis_dual_shade`: light from `wi` to the viewer, in place of S.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_dual_shade(
    from: *const DualScattering,
    wo: *const [f32; 3],
    wi: *const [f32; 3],
    single: *const [f32; 3],
    crossed: *const Crossed,
    gain: *const [f32; 2],
    value: *mut [f32; 3],
) {
    if value.is_null() {
        return;
    }
    let all = [wo, wi, single];
    let is_given = all.into_iter().all(|vector| !vector.is_null());
    if from.is_null() || crossed.is_null() || gain.is_null() || !is_given {
        // SAFETY: the caller's promise.
        return unsafe { ptr::write(value, [0.0; 3]) };
    }
    // SAFETY: the caller's promise.
    unsafe {
        let [[ox, oy, oz], [ix, iy, iz]] = [*wo, *wi];
        let dual = dual::DualScattering {
            coefficients: (*from).coefficients,
        };
        let (wo, wi) = (Vec3x::new(ox, oy, oz), Vec3x::new(ix, iy, iz));
        let shaded = dual.shade(wo, wi, *single, &from_header(&*crossed), *gain);
        ptr::write(value, shaded);
    }
}
