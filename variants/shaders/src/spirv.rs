//! SPIR-V modules, which can require that arithmetic keeps its order.

use crate::print::{Language, driver, print};
use crate::program::Program;
use hairis::simd::trace::Target;
use naga::back::spv;
use naga::front::wgsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Validates a WGSL module, and translates it to SPIR-V.
///
/// # Errors
///
/// Returns naga's message if naga rejects the module.
pub fn translate(source: &str) -> Result<Vec<u32>, String> {
    let module = wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string(source))?;
    let options = spv::Options::default();
    spv::write_vec(&module, &info, &options, None).map_err(|error| error.to_string())
}

/// Makes a SPIR-V module with one compute shader per function of the program, whose arithmetic compilers may not rearrange. The buffers
/// are described at [`driver`].
///
/// With [`Target::Exact`] and [`Target::Fused`], results have the bits that these targets promise: the module requires [IEEE
/// arithmetic](keep_numbers), and square roots are corrected.
///
/// # Errors
///
/// Returns naga's message if naga rejects the program.
pub fn module(program: &Program) -> Result<Vec<u32>, String> {
    let mut source = print(program, Language::Wgsl);
    source += &driver(program, Language::Wgsl);
    if matches!(program.target(), Target::Gpu | Target::GpuNative) {
        let mut words = translate(&source)?;
        keep_order(&mut words);
        return Ok(words);
    }
    let mut words = translate(&(source.replace(" sqrt(", " hairis_sqrt(") + SQUARE_ROOT))?;
    keep_order(&mut words);
    keep_numbers(&mut words);
    Ok(words)
}

/// Correctly rounded square root, computed from one that is a unit in the last place off, as on GPUs. The rest `x - s^2` is exact, and it
/// exceeds `s` times the distance of a neighbour if that neighbour is nearer. Numbers are scaled so that no part of Dekker's product is
/// denormal.
const SQUARE_ROOT: &str = "
fn hairis_sqrt(a: f32) -> f32 {
    let up = a < 0x1p-40f;
    let down = a > 0x1p+40f;
    let x = a * select(select(1.0, 0x1p-80f, down), 0x1p+80f, up);
    let s = sqrt(x);
    let high = bitcast<f32>(bitcast<u32>(s) & 0xfffff000u);
    let low = s - high;
    let square = s * s;
    let rest = (x - square) - (((high * high - square) + high * low + low * high) + low * low);
    let above = bitcast<f32>(bitcast<u32>(s) + 1u);
    let below = bitcast<f32>(bitcast<u32>(s) - 1u);
    let nearest = select(select(s, above, rest > s * (above - s)), below, rest <= s * (below - s));
    let root = select(s, nearest, 0.0 < x && x < 0x1p+100f);
    return root * select(select(1.0, 0x1p+40f, down), 0x1p-40f, up);
}
";

/// Number of words before the first instruction of a module.
const HEADER: usize = 5;
const OP_EXTENSION: u32 = 10;
const OP_ENTRY_POINT: u32 = 15;
const OP_EXECUTION_MODE: u32 = 16;
const OP_CAPABILITY: u32 = 17;
const OP_DECORATE: u32 = 71;
const OP_MEMBER_DECORATE: u32 = 72;
const NO_CONTRACTION: u32 = 42;
/// Opcodes of `OpFNegate`, `OpFAdd`, `OpFSub`, `OpFMul` and `OpFDiv`.
const ARITHMETIC: [u32; 5] = [127, 129, 131, 133, 136];

/// Adds the decoration `NoContraction` to every arithmetic instruction, so that drivers neither fuse nor reassociate. Each instruction
/// then has the result that it would have alone.
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

/// Capabilities and execution modes of `DenormPreserve`, `SignedZeroInfNanPreserve` and `RoundingModeRTE`.
const CONTROLS: [[u32; 2]; 3] = [[4464, 4459], [4466, 4461], [4467, 4462]];

/// Requires IEEE arithmetic in every entry point. Denormals, NaN, infinity and the sign of 0 are kept, and results round to nearest, even
/// those of divisions on drivers that would otherwise approximate them.
///
/// The module then needs `SPV_KHR_float_controls`. By Vulkan's rules it also needs a device that reports `shaderDenormPreserveFloat32`,
/// `shaderSignedZeroInfNanPreserveFloat32` and `shaderRoundingModeRTEFloat32`.
pub fn keep_numbers(words: &mut Vec<u32>) {
    let mut out = words[..HEADER].to_vec();
    let (mut at, mut entry_points, mut is_named) = (HEADER, Vec::new(), false);
    for [capability, _] in CONTROLS {
        out.extend([2 << 16 | OP_CAPABILITY, capability]);
    }
    while at < words.len() {
        let (op, len) = (words[at] & 0xffff, (words[at] >> 16) as usize);
        if op != OP_CAPABILITY && !is_named {
            let (name, _) = b"SPV_KHR_float_controls\0\0".as_chunks::<4>();
            out.push(7 << 16 | OP_EXTENSION);
            out.extend(name.iter().map(|bytes| u32::from_le_bytes(*bytes)));
            is_named = true;
        }
        if op == OP_ENTRY_POINT {
            entry_points.push(words[at + 2]);
        } else {
            for entry_point in entry_points.drain(..) {
                for [_, mode] in CONTROLS {
                    out.extend([4 << 16 | OP_EXECUTION_MODE, entry_point, mode, 32]);
                }
            }
        }
        out.extend(&words[at..at + len.max(1)]);
        at += len.max(1);
    }
    *words = out;
}
