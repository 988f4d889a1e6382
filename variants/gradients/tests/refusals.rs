//! Tests that rejected calls write nothing, and name the column at fault.

use hairis::columns::HitColumns;
use hairis::{Gaussian, HairParams, Published};
use hairis_gradients::{AnyGradients, GradColumns, GradError, Gradients, Weights};

type Hair = Gradients<Published<Gaussian>>;

/// Returns a handle that is compiled in the library, and not once more in this test.
fn hair() -> AnyGradients {
    AnyGradients::Gaussian(Hair::new(&HairParams::brown()))
}

/// Returns the error of a call on three hits, whose columns have three entries except for those that `change` replaces.
fn refusal(
    change: fn(
        &mut HitColumns<'static>,
        &mut Weights<'static>,
        &mut [&'static [f32]; 3],
        &mut Lengths,
    ),
) -> Option<GradError> {
    const ROW: &[f32] = &[0.6, 0.0, 0.8];
    let mut hits = HitColumns {
        wo: [ROW; 3],
        h: None,
    };
    let (mut weights, mut wi) = (Weights::default(), [ROW; 3]);
    let mut lengths = Lengths {
        out: 3,
        sums: Hair::NUMBERS,
        columns: Hair::NUMBERS,
        of_hits: 3,
    };
    change(&mut hits, &mut weights, &mut wi, &mut lengths);
    let (mut d_h, mut sums) = (vec![7.0; lengths.out], vec![7.0; lengths.sums]);
    let mut each = vec![vec![7.0; lengths.of_hits]; lengths.columns];
    let mut each: Vec<&mut [f32]> = each.iter_mut().map(|column| &mut column[..]).collect();
    let out = GradColumns {
        d_h: Some(&mut d_h),
        d_material: Some(&mut sums),
        d_material_of_hits: Some(&mut each),
        ..GradColumns::default()
    };
    let hair = hair();
    let refused = hair.eval_grad(hits, wi, weights, out).err()?;
    let of_hits = each.iter().flat_map(|column| column.iter());
    let is_kept = d_h.iter().chain(of_hits).all(|x| *x == 7.0);
    assert!(
        is_kept && sums.iter().all(|x| *x == 7.0),
        "something was written"
    );
    Some(refused)
}

struct Lengths {
    out: usize,
    sums: usize,
    columns: usize,
    of_hits: usize,
}

#[test]
fn columns_of_other_lengths_are_refused_by_name() {
    assert_eq!(refusal(|_, _, _, _| {}), None);
    let named = |refused: Option<GradError>| refused.map(|error| error.to_string());
    for (refused, message) in [
        (
            refusal(|hits, _, _, _| hits.wo[2] = &[1.0]),
            "wo.w has 1 entries where the first slice has 3",
        ),
        (
            refusal(|hits, _, _, _| hits.h = Some(&[])),
            "h has 0 entries where the first slice has 3",
        ),
        (
            refusal(|_, _, wi, _| wi[1] = &[1.0; 4]),
            "wi.v has 4 entries where the first slice has 3",
        ),
        (
            refusal(|_, weights, _, _| weights.pdf = Some(&[])),
            "weights.pdf has 0 entries where the first slice has 3",
        ),
        (
            refusal(|_, _, _, lengths| lengths.out = 2),
            "d_h has 2 entries where the first slice has 3",
        ),
        (
            refusal(|_, _, _, lengths| lengths.of_hits = 2),
            "d_material_of_hits[..] has 2 entries where the first slice has 3",
        ),
    ] {
        assert_eq!(named(refused).as_deref(), Some(message));
    }
    let numbers = Hair::NUMBERS;
    for (refused, field) in [
        (refusal(|_, _, _, lengths| lengths.sums = 0), "d_material"),
        (
            refusal(|_, _, _, lengths| lengths.columns = 0),
            "d_material_of_hits",
        ),
    ] {
        let message =
            format!("{field} must have {numbers} entries, one per number of the material, got 0");
        assert_eq!(named(refused), Some(message));
    }
}

#[test]
fn no_hits_have_no_derivatives() {
    let hair = hair();
    let hits = HitColumns {
        wo: [&[]; 3],
        h: None,
    };
    let mut sums = [1.5; Hair::NUMBERS];
    let out = GradColumns {
        d_material: Some(&mut sums),
        ..GradColumns::default()
    };
    hair.eval_grad(hits, [&[]; 3], Weights::default(), out)
        .expect("columns of one length");
    assert_eq!(sums, [1.5; Hair::NUMBERS], "the call adds nothing");
}
