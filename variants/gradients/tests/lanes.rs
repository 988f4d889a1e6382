//! Tests of lanes against the interpreter of graphs, bit by bit.

use crate::support::{Hits, Random, call};
use hairis::simd::Level;
use hairis_conformance::cases;
use hairis_gradients::AnyGradients;
use hairis_shaders::{Call, Function, Program, Rounding, Target, numbers};
use hairis_variants::{ModelId, Parameters, Registered, Visitor};

/// Hits per material: more than a block of sums, and not a multiple of eight.
const HITS: usize = 523;

fn hits(random: &mut Random) -> Hits {
    let mut hits = Hits::default();
    for _ in 0..HITS {
        let (wo, wi) = (random.edge(), random.edge());
        let h = match random.bits() % 4 {
            0 => random.choose(&[-1.0, 1.0, 0.0, 2.0, -3.0]),
            _ => random.range(-1.0, 1.0),
        };
        let weights = [(); 4].map(|()| random.range(-1.0, 1.0));
        hits.push(wo, h, wi, weights);
    }
    hits
}

fn same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

struct Bits(ModelId);

impl Visitor for Bits {
    type Output = ();

    fn visit<M: Registered>(self) {
        for level in Level::available() {
            let (target, gradient): (_, fn(&Function) -> Function) = if level.fuses() {
                (Target::Fused, Function::fused_gradient)
            } else {
                (Target::Exact, Function::gradient)
            };
            let eval = Program::of::<M>(target).function(Call::EvalHit).clone();
            let value = eval.only(&["value"]).expect("a field");
            let functions = [gradient(&eval), gradient(&value)];
            let mut random = Random(71);
            // Every third has narrow lobes.
            for material in 0..3 * cases(2) {
                let values = random.values(self.0, material % 3 == 2);
                let params = M::Params::from_values(&values).expect("legal values");
                let material = numbers(&M::MODEL.material(&params));
                let hits = hits(&mut random);
                let gradients = AnyGradients::new(self.0, &values).expect("legal values");
                for (function, has_pdf) in functions.iter().zip([true, false]) {
                    check(
                        self.0, level, function, &material, &hits, &gradients, has_pdf,
                    );
                }
            }
        }
    }
}

fn check(
    model: ModelId,
    level: Level,
    function: &Function,
    material: &[f32],
    hits: &Hits,
    gradients: &AnyGradients,
    has_pdf: bool,
) {
    let found = call(gradients, hits, level, has_pdf);
    let (results, count) = (if has_pdf { 4 } else { 3 }, material.len());
    // Sums as they are documented: eight lanes, in single precision over 512 hits.
    let (mut lanes, mut sums) = (vec![[0.0_f32; 8]; count], vec![0.0_f64; count]);
    for (hit, row) in found.rows.iter().enumerate() {
        let mut inputs = material.to_vec();
        inputs.extend(&hits.numbers(hit)[..7 + results]);
        let mut expected = function.run(&inputs, Rounding::Once);
        if !has_pdf {
            expected.insert(3, 0.0);
        }
        assert_eq!(row.len(), expected.len(), "rows of {model:?}");
        for (place, (got, want)) in row.iter().zip(&expected).enumerate() {
            assert!(
                same(*got, *want),
                "{model:?} on {level}, hit {hit}, row {place}: {got:e} where the graph has {want:e}"
            );
        }
        for (lanes, derivative) in lanes.iter_mut().zip(&expected[4..]) {
            lanes[hit % 8] += derivative;
        }
        if hit % 512 == 511 || hit + 1 == found.rows.len() {
            for (sum, lanes) in sums.iter_mut().zip(&mut lanes) {
                for lane in lanes {
                    *sum += f64::from(core::mem::take(lane));
                }
            }
        }
    }
    assert_eq!(found.sums, sums, "sums of {model:?} on {level}");
    assert!(
        found.sums.iter().any(|sum| *sum != 0.0),
        "{model:?} has derivatives"
    );
}

#[test]
fn lanes_have_the_bits_of_the_graph() {
    for id in ModelId::ALL {
        id.visit(Bits(*id));
    }
}
