//! Tests of `figures::csv`.

use hairis_instruments::stats::Estimate;
use hairis_render::figures::csv::{Start, columns};

#[test]
fn the_names_of_the_columns_come_first() {
    let start = Start {
        scene: "env (a, b.exr)".to_owned(),
        light: "direct at shading points".to_owned(),
        hair: "glossy".to_owned(),
        sampler: "uniform",
        protocol: "equal samples",
        samples: Some(16),
    };
    let estimate = Estimate {
        value: 0.123_456_7,
        standard_error: f64::NAN,
    };
    let rows = [
        start.row("MSE", estimate, true),
        Start {
            samples: None,
            ..start
        }
        .row("slope", Estimate::exact(1234.567), false),
    ];
    let mut bytes = Vec::new();
    columns(&rows).write_csv(&mut bytes).expect("written");
    let want = "\
scene,light,hair,sampler,protocol,samples,figure,value,standard_error,below_reference
\"env (a, b.exr)\",direct at shading points,glossy,uniform,equal samples,16,MSE,0.12346,,yes
\"env (a, b.exr)\",direct at shading points,glossy,uniform,equal samples,,slope,1234.6,0.0,
";
    assert_eq!(String::from_utf8(bytes).expect("text"), want);
}
