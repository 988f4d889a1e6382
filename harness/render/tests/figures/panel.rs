//! Tests of `figures::panel`.

use hairis_render::figures::map::Map;
use hairis_render::figures::panel::{Column, crops, panel};
use hairis_render::film::{Crop, Picture};

#[test]
fn a_panel_needs_no_other_file() {
    let picture = Picture::black([16, 16]);
    let column = |errors| Column {
        title: "<b>".to_owned(),
        remark: String::new(),
        picture: &picture,
        errors,
    };
    let columns = [
        column(vec![]),
        column(vec![vec![0.5; 256], vec![0.25; 256]]),
    ];
    let maps = [
        Map::signed("bias", 1.0, &["blue"]),
        Map::squared("noise", 1.0, &[]),
    ];
    let svg = panel(&columns, &crops(&picture, &[0.0; 256]), &maps, 1.0).expect("a drawing");
    // Picture and two crops of both, two legends, two maps.
    assert!(
        svg.contains("&lt;b&gt;") && svg.matches("data:image/png;base64,").count() == 10,
        "{svg}"
    );
    assert!(
        !svg.replace("http://www.w3.org/2000/svg", "")
            .contains("http")
    );
}

#[test]
fn crops_show_the_brightest_and_the_worst_part_apart() {
    let mut picture = Picture::black([16, 16]);
    picture.pixels[16 * 9 + 13] = [1.0; 3];
    let holds = |crop: &Crop, pixel| crop.pixels().any(|at| at == pixel);
    let mut squares = vec![0.0; 256];
    squares[16 * 2 + 3] = 1.0;
    let [brightest, worst] = crops(&picture, &squares);
    assert!(
        holds(&brightest, [13, 9]) && holds(&worst, [3, 2]),
        "{brightest:?} {worst:?}"
    );
    // The largest error lies in the brightest part: the next largest is shown.
    squares[16 * 9 + 13] = 2.0;
    let [brightest, worst] = crops(&picture, &squares);
    assert!(
        brightest.pixels().all(|pixel| !holds(&worst, pixel)),
        "{brightest:?} {worst:?}"
    );
    assert!(holds(&worst, [3, 2]), "{worst:?}");
}
