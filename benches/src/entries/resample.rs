//! Entry points of resampling: proposals, weights, pools and reservoirs.

use super::{Of, label};
use crate::check::Given;
use crate::entries::Visitor;
use crate::inputs::{DIRECTIONS, packets, xi_packets};
use crate::resample::{COUNTS, PoolTask, SKY_PDF, STREAMED, Stream, looked_up, proposed, sky8};
use crate::task::{Each, Slices};
use hairis::resample::{CandidateColumns, Partition, WeightColumns};
use hairis::simd::{Level, f32x8};
use hairis_reference::Formulas;

impl<M: Formulas> Of<'_, M> {
    pub(super) fn resample(&self, visitor: &mut impl Visitor) {
        let inputs = self.inputs;
        for level in Level::available() {
            let drawn = |i| self.at_one(Given::Xi(inputs.xi[i]));
            self.show(visitor, "propose_columns", label(level), drawn, || {
                let bsdf = self.bsdf().with_level(level);
                let call = move |xi: [&[f32]; 3], wi: [&mut [f32]; 3]| bsdf.propose_columns(xi, wi);
                Slices::new(DIRECTIONS, &inputs.xi, call).read_by(|wi| proposed(wi.into()))
            });
            let drawn_in_lane = |i| self.at_lane(i, Given::Xi(inputs.xi[i]));
            self.show(
                visitor,
                "propose8-points",
                label(level),
                drawn_in_lane,
                || {
                    let bsdf = self.bsdf8(level);
                    Each::new(8, xi_packets(&inputs.xi), move |xi| bsdf.propose8(xi))
                },
            );
            let weighed = |i| self.at_one(Given::Candidate(inputs.wi[i]));
            self.show(visitor, "weigh_columns", label(level), weighed, || {
                let bsdf = self.bsdf().with_level(level);
                Slices::new(
                    DIRECTIONS,
                    &looked_up(&inputs.wi),
                    move |[x, y, z, r, g, b, pdf_light]: [&[f32]; 7],
                          [fr, fg, fb, weight]: [&mut [f32]; 4]| {
                        let candidates = CandidateColumns {
                            wi: [x, y, z],
                            radiance: [r, g, b],
                            pdf_light,
                        };
                        let out = WeightColumns {
                            contribution: [fr, fg, fb],
                            weight,
                        };
                        bsdf.weigh_columns(candidates, COUNTS, Partition::All, out)
                    },
                )
            });
            let weighed_in_lane = |i| self.at_lane(i, Given::Candidate(inputs.wi[i]));
            self.show(
                visitor,
                "weigh8-points",
                label(level),
                weighed_in_lane,
                || {
                    let (bsdf, pdf) = (self.bsdf8(level), f32x8::splat(SKY_PDF));
                    let candidates: Vec<_> = packets(&inputs.wi)
                        .into_iter()
                        .map(|wi| (wi, sky8(&wi)))
                        .collect();
                    Each::new(8, candidates, move |(wi, radiance)| {
                        bsdf.weigh8(wi, radiance, &pdf, COUNTS, Partition::All)
                    })
                },
            );
            // Candidates of a pool: 32 of the BSDF, then 32 of the light.
            let in_pool = |i: usize| {
                let at = i / 64 * 32 + i % 32;
                self.at_one(if i % 64 < 32 {
                    Given::Proposal(inputs.xi[at])
                } else {
                    Given::Candidate(inputs.wi[at])
                })
            };
            self.show(visitor, "pool-32-32-16", label(level), in_pool, || {
                PoolTask::new(self.bsdf().with_level(level), inputs)
            });
            let kept = |i| self.at_lane(i, Given::Kept);
            self.show(visitor, "reservoir8-4-4", label(level), kept, || {
                let bsdf = self.bsdf8(level);
                Each::new(STREAMED, Stream::of(inputs), move |stream: &Stream| {
                    stream.keep(&bsdf)
                })
            });
        }
    }
}
