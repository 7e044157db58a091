#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Input as users have it: polygons, turned facets, files with parts, meshes of several volumes, second-order and
mixed cells, airfoils in either order; and wishes that no machine meets."""
import json
import math
import subprocess
import unittest

import harness
from harness import ProgramTest, slabhull

CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
QUADS = {"bottom": [(0, 2, 3, 1)], "top": [(4, 5, 7, 6)], "sides": [(0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6)]}
FACES = [face for part in QUADS.values() for face in part]


def halves(face):
    a, b, c, d = face
    return [(a, b, c), (a, c, d)]


def off(points, faces):
    rows = [" ".join(f"{x!r}" for x in p) for p in points]
    rows += [f"{len(f)} " + " ".join(map(str, f)) for f in faces]
    return f"OFF\n{len(points)} {len(faces)} 0\n" + "\n".join(rows) + "\n"


def stl():
    text = ""
    for name, faces in QUADS.items():
        text += f"solid {name}\n"
        for triangle in (t for face in faces for t in halves(face)):
            corners = "".join("vertex {} {} {}\n".format(*CORNERS[v]) for v in triangle)
            text += f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n"
        text += f"endsolid {name}\n"
    return text


def obj(statement):
    text = "".join("v {} {} {}\n".format(*p) for p in CORNERS)
    for name, faces in QUADS.items():
        text += f"{statement} {name}\n" + "".join("f " + " ".join(str(v - 8) for v in f) + "\n" for f in faces)
    return text


def ply():
    rows = "".join("{} {} {}\n".format(*p) for p in CORNERS)
    rows += "".join("4 {} {} {} {} {}\n".format(*f, part)
                    for part, faces in enumerate(QUADS.values()) for f in faces)
    return ("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 6\n"
            "property list uchar int vertex_indices\nproperty int patch\nend_header\n" + rows)


def klein_bottle(m=12, n=12):
    """Closed, but one-sided: a grid whose last row is joined to the first one turned round."""
    points = []
    for i in range(m):
        for j in range(n):
            u, v = 2 * math.pi * i / m, 2 * math.pi * j / n
            r = 2 + math.cos(u / 2) * math.sin(v) - math.sin(u / 2) * math.sin(2 * v)
            points.append((r * math.cos(u), r * math.sin(u), math.sin(u / 2) * math.sin(v) + math.cos(u / 2) * math.sin(2 * v)))

    def vertex(i, j):
        return (i % m) * n + (j if i < m else -j) % n

    faces = []
    for i in range(m):
        for j in range(n):
            a, b, c, d = vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
            faces += [(a, b, c), (a, c, d)]
    return off(points, faces)


class SurfaceTest(ProgramTest):
    def body(self, file, text, key='patch = "body"'):
        (self.dir / file).write_text(text)
        return self.case(f'dimension = 3\n[initial]\nsurfaces = [ {{ file = "{file}", {key} }} ]\n'
                         "box = { min = [-2, -2, -2], max = [3, 3, 3], size = 2 }\n[time]\nlayers = 1\n")

    def built(self, case):
        """The report and the messages of a hull that is sound."""
        result = slabhull("build", case, "--out", self.dir / "out")
        self.assertEqual(result.code, 0, result.err)
        report = json.loads((self.dir / "out" / "report.json").read_text())
        self.assertAlmostEqual(report["slabs"][0]["measure"]["initial"], 125 - 1, places=9)
        return report, result.err


class Surfaces(SurfaceTest):
    def test_planar_polygons_are_cut_and_counted(self):
        for name, text in (("a.off", off(CORNERS, FACES)), ("a.obj", obj("g")), ("a.ply", ply())):
            with self.subTest(name):
                _, messages = self.built(self.body(name, text))
                self.assertIn("6 planar polygons are cut into 12 triangles", messages)

    def test_a_polygon_that_is_not_planar_is_named(self):
        bent = CORNERS[:7] + [(1, 1, 1.01)]
        self.refused(self.body("a.off", off(bent, FACES)), 3, "a.off", "face 1 has 4 vertices", "not in one plane")

    def test_turned_facets_are_turned_back_and_counted(self):
        triangles = [t for face in FACES for t in halves(face)]
        some = [t[::-1] if i in (0, 5, 7) else t for i, t in enumerate(triangles)]
        _, messages = self.built(self.body("a.off", off(CORNERS, some)))
        self.assertIn("3 of 12 facets pointed inward, unlike the others, and were turned", messages)
        _, messages = self.built(self.body("a.off", off(CORNERS, [t[::-1] for t in some])))
        self.assertIn("9 of 12 facets pointed inward", messages)
        inside_out = off(CORNERS, [t[::-1] for t in triangles])
        self.assertNotIn("turned", self.built(self.body("a.off", inside_out))[1])

    def test_turned_facets_give_the_hull_of_the_surface_that_was_meant(self):
        triangles = [t for face in FACES for t in halves(face)]
        hulls = []
        for turned in ((), (2, 3, 9)):
            text = off(CORNERS, [(t[1], t[0], t[2]) if i in turned else t for i, t in enumerate(triangles)])
            self.built(self.body("a.off", text))
            hulls.append((self.dir / "out" / "slab_0000.vtu").read_bytes())
        self.assertEqual(hulls[0], hulls[1])

    def test_a_klein_bottle_has_no_inside(self):
        self.refused(self.body("a.off", klein_bottle()), 3, "a.off", "one side only", "Klein bottle", "facets")

    def test_facets_that_fall_together_are_told(self):
        flat = "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n"
        _, messages = self.built(self.body("a.stl", stl() + flat))
        self.assertIn("1 facets with two equal corners are left out", messages)


class PatchesOfFiles(SurfaceTest):
    def test_parts_of_a_file_are_patches(self):
        for name, text, names in (("a.stl", stl(), list(QUADS)), ("g.obj", obj("g"), list(QUADS)),
                                  ("o.obj", obj("o"), list(QUADS)), ("m.obj", obj("usemtl"), list(QUADS)),
                                  ("a.ply", ply(), ["0", "1", "2"])):
            with self.subTest(name):
                report, _ = self.built(self.body(name, text, 'patches = "file"'))
                self.assertEqual(sorted(report["patches"].values()), sorted([*names, "walls"]))

    def test_groups_of_a_mesh_file_are_patches(self):
        (self.dir / "a.stl").write_text(stl())
        self.assertEqual(slabhull("convert", self.dir / "a.stl", self.dir / "a.msh").code, 0)
        report, _ = self.built(self.body("b.stl", stl(), 'patches = "file"').rename(self.dir / "unused") and self.case(
            'dimension = 3\n[initial]\nsurfaces = [ { file = "a.msh", patches = "file" } ]\n'
            "box = { min = [-2, -2, -2], max = [3, 3, 3], size = 2 }\n[time]\nlayers = 1\n"))
        self.assertEqual(sorted(report["patches"].values()), ["bottom", "sides", "top", "walls"])

    def test_parts_that_become_one_patch_are_told(self):
        report, messages = self.built(self.body("a.stl", stl()))
        self.assertEqual(sorted(report["patches"].values()), ["body", "walls"])
        for word in ("bottom", "top", "sides", 'patches = "file"'):
            self.assertIn(word, messages)

    def test_each_part_can_move_by_itself(self):
        case = self.body("a.stl", stl(), 'patches = "file"')
        moving = case.read_text() + '[motion.top]\nkind = "translation"\nvelocity = [0, 0, 0.1]\n[motion.sides]\nkind = "stretch"\n'
        out, report = self.build(self.case(moving))
        self.check(out / "slab_0000.vtu")
        self.assertAlmostEqual(report["slabs"][0]["measure"]["terminating"], 125 - 1.1, places=6)

    def test_facets_without_a_name_need_one(self):
        nameless = stl().replace("solid top", "solid")
        self.refused(self.body("a.stl", nameless, 'patches = "file"'), 3, "2 facets are in no part", "patch =")
        report, _ = self.built(self.body("a.stl", nameless, 'patches = "file", patch = "rest"'))
        self.assertEqual(sorted(report["patches"].values()), ["bottom", "rest", "sides", "walls"])

    def test_names_that_hulls_use_themselves(self):
        for name in ("", "initial", "terminating"):
            with self.subTest(name):
                self.refused(self.body("a.stl", stl(), f'patch = "{name}"'), 2, "patch", "neither empty nor")
        self.refused(self.body("a.stl", stl().replace("top", "terminating"), 'patches = "file"'), 3, "terminating", "rename")
        self.refused(self.body("a.stl", stl(), 'patches = "fil"'), 2, '"file"')

    def test_one_name_for_a_body_and_the_box_is_told(self):
        self.assertIn('"walls" is part of a body and of the outer boundary',
                      self.built(self.body("a.stl", stl(), 'patch = "walls"'))[1])


def kuhn_mesh(n, region, interfaces, order=1):
    """MSH 2.2 of an n x n x n grid of cubes cut into tetrahedra: region(cube) gives the number of its volume,
    interfaces the physical groups (number, name) of the faces between two volumes, by their pair (0: outside)."""
    def vertex(i, j, k):
        return 1 + i + (n + 1) * (j + (n + 1) * k)

    steps = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)]
    cells, facets = [], {}
    for cube in ((i, j, k) for k in range(n) for j in range(n) for i in range(n)):
        for step in steps:
            at, corners = list(cube), [vertex(*cube)]
            for axis in step:
                at[axis] += 1
                corners.append(vertex(*at))
            if step in steps[3:]:  # an odd permutation
                corners[0], corners[1] = corners[1], corners[0]
            cells.append((region(cube), corners))
            for left in range(4):
                facet = tuple(sorted(corners[:left] + corners[left + 1:]))
                facets.setdefault(facet, []).append(region(cube))
    rows = []
    for facet, sides in facets.items():
        pair = frozenset(sides if len(sides) == 2 else sides + [0])
        for number, _ in interfaces.get(pair, []) if len(pair) == 2 else []:
            rows.append(f"2 2 {number} {number} " + " ".join(map(str, facet)))
    rows += [f"4 2 {number} {number} " + " ".join(map(str, corners)) for number, corners in cells]
    nodes = [f"{vertex(i, j, k)} {i} {j} {k}" for k in range(n + 1) for j in range(n + 1) for i in range(n + 1)]
    names = [f'2 {number} "{name}"' for groups in interfaces.values() for number, name in groups]
    names += ['3 1 "fluid"', '3 2 "solid"']
    return ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" + "\n".join([str(len(names)), *names]) +
            f"\n$EndPhysicalNames\n$Nodes\n{len(nodes)}\n" + "\n".join(nodes) + f"\n$EndNodes\n$Elements\n{len(rows)}\n" +
            "\n".join(f"{i + 1} {row}" for i, row in enumerate(rows)) + "\n$EndElements\n")


def inner_cube(cube):
    return 2 if cube == (1, 1, 1) else 1


WALLS, SKIN = (11, "walls"), (12, "skin")
INTERFACES = {frozenset((0, 1)): [WALLS], frozenset((1, 2)): [SKIN]}


class Regions(ProgramTest):
    def of_mesh(self, keys="", more="", interfaces=INTERFACES):
        (self.dir / "a.msh").write_text(kuhn_mesh(3, inner_cube, interfaces))
        return self.case(f'dimension = 3\n[initial]\nmesh = "a.msh"\n{keys}\n[time]\nlayers = 1\n{more}')

    def built(self, case):
        result = slabhull("build", case, "--out", self.dir / "out")
        self.assertEqual(result.code, 0, result.err)
        report = json.loads((self.dir / "out" / "report.json").read_text())
        return sorted(report["patches"].values()), report["slabs"][0]["measure"]["initial"], result.err

    def test_inner_interfaces_are_named_and_what_to_do(self):
        patches, volume, messages = self.built(self.of_mesh())
        self.assertEqual((patches, round(volume, 9)), (["walls"], 27))
        self.assertIn('"skin" (12 facets between "fluid" and "solid")', messages)
        self.assertIn("initial.regions", messages)

    def test_a_motion_of_an_inner_interface_says_what_it_is(self):
        moving = '[motion.skin]\nkind = "translation"\nvelocity = [0.1, 0, 0]\n'
        self.refused(self.of_mesh(more=moving), 2, "[motion.skin]", "inner interface", "cannot move", "initial.regions")
        patches, _, _ = self.built(self.of_mesh('regions = ["fluid"]', moving))
        self.assertEqual(patches, ["skin", "walls"])

    def test_regions_are_the_domain(self):
        patches, volume, messages = self.built(self.of_mesh('regions = ["fluid"]'))
        self.assertEqual((patches, round(volume, 9), messages.count("warning")), (["skin", "walls"], 26, 0))
        patches, volume, _ = self.built(self.of_mesh('regions = ["solid"]'))
        self.assertEqual((patches, round(volume, 9)), (["skin"], 1))
        both = self.built(self.of_mesh('regions = ["solid", "fluid"]'))
        self.assertEqual((both[0], round(both[1], 9)), (["walls"], 27))

    def test_a_region_that_there_is_not(self):
        self.refused(self.of_mesh('regions = ["fluids"]'), 2, '"fluids"', '"fluid", "solid"')
        self.refused(self.of_mesh("regions = []"), 2, "regions", "at least one")

    def test_facets_in_two_groups_and_groups_without_facets_are_told(self):
        twice = INTERFACES | {frozenset((0, 1)): [WALLS, (13, "again")], frozenset((7, 8)): [(14, "nothing")]}
        _, _, messages = self.built(self.of_mesh(interfaces=twice))
        self.assertIn('108 facets are listed for "walls" and again for "again"', messages)
        self.assertIn('groups that have a name, but no triangles: "nothing"', messages)

    def test_an_entity_in_two_groups_is_told(self):
        """MSH 4.1 gives the groups by entity."""
        (self.dir / "a.msh").write_text(
            '$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 "one"\n1 2 "two"\n2 3 "all"\n$EndPhysicalNames\n'
            "$Entities\n0 1 1 0\n1 0 0 0 1 1 0 2 1 2 0\n1 0 0 0 1 1 0 1 3 0\n$EndEntities\n"
            "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
            "$Elements\n2 4 1 4\n1 1 1 3\n1 1 2\n2 2 3\n3 3 1\n2 1 2 1\n4 1 2 3\n$EndElements\n")
        case = self.case('dimension = 2\n[initial]\nmesh = "a.msh"\n[time]\nlayers = 1\n')
        patches, _, messages = self.built(case)
        self.assertEqual(patches, ["one"])
        self.assertIn('3 lines are in several physical groups, "one", "two"; they count in "one" only', messages)


def second_order_triangle():
    """One curved triangle with its sides, MSH 2.2."""
    return ('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 "rim"\n2 2 "disk"\n$EndPhysicalNames\n$Nodes\n6\n'
            "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0.5 -0.1 0\n5 0.6 0.6 0\n6 -0.1 0.5 0\n$EndNodes\n$Elements\n4\n"
            "1 8 2 1 1 1 2 4\n2 8 2 1 1 2 3 5\n3 8 2 1 1 3 1 6\n4 9 2 2 1 1 2 3 4 5 6\n$EndElements\n")


class Cells(ProgramTest):
    def test_corners_of_second_order_cells_are_taken_when_asked_for(self):
        (self.dir / "a.msh").write_text(second_order_triangle())
        head = 'dimension = 2\n[initial]\nmesh = "a.msh"\n'
        self.refused(self.case(head), 3, "element 1 is a second-order line", "initial.linear = true", "--linear")
        result = slabhull("build", self.case(head + "linear = true\n[time]\nlayers = 1\n"), "--out", self.dir / "out")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("4 curved elements: their corners are taken, 3 points between them left out", result.err)
        report = json.loads((self.dir / "out" / "report.json").read_text())
        self.assertEqual(list(report["patches"].values()), ["rim"])
        self.assertAlmostEqual(report["slabs"][0]["measure"]["initial"], 0.5, places=12)

    def test_convert_takes_corners_when_asked_for(self):
        source, target = self.dir / "a.msh", self.dir / "b.vtu"
        source.write_text(second_order_triangle())
        self.assertEqual(slabhull("convert", source, target).code, 3)
        self.assertFalse(target.exists())
        done = slabhull("convert", source, target, "--linear")
        self.assertEqual(done.code, 0, done.err)
        self.assertIn("curved elements", done.err)
        self.assertIn("3 points, 1 triangles", done.out)

    def test_a_mixed_vtu_is_a_domain_with_patches(self):
        """As meshio writes it."""
        for array, key in (("gmsh:physical", ""), ("medit:ref", ""), ("patch", ""), ("zone", 'patch_array = "zone"')):
            with self.subTest(array):
                (self.dir / "a.vtu").write_text(
                    '<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="6"><Points>'
                    '<DataArray type="Float64" NumberOfComponents="3">0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points><Cells>'
                    '<DataArray type="Int64" Name="connectivity">0 1 1 2 2 3 3 0 0 1 2 0 2 3</DataArray>'
                    '<DataArray type="Int64" Name="offsets">2 4 6 8 11 14</DataArray>'
                    '<DataArray type="UInt8" Name="types">3 3 3 3 5 5</DataArray></Cells><CellData>'
                    f'<DataArray type="Int64" Name="{array}">4 4 5 4 9 9</DataArray></CellData></Piece></UnstructuredGrid>'
                    "</VTKFile>")
                case = self.case(f'dimension = 2\n[initial]\nmesh = "a.vtu"\n{key}\n[time]\nlayers = 1\n')
                _, report = self.build(case)
                self.assertEqual(sorted(report["patches"].values()), ["4", "5"])


class Airfoils(ProgramTest):
    def test_both_orders_of_airfoil_files_give_one_hull(self):
        x = [0.5 - 0.5 * math.cos(math.pi * i / 20) for i in range(21)]
        half = [0.1 * math.sqrt(t) * (1 - t) for t in x]
        upper, lower = list(zip(x, half)), [(t, -0.6 * h) for t, h in zip(x, half)]

        def rows(points):
            return "".join(f"{a!r} {b!r}\n" for a, b in points)

        hulls = []
        for text in ("SELIG\n" + rows(upper[::-1] + lower[1:]), f"LEDNICER\n {21.}  {21.}\n\n{rows(upper)}\n{rows(lower)}"):
            (self.dir / "a.dat").write_text(text)
            case = self.case('dimension = 2\n[initial]\ncurves = [ { file = "a.dat", patch = "wing" } ]\n'
                             "box = { min = [-1, -1], max = [2, 1], size = 0.5 }\n[time]\nlayers = 1\n")
            out, _ = self.build(case)
            self.check(out / "slab_0000.vtu")
            hulls.append((out / "slab_0000.vtu").read_bytes())
        self.assertEqual(hulls[0], hulls[1])


class Wishes(SurfaceTest):
    """What no machine can do is told within seconds, with figures."""

    def wish(self, keys, *words):
        case = self.body("a.stl", stl())
        self.refused(self.case(case.read_text().replace("[time]\nlayers = 1\n", keys)), 4, *words)

    def test_cells_that_indices_do_not_count(self):
        self.wish("[cap]\nsize = 1e-3\n", "cap.size", "8.9e+11", "indices count up to", "would do")

    def test_layers_that_do_not_fit(self):
        self.wish("[time]\nlayers = 1000000\n[side]\nsplit = \"E\"\n", "1000000 layers", "simplices", "GB are free")

    def test_layers_that_take_minutes_are_told_of_at_once(self):
        case = self.body("a.stl", stl())
        case.write_text(case.read_text().replace("layers = 1\n", "layers = 200000\n[check]\nembedding = false\n"))
        build = subprocess.Popen([harness.PROGRAM, "build", case, "--out", self.dir / "out", "--quiet"], text=True,
                                 stderr=subprocess.PIPE)
        told = next(line for line in build.stderr if "200000 layers" in line)
        build.terminate()
        build.communicate(timeout=60)
        self.assertRegex(told, r"simplices; that takes some [0-9.]+ GB and [0-9]+ minutes")
        self.assertEqual([file.name for file in (self.dir / "out").iterdir()], [])

    def test_a_gap_that_the_mesher_cannot_resolve(self):
        for gap, refused in ((1e-9, True), (1e-6, False)):
            for name, shift in (("a", 0), ("b", 1 + gap)):
                points = [(x + shift, y, z) for x, y, z in CORNERS]
                (self.dir / f"{name}.off").write_text(off(points, FACES))
            case = self.case('dimension = 3\n[initial]\nsurfaces = [ { file = "a.off", patch = "left" }, { file = "b.off", '
                             'patch = "right" } ]\nbox = { min = [-2, -2, -2], max = [4, 3, 3], size = 2 }\n[time]\nlayers = 1\n')
            if refused:
                self.refused(case, 4, '"left" and "right" are 1e-09 apart', "takes points within")
            else:
                self.build(case)


if __name__ == "__main__":
    harness.main()
