#!/usr/bin/env python3
"""Promise: tables with figures in Markdown files are those of their records. A table stands between the marks
`<!-- table NAME: written by .ci/tables.py --write -->` and `<!-- end of table -->`, below a line that names record, machine,
commit and date. `tables.py` fails where a table differs from its record, `tables.py --write` writes it anew."""

import csv
import os
import re
import statistics
import subprocess
import sys

RECORDS = "benches/records/"
LEVELS = {"wide (sse2)": "SSE2", "portable": "SSE2", "avx2+fma": "AVX2", "avx512": "AVX-512"}


class Record:
    """A record: facts of its first lines, and its rows."""

    def __init__(self, name):
        self.name = name
        lines = open(RECORDS + name, encoding="utf-8").read().splitlines()
        self.notes = [line[2:] for line in lines if line.startswith("# ")]
        self.rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        if not self.rows:
            sys.exit(f"{RECORDS}{name} must have rows, got none; measure it again")

    def fact(self, word):
        """What follows a word in the first lines."""
        found = [note.split(": ", 1)[1] for note in self.notes if note.startswith(word + ": ")]
        if word == "date":
            # Records of a machine have it in their names.
            found += re.findall(r"\d{4}-\d\d-\d\d", self.name)
        if not found:
            sys.exit(f"{RECORDS}{self.name} must name its {word} in its first lines, as `# {word}: ...`")
        return found[0]

    def caption(self, directory):
        """Record, machine, commit and date."""
        link = os.path.relpath(RECORDS + self.name, directory)
        processor = "GPU" if any(note.startswith("GPU: ") for note in self.notes) else "CPU"
        if self.fact(processor) == "any":
            return f"*[Record]({link}), which a test writes and holds.*"
        machine = re.sub(r"\((R|TM)\)", "", self.fact(processor))
        facts = f"{machine}, commit {self.fact('commit')[:7]}, {self.fact('date')}"
        return f"*[Record]({link}) of {facts}.*"


def lines_of(header, rows):
    """A table in Markdown."""
    line = lambda cells: "| " + " | ".join(cells) + " |"
    return [line(header).replace("|  |", "| |", 1), "|" + "---|" * len(header), *map(line, rows)]


def three(x):
    """A number with three digits, without zeros at its end."""
    return f"{x:.3g}"


def ratio_of_hand(record, task, call, level):
    """Median ratio of the runs, with their range where it is above 3%."""
    ratios = [float(row["ratio"]) for row in record.rows
              if (row["task"], row["call"], LEVELS[row["level"]]) == (task, call, level)]
    if not ratios:
        sys.exit(f"{record.name} has no row {task}, {call}, {level}")
    low, high = min(ratios), max(ratios)
    text = f"{statistics.median(ratios):.2f}"
    return text if high <= 1.03 * low else f"{text} ({low:.2f} to {high:.2f})"


def hand_table(goals, rows, words):
    record = Record("hand.csv")
    levels = ["SSE2", "AVX2", "AVX-512"]
    body = [[words(task, call), goals[call, task] if (call, task) in goals else goals[call],
             *(ratio_of_hand(record, task, call, level) for level in levels)] for task, call in rows]
    return record, ["", "goal", *levels], body


def hand():
    """Our calls over kernels written by hand."""
    tasks = {"eval-gaussian": "eval + pdf, Gaussian", "eval-cauchy": "eval + pdf, Cauchy", "sample-gaussian": "sample, Gaussian"}
    goals = {"slices": "1.05", ("slices", "sample-gaussian"): "1.15", "fresh packets": "1.25", "slices of eight": "1.5"}
    rows = [(task, call) for call in ("slices", "fresh packets", "slices of eight") for task in tasks]
    return hand_table(goals, rows, lambda task, call: f"{call}: {tasks[task]}")


def hits():
    """Slices of hits over slices of one hit."""
    calls = {"hits: eval": "eval + pdf", "hits: sample": "sample"}
    goals = {("hits: eval", "published"): "2.7", ("hits: sample", "published"): "2.4",
             ("hits: eval", "matched"): "7.6", ("hits: sample", "matched"): "6.6"}
    rows = [(task, call) for task in ("published", "matched") for call in calls]
    record, header, body = hand_table(goals, rows, lambda task, call: f"{task}: {calls[call]}")
    return record, ["", "goal, AVX2", *header[2:]], body


def in_runs(record):
    """Median over the runs of time and ratio, by model, call and level."""
    cells = {}
    for row in record.rows:
        cells.setdefault((row["model"], row["call"], LEVELS.get(row["level"], row["level"])), []).append(row)
    median = lambda rows, column: statistics.median(float(row[column]) for row in rows)
    return {key: f"{three(median(rows, 'ns'))}, **{median(rows, 'ratio'):.2f}**" for key, rows in cells.items()}


def conserving():
    """What energy conservation and several materials cost over hits: ns per hit, and the ratio."""
    record = Record("hits.csv")
    cells = in_runs(record)
    calls = ["eval_hits: Conserving over raw", "sample_hits: Conserving over raw", "packets of one material: Conserving over raw",
             "packets of eight materials: Conserving over raw", "prepare8 of one material: Conserving over raw",
             "prepare8 of eight materials: Conserving over raw", "eval_hits of six materials: Conserving over raw",
             "eval_sample_hits over both calls", "eval_sample_hits over both calls: Conserving",
             "eval_hits of six materials over one", "eval_hits by references over a table"]
    models = {"gaussian": "published", "gaussian-matched": "matched"}
    levels = ["SSE2", "AVX2", "AVX-512"]
    rows = [[f"{call}, {word}", *(cells[model, call, level] for level in levels)]
            for call in calls for model, word in models.items()]
    return record, ["Gaussian", *levels], rows


def one_lane():
    """What energy conservation costs one hit, and what one call saves: ns, and the ratio; of a material µs."""
    record = Record("hits.csv")
    cells = in_runs(record)
    models = {"gaussian": "Gaussian", "gaussian-matched": "Gaussian, matched", "cauchy": "Cauchy", "cauchy-matched": "Cauchy, matched"}
    calls = ["eval_hit: Conserving over raw", "sample_hit: Conserving over raw", "prepare: Conserving over raw",
             "eval_hit over prepare and eval_pdf", "sample_hit over prepare and sample"]
    rows = [[call, *(cells[model, call, "one lane"] for model in models)] for call in calls]
    made = lambda model: statistics.median(float(row["ns"]) for row in record.rows if (row["model"], row["call"]) == (model, "new"))
    rows.append(["a material with `Conserving`", *(f"{made(model) / 1000:.0f} µs" for model in models)])
    return record, ["", *models.values()], rows


def capi():
    """Calls of the C library over those of Rust: median ratios of raw and conserving materials."""
    record = Record("capi.csv")
    ratios = {}
    for row in record.rows:
        ratios.setdefault((row["call"], row["model"].strip(), row["energy"]), []).append(float(row["ratio"]))
    goals = {"eval_pdf": ".86 to 1.14", "sample": ".86 to 1.14", "eval_columns": ".93 to 1.07", "sample_columns": ".93 to 1.07",
             "eval_hits": ".93 to 1.07", "sample_hits": ".93 to 1.07", "prepare and eval_pdf": "1.25", "prepare and sample": "1.25",
             "eval_hits of eight": "1.5", "sample_hits of eight": "1.5",
             "eval_hits of a table": "1.2", "eval_hits of a sorted table": "1.15"}
    models = {"gaussian published": "Gaussian", "gaussian matched": "Gaussian, matched", "cauchy matched": "Cauchy, matched",
              "kajiya-kay": "Kajiya-Kay", "chiang mean": "Chiang"}
    cell = lambda call, model: ", ".join(f"{statistics.median(ratios[call, model, energy]):.2f}" for energy in ("raw", "conserving"))
    calls = dict.fromkeys(row["call"] for row in record.rows)
    rows = [[call, goals.get(call, "-"), *(cell(call, model) for model in models)] for call in calls]
    return record, ["raw, conserving", "goal", *models.values()], rows


def gradients():
    """Derivatives of slices of hits over their values: ns per hit, and the ratio."""
    record = Record("gradients.csv")
    cells = in_runs(record)
    models = {"Gaussian": "Gaussian", "GaussianMatched": "Gaussian, matched", "Cauchy": "Cauchy", "CauchyMatched": "Cauchy, matched", "KajiyaKay": "Kajiya-Kay", "Chiang": "Chiang"}
    levels = ["SSE2", "AVX2", "AVX-512"]
    rows = [[f"{word}: {call}", *(cells[model, call, level] for level in levels)]
            for model, word in models.items() for call in ("value", "value and density")]
    return record, ["", *levels], rows


def frameworks():
    """Hits in frameworks of arrays on the CPU: processor time in ns with quartiles, and Mitsuba's plugin over Dr.Jit."""
    record = Record("frameworks.csv")
    times = {(row["contender"], row["model"], row["call"]): [float(row[name]) for name in ("ns", "low", "high")] for row in record.rows}
    cells = [(model, call) for model in dict.fromkeys(row["model"] for row in record.rows) for call in ("eval_pdf", "sample")]
    shown = lambda found: f"{three(found[0])} ({three(found[1])} to {three(found[2])})" if found else "-"
    names = {"NumPy": "NumPy", "PyTorch": "`hairis.torch`", "JAX": "`hairis.jax`", "Dr.Jit": "`hairis.drjit`",
             "hairis.mitsuba": "`hairis.mitsuba`", "Mitsuba's hair": "Mitsuba's `hair`"}
    rows = [[word, *(shown(times.get((name, *cell))) for cell in cells)] for name, word in names.items()]
    ratios = (times["Mitsuba's hair", "chiang", call][0] / times["Dr.Jit", model, call][0] for model, call in cells)
    rows.append(["Mitsuba's `hair`, of Chiang et al., over `hairis.drjit`", *(f"**{ratio:.2f}×**" for ratio in ratios)])
    words = {"eval_pdf": "value and density", "sample": "sample"}
    return record, ["", *(f"{model.capitalize()}: {words[call]}" for model, call in cells)], rows


def cuda():
    """Calls on a GPU: billions per second, and over the formulas with default flags or with fast math."""
    record = Record("cuda.csv")
    rates = {(row["model"], row["call"], row["variant"]): 1 / float(row["ns"]) for row in record.rows}
    models = {"gaussian": "Gaussian", "gaussian_matched": "Gaussian, matched", "cauchy": "Cauchy", "cauchy_matched": "Cauchy, matched",
              "kajiya_kay": "Kajiya-Kay", "chiang": "Chiang"}
    variants = {"port": None, "exact": "port", "fused": "port", "gpu-native": "port", "port fast": None, "fused fast": "port fast",
                "gpu-native fast": "port fast"}

    def cell(model, call, variant, base):
        rate, port = (rates.get((model, call, name)) for name in (variant, base))
        return ("-" if rate is None else three(rate)) + (f", **{rate / port:.2f}×**" if port else "")

    calls = dict.fromkeys(row["call"] for row in record.rows)
    rows = [[f"{word}: `{call}`", *(cell(model, call, *pair) for pair in variants.items())]
            for model, word in models.items() for call in calls]
    header = ["", "formulas", "`exact`", "`fused`", "`gpu-native`", "formulas, fast math", "`fused`, fast math", "`gpu-native`, fast math"]
    return record, header, rows


def speed():
    """Times of a direction, and how many times as fast as the formulas."""
    machine = "amd-epyc-family-25-model-1-stepping-1/"
    record = Record(machine + max(name for name in os.listdir(RECORDS + machine) if re.fullmatch(r"\d{4}-\d\d-\d\d\.csv", name)))
    times = {(row["group"], row["entry"], row["level"]): float(row["ns"]) for row in record.rows}
    calls = {
        "eval": ("eval_pdf", "eval_pdf8", "eval_columns"),
        "sample": ("sample", "sample8", "sample_columns"),
        "path-1": ("prepare-sample", "prepare8-sample8", None),
    }
    words = {"eval": "eval + pdf", "sample": "sample, with value and density", "path-1": "prepare a hit and sample it once"}
    rows = []
    for group, model in [(group, model) for group in calls for model in ("gaussian", "cauchy")] + [
            (group, model) for group in ("sample", "path-1") for model in ("gaussian-matched", "cauchy-matched")]:
        key = f"{group}/{model}"
        one, eight, slices = calls[group]
        base = times.get((key, "reference", "scalar"))
        cells = [(one, "scalar"), (eight, "portable"), (eight, "avx2+fma"), (slices, "avx2+fma")]
        found = [times.get((key, entry, level)) for entry, level in cells]
        shown = lambda ns: "-" if ns is None else three(ns) + (f", **{three(base / ns)}×**" if base else "")
        name, matched = model.partition("-")[::2]
        label = f"`Matched`: {words[group].split(',')[0]}" if matched else words[group]
        rows.append([f"{label}, {name.capitalize()}", three(base) if base else "-", *map(shown, found)])
    header = ["", "reference", "one lane", "SSE2, eight lanes", "AVX2+FMA, eight lanes", "AVX2+FMA, slices"]
    return record, header, rows


def refits():
    """L1 distance of models before and after a refit: medians over the looks, and the worst."""
    record = Record("refits.csv")
    pairs = {}
    for row in record.rows:
        pairs.setdefault((row["from"], row["to"]), []).append(row)
    share = lambda figures, of: f"{100 * of(figures):.3g}%"
    body = []
    for (one, other), rows in pairs.items():
        column = lambda name: [float(row[name]) for row in rows if row[name]]
        best = column("best_factor")
        body.append([f"{one} to {other}", str(len(rows)), share(column("equal"), statistics.median),
                     share(best, statistics.median) if best else "-",
                     share(column("fitted"), statistics.median), share(column("fitted"), max), share(column("error"), max)])
    return record, ["", "looks", "start", "best factor on the widths", "fitted", "worst", "error, at most"], body


def exhaustive():
    """Largest errors of the elementary functions over all floats of their domains."""
    record = Record("exhaustive.csv")
    number = lambda text: ", ".join(f"{float(x):.6g}" for x in text.split())
    rows = [[f"`{row['function']}`", row["result"], f"{number(row['first'])} to {number(row['last'])}", row["unit"],
             three(float(row["one lane"])), number(row["one lane at"]), three(float(row["fused"])), number(row["fused at"])]
            for row in record.rows]
    return record, ["function", "result", "domain", "unit", "one lane", "at", "fused", "at"], rows


def uphill():
    """Largest figures of the stated bounds, at random points and after searches from the largest of them."""
    record = Record("uphill.csv")
    # A figure close to its bound shows by how much it is below.
    number = lambda text: f"{float(text):.5g}" if 0.9 < float(text) < 8 else three(float(text))
    rows = [[row["quantity"], row["model"], number(row["stated"]), number(row["sampled"]), number(max(row["one lane"], row["fused"], key=float))]
            for row in record.rows]
    return record, ["figure", "model", "stated, at most", "random points", "searched"], rows


def mutants():
    """Small faults that tests found, by folder."""
    record = Record("mutants.csv")
    counts = {}
    for row in record.rows:
        folder = "/".join(row["mutant"].split(":")[0].split("/")[:3]).removesuffix(".rs")
        outcome = "equivalent" if row["outcome"] == "missed" and row["why"] else row["outcome"]
        for name in (folder, "all"):
            counts.setdefault(name, {}).setdefault(outcome, 0)
            counts[name][outcome] += 1
    outcomes = ["caught", "timeout", "missed", "equivalent", "unviable"]
    names = sorted(name for name in counts if name != "all") + ["all"]
    body = [[f"`{name}`" if name != "all" else name, *(str(counts[name].get(outcome, 0)) for outcome in outcomes)] for name in names]
    return record, ["", "found", "found, by its time", "missed", "equivalent", "does not compile"], body


def rtxcr():
    """Albedo, V and largest weight of RTXCR's far field, and of ours."""
    record = Record("rtxcr.csv")
    of = lambda row, digits, *names: ", ".join(f"{float(row[name]):.{digits}f}" for name in names)
    rows = [[row["theta_o"], of(row, 3, "narrow_theirs", "wide_theirs"), of(row, 3, "clear"), of(row, 3, "brown_theirs"),
             of(row, 3, "estimate_theirs"), of(row, 3, "brown"), of(row, 2, "variance_theirs"), of(row, 2, "variance"),
             of(row, 1, "weight_theirs"), of(row, 1, "weight"), of(row, 1, "bound")] for row in record.rows]
    header = ["`theta_o`, degrees", "clear hair in RTXCR, roughness .1, .3", "ours", "brown hair in RTXCR", "RTXCR's estimate of it", "ours",
              "V in RTXCR", "V of ours", "largest weight in RTXCR", "ours", "bound of ours"]
    return record, header, rows


def pictures():
    """Numbers of the presets that fits found in pictures: distance from the truth, mean over the seeds with its standard error."""
    record = Record("pictures.csv")
    ends = {}
    for row in record.rows:
        ends.setdefault((row["preset"], row["number"]), []).append(100 * float(row["end"]))
    words = {"alpha.R": "shifts", "beta.R": "widths", "i_tt.r": "red", "i_tt.g": "green", "i_tt.b": "blue"}
    cell = lambda all: f"{statistics.mean(all):+.1f}% ± {statistics.stdev(all) / len(all) ** 0.5:.1f}%"
    rows = [[preset, *(cell(ends[preset, number]) for number in words)] for preset in dict.fromkeys(preset for preset, _ in ends)]
    return record, ["", *words.values()], rows


def dual():
    """Dual scattering over paths, by scene, model and colour."""
    record = Record("dual.csv")
    percent = lambda row, name: f"{100 * float(row[name]):.0f}%"
    rows = [[row["scene"], row["model"], row["colour"], *(f"{float(row[channel]):.2f}" for channel in ("red", "green", "blue")),
             f"{100 * float(row['noise']):.1f}%", percent(row, "once"), percent(row, "by block"),
             f"{float(row['dual ms']):.0f} and {float(row['paths ms']):.0f} ms"] for row in record.rows]
    return record, ["scene", "model", "colour", "red", "green", "blue", "noise", "once", "by block", "time, dual and paths"], rows


def color():
    """Errors of asked colours, of one fibre and of a mass."""
    record = Record("color.csv")
    rows = [[row["model"], row["sense"], row["largest"], row["rms"], row["darkest"], row["lightest"]] for row in record.rows]
    return record, ["model", "sense", "largest error", "rms", "darkest", "lightest"], rows


def color_heads():
    """Colours of heads less those that were asked."""
    record = Record("color-heads.csv")
    heads = {"env": "straight", "head": "wavy"}
    rows = [[heads[row["scene"]], row["model"], row["sense"], *(f"{float(row[name]):.3f}" for name in ("rms", "largest")), f"{float(row['mean']):+.3f}"]
            for row in record.rows]
    return record, ["hair", "model", "sense", "rms", "largest error", "mean"], rows


PHYSICS = ["gaussian", "cauchy", "kajiya-kay", "chiang", "d-eon"]


def physics():
    """L1 distance of fitted models from traced fibres, and of another seed."""
    record = Record("physics.csv")
    totals = {(row["fibre"], row["model"]): f"{100 * float(row['total']):.1f}%" for row in record.rows}
    fibres = dict.fromkeys(row["fibre"] for row in record.rows)
    rows = [[fibre, *(totals[fibre, model] for model in [*PHYSICS, "another seed"])] for fibre in fibres]
    # Names of fields stand before their numbers.
    free = lambda values: str(sum(len(part.split()) - 1 for part in values.split("; ")))
    fitted = {row["model"]: free(row["values"]) for row in record.rows}
    rows.insert(0, ["numbers that are fitted", *(fitted[model] for model in PHYSICS), "-"])
    return record, ["", *PHYSICS, "another seed"], rows


def physics_lobes():
    """L1 distance of R, TT and further light, each over the light of that part."""
    record = Record("physics.csv")
    parts = ["R", "TT", "further"]
    row_of = {(row["fibre"], row["model"]): row for row in record.rows}
    # A part without light has no distance.
    share = lambda row, truth, part: f"{100 * float(row[part]):.0f}%" if float(truth["energy " + part]) > 5e-4 else "-"
    body = []
    for fibre in dict.fromkeys(row["fibre"] for row in record.rows):
        truth = row_of[fibre, "another seed"]
        cell = lambda row: ", ".join(share(row, truth, part) for part in parts)
        energies = ", ".join(f"{100 * float(truth['energy ' + part]):.1f}%" for part in parts)
        models = [cell(row_of[fibre, model]) for model in PHYSICS if model != "kajiya-kay"]
        body.append([fibre, energies, *models, cell(truth)])
    header = ["R, TT, further", "light", *(model for model in PHYSICS if model != "kajiya-kay"), "another seed"]
    return record, header, body


def physics_fibres():
    """Parameters of the traced fibres."""
    record = Record("physics.csv")
    body = []
    for row in record.rows:
        if row["model"] == "another seed":
            values = dict(part.split(" ", 1) for part in row["values"].split("; "))
            medulla = values["medulla"].split(" ")
            core = ", ".join(medulla) if float(medulla[0]) > 0 else "-"
            body.append([row["fibre"], values["roughness"], values["tilt"] + "°", values["aspect"], values["sigma_a"].replace(" ", ", "), core])
    return record, ["fibre", "roughness", "tilt", "aspect", "absorption, RGB", "medulla: size, scattering, g"], body


TABLES = {"capi": capi, "color": color, "color-heads": color_heads, "conserving": conserving, "cuda": cuda, "dual": dual, "exhaustive": exhaustive, "frameworks": frameworks, "gradients": gradients, "hand": hand, "hits": hits, "mutants": mutants, "one-lane": one_lane, "physics": physics, "physics-fibres": physics_fibres, "physics-lobes": physics_lobes, "pictures": pictures, "refits": refits, "rtxcr": rtxcr, "speed": speed, "uphill": uphill}
MARKED = re.compile(r"(<!-- table (\S+): written by \.ci/tables\.py --write -->\n)(.*?)(<!-- end of table -->)", re.S)


def main():
    write = sys.argv[1:] == ["--write"]
    if sys.argv[1:] and not write:
        sys.exit(f"tables.py takes --write or nothing, got {' '.join(sys.argv[1:])}")
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    files = subprocess.run(["git", "ls-files", "*.md"], check=True, capture_output=True, text=True).stdout.split()
    stale, count = [], 0
    for name in files:
        text = open(name, encoding="utf-8").read()

        def anew(match):
            if match[2] not in TABLES:
                sys.exit(f"{name}: table must be one of {', '.join(TABLES)}, got {match[2]}")
            record, header, rows = TABLES[match[2]]()
            body = [record.caption(os.path.dirname(name) or "."), "", *lines_of(header, rows)]
            return match[1] + "\n" + "\n".join(body) + "\n\n" + match[4]

        new, found = MARKED.subn(anew, text)
        if found != text.count("<!-- table "):
            sys.exit(f"{name}: a mark of a table must have its end, `<!-- end of table -->`")
        count += found
        if new != text:
            stale.append(name)
            if write:
                open(name, "w", encoding="utf-8").write(new)
    if count == 0:
        sys.exit("no table is marked")
    if stale and not write:
        sys.exit(f"tables differ from their records in {', '.join(stale)}: run .ci/tables.py --write")
    print(f"{count} tables are those of their records")


main()
