//! Entry points for hits on materials that conserve energy, which is how hosts are advised to make them.

use super::{Of, label};
use crate::check::{Asked, Given};
use crate::entries::Visitor;
use crate::inputs::{DIRECTIONS, arrays, joined, packets, pairs};
use crate::task::{Each, PROBE, Slices};
use hairis::columns::{EvalColumns, HitColumns, SampleColumns};
use hairis::model::Model;
use hairis::simd::Level;
use hairis::{Conserving, Material, Material8};
use hairis_reference::Formulas;
use hairis_variants::Parameters;

impl<M: Formulas> Of<'_, M> {
    pub(super) fn hits(&self, visitor: &mut impl Visitor) {
        if const { M::CONSERVES } {
            self.hits_of(visitor, &M::MODEL);
        } else {
            self.hits_of(visitor, &Conserving(M::MODEL));
        }
    }

    /// Passes on the entry points on the first preset that conserves energy by itself, so that the formulas yield the expected answers.
    /// The amount of work in a call does not depend on the parameters.
    fn hits_of<C: Model<Params = M::Params>>(&self, visitor: &mut impl Visitor, model: &C) {
        let inputs = self.inputs;
        let presets = M::Params::PRESETS;
        let dark = presets
            .iter()
            .map(|(_, params)| params)
            .find(|params| Material::new(&M::MODEL, params).max_albedo() <= 1.0)
            .unwrap_or(&presets[0].1);
        let material = Material::new(model, dark);
        let asked = |i: usize, given| Asked {
            values: dark.values(),
            wo: inputs.wo[i],
            given,
        };
        let evals = |i| asked(i, Given::Wi(inputs.wi[i]));
        let samples = |i| asked(i, Given::Xi(inputs.xi[i]));
        let prepared = |i| asked(i, Given::Wi(PROBE));
        let (wo, wi) = (arrays(&inputs.wo), arrays(&inputs.wi));
        self.show(visitor, "eval_hit", "scalar", evals, || {
            Each::new(1, pairs(&inputs.wo, &inputs.wi), move |(wo, wi)| {
                material.eval_hit(*wo, *wi)
            })
        });
        self.show(visitor, "sample_hit", "scalar", samples, || {
            Each::new(1, pairs(&inputs.wo, &inputs.xi), move |(wo, xi)| {
                material.sample_hit(*wo, *xi)
            })
        });
        for level in Level::available() {
            let material = material.with_level(level);
            self.show(visitor, "prepare8", label(level), prepared, || {
                Each::new(8, packets(&inputs.wo), move |wo| material.prepare8(wo))
            });
            self.show(visitor, "prepare8-mixed", label(level), prepared, || {
                let material = Material8::pack([&material; 8]);
                Each::new(8, packets(&inputs.wo), move |wo| material.prepare8(wo))
            });
            self.show(visitor, "eval_hits", label(level), evals, || {
                Slices::new(
                    DIRECTIONS,
                    &joined(&wo, &wi),
                    move |[x, y, z, u, v, w]: [&[f32]; 6], [r, g, b, pdf]: [&mut [f32]; 4]| {
                        let hits = HitColumns {
                            wo: [x, y, z],
                            h: None,
                        };
                        let out = EvalColumns {
                            value: Some([r, g, b]),
                            pdf: Some(pdf),
                        };
                        material.eval_hits(hits, [u, v, w], out)
                    },
                )
            });
            self.show(visitor, "sample_hits", label(level), samples, || {
                Slices::new(
                    DIRECTIONS,
                    &joined(&wo, &inputs.xi),
                    move |[x, y, z, a, b, c]: [&[f32]; 6],
                          [red, green, blue, pdf, u, v, w, wr, wg, wb, slot]: [&mut [f32]; 11]| {
                        let hits = HitColumns {
                            wo: [x, y, z],
                            h: None,
                        };
                        let out = SampleColumns {
                            wi: Some([u, v, w]),
                            value: Some([red, green, blue]),
                            pdf: Some(pdf),
                            weight: Some([wr, wg, wb]),
                            slot: Some(slot),
                        };
                        material.sample_hits(hits, [a, b, c], out)
                    },
                )
            });
        }
    }
}
