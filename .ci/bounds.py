#!/usr/bin/env python3
"""What bounds each entry point, by llvm-mca on its instructions: bounds.py PROGRAM [CPU]

PROGRAM is the program `entry` built with -Csymbol-mangling-version=v0. A packet is a straight line: the whole function
is simulated, first a hundred calls one after another that do not wait for each other (throughput), then one alone
(latency). Of slices it is the main loop, one turn of which is two packets. Prints instructions, micro-operations, the
cycles that the fullest port needs, the cycles a call takes in a row of calls, and the cycles that one call takes alone.
The last column says what bounds a row of calls: ports where the fullest is busy 85% of the time, latency where it is not
for 65% (the chain of a call is longer than what the scheduler sees of the next one).
"""
import re
import subprocess
import sys

from sizes import entry, symbols, tool


def code(program, address, size):
    """Address and text of each instruction."""
    span = (f"--start-address={address}", f"--stop-address={address + size}")
    out = tool("objdump", "-d", "--no-show-raw-insn", *span, program)
    found = re.findall(r"^ *([0-9a-f]+):\t(.*)$", out, re.M)
    return [(int(at, 16), re.sub(r" *(#|<).*", "", text).strip()) for at, text in found]


def main_loop(lines):
    """The longest stretch that a jump goes back over; the whole code if there is none."""
    best = (0, None, None)
    for at, text in lines:
        jump = re.match(r"j\w+ +([0-9a-f]+)$", text)
        if jump and int(jump[1], 16) <= at and at - int(jump[1], 16) > best[0]:
            best = (at - int(jump[1], 16), int(jump[1], 16), at)
    return [line for line in lines if best[1] <= line[0] <= best[2]] if best[1] is not None else lines


def simulate(lines, cpu, iterations):
    # Leave out jumps and returns, which are not simulated, and the padding after a function.
    text = "\n".join(t for _, t in lines if not re.match(r"(j\w+|ret|int3|nop\w*|call)\b", t))
    words = ["llvm-mca", f"-mcpu={cpu}", f"-iterations={iterations}", "-instruction-info=false"]
    out = subprocess.run(words, input=text, check=True, capture_output=True, text=True).stdout
    number = lambda key: float(re.search(rf"{key}: *([0-9.]+)", out)[1])
    ports = re.search(r"Resource pressure per iteration:\n(.*)\n(.*)", out)
    pressure = dict(zip(re.findall(r"\[([\d.]+)\]", ports[1]), ports[2].split()))
    names = dict(re.findall(r"^\[([\d.]+)\] +- (\S+)", out, re.M))
    port, full = max(((names[i], float(p)) for i, p in pressure.items() if p != "-"), key=lambda x: x[1])
    instructions, uops, cycles = (number(key) / iterations for key in ("Instructions", "Total uOps", "Total Cycles"))
    return instructions, uops, port, full, cycles


def main():
    program, cpu = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "icelake-server"
    table = symbols(program)
    rows = []
    for address, (name, size) in table.items():
        key = entry(name)
        if key is None or key[2] not in ("portable", "avx2", "avx512"):
            continue
        lines = code(program, address, size)
        if "batch" in key[0]:
            lines = main_loop(lines)
        many, one = simulate(lines, cpu, 100), simulate(lines, cpu, 1)
        lanes = {"portable": 8, "avx2": 16, "avx512": 32}[key[2]] if "batch" in key[0] else 8
        share = many[3] / many[4]
        bound = "ports" if share > 0.85 else "ports and latency" if share > 0.65 else "latency"
        instructions, uops, port, *cycles = many
        whole = [f"{x:.0f}" for x in (instructions, uops, *cycles, one[4])]
        rows.append((*key, lanes, *whole[:2], port, *whole[2:], bound))
    print("entry,model,level,lanes,instructions,uops,fullest_port,port_cycles,cycles,cycles_alone,bound")
    for row in sorted(rows):
        print(",".join(map(str, row)))


if __name__ == "__main__":
    main()
