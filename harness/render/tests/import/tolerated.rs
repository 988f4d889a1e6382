//! Peculiarities of files in use, which are read with a remark.

use super::{STRAIGHT, hair, read, remarks, tfx, with_f32, with_u32};
use glam::Vec3;
use hairis_render::formats::{Curve, Import};
use hairis_render::geometry::Strands;
use hairis_render::tree::Tree;

/// Returns a cyHair file of strands along y, side by side, each of equal spans, with a thickness per
/// strand.
fn upright(thicknesses: &[f32], length: f32) -> Vec<u8> {
    let count = u32::try_from(thicknesses.len()).expect("a few");
    let mut file = b"HAIR".to_vec();
    for number in [count, 5 * count, 2 | 4, 4] {
        file.extend(number.to_le_bytes());
    }
    file.extend([0; 108]);
    for strand in 0..count {
        for k in 0..5_u8 {
            for number in [strand as f32, 0.25 * length * f32::from(k), 0.0] {
                file.extend(number.to_le_bytes());
            }
        }
    }
    let of_nodes = thicknesses.iter().flat_map(|thickness| [*thickness; 5]);
    file.extend(of_nodes.flat_map(f32::to_le_bytes));
    file
}

fn thickness_at(strands: usize, node: usize) -> usize {
    128 + 60 * strands + 4 * node
}

fn y(strands: &Strands) -> Vec<f32> {
    let nodes = (0..).take(strands.nodes());
    nodes.map(|node| strands.node_position(node).y).collect()
}

/// Checks one straight strand with nodes at y = 0, 4, 4.01, 8, 8.02, 8.03, 12.
#[test]
fn a_straight_strand_of_uneven_spans_has_no_loop() {
    let mut file = with_u32(with_u32(upright(&[0.02], 1.0), 8, 7), 16, 6);
    file.truncate(128);
    for y in [0.0_f32, 4.0, 4.01, 8.0, 8.02, 8.03, 12.0] {
        file.extend([0.0, y, 0.0].into_iter().flat_map(f32::to_le_bytes));
    }
    file.extend([0.02_f32; 7].into_iter().flat_map(f32::to_le_bytes));
    for curve in [Curve::Linear, Curve::Smooth, Curve::BSpline] {
        let options = Import {
            curve,
            ..Import::default()
        };
        let strands = read("a.hair", &file, &options).expect("read").strands;
        let y = y(&strands);
        assert!(y.is_sorted(), "{curve:?}: {y:?}");
        assert!((y[0], y[y.len() - 1]) == (0.0, 12.0), "{curve:?}: {y:?}");
        for (_, segment) in strands.numbers() {
            for s in [0.0, 0.5, 1.0] {
                let tangent = strands.tangent(segment, s);
                assert!(tangent.dot(Vec3::Y) > 0.999, "{curve:?}: {tangent}");
            }
        }
    }
}

#[test]
fn curves_are_what_was_asked_for() {
    let with = |curve| {
        let options = Import { curve, ..STRAIGHT };
        read("a.hair", &hair(), &options).expect("read").strands
    };
    let corner = Vec3::Y;
    let distance = |strands: &Strands| {
        let nodes = strands.nodes_of(0);
        let edges = (nodes.start..nodes.end - 1).map(|k| {
            let [from, to] = [0.0, 1.0].map(|s| strands.position(k, s));
            let s = (corner - from).dot(to - from) / from.distance_squared(to);
            from.lerp(to, s.clamp(0.0, 1.0)).distance(corner)
        });
        edges.fold(f32::INFINITY, f32::min)
    };
    let [linear, smooth, spline] = [Curve::Linear, Curve::Smooth, Curve::BSpline].map(with);
    assert_eq!(linear.nodes(), 5, "the nodes of the file");
    assert!(
        distance(&smooth) < 1e-6 && smooth.nodes() > 8,
        "through the corner"
    );
    // The middle of the quarters: a sixth of the way from the corner to the middle of its
    // neighbours, twice.
    let expected = (Vec3::ZERO + Vec3::new(1.0, 1.0, 0.0) - 2.0 * Vec3::Y).length() / 6.0;
    assert!(
        (distance(&spline) - expected).abs() < 0.02,
        "past the corner"
    );
    for strands in [&smooth, &spline] {
        let nodes = strands.nodes_of(0);
        let ends = [nodes.start, nodes.end - 1].map(|k| strands.node_position(k));
        assert!(
            ends[0].length() < 1e-6 && ends[1].distance(Vec3::new(1.0, 1.0, 0.0)) < 1e-6,
            "{ends:?}"
        );
    }
}

#[test]
fn what_lies_behind_what_is_needed_is_a_remark() {
    let plain = read("a.hair", &hair(), &STRAIGHT).expect("read").strands;
    let more = |mut file: Vec<u8>, bytes: usize| {
        file.extend(vec![7; bytes]);
        file
    };
    for (file, expected) in [
        // Texture coordinates, as LuxCore has them.
        (
            more(with_u32(hair(), 12, 35), 40),
            &["not used: texture coordinates"][..],
        ),
        (
            with_u32(hair(), 12, 35),
            &[
                "not used: texture coordinates",
                "warning: the last 40 bytes are missing, which are not used",
            ],
        ),
        (
            more(hair(), 3),
            &["warning: 3 bytes follow the end, byte 192: not used"],
        ),
        (
            more(with_u32(hair(), 12, 64 | 256 | 3), 80),
            &[
                "warning: flags 320 are unknown, and what they stand for is not used",
                "warning: 80 bytes follow the end, byte 192: not used",
            ],
        ),
        (
            more(with_u32(hair(), 12, 16 | 3), 59),
            &[
                "not used: colours",
                "warning: the last 1 bytes are missing, which are not used",
            ],
        ),
    ] {
        let read = read("a.hair", &file, &STRAIGHT).expect("what is needed is there");
        assert_eq!(read.remarks, expected, "remarks");
        assert_eq!(read.strands, plain, "the same hair");
    }
    let file = more(tfx(), 1);
    let remarks = remarks(read("a.tfx", &file, &STRAIGHT).expect("read"));
    assert_eq!(
        remarks,
        ["warning: 1 bytes follow the end, byte 288: not used"]
    );
}

#[test]
fn a_radius_overrides_any_thickness() {
    let options = Import {
        radius: Some(0.01),
        ..STRAIGHT
    };
    let right = read("a.hair", &upright(&[0.1, 0.1], 9.0), &options)
        .expect("read")
        .strands;
    let at = thickness_at(2, 3);
    let good = || upright(&[0.1, 0.1], 9.0);
    for broken in [
        with_f32(good(), at, f32::NAN),
        with_f32(good(), at, -1.0),
        with_f32(good(), at, f32::INFINITY),
        upright(&[0.0, 0.0], 9.0),
        good()[..at].to_vec(),
    ] {
        let error = read("a.hair", &broken, &STRAIGHT).expect_err("no thickness");
        assert!(!error.to_string().contains('\n'), "{error}");
        let read = read("a.hair", &broken, &options).expect("another radius");
        assert_eq!(read.strands, right, "{:?}", read.remarks);
    }
}

#[test]
fn thickness_0_names_its_array() {
    let error = read("a.hair", &upright(&[0.0; 11], 9.0), &STRAIGHT).expect_err("nothing shows");
    let expected = format!(
        "a.hair: byte {}: thickness must be above 0 somewhere, got 0 everywhere: give --radius",
        thickness_at(11, 0)
    );
    assert_eq!(error.to_string(), expected);
    let some = read("a.hair", &upright(&[0.1, 0.0, 0.0], 9.0), &STRAIGHT).expect("one shows");
    assert_eq!(
        some.remarks,
        ["warning: 2 of 3 strands have thickness 0 and do not show: --radius gives them one"]
    );
}

#[test]
fn thin_strands_are_widened() {
    let mut thicknesses = [0.02; 11];
    thicknesses[7] = 2e-6;
    let file = upright(&thicknesses, 9.0);
    let read_file = read("a.hair", &file, &STRAIGHT).expect("widened");
    let strands = &read_file.strands;
    let least = strands.bounds().size().length() * 1e-5;
    let radius = strands.node_radius(strands.nodes_of(7).start);
    assert!(
        (least..1.01 * least).contains(&radius),
        "{radius} for {least}"
    );
    assert_eq!(strands.node_radius(0), 0.01, "others stay");
    Tree::build(strands).expect("thick enough");
    let [remark] = &read_file.remarks[..] else {
        panic!("{:?}", read_file.remarks)
    };
    for words in [
        "warning: widened 1 of 11 strands",
        "strand 7",
        "0.000001 cm",
    ] {
        assert!(remark.contains(words), "{remark}");
    }

    // One strand far away, and all are thin against the scene: no radius would be right.
    let mut file = upright(&[0.02; 11], 9.0);
    file = with_f32(file, 128 + 60 * 4 + 12, 5e5);
    let error = read("a.hair", &file, &STRAIGHT)
        .expect_err("too far")
        .to_string();
    assert!(
        error.contains("strand 4 is farthest") && error.contains("a.hair"),
        "{error}"
    );
}

#[test]
fn thick_and_foreign_units_are_warned_of() {
    let remarks = |thickness: &[f32], length, options: &Import| {
        read("a.hair", &upright(thickness, length), options)
            .expect("read")
            .remarks
    };
    let thick = remarks(&[1.0, 0.02, 1.0], 4.0, &STRAIGHT);
    assert_eq!(
        thick,
        [
            "warning: radii of 2 of 3 strands exceed a tenth of their lengths (up to 0.5 cm, along 4 cm): --radius sets radii \
             in cm"
        ]
    );
    assert!(
        remarks(&[0.7, 0.02], 4.0, &STRAIGHT).is_empty(),
        "below a tenth"
    );
    let scale = Some(0.01);
    let small = remarks(&[0.7, 0.02], 4.0, &Import { scale, ..STRAIGHT });
    assert!(
        small.len() == 1 && small[0].contains("--scale") && small[0].contains("0.01)"),
        "{small:?}"
    );
}
