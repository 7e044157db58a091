#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a velocity that is a function of Python costs: 20 slabs of a million cells, in C++ and in Python by turns.

    PYTHONPATH=build/bench/python bench/python_march.py build/bench/bench/bench_slab_callable_march

Prints one line of JSON: seconds and CPU seconds of each run, the medians of the pairs' ratios, and that both made the same points, bit for bit, and
no array of a hull was copied."""
import argparse
import json
import statistics
import subprocess
import sys
import time
import zlib

ANGLE = 0.02  # of a slab


def address(array):
    return array.__array_interface__["data"][0]


def march(level, layers, slabs):
    import numpy
    import slabhull

    def turning(x, t):
        v = numpy.zeros_like(x)
        v[:, 0] = -x[:, 1]
        v[:, 1] = x[:, 0]
        return v

    march = slabhull.Case.experiment("ellipsoid", level).march()
    march.configure(reuse="move")
    march.move("body", turning)
    seconds = 0.0
    cpu = time.process_time()
    for slab in range(slabs):
        began = time.perf_counter()
        proposed = march.propose([(slab + k / layers) * ANGLE for k in range(layers + 1)])
        seconds += time.perf_counter() - began
        hull = proposed.hull
        places = [address(getattr(hull, name)) for name in ("points", "cells", "neighbors")]
        began = time.perf_counter()
        march.accept(proposed)
        if slab + 1 < slabs:
            del hull, proposed
        seconds += time.perf_counter() - began
    cpu = time.process_time() - cpu
    same = places == [address(getattr(hull, name)) for name in ("points", "cells", "neighbors")]
    print(json.dumps({"seconds": seconds, "cpu": cpu, "cells": len(hull.cells), "checksum": zlib.crc32(hull.points),
                      "copied": not same or hull.points.flags.owndata}))


def run(command):
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", nargs="?")
    parser.add_argument("--level", type=int, default=3)
    parser.add_argument("--layers", type=int, default=7)
    parser.add_argument("--slabs", type=int, default=20)
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--child", action="store_true", help="march in this process")
    options = parser.parse_args()
    size = [str(options.level), str(options.layers), str(options.slabs)]
    if options.child:
        return march(*map(int, size))
    child = [sys.executable, __file__, "--child", "--level", size[0], "--layers", size[1], "--slabs", size[2]]
    ours, theirs = [], []
    for pair in range(options.pairs):
        for made, command in [(theirs, [options.program, *size]), (ours, child)][:: 1 if pair % 2 == 0 else -1]:
            made.append(run(command))
    same = len({each["checksum"] for each in ours + theirs}) == 1
    figures = {}
    for kind in ("seconds", "cpu"):
        figures["cpp_" + kind] = [round(each[kind], 3) for each in theirs]
        figures["python_" + kind] = [round(each[kind], 3) for each in ours]
        figures["ratio_of_" + kind] = round(statistics.median(a[kind] / b[kind] for a, b in zip(ours, theirs)), 4)
    print(json.dumps({"bench": "python_march", "slabs": options.slabs, "cells": ours[0]["cells"], **figures,
                      "ratio_of_fastest": round(min(figures["python_seconds"]) / min(figures["cpp_seconds"]), 4),
                      "same_points": same,
                      "copied": any(each["copied"] for each in ours)}))
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
