//! Tests of `geometry::strands`.

use glam::Vec3;
use hairis_render::geometry::{GeometryError, Strands};

#[test]
fn wrong_nodes_are_refused_and_leave_nothing() {
    let mut builder = Strands::builder();
    builder
        .push([(Vec3::ZERO, 0.1), (Vec3::X, 0.1)])
        .expect("a cylinder");
    for position in [
        Vec3::new(f32::NAN, 0.0, 0.0),
        Vec3::new(0.0, 0.0, f32::INFINITY),
        Vec3::new(0.0, -1.1e6, 0.0),
    ] {
        let error = builder
            .push([(Vec3::Y, 0.1), (position, 0.1)])
            .expect_err("a node nowhere");
        assert!(
            matches!(error, GeometryError::Position { node: 1, .. }),
            "{error}"
        );
    }
    for radius in [f32::NAN, f32::INFINITY, -0.1] {
        let error = builder
            .push([(Vec3::Y, radius), (Vec3::X, 0.1)])
            .expect_err("no radius");
        assert!(
            matches!(error, GeometryError::Radius { node: 0, .. }),
            "{error}"
        );
    }
    let strands = builder.finish();
    assert_eq!(
        (strands.strands(), strands.nodes()),
        (1, 2),
        "what was right"
    );
}

#[test]
fn nodes_and_strands_without_length_are_dropped() {
    let mut builder = Strands::builder();
    builder
        .push([(Vec3::ZERO, 0.1), (Vec3::ZERO, 0.2), (Vec3::X, 0.1)])
        .expect("finite nodes");
    builder.push([(Vec3::ONE, 0.1); 3]).expect("finite nodes");
    builder.push([]).expect("no node is wrong");
    assert_eq!(
        (builder.dropped_nodes(), builder.dropped_strands()),
        (3, 2),
        "one, and all but one of three"
    );
    let strands = builder.finish();
    assert_eq!(
        (
            strands.strands(),
            strands.segments(),
            strands.node_radius(0)
        ),
        (1, 1, 0.1),
        "what is left"
    );
}

#[test]
fn strands_that_turn_back_have_tangents() {
    let mut builder = Strands::builder();
    builder
        .push([Vec3::ZERO, Vec3::X, Vec3::ZERO, Vec3::X].map(|p| (p, 0.1)))
        .expect("finite nodes");
    let strands = builder.finish();
    for (k, direction) in [(0, Vec3::X), (1, Vec3::NEG_X), (2, Vec3::X)] {
        let tangent = strands.tangent(k, 0.5);
        assert!(
            tangent.is_normalized() && tangent.dot(direction).abs() > 0.999,
            "{tangent} on segment {k}"
        );
    }
}
