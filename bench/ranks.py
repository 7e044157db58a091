#!/usr/bin/env python3
"""Runs in ranks beside one process: memory, CPU seconds, bytes sent, by turns.

    bench/ranks.py PROGRAM [--level 4] [--layers 0] [--ranks 1,2,4] [--rounds 3] [--folder DIR]

expanding-sphere, one slab, one .pvtu, with the proof of embedding. A run in N ranks counts when its pieces equal those that
one process writes with output.pieces = N and cap.blocks = N, byte for byte. A line of JSON each; at the end, medians are
printed, CPU of all ranks by stage among them, and CPU of a rank is fitted to a + b/N.
"""
import argparse
import filecmp
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

CASE = """title = "A sphere grows"
[initial]
experiment = "expanding-sphere"
level = {level}
{layers}
[output]
formats = ["pvtu"]
"""
ALONE = "pieces = {n}\n[cap]\nblocks = {n}\n"
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def built(command, case, out):
    """The report of a run and its CPU seconds."""
    shutil.rmtree(out, ignore_errors=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([*command, "build", case, "--out", out, "--quiet"], check=True, env=os.environ | AS_ROOT)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return json.loads((out / "report.json").read_text()), cpu


def require_same(alone, in_ranks):
    pieces = sorted(path.name for path in alone.glob("*.*vtu"))
    different = filecmp.cmpfiles(alone, in_ranks, pieces, shallow=False)
    if not pieces or different[1] or different[2]:
        sys.exit(f"{in_ranks} differs from {alone}: {different[1:]}")


def one_turn(program, case_text, ranks, folder):
    """What a run of one process takes, and one in ranks."""
    alone_case = folder / "alone.toml"
    alone_case.write_text(case_text + ALONE.format(n=ranks))
    alone, cpu = built([program], alone_case, folder / "alone")
    case = folder / "ranks.toml"
    case.write_text(case_text)
    report, _ = built(["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(ranks), program], case, folder / "ranks")
    require_same(folder / "alone", folder / "ranks")
    told = report["slabs"][0]["ranks"]
    return {"ranks": ranks, "cells": sum(told["cells"]), "one_process_cpu": cpu, "cpu_of_ranks": told["cpu_seconds"],
            "stage_cpu": told["stage_cpu_seconds"], "peak_memory": told["peak_memory"], "one_process_peak": alone["peak_memory"]["bytes"],
            "sent_bytes": told["sent_bytes"], "meetings": told["meetings"], "seconds": report["slabs"][0]["seconds"],
            "one_process_seconds": alone["slabs"][0]["seconds"]}


def fit(turns):
    """CPU of a rank as a + b/N, by least squares over all turns."""
    points = [(1 / turn["ranks"], statistics.mean(turn["cpu_of_ranks"])) for turn in turns]
    mean_x = statistics.mean(x for x, _ in points)
    mean_y = statistics.mean(y for _, y in points)
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    b = sum((x - mean_x) * (y - mean_y) for x, y in points) / spread if spread else 0
    return {"cpu_on_every_rank": mean_y - b * mean_x, "cpu_divided": b}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--level", type=int, default=4)
    parser.add_argument("--layers", type=int, default=0, help="0: the experiment's own")
    parser.add_argument("--ranks", default="1,2,4")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--folder", type=Path)
    options = parser.parse_args()
    layers = f"[time]\nlayers = {options.layers}" if options.layers else ""
    case_text = CASE.format(level=options.level, layers=layers)
    counts = [int(n) for n in options.ranks.split(",")]
    turns = []
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        for _ in range(options.rounds):
            for ranks in counts:
                turns.append(one_turn(options.program.resolve(), case_text, ranks, Path(folder)))
                print(json.dumps(turns[-1]), flush=True)
    for ranks in counts:
        of_count = [turn for turn in turns if turn["ranks"] == ranks]
        print(json.dumps({"ranks": ranks, "median": {
            "largest_peak": statistics.median(max(turn["peak_memory"]) for turn in of_count),
            "one_process_peak": statistics.median(turn["one_process_peak"] for turn in of_count),
            "cpu_of_all": statistics.median(sum(turn["cpu_of_ranks"]) for turn in of_count),
            "one_process_cpu": statistics.median(turn["one_process_cpu"] for turn in of_count),
            "stages": {stage: round(statistics.median(sum(turn["stage_cpu"][stage]) for turn in of_count), 3)
                       for stage in of_count[0]["stage_cpu"]},
            "sent_bytes": statistics.median(sum(turn["sent_bytes"]) for turn in of_count)}}))
    if len(counts) > 1:
        print(json.dumps(fit(turns)))


if __name__ == "__main__":
    main()
