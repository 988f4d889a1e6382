//! Rejections of files, each in one line with the byte and both numbers.

use super::{STRAIGHT, hair, read, tfx, with, with_f32, with_u32};
use hairis_render::formats::{Import, import};
use std::path::Path;

#[test]
fn wrong_files_are_refused_with_the_byte_and_both_numbers() {
    let (h, t) = (hair, tfx);
    let without_array = |file: Vec<u8>| with_u32(file, 12, 2);
    let with_thickness = |value: f32| {
        let mut file = with_u32(h(), 12, 7);
        for thickness in [0.1, 0.1, value, 0.1, 0.1] {
            file.extend(thickness.to_le_bytes());
        }
        file
    };
    let cases: [(&str, Vec<u8>, &str); 28] = [
        (
            "a.obj",
            b"v 0 0 0\nv 0 1 0\n".to_vec(),
            "a.obj: must be hair: .hair (cyHair, MonoHair), .tfx (TressFX), .data (USC-HairSalon), .bin (CT2Hair), .ply",
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
            "byte 0: must begin with \"HAIR\" (cyHair), or with counts that agree (MonoHair), got \"HAI\\x07\"",
        ),
        (
            "a.hair",
            with_u32(h(), 12, 1),
            "byte 12: flags must have points (2), got 1",
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
            "byte 191: the file must have at least 192 bytes, got 191",
        ),
        (
            "a.hair",
            with_u32(h(), 12, 7),
            "byte 192: the file must have at least 212 bytes, got 192",
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
            "byte 288: the file must have at least 304 bytes, got 288",
        ),
        (
            "a.tfx",
            with_f32(t(), 164, f32::NEG_INFINITY),
            "byte 164: coordinates must be finite and at most 1e6, got -inf",
        ),
        (
            "a.tfx",
            with_f32(t(), 160, 5e5),
            "byte 160: strand 0: coordinates must be finite and at most 1000000 cm",
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
