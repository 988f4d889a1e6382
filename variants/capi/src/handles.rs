//! Handles as the host stores them: a head with the model's tag, and the Rust handle behind it. Every material has the constants that
//! conserve energy, although they change nothing in a raw material, because a second type would double the code. Only calls on hits
//! leave them out. A handle whose tag is 0 is empty, and scatters nothing in any call.

use crate::layout::{
    BSDF_SIZE, ENERGY_CONSERVING, ENERGY_SCALED, HEAD_SIZE, MATERIAL_SIZE, RawBsdf, RawMaterial,
};
use crate::models::{self, tagged, visit};
use core::mem::MaybeUninit;
use hairis::{Bsdf, Conserving, Material, ParamError};
use hairis_variants::{ModelId, Parameters, Registered, Values};

/// Asserts that the sizes in the header hold the handles of `M`. Every function that writes handles calls this, for every model.
pub(crate) const fn assert_fits<M: Registered>() {
    const {
        let [material, bsdf] = [
            size_of::<Material<Conserving<M>>>(),
            size_of::<Bsdf<Conserving<M>>>(),
        ];
        assert!(
            material + HEAD_SIZE <= MATERIAL_SIZE,
            "raise HAIRIS_MATERIAL_SIZE"
        );
        assert!(bsdf + HEAD_SIZE <= BSDF_SIZE, "raise HAIRIS_BSDF_SIZE");
        let align = [
            align_of::<Material<Conserving<M>>>(),
            align_of::<Bsdf<Conserving<M>>>(),
        ];
        assert!(
            align[0] <= 16 && align[1] <= 16,
            "handles are aligned to 16"
        );
    }
}

/// Returns true if a handle lies where one can, and is empty or has the tag of a model.
#[inline(always)]
pub(crate) unsafe fn is_handle<T>(handle: *const T) -> bool {
    handle.is_aligned() && {
        // SAFETY: the caller's promise; every handle begins with its tag.
        let tag = unsafe { handle.cast::<u32>().read() };
        tag == 0 || tagged(tag).is_some()
    }
}

/// Returns the model of a material or a BSDF, or `None` if the handle is empty, or none at all.
#[inline(always)]
pub(crate) unsafe fn model_of<T>(handle: *const T) -> Option<ModelId> {
    if !handle.is_aligned() {
        return None;
    }
    // SAFETY: the caller's promise; every handle begins with its tag.
    tagged(unsafe { handle.cast::<u32>().read() })
}

/// Returns true if a material does not conserve energy.
pub(crate) unsafe fn is_raw(material: *const RawMaterial) -> bool {
    // SAFETY: the caller's promise.
    unsafe { (*material).head[1] == 1 }
}

/// Returns the material of a handle whose tag is the tag of `M`.
#[inline(always)]
pub(crate) unsafe fn material<'a, M: Registered>(
    raw: *const RawMaterial,
) -> &'a Material<Conserving<M>> {
    // SAFETY: `hairis_material_init` wrote it, which `assert_fits`.
    unsafe { &*(&raw const (*raw).body).cast() }
}

/// Returns the BSDF of a handle whose tag is the tag of `M`.
#[inline(always)]
pub(crate) unsafe fn bsdf<'a, M: Registered>(raw: *const RawBsdf) -> &'a Bsdf<Conserving<M>> {
    // SAFETY: `hairis_prepare` wrote it, which `assert_fits`.
    unsafe { &*(&raw const (*raw).body).cast() }
}

/// Returns the place of a BSDF of `M`, into which the caller writes the BSDF.
#[inline(always)]
pub(crate) unsafe fn place<'a, M: Registered>(
    raw: *mut RawBsdf,
) -> &'a mut MaybeUninit<Bsdf<Conserving<M>>> {
    assert_fits::<M>();
    // SAFETY: the host's memory, large enough and aligned.
    unsafe { &mut *(&raw mut (*raw).body).cast() }
}

/// Makes a material from values. This is the only place that reads the energy which the host asks for.
fn build<M: Registered>(
    values: &Values,
    energy: u32,
) -> Result<Material<Conserving<M>>, ParamError> {
    let params: M::Params = Parameters::from_values(values)?;
    let raw = |params| Material::<Conserving<M>>::from(Material::new(&M::MODEL, params));
    match energy {
        ENERGY_CONSERVING => Ok(Material::new(&Conserving(M::MODEL), &params)),
        ENERGY_SCALED => {
            let scale = raw(&params).conserving_scale();
            Ok(raw(&params.scaled(scale)?))
        }
        _ => Ok(raw(&params)),
    }
}

/// Writes the material of these values.
///
/// # Safety
///
/// `to` must be aligned memory for a material.
pub(crate) unsafe fn init(
    to: *mut RawMaterial,
    id: ModelId,
    values: &Values,
    energy: u32,
) -> Result<(), ParamError> {
    let values = &raw const *values;
    visit!(id, M, (to: *mut RawMaterial, values: *const Values, energy: u32) -> Result<(), ParamError>, {
        assert_fits::<M>();
        // SAFETY: the values outlive the call.
        let material = build::<M>(unsafe { &*values }, energy)?;
        // SAFETY: the caller's promise; the handle fits.
        unsafe {
            to.write_bytes(0, 1);
            let is_raw = u32::from(energy != ENERGY_CONSERVING);
            (&raw mut (*to).head).write([models::tag(ModelId::of::<M>()), is_raw, 0, 0]);
            (&raw mut (*to).body).cast::<Material<Conserving<M>>>().write(material);
        }
        Ok(())
    })
}
