//! Shading points of their own: preparing one, and a few samples of it.

use super::cells::{Contender, EIGHT, EIGHT_AT_ONE, ONE, scalar, truth, with_levels};
use super::check::Truth;
use super::inputs::{Inputs, pairs};
use super::task;
use glam::Vec3;
use hairis::reference::Reference;
use hairis::wide::f32x8;
use hairis::{Bsdf, Bsdf8, ParamError, Sample8};
use hairis_benches::entries::TEXTBOOK;
use hairis_benches::inputs::{arrays, packets, xi_packets};
use hairis_benches::task::{Answer, Output, Pass, Several};
use hairis_variants::{ModelId, Registered};

/// The first `N` samples of a packet.
struct Leading<const N: usize>(Sample8);

impl<const N: usize> Output for Leading<N> {
    fn answers(&self, out: &mut Vec<Answer>) {
        for lane in 0..N.min(8) {
            self.0.lane(lane).answers(out);
        }
    }
}

fn several<I: 'static, O: Output + 'static>(
    inputs: Vec<I>,
    place: fn(usize) -> usize,
    call: impl Fn(&I, &mut dyn FnMut(&O)) + 'static,
) -> Box<dyn Pass> {
    Box::new(Several::new(inputs, place, call))
}

/// A shading point and `N` samples of it, all on the same hair: each lane at its own point, or a point's samples in `P`
/// packets, the last of which may have lanes to spare.
pub(super) fn shared<M: Registered, const N: usize, const P: usize>(
    id: ModelId,
    inputs: &Inputs<M::Params>,
) -> Result<(Vec<Contender>, Truth), ParamError> {
    let params = inputs.params[0];
    let (bsdf, formulas) = (Bsdf::new(&M::MODEL, &params), M::formulas::<f32>(&params));
    let (rows, _) = inputs.xi.as_chunks::<N>();
    let wo = &inputs.wo[..rows.len()];
    let contenders = vec![
        scalar(
            TEXTBOOK,
            several(
                pairs(&arrays(wo), rows),
                |i| i,
                move |(wo, xi), keep| {
                    let point = M::reference_at(&formulas, *wo, 0.0);
                    xi.iter().for_each(|xi| keep(&point.sample(*xi)));
                },
            ),
        ),
        scalar(
            ONE,
            several(
                pairs(wo, rows),
                |i| i,
                move |(wo, xi), keep| {
                    let point = bsdf.prepare(*wo);
                    xi.iter().for_each(|xi| keep(&point.sample(*xi)));
                },
            ),
        ),
    ];
    let (eights, _) = rows.as_chunks::<8>();
    let by_sample: Vec<[[f32x8; 3]; N]> =
        eights.iter().map(|eight| core::array::from_fn(|k| xi_packets(&eight.map(|xi| xi[k]))[0])).collect();
    // A packet holds the same sample of eight points; the directions are in the order of the points.
    let place = |i: usize| (i / (8 * N) * 8 + i % 8) * N + i / 8 % N;
    let mut contenders = with_levels(contenders, EIGHT, |level| {
        several(pairs(&packets(wo), &by_sample), place, move |(wo, xi), keep| {
            let points = bsdf.prepare8_at(level, wo);
            xi.iter().for_each(|xi| keep(&points.sample8_at(level, xi)));
        })
    });
    if N > 1 {
        let packed: Vec<[[f32x8; 3]; P]> = rows
            .iter()
            .map(|row| {
                let mut padded = row.to_vec();
                padded.resize(8 * P, [0.5; 3]);
                let packets = xi_packets(&padded);
                core::array::from_fn(|p| packets[p])
            })
            .collect();
        contenders = with_levels(contenders, EIGHT_AT_ONE, |level| {
            several(
                pairs(wo, &packed),
                |i| i,
                move |(wo, xi), keep| {
                    let point = bsdf.prepare(*wo);
                    xi.iter().for_each(|xi| keep(&Leading::<N>(point.sample8_at(level, xi))));
                },
            )
        });
    }
    let points = truth(id, &params, wo)?.into_iter().flat_map(|point| core::iter::repeat_n(point, N)).collect();
    Ok((contenders, Truth::of_samples(points, &inputs.xi)))
}

/// A shading point and one sample of it, each lane on hair of its own; packed beforehand, or once per packet.
pub(super) fn mixed<M: Registered>(
    id: ModelId,
    inputs: &Inputs<M::Params>,
    pack_each: bool,
) -> Result<(Vec<Contender>, Truth), ParamError> {
    let params = inputs.params;
    let bsdfs = params.map(|params| Bsdf::new(&M::MODEL, &params));
    let formulas = params.map(|params| M::formulas::<f32>(&params));
    let numbered: Vec<(usize, Vec3)> = inputs.wo.iter().enumerate().map(|(i, wo)| (i % 8, *wo)).collect();
    let arrays: Vec<(usize, [f32; 3])> = numbered.iter().map(|(i, wo)| (*i, wo.to_array())).collect();
    let contenders = vec![
        scalar(
            TEXTBOOK,
            task(&pairs(&arrays, &inputs.xi), move |((i, wo), xi)| {
                M::reference_at(&formulas[*i], *wo, 0.0).sample(*xi)
            }),
        ),
        scalar(ONE, task(&pairs(&numbered, &inputs.xi), move |((i, wo), xi)| bsdfs[*i].prepare(*wo).sample(*xi))),
    ];
    let eights = pairs(&packets(&inputs.wo), &xi_packets(&inputs.xi));
    let packed = Bsdf8::pack(bsdfs.each_ref());
    let contenders = with_levels(contenders, EIGHT, |level| {
        if pack_each {
            task(&eights, move |(wo, xi)| Bsdf8::pack(bsdfs.each_ref()).prepare8_at(level, wo).sample8_at(level, xi))
        } else {
            task(&eights, move |(wo, xi)| packed.prepare8_at(level, wo).sample8_at(level, xi))
        }
    });
    let points = numbered.iter().map(|(i, wo)| truth(id, &params[*i], &[*wo])).collect::<Result<Vec<_>, _>>()?.concat();
    Ok((contenders, Truth::of_samples(points, &inputs.xi)))
}
