//! Tests that derivatives are finite wherever hosts may evaluate.

use crate::support::{Hits, Random, call};
use hairis::simd::Level;
use hairis_gradients::AnyGradients;
use hairis_variants::ModelId;

#[test]
fn derivatives_are_finite_at_the_edges() {
    for id in ModelId::ALL {
        let mut random = Random(72);
        for material in 0..24 {
            // Half of the materials have narrow lobes, and half of these the narrowest.
            let mut values = random.values(*id, material % 2 == 1);
            if material % 4 == 3 {
                for field in id.fields().iter().filter(|field| field.narrow.is_some()) {
                    let [least, most] = field.range().expect("a field of numbers");
                    let narrow = field.narrow.expect("filtered");
                    let end = if narrow < 1.0 { least } else { most };
                    values = values.with(field.name, &vec![end; field.kind.width()]);
                }
            }
            let gradients = AnyGradients::new(*id, &values).expect("legal values");
            let mut hits = Hits::default();
            for _ in 0..203 {
                let (wo, mut wi) = (random.edge(), random.edge());
                // Half of the directions are peaks: the mirror direction, the view, and straight through.
                let [u, v, w] = wo;
                match random.bits() % 6 {
                    0 => wi = [-u, v, w],
                    1 => wi = wo,
                    2 => wi = [-u, -v, -w],
                    _ => {}
                }
                let h = random.choose(&[-1.0, 1.0, 0.0, 0.999_999_9, 0.5, 3.0, f32::NAN]);
                hits.push(wo, h, wi, [1.0; 4]);
            }
            for level in Level::available() {
                let found = call(&gradients, &hits, level, true);
                for (hit, row) in found.rows.iter().enumerate() {
                    assert!(
                        row.iter().all(|x| x.is_finite()),
                        "{id:?} on {level}, {values:?}, {:?}: {row:?}",
                        hits.numbers(hit)
                    );
                }
                for index in 0..id.fields().len() {
                    let numbers = found.parameters.numbers_at(index);
                    assert!(numbers.iter().all(|x| x.is_finite()), "{id:?}: {numbers:?}");
                }
            }
        }
    }
}

#[test]
fn directions_that_are_no_numbers_have_no_derivative() {
    for id in ModelId::ALL {
        let gradients = AnyGradients::new(*id, &id.measured()).expect("a preset");
        let mut hits = Hits::default();
        for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            hits.push([x, 0.6, 0.8], 0.3, [0.6, 0.0, 0.8], [1.0; 4]);
            hits.push([0.6, 0.0, 0.8], 0.3, [0.6, x, 0.8], [1.0; 4]);
        }
        for level in Level::available() {
            let found = call(&gradients, &hits, level, true);
            for row in &found.rows {
                assert!(row.iter().all(|x| *x == 0.0), "{id:?} on {level}: {row:?}");
            }
        }
    }
}
