//! Subjects, materials and shading points without their types.
//!
//! Properties take these trait objects, so that each property is compiled once. The calls below are compiled once per model.

pub(crate) mod hits;

use crate::cases::case::{ANY, Choice, Choices, Source};
use crate::subject::{Claims, Expected, ParamsOf, Subject};
use hairis::columns::{EvalColumns, LengthError, SampleColumns};
use hairis::model::{DynBsdf, DynBsdf8, Model};
use hairis::simd::Level;
use hairis::{Bsdf, Bsdf8, Hit, Hit8, Lobe, LobeMask, Material, Material8};
use proptest::prelude::*;
use std::rc::Rc;

/// [`Subject`] without the type of its model. Every subject implements it, so pass a reference to any subject.
pub trait ErasedSubject {
    /// Returns the claims of the model: see [`Subject::claims`].
    #[doc(hidden)]
    fn claims(&self) -> Claims;
    /// Returns the names of the model's lobes.
    #[doc(hidden)]
    fn lobe_names(&self) -> &'static [&'static str];
    #[doc(hidden)]
    fn set(&self, which: Which) -> Box<dyn MaterialSet + '_>;
    /// Returns the strategy that draws materials.
    #[doc(hidden)]
    fn choices(&self, which: Which) -> Choices;
    #[doc(hidden)]
    fn set_of(&self, choices: [&Choice; 8]) -> Box<dyn MaterialSet + '_>;
    #[doc(hidden)]
    fn source(&self) -> Source {
        Source::Fresh
    }
}

/// Selection of the materials of a subject.
#[derive(Clone, Copy, Debug)]
pub enum Which {
    /// Materials of [`Subject::materials`].
    Everyday,
    /// Materials of the subject, with [`Subject::extremes`]. Draws add any legal material.
    WithExtremes,
    /// Everyday materials, with [`Subject::random_materials`].
    WithRandom,
    /// Materials of [`Subject::white`].
    White,
}

impl dyn ErasedSubject + '_ {
    /// Returns the number of the model's lobes.
    pub(crate) fn lobe_count(&self) -> usize {
        self.lobe_names().len()
    }

    /// Returns the name of a lobe.
    pub(crate) fn lobe(&self, lobe: Lobe) -> &'static str {
        self.lobe_names()
            .get(lobe.index())
            .copied()
            .unwrap_or("no lobe")
    }

    /// Returns the names of the lobes of a mask.
    pub(crate) fn lobes(&self, mask: LobeMask) -> String {
        if mask == LobeMask::ALL {
            return "all lobes".to_owned();
        }
        let names: Vec<_> = self.slots().filter(|lobe| mask.contains(*lobe)).collect();
        let names: Vec<_> = names.into_iter().map(|lobe| self.lobe(lobe)).collect();
        format!("lobes [{}]", names.join(", "))
    }

    /// Returns the slots that the model names.
    pub(crate) fn slots(&self) -> impl Iterator<Item = Lobe> + use<> {
        Lobe::ALL.into_iter().take(self.lobe_count())
    }

    /// Returns a mask for each lobe alone, and one for all together.
    pub(crate) fn parts(&self) -> impl Iterator<Item = LobeMask> + use<> {
        self.slots()
            .map(|lobe| LobeMask::of(&[lobe]))
            .chain([LobeMask::ALL])
    }
}

impl<S: Subject> ErasedSubject for S {
    fn claims(&self) -> Claims {
        Subject::claims(self)
    }

    fn lobe_names(&self) -> &'static [&'static str] {
        S::Model::LOBES
    }

    fn set(&self, which: Which) -> Box<dyn MaterialSet + '_> {
        Box::new(Set::new(self, which))
    }

    fn choices(&self, which: Which) -> Choices {
        let choice = |(name, params, code): Described<S>| Choice {
            params: Rc::new(params),
            name,
            code: code.into(),
        };
        let named: Vec<_> = described(self, which).into_iter().map(choice).collect();
        let named = proptest::sample::select(named);
        match self
            .any_material()
            .filter(|_| matches!(which, Which::WithExtremes))
        {
            None => named.boxed(),
            Some(any) => {
                let any = any.prop_map(|any| Choice {
                    params: Rc::new(any.params),
                    name: ANY,
                    code: any.code.into(),
                });
                prop_oneof![named, any].boxed()
            }
        }
    }

    fn set_of(&self, choices: [&Choice; 8]) -> Box<dyn MaterialSet + '_> {
        let params = |choice: &Choice| {
            let params = choice.params.clone().downcast();
            params.unwrap_or_else(|_| panic!("{choice:?} is of another model"))
        };
        let names = choices.map(|choice| choice.name).to_vec();
        let params = choices.map(params).to_vec();
        Box::new(Set::with(self, names, params))
    }
}

/// Materials of one model, which are accessed by index.
pub trait MaterialSet {
    fn len(&self) -> usize;
    fn name(&self, index: usize) -> &'static str;
    fn prepare(&self, index: usize, hit: Hit) -> Box<dyn ErasedBsdf>;
    fn prepare8(&self, index: usize, level: Level, hits: &Hit8) -> Box<dyn ErasedBsdf8>;
    fn prepare_packed(&self, index: [usize; 8], level: Level, hits: &Hit8) -> Box<dyn ErasedBsdf8>;
    fn edges(&self, index: usize, hit: &Hit) -> [Vec<f64>; 2];
    fn weight_bound(&self, index: usize, hit: &Hit, lobes: LobeMask) -> Option<f64>;
    fn reference(&self, index: usize, hit: &Hit) -> Option<Expected>;
}

impl dyn MaterialSet + '_ {
    pub(crate) fn iter(&self) -> impl Iterator<Item = NamedMaterial<'_>> {
        (0..self.len()).map(|index| self.get(index))
    }

    pub(crate) fn get(&self, index: usize) -> NamedMaterial<'_> {
        NamedMaterial { set: self, index }
    }
}

/// Material of a set, with its index.
#[derive(Clone, Copy)]
pub(crate) struct NamedMaterial<'a> {
    set: &'a dyn MaterialSet,
    index: usize,
}

impl NamedMaterial<'_> {
    pub(crate) const fn index(&self) -> usize {
        self.index
    }

    pub(crate) fn name(&self) -> &'static str {
        self.set.name(self.index)
    }

    pub(crate) fn prepare(&self, hit: Hit) -> Box<dyn ErasedBsdf> {
        self.set.prepare(self.index, hit)
    }

    pub(crate) fn prepare8(&self, level: Level, hits: Hit8) -> Box<dyn ErasedBsdf8> {
        self.set.prepare8(self.index, level, &hits)
    }

    /// Prepares eight hits on eight materials of one set.
    pub(crate) fn prepare_packed(
        materials: [Self; 8],
        level: Level,
        hits: Hit8,
    ) -> Box<dyn ErasedBsdf8> {
        materials[0]
            .set
            .prepare_packed(materials.map(|material| material.index), level, &hits)
    }

    pub(crate) fn edges(&self, hit: &Hit) -> [Vec<f64>; 2] {
        self.set.edges(self.index, hit)
    }

    pub(crate) fn weight_bound(&self, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        self.set.weight_bound(self.index, hit, lobes)
    }

    pub(crate) fn reference(&self, hit: &Hit) -> Option<Expected> {
        self.set.reference(self.index, hit)
    }
}

/// Materials of one model, with the types of the model.
pub(crate) struct Set<'s, S: Subject> {
    subject: &'s S,
    names: Vec<&'static str>,
    params: Vec<Rc<ParamsOf<S>>>,
    pub(crate) materials: Vec<Material<S::Model>>,
}

/// Name and parameters of a material, with the code of the parameters.
type Described<S> = (&'static str, ParamsOf<S>, String);

/// Returns the materials that a subject names.
fn described<S: Subject>(subject: &S, which: Which) -> Vec<Described<S>> {
    let list = |function: &str, materials: Vec<(&'static str, ParamsOf<S>)>| {
        let each = materials.into_iter().enumerate();
        let each = each.map(|(index, (name, params))| {
            let code = format!("subject.{function}().swap_remove({index}).1");
            (name, params, code)
        });
        each.collect::<Vec<_>>()
    };
    let everyday = || list("materials", subject.materials());
    let more = match which {
        Which::White => return list("white", subject.white()),
        Which::Everyday => Vec::new(),
        Which::WithExtremes => list("extremes", subject.extremes()),
        Which::WithRandom => {
            let random = subject.random_materials().into_iter().enumerate();
            let random = random.map(|(index, params)| {
                let code = format!("subject.random_materials().swap_remove({index})");
                ("a random material", params, code)
            });
            random.collect()
        }
    };
    everyday().into_iter().chain(more).collect()
}

impl<'s, S: Subject> Set<'s, S> {
    pub(crate) fn new(subject: &'s S, which: Which) -> Self {
        let named = described(subject, which).into_iter();
        let (names, params) = named
            .map(|(name, params, _)| (name, Rc::new(params)))
            .unzip();
        Self::with(subject, names, params)
    }

    fn with(subject: &'s S, names: Vec<&'static str>, params: Vec<Rc<ParamsOf<S>>>) -> Self {
        let material = |params: &Rc<_>| subject.material(params);
        let materials = params.iter().map(material).collect();
        Self {
            subject,
            names,
            params,
            materials,
        }
    }
}

impl<S: Subject> MaterialSet for Set<'_, S> {
    fn len(&self) -> usize {
        self.names.len()
    }

    fn name(&self, index: usize) -> &'static str {
        self.names[index]
    }

    fn prepare(&self, index: usize, hit: Hit) -> Box<dyn ErasedBsdf> {
        Box::new(self.materials[index].prepare(hit))
    }

    fn prepare8(&self, index: usize, level: Level, hits: &Hit8) -> Box<dyn ErasedBsdf8> {
        Box::new(self.materials[index].with_level(level).prepare8(hits))
    }

    fn prepare_packed(&self, index: [usize; 8], level: Level, hits: &Hit8) -> Box<dyn ErasedBsdf8> {
        Box::new(
            Material8::pack(index.map(|i| &self.materials[i]))
                .with_level(level)
                .prepare8(hits),
        )
    }

    fn edges(&self, index: usize, hit: &Hit) -> [Vec<f64>; 2] {
        self.subject.edges(&self.params[index], hit)
    }

    fn weight_bound(&self, index: usize, hit: &Hit, lobes: LobeMask) -> Option<f64> {
        self.subject.weight_bound(&self.params[index], hit, lobes)
    }

    fn reference(&self, index: usize, hit: &Hit) -> Option<Expected> {
        self.subject.reference(&self.params[index], hit)
    }
}

/// Number of columns of a sample: direction, value, density, weight, slot.
pub(crate) const COLUMNS: usize = 11;

/// Places of the columns that a path tracer needs among those of a sample.
pub(crate) const WEIGHT_COLUMNS: [usize; 7] = [0, 1, 2, 6, 7, 8, 9];

/// Outcome of a call on columns: an error if their lengths differ.
type ColumnResult = Result<(), LengthError>;

/// [`Bsdf`] of any model.
pub trait ErasedBsdf: DynBsdf {
    fn boxed(&self) -> Box<dyn ErasedBsdf>;
}

impl<M: Model + 'static> ErasedBsdf for Bsdf<M> {
    fn boxed(&self) -> Box<dyn ErasedBsdf> {
        Box::new(*self)
    }
}

/// [`Bsdf8`] of any model.
pub trait ErasedBsdf8: DynBsdf8 {
    fn boxed(&self) -> Box<dyn ErasedBsdf8>;
    fn lane(&self, lane: usize) -> Box<dyn ErasedBsdf>;
}

impl<M: Model + 'static> ErasedBsdf8 for Bsdf8<M> {
    fn boxed(&self) -> Box<dyn ErasedBsdf8> {
        Box::new(*self)
    }

    fn lane(&self, lane: usize) -> Box<dyn ErasedBsdf> {
        Box::new(self.lane(lane))
    }
}

macro_rules! with {
    ($($object:ident)*) => { $(
        impl dyn $object + '_ {
            pub(crate) fn with_level(&self, level: Level) -> Box<dyn $object> {
                let mut other = self.boxed();
                other.set_level(level);
                other
            }

            pub(crate) fn with_lobes(&self, lobes: LobeMask) -> Box<dyn $object> {
                let mut other = self.boxed();
                other.set_lobes(lobes);
                other
            }

            pub(crate) fn conserving(&self) -> Box<dyn $object> {
                let mut other = self.boxed();
                other.set_conserving();
                other
            }
        }
    )* };
}
with! { ErasedBsdf ErasedBsdf8 }

/// Calls on columns, which are passed as arrays.
impl dyn ErasedBsdf + '_ {
    pub(crate) fn eval_array(&self, wi: [&[f32]; 3], out: [&mut [f32]; 4]) -> ColumnResult {
        let [r, g, b, pdf] = out;
        let (value, pdf) = (Some([r, g, b]), Some(pdf));
        self.eval_columns(wi, EvalColumns { value, pdf })
    }

    pub(crate) fn value_array(&self, wi: [&[f32]; 3], value: [&mut [f32]; 3]) -> ColumnResult {
        let (value, pdf) = (Some(value), None);
        self.eval_columns(wi, EvalColumns { value, pdf })
    }

    pub(crate) fn pdf_array(&self, wi: [&[f32]; 3], pdf: &mut [f32]) -> ColumnResult {
        let (value, pdf) = (None, Some(pdf));
        self.eval_columns(wi, EvalColumns { value, pdf })
    }

    pub(crate) fn sample_array(&self, xi: [&[f32]; 3], out: [&mut [f32]; COLUMNS]) -> ColumnResult {
        let [u, v, w, r, g, b, pdf, wr, wg, wb, slot] = out;
        let out = SampleColumns {
            wi: Some([u, v, w]),
            value: Some([r, g, b]),
            pdf: Some(pdf),
            weight: Some([wr, wg, wb]),
            slot: Some(slot),
        };
        self.sample_columns(xi, out)
    }

    pub(crate) fn weight_array(
        &self,
        xi: [&[f32]; 3],
        out: [&mut [f32]; WEIGHT_COLUMNS.len()],
    ) -> ColumnResult {
        let [u, v, w, pdf, wr, wg, wb] = out;
        let out = SampleColumns {
            wi: Some([u, v, w]),
            pdf: Some(pdf),
            weight: Some([wr, wg, wb]),
            ..SampleColumns::default()
        };
        self.sample_columns(xi, out)
    }
}
