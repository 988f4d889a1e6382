//! Formats of research, and the content by which formats are told apart.

use super::{STRAIGHT, hair, read, tfx};
use glam::Vec3;
use hairis_render::formats::{Imported, import_bytes};
use hairis_render::geometry::{Groom, Strands};
use std::path::Path;

type Lines = Vec<Vec<[f32; 3]>>;

/// Returns three strands of 3, 2 and 4 nodes.
fn lines() -> Lines {
    let strand = |x: f32, nodes: u8| (0..nodes).map(|k| [x, 2.0 * f32::from(k), x * x]).collect();
    vec![strand(0.0, 3), strand(1.5, 2), strand(3.0, 4)]
}

fn bytes(numbers: impl IntoIterator<Item = f32>) -> Vec<u8> {
    numbers.into_iter().flat_map(f32::to_le_bytes).collect()
}

fn number(value: usize) -> [u8; 4] {
    u32::try_from(value).expect("small").to_le_bytes()
}

/// Returns a file of USC-HairSalon, or, with `beside` numbers after each position, of `CT2Hair`.
fn counted(lines: &Lines, beside: &[f32]) -> Vec<u8> {
    let mut file = number(lines.len()).to_vec();
    for line in lines {
        file.extend(number(line.len()));
        for place in line {
            file.extend(bytes(place.iter().chain(beside).copied()));
        }
    }
    file
}

fn monohair(lines: &Lines) -> Vec<u8> {
    let mut file = number(lines.len()).to_vec();
    file.extend(number(lines.concat().len()));
    for line in lines {
        file.extend(&number(line.len())[..2]);
    }
    file.extend(bytes(lines.concat().concat()));
    file
}

fn mitsuba_binary(lines: &Lines) -> Vec<u8> {
    let mut file = b"BINARY_HAIR".to_vec();
    file.extend(number(lines.concat().len()));
    for line in lines {
        file.extend(bytes([f32::INFINITY]));
        file.extend(bytes(line.concat()));
    }
    file
}

fn text(lines: &Lines, radius: &str, between: &str) -> Vec<u8> {
    let node = |[x, y, z]: &[f32; 3]| format!("{x} {y} {z}{radius}\n");
    let strand = |line: &Vec<[f32; 3]>| line.iter().map(node).collect::<String>() + between;
    lines.iter().map(strand).collect::<String>().into_bytes()
}

/// Returns a PLY file in three encodings, from a header without its `format` and from rows.
fn ply(header: &str, rows: &[&[(char, f64)]]) -> [Vec<u8>; 3] {
    let start =
        |format: &str| format!("ply\nformat {format} 1.0\n{header}end_header\n").into_bytes();
    let mut files = [
        start("ascii"),
        start("binary_little_endian"),
        start("binary_big_endian"),
    ];
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "small whole numbers"
    )]
    for row in rows {
        let words: Vec<String> = row.iter().map(|(_, value)| value.to_string()).collect();
        files[0].extend((words.join(" ") + "\n").into_bytes());
        for (kind, value) in *row {
            let little = match kind {
                'f' => (*value as f32).to_le_bytes().to_vec(),
                'd' => value.to_le_bytes().to_vec(),
                'i' => (*value as i32).to_le_bytes().to_vec(),
                's' => (*value as u16).to_le_bytes().to_vec(),
                _ => vec![*value as u8],
            };
            files[1].extend(&little);
            files[2].extend(little.iter().rev());
        }
    }
    files
}

/// Returns the nodes of all strands as rows of floats and doubles, each with `more`.
fn nodes(lines: &Lines, more: &[(char, f64)]) -> Vec<Vec<(char, f64)>> {
    let row = |place: [f32; 3]| {
        let [x, y, z] = place.map(f64::from);
        [&[('f', x), ('d', y), ('f', z)], more].concat()
    };
    lines.concat().into_iter().map(row).collect()
}

fn check(name: &str, file: &[u8], lines: &Lines, scale: f32, remarks: &[&str]) -> Strands {
    let read = read(name, file, &STRAIGHT).unwrap_or_else(|error| panic!("{error}"));
    let mut builder = Strands::builder();
    let radius = Groom::covering_radius(lines.len());
    for line in lines {
        builder
            .push(
                line.iter()
                    .map(|place| (scale * Vec3::from(*place), radius)),
            )
            .expect("in range");
    }
    let expected = builder.finish();
    assert_eq!(super::remarks(read.clone()), remarks, "{name}");
    assert_eq!(read.scale, scale, "{name}");
    let ranges = |strands: &Strands| {
        let all = (0..).take(strands.strands());
        all.map(|strand| strands.nodes_of(strand))
            .collect::<Vec<_>>()
    };
    assert_eq!(ranges(&read.strands), ranges(&expected), "{name}");
    for node in (0..).take(expected.nodes()) {
        let [got, wanted] = [&read.strands, &expected].map(|one| one.node_position(node));
        assert!(got.distance(wanted) < 1e-4, "{name}: {got} for {wanted}");
    }
    assert!(
        read.strands.node_radius(0) <= radius && read.strands.node_radius(0) > 0.99 * radius,
        "{name}"
    );
    read.strands
}

#[test]
fn counted_strands_are_read() {
    let mut with_roots = lines();
    with_roots.insert(1, vec![[7.0; 3]]);
    with_roots.push(Vec::new());
    check("a.data", &counted(&lines(), &[]), &lines(), 100.0, &[]);
    let roots = ["2 of 5 roots have no hair"];
    check(
        "a.data",
        &counted(&with_roots, &[]),
        &lines(),
        100.0,
        &roots,
    );
    let normal = [0.0, 1.0, 0.0, f32::NAN];
    check("a.bin", &counted(&lines(), &normal), &lines(), 0.1, &[]);
    check(
        "a.bin",
        &counted(&with_roots, &normal),
        &lines(),
        0.1,
        &roots,
    );

    let mut nan = lines();
    nan.insert(0, vec![[0.0; 3], [f32::NAN, 0.0, 0.0]]);
    let dropped = ["warning: dropped 1 of 4 strands, which have coordinates that are not finite"];
    check("a.bin", &counted(&nan, &normal), &lines(), 0.1, &dropped);

    let mut long = counted(&lines(), &[]);
    long.extend([1, 2, 3]);
    let behind = ["warning: 3 bytes follow the end, byte 124: not used"];
    check("a.data", &long, &lines(), 100.0, &behind);
}

#[test]
fn monohair_and_mitsuba_are_read() {
    check("a.hair", &monohair(&lines()), &lines(), 100.0, &[]);
    for name in ["a.txt", "a.hair"] {
        for between in ["\n", "# next\n", "\r\n\n", "  \n\n\n"] {
            check(name, &text(&lines(), "", between), &lines(), 1.0, &[]);
        }
    }
    let windows = text(&lines(), "", "\n");
    let windows = String::from_utf8(windows)
        .expect("text")
        .replace('\n', "\r\n");
    check("a.txt", windows.as_bytes(), &lines(), 1.0, &[]);
    let marked = [b"\xef\xbb\xbf", windows.as_bytes()].concat();
    check("a.txt", &marked, &lines(), 1.0, &[]);
    check("a.hair", &mitsuba_binary(&lines()), &lines(), 1.0, &[]);
    let with_radius = read("a.txt", &text(&lines(), " 5e-2", "\n"), &STRAIGHT).expect("read");
    assert_eq!(
        with_radius.strands.node_radius(4),
        0.05,
        "the fourth number"
    );
}

#[test]
fn strands_of_ply_are_read_in_each_encoding() {
    let vertex = "comment caf\u{e9}\nelement vertex 9\nproperty float x\nproperty double y\nproperty float32 z\n";
    let plain = nodes(&lines(), &[]);
    let whole = |header: &str, rows: &[&[(char, f64)]]| {
        let nodes: Vec<_> = plain.iter().map(Vec::as_slice).collect();
        ply(&format!("{vertex}{header}"), &[&nodes, rows].concat())
    };
    let counts = whole(
        "element strand 3\nproperty ushort nsegs\n",
        &[&[('s', 2.0)], &[('s', 1.0)], &[('s', 3.0)]],
    );
    let points = whole(
        "obj_info x\nelement curves 3\nproperty uchar label\nproperty int num_points\n",
        &[
            &[('b', 9.0), ('i', 3.0)],
            &[('b', 0.0), ('i', 2.0)],
            &[('b', 1.0), ('i', 4.0)],
        ],
    );
    let lists = whole(
        "element line 3\nproperty list uchar int vertex_indices\n",
        &[
            &[('b', 3.0), ('i', 0.0), ('i', 1.0), ('i', 2.0)],
            &[('b', 2.0), ('i', 3.0), ('i', 4.0)],
            &[('b', 4.0), ('i', 5.0), ('i', 6.0), ('i', 7.0), ('i', 8.0)],
        ],
    );
    // In any order.
    let edges = whole(
        "element edge 6\nproperty int vertex1\nproperty int vertex2\n",
        &[
            &[('i', 7.0), ('i', 8.0)],
            &[('i', 0.0), ('i', 1.0)],
            &[('i', 3.0), ('i', 4.0)],
            &[('i', 2.0), ('i', 1.0)],
            &[('i', 5.0), ('i', 6.0)],
            &[('i', 6.0), ('i', 7.0)],
        ],
    );
    let mut rows = plain.clone();
    for (row, id) in rows
        .iter_mut()
        .zip([4.0, 4.0, 4.0, 1.0, 1.0, 9.0, 9.0, 9.0, 9.0])
    {
        row.push(('i', id));
    }
    let rows: Vec<_> = rows.iter().map(Vec::as_slice).collect();
    let ids = ply(&format!("{vertex}property int strand_id\n"), &rows);
    for files in [counts, points, lists, edges, ids] {
        for file in files {
            check("a.ply", &file, &lines(), 1.0, &[]);
        }
    }

    let rows = nodes(&lines(), &[('f', 0.5)]);
    let mut rows: Vec<_> = rows.iter().map(Vec::as_slice).collect();
    rows.extend([&[('b', 8.0)][..]]);
    for (name, radius) in [("radius", 0.5), ("thickness", 0.25), ("width", 0.25)] {
        let header =
            format!("{vertex}property float {name}\nelement strand 1\nproperty uchar nsegs\n");
        for file in ply(&header, &rows) {
            let strands = read("a.ply", &file, &STRAIGHT).expect("read").strands;
            assert_eq!(
                (strands.node_radius(3), strands.nodes()),
                (radius, 9),
                "{name}"
            );
        }
    }
}

#[test]
fn text_of_ply_may_be_untidy() {
    let file = "ply\r\nformat ascii 1.0\r\nelement vertex 2\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n\
        element edge 1\r\nproperty int vertex1\r\nproperty int vertex2\r\nend_header\r\n.5 1. -2e0\r\n\r\n  +1\t0 0 \r\n0 1";
    let lines = vec![vec![[0.5, 1.0, -2.0], [1.0, 0.0, 0.0]]];
    check("a.ply", file.as_bytes(), &lines, 1.0, &[]);
    let end = file.len();
    let behind = format!(
        "warning: 7 bytes follow the end, byte {}: not used",
        end + 1
    );
    check(
        "a.ply",
        (file.to_owned() + "\n\n5 5 5\n").as_bytes(),
        &lines,
        1.0,
        &[&behind],
    );
}

#[test]
fn content_decides_and_the_name_is_remarked_on() {
    let formats = [
        (counted(&lines(), &[]), "USC-HairSalon", "data"),
        (counted(&lines(), &[0.0; 4]), "CT2Hair", "bin"),
        (monohair(&lines()), "MonoHair", "hair"),
        (
            mitsuba_binary(&lines()),
            "Mitsuba's binary hair",
            "hair bin",
        ),
        (text(&lines(), " 0.1", "\n"), "Mitsuba's text", "hair txt"),
        (hair(), "cyHair", "hair"),
        (tfx(), "TressFX", "tfx"),
    ];
    for (file, format, own) in &formats {
        let own: Vec<&str> = own.split(' ').collect();
        let name = |ending: &str| format!("a.{ending}");
        let right = read(&name(own[0]), file, &STRAIGHT).expect("read");
        for ending in ["hair", "tfx", "data", "bin", "ply", "txt", "dat", "DATA"] {
            let Imported {
                strands, remarks, ..
            } = read(&name(ending), file, &STRAIGHT)
                .unwrap_or_else(|error| panic!("{error}: is {format}"));
            assert_eq!(strands, right.strands, "{format} as {ending}");
            let expected = format!(
                "read as {format}, which the name's ending .{} does not say",
                ending.to_lowercase()
            );
            let said = remarks.first() == Some(&expected);
            assert_eq!(
                said,
                !own.contains(&ending.to_lowercase().as_str()),
                "{remarks:?} of {format} as {ending}"
            );
        }
    }
    let none = read("noname", &hair(), &STRAIGHT).expect("read").remarks;
    assert_eq!(none, ["read as cyHair: the name has no ending"]);
}

#[test]
fn wrong_strands_are_refused_in_one_line() {
    let vertex = "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
    let text = |header: &str, rows: &str| {
        format!("ply\nformat ascii 1.0\n{header}end_header\n{rows}").into_bytes()
    };
    let edges = "element edge 1\nproperty int vertex1\nproperty int vertex2\n";
    let strand = "element strand 1\nproperty int nsegs\n";
    let list = "element line 1\nproperty list int int vertex_indices\n";
    let cut = |mut file: Vec<u8>| {
        file.pop();
        file
    };
    let huge = |name: usize| [number(3), number(name)].concat();
    let cases = [
        (
            "a.data",
            cut(counted(&lines(), &[])),
            "strand 2 must end by byte 123, the file's end, got 124",
        ),
        ("a.bin", huge(1 << 30), "strand 0 must end by byte 8"),
        (
            "a.data",
            number(0).to_vec(),
            "byte 0: there must be a strand, got 0",
        ),
        (
            "a.data",
            vec![1, 0],
            "byte 2: the header has 4 bytes, got 2",
        ),
        (
            "a.data",
            counted(&vec![vec![[0.0, 2e6, 0.0]; 2]], &[]),
            "byte 12: coordinates must be finite and at most 1e6",
        ),
        (
            "a.hair",
            cut(monohair(&lines())),
            "byte 121: the file must have at least 122 bytes, got 121",
        ),
        ("a.hair", cut(mitsuba_binary(&lines())), "at least"),
        (
            "a.txt",
            b"0 0 0 1\n0 1 0\n".to_vec(),
            "byte 8: every line must have 4 numbers, as the first has, got \"0 1 0\"",
        ),
        (
            "a.txt",
            b"0 0 0 1\n0 1 zero 1\n".to_vec(),
            "byte 8: a line must have numbers: x y z radius, got \"0 1 zero 1\"",
        ),
        (
            "a.txt",
            b"0 0 0 1\n0 nan 0 1\n".to_vec(),
            "byte 8: coordinates must be finite",
        ),
        (
            "a.txt",
            b"0 0 0 1\n0 1 0 -1\n".to_vec(),
            "byte 8: thickness must be finite and at least 0, got -1",
        ),
        (
            "a.txt",
            b"# nothing\n".to_vec(),
            "there must be a line of numbers",
        ),
        (
            "a.ply",
            b"ply\nformat ascii 1.0\n".to_vec(),
            "the header must end with a line \"end_header\"",
        ),
        (
            "a.ply",
            text(
                "element edge 1\nproperty int v1\nproperty int v2\nelement vertex 999999999999\nproperty float x\n\
                 property float y\nproperty float z\n",
                "0 1\n0 0 0\n",
            ),
            "the 999999999999 rows of `vertex` must fit in what follows the header, got 10 bytes",
        ),
        ("a.ply", text("", ""), "an element `vertex` with x, y and z"),
        (
            "a.ply",
            text("propert y\n", ""),
            "byte 21: a line of the header must begin with a keyword of PLY, got \"propert y\"",
        ),
        (
            "a.ply",
            text(vertex, "0 0 0\n0 1 0\n"),
            "strands must have a count, a list of vertices or edges each, got elements vertex",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{edges}"), "0 0 0\n0 1\n0 1"),
            "row 1 of the 2 of `vertex` is too short",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{edges}"), "0 0 0 0\n0 1 0\n0 1"),
            "row 0 of the 2 of `vertex` has 1 numbers too many",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{edges}"), "0 0 x\n0 1 0\n0 1"),
            "row 0 of the 2 of `vertex` must have numbers, got \"x\"",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{edges}"), "0 0 0\n0 1 0\n"),
            "row 0 of the 1 of `edge` is missing",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{edges}"), "0 0 0\n0 1 0\n0 2"),
            "numbers of vertices must be whole and below 2, got 2",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{edges}"), "0 0 0\n0 1 0\n0 .5"),
            "numbers of vertices must be whole and below 2, got 0.5",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{strand}"), "0 0 0\n0 1 0\n0"),
            "strands need 1 points, got 2",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{strand}"), "0 0 0\n0 1 0\n2"),
            "strands need 3 points, got 2",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{list}"), "0 0 0\n0 1 0\n-1"),
            "has a list of -1 numbers",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{list}"), "0 0 0\n0 1 0\n1e9"),
            "has a list of 1000000000 numbers",
        ),
        (
            "a.ply",
            text(&format!("{vertex}{list}"), "0 0 inf\n0 1 0\n2 0 1"),
            "coordinates must be finite and at most 1e6, got inf",
        ),
    ];
    for (name, file, expected) in cases {
        let error = import_bytes(Path::new(name), &file, &STRAIGHT)
            .expect_err(expected)
            .to_string();
        assert!(
            error.starts_with(name) && error.contains(expected) && !error.contains('\n'),
            "{error} for {expected}"
        );
    }
    let mesh = text(
        &format!("{vertex}element face 0\nproperty list uchar int vertex_indices\n"),
        "0 0 0\n0 1 0\n",
    );
    let error = read("a.ply", &mesh, &STRAIGHT)
        .expect_err("a mesh")
        .to_string();
    assert!(
        error.contains("vertex, face; a mesh is for --head"),
        "{error}"
    );
}
