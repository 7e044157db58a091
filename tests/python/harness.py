# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the Python module share: domains, scratch folders, skipping where a part is missing."""
import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest
from collections import Counter
from itertools import combinations, permutations
from pathlib import Path

SKIPPED = 77  # ctest's SKIP_RETURN_CODE
for needed in ("numpy", "slabhull"):
    if importlib.util.find_spec(needed) is None:
        print(f"skipped: {needed} is not there", file=sys.stderr)
        raise SystemExit(SKIPPED)

import numpy  # noqa: E402

import slabhull  # noqa: E402

ROOT = Path(os.environ["SLABHULL_ROOT"])
PROGRAM = os.environ["SLABHULL_PROGRAM"]
CIRCLE = {"initial": {"experiment": "expanding-circle", "level": 1}, "time": {"layers": 2, "slabs": 2}}


def needs(name):
    """Skips a test, with the name, where a package is not installed."""
    return unittest.skipIf(importlib.util.find_spec(name) is None, f"{name} is not installed")


def grid(cubes, dimension):
    """Points and simplices of a grid of unit cubes with the middle one left out."""
    number, cells = {}, []

    def index(at):
        return number.setdefault(tuple(at), len(number))

    for cube in numpy.ndindex(*[cubes] * dimension):
        if all(at == cubes // 2 for at in cube):
            continue
        for order in permutations(range(dimension)):
            at = list(cube)
            cell = [index(at)]
            for axis in order:
                at[axis] += 1
                cell.append(index(at))
            if numpy.linalg.det(numpy.eye(dimension)[list(order)]) < 0:
                cell[-2], cell[-1] = cell[-1], cell[-2]
            cells.append(cell)
    return numpy.array(list(number), dtype=float), numpy.array(cells)


def body_facets(points, cells, cubes):
    """The boundary facets of the grid around the cube that is left out."""
    seen = Counter(tuple(sorted(facet)) for cell in cells for facet in combinations(cell, len(cell) - 1))
    low, high = cubes // 2, cubes // 2 + 1
    inner = ((points >= low) & (points <= high)).all(axis=1)
    return numpy.array([facet for facet, times in seen.items() if times == 1 and inner[list(facet)].all()])


def domain(dimension=2, cubes=5):
    points, cells = grid(cubes, dimension)
    return slabhull.Domain(points, cells, facets={"body": body_facets(points, cells, cubes)})


def swing(x, t):
    """Along the first axis by 0.5 t - t^2 / 2."""
    v = numpy.zeros_like(x)
    v[:, 0] = 0.5 - t
    return v


def address(array):
    return array.__array_interface__["data"][0]


def program(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120)
    assert done.returncode >= 0, done.stderr
    return done


class PythonTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="slabhull-test-")
        self.addCleanup(scratch.cleanup)
        self.dir = Path(scratch.name)

    def assert_same(self, a, b):
        self.assertEqual(a.dtype, b.dtype)
        self.assertTrue(numpy.array_equal(a, b))

    def assert_same_hull(self, a, b):
        for name in ("points", "cells", "neighbors", "region", "patch", "layer", "vertex_ids", "track_ids"):
            self.assert_same(getattr(a, name), getattr(b, name))
        self.assertEqual((a.slab, a.time, a.patches), (b.slab, b.time, b.patches))


def main():
    result = unittest.main(exit=False).result
    if result.wasSuccessful() and result.testsRun > 0 and len(result.skipped) == result.testsRun:
        raise SystemExit(SKIPPED)
    raise SystemExit(0 if result.wasSuccessful() and result.testsRun > 0 else 1)
