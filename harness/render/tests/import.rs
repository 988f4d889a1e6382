//! Tests of files of hair: the strands that they hold, and each rejection.

mod refused;
mod research;
mod text;
mod tolerated;

use glam::Vec3;
use hairis_render::formats::{
    Curve, Follow, Import, ImportError, Imported, Up, import_bytes, write_hair,
};
use hairis_render::geometry::{Flattening, Groom, Kind};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use std::path::Path;

const STRAIGHT: Import = Import {
    radius: None,
    scale: None,
    up: Up::Y,
    curve: Curve::Linear,
    follow: Follow {
        strands: 0,
        spread: 1.0,
    },
};

/// Returns a cyHair file: two strands of two and one segments, thickness 0.02.
fn hair() -> Vec<u8> {
    let mut file = b"HAIR".to_vec();
    for number in [2_u32, 5, 1 | 2, 0] {
        file.extend(number.to_le_bytes());
    }
    for number in [0.02_f32, 0.0, 1.0, 1.0, 1.0] {
        file.extend(number.to_le_bytes());
    }
    file.extend([0; 88]);
    for segments in [2_u16, 1] {
        file.extend(segments.to_le_bytes());
    }
    for number in [
        0.0_f32, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 5.0, 0.0, 0.0, 5.0, 0.0, 3.0,
    ] {
        file.extend(number.to_le_bytes());
    }
    file
}

/// Returns a `TressFX` file: two strands of four nodes.
fn tfx() -> Vec<u8> {
    let mut file = 4_f32.to_le_bytes().to_vec();
    for number in [2_u32, 4, 160] {
        file.extend(number.to_le_bytes());
    }
    file.resize(160, 0);
    for node in 0..8 {
        for number in [0.1 * (node / 4) as f32, 0.01 * (node % 4) as f32, 0.02, 1.0] {
            file.extend(number.to_le_bytes());
        }
    }
    file
}

/// Returns the file with four bytes changed.
fn with(mut file: Vec<u8>, offset: usize, bytes: [u8; 4]) -> Vec<u8> {
    file[offset..offset + 4].copy_from_slice(&bytes);
    file
}

fn with_u32(file: Vec<u8>, offset: usize, number: u32) -> Vec<u8> {
    with(file, offset, number.to_le_bytes())
}

fn with_f32(file: Vec<u8>, offset: usize, number: f32) -> Vec<u8> {
    with(file, offset, number.to_le_bytes())
}

fn read(name: &str, file: &[u8], options: &Import) -> Result<Imported, ImportError> {
    import_bytes(Path::new(name), file, options)
}

/// Returns the remarks, except the one on the radius of few strands, which is thick where the file has none.
fn remarks(imported: Imported) -> Vec<String> {
    let mut remarks = imported.remarks;
    remarks.retain(|remark| !remark.contains("exceed a tenth of their lengths"));
    remarks
}

#[test]
fn cyhair_is_read() {
    let Imported {
        strands, remarks, ..
    } = read("a.hair", &hair(), &STRAIGHT).expect("a file as it should be");
    assert_eq!(
        (strands.strands(), strands.segments(), remarks.len()),
        (2, 3, 0),
        "{remarks:?}"
    );
    assert_eq!(
        strands.node_position(2),
        Vec3::new(1.0, 1.0, 0.0),
        "the third node"
    );
    assert_eq!(
        (strands.node_radius(0), strands.node_radius(4)),
        (0.01, 0.01),
        "half the thickness"
    );

    let options = Import {
        radius: Some(0.1),
        scale: Some(2.0),
        up: Up::Z,
        ..STRAIGHT
    };
    let strands = read("a.HAIR", &hair(), &options)
        .expect("the same file")
        .strands;
    assert_eq!(
        strands.node_position(4),
        Vec3::new(10.0, 6.0, 0.0),
        "twice as large, z up"
    );
    assert!(
        (strands.node_radius(0) - 0.1).abs() < 1e-7 && (strands.node_radius(4) - 0.04).abs() < 1e-7,
        "tapered"
    );

    // All arrays, of which colours and transparency are not used; strands without segments and repeated points.
    let mut file = with_u32(with_u32(hair(), 8, 7), 12, 31);
    file[4] = 3;
    file.splice(128..132, [2, 0, 1, 0, 0, 0]);
    for number in [5.0_f32, 0.0, 3.0, 9.0, 9.0, 9.0] {
        file.extend(number.to_le_bytes());
    }
    file[130] = 2;
    for thickness in 0..7 {
        file.extend((thickness as f32).to_le_bytes());
    }
    file.extend([0; 7 * 16]);
    let Imported {
        strands, remarks, ..
    } = read("a.hair", &file, &STRAIGHT).expect("all arrays");
    assert_eq!(
        (strands.strands(), strands.segments()),
        (2, 3),
        "without what was dropped"
    );
    assert_eq!(
        strands.node_radius(4),
        2.0,
        "half the thickness of its point"
    );
    let expected = [
        "not used: transparency, colours",
        "warning: dropped 1 of 3 strands, which have no segment",
        "warning: dropped 1 of 7 nodes, which repeat the one before",
        "warning: radii of 2 of 2 strands exceed a tenth of their lengths (up to 2 cm, along 3 cm): --radius sets radii in cm",
    ];
    assert_eq!(remarks, expected, "remarks");

    // A default number of segments instead of the array.
    let mut file = with_u32(with_u32(with_u32(hair(), 8, 4), 12, 2), 16, 1);
    file.drain(128..132);
    file.truncate(128 + 4 * 12);
    assert_eq!(
        read("a.hair", &file, &STRAIGHT)
            .expect("a default")
            .strands
            .segments(),
        2,
        "one a strand"
    );
}

#[test]
fn tressfx_is_read() {
    let tressfx = read("a.tfx", &tfx(), &STRAIGHT).expect("a file as it should be");
    let strands = tressfx.strands.clone();
    assert_eq!((strands.strands(), strands.segments()), (2, 6));
    assert!(remarks(tressfx).is_empty(), "as it should be");
    assert!(
        strands.node_position(7).distance(Vec3::new(10.0, 3.0, 2.0)) < 1e-5,
        "metres"
    );
    assert!(
        (strands.node_radius(0) - Groom::covering_radius(2)).abs() < 1e-6,
        "the radius that covers"
    );
    let mut file = with_u32(tfx(), 16, 160 + 128);
    file.extend([0; 16]);
    let more = read("a.tfx", &file, &STRAIGHT).expect("texture coordinates");
    assert_eq!(
        remarks(more),
        ["not used: texture coordinates of strands"],
        "remarks"
    );
}

#[test]
fn curves_go_through_the_nodes_of_a_file() {
    let smooth = read("a.hair", &hair(), &Import::default())
        .expect("a file as it should be")
        .strands;
    let nodes: Vec<Vec3> = smooth
        .nodes_of(0)
        .map(|node| smooth.node_position(node))
        .collect();
    assert!(nodes.len() > 6, "a right angle is rounded: {nodes:?}");
    for node in [Vec3::ZERO, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)] {
        assert!(
            nodes.iter().any(|p| p.distance(node) < 1e-6),
            "{node} of {nodes:?}"
        );
    }
}

/// Checks that any bytes give an error or hair, never a panic, and never more than 64 bytes per byte of the file.
#[test]
fn no_bytes_make_it_panic_or_grow() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut index = |below: usize| random.next_u32() as usize % below;
    let byte = |number: usize| u8::try_from(number).expect("below 256");
    let mut accepted = 0;
    for i in 0..40_000 {
        let (name, mut file) = if i % 2 == 0 {
            ("a.hair", hair())
        } else {
            ("a.tfx", tfx())
        };
        match i / 2 % 4 {
            0 => file = (0..index(300)).map(|_| byte(index(256))).collect(),
            1 => {
                let start = file.len().min(12 + 4 * index(40));
                file[start..]
                    .iter_mut()
                    .for_each(|place| *place = byte(index(256)));
            }
            2 => {
                for _ in 0..=index(3) {
                    let place = index(file.len());
                    file[place] = [0, 1, 2, 127, 128, 255][index(6)];
                }
            }
            _ => {
                let place = index(file.len());
                file[place] ^= 1 << index(8);
                file.truncate(if index(4) == 0 {
                    index(file.len())
                } else {
                    file.len()
                });
            }
        }
        let options = if index(2) == 0 {
            STRAIGHT
        } else {
            Import::default()
        };
        if let Ok(Imported { strands, .. }) = read(name, &file, &options) {
            accepted += 1;
            // Nodes take 16 bytes while their vector grows to twice that, and tangents 12.
            let memory = strands.nodes() * (2 * 16 + 12);
            assert!(
                memory <= 64 * file.len(),
                "{memory} bytes from {}",
                file.len()
            );
            assert!(
                strands
                    .numbers()
                    .all(|(_, k)| strands.tangent(k, 0.5).is_finite()),
                "tangents of {file:?}"
            );
        }
    }
    assert!(accepted > 2_000, "{accepted} files were accepted");
}

#[test]
fn exported_hair_reads_back_the_same() {
    let strands = Groom::new(Kind::Curly, 20)
        .grow(&Flattening::default())
        .expect("settings in range");
    for (ending, has_radii, tolerance) in [
        ("txt", true, 0.0),
        ("hair", true, 0.0),
        ("ply", true, 0.0),
        ("data", false, 1e-5),
        ("bin", false, 1e-5),
    ] {
        let name = format!("a.{ending}");
        let mut file = Vec::new();
        write_hair(Path::new(&name), &strands, &mut file).expect("memory takes anything");
        let back = read(&name, &file, &STRAIGHT).expect("what was written");
        assert_eq!(remarks(back.clone()), [""; 0], "{name}");
        assert_eq!(back.strands.strands(), strands.strands(), "{name}");
        assert_eq!(back.strands.nodes(), strands.nodes(), "{name}");
        for node in (0..).take(strands.nodes()) {
            let off = back
                .strands
                .node_position(node)
                .distance(strands.node_position(node));
            assert!(off <= tolerance, "{name}: off by {off}");
            let radius = back.strands.node_radius(node);
            assert!(
                !has_radii || radius == strands.node_radius(node),
                "{name}: {radius}"
            );
        }
    }
}
