//! Tests of `figures::map`.

use hairis_render::figures::map::{Map, scale};

#[test]
fn errors_have_a_sign() {
    let image = Map::signed("bias", 0.5, &[]).image(&[-0.5, 0.0, 0.5, 9.0], [4, 1]);
    assert_eq!(image.get_pixel(1, 0).0, [255; 3]);
    assert!(image.get_pixel(0, 0).0[2] > image.get_pixel(0, 0).0[0]);
    assert!(image.get_pixel(2, 0).0[0] > image.get_pixel(2, 0).0[2]);
    assert_eq!(
        image.get_pixel(2, 0),
        image.get_pixel(3, 0),
        "the end of the scale"
    );
}

#[test]
fn squares_are_told_apart_over_four_decades() {
    let map = Map::squared("noise", 2.0, &[]);
    let image = map.image(&[0.0, 2e-4, 2e-3, 2e-2, 0.2, 2.0, 9.0], [7, 1]);
    let light = |x: u32| {
        image
            .get_pixel(x, 0)
            .0
            .iter()
            .map(|byte| u32::from(*byte))
            .sum::<u32>()
    };
    assert!(
        (1..5).all(|x| light(x) < light(x + 1)),
        "lighter for larger errors"
    );
    assert_eq!(
        [light(0), light(6)],
        [light(1), light(5)],
        "the ends of the scale"
    );
    assert_eq!(map.legend(5).get_pixel(4, 0), image.get_pixel(5, 0));
    assert_eq!(
        map.ticks().map(|(_, _, text)| text),
        ["0.0002", "0.02", "2"]
    );
}

#[test]
fn scales_are_round_and_leave_out_a_few() {
    let mut values = vec![0.3; 1000];
    values.extend([-7.0, 0.0, 1e9]);
    assert_eq!(scale(values.iter()), 0.5);
    assert!(
        (scale([0.7, 0.7].iter()) - 1.0).abs() < 1e-12
            && (scale([-2e-3].iter()) - 2e-3).abs() < 1e-12
    );
    assert_eq!(scale([].iter()), 1.0);
}
