//! Gather points of their own: preparing one, and a few samples of it.

use super::cells::{Contender, EIGHT, EIGHT_AT_ONE, ONE, TEXTBOOK, scalar, with_levels};
use super::check::Truth;
use super::inputs::{Inputs, arrays, packets, pairs, xi_packets};
use super::task::{Answer, Output, several, task};
use crate::subject::Subject;
use glam::Vec3;
use hairis::textbook::Textbook;
use hairis::wide::f32x8;
use hairis::{Bsdf, Bsdf8, HairParams, Model, Sample8};

/// The first `N` samples of a packet.
struct Leading<const N: usize>(Sample8);

impl<const N: usize> Output for Leading<N> {
    fn answers(&self, out: &mut Vec<Answer>) {
        for lane in 0..N.min(8) {
            self.0.lane(lane).answers(out);
        }
    }
}

/// A gather point and `N` samples of it, all on the same hair: each lane at its own point, or a point's samples in `P`
/// packets, the last of which may have lanes to spare.
pub(super) fn shared<M, const N: usize, const P: usize>(
    subject: &Subject<M>,
    inputs: &Inputs,
) -> (Vec<Contender>, Truth)
where
    M: Model<Params = HairParams> + 'static,
{
    let hair = &inputs.hair[0];
    let (parameters, shape) = (subject.parameters::<f32>(hair), subject.shape);
    let bsdf = Bsdf::new(&subject.model, hair);
    let (rows, _) = inputs.xi.as_chunks::<N>();
    let wo = &inputs.wo[..rows.len()];
    let contenders = vec![
        scalar(
            TEXTBOOK,
            several(
                &pairs(&arrays(wo), rows),
                |i| i,
                move |(wo, xi), keep| {
                    let point = Textbook::prepare(&parameters, shape, *wo);
                    xi.iter().for_each(|xi| keep(&point.sample(*xi)));
                },
            ),
        ),
        scalar(
            ONE,
            several(
                &pairs(wo, rows),
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
        several(&pairs(&packets(wo), &by_sample), place, move |(wo, xi), keep| {
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
                &pairs(wo, &packed),
                |i| i,
                move |(wo, xi), keep| {
                    let point = bsdf.prepare(*wo);
                    xi.iter().for_each(|xi| keep(&Leading::<N>(point.sample8_at(level, xi))));
                },
            )
        });
    }
    let points = wo.iter().flat_map(|wo| core::iter::repeat_n(subject.oracle(hair, *wo), N)).collect();
    (contenders, Truth::of_samples(points, &inputs.xi))
}

/// A gather point and one sample of it, each lane on hair of its own; packed beforehand, or once a packet.
pub(super) fn mixed<M>(subject: &Subject<M>, inputs: &Inputs, pack_each: bool) -> (Vec<Contender>, Truth)
where
    M: Model<Params = HairParams> + 'static,
{
    let parameters = inputs.hair.map(|hair| subject.parameters::<f32>(&hair));
    let shape = subject.shape;
    let bsdfs = inputs.hair.map(|hair| Bsdf::new(&subject.model, &hair));
    let numbered: Vec<(usize, Vec3)> = inputs.wo.iter().enumerate().map(|(i, wo)| (i % 8, *wo)).collect();
    let arrays: Vec<(usize, [f32; 3])> = numbered.iter().map(|(i, wo)| (*i, wo.to_array())).collect();
    let contenders = vec![
        scalar(
            TEXTBOOK,
            task(&pairs(&arrays, &inputs.xi), move |((hair, wo), xi)| {
                Textbook::prepare(&parameters[*hair], shape, *wo).sample(*xi)
            }),
        ),
        scalar(ONE, task(&pairs(&numbered, &inputs.xi), move |((hair, wo), xi)| bsdfs[*hair].prepare(*wo).sample(*xi))),
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
    let points = numbered.iter().map(|(i, wo)| subject.oracle(&inputs.hair[*i], *wo)).collect();
    (contenders, Truth::of_samples(points, &inputs.xi))
}
