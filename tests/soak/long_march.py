#!/usr/bin/env python3
"""A thousand slabs of a hull of 100,000 tetrahedra: memory and time stay flat, no id is ever given twice, each initial
cap is the terminating cap before, bit for bit. Not part of the test suite; takes some ten minutes and one slab's disk.

    tests/soak/long_march.py build/release/tools/slabhull [--slabs 1000] [--reuse none]

Files are read by VTK, checked here, and removed. Prints one line of JSON; exit code 1 when something is wrong.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

CASE = """
title = "A long march"
dimension = 3
[initial]
surfaces = [ {{ file = "body.off", patch = "body" }} ]
box = {{ min = [-4, -4, -4], max = [4, 4, 4], size = 0.62, patch = "walls" }}
[time]
start = 0.0
end = {end}
slabs = {slabs}
layers = 1
[motion.body]
kind = "rotation"
axis = [0, 0, 1]
centre = [0, 0, 0]
rate = 1.0
[side]
split = "C"
[cap]
growth = 0.2
reuse = "{reuse}"
[output]
formats = ["vtu"]
"""


def sphere(n, axes):
    """An octahedron's faces divided by n, on an ellipsoid: points and outward triangles."""
    corners = [(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (1, 0, 5), (2, 1, 5), (3, 2, 5), (0, 3, 5)]
    number, points, triangles = {}, [], []

    def vertex(face, i, j):
        weights = (n - i - j, i, j)
        key = tuple(sum(w * corners[c][k] for w, c in zip(weights, face)) for k in range(3))
        if key not in number:
            number[key] = len(points)
            length = math.sqrt(sum(x * x for x in key))
            points.append([a * x / length for a, x in zip(axes, key)])
        return number[key]

    for face in faces:
        for i in range(n):
            for j in range(n - i):
                triangles.append((vertex(face, i, j), vertex(face, i + 1, j), vertex(face, i, j + 1)))
                if i + j < n - 1:
                    triangles.append((vertex(face, i + 1, j), vertex(face, i + 1, j + 1), vertex(face, i, j + 1)))
    return points, triangles


def write_off(path):
    points, triangles = sphere(18, (1.0, 1.6, 1.3))
    lines = ["OFF", f"{len(points)} {len(triangles)} 0"]
    lines += ["{!r} {!r} {!r}".format(*p) for p in points]
    lines += ["3 {} {} {}".format(*t) for t in triangles]
    path.write_text("\n".join(lines) + "\n")


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    ids = vtk_to_numpy(grid.GetPointData().GetArray("vertex_id")).copy()
    t = vtk_to_numpy(grid.GetPointData().GetArray("t")).copy()
    return ids, t, vtk_to_numpy(grid.GetPoints().GetData()).copy(), grid.GetNumberOfCells()


class Ids:
    """Which ids were given, over the whole run."""

    def __init__(self):
        self.given = np.zeros(1 << 20, bool)
        self.cap = None  # ids and places of the last terminating cap, by id

    def add(self, path):
        ids, t, places, cells = read(path)
        begin, end = t.min(), t.max()
        initial = self.sorted_cap(ids[t == begin], places[t == begin])
        if self.cap is not None:
            assert np.array_equal(self.cap[0], initial[0]), f"{path.name}: another initial cap than the cap before"
            assert np.array_equal(self.cap[1], initial[1]), f"{path.name}: its initial cap has moved"
        fresh = ids if self.cap is None else ids[t > begin]
        assert len(np.unique(fresh)) == len(fresh), f"{path.name}: an id twice in one slab"
        while fresh.max() >= len(self.given):
            self.given = np.concatenate([self.given, np.zeros(len(self.given), bool)])
        assert not self.given[fresh].any(), f"{path.name}: an id of an earlier slab"
        self.given[fresh] = True
        self.cap = self.sorted_cap(ids[t == end], places[t == end])
        return cells

    @staticmethod
    def sorted_cap(ids, places):
        order = np.argsort(ids)
        return ids[order], places[order]


def follow(run, out, slabs):
    """Checks and removes each slab's files as soon as the next one's are there."""
    ids, cells = Ids(), []
    for number in range(slabs):
        path = out / f"slab_{number:04}.vtu"
        following = out / (f"slab_{number + 1:04}.vtu" if number + 1 < slabs else "report.json")
        while not following.exists():
            assert run.poll() in (None, 0), run.stderr.read().decode()
            time.sleep(0.02)
        cells.append(ids.add(path))
        path.unlink()
        if number > 0:
            (out / f"cap_{number:04}.vtu").unlink()
    assert run.wait() == 0, run.stderr.read().decode()
    return cells, int(ids.given.sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--slabs", type=int, default=1000)
    parser.add_argument("--reuse", default="move", choices=("move", "none", "adapt"))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="slabhull-soak-") as folder:
        folder = Path(folder)
        write_off(folder / "body.off")
        (folder / "case.toml").write_text(
            CASE.format(slabs=options.slabs, end=0.01 * options.slabs, reuse=options.reuse))
        out = folder / "out"
        run = subprocess.Popen([os.path.abspath(options.program), "build", folder / "case.toml", "--out", out, "--quiet"],
                               stderr=subprocess.PIPE)
        cells, given = follow(run, out, options.slabs)
        slabs = json.loads((out / "report.json").read_text())["slabs"]
    part = max(1, options.slabs // 10)
    seconds = np.array([sum(slab["seconds"].values()) for slab in slabs])
    memory = np.array([slab["peak_memory"]["bytes"] for slab in slabs])
    moved = sum(slab["cap"]["made"] == "moved" for slab in slabs)
    result = {
        "slabs": len(slabs), "cells": int(np.median(cells)), "ids": given, "caps_moved": moved,
        "memory_last_to_first_part": float(memory[-1] / memory[part - 1]),
        "seconds_last_to_first_part": float(np.median(seconds[-part:]) / np.median(seconds[:part])),
        "seconds_median": float(np.median(seconds)),
        "smallest_angle": min(slab["angle"]["smallest"] for slab in slabs),
    }
    print(json.dumps(result))
    return 0 if all(slab["clean"] for slab in slabs) and result["memory_last_to_first_part"] <= 1.02 else 1


if __name__ == "__main__":
    sys.exit(main())
