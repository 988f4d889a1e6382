#!/usr/bin/env python3
"""Bytes and calls of every entry point in builds of the program `entry`: sizes.py OPT_LEVEL=PROGRAM...

Prints a table as CSV. Fails if an entry point of AVX2 or AVX-512 contains a call, in any of the builds: whatever the
optimisation level, the kernel is inlined whole. At "s" two models call memset or memcpy, see COPIES. Those of the
portable level go through `wide`, and are shown.
"""
import re
import subprocess
import sys

ROWS = {
    "ValuePdf": "eval_columns",
    "Pdf": "eval_columns-pdf",
    "Samples": "sample_columns",
    "Proposed": "propose_columns",
}
PACKETS = {
    "Prepare": ("prepare8", "shared", "mixed"),
    "EvalPdf": ("eval_pdf8", "", "points"),
    "SampleWi": ("sample8", "", "points"),
}
# Weights of candidates, and packets of eight hits: the model is their only parameter.
OF_MODEL = {"Weighs": "weigh_columns", "ProposalsOf": "propose8-points", "WeighOf": "weigh8-points"}
MODELS = {
    "Chiang": "chiang",
    "DEon": "d-eon",
    "KajiyaKay": "kajiya-kay",
    "Gaussian": "gaussian",
    "Cauchy": "cauchy",
}


def tool(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def symbols(program):
    """Address to (name, bytes)."""
    out = {}
    for line in tool("nm", "-S", "-C", "--defined-only", program).splitlines():
        found = re.match(r"([0-9a-f]+) ([0-9a-f]+) [tT] (.*)", line)
        if found:
            out[int(found[1], 16)] = (found[3], int(found[2], 16))
    return out


def entry(name):
    """Entry point, model and level of a function, or None."""
    model = next((MODELS[m] for m in MODELS if re.search(rf"\b{m}(?![\w<])", name)), None)
    if model is None:
        return None
    if "::Matched<" in name:
        model += "-matched"
    found = re.search(r"dispatch::(rows|eights)_(avx\w+|portable)::<.*kernels::(\w+)>, \d+, \d+>$", name)
    if found and found[3] in ROWS:
        return ROWS[found[3]] + ("-eights" if found[1] == "eights" else ""), model, found[2]
    found = re.search(r"dispatch::(rows|eights|run)_(avx\w+|portable)::<hairis::resample::kernels::(\w+)<.*>(?:, \d+, \d+)?>$", name)
    if found and found[3] in OF_MODEL:
        return OF_MODEL[found[3]] + ("-eights" if found[1] == "eights" else ""), model, found[2]
    found = re.search(r"dispatch::run_(avx\w+)::<hairis::handle::kernels::(\w+)<.*?, (f32|wide::[\w:]+)(?:, .*)?>>$", name)
    if found and found[2] in PACKETS:
        base, shared, own = PACKETS[found[2]]
        suffix = shared if found[3] == "f32" else own
        return (f"{base}-{suffix}" if suffix else base), model, found[1]
    found = re.search(r"outlined::(scalar|portable)_(\w+?)(?:_(shared|mixed|points))?::<", name)
    if found and "batch" not in found[2]:
        return (f"{found[2]}-{found[3]}" if found[3] else found[2]), model, found[1]
    return None

# Calls of memset and memcpy that the compiler makes of buffers and shading points: by opt-level and model, at most.
# Since the constants of a material are spread field by field, prepare8 copies those of its sampler at "s".
COPIES = {
    ("s", "kajiya-kay"): 1,
    ("s", "chiang"): 2,
    ("s", "gaussian"): 1,
    ("s", "gaussian-matched"): 1,
    ("s", "cauchy"): 1,
    ("s", "cauchy-matched"): 1,
}


def body(program, table, address):
    """Bytes and calls of a function, or of the one that it does nothing but call."""
    while True:
        name, size = table[address]
        span = (f"--start-address={address}", f"--stop-address={address + size}")
        code = tool("objdump", "-d", "--no-show-raw-insn", *span, program)
        further = [int(to, 16) for to in re.findall(r"\t(?:jmp|call) +([0-9a-f]+) ", code)]
        if size > 64 or not further or further[-1] not in table:
            return size, len(re.findall(r"\tcall ", code))
        address = further[-1]


def main():
    builds = dict(word.split("=", 1) for word in sys.argv[1:])
    rows = {}
    for level, program in builds.items():
        table = symbols(program)
        for address, (name, _) in table.items():
            key = entry(name)
            if key:
                rows.setdefault(key, {})[level] = body(program, table, address)
    print("entry,model,level," + ",".join(f"bytes_{b},calls_{b}" for b in builds))
    failed = 0
    for (name, model, level), found in sorted(rows.items()):
        # Functions of both models that are equal are one, under either name.
        cells = [",".join(map(str, found[b])) if b in found else "," for b in builds]
        print(f"{name},{model},{level}," + ",".join(cells))
        for build, (_, calls) in found.items():
            if level.startswith("avx") and calls > COPIES.get((build, model), 0):
                print(f"FAIL {name} of {model} on {level} at opt-level {build}: {calls} calls", file=sys.stderr)
                failed += 1
    if len(rows) < 40:
        print(f"FAIL only {len(rows)} entry points were found", file=sys.stderr)
        failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
