//! Table of the functions of each model in the list, chosen by index at run time.

use crate::memory::COLUMN;
use crate::slot::Slot;
use glam::Vec3;
use hairis::simd::{LaneStruct, Path, f32x8};
use hairis::{Hit, Vec3x8};
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
        let sample = bsdf.sample([0, 1, 2].map(|axis| columns[axis][place]));
        let results = sample.map_or([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0], |sample| {
            let ([u, v, w], [r, g, b]) = (sample.wi.to_array(), sample.weight);
            let lobe = sample.lobe.index();
            [u, v, w, r, g, b, sample.pdf, lobe as f32]
        });
        for (column, number) in columns[3..].iter_mut().zip(results) {
            column[place] = number;
        }
    }
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
        let albedo = bsdf.albedo();
        for (column, number) in columns[1..].iter_mut().zip(albedo.0.as_flattened()) {
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
