//! Cases for tests, and the results that the models return for them.

use core::cell::RefCell;
use core::fmt;
use hairis::model::{Model, SampleLanes, Single};
use hairis::simd::{Level, Vec3x, f32x8};
use hairis::{Eval, Gaussian, Hit, Material, Material8, Published};
use hairis_conformance::cases;
use hairis_shaders::{Call, Function, Target, numbers, parameters};
use hairis_variants::chiang::ScatteringChiang;
use hairis_variants::{
    Chiang, Field, Kind, ModelId, Parameters, Registered, Values, Visitor, WithDiffuse,
};

/// Generator of random numbers, `SplitMix64`.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Draws a number in [0, 1).
    #[expect(clippy::cast_precision_loss, reason = "24 bits fit a float")]
    pub(crate) fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / 16_777_216.0
    }

    pub(crate) fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    pub(crate) fn choose<T: Copy>(&mut self, of: &[T]) -> T {
        of[usize::try_from(self.next() % of.len() as u64).expect("an index")]
    }

    fn one_in(&mut self, n: u64) -> bool {
        self.next().is_multiple_of(n)
    }

    pub(crate) fn sphere(&mut self) -> [f32; 3] {
        let (u, phi) = (self.range(-1.0, 1.0), self.range(-3.2, 3.2));
        let cos = (1.0 - u * u).max(0.0).sqrt();
        [u, cos * phi.cos(), cos * phi.sin()]
    }

    /// Draws a direction: at random, along an axis, grazing, of any length, or not a direction at all.
    fn direction(&mut self) -> [f32; 3] {
        let mut wi = self.sphere();
        match self.next() % 32 {
            0 => wi = [self.choose(&[-1.0, 1.0]), 0.0, 0.0],
            1 => wi = [0.0, self.choose(&[-1.0, 1.0]), 0.0],
            2 | 3 => {
                let angle = self.range(-16.0, -1.0).exp2();
                wi = [self.choose(&[-1.0, 1.0]), angle * wi[1], angle * wi[2]];
            }
            4 => wi = wi.map(|x| x * 1e20),
            5 => wi = wi.map(|x| x * 1e-20),
            6 => {
                let numbers = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -0.0];
                wi[self.choose(&[0, 1, 2])] = self.choose(&numbers);
            }
            7 => wi = [0.0; 3],
            _ => {}
        }
        wi
    }

    fn offset(&mut self) -> f32 {
        if self.one_in(4) {
            self.choose(&[0.0, -1.0, 1.0, 2.0, -3.0, f32::NAN, 0.999_999_9])
        } else {
            self.range(-1.0, 1.0)
        }
    }

    fn uniform(&mut self) -> [f32; 3] {
        let mut xi = [self.unit(), self.unit(), self.unit()];
        if self.one_in(4) {
            let ends = [0.0, 0.999_999_94, 1.0, f32::NAN, f32::INFINITY, -1.0, 1e-9];
            xi[self.choose(&[0, 1, 2])] = self.choose(&ends);
        }
        xi
    }

    /// Draws parameters of a material, one in four with narrow lobes.
    pub(crate) fn material<P: Parameters>(&mut self) -> P {
        loop {
            let mut values: Values = P::default().values();
            let is_narrow = self.one_in(4);
            for field in P::FIELDS {
                // A tilt by another name is no number of its own, and leaves the draws of other fields as they are.
                if field.instead_of == Some("tilt") || field.instead_of.is_some() && self.one_in(2)
                {
                    continue;
                }
                match (field.kind, field.draw) {
                    (Kind::Word(words), _) => {
                        let word = self.choose(words);
                        values = values.with_word(field.name, word);
                    }
                    (kind, Some(draw)) => {
                        let number = || {
                            let number = if draw.log {
                                self.range(draw.least.ln(), draw.most.ln()).exp()
                            } else {
                                self.range(draw.least, draw.most)
                            };
                            number * draw.unit
                        };
                        let mut numbers: Vec<f32> =
                            core::iter::repeat_with(number).take(kind.width()).collect();
                        if is_narrow && let Some(narrow) = field.narrow {
                            numbers.fill(narrow);
                        }
                        values = values.with(field.name, &numbers);
                    }
                    // Fields that are left out as a rule: in half of the materials they have more than their default, or less if
                    // that is the most. They leave the draws of other fields as they are.
                    (_, None) if field.optional && Random(!self.0).one_in(2) => {
                        let mut own =
                            Random(!self.0 ^ field.name.bytes().map(u64::from).sum::<u64>());
                        let most = field.range().map_or(f32::MAX, |[_, most]| most);
                        let vary = |x: &f32| {
                            let [low, high] = if *x < most { [1.02, 1.96] } else { [0.5, 0.98] };
                            x * own.range(low, high)
                        };
                        let numbers: Vec<f32> =
                            values.numbers(field.name).iter().map(vary).collect();
                        values = values.with(field.name, &numbers);
                    }
                    _ => {}
                }
            }
            if let Ok(params) = P::from_values(&values) {
                return params;
            }
        }
    }
}

/// Arguments of every call, with the material that they are for.
pub(crate) struct Case<M: Model> {
    handle: Material<M>,
    pub(crate) values: Values,
    pub(crate) material: M::Material<f32>,
    pub(crate) wo: [f32; 3],
    pub(crate) h: f32,
    pub(crate) wi: [f32; 3],
    pub(crate) xi: [f32; 3],
}

impl<M: Model> fmt::Display for Case<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { wo, h, wi, xi, .. } = self;
        write!(f, "wo {wo:?}, h {h}, wi {wi:?}, xi {xi:?}")
    }
}

fn vector<L: Copy>([x, y, z]: [L; 3]) -> Vec3x<L> {
    Vec3x::new(x, y, z)
}

fn eval<L: Copy>(eval: &Eval<L>) -> Vec<L> {
    let [r, g, b] = eval.value;
    vec![r, g, b, eval.pdf]
}

fn sample<L: Copy>(s: &SampleLanes<L>) -> Vec<L> {
    let ([r, g, b], [wr, wg, wb]) = (s.value, s.weight);
    vec![s.wi.x, s.wi.y, s.wi.z, r, g, b, s.pdf, wr, wg, wb, s.slot]
}

impl<M: Registered> Case<M> {
    /// Draws cases with everything that a host may pass, eight to a material.
    pub(crate) fn many(count: usize, seed: u64) -> Vec<Self> {
        let mut random = Random(seed);
        let mut params = M::Params::PRESETS[0].1;
        let mut cases = Vec::with_capacity(count);
        for i in 0..count {
            if i > 0 && i % 8 == 0 {
                params = random.material();
            }
            cases.push(Self {
                handle: Material::new(&M::MODEL, &params),
                values: params.values(),
                material: M::MODEL.material(&params),
                wo: random.direction(),
                h: random.offset(),
                wi: random.direction(),
                xi: random.uniform(),
            });
        }
        cases
    }

    /// Draws cases away from the edges, each with a material of its own.
    pub(crate) fn smooth(count: usize, seed: u64) -> Vec<Self> {
        let mut random = Random(seed);
        let mut cases = Self::many(count, seed);
        for case in &mut cases {
            let params: M::Params = random.material();
            case.values = params.values();
            case.material = M::MODEL.material(&params);
            case.wo = random.sphere();
            case.h = random.range(-0.95, 0.95);
            case.wi = random.sphere();
        }
        cases
    }

    /// Draws cases of the presets as most hits are: unit directions, and random numbers above 0. In every third a colour is black.
    pub(crate) fn everyday(count: usize, seed: u64) -> Vec<Self> {
        let mut random = Random(seed);
        let mut cases = Self::many(count, seed);
        let is_color = |field: &&Field| field.kind == Kind::Rgb;
        let mut colors = M::Params::FIELDS.iter().filter(is_color).cycle();
        let presets = M::Params::PRESETS.iter().cycle();
        for ((case, (_, params)), k) in cases.iter_mut().zip(presets).zip(0..) {
            let black = if k % 3 == 0 { colors.next() } else { None };
            let values = params.values();
            case.values = black.map_or(values, |field| values.with(field.name, &[0.0; 3]));
            let params = M::Params::from_values(&case.values).expect("black is in range");
            case.material = M::MODEL.material(&params);
            case.wo = random.sphere();
            case.h = random.range(-1.0, 1.0);
            case.wi = random.sphere();
            case.xi = [(); 3].map(|()| random.unit().max(1e-7));
        }
        cases
    }

    /// Computes the shading point in one lane.
    pub(crate) fn prepared(&self) -> M::Prepared<f32> {
        M::prepare::<f32, f32>(&self.material, Hit::new(vector(self.wo), self.h))
    }

    /// Returns the arguments of a call as the numbers that its function takes.
    pub(crate) fn arguments(&self, call: Call) -> Vec<f32> {
        let mut all = match call {
            Call::Material => {
                return parameters(&M::Params::from_values(&self.values).expect("legal values"));
            }
            Call::Eval | Call::Sample | Call::Lobes => numbers(&self.prepared()),
            _ => {
                let mut all = numbers(&self.material);
                all.extend(self.wo);
                all.push(self.h);
                all
            }
        };
        if !matches!(call, Call::Prepare | Call::Sample | Call::SampleHit) {
            all.extend(self.wi);
        }
        if matches!(call, Call::Sample | Call::SampleHit | Call::EvalSampleHit) {
            all.extend(self.xi);
        }
        all
    }

    /// Computes the results of a call in one lane.
    pub(crate) fn results(&self, call: Call) -> Vec<f32> {
        let prepared = self.prepared();
        let at = || eval(&M::eval::<f32, f32>(&prepared, vector(self.wi)));
        let drawn = || sample(&M::sample::<f32, f32>(&prepared, self.xi));
        match call {
            Call::Material => numbers(&M::constants::<Single<f32>>(&self.values)),
            Call::Prepare => numbers(&prepared),
            Call::Eval | Call::EvalHit => at(),
            Call::Sample | Call::SampleHit => drawn(),
            Call::EvalSampleHit => [at(), drawn()].concat(),
            Call::Lobes => {
                let lobes = M::lobes::<f32, f32>(&prepared, vector(self.wi)).0;
                let lobes = &lobes[..M::LOBES.len()];
                let mut all: Vec<f32> = lobes.iter().map(|lobe| lobe.value).collect();
                all.extend(lobes.iter().flat_map(|lobe| lobe.color));
                all.extend(lobes.iter().map(|lobe| lobe.pdf));
                all
            }
        }
    }

    /// Computes the results of [`Call::EvalSampleHit`] for eight cases on a level.
    pub(crate) fn results8(cases: &[Self; 8], level: Level) -> [Vec<f32>; 8] {
        let lanes = |of: &dyn Fn(&Self) -> f32| f32x8::new(cases.each_ref().map(of));
        let lanes3 = |of: fn(&Self) -> [f32; 3]| [0, 1, 2].map(|i| lanes(&|case| of(case)[i]));
        let materials = Material8::pack(cases.each_ref().map(|case| &case.handle));
        let hit = Hit::new(vector(lanes3(|case| case.wo)), lanes(&|case| case.h));
        let bsdf = materials.with_level(level).prepare8(hit);
        let mut all = eval(&bsdf.eval_pdf8(&vector(lanes3(|case| case.wi))));
        all.extend(sample(&bsdf.sample8(&lanes3(|case| case.xi))));
        core::array::from_fn(|lane| all.iter().map(|x| x.to_array()[lane]).collect())
    }
}

/// Returns a level that fuses, if this CPU has one.
pub(crate) fn fusing_level() -> Option<Level> {
    Level::available().find(|level| level.fuses())
}

/// Returns true if both have the same bits, or both are NaN.
pub(crate) fn same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// Counts the results that differ in a bit, and prints the first.
pub(crate) fn differing(function: &Function, got: &[f32], expected: &[Vec<f32>]) -> usize {
    let len = function.output().len();
    assert_eq!(
        got.len(),
        expected.len() * len,
        "{}: count of results",
        function.name()
    );
    let is_other = |(got, expected): &(&[f32], &Vec<f32>)| {
        let places = function.output().places();
        let mut numbers = got.iter().zip(*expected).zip(places);
        numbers.any(|((a, b), place)| {
            let is_other = !same(*a, *b);
            if is_other {
                println!("{}: {place} is {a}, not {b}", function.name());
            }
            is_other
        })
    };
    let mut pairs = got.chunks(len).zip(expected);
    // Only the first is printed.
    match pairs.by_ref().find(is_other) {
        Some(_) => {
            let count = pairs
                .filter(|(got, expected)| !got.iter().zip(*expected).all(|(a, b)| same(*a, *b)))
                .count();
            count + 1
        }
        None => 0,
    }
}

/// Returns the number, with 0 made positive.
pub(crate) fn unsigned(x: f32) -> f32 {
    if x == 0.0 { 0.0 } else { x }
}

/// Functions with cases that differ, collected so that one run names all of them.
#[derive(Default)]
pub(crate) struct Tally(RefCell<Vec<String>>);

impl Tally {
    /// Compares results with the expected ones, and notes the function if any differ.
    pub(crate) fn count(
        &self,
        function: &Function,
        got: &[f32],
        expected: &[Vec<f32>],
        name: &str,
    ) {
        let (count, all) = (differing(function, got, expected), expected.len());
        let line = format!("{name}: {count} of {all} differ");
        println!("{line}");
        if count > 0 {
            self.0.borrow_mut().push(line);
        }
    }

    /// Fails the test if any results differed.
    ///
    /// # Panics
    ///
    /// Panics with the names of all functions whose results differed.
    pub(crate) fn check(self) {
        let lines = self.0.into_inner();
        assert!(lines.is_empty(), "{}", lines.join("\n"));
    }
}

/// Runs a test on each model of the list.
pub(crate) fn visit_every_model<V: Visitor + Copy>(visitor: V) {
    for id in ModelId::ALL {
        id.visit(visitor);
    }
    visit_rarer_models(visitor, true);
}

/// Runs a test on models that are on the longer list of `every-sampler` alone: hair with a diffuse part, and fibres too if `all`.
pub(crate) fn visit_rarer_models<V: Visitor + Copy>(visitor: V, all: bool) {
    if ModelId::find("chiang-diffuse", None).is_some() {
        return;
    }
    visitor.visit::<WithDiffuse<Published<Gaussian>>>();
    if all {
        visitor.visit::<WithDiffuse<Chiang>>();
        visitor.visit::<ScatteringChiang>();
    }
}

/// Returns true with more cases than those of CI: slow tests then have every model and every arithmetic.
pub(crate) fn is_long() -> bool {
    cases(2) > 2
}

/// Returns the kinds of arithmetic that a slow test has: all where it is long, and the first `count` elsewhere.
pub(crate) fn some_targets<const N: usize>(
    all: [Target; N],
    count: usize,
) -> impl Iterator<Item = Target> {
    all.into_iter().take(if is_long() { N } else { count })
}

/// Runs a slow test on models with the code of all: both bells, both samplers, each fibre once, and hair with a diffuse part.
pub(crate) fn visit_code_of_models<V: Visitor + Copy>(visitor: V) {
    let is_twin = |id: &ModelId| {
        let word = id.choice().map(|(_, word)| word);
        matches!(
            (id.name(), word),
            ("gaussian", Some("published")) | ("cauchy", Some("matched"))
        )
    };
    for id in ModelId::ALL.iter().filter(|id| is_long() || !is_twin(id)) {
        id.visit(visitor);
    }
    visit_rarer_models(visitor, is_long());
}

/// Runs a function that is generic over a model for each model of the list, or for those of another function.
macro_rules! every_model {
    ($check:ident) => {
        $crate::support::every_model!($check, visit_every_model)
    };
    ($check:ident, $visit:ident) => {{
        #[derive(Clone, Copy)]
        struct Each;
        impl hairis_variants::Visitor for Each {
            type Output = ();
            fn visit<M: hairis_variants::Registered>(self) {
                $check::<M>();
            }
        }
        $crate::support::$visit(Each);
    }};
}
pub(crate) use every_model;
