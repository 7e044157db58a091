#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the proof of embedding adds to `build` for each example, as rows of RESULTS.md: embedding_share.py PROGRAM [ROUNDS]

CPU time of the program, its children included, medians of rounds that alternate; each case is run with and without
`check.embedding`, from a copy beside its files."""
import json
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

EXAMPLES = Path(__file__).parent.parent / "examples"


def cpu_of(command):
    """Seconds of CPU, or nothing where the program fails."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        print(f"{command[2].name}: exit {done.returncode}: {done.stderr.strip().splitlines()[-1]}", file=sys.stderr)
        return None
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def row_of(program, example, folder, rounds):
    text = (folder / example).read_text()
    (folder / "without.toml").write_text(text + "\n[check]\nembedding = false\n")
    seconds = {"with": [], "without": []}
    for _ in range(rounds):
        for way, case in (("with", example), ("without", "without.toml")):
            cpu = cpu_of([program, "build", folder / case, "--out", folder / way, "--quiet"])
            if cpu is None:
                return
            seconds[way].append(cpu)
    slabs = json.loads((folder / "with" / "report.json").read_text())["slabs"]
    cells = sum(slab["counts"]["cells"] for slab in slabs)
    full, bare = (statistics.median(seconds[way]) for way in ("with", "without"))
    print(f"| {Path(example).stem} | {len(slabs)} | {cells:,} | {bare:.2f} | {full:.2f} | {100 * (full / bare - 1):+.0f} % |")


def main():
    program, rounds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 3
    print("| example | slabs | simplices | s of CPU without | with | share |\n|---|---|---|---|---|---|")
    for case in sorted(EXAMPLES.glob("*.toml")):
        with tempfile.TemporaryDirectory(prefix="slabhull-bench-") as scratch:
            folder = Path(scratch) / "examples"
            shutil.copytree(EXAMPLES, folder)
            row_of(program, case.name, folder, rounds)


if __name__ == "__main__":
    main()
