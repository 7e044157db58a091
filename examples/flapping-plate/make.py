#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a thin plate and its displacements in one period of flapping: make.py [2|3] [DIRECTORY].

The plate is clamped at x = 0 and bends like a cantilever; its cross-sections turn along. For dimension 2 (as in
flapping-plate.toml) a curve plate.dat, for dimension 3 a closed surface plate.off, which twists, too. The displacements
d_00.csv .. d_16.csv are those at t = 0, 1/16 .. 1.
"""
import math
import sys
from pathlib import Path

LENGTH, THICKNESS, SPAN, BEND = 1.0, 0.04, 0.6, 0.2
INSTANTS = 16


def displaced(x, y, z, t):
    """Where the plate's point is at time t: its middle surface bends, what is off it turns with it."""
    bend = BEND * (1 + 0.8 * z) * math.sin(2 * math.pi * t)
    slope = 2 * bend * x
    shortening = 2 * bend * bend * x ** 3 / 3  # half the square of the slope, from the clamp to x
    angle = math.atan(slope)
    return x - shortening - y * math.sin(angle), bend * x * x + y * math.cos(angle), z


def curve(count=24):
    """The outline, counter-clockwise, for dimension 2."""
    below = [(LENGTH * i / count, -THICKNESS / 2, 0.0) for i in range(count + 1)]
    return below + [(x, -y, z) for x, y, z in reversed(below)]


def surface(along=10, across=6):
    """The plate's vertices and triangles, outward, for dimension 3."""
    points, number = [], {}

    def vertex(i, j, side):
        if (i, j, side) not in number:
            number[i, j, side] = len(points)
            points.append((LENGTH * i / along, (side - 0.5) * THICKNESS, SPAN * (j / across - 0.5)))
        return number[i, j, side]

    triangles = []

    def quadrilateral(a, b, c, d):
        triangles.extend([(a, b, c), (a, c, d)])

    for i in range(along):
        for j in range(across):
            for side in (0, 1):
                ring = [vertex(i, j, side), vertex(i + 1, j, side), vertex(i + 1, j + 1, side), vertex(i, j + 1, side)]
                quadrilateral(*(ring if side == 0 else ring[::-1]))
    for i in range(along):
        quadrilateral(vertex(i, 0, 0), vertex(i, 0, 1), vertex(i + 1, 0, 1), vertex(i + 1, 0, 0))
        quadrilateral(vertex(i, across, 0), vertex(i + 1, across, 0), vertex(i + 1, across, 1), vertex(i, across, 1))
    for j in range(across):
        quadrilateral(vertex(0, j, 0), vertex(0, j + 1, 0), vertex(0, j + 1, 1), vertex(0, j, 1))
        quadrilateral(vertex(along, j, 0), vertex(along, j, 1), vertex(along, j + 1, 1), vertex(along, j + 1, 0))
    return points, triangles


def write_plate(dimension, directory):
    """Returns the plate's points."""
    if dimension == 2:
        points = curve()
        (directory / "plate.dat").write_text("".join(f"{x:.9g} {y:.9g}\n" for x, y, _ in points))
        return points
    points, triangles = surface()
    lines = ["OFF", f"{len(points)} {len(triangles)} 0"]
    lines += [" ".join(f"{x:.9g}" for x in point) for point in points]
    lines += ["3 " + " ".join(map(str, triangle)) for triangle in triangles]
    (directory / "plate.off").write_text("\n".join(lines) + "\n")
    return points


def write_displacements(dimension, directory, points):
    names = "xyz"[:dimension]
    for instant in range(INSTANTS + 1):
        lines = [",".join([*names, *("d" + name for name in names)])]
        for point in points:
            place = displaced(*point, instant / INSTANTS)
            row = [*point[:dimension], *(b - a for a, b in zip(point, place))][:2 * dimension]
            lines.append(",".join(f"{value + 0.0:.7g}" for value in row))
        (directory / f"d_{instant:02}.csv").write_text("\n".join(lines) + "\n")


def main():
    dimension = int(sys.argv[1]) if len(sys.argv) > 1 else 2
    directory = Path(sys.argv[2] if len(sys.argv) > 2 else Path(__file__).parent)
    write_displacements(dimension, directory, write_plate(dimension, directory))


if __name__ == "__main__":
    main()
