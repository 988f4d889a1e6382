//! Table of the functions of each model in the list, chosen by index at run time.

use crate::memory::COLUMN;
use crate::slot::Slot;
use glam::Vec3;
use hairis::simd::{LaneStruct, Path, f32x8};
use hairis::{Bsdf, Hit, Lobe, Vec3x8};
#[cfg(feature = "dual")]
use hairis::{LobeMask, dual_scattering::DualScattering};
use hairis_variants::{ModelId, Registered, Visitor};

/// Columns that a function reads its arguments from and writes its results to.
type Columns = [[f32; COLUMN]];

/// Functions of one model.
pub(crate) struct Calls {
    pub(crate) eval: fn(&Slot, &mut Columns, usize),
    pub(crate) sample: fn(&Slot, &mut Columns, usize),
    pub(crate) hits: fn(&Slot, &mut Columns, usize),
    pub(crate) albedos: fn(&Slot, &mut Columns, usize),
    pub(crate) constants: fn(&Slot, &mut [f32]) -> usize,
    #[cfg(feature = "dual")]
    pub(crate) dual: fn(&Slot, &mut [f32]) -> usize,
}

impl Calls {
    pub(crate) fn of(id: ModelId) -> Self {
        struct All;
        impl Visitor for All {
            type Output = Calls;
            fn visit<M: Registered>(self) -> Calls {
                Calls {
                    eval: eval::<M>,
                    sample: sample::<M>,
                    hits: hits::<M>,
                    albedos: albedos::<M>,
                    constants: constants::<M>,
                    #[cfg(feature = "dual")]
                    dual: dual::<M>,
                }
            }
        }
        id.visit(All)
    }
}

/// Returns the model at an index of the list, or the first model if the index is beyond the list.
pub(crate) fn model_at(index: usize) -> ModelId {
    *ModelId::ALL.get(index).unwrap_or(&ModelId::ALL[0])
}

/// Returns true if the model represents all models of its name where nothing is sampled. The code of the others is left out.
const fn is_first<M: Registered>() -> bool {
    ModelId::of::<M>().is_default()
}

/// Returns the eight numbers of a column that begin at `first`.
fn packet(column: &[f32; COLUMN], first: usize) -> f32x8 {
    let lanes = column[first..].first_chunk::<8>();
    f32x8::new(*lanes.unwrap_or(&[0.0; 8]))
}

// Calls with packets, because the functions on columns would be compiled for each set of results that callers may leave out.
fn eval<M: Registered>(slot: &Slot, columns: &mut Columns, count: usize) {
    let bsdf = slot.bsdf::<M>();
    for first in (0..count).step_by(8) {
        let [x, y, z] = [0, 1, 2].map(|axis| packet(&columns[axis], first));
        let eval = bsdf.eval_pdf8(&Vec3x8::new(x, y, z));
        let [r, g, b] = eval.value;
        for (column, lanes) in columns[3..].iter_mut().zip([r, g, b, eval.pdf]) {
            if let Some(to) = column[first..].first_chunk_mut::<8>() {
                *to = lanes.to_array();
            }
        }
    }
}

// Computes one sample or one hit at a time, because the code of packets is twice as long and the page does not wait for either.
fn sample<M: Registered>(slot: &Slot, columns: &mut Columns, count: usize) {
    let bsdf = slot.bsdf::<M>();
    for place in 0..count {
        let results = draw(&bsdf, [0, 1, 2].map(|axis| columns[axis][place]));
        for (column, number) in columns[3..].iter_mut().zip(results) {
            column[place] = number;
        }
    }
}

/// Returns direction, weight, density and slot of the lobe of a sample. Not inlined, like [`albedo`], because the module is to be small.
#[inline(never)]
fn draw<M: Registered>(bsdf: &Bsdf<M>, xi: [f32; 3]) -> [f32; 8] {
    let none = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0];
    bsdf.sample(xi).map_or(none, |sample| {
        let ([u, v, w], [r, g, b]) = (sample.wi.to_array(), sample.weight);
        let lobe = sample.lobe.index();
        [u, v, w, r, g, b, sample.pdf, lobe as f32]
    })
}

#[inline(never)]
fn albedo<M: Registered>(bsdf: &Bsdf<M>) -> [[f32; 3]; Lobe::COUNT] {
    bsdf.albedo().0
}

fn hits<M: Registered>(slot: &Slot, columns: &mut Columns, count: usize) {
    if const { !is_first::<M>() } {
        return;
    }
    let material = slot.material::<M>();
    for place in 0..count {
        let [u, v, w, h, x, y, z] = core::array::from_fn(|column| columns[column][place]);
        let hit = Hit::new(Vec3::new(u, v, w), h);
        let value = material.prepare(hit).eval(Vec3::new(x, y, z));
        for (column, number) in columns[7..].iter_mut().zip(value) {
            column[place] = number;
        }
    }
}

fn albedos<M: Registered>(slot: &Slot, columns: &mut Columns, count: usize) {
    if const { !is_first::<M>() } {
        return;
    }
    let material = slot.material::<M>();
    for place in 0..count {
        let sin = columns[0][place].clamp(-1.0, 1.0);
        let cos = libm::sqrtf((1.0 - sin) * (1.0 + sin));
        let bsdf = material.prepare(Hit::new(Vec3::new(sin, cos, 0.0), slot.hit.h));
        let albedo = &albedo(&bsdf)[..M::LOBES.len()];
        for (column, number) in columns[1..].iter_mut().zip(albedo.as_flattened()) {
            column[place] = *number;
        }
    }
}

fn constants<M: Registered>(slot: &Slot, column: &mut [f32]) -> usize {
    if const { !is_first::<M>() } {
        return 0;
    }
    let mut count = 0;
    let mut see = |_: &Path<'_>, number| {
        if let Some(place) = column.get_mut(count) {
            *place = number;
            count += 1;
        }
    };
    let constants = M::MODEL.material(&slot.params::<M>());
    constants.visit(&Path::Root, &mut see);
    count
}

#[cfg(feature = "dual")]
fn dual<M: Registered>(slot: &Slot, column: &mut [f32]) -> usize {
    if const { !is_first::<M>() } {
        return 0;
    }
    let material = slot.material::<M>();
    let dual = DualScattering::measured(M::LOBES.len(), &mut |hit, lobe, xi, out| {
        let whole = material.prepare(hit);
        // No viewer gets back more than arrives, as with `Conserving`.
        let lobes = albedo(&whole);
        let [r, g, b] = [0, 1, 2].map(|c| {
            let albedo: f32 = lobes.iter().map(|lobe| lobe[c]).sum();
            1.0 / albedo.max(1.0)
        });
        let bsdf = whole.with_lobes(LobeMask::of(&[lobe]));
        let (Some(mut wi), Some(mut weight)) = (out.wi, out.weight) else {
            return;
        };
        for place in 0..xi[0].len() {
            let [u, v, w, x, y, z, ..] = draw(&bsdf, xi.map(|column| column[place]));
            let results = [u, v, w, r * x, g * y, b * z];
            let columns = wi.iter_mut().chain(&mut weight);
            columns
                .zip(results)
                .for_each(|(column, number)| column[place] = number);
        }
    });
    let numbers = dual.coefficients.as_flattened().as_flattened();
    column[..numbers.len()].copy_from_slice(numbers);
    numbers.len()
}
