#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes points and tetrahedra by meshio: write_meshio.py POINTS CELLS FILE.

POINTS holds doubles, CELLS 64-bit integers. Prints the seconds of the writing alone.
"""
import sys
import time

import meshio
import numpy


def main():
    points = numpy.fromfile(sys.argv[1], dtype=numpy.float64).reshape(-1, 3)
    cells = numpy.fromfile(sys.argv[2], dtype=numpy.int64).reshape(-1, 4)
    mesh = meshio.Mesh(points, [("tetra", cells)])
    start = time.perf_counter()
    meshio.write(sys.argv[3], mesh, file_format="gmsh", binary=True)
    print(time.perf_counter() - start)


main()
