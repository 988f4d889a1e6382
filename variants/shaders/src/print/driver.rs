//! Entry points that run functions of a program over arrays of numbers.

use super::{Language, prefix, python, type_name};
use crate::function::{Argument, Function};
use crate::program::Program;

/// Returns the entry points for the functions of a program, to follow the text of [`print`](super::print) in one file. Each entry point
/// reads an array of floats, which holds the arguments of one call after the other, and writes an array of the results.
///
/// - WGSL: a compute shader per function, by the function's name, over buffers 0 (read) and 1 (written) of group 0; workgroups of 64.
/// - GLSL: `main` of the last function alone, over the same buffers of a Vulkan shader.
/// - Slang: a compute shader per function, over the same buffers, and for each function a second one, `NAME_backward`, which has the arguments and results of the function's
///   [gradient](Function::gradient), with the derivatives of Slang's compiler. Both buffers have room for a multiple of 64 calls.
/// - C: `main` takes the name of a function, reads standard input and writes standard output. Compiled as CUDA, it runs the function on
///   the GPU, one thread per call.
/// - Python: likewise with `NumPy`.
///
/// # Panics
///
/// Panics for HLSL and Metal, which have no driver, and for GLSL if the program has no function.
#[must_use]
pub fn driver(program: &Program, language: Language) -> String {
    match language {
        Language::C => c(program),
        Language::Wgsl => wgsl(program),
        Language::Glsl => glsl(program),
        Language::Slang => slang(program),
        Language::Python => python(program),
        Language::Hlsl | Language::Msl => panic!("no driver runs {language:?}"),
    }
}

/// Returns statements that read the arguments from `i * count` on, call the function, and write its result.
fn statements(program: &Program, language: Language, function: &Function) -> Vec<String> {
    let count = function.arguments().iter().map(Argument::len).sum();
    let mut lines = called(program, language, function, count);
    let places: Vec<_> = function.output().places().collect();
    lines.extend(stored("r", &places, 0, places.len()));
    lines
}

/// Returns statements that read the arguments from `i * count` on, and call the function.
fn called(program: &Program, language: Language, function: &Function, count: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut from = 0;
    let variable = |of: &str, name: &str| match language {
        Language::Wgsl => format!("var a_{name}: {of};"),
        _ => format!("{of} a_{name};"),
    };
    for argument in function.arguments() {
        let name = argument.name();
        let of = match argument {
            Argument::Record(_, record) => type_name(program, record),
            Argument::Field(field) => language.shape(field.shape).0,
        };
        lines.push(variable(&of, name));
        for place in argument.places() {
            lines.push(format!("a_{place} = inputs[i * {count}u + {from}u];"));
            from += 1;
        }
    }
    let names: Vec<_> = function
        .arguments()
        .iter()
        .map(|argument| format!("a_{}", argument.name()))
        .collect();
    let (prefix, output) = (prefix(program), function.output());
    let call = format!("{prefix}{}({})", function.name(), names.join(", "));
    lines.push(match language {
        Language::Wgsl => format!("let r = {call};"),
        _ => format!("{} r = {call};", type_name(program, output)),
    });
    lines
}

/// Returns statements that write these places of a variable to `i * count + first` and on.
fn stored(of: &str, places: &[String], first: usize, count: usize) -> Vec<String> {
    (first..)
        .zip(places)
        .map(|(to, place)| format!("outputs[i * {count}u + {to}u] = {of}.{place};"))
        .collect()
}

fn wgsl(program: &Program) -> String {
    let mut out = "@group(0) @binding(0) var<storage, read> inputs: array<f32>;\n\
                   @group(0) @binding(1) var<storage, read_write> outputs: array<f32>;\n"
        .to_owned();
    for function in program.functions() {
        let count: usize = function.arguments().iter().map(Argument::len).sum();
        let statements = statements(program, Language::Wgsl, function).join("\n    ");
        out += &format!(
            "\n@compute @workgroup_size(64) fn {}(@builtin(global_invocation_id) id: vec3<u32>) {{\n    let i = id.x;\n    \
             if i >= arrayLength(&inputs) / {count}u {{ return; }}\n    {statements}\n}}\n",
            function.name(),
        );
    }
    out
}

fn slang(program: &Program) -> String {
    let mut out =
        "StructuredBuffer<float> inputs;\nRWStructuredBuffer<float> outputs;\n".to_owned();
    for function in program.functions() {
        let mut entry = |name: &str, statements: Vec<String>| {
            let statements = statements.join("\n    ");
            out += &format!(
                "\n[shader(\"compute\")] [numthreads(64, 1, 1)] void {name}(uint3 id : SV_DispatchThreadID) {{\n    \
                 uint i = id.x;\n    {statements}\n}}\n"
            );
        };
        entry(
            function.name(),
            statements(program, Language::Slang, function),
        );
        let name = format!("{}_backward", function.name());
        entry(&name, backward(program, function));
    }
    out
}

/// Returns statements with the arguments and results of [`Function::gradient`], whose derivatives are those of Slang's compiler.
fn backward(program: &Program, function: &Function) -> Vec<String> {
    let (name, of) = (function.name(), type_name(program, function.output()));
    let places: Vec<_> = function.output().places().collect();
    let numbers: usize = function.arguments().iter().map(Argument::len).sum();
    let all = numbers + places.len();
    let mut lines = called(program, Language::Slang, function, all);
    lines.extend(stored("r", &places, 0, all));
    lines.push(format!("{of}.Differential w;"));
    let weights = (numbers..).zip(&places);
    lines.extend(weights.map(|(from, place)| format!("w.{place} = inputs[i * {all}u + {from}u];")));
    let (mut to, mut pairs, mut stores) = (places.len(), Vec::new(), Vec::new());
    for argument in function.arguments() {
        let argument_name = argument.name();
        lines.push(format!(
            "var d_{argument_name} = diffPair(a_{argument_name});"
        ));
        pairs.push(format!("d_{argument_name}"));
        for place in argument.places() {
            let (of, part) = place.split_at(argument_name.len());
            stores.push(format!("outputs[i * {all}u + {to}u] = d_{of}.d{part};"));
            to += 1;
        }
    }
    let pairs = pairs.join(", ");
    lines.push(format!("bwd_diff({}{name})({pairs}, w);", prefix(program)));
    lines.extend(stores);
    lines
}

fn glsl(program: &Program) -> String {
    let function = program
        .functions()
        .last()
        .expect("a program has a function");
    let count: usize = function.arguments().iter().map(Argument::len).sum();
    let statements = statements(program, Language::Glsl, function).join("\n    ");
    format!(
        "layout(local_size_x = 64) in;\nlayout(std430, set = 0, binding = 0) readonly buffer Inputs {{ float inputs[]; }};\n\
         layout(std430, set = 0, binding = 1) buffer Outputs {{ float outputs[]; }};\n\
         void main() {{\n    uint i = gl_GlobalInvocationID.x;\n    if (i >= inputs.length() / {count}u) return;\n    \
         {statements}\n}}\n"
    )
}

/// Macros that run a function over all calls: on threads of a GPU, one per call, or in a loop.
const C_HEAD: &str = "\
#include <stdio.h>
#include <stdlib.h>
#if defined(__CUDACC__)
#define RUN static __global__ void
#define EACH(i, n) const unsigned i = blockIdx.x * blockDim.x + threadIdx.x; if (i < n)
#else
#define RUN static void
#define EACH(i, n) for (unsigned i = 0; i < n; i++)
#endif
";

/// End of `main`, after `run` and the counts of numbers `in` and `out` are set.
const C_MAIN: &str = "    \
    if (!run) return 2;
    for (;;) {
        n += fread(inputs + n, sizeof(float), room - n, stdin);
        if (n < room) break;
        inputs = (float *)realloc(inputs, (room *= 2) * sizeof(float));
    }
    n /= in;
    outputs = (float *)malloc(n * out * sizeof(float));
#if defined(__CUDACC__)
    float *at[2];
    cudaMalloc(&at[0], n * in * sizeof(float));
    cudaMalloc(&at[1], n * out * sizeof(float));
    cudaMemcpy(at[0], inputs, n * in * sizeof(float), cudaMemcpyHostToDevice);
    run<<<(unsigned)((n + 63) / 64), 64>>>(at[0], at[1], (unsigned)n);
    cudaMemcpy(outputs, at[1], n * out * sizeof(float), cudaMemcpyDeviceToHost);
    const cudaError_t error = cudaGetLastError();
    if (error) {
        fprintf(stderr, \"%s\\n\", cudaGetErrorString(error));
        return 1;
    }
#else
    run(inputs, outputs, (unsigned)n);
#endif
    return fwrite(outputs, sizeof(float), n * out, stdout) != n * out;
}
";

fn c(program: &Program) -> String {
    let (mut out, mut calls) = (C_HEAD.to_owned(), String::new());
    for function in program.functions() {
        let name = function.name();
        let count: usize = function.arguments().iter().map(Argument::len).sum();
        let statements = statements(program, Language::C, function).join("\n        ");
        out += &format!(
            "RUN run_{name}(const float *inputs, float *outputs, unsigned n) {{\n    \
             EACH(i, n) {{\n        {statements}\n    }}\n}}\n"
        );
        calls += &format!(
            "    if (!strcmp(argv[1], \"{name}\")) {{ run = run_{name}; in = {count}; out = {}; }}\n",
            function.output().len()
        );
    }
    out + &format!(
        "int main(int argc, char **argv) {{\n    void (*run)(const float *, float *, unsigned) = 0;\n    \
         size_t in = 0, out = 0, n = 0, room = 1u << 20;\n    \
         float *inputs = (float *)malloc(room * sizeof(float)), *outputs;\n    if (argc < 2) return 2;\n{calls}{C_MAIN}"
    )
}

/// End of the driver in Python, after `CALLS` has the function of a name and the forms of its arguments.
const PYTHON_MAIN: &str = "

def _flat(value: Any) -> Iterator[Any]:
    for entry in value:
        yield from _flat(entry) if isinstance(entry, tuple) else [entry]


if __name__ == \"__main__\":
    import sys

    import numpy

    call, forms = CALLS[sys.argv[1]]
    sizes = [size for form in forms for size in (_SIZES[form] if isinstance(form, type) else (form,))]
    inputs = numpy.frombuffer(sys.stdin.buffer.read(), numpy.float32)
    numbers = iter(inputs.reshape(-1, sum(max(size, 1) for size in sizes)).T)
    results = call(*(_make(form, numbers) for form in forms))
    sys.stdout.buffer.write(numpy.stack(list(_flat(results)), axis=-1).tobytes())
";

fn python(program: &Program) -> String {
    let mut out = "\n\nCALLS: dict[str, Any] = {\n".to_owned();
    for function in program.functions() {
        let forms: String = (function.arguments().iter())
            .map(|argument| python::form(argument) + ", ")
            .collect();
        let name = function.name();
        out += &format!("    \"{name}\": ({name}, ({forms})),\n");
    }
    out + "}\n" + PYTHON_MAIN
}
