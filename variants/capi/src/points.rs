//! Calls on one hit and on one direction: they take numbers and return structs by value.

use crate::handles::{bsdf, material, model_of, place};
use crate::layout::{EvalResult, LOBES, LobeResult, RawBsdf, RawMaterial, SampleResult};
use crate::models::{tag, visit};
use glam::Vec3;
use hairis::{FiberFrame, Hit, Lobe, LobeMask, PerLobe};
use hairis_variants::ModelId;

/// Implements `hairis_frame`: computes the fibre's frame from a tangent and an optional normal.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_frame(
    tangent: *const [f32; 3],
    normal: *const [f32; 3],
    to: *mut [[f32; 3]; 3],
) {
    // SAFETY: the caller's promise.
    let (tangent, normal) = unsafe { (Vec3::from(tangent.read()), normal.as_ref()) };
    let frame = match normal {
        None => FiberFrame::from_tangent(tangent),
        Some(normal) => FiberFrame::from_tangent_normal(tangent, Vec3::from(*normal)),
    };
    let rows = [frame.u, frame.v, frame.w].map(|row| row.to_array());
    // SAFETY: the caller's promise.
    unsafe { to.write(rows) };
}

/// Implements `hairis_offset`: returns the offset of a hit across the fibre.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_offset(
    frame: *const [[f32; 3]; 3],
    normal: *const [f32; 3],
    wo: *const [f32; 3],
) -> f32 {
    // SAFETY: the caller's promise.
    let (frame, normal, wo) = unsafe { (frame.read(), normal.read(), wo.read()) };
    let [u, v, w] = frame.map(Vec3::from);
    FiberFrame { u, v, w }.offset(Vec3::from(normal), Vec3::from(wo))
}

/// Implements `hairis_prepare`: prepares the BSDF of a material at a hit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_prepare(
    to: *mut RawBsdf,
    from: *const RawMaterial,
    u: f32,
    v: f32,
    w: f32,
    h: f32,
) {
    if !to.is_aligned() {
        return;
    }
    // SAFETY: the caller's promise.
    let id = unsafe { model_of(from) };
    let head = [id.map_or(0, tag), 0, 0, 0];
    // SAFETY: the caller's promise.
    unsafe { (&raw mut (*to).head).write(head) };
    let Some(id) = id else { return };
    visit!(id, M, (to: *mut RawBsdf, from: *const RawMaterial, u: f32, v: f32, w: f32, h: f32) -> (), {
        // SAFETY: the tag is the model's; the caller's promise.
        let (material, to) = unsafe { (material::<M>(from), place::<M>(to)) };
        material.prepare_into(Hit::new(Vec3::new(u, v, w), h), to);
    });
}

/// Implements `hairis_restrict`: keeps only some lobes of a BSDF.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_restrict(raw: *mut RawBsdf, lobes: u32) {
    // SAFETY: the caller's promise.
    let Some(id) = (unsafe { model_of(raw) }) else {
        return;
    };
    let (mut kept, mut count) = ([Lobe::R; Lobe::COUNT], 0);
    for lobe in Lobe::ALL {
        if lobes >> lobe.index() & 1 == 1 {
            kept[count] = lobe;
            count += 1;
        }
    }
    let mask = LobeMask::of(&kept[..count]);
    visit!(id, M, (raw: *mut RawBsdf, mask: LobeMask) -> (), {
        // SAFETY: the tag is the model's.
        let restricted = unsafe { bsdf::<M>(raw) }.with_lobes(mask);
        // SAFETY: the caller's promise.
        unsafe { place::<M>(raw) }.write(restricted);
    });
}

/// Implements `hairis_albedo`: computes the directional albedo of each lobe.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_albedo(raw: *const RawBsdf, to: *mut [[f32; 3]; LOBES]) {
    // SAFETY: the caller's promise.
    let id = unsafe { model_of(raw) };
    let albedo = id.map(|id| {
        visit!(id, M, (raw: *const RawBsdf) -> PerLobe<[f32; 3]>, {
            // SAFETY: the tag is the model's.
            unsafe { bsdf::<M>(raw) }.albedo()
        })
    });
    // SAFETY: the caller's promise.
    unsafe { to.write(albedo.unwrap_or_default().0) };
}

/// Implements `hairis_eval_pdf`: evaluates value and density at one direction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_eval_pdf(
    raw: *const RawBsdf,
    u: f32,
    v: f32,
    w: f32,
) -> EvalResult {
    // SAFETY: the caller's promise.
    let id: Option<ModelId> = unsafe { model_of(raw) };
    let result = id.map(|id| {
        visit!(id, M, (raw: *const RawBsdf, u: f32, v: f32, w: f32) -> EvalResult, {
            // SAFETY: the tag is the model's.
            let eval = unsafe { bsdf::<M>(raw) }.eval_pdf(Vec3::new(u, v, w));
            EvalResult { value: eval.value, pdf: eval.pdf }
        })
    });
    result.unwrap_or_default()
}

/// Implements `hairis_lobes`: evaluates each lobe at one direction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_lobes(
    raw: *const RawBsdf,
    u: f32,
    v: f32,
    w: f32,
    to: *mut [LobeResult; LOBES],
) {
    // SAFETY: the caller's promise.
    let id = unsafe { model_of(raw) };
    let lobes = id.map(|id| {
        visit!(id, M, (raw: *const RawBsdf, u: f32, v: f32, w: f32) -> [LobeResult; LOBES], {
            // SAFETY: the tag is the model's.
            let PerLobe(lobes) = unsafe { bsdf::<M>(raw) }.lobes(Vec3::new(u, v, w));
            lobes.map(|lobe| LobeResult { value: lobe.value, color: lobe.color, pdf: lobe.pdf })
        })
    });
    // SAFETY: the caller's promise.
    unsafe { to.write(lobes.unwrap_or_default()) };
}

/// Implements `hairis_sample`: draws one sample.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairis_sample(
    raw: *const RawBsdf,
    xi_lobe: f32,
    xi_theta: f32,
    xi_phi: f32,
) -> SampleResult {
    const DISCARDED: SampleResult = SampleResult {
        wi: [0.0; 3],
        pdf: 0.0,
        value: [0.0; 3],
        weight: [0.0; 3],
        lobe: -1,
    };
    // SAFETY: the caller's promise.
    let id = unsafe { model_of(raw) };
    let result = id.map(|id| {
        visit!(id, M, (raw: *const RawBsdf, xi_lobe: f32, xi_theta: f32, xi_phi: f32) -> SampleResult, {
            // SAFETY: the tag is the model's.
            let sample = unsafe { bsdf::<M>(raw) }.sample([xi_lobe, xi_theta, xi_phi]);
            sample.map_or(DISCARDED, |sample| SampleResult {
                wi: sample.wi.to_array(),
                pdf: sample.pdf,
                value: sample.value,
                weight: sample.weight,
                lobe: sample.lobe.index().try_into().unwrap_or(-1),
            })
        })
    });
    result.unwrap_or(DISCARDED)
}
