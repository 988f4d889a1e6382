//! Tests of derivatives against central differences of the same function in double precision, without the error of the values.

use crate::support::{Hits, Random, call, quantiles};
use hairis::simd::Level;
use hairis_conformance::cases;
use hairis_gradients::AnyGradients;
use hairis_shaders::{Call, Function, Program, Target, numbers, parameters};
use hairis_variants::{Kind, ModelId, Parameters, Registered, Visitor};

/// Weighted sum of the results of a function, and its size.
struct Loss<'a> {
    function: &'a Function,
    inputs: Vec<f64>,
    weights: Vec<f64>,
    size: f64,
}

impl<'a> Loss<'a> {
    fn new(function: &'a Function, inputs: Vec<f64>, weights: Vec<f64>) -> Self {
        let (results, _) = function.run_double(&inputs);
        let terms = results.iter().zip(&weights).map(|(x, w)| (x * w).abs());
        let size = terms.sum();
        Self {
            function,
            inputs,
            weights,
            size,
        }
    }

    /// Returns the derivative by the input at `place`, or `None` if a choice changes within a step.
    fn difference(&self, place: usize) -> Option<f64> {
        let step = 1e-6 * self.inputs[place].abs().max(0.03);
        let at = |by: f64| {
            let mut inputs = self.inputs.clone();
            inputs[place] += by;
            let (results, choices) = self.function.run_double(&inputs);
            let terms = results.iter().zip(&self.weights).map(|(x, w)| x * w);
            (terms.sum::<f64>(), choices)
        };
        let ((low, before), (high, after)) = (at(-step), at(step));
        (before == after).then_some((high - low) / (2.0 * step))
    }

    /// Returns the errors of the derivatives by the inputs from `first` on, relative to their size, or to a thousandth of the loss for a
    /// change of the whole argument if that is larger.
    fn errors(&self, first: usize, got: impl IntoIterator<Item = f64>) -> Vec<f64> {
        let errors = got.into_iter().zip(first..).filter_map(|(got, place)| {
            let expected = self.difference(place)?;
            let least = 1e-3 * self.size / self.inputs[place].abs().max(1e-2);
            Some((got - expected).abs() / expected.abs().max(least).max(1e-30))
        });
        errors.collect()
    }
}

fn double(numbers: &[f32]) -> Vec<f64> {
    numbers.iter().copied().map(f64::from).collect()
}

struct Precision(ModelId, Level);

impl Visitor for Precision {
    type Output = ();

    fn visit<M: Registered>(self) {
        let Self(id, level) = self;
        let target = if level.fuses() {
            Target::Fused
        } else {
            Target::Exact
        };
        let program = Program::of::<M>(target);
        // Material constants are computed from parameters in one lane on every level.
        let one_lane = Program::of::<M>(Target::Exact);
        let (eval, of_parameters) = (
            program.function(Call::EvalHit),
            one_lane.function(Call::Material),
        );
        let mut random = Random(74);
        let mut by = [Vec::new(), Vec::new(), Vec::new()];
        let mut asked = 0;
        for _ in 0..cases(40) {
            let values = random.values(id, false);
            let params = M::Params::from_values(&values).expect("legal values");
            // Functions of parameters read the fields that the parameters keep.
            let values = params.values();
            let material = numbers(&M::MODEL.material(&params));
            let gradients = AnyGradients::new(id, &values).expect("legal values");
            for _ in 0..3 {
                let hits = Hits::one(&mut random);
                let found = call(&gradients, &hits, level, true);
                let hit = hits.numbers(0);
                let (hit, weights) = hit.split_at(7);
                let inputs = [&material[..], hit].concat();
                let loss = Loss::new(eval, double(&inputs), double(weights));
                let rows = double(&found.rows[0][4..]);
                let (of_material, of_hit) = rows.split_at(material.len());
                by[0].extend(loss.errors(material.len(), of_hit.iter().copied()));
                by[1].extend(loss.errors(0, of_material.iter().copied()));
                let loss = Loss::new(
                    of_parameters,
                    double(&parameters(&params)),
                    found.sums.clone(),
                );
                let fields = id.fields().iter().enumerate();
                let fields = fields.filter(|(index, _)| values.has_at(*index));
                let mut place = 0;
                for (index, field) in fields {
                    let got = found.parameters.numbers_at(index);
                    if !matches!(field.kind, Kind::Word(_)) {
                        by[2].extend(loss.errors(place, got.iter().copied()));
                        asked += got.len();
                    }
                    place += got.len();
                }
                asked += rows.len();
            }
        }
        let smooth: usize = by.iter().map(Vec::len).sum();
        assert!(smooth > asked * 9 / 10, "{id:?}: {smooth} of {asked}");
        let [hit, material, parameters] = by.each_mut().map(|errors| quantiles(errors));
        let text = |[median, most]: [f64; 2]| format!("{median:.1e} / {most:.1e}");
        println!(
            "{id:?} on {level}: by hits {}, by numbers of the material {}, by parameters {}",
            text(hit),
            text(material),
            text(parameters)
        );
        // Widths by the cosine of `wo` make its components steep, and what is left of them across `wo` has fewer digits.
        let most = if id.name() == "chiang-scattering" {
            2e-3
        } else {
            1e-3
        };
        for found in [hit, material, parameters] {
            assert!(
                found[0] < 1e-6 && found[1] < most,
                "{id:?} on {level}: {found:?}"
            );
        }
    }
}

#[test]
fn derivatives_are_those_of_the_same_function() {
    for id in ModelId::ALL {
        for level in [Level::portable(), Level::detect()] {
            id.visit(Precision(*id, level));
        }
    }
}
