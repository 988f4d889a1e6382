//! Tests of `fit::variables`.

use hairis_render::fit::Variables;
use hairis_variants::ModelId;

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

#[test]
fn numbers_that_belong_together_have_one_factor() {
    let start = ModelId::Gaussian.measured();
    let variables = Variables::new(&start, &[], &[]);
    assert_eq!(variables.len(), 5, "shifts, widths and three channels");
    let x = [0.5_f64.ln(), 2.0_f64.ln(), 0.0, 0.0, 3.0_f64.ln()];
    let values = variables.values(&x);
    for (field, factors) in [
        ("alpha", &[0.5; 3][..]),
        ("beta", &[2.0; 3]),
        ("gamma_tt", &[2.0]),
        ("i_r", &[1.0; 3]),
        ("i_tt", &[1.0, 1.0, 3.0]),
        ("i_trt", &[1.0, 1.0, 9.0]),
        ("i_g", &[1.0]),
    ] {
        let pairs = values.numbers(field).iter().zip(start.numbers(field));
        for ((found, start), factor) in pairs.zip(factors) {
            assert!(
                (found / start / factor - 1.0).abs() < 1e-6,
                "{field}: {found} of {start}"
            );
        }
    }
    let free = Variables::new(
        &start,
        &names(&["beta", "gamma_g"]),
        &names(&["alpha", "i_g"]),
    );
    let expected = ["alpha.R", "alpha.TT", "alpha.TRT", "gamma_tt"];
    assert_eq!(free.names()[..4], expected);
    assert_eq!(free.len(), 3 + 1 + 3 + 1);
}

#[test]
fn variables_keep_numbers_in_their_ranges() {
    for id in ModelId::defaults_of_names() {
        let fields: Vec<&str> = id.fields().iter().map(|field| field.name).collect();
        for (_, start) in id.presets() {
            for free in [Vec::new(), names(&fields)] {
                let variables = Variables::new(&start, &[], &free);
                for far in [-1e9, 1e9] {
                    let mut x = vec![0.0; variables.len()];
                    for _ in 0..200 {
                        x = variables.after(&x, &vec![far; x.len()]);
                    }
                    assert!(id.material(&variables.values(&x)).is_ok(), "{far}");
                    assert!(
                        variables
                            .numbers(&x)
                            .iter()
                            .all(|number| number.is_finite())
                    );
                }
                let same = variables.values(&vec![0.0; variables.len()]);
                let numbers = variables.numbers(&vec![0.0; variables.len()]);
                assert_eq!(numbers.len(), variables.names().len());
                if free.is_empty() {
                    for field in id.fields() {
                        assert_eq!(same.numbers(field.name), start.numbers(field.name));
                    }
                }
            }
        }
    }
}
