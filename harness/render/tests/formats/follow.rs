//! Tests of `formats::follow`.

use glam::Vec3;
use hairis_render::formats::Follow;

#[test]
fn strands_stay_near_their_guide() {
    let nodes: Vec<(Vec3, f32)> = (0..5_u8).map(|k| (f32::from(k) * Vec3::Y, 0.01)).collect();
    let follow = Follow {
        strands: 200,
        spread: 0.3,
    };
    let strands: Vec<_> = follow.about(7, &nodes).collect();
    assert_eq!((strands.len(), &strands[0]), (201, &nodes));
    let mut mean = Vec3::ZERO;
    for strand in &strands {
        assert!(
            strand[0].0.y.abs() < 1e-6,
            "the root is on the skin: {}",
            strand[0].0
        );
        for (node, guide) in strand.iter().zip(&nodes) {
            assert!(
                node.0.distance(guide.0) <= 0.3 + 1e-6 && node.1 == guide.1,
                "{node:?}"
            );
        }
        mean += (strand[4].0 - nodes[4].0) / strands.len() as f32;
    }
    // Deviation of an axis: 0.3 / sqrt 5.
    assert!(
        mean.abs().max_element() < 4.0 * 0.3 / (5.0 * 201_f32).sqrt(),
        "{mean}"
    );
    assert_ne!(
        follow.about(8, &nodes).last(),
        strands.last().cloned(),
        "another guide"
    );
    assert_eq!(Follow::default().about(7, &nodes).count(), 1);
}
