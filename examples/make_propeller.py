#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes propeller.stl, a hub with three twisted blades in one closed surface, with Gmsh's OpenCASCADE kernel.

Usage: make_propeller.py [OUT.stl]        (Debian: python3-gmsh)
"""
import math
import sys
from pathlib import Path

import gmsh

HUB_RADIUS, HUB_LENGTH = 0.25, 0.5
TIP_RADIUS = 1.0
BLADES = 3
EDGE = 0.1


def section(radius, chord, thickness, pitch):
    """A wire around the blade at this distance from the axis, which is z: an ellipse turned by the pitch angle, in two
    halves, so that both edges of the blade are edges of the mesh."""
    occ = gmsh.model.occ
    halves = [(1, occ.addEllipse(0, 0, 0, chord / 2, thickness / 2, angle1=side * math.pi, angle2=(side + 1) * math.pi))
              for side in (0, 1)]
    occ.rotate(halves, 0, 0, 0, 1, 0, 0, math.pi / 2)
    occ.rotate(halves, 0, 0, 0, 0, 0, 1, math.pi / 2)  # in the plane across x now, its chord along y
    occ.rotate(halves, 0, 0, 0, 1, 0, 0, pitch)
    occ.translate(halves, radius, 0, 0)
    return occ.addWire([tag for _, tag in halves])


def blade():
    """From inside the hub to the tip, the pitch angle falling as on a screw."""
    wires = []
    for step in range(6):
        s = step / 5
        radius = 0.12 + s * (TIP_RADIUS - 0.12)
        pitch = math.atan2(0.35, radius)
        wires.append(section(radius, 0.26 + 0.36 * s * (1 - s) - 0.08 * s, 0.07 - 0.035 * s, pitch))
    return [entity for entity in gmsh.model.occ.addThruSections(wires, makeSolid=True) if entity[0] == 3]


def propeller():
    occ = gmsh.model.occ
    hub = (3, occ.addCylinder(0, 0, -HUB_LENGTH / 2, 0, 0, HUB_LENGTH, HUB_RADIUS))
    first = blade()
    blades = list(first)
    for number in range(1, BLADES):
        turned = occ.copy(first)
        occ.rotate(turned, 0, 0, 0, 0, 0, 1, 2 * math.pi * number / BLADES)
        blades += turned
    occ.fuse([hub], blades)
    occ.synchronize()


def main(path):
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.option.setNumber("Mesh.MeshSizeMax", EDGE)
    gmsh.option.setNumber("Mesh.MeshSizeMin", EDGE / 3)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 8)
    gmsh.option.setNumber("Mesh.Binary", 1)
    propeller()
    gmsh.model.mesh.generate(2)
    gmsh.write(path)
    gmsh.finalize()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else str(Path(__file__).parent / "propeller.stl"))
