//! Entry points of the models, as they are measured by the benches and by the program `entry`.

mod hits;
mod models;
pub(crate) mod name;
mod resample;

pub use models::{MODELS, is_compiled};
pub use name::{Name, Op};

use crate::check::{Asked, Given, check};
use crate::inputs::{DIRECTIONS, Inputs, arrays, materials, packets, params, xi_packets};
use crate::task::{Answer, Each, PROBE, Point, Slices, Task};
use core::hint::black_box;
use core::marker::PhantomData;
use glam::Vec3;
use hairis::columns::{EvalColumns, SampleColumns};
use hairis::simd::Level;
use hairis::{Bsdf, Bsdf8, Material, Material8};
use hairis_reference::{Formulas, Reference};
use hairis_variants::{ModelId, Parameters};

/// Measurement that is applied to the selected entry points.
pub trait Visitor {
    /// Returns true if an entry point is to be measured at all.
    fn wants(&self, name: &Name) -> bool;
    /// Measures an entry point.
    fn visit<T: Task>(&mut self, name: &Name, task: T);
}

/// Name of the scalar baseline, the paper's formulas in `f32`.
pub const REFERENCE: &str = "reference";
/// Number of directions in a short slice: less than a packet.
const SHORT: usize = 5;

/// Returns the short name of a level, which is the same on every machine and in every build.
#[must_use]
pub fn label(level: Level) -> &'static str {
    if level == Level::portable() {
        "portable"
    } else {
        level.name()
    }
}

/// Passes the entry points of an operation to `visitor`, for all [`MODELS`] that are compiled. The reference comes first. The answers
/// of an entry point are checked before `visitor` measures it.
///
/// # Panics
///
/// Panics if an entry point that the visitor selects returns wrong answers.
pub fn visit(op: Op, visitor: &mut impl Visitor) {
    let inputs = &Inputs::draw();
    for (name, id) in MODELS.iter() {
        let model = OfModel {
            op,
            name,
            inputs,
            visitor,
        };
        hairis_reference::visit(*id, model);
    }
}

/// Visitor that passes on the entry points of one operation of a model.
struct OfModel<'a, V> {
    op: Op,
    name: &'static str,
    inputs: &'a Inputs,
    visitor: &'a mut V,
}

impl<V: Visitor> hairis_reference::Visitor for OfModel<'_, V> {
    type Output = ();

    fn visit<M: Formulas>(self) {
        if const { !is_compiled(ModelId::of::<M>()) } {
            return;
        }
        let Self {
            op,
            name,
            inputs,
            visitor,
        } = self;
        Of::<M> {
            op,
            id: ModelId::of::<M>(),
            name,
            inputs,
            model: PhantomData,
        }
        .visit(visitor);
    }
}

/// Entry points of one operation of one model.
struct Of<'a, M> {
    op: Op,
    id: ModelId,
    name: &'static str,
    inputs: &'a Inputs,
    model: PhantomData<M>,
}

impl<M: Formulas> Of<'_, M> {
    fn visit(&self, visitor: &mut impl Visitor) {
        match self.op {
            Op::Prepare => self.prepare(visitor),
            Op::Eval => self.eval(visitor),
            Op::Sample => self.sample(visitor),
            Op::Path(samples) => self.path(visitor, samples),
            Op::Resample => self.resample(visitor),
            Op::Hits => self.hits(visitor),
        }
    }

    /// Passes on one entry point if it is selected and its answers are correct. All samplers share the published sampler's baseline.
    fn show<T: Task>(
        &self,
        visitor: &mut impl Visitor,
        entry: &'static str,
        level: &'static str,
        asked: impl Fn(usize) -> Asked,
        task: impl FnOnce() -> T,
    ) {
        let name = Name {
            op: self.op,
            entry,
            model: self.name,
            level,
        };
        let baseline_of_its_own = entry == REFERENCE && !self.id.is_default();
        if !baseline_of_its_own && visitor.wants(&name) {
            let mut task = task();
            check(&name, &mut task, self.id, asked);
            visitor.visit(&name, task);
        }
    }

    /// Returns the formulas for the default parameters, seen from `wo`.
    fn reference(wo: [f32; 3]) -> M::Point<f32> {
        M::point(&M::formulas(&M::Params::PRESETS[0].1), wo, 0.0)
    }

    fn material(&self) -> Material<M> {
        Material::new(&M::MODEL, &M::Params::PRESETS[0].1)
    }

    fn mixed(&self) -> Material8<M> {
        Material8::pack(materials::<M>().each_ref())
    }

    /// Returns the shading point that all evaluations and samples share.
    fn bsdf(&self) -> Bsdf<M> {
        self.material().prepare(self.inputs.wo[0])
    }

    /// Returns eight shading points on eight heads of hair.
    fn bsdf8(&self, level: Level) -> Bsdf8<M> {
        self.mixed()
            .with_level(level)
            .prepare8(&packets(&self.inputs.wo[..8])[0])
    }

    /// Returns the query at the shading point of [`bsdf`](Self::bsdf).
    fn at_one(&self, given: Given) -> Asked {
        Asked {
            values: M::Params::PRESETS[0].1.values(),
            wo: self.inputs.wo[0],
            given,
        }
    }

    /// Returns the query at lane `i % 8` of [`bsdf8`](Self::bsdf8).
    fn at_lane(&self, i: usize, given: Given) -> Asked {
        Asked {
            values: params::<M>()[i % 8].values(),
            wo: self.inputs.wo[i % 8],
            given,
        }
    }

    /// Returns the query at the `i`th shading point on one material.
    fn shared(&self, i: usize, given: Given) -> Asked {
        Asked {
            values: M::Params::PRESETS[0].1.values(),
            wo: self.inputs.wo[i],
            given,
        }
    }

    /// Returns the query at the `i`th shading point, on the material of lane `i % 8`.
    fn mixed_hair(&self, i: usize, given: Given) -> Asked {
        Asked {
            values: params::<M>()[i % 8].values(),
            wo: self.inputs.wo[i],
            given,
        }
    }

    fn prepare(&self, visitor: &mut impl Visitor) {
        let inputs = self.inputs;
        let shared = |i| self.shared(i, Given::Wi(PROBE));
        let mixed = |i| self.mixed_hair(i, Given::Wi(PROBE));
        self.show(visitor, REFERENCE, "scalar", shared, || {
            let formulas = M::formulas::<f32>(&M::Params::PRESETS[0].1);
            Each::new(1, arrays(&inputs.wo), move |wo| {
                Point(M::point(&formulas, *wo, 0.0), PhantomData)
            })
        });
        self.show(visitor, "prepare", "scalar", shared, || {
            let material = self.material();
            Each::new(1, inputs.wo.clone(), move |wo| material.prepare(*wo))
        });
        for level in Level::available() {
            self.show(visitor, "prepare8-shared", label(level), shared, || {
                let material = self.material().with_level(level);
                Each::new(8, packets(&inputs.wo), move |wo| material.prepare8(wo))
            });
            self.show(visitor, "prepare8-mixed", label(level), mixed, || {
                let material = self.mixed().with_level(level);
                Each::new(8, packets(&inputs.wo), move |wo| material.prepare8(wo))
            });
        }
    }

    fn eval(&self, visitor: &mut impl Visitor) {
        let inputs = self.inputs;
        let one = |i| self.at_one(Given::Wi(inputs.wi[i]));
        let lane = |i| self.at_lane(i, Given::Wi(inputs.wi[i]));
        self.show(visitor, REFERENCE, "scalar", one, || {
            let reference = Self::reference(inputs.wo[0].to_array());
            Each::new(1, arrays(&inputs.wi), move |wi| reference.eval_pdf(*wi))
        });
        self.show(visitor, "eval_pdf", "scalar", one, || {
            let bsdf = self.bsdf();
            Each::new(1, inputs.wi.clone(), move |wi| bsdf.eval_pdf(*wi))
        });
        for level in Level::available() {
            self.show(visitor, "eval_pdf8", label(level), one, || {
                let bsdf = self.bsdf().with_level(level);
                Each::new(8, packets(&inputs.wi), move |wi| bsdf.eval_pdf8(wi))
            });
            self.show(visitor, "eval_pdf8-points", label(level), lane, || {
                let bsdf = self.bsdf8(level);
                Each::new(8, packets(&inputs.wi), move |wi| bsdf.eval_pdf8(wi))
            });
            for (entry, len) in [("eval_columns", DIRECTIONS), ("eval_columns-short", SHORT)] {
                self.show(visitor, entry, label(level), one, || {
                    let bsdf = self.bsdf().with_level(level);
                    Slices::new(
                        len,
                        &arrays(&inputs.wi),
                        move |wi, [r, g, b, pdf]: [&mut [f32]; 4]| {
                            let (value, pdf) = (Some([r, g, b]), Some(pdf));
                            bsdf.eval_columns(wi, EvalColumns { value, pdf })
                        },
                    )
                });
            }
            self.show(visitor, "eval_columns-value", label(level), one, || {
                let bsdf = self.bsdf().with_level(level);
                Slices::new(
                    DIRECTIONS,
                    &arrays(&inputs.wi),
                    move |wi, value: [&mut [f32]; 3]| {
                        let (value, pdf) = (Some(value), None);
                        bsdf.eval_columns(wi, EvalColumns { value, pdf })
                    },
                )
            });
            self.show(visitor, "eval_columns-pdf", label(level), one, || {
                let bsdf = self.bsdf().with_level(level);
                Slices::new(
                    DIRECTIONS,
                    &arrays(&inputs.wi),
                    move |wi, [pdf]: [&mut [f32]; 1]| {
                        let (value, pdf) = (None, Some(pdf));
                        bsdf.eval_columns(wi, EvalColumns { value, pdf })
                    },
                )
            });
        }
    }

    fn sample(&self, visitor: &mut impl Visitor) {
        let inputs = self.inputs;
        let one = |i| self.at_one(Given::Xi(inputs.xi[i]));
        let lane = |i| self.at_lane(i, Given::Xi(inputs.xi[i]));
        self.show(visitor, REFERENCE, "scalar", one, || {
            let reference = Self::reference(inputs.wo[0].to_array());
            Each::new(1, inputs.xi.clone(), move |xi| reference.sample(*xi))
        });
        self.show(visitor, "sample", "scalar", one, || {
            let bsdf = self.bsdf();
            Each::new(1, inputs.xi.clone(), move |xi| bsdf.sample(*xi))
        });
        for level in Level::available() {
            self.show(visitor, "sample8", label(level), one, || {
                let bsdf = self.bsdf().with_level(level);
                Each::new(8, xi_packets(&inputs.xi), move |xi| bsdf.sample8(xi))
            });
            self.show(visitor, "sample8-points", label(level), lane, || {
                let bsdf = self.bsdf8(level);
                Each::new(8, xi_packets(&inputs.xi), move |xi| bsdf.sample8(xi))
            });
            self.show(visitor, "sample_columns-weight", label(level), one, || {
                let bsdf = self.bsdf().with_level(level);
                Slices::new(
                    DIRECTIONS,
                    &inputs.xi,
                    move |xi, [u, v, w, pdf, r, g, b]: [&mut [f32]; 7]| {
                        let out = SampleColumns {
                            wi: Some([u, v, w]),
                            pdf: Some(pdf),
                            weight: Some([r, g, b]),
                            ..SampleColumns::default()
                        };
                        bsdf.sample_columns(xi, out)
                    },
                )
                .read_by(|[u, v, w, pdf, ..]| Answer {
                    // No direction where the sample is discarded.
                    wi: Some(if pdf > 0.0 {
                        Vec3::new(u, v, w)
                    } else {
                        Vec3::ZERO
                    }),
                    value: None,
                    pdf: Some(pdf),
                })
            });
            for (entry, len) in [
                ("sample_columns", DIRECTIONS),
                ("sample_columns-short", SHORT),
            ] {
                self.show(visitor, entry, label(level), one, || {
                    let bsdf = self.bsdf().with_level(level);
                    Slices::new(
                        len,
                        &inputs.xi,
                        move |xi, [r, g, b, pdf, u, v, w, weight_r, weight_g, weight_b, slot]: [&mut [f32]; 11]| {
                            let weight = [weight_r, weight_g, weight_b];
                            let out = SampleColumns { wi: Some([u, v, w]), value: Some([r, g, b]), pdf: Some(pdf), weight: Some(weight), slot: Some(slot) };
                            bsdf.sample_columns(xi, out)
                        },
                    )
                });
            }
        }
    }

    /// Passes on the entry points that prepare a shading point and draw `samples` samples. The answers of the last call are checked.
    fn path(&self, visitor: &mut impl Visitor, samples: usize) {
        let inputs = self.inputs;
        // Every path uses the first numbers that were drawn, whatever its shading point.
        let (xi, eights) = (&inputs.xi[..samples], xi_packets(&inputs.xi));
        let packets_at_one = samples.div_ceil(8);
        let scalar = |i| self.shared(i, Given::Xi(xi[samples - 1]));
        let one = |i| {
            self.shared(
                i / 8,
                Given::Xi(inputs.xi[8 * (packets_at_one - 1) + i % 8]),
            )
        };
        let eight = |i| self.mixed_hair(i, Given::Xi(inputs.xi[8 * (samples - 1) + i % 8]));
        self.show(visitor, REFERENCE, "scalar", scalar, || {
            let (formulas, xi) = (M::formulas::<f32>(&M::Params::PRESETS[0].1), xi.to_vec());
            Each::new(samples, arrays(&inputs.wo), move |wo| {
                let reference = M::point(&formulas, *wo, 0.0);
                last(&xi, |xi| reference.sample(*xi))
            })
        });
        self.show(visitor, "prepare-sample", "scalar", scalar, || {
            let (material, xi) = (self.material(), xi.to_vec());
            Each::new(samples, inputs.wo.clone(), move |wo| {
                let bsdf = material.prepare(*wo);
                last(&xi, |xi| bsdf.sample(*xi))
            })
        });
        for level in Level::available() {
            // Eight directions at one shading point; in the last packet only the requested lanes count.
            self.show(visitor, "prepare-sample8", label(level), one, || {
                let material = self.material().with_level(level);
                let xi = eights[..packets_at_one].to_vec();
                Each::new(samples, inputs.wo.clone(), move |wo| {
                    let bsdf = material.prepare(*wo);
                    last(&xi, |xi| bsdf.sample8(xi))
                })
            });
            // Eight shading points on eight heads of hair.
            self.show(visitor, "prepare8-sample8", label(level), eight, || {
                let (material, xi) = (self.mixed().with_level(level), eights[..samples].to_vec());
                Each::new(8 * samples, packets(&inputs.wo), move |wo| {
                    let bsdf = material.prepare8(wo);
                    last(&xi, |xi| bsdf.sample8(xi))
                })
            });
        }
    }
}

/// Returns the result of the last call; the results of earlier calls are written to memory and dropped.
#[inline(always)]
fn last<X, O>(inputs: &[X], call: impl Fn(&X) -> O) -> O {
    let [before @ .., input] = inputs else {
        unreachable!("there is at least one sample")
    };
    for input in before {
        black_box(&call(black_box(input)));
    }
    call(black_box(input))
}
