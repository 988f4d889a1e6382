#!/usr/bin/env python3
"""Bytes and calls of every entry point in builds of the program `entry`: sizes.py OPT_LEVEL=PROGRAM...

Prints a table as CSV. Fails if an entry point of AVX2 or AVX-512 contains a call, in any of the builds: whatever the
optimisation level, the kernel is inlined whole, but for COPIES. Those of the portable level go through `wide`, and are shown.
"""
import re
import subprocess
import sys

# Kernels of slices, and of packets of eight.
ROWS = {
    "ValuePdf": "eval_columns",
    "Pdf": "eval_columns-pdf",
    "Samples": "sample_columns",
    "Proposed": "propose_columns",
    "Weighs": "weigh_columns",
    "HitEvals": "eval_hits",
    "HitSamples": "sample_hits",
}
PACKETS = {
    "Prepare": ("prepare8-shared", "prepare8-mixed"),
    "EvalPdf": ("eval_pdf8", "eval_pdf8-points"),
    "SampleWi": ("sample8", "sample8-points"),
    "ProposalsOf": ("propose8-points",) * 2,
    "WeighOf": ("weigh8-points",) * 2,
}
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
    for wrapper in ("matched", "conserving"):
        if f"::{wrapper.title()}<" in name:
            model += f"-{wrapper}"
    found = re.search(r"dispatch::(pairs|eight)_(avx\w+)::<.*kernels::(\w+)(?:<.*>)?>?, \d+, \d+>$", name)
    if found:
        return ROWS[found[3]] + ("-eight" if found[1] == "eight" else ""), model, found[2]
    found = re.search(r"dispatch::run_(avx\w+)::<[\w:]*kernels::(\w+)<", name)
    if found and found[2] in PACKETS:
        return PACKETS[found[2]]["f32x8" in name], model, found[1]
    found = re.search(r"outlined::(scalar|portable)_(\w+?)(?:_(shared|mixed|points))?::<", name)
    if found and "batch" not in found[2]:
        return (f"{found[2]}-{found[3]}" if found[3] else found[2]), model, found[1]
    return None

# Calls at "s" by slices of hits that prepare a matched sampler: copies of parts of its constants, for eight or sixteen hits each.
COPIES = 7


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
            allowed = COPIES if build == "s" and model.endswith("-matched-conserving") else 0
            if level.startswith("avx") and calls > allowed:
                print(f"FAIL {name} of {model} on {level} at opt-level {build}: {calls} calls", file=sys.stderr)
                failed += 1
    if len(rows) < 120:
        print(f"FAIL only {len(rows)} entry points were found", file=sys.stderr)
        failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
