//! Tests of portraits: hairstyles, busts, and heads with a material each.

use crate::support::hair;
use hairis_render::film::Crop;
use hairis_render::geometry::{GeometryError, Mesh, Strands};
use hairis_render::portrait::{CURLY, Portrait, STRAIGHT, Style, WAVY, bust, grow};
use hairis_render::scene::{Head, Scene};
use hairis_render::scenes::{self, Name, Parts};
use hairis_render::transport::{self, Settings};

const COUNT: u32 = 400;

fn strands(portrait: Portrait) -> Strands {
    let upright = Portrait {
        turn: 0.0,
        ..portrait
    };
    grow(&[upright], COUNT as usize).expect("measures in range")
}

/// Returns the lengths of the segments of a strand.
fn lengths(strands: &Strands, strand: u32) -> impl Iterator<Item = f32> {
    let nodes = strands.nodes_of(strand);
    (nodes.start..nodes.end - 1)
        .map(|k| strands.position(k, 0.0).distance(strands.position(k, 1.0)))
}

#[test]
fn hair_grows_on_the_scalp_and_not_into_the_head() {
    for portrait in [WAVY, CURLY, STRAIGHT] {
        let (name, strands) = (portrait.style.name, strands(portrait));
        assert_eq!(strands.strands(), COUNT as usize, "{name}");
        for strand in 0..COUNT {
            let nodes = strands.nodes_of(strand);
            let root = strands.node_position(nodes.start);
            let off = bust::distance(root).abs();
            assert!(off < 0.02, "{name}: root of {strand} is {off} cm off");
            // No hair grows on the face: in front of the ears, roots lie above the brows.
            assert!(root.z < 5.5 || root.y > 4.0, "{name}: {strand} at {root}");
            // All nodes but the root keep a distance from the skin, which one step restores nearly.
            let least = (nodes.start + 1..nodes.end)
                .map(|k| bust::distance(strands.node_position(k)))
                .fold(f32::INFINITY, f32::min);
            assert!(least > 0.0, "{name}: {strand} is {least} cm from the skin");
        }
    }
}

#[test]
fn strands_have_the_lengths_and_radii_of_their_style() {
    for portrait in [WAVY, CURLY, STRAIGHT] {
        let (style, strands) = (portrait.style, strands(portrait));
        // Waves and curls are longer than their middle: by the length of a helix around it.
        let slope = core::f32::consts::TAU * 1.6 * style.curl_radius / style.curl_length;
        let longest = style.length * (1.0 + 2.0 * style.length_spread) * (1.3 + slope);
        let mut shortest = f32::INFINITY;
        let mut sum = 0.0;
        for strand in 0..COUNT {
            let length: f32 = lengths(&strands, strand).sum();
            assert!(
                length < longest,
                "{} has a length of {length} cm",
                style.name
            );
            shortest = shortest.min(length);
            sum += length / COUNT as f32;
            let nodes = strands.nodes_of(strand);
            let [root, tip] =
                [nodes.start, nodes.end - 1].map(|k| strands.node_radius(k) / style.radius);
            let spread = 2.0 * style.radius_spread;
            assert!(
                (root - 1.0).abs() <= spread + 1e-5,
                "{}: {root}",
                style.name
            );
            assert!(
                (tip - root * (1.0 - style.taper)).abs() < 1e-5,
                "{}: {tip}",
                style.name
            );
        }
        assert!(shortest < 0.7 * sum, "{}: lengths vary", style.name);
    }
}

#[test]
fn curls_turn_more_than_waves_and_waves_more_than_straight_hair() {
    let turns = [STRAIGHT, WAVY, CURLY].map(|portrait| {
        let strands = strands(portrait);
        let of_strand = |strand| {
            let nodes = strands.nodes_of(strand);
            let direction = |k| strands.position(k, 1.0) - strands.position(k, 0.0);
            let turns: f32 = (nodes.start..nodes.end - 2)
                .map(|k| direction(k).angle_between(direction(k + 1)))
                .sum();
            turns / lengths(&strands, strand).sum::<f32>()
        };
        (0..COUNT).map(of_strand).sum::<f32>() / COUNT as f32
    });
    // In rad per cm.
    assert!(turns[1] > 1.3 * turns[0], "{turns:?}");
    assert!(turns[2] > 2.0 * turns[1], "{turns:?}");
}

#[test]
fn hair_depends_on_its_style_and_seed_alone() {
    let one = strands(WAVY);
    assert_eq!(one, strands(WAVY), "the same again");
    let mut other = WAVY;
    other.style.seed += 1;
    assert_ne!(one, strands(other), "another seed");
    // Heads follow one another, each with all its strands.
    let two = grow(&[WAVY, CURLY], COUNT as usize).expect("in range");
    assert_eq!(two.strands(), 2 * COUNT as usize);
}

#[test]
fn measures_out_of_range_are_refused_by_name() {
    let refused = |style: Style, count| {
        let portrait = Portrait { style, ..WAVY };
        grow(&[portrait], count)
            .expect_err("out of range")
            .to_string()
    };
    let style = Style::WAVY;
    for (style, count, message) in [
        (
            Style {
                length: 100.0,
                ..style
            },
            1,
            "`length` must be in [2, 60], got 100",
        ),
        (
            Style {
                frizz: f32::NAN,
                ..style
            },
            1,
            "`frizz` must be in [0, 2], got NaN",
        ),
        (
            Style { clumps: 0, ..style },
            1,
            "`clumps` must be from 1 to 100000, got 0",
        ),
        (style, 0, "`strands` must be from 1 to 16777216, got 0"),
    ] {
        assert_eq!(refused(style, count), message);
    }
    let error = Style {
        lift: -1.0,
        ..style
    }
    .check();
    assert!(matches!(
        error,
        Err(GeometryError::Setting { name: "lift", .. })
    ));
}

#[test]
fn the_mesh_of_a_bust_lies_on_its_surface_with_normals_outwards() {
    let cell = 0.8;
    let mesh = bust::mesh(cell).expect("a mesh");
    for triangle in (0..).take(mesh.triangles()) {
        let corners = mesh.corners(triangle);
        let middle = corners.into_iter().sum::<glam::Vec3>() / 3.0;
        // Coarse cells cut the rims of ears.
        if middle.x.abs() > 6.0 && middle.y > -7.0 {
            continue;
        }
        for corner in corners {
            let off = bust::distance(corner).abs();
            assert!(off < 0.5 * cell, "{corner} is {off} cm off the surface");
        }
        let [flat, smooth] = [mesh.normal(triangle), mesh.shading_normal(triangle, middle)];
        let outside = bust::distance(middle + 0.1 * smooth);
        assert!(outside > bust::distance(middle), "{middle}: {smooth}");
        assert!(flat.dot(smooth) > 0.0, "{middle}: {flat}, {smooth}");
    }
}

#[test]
fn meshes_with_normals_refuse_others_than_one_unit_normal_per_corner() {
    let [o, x, y] = [glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Y];
    let mesh = Mesh::new(vec![o, x, y], vec![[0, 1, 2]]).expect("a triangle");
    let refused = |normals| mesh.clone().with_normals(normals).expect_err("refused");
    assert_eq!(refused(vec![x]), "a mesh must have 3 normals, got 1");
    assert!(refused(vec![x, y, 2.0 * y]).starts_with("normals must have length 1"));
    // Between corners the normal is interpolated.
    let smooth = mesh.with_normals(vec![x, y, x]).expect("normals");
    let middle = smooth.shading_normal(0, 0.5 * x);
    assert!(middle.distance((x + y).normalize()) < 1e-6, "{middle}");
}

/// Returns a head with two materials: `others` begin at the middle strand.
fn two_materials(first: &str, other: &str) -> Scene {
    let parts = Parts {
        strands: scenes::grow(Name::Head, 600).expect("a few strands"),
        imported: false,
        head: None,
        hair: hair("gaussian", "matched", first),
        env: None,
        size: [24, 24],
        turn: 0.0,
    };
    Scene {
        others: vec![(300, hair("gaussian", "matched", other))],
        ..scenes::build(Name::Head, parts).expect("a scene")
    }
}

#[test]
fn strands_have_the_material_of_their_head() {
    let film = |scene: &Scene| {
        transport::film(scene, &Settings::default(), Crop::whole([24, 24]), 8).picture()
    };
    let brown = two_materials("brown", "brown");
    let one = Scene {
        others: Vec::new(),
        ..brown.clone()
    };
    let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(
        close(film(&brown).mean(), film(&one).mean()),
        "two of the same"
    );
    let mixed = film(&two_materials("brown", "blond")).mean()[0];
    let [dark, light] = ["brown", "blond"].map(|name| film(&two_materials(name, name)).mean()[0]);
    assert!(dark < mixed && mixed < light, "{dark} {mixed} {light}");
    let scene = two_materials("brown", "blond");
    assert_eq!(
        [0, 299, 300, 599].map(|strand| scene.hair_of(strand).0),
        [0, 0, 1, 1]
    );
}

#[test]
fn portraits_have_busts_and_lights() {
    let parts = Parts {
        strands: scenes::grow(Name::Straight, 50).expect("a few strands"),
        imported: false,
        head: None,
        hair: hair("gaussian", "matched", "black"),
        env: None,
        size: [32, 40],
        turn: 0.0,
    };
    let scene = scenes::build(Name::Straight, parts).expect("a scene");
    assert!(scene.head.as_ref().map_or(0, Head::triangles) > 10_000);
    let film = transport::film(&scene, &Settings::default(), Crop::whole([32, 40]), 4);
    assert!(
        film.picture()
            .mean()
            .into_iter()
            .all(|channel| channel > 0.01)
    );
}
