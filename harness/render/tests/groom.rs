//! Tests of procedural hair.

use hairis_render::geometry::{Flattening, GeometryError, Groom, HEAD, Kind, Strands};

fn grow(groom: Groom) -> Strands {
    groom
        .grow(&Flattening::default())
        .expect("settings in range")
}

#[test]
fn kinds_are_what_they_are_called() {
    for kind in Kind::ALL {
        let strands = grow(Groom::new(kind, 300));
        assert_eq!(
            strands.strands(),
            if kind == Kind::Single { 1 } else { 300 },
            "{}",
            kind.name()
        );
        let turn = |ends: [u32; 2]| {
            let direction = |k| (strands.position(k, 1.0) - strands.position(k, 0.0)).normalize();
            direction(ends[0]).angle_between(direction(ends[1]))
        };
        let of_strand = |strand| {
            let nodes = strands.nodes_of(strand);
            let turns: f32 = (nodes.start..nodes.end - 2).map(|k| turn([k, k + 1])).sum();
            let length: f32 = (nodes.start..nodes.end - 1)
                .map(|k| strands.position(k, 0.0).distance(strands.position(k, 1.0)))
                .sum();
            (turns / length, length)
        };
        let n = strands.strands() as f32;
        let (turns, length) = (0..)
            .take(strands.strands())
            .map(of_strand)
            .fold((0.0, 0.0), |sum, (a, b)| (sum.0 + a / n, sum.1 + b / n));
        // Mean turn in rad per cm, and mean length in cm.
        let (least, most, shortest, longest) = match kind {
            Kind::Straight => (0.05, 0.09, 13.2, 14.2),
            Kind::Wavy => (0.4, 0.6, 14.0, 15.5),
            Kind::Curly => (1.3, 1.9, 28.0, 33.0),
            Kind::Fur => (0.15, 0.26, 2.8, 3.2),
            Kind::Patch => (0.015, 0.04, 17.2, 18.0),
            Kind::Single => (0.0, 1e-3, 9.999, 10.001),
        };
        assert!(
            (least..=most).contains(&turns),
            "{} turns by {turns} per cm",
            kind.name()
        );
        assert!(
            (shortest..longest).contains(&length),
            "{} has length {length}",
            kind.name()
        );
    }
}

#[test]
fn hair_grows_on_the_head_and_not_into_it() {
    let groom = Groom::new(Kind::Straight, 2000);
    let strands = grow(Groom {
        clump: 0.0,
        frizz: 0.0,
        ..groom
    });
    for strand in 0..2000 {
        let nodes = strands.nodes_of(strand);
        let radius = |k: u32| (strands.position(k, 0.0) / HEAD).length();
        let root = radius(nodes.start);
        assert!(
            (0.99..1.05).contains(&root),
            "root of strand {strand} at {root} of the head"
        );
        let inside = (nodes.start..nodes.end - 1)
            .map(radius)
            .fold(f32::INFINITY, f32::min);
        assert!(inside > 0.99, "strand {strand} is at {inside} of the head");
    }
}

#[test]
fn combed_hair_lies_on_the_head_to_either_side_of_the_parting() {
    for kind in [Kind::Straight, Kind::Wavy] {
        let strands = grow(Groom::new(kind, 2000));
        let highest = (0..)
            .take(strands.nodes())
            .map(|k| strands.node_position(k).y)
            .fold(f32::NEG_INFINITY, f32::max);
        assert!(
            (HEAD.y..1.18 * HEAD.y).contains(&highest),
            "{}: {highest} cm",
            kind.name()
        );
        for strand in 0..2000 {
            let nodes = strands.nodes_of(strand);
            let [root, tip] = [nodes.start, nodes.end - 1].map(|k| strands.node_position(k));
            let side = root.x - 0.25 * HEAD.x;
            if root.y > 0.8 * HEAD.y && side.abs() > 3.0 {
                assert!(
                    (tip.x - root.x) * side > 0.0,
                    "{}: from {root} to {tip}",
                    kind.name()
                );
            }
            // Clumps do not draw strands through the head; curls and frizz may reach a little into it.
            let inside = nodes
                .map(|k| (strands.node_position(k) / HEAD).length())
                .fold(f32::INFINITY, f32::min);
            assert!(
                inside > 0.9,
                "{}: strand {strand} is at {inside} of the head",
                kind.name()
            );
        }
    }
}

#[test]
fn a_strand_depends_on_the_seed_and_its_number() {
    let groom = Groom::new(Kind::Wavy, 50);
    let (one, same, other) = (grow(groom), grow(groom), grow(Groom { seed: 2, ..groom }));
    assert_eq!(one, same, "the same settings");
    assert_ne!(one, other, "another seed");
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let groom = Groom::new(Kind::Wavy, 50);
    let wrong = [
        (
            "strands",
            Groom {
                strands: 0,
                ..groom
            },
        ),
        ("nodes", Groom { nodes: 1, ..groom }),
        ("clumps", Groom { clumps: 0, ..groom }),
        (
            "length",
            Groom {
                length: f32::NAN,
                ..groom
            },
        ),
        (
            "radius",
            Groom {
                radius: 0.0,
                ..groom
            },
        ),
        (
            "clump",
            Groom {
                clump: 1.5,
                ..groom
            },
        ),
        (
            "curl_length",
            Groom {
                curl_length: 0.0,
                ..groom
            },
        ),
        (
            "frizz",
            Groom {
                frizz: f32::INFINITY,
                ..groom
            },
        ),
    ];
    for (name, groom) in wrong {
        let error: GeometryError = groom.grow(&Flattening::default()).expect_err(name);
        assert!(error.to_string().contains(&format!("`{name}`")), "{error}");
    }
}
