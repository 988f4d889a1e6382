//! Operations that prepare a shading point and draw a few samples at it.

use super::{
    CONSERVING_HITS, Contenders, EIGHT, EIGHT_AT_ONE, Entrants, HITS, Implementations,
    TIMED_DIRECTIONS, TimedInputs, Truth, truth,
};
use crate::inputs::{arrays, joined, packets, pairs, xi_packets};
use crate::platform::{Platform, platform};
use crate::task::{Answer, Output, Pass, Several, Slices, task};
use glam::Vec3;
use hairis::columns::{
    EvalColumns, HitColumns, HitsError, LengthError, MaterialTable, SampleColumns,
};
use hairis::model::Model;
use hairis::simd::f32x8;
use hairis::{Bsdf, Bsdf8, Conserving, Material, Material8, Sample, Sample8};
use hairis_reference::{Formulas, Reference};

/// Packet of samples of which only the first `N` are answers.
struct Leading<const N: usize>(Sample8);

impl<const N: usize> Output for Leading<N> {
    fn answers(&self, out: &mut Vec<Answer>) {
        for lane in 0..N.min(8) {
            self.0.lane(lane).answers(out);
        }
    }
}

// Calls of the kernel, which are not inlined: every operation below would hold a copy of its portable level.

#[inline(never)]
fn prepare<M: Model>(material: &Material<M>, wo: Vec3) -> Bsdf<M> {
    material.prepare(wo)
}

#[inline(never)]
fn sample<M: Model>(point: &Bsdf<M>, xi: [f32; 3]) -> Option<Sample> {
    point.sample(xi)
}

#[inline(never)]
fn sample8_at<M: Model>(point: &Bsdf<M>, xi: &[f32x8; 3]) -> Sample8 {
    point.sample8(xi)
}

#[inline(never)]
fn sample8<M: Model>(points: &Bsdf8<M>, xi: &[f32x8; 3]) -> Sample8 {
    points.sample8(xi)
}

#[inline(never)]
fn eval_hits<M: Model>(
    material: &Material<M>,
    hits: HitColumns<'_>,
    wi: [&[f32]; 3],
    out: EvalColumns<'_>,
) -> Result<(), LengthError> {
    material.eval_hits(hits, wi, out)
}

#[inline(never)]
fn sample_hits<M: Model>(
    material: &Material<M>,
    hits: HitColumns<'_>,
    xi: [&[f32]; 3],
    out: SampleColumns<'_>,
) -> Result<(), LengthError> {
    material.sample_hits(hits, xi, out)
}

fn several<I: 'static, O: Output + 'static>(
    inputs: Vec<I>,
    place: fn(usize) -> usize,
    call: impl Fn(&I, &mut dyn FnMut(&O)) + 'static,
) -> Box<dyn Pass> {
    Box::new(Several::new(inputs, place, call))
}

/// Prepares shading points on one material and draws `N` samples at each. Each lane has a shading point of its own, or the samples of
/// one shading point fill `P` packets, the last of which may have lanes to spare.
pub(super) fn shared<M: Formulas, const N: usize, const P: usize>(
    inputs: &TimedInputs<M::Params>,
) -> Entrants {
    let params = &inputs.params[0];
    let Implementations::<M> {
        material,
        libm,
        std,
    } = Implementations::new(params);
    let (rows, _) = inputs.xi.as_chunks::<N>();
    let wo = &inputs.wo[..rows.len()];
    let in_turn = |i| i;
    let (eights, _) = rows.as_chunks::<8>();
    let by_sample: Vec<[[f32x8; 3]; N]> = eights
        .iter()
        .map(|eight| core::array::from_fn(|k| xi_packets(&eight.map(|xi| xi[k]))[0]))
        .collect();
    // A packet holds the same sample of eight points, whereas the directions are in the order of the points.
    let place = |i: usize| (i / (8 * N) * 8 + i % 8) * N + i / 8 % N;
    let mut contenders = Contenders::new(
        [
            several(pairs(&arrays(wo), rows), in_turn, move |(wo, xi), keep| {
                let point = M::point(&libm, *wo, 0.0);
                xi.iter().for_each(|xi| keep(&point.sample(*xi)));
            }),
            several(pairs(&arrays(wo), rows), in_turn, move |(wo, xi), keep| {
                let point = M::point(&std, platform(*wo), Platform(0.0));
                xi.iter().for_each(|xi| keep(&point.sample(platform(*xi))));
            }),
        ],
        several(pairs(wo, rows), in_turn, move |(wo, xi), keep| {
            let point = prepare(&material, *wo);
            xi.iter().for_each(|xi| keep(&sample(&point, *xi)));
        }),
    )
    .levels(EIGHT, |level| {
        let material = material.with_level(level);
        several(
            pairs(&packets(wo), &by_sample),
            place,
            move |(wo, xi), keep| {
                let points = material.prepare8(wo);
                xi.iter().for_each(|xi| keep(&sample8(&points, xi)));
            },
        )
    });
    if N > 1 {
        let packed = |row: &[[f32; 3]; N]| -> [[f32x8; 3]; P] {
            let mut padded = row.to_vec();
            padded.resize(8 * P, [0.5; 3]);
            let packets = xi_packets(&padded);
            core::array::from_fn(|p| packets[p])
        };
        let packed: Vec<_> = rows.iter().map(packed).collect();
        contenders = contenders.levels(EIGHT_AT_ONE, |level| {
            let material = material.with_level(level);
            several(pairs(wo, &packed), in_turn, move |(wo, xi), keep| {
                let point = prepare(&material, *wo);
                xi.iter()
                    .for_each(|xi| keep(&Leading::<N>(sample8_at(&point, xi))));
            })
        });
    } else {
        let rows = joined(&arrays(wo), &inputs.xi);
        contenders = contenders.levels(HITS, |level| {
            sampled_hits(&rows, material.with_level(level))
        });
        if const { !M::CONSERVES } {
            let material = Material::new(&Conserving(M::MODEL), params);
            contenders = contenders.levels(CONSERVING_HITS, |level| {
                sampled_hits(&rows, material.with_level(level))
            });
        }
    }
    let points = truth::<M>(params, wo)?;
    Ok((contenders, Truth::of_samples(points, &inputs.xi)))
}

/// Evaluates rows of hits and directions on one material.
fn evaluated_hits<M: Model + 'static>(rows: &[[f32; 6]], material: Material<M>) -> Box<dyn Pass> {
    let call = move |[x, y, z, u, v, w]: [&[f32]; 6], [r, g, b, pdf]: [&mut [f32]; 4]| {
        let (wo, out) = (
            [x, y, z],
            EvalColumns {
                value: Some([r, g, b]),
                pdf: Some(pdf),
            },
        );
        eval_hits(&material, HitColumns { wo, h: None }, [u, v, w], out)
    };
    Box::new(Slices::new(TIMED_DIRECTIONS, rows, call))
}

/// Makes a pass whose `call` samples rows of hits and uniform numbers.
fn sample_rows(
    rows: &[[f32; 6]],
    call: impl Fn(HitColumns<'_>, [&[f32]; 3], SampleColumns<'_>) -> Result<(), LengthError> + 'static,
) -> Box<dyn Pass> {
    let call = move |[x, y, z, a, b, c]: [&[f32]; 6], out: [&mut [f32]; 11]| {
        let [red, green, blue, pdf, u, v, w, wr, wg, wb, slot] = out;
        let (wo, out) = (
            [x, y, z],
            SampleColumns {
                wi: Some([u, v, w]),
                value: Some([red, green, blue]),
                pdf: Some(pdf),
                weight: Some([wr, wg, wb]),
                slot: Some(slot),
            },
        );
        call(HitColumns { wo, h: None }, [a, b, c], out)
    };
    Box::new(Slices::new(TIMED_DIRECTIONS, rows, call))
}

/// Samples rows of hits on one material.
fn sampled_hits<M: Model + 'static>(rows: &[[f32; 6]], material: Material<M>) -> Box<dyn Pass> {
    sample_rows(rows, move |hits, xi, out| {
        sample_hits(&material, hits, xi, out)
    })
}

/// Samples rows of hits on eight materials in turn.
fn sample_table<M: Model + 'static>(
    rows: &[[f32; 6]],
    materials: [Material<M>; 8],
) -> Box<dyn Pass> {
    let index: Vec<u32> = (0..8).cycle().take(rows.len()).collect();
    sample_rows(rows, move |hits, xi, out| {
        let table = MaterialTable {
            materials: &materials,
            index: &index,
        };
        // No index is beyond the table; if one were, the check of the answers would fail.
        match table.sample_hits(hits, xi, out) {
            Err(HitsError::Length(error)) => Err(error),
            _ => Ok(()),
        }
    })
}

/// Prepares shading points on one material, and evaluates one direction at each.
pub(super) fn eval<M: Formulas>(inputs: &TimedInputs<M::Params>) -> Entrants {
    let params = &inputs.params[0];
    let Implementations::<M> {
        material,
        libm,
        std,
    } = Implementations::new(params);
    let both = pairs(&arrays(&inputs.wo), &arrays(&inputs.wi));
    let eights = pairs(&packets(&inputs.wo), &packets(&inputs.wi));
    let rows = joined(&arrays(&inputs.wo), &arrays(&inputs.wi));
    let mut contenders = Contenders::new(
        [
            task(&both, move |(wo, wi)| {
                M::point(&libm, *wo, 0.0).eval_pdf(*wi)
            }),
            task(&both, move |(wo, wi)| {
                M::point(&std, platform(*wo), Platform(0.0)).eval_pdf(platform(*wi))
            }),
        ],
        task(&pairs(&inputs.wo, &inputs.wi), move |(wo, wi)| {
            prepare(&material, *wo).eval_pdf(*wi)
        }),
    )
    .levels(EIGHT, |level| {
        let material = material.with_level(level);
        task(&eights, move |(wo, wi)| material.prepare8(wo).eval_pdf8(wi))
    })
    .levels(HITS, |level| {
        evaluated_hits(&rows, material.with_level(level))
    });
    if const { !M::CONSERVES } {
        let material = Material::new(&Conserving(M::MODEL), params);
        contenders = contenders.levels(CONSERVING_HITS, |level| {
            evaluated_hits(&rows, material.with_level(level))
        });
    }
    Ok((
        contenders,
        Truth::of_directions(truth::<M>(params, &inputs.wo)?, &inputs.wi),
    ))
}

/// Prepares shading points and draws one sample at each. Every lane has a material of its own, packed once, or before each call if
/// `pack_each`.
pub(super) fn mixed<M: Formulas>(inputs: &TimedInputs<M::Params>, pack_each: bool) -> Entrants {
    let each = inputs.params.each_ref().map(Implementations::<M>::new);
    let (libm, std) = (
        each.each_ref().map(|one| one.libm),
        each.each_ref().map(|one| one.std),
    );
    let materials = each.map(|one| one.material);
    let numbered: Vec<(usize, Vec3)> = inputs
        .wo
        .iter()
        .enumerate()
        .map(|(i, wo)| (i % 8, *wo))
        .collect();
    let numbered_arrays: Vec<(usize, [f32; 3])> =
        numbered.iter().map(|(i, wo)| (*i, wo.to_array())).collect();
    let eights = pairs(&packets(&inputs.wo), &xi_packets(&inputs.xi));
    let packed = Material8::pack(materials.each_ref());
    let rows = joined(&arrays(&inputs.wo), &inputs.xi);
    let mut contenders = Contenders::new(
        [
            task(
                &pairs(&numbered_arrays, &inputs.xi),
                move |((i, wo), xi)| M::point(&libm[*i], *wo, 0.0).sample(*xi),
            ),
            task(
                &pairs(&numbered_arrays, &inputs.xi),
                move |((i, wo), xi)| {
                    M::point(&std[*i], platform(*wo), Platform(0.0)).sample(platform(*xi))
                },
            ),
        ],
        task(&pairs(&numbered, &inputs.xi), move |((i, wo), xi)| {
            sample(&prepare(&materials[*i], *wo), *xi)
        }),
    )
    .levels(EIGHT, |level| {
        let packed = packed.with_level(level);
        if pack_each {
            let materials = materials.map(|material| material.with_level(level));
            task(&eights, move |(wo, xi)| {
                let packed = Material8::pack(materials.each_ref());
                sample8(&packed.prepare8(wo), xi)
            })
        } else {
            task(&eights, move |(wo, xi)| sample8(&packed.prepare8(wo), xi))
        }
    });
    if !pack_each {
        contenders = contenders.levels(HITS, |level| {
            sample_table(&rows, materials.map(|material| material.with_level(level)))
        });
        if const { !M::CONSERVES } {
            let materials = inputs
                .params
                .each_ref()
                .map(|params| Material::new(&Conserving(M::MODEL), params));
            contenders = contenders.levels(CONSERVING_HITS, |level| {
                sample_table(&rows, materials.map(|material| material.with_level(level)))
            });
        }
    }
    let points = numbered
        .iter()
        .map(|(i, wo)| truth::<M>(&inputs.params[*i], &[*wo]))
        .collect::<Result<Vec<_>, _>>()?;
    Ok((
        contenders,
        Truth::of_samples(points.into_iter().flatten().collect(), &inputs.xi),
    ))
}
