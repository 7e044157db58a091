# SPDX-License-Identifier: BSD-3-Clause
"""`slabhull convert`: what comes back, what is told, what the operations leave, against independent readers."""
import importlib.util
import json
import unittest

import harness
from harness import ROOT, ProgramTest, slabhull

CIRCLE = '[initial]\nexperiment = "expanding-circle"\nlevel = 2\n'
SPHERE = '[initial]\nexperiment = "expanding-sphere"\nlevel = 1\n'
ROOM = ROOT / "examples/room.msh"
FIXTURES = ROOT / "tests/data/io"
HAVE_READERS = all(importlib.util.find_spec(module) for module in ("meshio", "numpy"))


class ConvertTest(ProgramTest):
    def convert(self, source, target, *options, told=()):
        """A conversion that must succeed and tell these words, or nothing; returns the new file."""
        result = slabhull("convert", source, self.dir / target, *options)
        self.assertEqual(result.code, 0, result.err)
        if not told:
            self.assertEqual(result.err, "")
        for word in told:
            self.assertIn(word, result.err)
        return self.dir / target

    def hull(self, text, name="slab_0000"):
        out, _ = self.build(self.case(text))
        return out / f"{name}.vtu", out / f"{name}.msh"

    def refused_arguments(self, code, words, *arguments):
        result = slabhull("convert", *arguments)
        self.assertEqual(result.code, code, result.out + result.err)
        for word in words:
            self.assertIn(word, result.err)


class RoundTrips(ConvertTest):
    def test_a_hull_as_vtu_comes_back_with_the_same_bytes(self):
        for text in (CIRCLE, SPHERE):
            vtu, _ = self.hull(text)
            self.assertEqual(self.convert(vtu, "again.vtu").read_bytes(), vtu.read_bytes())

    def test_a_hull_goes_through_msh_and_stays_sound_and_the_same(self):
        for text in (CIRCLE, SPHERE):
            vtu, msh = self.hull(text)
            through = self.convert(vtu, "through.msh", told=["field data slab, time, dimension"])
            back = self.convert(through, "back.vtu")
            sound = self.check(vtu)
            for path in (through, back, self.convert(msh, "from_msh.vtu")):
                seen = self.check(path)
                for key in ("counts", "cells_by_region", "measure", "clean"):
                    expected = dict(sound[key]) if isinstance(sound[key], dict) else sound[key]
                    if path.name == "from_msh.vtu" and key == "counts":
                        expected["layers"] = 0  # an MSH as `build` writes it does not tell
                    self.assertEqual(seen[key], expected, path.name)
            again = self.convert(back, "again.msh")
            self.assertEqual(again.read_bytes(), through.read_bytes())

    @unittest.skipUnless(HAVE_READERS, "no meshio here")
    def test_meshio_sees_the_same_arrays_in_a_hull_that_went_through_msh(self):
        import meshio
        import numpy as np
        for text in (CIRCLE, SPHERE):
            vtu, _ = self.hull(text)
            through = self.convert(vtu, "through.msh", told=["field data"])
            back = meshio.read(self.convert(through, "back.vtu"))
            first = meshio.read(vtu)
            np.testing.assert_array_equal(back.points, first.points)
            np.testing.assert_array_equal(back.cells[0].data, first.cells[0].data)
            self.assertEqual(set(back.point_data), set(first.point_data))
            self.assertEqual(set(back.cell_data), set(first.cell_data))
            for name, values in first.point_data.items():
                np.testing.assert_array_equal(back.point_data[name], values, name)
            for name, values in first.cell_data.items():
                np.testing.assert_array_equal(back.cell_data[name][0], values[0], name)

    @unittest.skipUnless(HAVE_READERS, "no meshio here")
    def test_a_gmsh_mesh_keeps_its_triangles_groups_and_names_in_msh(self):
        import meshio
        import numpy as np
        first = meshio.read(ROOM)
        second = meshio.read(self.convert(ROOM, "room.msh", told=["geometric entities"]))
        np.testing.assert_array_equal(second.points, first.points)
        self.assertEqual({k: list(v) for k, v in second.field_data.items()},
                         {k: list(v) for k, v in first.field_data.items()})
        for kind in ("triangle", "tetra"):
            def rows(mesh):
                groups = mesh.get_cell_data("gmsh:physical", kind)
                return np.column_stack([mesh.get_cells_type(kind), groups])
            self.assertGreater(len(rows(first)), 0)
            np.testing.assert_array_equal(rows(second), rows(first))

    def test_the_converted_room_builds_the_same_hull(self):
        self.convert(ROOM, "room.msh", told=["geometric entities"])
        case = self.case((ROOT / "examples/room.toml").read_text(), "room.toml")
        _, ours = self.build(case, out="ours")
        (self.dir / "room.msh").write_bytes(ROOM.read_bytes())
        _, gmsh = self.build(case, out="gmsh")
        self.assertEqual(ours["slabs"][0]["measure"], gmsh["slabs"][0]["measure"])
        self.assertEqual(ours["slabs"][0]["counts"], gmsh["slabs"][0]["counts"])

    def test_what_vtu_cannot_hold_is_told_in_one_line(self):
        result = slabhull("convert", ROOM, self.dir / "room.vtu")
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual(len(result.err.splitlines()), 1)
        self.assertIn("VTU does not hold", result.err)
        self.assertIn("triangles", result.err)


class Operations(ConvertTest):
    def test_a_hull_renumbered_along_a_curve_is_sound_and_has_the_same_measures(self):
        for text in (CIRCLE, SPHERE):
            vtu, msh = self.hull(text)
            sound = self.check(vtu)
            for source, target in ((vtu, "curve.vtu"), (msh, "curve.vtu"), (vtu, "curve.msh")):
                told = ["field data"] if target == "curve.msh" else ()
                curve = self.convert(source, target, "--renumber", "curve", told=told)
                self.assertNotEqual(curve.read_bytes(), vtu.read_bytes())
                seen = self.check(curve)
                self.assertEqual(seen["cells_by_region"], sound["cells_by_region"])
                self.assertEqual(seen["cells_by_patch"], sound["cells_by_patch"])
                self.assertAlmostEqual(seen["measure"]["hull"] / sound["measure"]["hull"], 1, delta=1e-12)

    @unittest.skipUnless(HAVE_READERS, "no meshio here")
    def test_the_parts_of_a_hull_have_right_neighbors_and_cells(self):
        import meshio
        import numpy as np
        for text in (CIRCLE, SPHERE):
            vtu, msh = self.hull(text)
            whole = meshio.read(vtu)
            for code, region in enumerate(("initial", "side", "terminating")):
                cells = whole.cells[0].data[whole.cell_data["region"][0] == code]
                for source in (vtu, msh):
                    part = meshio.read(self.convert(source, "part.vtu", "--region", region))
                    ids = part.point_data["vertex_id"]
                    np.testing.assert_array_equal(ids[part.cells[0].data], whole.point_data["vertex_id"][cells])
                    self.assertEqual(len(np.unique(part.cells[0].data)), len(part.points))
                    self.adjacency_is_right(part)

    def adjacency_is_right(self, mesh):
        import numpy as np
        cells, neighbors = mesh.cells[0].data, mesh.cell_data["neighbors"][0]
        facets = {}
        for i in range(cells.shape[1]):
            for c, facet in enumerate(np.sort(np.delete(cells, i, axis=1), axis=1)):
                facets.setdefault(tuple(facet), []).append((c, i))
        expected = np.full_like(neighbors, -1)
        for users in facets.values():
            if len(users) == 2:
                (a, i), (b, j) = users
                expected[a, i], expected[b, j] = b, a
        np.testing.assert_array_equal(neighbors, expected)
        if "cell" in mesh.point_data:
            users = cells[mesh.point_data["cell"]]
            self.assertTrue((users == np.arange(len(mesh.points))[:, None]).any(axis=1).all())

    @unittest.skipUnless(HAVE_READERS, "no meshio here")
    def test_a_patch_of_a_hull_and_of_a_gmsh_mesh(self):
        import meshio
        vtu, _ = self.hull(CIRCLE)
        whole = meshio.read(vtu)
        part = meshio.read(self.convert(vtu, "body.vtu", "--patch", "body"))
        number = set(part.cell_data["patch"][0])
        self.assertEqual(len(number), 1)
        self.assertEqual(len(part.cells[0].data), (whole.cell_data["patch"][0] == number.pop()).sum())
        self.adjacency_is_right(part)
        room = meshio.read(ROOM)
        bar = meshio.read(self.convert(ROOM, "bar.vtu", "--patch", "bar", told=["own"]))
        expected = (room.get_cell_data("gmsh:physical", "triangle") == room.field_data["bar"][0]).sum()
        self.assertEqual(len(bar.get_cells_type("triangle")), expected)

    @unittest.skipUnless(HAVE_READERS, "no meshio here")
    def test_the_boundary_of_a_room_is_the_surface_that_gmsh_wrote_and_faces_outward(self):
        import meshio
        import numpy as np
        room = meshio.read(ROOM)
        skin = meshio.read(self.convert(ROOM, "skin.msh", "--extract-boundary", told=["own"]))

        def facets(mesh):
            return sorted((*sorted(map(tuple, mesh.points[triangle])), int(group)) for triangle, group in
                          zip(mesh.get_cells_type("triangle"), mesh.get_cell_data("gmsh:physical", "triangle")))
        self.assertEqual(facets(skin), facets(room))

        def signed(corners):
            return np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
        tets = room.points[room.get_cells_type("tetra")]
        volume = np.abs(np.linalg.det(tets[:, 1:] - tets[:, :1])).sum() / 6
        self.assertAlmostEqual(signed(skin.points[skin.get_cells_type("triangle")]) / volume, 1, delta=1e-12)

    def test_the_boundary_of_a_side_is_the_boundary_at_both_times(self):
        vtu, _ = self.hull(SPHERE)
        self.convert(vtu, "side.vtu", "--region", "side", "--extract-boundary")
        result = slabhull("convert", vtu, self.dir / "none.vtu", "--extract-boundary")
        self.assertEqual(result.code, 3)  # a closed hull has no boundary
        self.assertIn("no boundary", result.err)
        self.assertFalse((self.dir / "none.vtu").exists())

    def test_reversing_turns_a_hull_inside_out_and_twice_gives_the_same_bytes(self):
        for text in (CIRCLE, SPHERE):
            vtu, _ = self.hull(text)
            inside_out = self.convert(vtu, "inside_out.vtu", "--reverse")
            result = slabhull("check", inside_out, "--json")
            self.assertEqual(result.code, 1)
            defects = json.loads(result.out)["defects"]
            self.assertIn("inward-orientation", defects)
            self.assertNotIn("wrong-neighbor", defects)
            self.assertEqual(self.convert(inside_out, "back.vtu", "--reverse").read_bytes(), vtu.read_bytes())

    def test_scaling_moves_space_and_leaves_time(self):
        for text, dimension in ((CIRCLE, 2), (SPHERE, 3)):
            vtu, _ = self.hull(text)
            before, after = self.check(vtu), self.check(self.convert(vtu, "half.vtu", "--scale", "0.5"))
            self.assertEqual(after["time"], before["time"])
            for what, power in (("initial", dimension), ("terminating", dimension), ("enclosed", dimension)):
                self.assertAlmostEqual(after["measure"][what] / before["measure"][what], 0.5**power, delta=1e-12)

    def test_facets_that_only_meet_in_place_are_welded_to_a_hull_again(self):
        square = self.dir / "two.off"
        square.write_text("OFF\n6 3 0\n0 0 0\n1 0 0\n0 1 0\n1 0 1e-9\n1 1 0\n0 1 1e-9\n"
                          "3 0 1 2\n3 3 4 5\n3 1 3 2\n")
        result = slabhull("convert", square, self.dir / "one.msh", "--weld", "1e-6")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("2 points welded to others, 1 cells that collapsed", result.err)
        self.assertIn("4 points, 2 triangles", result.out)
        result = slabhull("convert", square, self.dir / "six.msh", "--weld", "1e-12")
        self.assertIn("6 points, 3 triangles", result.out)


class Info(ConvertTest):
    def info(self, path):
        result = slabhull("info", path, "--json")
        self.assertEqual(result.code, 0, result.err)
        return json.loads(result.out)

    def test_a_hull_has_the_measures_of_its_check_in_each_format(self):
        for text, corners in ((CIRCLE, 3), (SPHERE, 6)):
            for path in self.hull(text):
                sound, seen = self.check(path), self.info(path)
                self.assertEqual(seen["kind"], "hull")
                self.assertEqual(seen["counts"]["points"], sound["counts"]["vertices"])
                self.assertEqual(seen["bounds"]["t"], sound["time"])
                for ours, theirs in (("initial", "initial"), ("side", "intermediate"), ("terminating",) * 2):
                    self.assertEqual(seen["regions"][ours]["cells"], sound["cells_by_region"][theirs])
                    self.assertAlmostEqual(seen["regions"][ours]["measure"], sound["measure"][theirs])
                self.assertEqual({str(g["number"]): g["cells"] for g in seen["groups"]}, sound["cells_by_patch"])
                self.assertEqual(seen["angle"]["smallest"], sound["angle"]["smallest"])
                histogram = seen["angle"]["histogram"]
                self.assertEqual(sum(histogram), corners * sound["counts"]["cells"])
                filled = [k for k, count in enumerate(histogram) if count]
                self.assertEqual(filled[0], int(sound["angle"]["smallest"] // 10))
                self.assertEqual(filled[-1], int(sound["angle"]["largest"] // 10))

    def test_a_right_triangle_is_told_in_words(self):
        path = self.dir / "one.off"
        path.write_text("OFF\n3 1 0\n0 0 1\n1 0 1\n0 1 1\n3 0 1 2\n")
        result = slabhull("info", path)
        self.assertEqual(result.code, 0, result.err)
        for words in ("OFF, mesh of dimension 2", "3 points, 1 triangles", "measure 0.5", "angles 45.0 to 90.0"):
            self.assertIn(words, result.out)
        self.assertEqual(sum(self.info(path)["angle"]["histogram"]), 3)
        self.assertEqual(slabhull("info", self.dir / "a.xyz").code, 2)


class Refusals(ConvertTest):
    def test_wrong_formats_and_options_are_refused_before_anything_is_read(self):
        out = self.dir / "out.vtu"
        for words, arguments in (
                (["a.xyz", "--from"], ["a.xyz", out]),
                (["a.xyz", "--to"], ["none.msh", self.dir / "a.xyz"]),
                (["--to", "nothing"], ["none.msh", out, "--to", "nothing"]),
                (["TetGen is not written"], ["none.msh", self.dir / "a.data", "--to", "tetgen"]),
                (["--weld"], ["none.msh", out, "--weld=-1"]),
                (["--scale"], ["none.msh", out, "--scale", "0"]),
                (["--region"], ["none.msh", out, "--region", "top"]),
                (["--renumber"], ["none.msh", out, "--renumber", "hilbert"])):
            self.refused_arguments(2, words, *arguments)
        self.refused_arguments(3, ["none.msh"], "none.msh", out)
        self.assertEqual(list(self.dir.iterdir()), [])

    def test_a_region_of_a_mesh_and_an_unknown_patch_are_refused_and_leave_nothing(self):
        out = self.dir / "out.vtu"
        self.refused_arguments(2, ["--region", "no hull"], ROOM, out, "--region", "side")
        self.refused_arguments(2, ["door", "bar, duct", "walls"], ROOM, out, "--patch", "door")
        self.assertEqual(list(self.dir.iterdir()), [])

    def test_the_format_can_be_given_where_the_extension_says_nothing(self):
        data = self.dir / "mesh.data"
        data.write_bytes((FIXTURES / "vtk_raw.vtu").read_bytes())
        self.convert(data, "a.bin", "--from", "vtu", "--to", "vtu")
        self.assertIn(b"<VTKFile", (self.dir / "a.bin").read_bytes())


if __name__ == "__main__":
    harness.main()
