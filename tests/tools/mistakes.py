#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Typical mistakes and the whole answers that they get, side by side.

Each entry has the mistake as a user makes it (a case file, the files beside it, the command), the exit code, and what
stands on stderr, word by word: what is wrong and where (`says`), then what to do about it (`todo`)."""
import re
import shutil
import struct
import tempfile
import unittest
from dataclasses import dataclass, field
from pathlib import Path

import harness

DONE, USAGE, INPUT, GEOMETRY, OUTPUT = 0, 2, 3, 4, 5
MISTAKES = []


@dataclass
class Mistake:
    title: str
    says: str  # after "slabhull: "; {dir} is the folder in which the command runs, {size} follows from the memory
    todo: str
    code: int = USAGE
    case: str = ""  # case.toml
    files: dict = field(default_factory=dict)  # the others, by name
    command: str = "build case.toml"
    needs: str = ""  # "run": a folder of this name with what CIRCLE builds; "formats", "three": builds that have all


def mistake(title, **rest):
    MISTAKES.append(Mistake(title, **rest))


# --- Inputs without a mistake

CIRCLE = '[initial]\nexperiment = "circle"\nlevel = 1\n'  # its patches: body, walls

# Two triangles. The boundary is in two groups.
SQUARE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "left"
1 2 "right"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
6
1 1 2 1 1 1 2
2 1 2 2 2 2 3
3 1 2 2 2 3 4
4 1 2 1 1 4 1
5 2 2 5 1 1 2 3
6 2 2 5 1 1 3 4
$EndElements
"""
PLATE = 'dimension = 2\n[initial]\nmesh = "plate.msh"\n'
NAMES = '$PhysicalNames\n2\n1 1 "left"\n1 2 "right"\n$EndPhysicalNames\n'
NODES = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
LINES = "1 1 2 1 1 1 2\n2 1 2 2 2 2 3\n3 1 2 2 2 3 4\n4 1 2 1 1 4 1\n"
TRIANGLES = "5 2 2 5 1 1 2 3\n6 2 2 5 1 1 3 4\n"

# One tetrahedron.
TETRAHEDRON = ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
               "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n")

OCTAHEDRON = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]


def corners(centre, radius):
    x, y, z = centre
    return [(x + radius, y, z), (x - radius, y, z), (x, y + radius, z), (x, y - radius, z), (x, y, z + radius),
            (x, y, z - radius)]


def off(points, facets):
    rows = [" ".join(f"{c:g}" for c in p) for p in points] + ["3 " + " ".join(map(str, f)) for f in facets]
    return "\n".join(["OFF", f"{len(points)} {len(facets)} 0", *rows]) + "\n"


def ball(centre=(0, 0, 0), radius=0.5, facets=OCTAHEDRON):
    """An octahedron."""
    return off(corners(centre, radius), facets)


def stl(facets, name="ball"):
    """As text, of triples of points."""
    rows = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex {:g} {:g} {:g}\n".format(*p) for p in points) +
                   "endloop\nendfacet\n" for points in facets)
    return f"solid {name}\n{rows}endsolid {name}\n"


def binary_stl():
    points = corners((0, 0, 0), 0.5)
    return b"ball".ljust(80) + struct.pack("<I", len(OCTAHEDRON)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *(c for v in f for c in points[v]), 0) for f in OCTAHEDRON)


def loose_stl():
    """Each facet has corners of its own, which are not quite where those of its neighbours are."""
    points = corners((0, 0, 0), 0.5)
    return stl([[tuple(c + 1e-5 * i for c in points[v]) for v in f] for i, f in enumerate(OCTAHEDRON)])


BOX = "box = { min = [-2, -2, -2], max = [2, 2, 2], size = 0.8 }\n"
SOLID = 'dimension = 3\n[initial]\nsurfaces = [ { file = "ball.off", patch = "ball" } ]\n' + BOX
TWO = ('dimension = 3\n[initial]\nsurfaces = [ { file = "a.off", patch = "a" }, { file = "b.off", patch = "b" } ]\n' +
       BOX)
BOX_2D = "box = { min = [-2, -2], max = [2, 2], size = 0.4 }\n"
WING = 'dimension = 2\n[initial]\ncurves = [ { file = "wing.dat", patch = "wing" } ]\n' + BOX_2D
DIAMOND = "0.5 0\n0 0.2\n-0.5 0\n0 -0.2\n"
FLAP = "1.7 0\n1.2 0.2\n0.7 0\n1.2 -0.2\n"
WING_AND_FLAP = WING.replace("} ]", '}, { file = "flap.dat", patch = "flap" } ]')
SPIN = '[motion.body]\nkind = "rotation"\ncentre = [0, 0]\n'
BY_TABLE = CIRCLE + SPIN + 'table = "spin.csv"\n'


def flow(*formula):
    return WING + f'[motion.wing]\nkind = "velocity"\nformula = ["{formula[0]}", "{formula[1]}"]\n'


# --- Case files

mistake("A key is misspelt", case=CIRCLE + "[cap]\nsiize = 0.3\n",
        says='case.toml: line 5: unknown key "cap.siize"; ',
        todo='did you mean "cap.size"?')

mistake("A section is misspelt", case=CIRCLE + "[trajectry]\nsubsteps = 3\n",
        says='case.toml: line 4: unknown key "trajectry"; ',
        todo='did you mean "trajectory"?')

mistake("An axis in the plane", case=CIRCLE + SPIN + "rate = 1\naxis = [0, 0, 1]\n",
        says='case.toml: line 8: unknown key "motion.body.axis"; ',
        todo="the keys of motion.body are centre, kind, rate, table")

mistake("A text without quotation marks", case="[initial]\nexperiment = circle\n",
        says="case.toml: line 2: no TOML: could not determine value type; ",
        todo="texts stand in quotation marks, numbers have a decimal point")

mistake("A number in quotation marks", case=CIRCLE + '[time]\nlayers = "4"\n',
        says="case.toml: line 5: time.layers: ",
        todo="expected a whole number from 1 to 1000000, without quotation marks")

mistake("A decimal comma", case=CIRCLE + "[time]\nend = 1,5\n",
        says="case.toml: line 5: no TOML: expected a comment or whitespace, saw ','; ",
        todo="numbers have a decimal point, not a comma; lists stand in brackets, as in [1.0, 2.5]")

mistake("A key is given twice", case=CIRCLE + "[time]\nlayers = 2\nlayers = 3\n",
        says="case.toml: line 6: no TOML: cannot redefine existing integer 'layers'; ",
        todo="a key stands once in a table: remove one of the two")

mistake("A patch is moved twice",
        case=CIRCLE + SPIN + 'rate = 1\n[motion.body]\nkind = "translation"\nvelocity = [1, 0]\n',
        says="case.toml: line 8: no TOML: cannot redefine existing table 'motion.body'; ",
        todo="a table stands once in a file: put all its keys under one heading")

mistake("A kind of motion that there is not", case=CIRCLE + '[motion.body]\nkind = "rotate"\ncentre = [0, 0]\nrate = 1\n',
        says='case.toml: line 5: motion.body.kind: expected one of "displacement-series", "expansion", '
             '"rigid-table", "rotation", "sequence", "stretch", "translation", "velocity", not "rotate"; ',
        todo='did you mean "rotation"?')

mistake("A vector of two numbers in space", case=SOLID + '[motion.ball]\nkind = "translation"\nvelocity = [1, 0]\n',
        files={"ball.off": ball()},
        says="case.toml: line 7: motion.ball.velocity: ",
        todo="expected a list of 3 finite numbers")

mistake("A rotation without a centre", case=CIRCLE + '[motion.body]\nkind = "rotation"\nrate = 1\n',
        says="case.toml: line 4: motion.body.centre: missing; ",
        todo="expected a list of 2 finite numbers")

mistake("No layers", case=CIRCLE + "[time]\nlayers = 0\n",
        says="case.toml: line 5: time.layers: ",
        todo="expected a whole number from 1 to 1000000, not 0")

mistake("The end is before the start", case=CIRCLE + "[time]\nstart = 2\nend = 1\n",
        says="case.toml: line 6: time.end: ",
        todo='expected a time after "start", 2, not 1')

mistake("An experiment that there is not", case='[initial]\nexperiment = "elipsoid"\n',
        says='case.toml: line 2: initial.experiment: no experiment "elipsoid"; there are "circle", '
             '"expanding-circle", "sphere", "expanding-sphere", "ellipsoid", "tandem-ellipsoids"; ',
        todo='did you mean "ellipsoid"?')

mistake("A level that an experiment does not have", case='[initial]\nexperiment = "ellipsoid"\nlevel = 12\n',
        says='case.toml: line 3: initial.level: experiment "ellipsoid" has no level 12; ',
        todo="give one from 1 to 7")

mistake("A format of hulls that there is not", case=CIRCLE + '[output]\nformats = ["vtk"]\n',
        says="case.toml: line 5: output.formats: ",
        todo='expected "vtu", "pvtu", "msh", not "vtk"')

mistake("Surfaces in the plane", case=SOLID.replace("dimension = 3", "dimension = 2"), files={"ball.off": ball()},
        says="case.toml: line 3: initial.surfaces: they are for dimension = 3; ",
        todo="give curves, or change dimension")

mistake("A box around a mesh", case=PLATE + BOX_2D, files={"plate.msh": SQUARE},
        says="case.toml: line 4: initial.box: a mesh is the whole domain, its outer boundary included; ",
        todo="remove this, or give curves instead of the mesh")

mistake("Bodies without a box", case=SOLID.replace(BOX, ""), files={"ball.off": ball()},
        says="case.toml: line 2: initial.box: missing; ",
        todo='expected "mesh", "experiment", or surfaces with exactly one of "box" and "outer"')

mistake("[fill] with caps that are meshed anew", case=CIRCLE + "[fill]\n",
        says="case.toml: line 4: fill: ",
        todo='expected [cap] reuse = "move" or "adapt" with it: caps that are meshed anew are not filled')

# --- Paths

mistake("The case file is not there", case=CIRCLE, command="build cases.toml", code=INPUT,
        says="cases.toml: cannot be read: No such file or directory; ",
        todo="did you mean case.toml?")

mistake("A folder instead of the case file in it", files={"room/case.toml": CIRCLE}, command="build room", code=INPUT,
        says="room: is a folder; ",
        todo="give the case file in it")

mistake("A mesh instead of a case file", files={"plate.msh": SQUARE}, command="build plate.msh",
        says="plate.msh: this is a mesh or surface (MSH), not a case file; ",
        todo="slabhull new plate.msh writes a case file to start with")

mistake("A path from the working directory, not from the case file",
        files={"room/case.toml": PLATE.replace("plate.msh", "room/plate.msh"), "room/plate.msh": SQUARE},
        command="build room/case.toml", code=INPUT,
        says="room/case.toml: initial.mesh: room/room/plate.msh: cannot be read: No such file or directory "
             "(paths in a case file start from its own folder); ",
        todo="there is no folder room/room: check the path")

mistake("The name of a mesh is misspelt", case=PLATE.replace("plate", "plaet"), files={"plate.msh": SQUARE}, code=INPUT,
        says="case.toml: initial.mesh: plaet.msh: cannot be read: No such file or directory (paths in a "
             "case file start from its own folder); ",
        todo="did you mean plate.msh?")

mistake("A folder instead of a mesh", case=PLATE.replace("plate.msh", "meshes"), files={"meshes/plate.msh": SQUARE}, code=INPUT,
        says="case.toml: initial.mesh: meshes: cannot be read: Is a directory; ",
        todo="give a file in it")

mistake("The model instead of the mesh", case=PLATE.replace(".msh", ".geo"), files={"plate.geo": "Point(1) = {0, 0, 0};\n"},
        code=INPUT, needs="formats",
        says="plate.geo: neither the name nor the content is that of a mesh file that is read; ",
        todo="mesh CAD models first, and export one of .msh .vtu .pvtu .vtk .xdmf .xmf .node .ele .face "
             ".poly .smesh .mesh .mfem .avro .stl .off .obj .ply")

mistake("A surface for projection that is not there",
        case=SOLID + '[project.ball]\nsurface = "file"\nfile = "ball.step"\n', files={"ball.off": ball()}, code=INPUT,
        says="case.toml: project.ball.file: ball.step: cannot be read: No such file or directory (paths in "
             "a case file start from its own folder); ",
        todo="there is none of nearly this name in {dir}: check the path")

# --- Files

mistake("An empty mesh file", case=PLATE, files={"plate.msh": ""}, code=INPUT,
        says="plate.msh: line 1: this is no MSH file: $MeshFormat was expected; the file is empty: ",
        todo="write it again")

mistake("A mesh of another format than its name says", case=PLATE.replace(".msh", ".vtu"), files={"plate.vtu": SQUARE},
        code=INPUT,
        says="plate.vtu: byte 0: this is no VTU file: No document element found; its content looks like MSH: ",
        todo="name it plate.msh, or export it anew")

mistake("An OFF file that is named STL", case=SOLID.replace(".off", ".stl"), files={"ball.stl": ball()}, code=INPUT,
        says='ball.stl: byte 0: this is no STL file: as text, it would begin with "solid"; export it anew; '
             "its content looks like OFF: ",
        todo="name it ball.off, or export it anew")

mistake("A download that was a web page", case=SOLID.replace(".off", ".stl"), code=INPUT,
        files={"ball.stl": "<!DOCTYPE html>\n<html><head><title>404: there is no such page</title></head><body></body></html>\n"},
        says='ball.stl: byte 0: this is no STL file: as text, it would begin with "solid"; ',
        todo="export it anew")

mistake("A binary STL that was cut off", case=SOLID.replace(".off", ".stl"), files={"ball.stl": binary_stl()[:300]}, code=INPUT,
        says="ball.stl: byte 0: 8 facets take 484 bytes, but the file has 300: it was cut short; ",
        todo="export or copy it again")

mistake("An old version of Gmsh's format", case=PLATE, files={"plate.msh": SQUARE.replace("2.2 0 8", "4 0 8")}, code=INPUT,
        says="plate.msh: line 2: MSH version 4 is not read; ",
        todo="save the mesh as version 4.1 or 2.2")

mistake("Gmsh saved what is in physical groups only, and the surface is in none", case=PLATE,
        files={"plate.msh": SQUARE.replace(TRIANGLES, "").replace("$Elements\n6", "$Elements\n4")}, code=INPUT,
        says="plate.msh: has no triangles, which a domain of dimension 2 is made of, but 4 lines; ",
        todo="give them under initial.curves if they are the outline of a body. If the surface is meant to "
             "be there: Gmsh saves what is in physical groups only, so give it one, too")

mistake("A mesh in the plane for a domain in space", case=PLATE.replace("2", "3"), files={"plate.msh": SQUARE}, code=INPUT,
        says="plate.msh: has no tetrahedra, which a domain of dimension 3 is made of, but 2 triangles; ",
        todo="set dimension = 2 if they are a plane domain, or give them under initial.surfaces if they "
             "are the surface of a body. If the volume is meant to be there: Gmsh saves what is in "
             "physical groups only, so give it one, too")

mistake("A mesh in space for a domain in the plane", case=PLATE, files={"plate.msh": TETRAHEDRON}, code=INPUT,
        says="plate.msh: has no triangles, which a domain of dimension 2 is made of, but 1 tetrahedra; ",
        todo="set dimension = 3")

mistake("A surface instead of a mesh of tetrahedra", case='dimension = 3\n[initial]\nmesh = "ball.off"\n',
        files={"ball.off": ball()}, code=INPUT,
        says="ball.off: has no tetrahedra, which a domain of dimension 3 is made of, but 8 triangles; ",
        todo="set dimension = 2 if they are a plane domain, or give them under initial.surfaces if they "
             "are the surface of a body. If the volume is meant to be there: Gmsh saves what is in "
             "physical groups only, so give it one, too")

mistake("A mesh that leaves the plane", case=PLATE, files={"plate.msh": SQUARE.replace("3 1 1 0", "3 1 1 0.5")}, code=INPUT,
        says="plate.msh: point 3 has z = 0.5, but a plane mesh (dimension = 2) has one z, here 0; ",
        todo="put the mesh into the plane of x and y, or set dimension = 3 for a mesh of tetrahedra")

mistake("Quadrangles", case=PLATE, code=INPUT,
        files={"plate.msh": SQUARE.replace(TRIANGLES, "5 3 2 5 1 1 2 3 4\n").replace("$Elements\n6", "$Elements\n5")},
        says="plate.msh: line 22: element 5 is a quadrangle; only points and straight lines, triangles and "
             "tetrahedra are read; ",
        todo="mesh without recombination into quadrangles or hexahedra")

mistake("Second-order triangles", case=PLATE, code=INPUT,
        files={"plate.msh": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0.5 0 0\n5 0.5 0.5 0\n"
                            "6 0 0.5 0\n$EndNodes\n$Elements\n1\n1 9 2 1 1 1 2 3 4 5 6\n$EndElements\n"},
        says="plate.msh: line 15: element 1 is a second-order triangle; ",
        todo="its corners are taken with initial.linear = true in a case, with --linear by convert")

mistake("One triangle is numbered the other way round", case=PLATE, code=INPUT,
        files={"plate.msh": SQUARE.replace("5 2 2 5 1 1 2 3", "5 2 2 5 1 2 1 3")},
        says="plate.msh: 1 inverted cells (oriented against the others of their entity): 5; ",
        todo="turn them round: swap two of their corners")

mistake("An element names a node that there is not", case=PLATE, code=INPUT,
        files={"plate.msh": SQUARE.replace("4 0 1 0", "40 0 1 0")},
        says="plate.msh: line 20: element 3 names node 4, which does not exist; ",
        todo="write the mesh again")

mistake("Two parts of a mesh that do not share their nodes", case=PLATE, code=INPUT,
        files={"plate.msh": SQUARE.replace(NODES, "$Nodes\n6\n1 1 1 0\n2 2 1 0\n3 2 2 0\n4 1 2 0\n5 1 1 0\n6 2 2 0\n")
               .replace("1 1 3 4", "1 5 6 4")},
        says="plate.msh: the boundary crosses or touches itself in 7 pairs of facets\n"
             "  facet 0 (patch right) and facet 3 (patch boundary) cross near (2, 2)\n"
             "  facet 0 (patch right) and facet 5 (patch boundary) cross near (2, 2)\n"
             "  facet 1 (patch boundary) and facet 3 (patch boundary) cross near (2, 2)\n"
             "  facet 1 (patch boundary) and facet 4 (patch boundary) cross near (1, 1)\n"
             "  facet 1 (patch boundary) and facet 5 (patch boundary) cross near (1.5, 1.5)\n"
             "  facet 2 (patch left) and facet 4 (patch boundary) cross near (1, 1)\n"
             "  facet 2 (patch left) and facet 5 (patch boundary) cross near (1, 1)\n",
        todo="Part them, or make them one surface; slabhull convert --weld TOLERANCE joins vertices that "
             "are in one place, or nearly")

mistake("A hull instead of a mesh", case='dimension = 2\n[initial]\nmesh = "run/slab_0000.vtu"\n', code=INPUT, needs="run",
        command="build case.toml --out out",
        says="run/slab_0000.vtu: this is the hull of a slab; ",
        todo="give a mesh in space, such as a cap (cap_0001.vtu)")

# --- Patches

mistake("The name of a patch is misspelt", case=PLATE + '[motion.rigth]\nkind = "translation"\nvelocity = [0, 0]\n',
        files={"plate.msh": SQUARE},
        says='case.toml: [motion.rigth]: the domain has no patch "rigth"; it has "left", "right"; ',
        todo='did you mean "right"?')

mistake("Physical groups have no names", case=PLATE + '[motion.left]\nkind = "translation"\nvelocity = [0, 0]\n',
        files={"plate.msh": SQUARE.replace(NAMES, "")},
        says='case.toml: [motion.left]: the domain has no patch "left"; it has "1", "2"; a number is a '
             "physical group without a name: ",
        todo="use the number, or name the group in the mesher")

mistake("A mesh without physical groups", case=PLATE + '[motion.left]\nkind = "translation"\nvelocity = [0, 0]\n',
        files={"plate.msh": SQUARE.replace(NAMES, "").replace(LINES, "").replace("$Elements\n6", "$Elements\n2")},
        says="warning: plate.msh: 4 of 4 boundary facets are in no physical group; they become the patch "
             '"boundary"; to move some of them by themselves, put them into a group\n'
             'slabhull: case.toml: [motion.left]: the domain has no patch "left"; ',
        todo='it has "boundary"')

mistake("Physical groups leave boundary facets out", case=PLATE, code=DONE,
        files={"plate.msh": SQUARE.replace("1 1 2 1 1 1 2\n", "").replace("$Elements\n6", "$Elements\n5")},
        says="warning: plate.msh: 1 of 4 boundary facets are in no physical group; they become the patch "
             '"boundary"; ',
        todo="to move some of them by themselves, put them into a group")

mistake("A region that there is not", case=PLATE + 'regions = ["fluid"]\n', files={"plate.msh": SQUARE},
        says='[initial] regions: plate.msh has no region "fluid"; ',
        todo='give of those that it has, "5"')

mistake("Two bodies get one name", case=TWO.replace('"b" }', '"a" }'), code=DONE, command="build case.toml --dry-run",
        files={"a.off": ball(), "b.off": ball((1.2, 0, 0))},
        says='warning: the patch "a" is part of several bodies: they move, or stand still, together; ',
        todo="give each a name of its own to move it alone")

# --- Surfaces

mistake("An open surface", case=SOLID, files={"ball.off": ball(facets=OCTAHEDRON[1:])}, code=INPUT,
        says="ball.off: the boundary is not a closed, oriented surface; 3 places are faulty\n"
             "  the edge from (0.5, 0, 0) to (0, 0.5, 0) is open: it is in facet 3 (patch ball) only\n"
             "  the edge from (0.5, 0, 0) to (0, 0, 0.5) is open: it is in facet 2 (patch ball) only\n"
             "  the edge from (0, 0.5, 0) to (0, 0, 0.5) is open: it is in facet 0 (patch ball) only\n",
        todo="Close it there, or turn facets round; slabhull convert --weld TOLERANCE joins vertices that "
             "are only nearly in one place")

mistake("An STL whose facets do not share their corners", case=SOLID.replace(".off", ".stl"), files={"ball.stl": loose_stl()},
        code=INPUT,
        says="ball.stl: the boundary is not a closed, oriented surface; 24 places are faulty\n"
             "  the edge from (0.5, 0, 0) to (0, 0.5, 0) is open: it is in facet 0 (patch ball) only\n"
             "  the edge from (0.5, 0, 0) to (0, 0, 0.5) is open: it is in facet 0 (patch ball) only\n"
             "  the edge from (0, 0.5, 0) to (0, 0, 0.5) is open: it is in facet 0 (patch ball) only\n"
             "  the edge from (1e-05, 0.50001, 1e-05) to (-0.49999, 1e-05, 1e-05) is open: it is in facet "
             "1 (patch ball) only\n"
             "  the edge from (1e-05, 0.50001, 1e-05) to (1e-05, 1e-05, 0.50001) is open: it is in facet 1 "
             "(patch ball) only\n"
             "  the edge from (-0.49999, 1e-05, 1e-05) to (1e-05, 1e-05, 0.50001) is open: it is in facet "
             "1 (patch ball) only\n"
             "  the edge from (-0.49998, 2e-05, 2e-05) to (2e-05, -0.49998, 2e-05) is open: it is in facet "
             "2 (patch ball) only\n"
             "  the edge from (-0.49998, 2e-05, 2e-05) to (2e-05, 2e-05, 0.50002) is open: it is in facet "
             "2 (patch ball) only\n",
        todo="Close it there, or turn facets round; slabhull convert --weld TOLERANCE joins vertices that "
             "are only nearly in one place")

mistake("A surface that crosses itself", case=SOLID, code=INPUT,
        files={"ball.off": ball().replace("0 0 0.5", "0.3 0.3 -0.8")},
        says="ball.off: the boundary crosses or touches itself in 3 pairs of facets\n"
             "  facet 2 (patch ball) and facet 4 (patch ball) cross near (0.0394737, 0.0394737, -0.421053)\n"
             "  facet 2 (patch ball) and facet 5 (patch ball) cross near (0, 0.0789474, -0.421053)\n"
             "  facet 2 (patch ball) and facet 7 (patch ball) cross near (0.0789474, 0, -0.421053)\n",
        todo="Part them, or make them one surface; slabhull convert --weld TOLERANCE joins vertices that "
             "are in one place, or nearly")

mistake("Two bodies that cross", case=WING_AND_FLAP, code=INPUT,
        files={"wing.dat": DIAMOND, "flap.dat": FLAP.replace("0.7", "0.3")},
        says="initial boundary of wing.dat, flap.dat: the boundary crosses or touches itself in 2 pairs of facets\n"
             "  facet 0 (patch wing) and facet 1 (patch flap) cross near (0.428571, 0.0285714)\n"
             "  facet 3 (patch wing) and facet 2 (patch flap) cross near (0.428571, -0.0285714)\n",
        todo="Part them, or make them one surface; slabhull convert --weld TOLERANCE joins vertices that "
             "are in one place, or nearly")

mistake("Two bodies that touch", case=TWO, files={"a.off": ball(), "b.off": ball((1, 0, 0))}, code=INPUT,
        says="initial boundary of a.off, b.off: the boundary crosses or touches itself in 16 pairs of facets\n"
             "  facet 0 (patch a) and facet 1 (patch b) cross near (0.5, 0, 0)\n"
             "  facet 0 (patch a) and facet 2 (patch b) cross near (0.5, 0, 0)\n"
             "  facet 0 (patch a) and facet 5 (patch b) cross near (0.5, 0, 0)\n"
             "  facet 0 (patch a) and facet 6 (patch b) cross near (0.5, 0, 0)\n"
             "  facet 3 (patch a) and facet 1 (patch b) cross near (0.5, 0, 0)\n"
             "  facet 3 (patch a) and facet 2 (patch b) cross near (0.5, 0, 0)\n"
             "  facet 3 (patch a) and facet 5 (patch b) cross near (0.5, 0, 0)\n"
             "  facet 3 (patch a) and facet 6 (patch b) cross near (0.5, 0, 0)\n",
        todo="Part them, or make them one surface; slabhull convert --weld TOLERANCE joins vertices that "
             "are in one place, or nearly")

mistake("A body through the wall of its box", case=SOLID, files={"ball.off": ball((1.8, 0.1, 0.1))}, code=INPUT,
        says="initial boundary of ball.off: the boundary crosses or touches itself in 10 pairs of facets\n"
             "  facet 0 (patch ball) and facet 74 (patch walls) cross near (2, 0.25, 0.25)\n"
             "  facet 0 (patch ball) and facet 75 (patch walls) cross near (2, 0.1, 0.4)\n"
             "  facet 0 (patch ball) and facet 77 (patch walls) cross near (2, 0.4, 0.1)\n"
             "  facet 0 (patch ball) and facet 85 (patch walls) cross near (2, 0.1, 0.4)\n"
             "  facet 3 (patch ball) and facet 75 (patch walls) cross near (2, 0.0166667, 0.316667)\n"
             "  facet 3 (patch ball) and facet 85 (patch walls) cross near (2, 0.1, 0.4)\n"
             "  facet 4 (patch ball) and facet 74 (patch walls) cross near (2, 0.275, -0.025)\n"
             "  facet 4 (patch ball) and facet 77 (patch walls) cross near (2, 0.4, 0.1)\n",
        todo="Part them, or make them one surface; slabhull convert --weld TOLERANCE joins vertices that "
             "are in one place, or nearly")

mistake("A body outside of its box", case=SOLID, files={"ball.off": ball((5, 0, 0))}, code=INPUT,
        says="initial boundary of ball.off: the closed part of the boundary with facet 0 (patch ball) at "
             "(5, 0.5, 0) bounds a body that lies outside the domain: outside the outer boundary, or "
             "inside another body; it extends from (4.5, -0.5, -0.5) to (5.5, 0.5, 0.5), the outer "
             "boundary from (-2, -2, -2) to (2, 2, 2). ",
        todo="Move it or change the outer boundary; if they are in different units, slabhull convert "
             "--scale changes those of a surface")

mistake("A body inside another one", case=TWO, files={"a.off": ball(radius=1), "b.off": ball(radius=0.3)}, code=INPUT,
        says="initial boundary of a.off, b.off: the closed part of the boundary with facet 0 (patch b) at "
             "(0, 0.3, 0) bounds a body that lies outside the domain: outside the outer boundary, or "
             "inside another body; it extends from (-0.3, -0.3, -0.3) to (0.3, 0.3, 0.3), the outer "
             "boundary from (-2, -2, -2) to (2, 2, 2). ",
        todo="Move it or change the outer boundary; if they are in different units, slabhull convert "
             "--scale changes those of a surface")

mistake("The body is in millimetres, the box in metres", case=SOLID, files={"ball.off": ball(radius=500)}, code=INPUT,
        says="initial boundary of ball.off: the closed part of the boundary with facet 0 (patch ball) at "
             "(0, 500, 0) bounds a body that lies outside the domain: outside the outer boundary, or "
             "inside another body; it extends from (-500, -500, -500) to (500, 500, 500), the outer "
             "boundary from (-2, -2, -2) to (2, 2, 2). ",
        todo="Move it or change the outer boundary; if they are in different units, slabhull convert "
             "--scale changes those of a surface")

mistake("The body is in metres, the box in millimetres", code=DONE, command="build case.toml --dry-run",
        case=SOLID.replace("-2", "-2000").replace("2, 2, 2", "2000, 2000, 2000").replace("0.8", "400"),
        files={"ball.off": ball(radius=0.05)},
        says="warning: initial boundary of ball.off: the largest body is 0.1 long, the outer boundary 4e+03: ",
        todo="if they are in different units, slabhull convert --scale changes those of a surface")

# --- Caps

mistake("A size beyond the whole numbers of doubles", case=CIRCLE + "[cap]\nsize = -9007199254740993\n",
        says="case.toml: line 5: cap.size: ", todo="expected a positive number, not -9007199254740992")

mistake("A key of very many parts", case=CIRCLE + ".".join("a" * 100000) + " = 1\n",
        says="case.toml: line 4: no TOML: a key of more than 1000 parts; ",
        todo="write key = value, a line each, under [table] headings")

mistake("A patch whose boundary is adapted and is not", says="case.toml: line 7: adapt.boundary: ",
        case=CIRCLE + '[cap]\nreuse = "adapt"\n[adapt]\nboundary = false\n[adapt.body]\nsize = 0.1\n',
        todo="expected true, or nothing, beside [adapt.body], which adapts the boundary")

mistake("A bound of TetGen in 2D", case=CIRCLE + "[cap]\nquality = 1.2\n", code=DONE,
        says="warning: cap.quality has no effect in 2D: ", todo="leave it out")

# --- Motions

mistake("Degrees for radians, with given layers", case=CIRCLE + SPIN + "rate = 90\n", code=GEOMETRY,
        says="warning: motion.body.rate: 90 radians per unit of time are 7.16 turns in the layer from t = "
             "0 to 0.5; if degrees were meant, give 1.5708\n"
             "slabhull: projection of patch body at t = 0.5 would move 32 vertices by more than half of "
             "their shortest edge, the farthest, vertex 4 at (9.48551917e+11, 2.70410133e+12), by 2.866e+12 with "
             "an edge of 5.618e+11; ",
        todo="check that the projection surface is that of the patch and that angles of its motion are in "
             "radians, or shorten the layers")

mistake("Degrees for radians, with layers that follow the motion", code=DONE, command="build case.toml --dry-run",
        case=WING + '[motion.wing]\nkind = "rotation"\ncentre = [0, 0]\nrate = 360\n', files={"wing.dat": DIAMOND},
        says="warning: motion.wing.rate: 360 radians per unit of time are 57.3 turns in the slab from t = 0 to 1; ",
        todo="if degrees were meant, give 6.28319")

mistake("Revolutions per minute for radians", code=GEOMETRY,
        case=WING + '[motion.wing]\nkind = "rotation"\ncentre = [0, 0]\nrate = 60000.5\n', files={"wing.dat": DIAMOND},
        says="the motion of patch wing would need more than 10000 layers in the slab from t = 0 to 1: with "
             "8192, it is 1.767 local edge lengths off its chords and turns by 156.7 degrees in a layer, "
             "worst near t = 6.10351562e-05; ",
        todo="check the motion, or make slabs shorter ([time] slabs), or let chords be longer ([time] "
             "layer_tolerance, layers, spacing)")

mistake("A motion out of the box", case=WING + '[motion.wing]\nkind = "translation"\nvelocity = [3, 0]\n',
        files={"wing.dat": DIAMOND}, code=GEOMETRY,
        says="patches wing and walls cross at t = 0.5 near (2, 0), facets 0 and 18, 19\n"
             "The boundary is good until t = 0.499023438, 49.9 % of the slab from 0 to 1: ",
        todo="end the slab there ([time] adapt = true does), or change the motion.")

mistake("A motion into another body", code=GEOMETRY, files={"wing.dat": DIAMOND, "flap.dat": FLAP},
        case=WING_AND_FLAP + '[motion.wing]\nkind = "translation"\nvelocity = [0.8, 0]\n',
        says="patches wing and flap cross at t = 0.250976562 near (0.700391, 0.00015625), facets 0 and 5\n"
             "The boundary is good until t = 0.25, 25 % of the slab from 0 to 1: ",
        todo="end the slab there ([time] adapt = true does), or change the motion.")

mistake("Layers that are too long for the motion", code=DONE, files={"wing.dat": DIAMOND},
        case=WING + '[motion.wing]\nkind = "rotation"\ncentre = [0, 0]\nrate = 6\n[time]\nlayers = 2\n',
        says="warning: slab 0: 2 layers are too few for the motion of patch wing: it is up to 0.863 local "
             "edge lengths off its chords (time.layer_tolerance is 0.05) and facets turn by up to 172 "
             "degrees in a layer, worst near t = 1; ",
        todo="12 would do. Without time.layers and time.spacing, the number follows from the motion")

mistake("A table that has degrees in its column of radians", case=BY_TABLE, files={"spin.csv": "time, angle\n0, 0\n1, 360\n"},
        code=GEOMETRY,
        says="projection of patch body at t = 0.5 would move 32 vertices by more than half of their "
             "shortest edge, the farthest, vertex 5 at (1.43391692e+32, -6.79208647e+31), by 1.587e+32 with an "
             "edge of 3.11e+31; ",
        todo="check that the projection surface is that of the patch and that angles of its motion are in "
             "radians, or shorten the layers")

mistake("Patches that share vertices are moved apart",
        case=PLATE + '[motion.left]\nkind = "translation"\nvelocity = [0.1, 0]\n', files={"plate.msh": SQUARE}, code=GEOMETRY,
        says="patch left and patch right share 2 vertices that their motions take to different places by t "
             "= 0.015625: 1 at (1, 0), 3 at (0, 1). ",
        todo="Give both the same motion there, part them, or let one of them stretch.")

mistake("A name in a formula that was not given", case=flow("-w * y", "w * x"), files={"wing.dat": DIAMOND},
        says='case.toml: [motion.wing]: velocity formula "-w * y": the name "w" means nothing here; ',
        todo="the variables are x, y, t, further ones stand in constants = { name = 1.0 }")

mistake("A formula that is cut off", case=flow("-2 *", "x"), files={"wing.dat": DIAMOND},
        says='case.toml: [motion.wing]: velocity formula "-2 *": Unexpected end of expression at position 5; ',
        todo="write it as in -2 * y + sin(pi * t), powers with ^")

mistake("Powers as in Python", case=flow("x**2", "x"), files={"wing.dat": DIAMOND},
        says='case.toml: [motion.wing]: velocity formula "x**2": Unexpected operator "*" found at position 2; ',
        todo="write it as in -2 * y + sin(pi * t), powers with ^")

mistake("A formula that divides by zero", case=flow("1 / t", "0"), files={"wing.dat": DIAMOND}, code=GEOMETRY,
        says='velocity formula "1 / t" is infinite (a division by zero?) at the point (0.5, 0) at t = 0; ',
        todo="change it so that it is finite wherever the patch goes")

mistake("A formula that has the root of a negative number", case=flow("sqrt(-1 - t)", "0"), files={"wing.dat": DIAMOND},
        code=GEOMETRY,
        says='velocity formula "sqrt(-1 - t)" is no number at the point (0.5, 0) at t = 0; ',
        todo="change it so that it is finite wherever the patch goes")

mistake("A sphere for projection that is far away", code=GEOMETRY, files={"wing.dat": DIAMOND},
        case=WING + '[project.wing]\nsurface = "circle"\ncentre = [10, 0]\nradius = 0.5\n[time]\nlayers = 1\n',
        says="projection of patch wing at t = 1 would move 4 vertices by more than half of their shortest "
             "edge, the farthest, vertex 2 at (-0.5, 0), by 10 with an edge of 0.5385; ",
        todo="check that the projection surface is that of the patch and that angles of its motion are in "
             "radians, or shorten the layers")

# --- Tables

mistake("Times in a table that decrease", case=BY_TABLE, code=INPUT,
        files={"spin.csv": "time, angle\n0, 0\n0.6, 1\n0.5, 2\n1, 3\n"},
        says="spin.csv: line 4: row 2 of a motion by table: its time 0.5 is not after that of the row before, 0.6; ",
        todo="put the rows in order of time, one for each time")

mistake("A column that is misspelt", case=BY_TABLE, files={"spin.csv": "time, angel\n0, 0\n1, 3\n"}, code=INPUT,
        says='spin.csv: there is no column "angle" (radians) or "angle_deg" (degrees); ',
        todo="name one so; the columns are time, angel")

mistake("A table without the names of its columns", case=BY_TABLE, files={"spin.csv": "0, 0\n0.5, 1\n1, 2\n"}, code=INPUT,
        says='spin.csv: line 1: the name of column 1 was expected, not "0"; ',
        todo="the first line names the columns, such as time, angle")

mistake("A table with decimal commas", case=BY_TABLE, files={"spin.csv": "time;angle\n0;0\n0,5;0,1\n1;3\n"}, code=INPUT,
        says='spin.csv: line 3: column "time": a finite number was expected, not "0,5"; ',
        todo="write numbers with a decimal point")

mistake("A row of a table that lacks a value", case=BY_TABLE, files={"spin.csv": "time, angle\n0, 0\n0.5\n1, 2\n"}, code=INPUT,
        says='spin.csv: line 3: column "angle" is missing: 1 values where the header names 2 columns; ',
        todo="give a value for each")

mistake("A table that ends before the case does", case=BY_TABLE, files={"spin.csv": "time, angle\n0, 0\n0.5, 3\n"}, code=INPUT,
        says="spin.csv: the rows go from t = 0 to 0.5, but the case from 0 to 1; ",
        todo="extend the table or change [time]")

mistake("A displacement file that lacks rows", code=INPUT,
        case=PLATE + '[motion.left]\nkind = "displacement-series"\nfiles = ["0.csv", "1.csv"]\ntimes = [0, 1]\n',
        files={"plate.msh": SQUARE, "0.csv": "x, y, dx, dy\n0, 0, 0, 0\n1, 0, 0, 0\n",
               "1.csv": "x, y, dx, dy\n0, 0, 0, 0\n1, 0, 0, 0\n"},
        says="0.csv: vertex of track 3 of patch left at (0, 1): no row is within the tolerance 1e-06; the "
             "nearest, line 2, is 1 away. So it is for 1 of 3 vertices; ",
        todo="give every vertex of the patch a row, with its place at the start")

# --- Sizes

mistake("cap.size is much too small", case=SOLID + "[cap]\nsize = 1e-3\n", files={"ball.off": ball()}, code=GEOMETRY,
        says="cells no longer than 0.001 (cap.size) in a domain of measure 63.83 are some 4.6e+11: indices "
             "count up to 4.3e+09. ",
        todo="A size from {size} on would do")

mistake("The box's size is much too small", case=SOLID.replace("0.8", "1e-4"), files={"ball.off": ball()}, code=GEOMETRY,
        says="initial.box.size: a box from (-2, -2, -2) to (2, 2, 2) with edges of size 0.0001 has more "
             "than 2^32 facets; ",
        todo="give a larger size")

# --- Output

mistake("A file where the folder for the output should be", case=CIRCLE, files={"notes.txt": "Monday\n"},
        command="build case.toml --out notes.txt", code=OUTPUT,
        says="notes.txt: this is a file, where a folder is wanted; ",
        todo="give another one with --out")

mistake("An output folder that cannot be made", case=CIRCLE, command="build case.toml --out /proc/out", code=OUTPUT,
        says="/proc/out: the folder cannot be made: No such file or directory; ",
        todo="give another one with --out")

mistake("--resume with another case", case=CIRCLE + "[time]\nlayers = 9\n", command="build case.toml --out run --resume",
        code=DONE, needs="run",
        says="warning: the case file, or a table or surface that it names, is not what it was when run/march.state was "
             "written: slabs that are there stay as they are, and what is left to do follows the new file; ",
        todo="to build all of it anew, run without --resume")

mistake("--resume where nothing was built", case=CIRCLE + "[time]\nlayers = 1\n", command="build case.toml --out runs --resume",
        code=DONE,
        says="warning: runs/march.state: no such checkpoint, ",
        todo="the run starts from the beginning")

mistake("--resume of a run by another version", case=CIRCLE, command="build case.toml --out run --resume", code=INPUT,
        needs="run", files={"run/march.state": b"slabhull march 1\n" + bytes(100)},
        says="run/march.state: is no checkpoint of this version of Slabhull, or is cut short; ",
        todo="start the run anew, without --resume")

# --- Other commands

mistake("A command that is misspelt", command="biuld case.toml", case=CIRCLE,
        says='there is no command "biuld"; ',
        todo='did you mean "build"?')

mistake("An option that is misspelt", command="build case.toml --thread 2", case=CIRCLE,
        says="build: there is no option --thread; ",
        todo='did you mean "--threads"?')

mistake("No command", command="",
        says="a command is missing; ",
        todo="slabhull --help lists the commands")

mistake("Nothing to look at", command="view --out page.html",
        says="view: FILE is required; ",
        todo="slabhull view --help says how it is called")

mistake("A view of a mesh in space", command="view plate.msh --out page.html", files={"plate.msh": SQUARE}, code=INPUT,
        needs="three",
        says="plate.msh: a mesh in space, neither the hull nor a filling of a slab; ",
        todo="give a file that slabhull build or fill wrote (slab_0000.vtu)")

mistake("A slice of a mesh in space", command="slice plate.msh --time 0.5 --out cut.vtu", files={"plate.msh": SQUARE}, code=INPUT,
        says="plate.msh: neither the hull of a slab nor a filling that can be cut; ",
        todo="give a hull that slabhull build wrote (slab_0000.vtu), or a filling as .h5 or .getfem")

mistake("A slice at a time outside of the slab", command="slice run/slab_0000.vtu --time 1.5 --out cut.vtu", needs="run",
        says="--time: t = 1.5 is in none of the files: run/slab_0000.vtu lasts from 0 to 1; ",
        todo="give a time in one of them")

mistake("A range of times that is no range", command="slice run/slab_0000.vtu --times 0-1 --out cuts.pvd", needs="run",
        says='--times: expected a finite number, not "0-1"; ',
        todo="write times as 0.5, 0:1:11 (first:last:number) or 0,0.5,1")

mistake("Several slices into one file", command="slice run/slab_0000.vtu --times 0:1:3 --out cut.vtu", needs="run",
        says="--out: cut.vtu holds one section, but there are 3 times; ",
        todo="give a directory or a .pvd file")

mistake("A filling of a mesh in space", command="fill plate.msh plate.mfem", files={"plate.msh": SQUARE},
        says="plate.msh: a mesh in space; only the hulls of slabs are filled: ",
        todo="give a file that slabhull build wrote (slab_0000.vtu)")

mistake("A filling of a hull whose caps were meshed anew", command="fill run/slab_0000.vtu run.mfem", needs="run", code=GEOMETRY,
        says="run/slab_0000.vtu: the cap at t = 0 has 409 vertices without a track, vertex 108, 109, 110, "
             "111, 112, 113, 114, 115, 116, 117, ...: the hull alone cannot be filled, since its caps are "
             "not one mesh moved. A cap that was meshed anew has none before it; ",
        todo='build with cap.reuse = "move" or "adapt". One that was adapted is filled from its VTU file, '
             "or by `build` with [fill] in the case file")

mistake("A filling in a format that holds none", command="fill run/slab_0000.vtu run.vtk", needs="run",
        says='run.vtk: "vtk" is no format of a filling in 2D+t; ',
        todo="there are mfem, getfem, h5, vtu, msh (--to)")

mistake("A time scale of nothing", command="fill run/slab_0000.vtu fill.vtu --method tetgen --time-scale 0", needs="run",
        says="fill: --time-scale: ",
        todo="expected a positive number, not 0; slabhull fill --help says how it is called")

mistake("A hull in place of its filling", command="check run/slab_0000.vtu --hull run/slab_0000.vtu", needs="run",
        says="run/slab_0000.vtu: the hull of a slab, no filling, which --hull compares with the hull that it fills; ",
        todo="leave --hull out to check it by itself")

mistake("An output in place of the input", command="convert run/slab_0000.vtu run/slab_0000.vtu --scale 2", needs="run",
        says="run/slab_0000.vtu: is read, so it is not written over; ",
        todo="give the output another name")

mistake("Tetrahedra into a format of surfaces", command="convert one.msh one.off", files={"one.msh": TETRAHEDRON}, code=OUTPUT,
        says="one.off: OFF has no place for tetrahedra; ",
        todo="give --extract-boundary for their surface")

mistake("A surface with more rows than it says", case=SOLID, files={"ball.off": ball() + "3 0 1 2\n"}, code=INPUT,
        says="ball.off: line 17: more follows after the 8 faces that the file says it has; ",
        todo="correct the counts, or export it anew")

mistake("An empty surface", command="info ball.off", files={"ball.off": ""}, code=INPUT,
        says="ball.off: line 1: the file ends where OFF was expected; the file is empty: ",
        todo="write it again")

mistake("Groups that overlap, in MSH 2.2", case=PLATE, code=INPUT,
        files={"plate.msh": SQUARE.replace("\n6\n1 1", "\n8\n1 1").replace(
            "$EndElements", "7 2 2 6 1 1 2 3\n8 2 2 6 1 1 3 4\n$EndElements")},
        says="warning: plate.msh: 2 triangles are listed again for another physical group, as MSH 2.2 does with groups that "
             "overlap; ",
        todo="leave such groups out, or write version 4.1\n"
             "slabhull: plate.msh: 4 cells meet in a facet of three or more: 5, 6, 7, 8")

mistake("A split of another dimension", case=CIRCLE + '[side]\nsplit = "A"\n',
        says='case.toml: line 5: side.split: no split "A" for dimension 2; ',
        todo='there are "diagonal", "centre"')

mistake("A comparison with a file that is no hull", command="check plate.msh --hull plate.msh", files={"plate.msh": SQUARE},
        says="--hull: plate.msh is not a hull in 2D+t; ",
        todo="give the one that was filled (slab_0000.vtu)")

mistake("A check of a text file", command="check notes.vtu", files={"notes.vtu": "Monday\n"}, code=INPUT,
        says="notes.vtu: byte 0: this is no VTU file: No document element found; it begins like no file "
             "that is read: ",
        todo="export it anew")

mistake("What is in a text file?", command="info notes.txt", files={"notes.txt": "Monday\n"}, needs="formats",
        says="notes.txt: no format has this extension; ",
        todo="give --from one of msh, vtu, pvtu, vtk, xdmf, tetgen, medit, mfem, avro, stl, off, obj, ply")

mistake("A text file by the name of a mesh", command="info notes.msh", files={"notes.msh": "Monday\n"}, code=INPUT,
        says="notes.msh: line 1: this is no MSH file: $MeshFormat was expected; it begins like no file "
             "that is read: ",
        todo="export it anew")

mistake("A conversion to a format that there is not", command="convert plate.msh plate.xyz", files={"plate.msh": SQUARE},
        needs="formats",
        says="plate.xyz: no format has this extension; ",
        todo="give --to one of msh, vtu, pvtu, vtk, xdmf, tetgen, medit, mfem, avro, stl, off, obj, ply")

mistake("A conversion into a folder that is not there", command="convert plate.msh new/plate.vtu", files={"plate.msh": SQUARE},
        code=OUTPUT,
        says="new/plate.vtu: cannot be created: No such file or directory; ",
        todo="make the folder new first")

mistake("A conversion of a patch that there is not", command="convert run/slab_0000.vtu body.vtu --patch bdy", needs="run",
        says='--patch: run/slab_0000.vtu has no patch "bdy"; ',
        todo="it has body, walls")

mistake("A new case over an old one", command="new plate.msh --out case.toml", case=CIRCLE, files={"plate.msh": SQUARE},
        says="case.toml exists; ",
        todo="--out another name, or remove it")

mistake("A study of an experiment that there is not", command="study elipsoid --out study",
        says='no experiment "elipsoid"; there are "circle", "expanding-circle", "sphere", '
             '"expanding-sphere", "ellipsoid", "tandem-ellipsoids"; ',
        todo='did you mean "ellipsoid"?')

mistake("A study of levels that there are not", command="study circle --levels 99 --out study",
        says='experiment "circle" has no level 99; ',
        todo="give one from 1 to 9")


# --- The test

JARGON = re.compile(r"\b(exceptions?|assert\w*|nullptr|std|errno|iterators?|stack|segfault|boost|CGAL|muParser|toml\+\+|pugi\w*|"
                    r"unordered|allocat\w+|0x[0-9a-f]+)\b|::|_t\b")
ADVICE = re.compile(r"\b(give|write|set|use|put|remove|change|check|choose|export|save|name|mesh|make|move|close|part|build|"
                    r"start|starts|extend|turn|leave|expected|did you mean|would do|there are|it has|help|stands?|have|moves?|"
                    r"taken|were meant|different units|the keys|end the slab|names the columns)\b", re.IGNORECASE)


def contents(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def names_a_place(entry):
    """A message names a file, an option, a key's table, a patch or the command."""
    words = [*entry.files, "case.toml", "motion.", "initial.", "patch", "cap.size", "cap.quality", "velocity formula", "slabhull --help", "run/"]
    words += [word for word in entry.command.split() if len(word) > 3]
    return any(word in entry.says + entry.todo for word in words)


def faults_of(entry, run):
    """All that is not as the entry has it, as texts. `run`: the folder of a finished run."""
    faults = []
    with tempfile.TemporaryDirectory(prefix="slabhull-mistake-") as name:
        folder = Path(name)
        if entry.needs == "run":
            shutil.copytree(run, folder / "run")
        for file, text in {**({"case.toml": entry.case} if entry.case else {}), **entry.files}.items():
            (folder / file).parent.mkdir(exist_ok=True)
            (folder / file).write_bytes(text if isinstance(text, bytes) else text.encode())
        before = contents(folder)
        done = harness.subprocess.run([harness.PROGRAM, *entry.command.split()], cwd=folder, capture_output=True, text=True,
                                      timeout=60)
        said = re.sub(r"A size from \S+ on", "A size from {size} on", done.stderr.replace(name, "{dir}"))  # by the free memory
        expected = f"slabhull: {entry.says}{entry.todo}\n"
        if said != expected:
            faults.append(f"said:\n{said}instead of:\n{expected}")
        if done.returncode != entry.code:
            faults.append(f"the exit code is {done.returncode}, not {entry.code}")
        if entry.code != DONE and contents(folder) != before:
            faults.append(f"files changed: {sorted(set(contents(folder).items()) ^ set(before.items()))[0][0]}")
        if entry.code != DONE and done.stdout:
            faults.append(f"on stdout: {done.stdout}")
    if not names_a_place(entry):
        faults.append("names neither file, option, key nor patch")
    if JARGON.search(entry.says + entry.todo):
        faults.append("has words that only programmers know")
    if not ADVICE.search(entry.todo):
        faults.append("does not say what to do")
    return faults


class Answers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory(prefix="slabhull-test-")
        cls.addClassCleanup(scratch.cleanup)
        cls.run_folder = Path(scratch.name) / "run"
        case = Path(scratch.name) / "case.toml"
        case.write_text(CIRCLE)
        built = harness.slabhull("build", case, "--out", cls.run_folder, "--quiet")
        assert built.code == 0, built.err

    def test_every_mistake_gets_its_answer(self):
        for entry in MISTAKES:
            with self.subTest(entry.title):
                if entry.needs == "formats" and harness.LEFT_OUT:
                    self.skipTest("left out of this build: some formats")
                if entry.needs == "three" and "has no three.js" in harness.slabhull("view", "x", "--out", "x.html").err:
                    self.skipTest("left out of this build: three.js")
                self.assertEqual(faults_of(entry, self.run_folder), [])

    def test_there_are_at_least_forty_and_each_once(self):
        self.assertGreaterEqual(len({entry.title for entry in MISTAKES}), 40)
        self.assertEqual(len({entry.title for entry in MISTAKES}), len(MISTAKES))

    def test_this_test_finds_wrong_messages_codes_and_files(self):
        good = MISTAKES[0]
        self.assertEqual(faults_of(good, self.run_folder), [])
        for change, fault in (({"todo": good.todo.replace("size", "sizes")}, "instead of"),
                              ({"says": "case.toml: "}, "instead of"),
                              ({"code": INPUT}, "the exit code is 2, not 3"), ({"todo": ""}, "what to do"),
                              ({"says": good.says + "std::"}, "programmers"),
                              ({"says": "line 5: unknown key; ", "todo": "remove it", "command": ""}, "names neither")):
            with self.subTest(change):
                self.assertIn(fault, "\n".join(faults_of(Mistake(**{**vars(good), **change}), self.run_folder)))
        leaves_files = Mistake("It builds", says="", todo="", code=USAGE, case=CIRCLE)
        faults = "\n".join(faults_of(leaves_files, self.run_folder))
        self.assertIn("files changed: out/", faults)
        self.assertIn("on stdout", faults)


if __name__ == "__main__":
    harness.main()
