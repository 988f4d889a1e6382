//! Tests of `geometry::spline`.

use glam::Vec3;
use hairis_instruments::sequence::{Independent, XiSource as _};
use hairis_render::geometry::{Basis, Flattening, Spline};

fn helix() -> Vec<Vec3> {
    (0..20)
        .map(|k| 0.6 * k as f32)
        .map(|a| Vec3::new(0.2 * a, libm::cosf(a), libm::sinf(a)))
        .collect()
}

#[test]
fn derivatives_are_those_of_points() {
    let nodes = helix();
    for basis in [Basis::BSpline, Basis::PinnedBSpline, Basis::CatmullRom] {
        let spline = Spline::new(&nodes, basis).expect("twenty nodes");
        for (span, x) in [(0, 0.3), (7, 0.0), (7, 0.5), (18, 0.9)] {
            let step = 0.01;
            let numeric =
                (spline.at(span, x + step).0 - spline.at(span, x - step).0) / (2.0 * step);
            let (_, exact) = spline.at(span, x);
            assert!(
                numeric.distance(exact) < 2e-4,
                "{basis:?} at {span} + {x}: {numeric} and {exact}"
            );
        }
        let (ends, starts) = (spline.at(6, 1.0), spline.at(7, 0.0));
        assert!(
            ends.0.distance(starts.0) < 1e-5 && ends.1.distance(starts.1) < 1e-5,
            "{basis:?} has a gap"
        );
    }
}

#[test]
fn catmull_rom_passes_through_its_nodes() {
    let nodes = helix();
    let spline = Spline::new(&nodes, Basis::CatmullRom).expect("twenty nodes");
    for span in 0..19 {
        for (x, node) in [(0.0, nodes[span]), (1.0, nodes[span + 1])] {
            let point = spline.at(span, x).0;
            assert!(
                point.distance(node) < 1e-6,
                "span {span}: {point} for {node}"
            );
        }
    }
}

#[test]
fn straight_strands_stay_straight_whatever_their_spans() {
    let mut random = Independent::new(3, 0);
    let mut strands = vec![vec![0.0, 4.0, 4.01, 8.0, 8.02, 8.03, 12.0]];
    strands.extend((0..200).map(|_| {
        let steps = (0..12).map(|_| libm::powf(10.0, -5.0 * random.next_xi_f32::<1>()[0]));
        steps
            .scan(0.0, |y, step| {
                *y += step;
                Some(*y)
            })
            .collect()
    }));
    for strand in strands {
        let nodes: Vec<Vec3> = strand.iter().map(|y| Vec3::new(1.0, *y, 0.0)).collect();
        for basis in [Basis::PinnedBSpline, Basis::CatmullRom] {
            let spline = Spline::new(&nodes, basis).expect("nodes");
            let (mut last, end) = (strand[0], strand[strand.len() - 1]);
            for (span, x) in (0..spline.spans()).flat_map(|k| (0..=32).map(move |i| (k, i))) {
                let (point, along) = spline.at(span, x as f32 / 32.0);
                assert!(
                    point.y >= last - 1e-6 * end && along.y > 0.0 && along.x == 0.0,
                    "{basis:?} of {strand:?}: {point} after {last} along {along}"
                );
                last = point.y;
            }
            assert!((last - end).abs() <= 1e-6 * end, "{basis:?}: {last}");
        }
    }
}

#[test]
fn uneven_spans_turn_no_further_than_their_corners() {
    // A right angle between spans of very different length: no loop, so the direction stays
    // between those of the legs.
    for short in [1e-4, 0.01, 0.3, 1.0] {
        let nodes = [-1.0, -0.5, 0.0].map(|x| Vec3::new(x, 0.0, 0.0));
        let leg = [1.0, 2.0, 40.0].map(|k| Vec3::new(0.0, k * short, 0.0));
        let nodes: Vec<Vec3> = nodes.into_iter().chain(leg).collect();
        let spline = Spline::new(&nodes, Basis::CatmullRom).expect("six nodes");
        let back = Vec3::new(-1.0, -1.0, 0.0);
        for (span, x) in (0..5).flat_map(|k| (0..=64).map(move |i| (k, i))) {
            let along = spline.at(span, x as f32 / 64.0).1.normalize();
            assert!(
                along.dot(back) < 0.35,
                "{short}: {along} at {span} + {x}/64"
            );
        }
    }
}

#[test]
fn segments_keep_to_tolerance_and_turn() {
    let nodes = helix();
    let spline = Spline::new(&nodes, Basis::BSpline).expect("twenty nodes");
    for (flattening, worst) in [
        (
            Flattening {
                radii: 1.0,
                centimetres: 1.0,
                turn: 9.0,
                halvings: 8,
            },
            0.01,
        ),
        (
            Flattening {
                radii: 1.0,
                centimetres: 0.001,
                turn: 9.0,
                halvings: 8,
            },
            0.001,
        ),
        (
            Flattening {
                radii: 99.0,
                centimetres: 1.0,
                turn: 0.1,
                halvings: 8,
            },
            0.1,
        ),
    ] {
        let mut polyline = Vec::new();
        flattening.append(&spline, |_| 0.01, &mut polyline);
        let segments: Vec<Vec3> = polyline
            .windows(2)
            .map(|ends| ends[1].0 - ends[0].0)
            .collect();
        let turn = segments
            .windows(2)
            .map(|pair| pair[0].angle_between(pair[1]))
            .fold(0.0, f32::max);
        assert!(
            turn <= flattening.turn + 1e-3,
            "{flattening:?}: turns by {turn}"
        );
        let off = (0..19 * 64)
            .map(|i| spline.at(i / 64, (i % 64) as f32 / 64.0).0)
            .map(|point| {
                let nearest = |ends: &[(Vec3, f32)]| {
                    let edge = ends[1].0 - ends[0].0;
                    let s = ((point - ends[0].0).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
                    point.distance(ends[0].0 + s * edge)
                };
                polyline
                    .windows(2)
                    .map(nearest)
                    .fold(f32::INFINITY, f32::min)
            });
        let off = off.fold(0.0, f32::max);
        assert!(
            off <= 1.1 * worst && off > 0.05 * worst.min(0.01),
            "{flattening:?}: off by {off}"
        );
    }
}
