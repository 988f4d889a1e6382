//! Writes to a folder what the C interface must answer: `layout.c`, assertions on structs and constants, and `answers.bin`, the
//! inputs and answers of Rust's typed handles for every model, preset and energy, which `bits.c` reads in order.

mod answers;
// The structs themselves: a copy would prove nothing.
#[path = "../../../variants/capi/src/layout.rs"]
mod layout;

use std::fmt::Write;
use std::path::Path;

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).expect("usage: hairis-hosts FOLDER");
    let folder = Path::new(&folder);
    std::fs::write(folder.join("layout.c"), layout_c())?;
    std::fs::write(folder.join("answers.bin"), answers::all())
}

/// Assertions that the header has Rust's structs and constants.
fn layout_c() -> String {
    let mut text = String::from("#include \"hairis.h\"\n");
    let mut check = |condition: String| {
        writeln!(text, "_Static_assert({condition}, \"{condition}\");").expect("memory");
    };
    for (name, value) in layout::CONSTANTS {
        check(format!("{name} == {value}"));
    }
    for one in layout::LAYOUTS {
        let name = one.name;
        check(format!("sizeof({name}) == {}", one.size));
        check(format!("_Alignof({name}) == {}", one.align));
        for (field, offset, size) in one.fields {
            check(format!("offsetof({name}, {field}) == {offset}"));
            check(format!("sizeof((({name} *)0)->{field}) == {size}"));
        }
    }
    text
}
