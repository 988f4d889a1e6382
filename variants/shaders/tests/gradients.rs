//! Tests of gradients against differences in double precision, and at the edges.

use crate::support::{Case, Random, differing, every_model, same, visit_every_model};
use hairis_shaders::{Call, Function, Program, Rounding, Target};
use hairis_variants::{Registered, Visitor};

/// Returns the derivative of the weighted results by the input at `place`, or `None` if a choice changes within the step.
fn difference(function: &Function, inputs: &[f64], weights: &[f32], place: usize) -> Option<f64> {
    let step = 1e-6 * inputs[place].abs().max(0.03);
    let at = |by: f64| {
        let mut inputs = inputs.to_vec();
        inputs[place] += by;
        let (results, choices) = function.run_double(&inputs);
        let weighted = results.iter().zip(weights);
        (
            weighted
                .map(|(result, weight)| result * f64::from(*weight))
                .sum::<f64>(),
            choices,
        )
    };
    let ((low, before), (high, after)) = (at(-step), at(step));
    (before == after).then_some((high - low) / (2.0 * step))
}

/// Cases whose gradients are compared with differences: arguments of a function, and the weights of its results.
pub(crate) struct Weighted {
    pub(crate) function: Function,
    pub(crate) gradient: Function,
    /// Inputs away from the edges.
    pub(crate) inputs: Vec<Vec<f32>>,
    /// Inputs away from the edges, followed by everything that a host may pass.
    pub(crate) all: Vec<Vec<f32>>,
}

impl Weighted {
    pub(crate) fn new<M: Registered>(program: &Program, call: Call) -> Self {
        let function = program.function(call).clone();
        let gradient = function.gradient();
        let mut random = Random(46);
        let mut weighted = |case: Case<M>| {
            let mut inputs = case.arguments(call);
            inputs.extend(function.results().iter().map(|_| random.range(-1.0, 1.0)));
            inputs
        };
        let smooth = Case::<M>::smooth(48, 47).into_iter();
        let inputs: Vec<_> = smooth.map(&mut weighted).collect();
        let edges = Case::<M>::many(976, 49).into_iter().map(weighted);
        let all = inputs.iter().cloned().chain(edges).collect();
        Self {
            inputs,
            all,
            gradient,
            function,
        }
    }

    /// Makes the cases of a material and of a hit, and leaves only their gradients in the program.
    pub(crate) fn both<M: Registered>(program: &mut Program) -> [Self; 2] {
        let cases = [Call::Material, Call::EvalHit].map(|call| Self::new::<M>(program, call));
        program.keep(cases.each_ref().map(|cases| cases.gradient.clone()).into());
        cases
    }

    /// Compares gradients with those of the graph, bit by bit after `read`.
    pub(crate) fn check_bits(
        &self,
        got: &[f32],
        rounding: Rounding,
        read: impl Fn(f32) -> f32,
        name: &str,
    ) {
        let gradient = &self.gradient;
        let read = |results: &[f32]| -> Vec<f32> { results.iter().map(|x| read(*x)).collect() };
        let expected = self.all.iter();
        let expected: Vec<_> = expected
            .map(|inputs| read(&gradient.run(inputs, rounding)))
            .collect();
        let got = read(got);
        let count = differing(gradient, &got, &expected);
        let places: Vec<_> = gradient.output().places().collect();
        let pairs = got.iter().zip(expected.iter().flatten());
        if let Some((at, (a, b))) = pairs.enumerate().find(|(_, (a, b))| !same(**a, **b)) {
            println!("{name}: {} is {a}, not {b}", places[at % places.len()]);
        }
        assert_eq!(count, 0, "{name}: gradients that differ from the graph's");
    }

    /// Compares gradients with differences in double precision: 1e-6 in the median, 1e-3 for 99.9%.
    pub(crate) fn check(&self, gradients: &[f32], name: &str) {
        let [median, most] = self.errors(gradients, name);
        println!("{name}: {median:e}, {most:e}");
        assert!(median < 1e-6 && most < 1e-3, "{name}: {median:e}, {most:e}");
    }

    /// Returns the errors of gradients against differences in double precision: the median, and the quantile of 99.9%.
    pub(crate) fn errors(&self, gradients: &[f32], name: &str) -> [f64; 2] {
        let (count, results) = (self.function.inputs().len(), self.function.output().len());
        let gradients = gradients.chunks(self.gradient.output().len());
        assert!(gradients.len() >= self.inputs.len(), "{name}: cases");
        let mut errors = Vec::new();
        for (inputs, got) in self.inputs.iter().zip(gradients) {
            assert_eq!(got.len(), results + count, "results, and a derivative each");
            let (inputs, weights) = inputs.split_at(count);
            let exact: Vec<f64> = inputs.iter().copied().map(f64::from).collect();
            let loss: f64 = got
                .iter()
                .zip(weights)
                .map(|(x, w)| f64::from((x * w).abs()))
                .sum();
            for (place, got) in got[results..].iter().enumerate() {
                if let Some(expected) = difference(&self.function, &exact, weights, place) {
                    // Errors are relative to at least a thousandth of the loss for a change of the whole argument.
                    let least = 1e-3 * loss / exact[place].abs().max(1e-2);
                    let scale = expected.abs().max(least).max(1e-30);
                    errors.push((f64::from(*got) - expected).abs() / scale);
                }
            }
        }
        let all = self.inputs.len() * count;
        assert!(errors.len() > all / 2, "{} of {all} smooth", errors.len());
        errors.sort_by(f64::total_cmp);
        [
            errors[errors.len() / 2],
            errors[errors.len() - 1 - errors.len() / 1000],
        ]
    }
}

#[derive(Clone, Copy)]
struct Differences(Call);

impl Visitor for Differences {
    type Output = ();

    fn visit<M: Registered>(self) {
        let program = Program::of::<M>(Target::Exact);
        let cases = Weighted::new::<M>(&program, self.0);
        let gradients = cases.inputs.iter().map(|inputs| {
            let got = cases.gradient.run(inputs, Rounding::Once);
            let results = cases.function.run(inputs, Rounding::Once);
            assert_eq!(got[..results.len()], results, "the results");
            got
        });
        let name = format!("{} {}", program.name(), cases.gradient.name());
        cases.check(&gradients.collect::<Vec<_>>().concat(), &name);
    }
}

#[test]
fn gradients_of_materials_are_those_of_differences() {
    visit_every_model(Differences(Call::Material));
}

#[test]
fn gradients_are_those_of_differences() {
    visit_every_model(Differences(Call::EvalHit));
}

#[test]
fn gradients_of_a_shading_point_are_those_of_differences() {
    visit_every_model(Differences(Call::Eval));
}

fn check_finite<M: Registered>() {
    for target in [Target::Exact, Target::Fused, Target::GpuNative] {
        let program = Program::of::<M>(target);
        for call in [Call::EvalHit, Call::SampleHit] {
            let function = program.function(call);
            let gradient = function.gradient();
            let weights = vec![1.0; function.output().len()];
            for case in Case::<M>::many(512, 48) {
                let is_unit = |x: [f32; 3]| {
                    let square: f32 = x.iter().map(|x| x * x).sum();
                    (square - 1.0).abs() < 1e-3
                };
                let is_uniform = case.xi.iter().all(|xi| (0.0..1.0).contains(xi));
                if !is_unit(case.wo) || !is_unit(case.wi) || case.h.is_nan() || !is_uniform {
                    continue;
                }
                let inputs = [&case.arguments(call)[..], &weights].concat();
                let got = gradient.run(&inputs, Rounding::Once);
                let name = format!("{} {} {target:?}", program.name(), function.name());
                assert!(got.iter().all(|x| x.is_finite()), "{name}: {case}: {got:?}");
            }
        }
    }
}

#[test]
fn gradients_are_finite_at_the_edges() {
    every_model!(check_finite);
}

/// Checks that a sample has no derivative by a uniform number at an end where the derivative from within, in double precision, is infinite.
fn check_uniform<M: Registered>() {
    const STEP: f64 = 1e-9;
    let program = Program::of::<M>(Target::Exact);
    let function = program.function(Call::SampleHit);
    let gradient = function.gradient();
    let weights = vec![1.0_f32; function.output().len()];
    let first = function.inputs().len() - 3;
    let (mut random, mut infinite) = (Random(50), 0);
    for mut case in Case::<M>::smooth(160, 51) {
        for (k, end) in (0..3).flat_map(|k| [(k, 0.0), (k, 1.0 - 0.5 * f32::EPSILON)]) {
            case.xi = [(); 3].map(|()| random.range(0.1, 0.9));
            case.xi[k] = end;
            let inputs = case.arguments(Call::SampleHit);
            let exact: Vec<f64> = inputs.iter().copied().map(f64::from).collect();
            let inwards = if end == 0.0 { STEP } else { -STEP };
            let at = |steps: f64| -> f64 {
                let mut exact = exact.clone();
                exact[first + k] += inwards * steps;
                function.run_double(&exact).0.iter().sum()
            };
            let slopes = [1.0, 1.0 / 16.0, 1.0 / 256.0].map(|steps| (at(steps) - at(0.0)) / steps);
            let [a, b, c] = slopes.map(f64::abs);
            let is_rounding = c < 1e-9 * at(0.0).abs();
            if b > 2.0 * a && c > 2.0 * b && !is_rounding {
                let all = gradient.run(&[&inputs[..], &weights].concat(), Rounding::Once);
                let got = all[weights.len() + first + k];
                let name = program.name();
                assert!(got == 0.0, "{name}: {got} by xi[{k}]: {case}");
                infinite += 1;
            }
        }
    }
    println!("{}: {infinite} are infinite", program.name());
    assert!(infinite > 20, "{}", program.name());
}

#[test]
fn samples_have_no_infinite_derivatives_by_uniform_numbers() {
    every_model!(check_uniform);
}
