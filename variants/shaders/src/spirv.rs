//! SPIR-V, which can say that arithmetic keeps its order.

use crate::print::{Language, driver, print};
use crate::program::Program;
use naga::back::spv;
use naga::front::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Checks a module of WGSL, and translates it.
///
/// # Errors
///
/// In words, if naga rejects it.
pub fn translate(source: &str) -> Result<Vec<u32>, String> {
    let module = wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string(source))?;
    let options = spv::Options::default();
    spv::write_vec(&module, &info, &options, None).map_err(|error| error.to_string())
}

/// A compute shader per function of the program, which compilers may not rearrange: see [`driver`].
///
/// # Errors
///
/// In words, if naga rejects the program.
pub fn module(program: &Program) -> Result<Vec<u32>, String> {
    let mut source = print(program, Language::Wgsl);
    source += &driver(program, Language::Wgsl);
    let mut words = translate(&source)?;
    keep_order(&mut words);
    Ok(words)
}

/// Words before the first instruction.
const HEADER: usize = 5;
const OP_DECORATE: u32 = 71;
const OP_MEMBER_DECORATE: u32 = 72;
const NO_CONTRACTION: u32 = 42;
/// `OpFNegate`, `OpFAdd`, `OpFSub`, `OpFMul`, `OpFDiv`.
const ARITHMETIC: [u32; 5] = [127, 129, 131, 133, 136];

/// Adds the decoration `NoContraction` to every arithmetic instruction: its result is that of the instruction alone. Drivers
/// then neither fuse nor reassociate.
pub fn keep_order(words: &mut Vec<u32>) {
    let (mut at, mut end, mut decorations) = (HEADER, HEADER, Vec::new());
    while at < words.len() {
        let (op, len) = (words[at] & 0xffff, (words[at] >> 16) as usize);
        if op == OP_DECORATE || op == OP_MEMBER_DECORATE {
            end = at + len;
        }
        if ARITHMETIC.contains(&op) {
            decorations.extend([3 << 16 | OP_DECORATE, words[at + 2], NO_CONTRACTION]);
        }
        at += len.max(1);
    }
    words.splice(end..end, decorations);
}
