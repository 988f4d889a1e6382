//! Lines of text in files of hair: comments, ends of lines, and a sentence for each fault.

use super::{STRAIGHT, read};

/// Returns the sentence that refuses the file, without the name and the byte.
fn refusal(name: &str, file: &str) -> String {
    let error = read(name, file.as_bytes(), &STRAIGHT).expect_err(file);
    error.problem.to_string()
}

#[test]
fn comments_stand_behind_data() {
    let plain = "0 0 0 .1\n0 9 0 .1\n\n1 0 0 .1\n1 9 0 .1\n";
    let strands = read("a.txt", plain.as_bytes(), &STRAIGHT)
        .expect("read")
        .strands;
    let latin = plain.replace('\n', " # b\u{fc}rste\n");
    let latin = latin.chars().map(|c| u8::try_from(c).expect("Latin-1"));
    for file in [
        plain.replace(".1\n", ".1 # node\n").into_bytes(),
        plain.replace(".1\n", ".1# 5\r\n").into_bytes(),
        plain
            .replace("\n\n", "\r\t# next\r")
            .replace('\n', "\r")
            .into_bytes(),
        format!("\u{feff}# hair\n{plain}").into_bytes(),
        latin.collect(),
    ] {
        let hair = read("a.txt", &file, &STRAIGHT).expect("comments are ignored");
        assert_eq!(hair.strands, strands, "{}", file.escape_ascii());
    }
}

#[test]
fn each_fault_of_mitsuba_text_has_its_own_sentence() {
    for (line, problem) in [
        ("0 1", "a line must have three or four numbers"),
        ("0 1 2 3 4", "a line must have three or four numbers"),
        ("0 1 0", "every line must have 4 numbers, as the first has"),
        ("0 1 0 x", "a line must have numbers: x y z radius"),
    ] {
        let file = format!("0 0 0 1 # root\n{line} # tip\n");
        assert_eq!(refusal("a.txt", &file), format!("{problem}, got {line:?}"));
    }
    let long = refusal("a.txt", &format!("0 0 0\n{}", "x".repeat(999)));
    assert!(long.len() < 120, "{long}");
}

#[test]
fn each_fault_of_a_header_of_ply_has_its_own_sentence() {
    for (line, problem) in [
        (
            "format text 1.0",
            "the format must be ascii, binary_little_endian or binary_big_endian",
        ),
        (
            "format",
            "a line of the header must begin with a keyword of PLY",
        ),
        (
            "vertex 3",
            "a line of the header must begin with a keyword of PLY",
        ),
        ("property float x", "a property must be below an element"),
        ("element vertex", "an element must have a name and a count"),
        (
            "element vertex -1",
            "an element must have a name and a count",
        ),
        (
            "property int64 x",
            "the type of a property must be char, uchar, short, ushort, int, uint, float or double",
        ),
        (
            "property list uchar half x",
            "the type of a property must be char, uchar, short, ushort, int, uint, float or double",
        ),
        (
            "property float",
            "a property must have a type and a name, or `list`, two types and a name",
        ),
    ] {
        assert_eq!(
            refusal("a.ply", &format!("ply\n{line}\n")),
            format!("{problem}, got {line:?}")
        );
    }
}

#[test]
fn counts_of_strands_are_not_numbers_of_vertices() {
    let file = |count: &str| {
        format!(
            "ply\nformat ascii\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
             element strand 1\nproperty float nsegs\nend_header\n0 0 0\n0 1 0\n{count}\n"
        )
    };
    read("a.ply", file("1").as_bytes(), &STRAIGHT).expect("a version is not needed");
    let marked = format!("\u{feff}{}", file("1"));
    read("a.ply", marked.as_bytes(), &STRAIGHT).expect("a mark is not of the text");
    assert_eq!(
        refusal("a.ply", &file("9")),
        "strands need 10 points, got 2"
    );
    for count in ["1.5", "-1", "NaN", "1e12"] {
        let number: f64 = count.parse().expect("a number");
        let problem = "the count of a strand must be whole and below 2^32";
        assert_eq!(
            refusal("a.ply", &file(count)),
            format!("{problem}, got {number}")
        );
    }
}
