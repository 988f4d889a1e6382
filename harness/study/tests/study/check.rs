//! Checks of a finished study.

use hairis_harness::variance::Measured;
use hairis_instruments::light::Sky;
use hairis_instruments::shard::Shard;
use hairis_study::study::output::Study;
use hairis_study::study::{Plan, Size};

#[test]
fn weights_above_their_bound_and_means_apart_are_found() {
    let sky = Sky::default().environment();
    let plan = Plan {
        seed: 1,
        size: Size::Quick,
        lights: (&sky).into(),
        materials: &[],
    };
    let study = Study::of_figures(plan.header(Shard::WHOLE), &|_, _| 0.2);
    let mut cells = study.cells[..2].to_vec();
    let found = |cells: &[Vec<Measured>]| {
        let mut other = study.clone();
        other.cells = cells.to_vec();
        other.failures()
    };
    assert_eq!(found(&cells), [""; 0]);
    cells[0][0].max_weight = 1e3;
    cells[1][5].figures.mean.value = 3.3;
    let said = found(&cells);
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(
        said[0].starts_with(
            "cell 0, gaussian uniform, constant: a weight of 1000 is above its bound 20.7"
        ),
        "{said:?}"
    );
    assert!(
        said[1]
            .starts_with("cell 1, gaussian published, constant: its mean is 7.07 standard errors"),
        "{said:?}"
    );
    cells[1][5].figures.mean.value = f64::NAN;
    assert_eq!(found(&cells).len(), 2, "no number is no agreement");
    cells[1][9].bias = Some(-9.0);
    let said = found(&cells);
    let words = "cell 1, gaussian published, clear sky: the mean of rays from candidates is 9.00 standard errors from";
    assert!(said.len() == 3 && said[2].starts_with(words), "{said:?}");
}
