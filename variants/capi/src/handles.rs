//! Handles as the host stores them: a head with the model's tag, and the Rust handle behind it. Every material has the constants that
//! conserve energy; in a raw one they change nothing. Two types would double the code.

use crate::layout::{BSDF_SIZE, HEAD_SIZE, MATERIAL_SIZE, RawBsdf, RawMaterial};
use crate::models::tagged;
use core::mem::MaybeUninit;
use hairis::{Bsdf, Conserving, Material};
use hairis_variants::{ModelId, Registered};

/// The sizes of the header hold the handles of `M`: used where handles are written, for every model.
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

/// The model of a material; `None` if it is empty.
#[inline(always)]
pub(crate) unsafe fn model_of(material: *const RawMaterial) -> Option<ModelId> {
    // SAFETY: the caller's promise.
    tagged(unsafe { (&raw const (*material).head).cast::<u32>().read() })
}

/// The model of a BSDF; `None` if it is empty.
#[inline(always)]
pub(crate) unsafe fn model_at(bsdf: *const RawBsdf) -> Option<ModelId> {
    // SAFETY: the caller's promise.
    tagged(unsafe { (&raw const (*bsdf).head).cast::<u32>().read() })
}

/// The material of a handle whose tag is that of `M`.
#[inline(always)]
pub(crate) unsafe fn material<'a, M: Registered>(
    raw: *const RawMaterial,
) -> &'a Material<Conserving<M>> {
    // SAFETY: `hairis_material_init` wrote it, which `assert_fits`.
    unsafe { &*(&raw const (*raw).body).cast() }
}

/// The BSDF of a handle whose tag is that of `M`.
#[inline(always)]
pub(crate) unsafe fn bsdf<'a, M: Registered>(raw: *const RawBsdf) -> &'a Bsdf<Conserving<M>> {
    // SAFETY: `hairis_prepare` wrote it, which `assert_fits`.
    unsafe { &*(&raw const (*raw).body).cast() }
}

/// The place of a BSDF of `M`, which the caller writes.
#[inline(always)]
pub(crate) unsafe fn place<'a, M: Registered>(
    raw: *mut RawBsdf,
) -> &'a mut MaybeUninit<Bsdf<Conserving<M>>> {
    assert_fits::<M>();
    // SAFETY: the host's memory, large enough and aligned.
    unsafe { &mut *(&raw mut (*raw).body).cast() }
}
