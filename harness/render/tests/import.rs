//! Files of hair: what they hold, and each refusal.

use glam::Vec3;
use hairis_render::formats::{
    Follow, Import, ImportError, Imported, Up, import, import_bytes, write_mitsuba,
};
use hairis_render::geometry::{Flattening, Groom, Kind};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use std::path::Path;

const STRAIGHT: Import = Import {
    radius: None,
    scale: None,
    up: Up::Y,
    smooth: None,
    follow: Follow {
        strands: 0,
        spread: 1.0,
    },
};

/// A cyHair file: two strands of two and one segments, thickness 0.02.
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

/// A `TressFX` file: two strands of four nodes.
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

/// The file with four bytes changed.
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

#[test]
fn cyhair_is_read() {
    let Imported { strands, remarks } =
        read("a.hair", &hair(), &STRAIGHT).expect("a file as it should be");
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
    let Imported { strands, remarks } = read("a.hair", &file, &STRAIGHT).expect("all arrays");
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
        "warning: dropped 1 of 3 strands, which have no segment",
        "warning: dropped 1 of 7 nodes, which repeat the one before",
        "not used: transparency, colours",
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
    let Imported { strands, remarks } =
        read("a.tfx", &tfx(), &STRAIGHT).expect("a file as it should be");
    assert_eq!(
        (strands.strands(), strands.segments(), remarks.len()),
        (2, 6, 0),
        "{remarks:?}"
    );
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
    let remarks = read("a.tfx", &file, &STRAIGHT)
        .expect("texture coordinates")
        .remarks;
    assert_eq!(
        remarks,
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

#[test]
fn wrong_files_are_refused_with_the_byte_and_both_numbers() {
    let (h, t) = (hair, tfx);
    let long = |mut file: Vec<u8>| {
        file.push(0);
        file
    };
    let without_array = |file: Vec<u8>| with_u32(file, 12, 2);
    let with_thickness = |value: f32| {
        let mut file = with_u32(h(), 12, 7);
        for thickness in [0.1, 0.1, value, 0.1, 0.1] {
            file.extend(thickness.to_le_bytes());
        }
        file
    };
    let cases: [(&str, Vec<u8>, &str); 31] = [
        (
            "a.obj",
            h(),
            "a.obj: the name of a file of hair must end in .hair (cyHair) or .tfx (TressFX)",
        ),
        (
            "a.hair",
            Vec::new(),
            "a.hair: byte 0: the header has 128 bytes, got 0",
        ),
        (
            "a.hair",
            h()[..127].to_vec(),
            "a.hair: byte 127: the header has 128 bytes, got 127",
        ),
        (
            "a.hair",
            with(h(), 0, *b"HAI\x07"),
            "byte 0: must begin with \"HAIR\", got \"HAI\\x07\"",
        ),
        (
            "a.hair",
            with_u32(h(), 12, 1),
            "byte 12: flags must have points (2), got 1",
        ),
        (
            "a.hair",
            with_u32(h(), 12, 35),
            "byte 12: flags must be at most 31, got 35",
        ),
        (
            "a.hair",
            with_u32(h(), 4, 0),
            "byte 4: there must be a strand, got 0",
        ),
        (
            "a.hair",
            without_array(h()),
            "byte 16: there must be segments per strand, or a default of at least 1, got 0",
        ),
        (
            "a.hair",
            h()[..191].to_vec(),
            "byte 191: the file must have 192 bytes, got 191",
        ),
        (
            "a.hair",
            long(h()),
            "byte 192: the file must have 192 bytes, got 193",
        ),
        (
            "a.hair",
            with_u32(h(), 12, 7),
            "byte 192: the file must have 212 bytes, got 192",
        ),
        (
            "a.hair",
            with(h(), 128, [3, 0, 1, 0]),
            "byte 8: strands need 6 points, got 5",
        ),
        (
            "a.hair",
            with(h(), 128, [1, 0, 1, 0]),
            "byte 8: strands need 4 points, got 5",
        ),
        (
            "a.hair",
            with_u32(h(), 8, u32::MAX),
            "byte 4: arrays must have at most 2147483648 bytes, got 51539607672",
        ),
        (
            "a.hair",
            with_u32(h(), 4, u32::MAX),
            "byte 4: arrays must have at most 2147483648 bytes, got 8589934778",
        ),
        (
            "a.hair",
            with_f32(h(), 132, f32::NAN),
            "byte 132: coordinates must be finite and at most 1e6, got NaN",
        ),
        (
            "a.hair",
            with_f32(h(), 188, -2e6),
            "byte 188: coordinates must be finite and at most 1e6, got -2000000",
        ),
        (
            "a.hair",
            with_f32(h(), 20, -1.0),
            "byte 20: thickness must be finite and at least 0, got -1",
        ),
        (
            "a.hair",
            with_thickness(f32::INFINITY),
            "byte 200: thickness must be finite and at least 0, got inf",
        ),
        (
            "a.hair",
            with_f32(h(), 20, 0.0),
            "byte 20: thickness must be above 0 somewhere, got 0 everywhere",
        ),
        (
            "a.tfx",
            t()[..100].to_vec(),
            "a.tfx: byte 100: the header has 160 bytes, got 100",
        ),
        (
            "a.tfx",
            with_f32(t(), 0, 3.0),
            "byte 0: must begin with version 4 as a float",
        ),
        (
            "a.tfx",
            with_u32(t(), 4, 0),
            "byte 4: there must be a strand, got 0",
        ),
        (
            "a.tfx",
            with_u32(t(), 8, 3),
            "byte 8: nodes per strand must be a power of two from 4 to 64, got 3",
        ),
        (
            "a.tfx",
            with_u32(t(), 8, 128),
            "byte 8: nodes per strand must be a power of two from 4 to 64, got 128",
        ),
        (
            "a.tfx",
            with_u32(t(), 12, 159),
            "byte 12: sections must begin after byte 160, got 159",
        ),
        (
            "a.tfx",
            with_u32(t(), 4, u32::MAX),
            "byte 4: arrays must have at most 2147483648 bytes, got 274877907040",
        ),
        (
            "a.tfx",
            with_u32(t(), 12, 176),
            "byte 288: the file must have 304 bytes, got 288",
        ),
        (
            "a.tfx",
            long(t()),
            "byte 288: the file must have 288 bytes, got 289",
        ),
        (
            "a.tfx",
            with_f32(t(), 164, f32::NEG_INFINITY),
            "byte 164: coordinates must be finite and at most 1e6, got -inf",
        ),
        (
            "a.tfx",
            with_f32(t(), 160, 5e5),
            "byte 160: coordinates must be finite and at most 1000000 cm",
        ),
    ];
    for (name, file, expected) in cases {
        let error = read(name, &file, &STRAIGHT)
            .expect_err(expected)
            .to_string();
        assert!(
            error.starts_with(name) && error.contains(expected) && !error.contains('\n'),
            "{error} for {expected}"
        );
    }
    for (options, name) in [
        (
            Import {
                radius: Some(0.0),
                ..STRAIGHT
            },
            "`radius`",
        ),
        (
            Import {
                scale: Some(f32::NAN),
                ..STRAIGHT
            },
            "`scale`",
        ),
    ] {
        let error = read("a.hair", &h(), &options).expect_err(name).to_string();
        assert!(error.contains(name), "{error} for {name}");
    }
    let missing = import(Path::new("no such.hair"), &STRAIGHT)
        .expect_err("no file")
        .to_string();
    assert!(
        missing.starts_with("no such.hair: cannot be read: "),
        "{missing}"
    );
}

/// Any bytes: an error or hair, never a panic, and never more than 64 bytes per byte of the file.
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
fn exported_text_reads_back_the_same() {
    let strands = Groom::new(Kind::Curly, 20)
        .grow(&Flattening::default())
        .expect("settings in range");
    let mut text = Vec::new();
    write_mitsuba(&strands, &mut text).expect("memory takes anything");
    let text = String::from_utf8(text).expect("plain text");
    let mut builder = hairis_render::geometry::Strands::builder();
    for strand in text.split_terminator("\n\n") {
        let node = |line: &str| {
            let numbers: Vec<f32> = line
                .split(' ')
                .map(|number| number.parse().expect("a number"))
                .collect();
            (Vec3::from_slice(&numbers), numbers[3])
        };
        builder
            .push(strand.lines().map(node))
            .expect("what was written");
    }
    assert_eq!(builder.finish(), strands, "read back");
}
