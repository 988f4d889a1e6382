#!/usr/bin/env python3
"""Promise: prose reads as sentences. Counts words per sentence and digits outside tables and code, doc comments that begin with a
headless pronoun, and lines of README files, and follows links between files; fails where a count is outside its bound or a link is
dead. `prose.py --list` prints the headless comments, `prose.py --sentences FILE` the sentences of one file, shortest first."""

import os
import re
import statistics
import subprocess
import sys

HEADLESS = re.compile(
    r"(What|Those|That of|The same|Of the|Of|So|Itself|Who|Whoever|Nobody|One who|How many|How much|As many|Where|When)\b"
)
MEDIAN, DIGITS = (12, 18), 6.0


def tracked(*patterns):
    """Names of tracked files."""
    return subprocess.run(["git", "ls-files", *patterns], check=True, capture_output=True, text=True).stdout.split()


def comments(text):
    """Public doc comments of a Rust file, each as one text."""
    block, found = [], []
    for line in text.splitlines():
        match = re.match(r"\s*//[/!] ?(.*)", line)
        if match:
            block.append(match[1])
        elif block:
            if re.match(r"\s*(#\[|pub\b|mod\b|use\b|$|fn\b|[A-Za-z_]+\b)", line):
                found.append("\n".join(block))
            block = []
    return found


def sentences(markdown):
    """Sentences of a text, without code, tables and their generated captions, headings, links' targets and list marks."""
    text = re.sub(r"(?ms)^<!-- table .*?^<!-- end of table -->$", "\n\n", markdown)
    text = re.sub(r"(?ms)^\s*(```|~~~).*?^\s*(```|~~~)\s*$", "\n\n", text)
    lines = []
    for line in text.splitlines():
        if re.match(r"\s*(\||#|<|!\[|\[[^\]]+\]: )", line):
            line = ""
        elif re.match(r"\s*([-*]|\d+\.) ", line):
            line = "\n\n" + re.sub(r"^\s*([-*]|\d+\.) ", "", line)
        lines.append(line)
    text = "\n".join(lines)
    text = re.sub(r"`[^`]*`", "code", text)
    text = re.sub(r"\](\([^)]*\)|\[[^\]]*\])", "]", text)
    text = re.sub(r"[*_\[\]]", "", text)
    found = []
    for paragraph in re.split(r"\n\s*\n", text):
        paragraph = " ".join(paragraph.split())
        for sentence in re.split(r"(?<=[.!?:;])\s+(?=[A-Z(])", paragraph):
            if len(re.findall(r"[A-Za-z]{2,}", sentence)) >= 2:
                found.append(sentence)
    return found


def count(texts):
    """Sentences, their median in words, digits per 100 words."""
    found = [sentence for text in texts for sentence in sentences(text)]
    words = [len(sentence.split()) for sentence in found]
    digits = sum(len(re.findall(r"\d", sentence)) for sentence in found)
    return len(found), statistics.median(words or [0]), 100 * digits / max(1, sum(words))


def slug(heading):
    """Anchor of a heading, as GitHub makes it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def dead_links(names):
    """Relative links of Markdown files whose file or heading does not exist."""
    for name in names:
        text = open(name, encoding="utf-8").read()
        # `[text](target)`, and `[label]: target` on a line of its own.
        for target in re.findall(r"(?m)(?:\]\(|^\[[^\]]+\]: )([^)\s]+)", re.sub(r"(?ms)^```.*?^```", "", text)):
            if re.match(r"[a-z]+://|crate\b", target):
                continue
            path, _, anchor = target.partition("#")
            file = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
            if not os.path.exists(file):
                yield name, target
            elif anchor and file.endswith(".md"):
                headings = re.findall(r"(?m)^#+ (.*)$", open(file, encoding="utf-8").read())
                if anchor not in map(slug, headings):
                    yield name, target


def main():
    guide = tracked("*/src/guide/*.md", "*/docs/*.md")
    readmes = [f for f in tracked("*.md") if f not in guide and not f.endswith(("CHANGELOG.md", "ERRATA.md", "records/README.md"))]
    rust = tracked("kernels/src/*.rs", "variants/*.rs", "harness/*.rs", "benches/src/*.rs")
    read = {name: open(name, encoding="utf-8").read() for name in guide + readmes + rust}
    docs = [(name, text) for name in rust for text in comments(read[name])]
    headless = [(name, text.splitlines()[0]) for name, text in docs if HEADLESS.match(text)]
    if "--list" in sys.argv:
        for name, line in headless:
            print(f"{name}: {line}")
        return 0
    if "--sentences" in sys.argv:
        for sentence in sorted(sentences(open(sys.argv[-1], encoding="utf-8").read()), key=lambda s: len(s.split())):
            print(len(sentence.split()), sentence)
        return 0
    failed = False
    print(f"{'prose':<28}{'sentences':>10}{'median words':>14}{'digits per 100 words':>22}")
    groups = {"README files": readmes, "guide": guide}
    rows = {name: [read[f] for f in files] for name, files in groups.items() if files}
    rows["doc comments"] = [text for _, text in docs]
    if "--files" in sys.argv:
        rows = {name: [read[name]] for name in readmes + guide}
    for name, texts in rows.items():
        total, median, digits = count(texts)
        # Comments of fields and variants are phrases, not sentences: no bound on their length.
        bad = digits > DIGITS or (name != "doc comments" and not MEDIAN[0] <= median <= MEDIAN[1])
        failed |= bad
        print(f"{name:<28}{total:>10}{median:>14.0f}{digits:>22.1f}{'  FAIL' if bad else ''}")
    print(f"{len(headless)} of {len(docs)} doc comments begin without a noun or a verb{'  FAIL' if headless else ''}")
    for name in readmes:
        directory = os.path.dirname(name)
        most = 40 if directory else 80
        lines = read[name].count("\n")
        if name.endswith("README.md") and os.path.exists(os.path.join(directory, "Cargo.toml")) and lines > most:
            failed = True
            print(f"{name}: must have at most {most} lines, got {lines}  FAIL")
    dead = list(dead_links(tracked("*.md")))
    for name, target in dead:
        print(f"{name}: the link {target} leads nowhere  FAIL")
    return int(failed or bool(headless) or bool(dead))


sys.exit(main())
