#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Two builds of the program on the same cases by turns: what a change of a run is worth.

    bench/by_turns.py OLD/slabhull NEW/slabhull [--rounds 3] [--threads N] [meshed moved adapted]

A case's times count only when both programs wrote the same hulls and caps, byte for byte. Prints a line of JSON per case: seconds of each run, wall and CPU
(the meshers' processes not counted) with the system's part, pages that were touched first, the peak memory of program and mesher, and the ratios of the medians."""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

COMMON = '[output]\nformats = ["vtu"]\n[time]\nslabs = 8\nlayers = 5\n'
CASES = {
    "meshed": COMMON + '[initial]\nexperiment = "ellipsoid"\nlevel = 3\n',
    "moved": COMMON + 'end = 0.32\n[initial]\nexperiment = "ellipsoid"\nlevel = 3\n[cap]\nreuse = "move"\n',
    "adapted": COMMON + 'end = 0.32\n[initial]\nexperiment = "ellipsoid"\nlevel = 2\n[cap]\nreuse = "adapt"\n',
}


def run(program, case, out, threads):
    began = time.perf_counter()
    process = subprocess.Popen([program, "build", case, "--out", out, "--quiet", "--threads", str(threads)])
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - began
    if status != 0:
        sys.exit(f"{program} ended with status {status}")
    peak = json.loads((out / "report.json").read_text())["peak_memory"]
    return {"seconds": round(seconds, 3), "cpu": round(usage.ru_utime + usage.ru_stime, 3), "system": round(usage.ru_stime, 3),
            "faults": usage.ru_minflt, "mb": peak["bytes"] // 10**6, "mesher_mb": peak["mesher_bytes"] // 10**6}


def differ(one, other):
    """The meshes that are not the same in both folders."""
    names = {path.name for folder in (one, other) for path in folder.glob("*.vtu")}
    return [name for name in sorted(names)
            if not all((folder / name).exists() for folder in (one, other))
            or (one / name).read_bytes() != (other / name).read_bytes()]


def compare(old, new, name, rounds, threads):
    with tempfile.TemporaryDirectory(prefix="slabhull-turns-") as scratch:
        folder = Path(scratch)
        case = folder / "case.toml"
        case.write_text(CASES[name])
        runs = {"old": [], "new": []}
        for _ in range(rounds):
            for which, program in (("old", old), ("new", new)):
                runs[which].append(run(program, case, folder / which, threads))
        if wrong := differ(folder / "old", folder / "new"):
            sys.exit(f"{name}: not the same: {', '.join(wrong)}")
    ratio = {}
    for what in ("seconds", "cpu"):
        old_one, new_one = (statistics.median(each[what] for each in runs[which]) for which in ("old", "new"))
        ratio[what] = round(old_one / new_one, 3)
    print(json.dumps({"bench": "by_turns", "case": name, "threads": threads, **runs,
                      "old_over_new": ratio["seconds"], "cpu_old_over_new": ratio["cpu"]}), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("cases", nargs="*", default=list(CASES))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=0)
    options = parser.parse_intermixed_args()
    for name in options.cases:
        compare(options.old, options.new, name, options.rounds, options.threads)


if __name__ == "__main__":
    main()
