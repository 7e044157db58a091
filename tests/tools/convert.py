# SPDX-License-Identifier: BSD-3-Clause
"""`slabhull convert`: what comes back, what is told, what the operations leave, against independent readers."""
import importlib.util
import json
import unittest

import harness
from harness import CIRCLE, ROOT, SPHERE, ProgramTest, needs_formats, slabhull

HULLS = (CIRCLE, SPHERE)
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


OFF = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"


class NothingInSilence(ConvertTest):
    """What a format or a number cannot hold is refused or told."""

    def legacy(self, name):
        """A file with an array over points."""
        path = self.dir / "named.vtk"
        path.write_text("# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 double\n0 0 0 1 0 0 0 1 0\n"
                        f"POLYGONS 1 4\n3 0 1 2\nPOINT_DATA 3\nFIELD FieldData 1\n{name} 1 3 double\n1 2 3\n")
        return path

    def test_names_of_arrays_that_a_format_does_not_have_are_refused(self):
        for name, target, words in (("a%00b", "x.vtu", "a character in its name that XML does not have"),
                                    ("a%01b", "x.pvtu", "XML"), ("a%EF%BF%BEb", "x.vtu", "XML"),
                                    ("a%0Ab", "x.msh", "a line end in the name of an array"),
                                    ("a%22b", "x.msh", "a double quote")):
            with self.subTest(name=name, target=target):
                self.refused_arguments(5, [words, "rename it"], self.legacy(name), self.dir / target)
                self.assertFalse((self.dir / target).exists())
        path = self.convert(self.legacy("ab"), "named.vtu", "--encoding", "ascii")
        path.write_text(path.read_text().replace('Name="ab"', 'Name=""'))
        self.refused_arguments(5, ["without a name", "name it"], path, self.dir / "x.vtk")

    def test_names_in_latin_1_become_utf_8_in_xml(self):
        path = self.convert(self.legacy("Temp%E9rature"), "x.vtu", "--encoding", "ascii")
        self.assertIn('Name="Température"', path.read_text(encoding="utf-8"))

    def test_arrays_of_msh_that_lack_rows_are_told(self):
        msh = self.convert(self.legacy("heat"), "x.msh", "--encoding", "ascii", "--version", "2.2")
        text = msh.read_text()
        self.assertIn("\n3\n1 1\n2 2\n3 3\n", text)
        for few in ("\n2\n1 1\n2 2\n", "\n3\n1 1\n2 2\n1 3\n"):
            msh.write_text(text.replace("\n3\n1 1\n2 2\n3 3\n", few))
            self.convert(msh, "y.vtu", told=['the array "heat" is left out: it has no value for some nodes'])
        msh.write_text(text + "$ElementNodeData\n$EndElementNodeData\n")
        self.convert(msh, "y.vtu", told=["$ElementNodeData is left out"])

    def test_a_scale_beyond_the_largest_number_is_refused(self):
        (self.dir / "a.off").write_text(OFF.replace("1 0 0\n0 1 0", "1e10 0 0\n0 1 0"))
        self.refused_arguments(4, ["scaled by 1e+300, point 1 is beyond the largest number"], self.dir / "a.off",
                               self.dir / "b.off", "--scale", 1e300)

    def test_an_stl_that_is_coarse_beside_its_edges_is_told(self):
        for place, told in (("0 0 0", ()), ("1e4 0 0", ["STL has single precision", "steps of 0.0012"])):
            x, y, z = map(float, place.split())
            corners = [(x, y, z), (x + 1, y, z), (x, y + 1, z), (x, y, z + 1)]
            text = "solid a\n" + "".join(
                "facet normal 0 0 0\nouter loop\n" + "".join("vertex {} {} {}\n".format(*corners[k]) for k in facet) +
                "endloop\nendfacet\n" for facet in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))) + "endsolid a\n"
            (self.dir / "a.stl").write_text(text)
            self.convert(self.dir / "a.stl", "a.vtu", told=told)


class RoundTrips(ConvertTest):
    def test_a_hull_as_vtu_comes_back_with_the_same_bytes(self):
        for text in HULLS:
            vtu, _ = self.hull(text)
            self.assertEqual(self.convert(vtu, "again.vtu").read_bytes(), vtu.read_bytes())

    def test_a_hull_goes_through_msh_and_stays_sound_and_the_same(self):
        for text in HULLS:
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
        for text in HULLS:
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


class Ways(ConvertTest):
    """The encodings, versions and dialects that formats offer."""

    def test_a_hull_goes_through_each_encoding_of_vtu_and_comes_back_with_the_same_bytes(self):
        for text in HULLS:
            vtu, _ = self.hull(text)
            sizes = {}
            for encoding in ("raw", "zlib", "lz4", "ascii"):
                there = self.convert(vtu, f"{encoding}.vtu", "--encoding", encoding)
                sizes[encoding] = there.stat().st_size
                self.assertEqual(self.convert(there, "back.vtu").read_bytes(), vtu.read_bytes(), encoding)
            self.assertEqual(len(set(sizes.values())), 4)
            self.assertLess(sizes["zlib"], sizes["lz4"])
            self.assertLess(sizes["lz4"], sizes["raw"])

    @harness.long
    def test_a_hull_goes_through_each_kind_of_msh_and_stays_the_same(self):
        for text in HULLS:
            vtu, _ = self.hull(text)
            plain = self.convert(vtu, "plain.msh", told=["field data"])
            for version in ("4.1", "2.2"):
                for encoding, mark in (("binary", 1), ("ascii", 0)):
                    there = self.convert(vtu, "there.msh", "--version", version, "--encoding", encoding,
                                         told=["field data"])
                    self.assertTrue(there.read_bytes().startswith(f"$MeshFormat\n{version} {mark} 8".encode()))
                    back = self.convert(there, "back.msh")
                    self.assertEqual(back.read_bytes(), plain.read_bytes(), (version, encoding))
                    self.assertEqual(self.check(there)["cells_by_patch"], self.check(vtu)["cells_by_patch"])

    @unittest.skipUnless(HAVE_READERS, "no meshio here")
    def test_groups_and_their_names_are_in_each_kind_of_msh(self):
        import meshio
        import numpy as np
        first = meshio.read(ROOM)
        for options in (["--version", "2.2"], ["--encoding", "ascii"], ["--version", "2.2", "--encoding", "ascii"]):
            second = meshio.read(self.convert(ROOM, "room.msh", *options, told=["geometric entities"]))
            np.testing.assert_array_equal(second.points, first.points)
            self.assertEqual({k: list(v) for k, v in second.field_data.items()},
                             {k: list(v) for k, v in first.field_data.items()})
            for kind in ("triangle", "tetra"):
                np.testing.assert_array_equal(second.get_cell_data("gmsh:physical", kind),
                                              first.get_cell_data("gmsh:physical", kind))

    @needs_formats("medit")
    def test_medit_s_dialect_keeps_the_times_of_a_hull(self):
        vtu, _ = self.hull(SPHERE)
        plain = self.convert(vtu, "plain.mesh", told=["names of groups: ", "initial", "point data t,"])
        self.assertIn("Dimension 3", plain.read_text()[:60])
        result = slabhull("convert", vtu, self.dir / "four.mesh", "--four-dimensional")
        self.assertEqual(result.code, 0, result.err)
        self.assertNotIn("point data t,", result.err)
        self.assertIn("Dimension 4", (self.dir / "four.mesh").read_text()[:60])
        there, back = (json.loads(slabhull("info", path, "--json").out) for path in (vtu, self.dir / "four.mesh"))
        self.assertEqual(back["kind"], "hull")
        self.assertEqual(back["bounds"], there["bounds"])
        self.assertEqual(back["measure"], there["measure"])
        result = slabhull("convert", ROOM, self.dir / "room.mesh", "--four-dimensional")
        self.assertEqual(result.code, 2)
        self.assertIn('point data "t"', result.err)
        self.assertFalse((self.dir / "room.mesh").exists())

    @needs_formats("tetgen")
    def test_a_hull_goes_through_tetgen_s_files_and_stays_sound(self):
        vtu, _ = self.hull(SPHERE)
        result = slabhull("convert", vtu, self.dir / "hull.ele")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("field data slab, time", result.err)
        for name in ("hull.node", "hull.ele", "hull.neigh"):
            self.assertIn(name, result.out)
            self.assertTrue((self.dir / name).exists())
        back = self.convert(self.dir / "hull.node", "back.vtu")
        for path in (back, self.dir / "hull.ele"):
            seen = self.check(path)
            for key in ("cells_by_region", "measure", "betti"):
                self.assertEqual(seen[key], self.check(vtu)[key], path)

    @needs_formats("tetgen")
    def test_tetgen_files_are_called_after_the_stem_and_leave_none_where_one_cannot_be_written(self):
        for name, files in (("a.poly", {"a.node", "a.face", "a.poly"}), ("b.smesh", {"b.node", "b.face", "b.smesh"}),
                            ("c.data", {"c.data.node", "c.data.face", "c.data.smesh"})):
            before = set(self.dir.iterdir())
            self.convert(ROOM, name, "--to", "tetgen", "--extract-boundary", told=["names of groups: bar, duct"])
            self.assertEqual({path.name for path in set(self.dir.iterdir()) - before}, files)
            seen = json.loads(slabhull("info", sorted(set(self.dir.iterdir()) - before)[-1], "--json",
                                       "--from", "tetgen").out)
            self.assertEqual(len([group for group in seen["groups"] if group["cells"]]), 3)
        (self.dir / "d.face").mkdir()
        self.refused_arguments(5, ["d.face"], ROOM, self.dir / "d.node")
        self.assertEqual([path.name for path in self.dir.glob("d.*")], ["d.face"])
        self.refused_arguments(5, ["e.smesh", ".ele"], ROOM, self.dir / "e.smesh")

    @needs_formats("medit", "mfem", "tetgen")
    def test_lower_simplices_and_groups_go_through_medit_mfem_and_tetgen(self):
        room = json.loads(slabhull("info", ROOM, "--json").out)
        groups = [(g["dimension"], g["number"], g["cells"]) for g in room["groups"]]
        for name in ("room.mesh", "room.mfem", "room.ele"):
            there = self.convert(ROOM, name, told=["names of groups: air, bar, duct, walls"])
            seen = json.loads(slabhull("info", self.convert(there, "back.msh"), "--json").out)
            self.assertEqual([(g["dimension"], g["number"], g["cells"]) for g in seen["groups"]], groups, name)
            self.assertEqual(seen["counts"], room["counts"], name)


class Parts(ConvertTest):
    @harness.long
    def test_a_hull_is_split_into_its_caps_and_the_patches_of_its_side(self):
        for text in HULLS:
            vtu, msh = self.hull(text)
            whole = self.check(vtu)
            for source in (vtu, msh):
                result = slabhull("convert", source, self.dir / "part.vtu", "--split-output")
                self.assertEqual(result.code, 0, result.err)
                self.assertEqual(len(result.out.splitlines()), 4)
                counts = {}
                for path in self.dir.glob("part_*.vtu"):
                    info = json.loads(slabhull("info", path, "--json").out)
                    counts[path.stem] = info["counts"]["triangles" if info["dimension"] == 2 else "tetrahedra"]
                    path.unlink()
                self.assertEqual(set(counts), {"part_initial", "part_terminating", "part_body", "part_walls"})
                self.assertEqual(counts["part_initial"], whole["cells_by_region"]["initial"])
                self.assertEqual(sum(counts.values()), whole["counts"]["cells"])

    def test_the_boundary_of_a_mesh_is_split_into_its_patches(self):
        result = slabhull("convert", ROOM, self.dir / "skin.stl", "--extract-boundary", "--split-output")
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual({path.name for path in self.dir.iterdir()},
                         {"skin_bar.stl", "skin_duct.stl", "skin_walls.stl"})
        self.assertEqual(len(result.err.splitlines()), 1)

    def test_a_split_that_fails_leaves_nothing(self):
        self.refused_arguments(5, ["STL", "tetrahedra"], ROOM, self.dir / "room.stl", "--split-output")
        single = self.dir / "one.off"
        single.write_text("OFF\n3 1 0\n0 0 1\n1 0 1\n0 1 1\n3 0 1 2\n")
        self.refused_arguments(2, ["--split-output", "neither regions nor patches"], single,
                               self.dir / "one.vtu", "--split-output")
        self.assertEqual([path.name for path in self.dir.iterdir()], ["one.off"])


class AllFormatsAreRead(ConvertTest):
    @needs_formats("vtk", "tetgen")
    def test_check_and_slice_read_a_hull_from_whatever_holds_it(self):
        vtu, _ = self.hull(SPHERE)
        sound = self.check(vtu)
        for name, told in (("hull.vtk", ()), ("hull.ele", ["field data"])):
            path = self.convert(vtu, name, told=told)
            self.assertEqual(self.check(path)["measure"], sound["measure"])
            result = slabhull("slice", path, "--time", "0.1", "--out", self.dir / "cut.vtu", "--json")
            self.assertEqual(result.code, 0, result.err)
            self.assertLess(json.loads(result.out)["sections"][0]["measure"]["closure"], 1e-9)

    @needs_formats("mfem", "medit", "tetgen")
    def test_a_domain_is_built_from_whatever_holds_it(self):
        text = (ROOT / "examples/room.toml").read_text()
        (self.dir / "room.msh").write_bytes(ROOM.read_bytes())
        _, gmsh = self.build(self.case(text, "room.toml"), out="gmsh")
        for name in ("room.mfem", "room.mesh", "room.node"):
            self.convert(ROOM, name, told=["names of groups"])
            numbered = text.replace("room.msh", name)
            for patch in json.loads(slabhull("info", ROOM, "--json").out)["groups"]:
                numbered = numbered.replace(f"motion.{patch['name']}]", f"motion.{patch['number']}]")
                numbered = numbered.replace(f"project.{patch['name']}]", f"project.{patch['number']}]")
            _, ours = self.build(self.case(numbered, "numbered.toml"), out=name + "_out")
            self.assertEqual(ours["slabs"][0]["measure"], gmsh["slabs"][0]["measure"], name)

    @needs_formats("vtk")
    def test_a_file_without_a_telling_name_is_known_by_its_content_or_by_from(self):
        vtu, msh = self.hull(CIRCLE)
        for source, name in ((vtu, "vtu"), (msh, "msh"), (self.convert(vtu, "a.vtk"), "vtk")):
            plain = self.dir / "plain"
            plain.write_bytes(source.read_bytes())
            self.check(plain)
            self.assertEqual(slabhull("check", plain, "--from", name).code, 0)
        self.assertEqual(slabhull("check", plain, "--from", "nothing").code, 2)
        plain.write_text("no mesh")
        result = slabhull("check", plain)
        self.assertEqual(result.code, 3)
        self.assertIn("neither the name nor the content", result.err)


class CaseFiles(ConvertTest):
    def test_build_writes_the_encodings_and_versions_that_the_case_asks_for(self):
        vtu, msh = self.hull(CIRCLE)
        output = '[output.vtu]\nencoding = "zlib"\n[output.msh]\nversion = "2.2"\nencoding = "ascii"\n'
        out, _ = self.build(self.case(CIRCLE + output), out="other")
        packed, old = out / "slab_0000.vtu", out / "slab_0000.msh"
        self.assertIn(b"vtkZLibDataCompressor", packed.read_bytes())
        self.assertEqual(self.convert(packed, "raw.vtu").read_bytes(), vtu.read_bytes())
        self.assertTrue(old.read_bytes().startswith(b"$MeshFormat\n2.2 0 8"))
        for path in (msh, old):
            self.convert(path, path.parent.name + ".vtu")
        self.assertEqual((self.dir / "other.vtu").read_bytes(), (self.dir / "out.vtu").read_bytes())
        for table, words in (('[output.vtu]\nencoding = "lzma"\n', ("encoding", "zlib", "lzma")),
                             ('[output.vtu]\nversion = "1.0"\n', ("version",)),
                             ('[output.msh]\nversion = "3"\n', ("version", "4.1"))):
            result = slabhull("build", self.case(CIRCLE + table), "--out", self.dir / "none")
            self.assertEqual(result.code, 2, result.err)
            for word in words:
                self.assertIn(word, result.err)


class Operations(ConvertTest):
    def test_a_hull_renumbered_along_a_curve_is_sound_and_has_the_same_measures(self):
        for text in HULLS:
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
        for text in HULLS:
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

    @unittest.skipUnless(HAVE_READERS, "no meshio here")
    def test_the_domain_lies_to_the_right_of_its_boundary_in_the_plane_as_in_sections(self):
        import meshio
        vtu, _ = self.hull(CIRCLE)
        cap = self.convert(vtu, "cap.vtu", "--region", "terminating")
        rim = meshio.read(self.convert(cap, "rim.vtu", "--extract-boundary"))
        cut = self.dir / "cut.vtu"
        self.assertEqual(slabhull("slice", vtu, "--time", str(self.check(vtu)["time"][1]), "--out", cut).code, 0)
        section = meshio.read(cut)

        def enclosed(mesh):
            a, b = (mesh.points[mesh.cells[0].data[:, k], :2] for k in (0, 1))
            return ((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2).sum()
        self.assertLess(enclosed(rim), 0)
        self.assertAlmostEqual(enclosed(rim) / enclosed(section), 1, delta=1e-9)

    def test_the_boundary_of_a_side_is_the_boundary_at_both_times(self):
        vtu, _ = self.hull(SPHERE)
        self.convert(vtu, "side.vtu", "--region", "side", "--extract-boundary")
        result = slabhull("convert", vtu, self.dir / "none.vtu", "--extract-boundary")
        self.assertEqual(result.code, 3)  # a closed hull has no boundary
        self.assertIn("no boundary", result.err)
        self.assertFalse((self.dir / "none.vtu").exists())

    def test_reversing_turns_a_hull_inside_out_and_twice_gives_the_same_bytes(self):
        for text in HULLS:
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
                (["--encoding", "binary, ascii", "zlib"], ["none.msh", self.dir / "a.msh", "--encoding", "zlib"]),
                (["--encoding", "one way only"], ["none.msh", self.dir / "a.off", "--encoding", "ascii"]),
                (["--version", "4.1, 2.2", "3"], ["none.msh", self.dir / "a.msh", "--version", "3"]),
                (["--version"], ["none.msh", out, "--version", "1.0"]),
                (["--four-dimensional", "Medit"], ["none.msh", out, "--four-dimensional"]),
                (["--weld"], ["none.msh", out, "--weld=-1"]),
                (["--scale"], ["none.msh", out, "--scale", "0"]),
                (["--region"], ["none.msh", out, "--region", "top"]),
                (["--renumber"], ["none.msh", out, "--renumber", "hilbert"])):
            self.refused_arguments(2, words, *arguments)
        self.refused_arguments(3, ["none.msh"], "none.msh", out)
        self.assertEqual(list(self.dir.iterdir()), [])

    def test_a_region_of_a_mesh_and_an_unknown_patch_are_refused_and_leave_nothing(self):
        out = self.dir / "out.vtu"
        self.refused_arguments(2, ["--region", "not a hull"], ROOM, out, "--region", "side")
        self.refused_arguments(2, ["door", "bar, duct", "walls"], ROOM, out, "--patch", "door")
        self.assertEqual(list(self.dir.iterdir()), [])

    def test_the_format_can_be_given_where_the_extension_says_nothing(self):
        data = self.dir / "mesh.data"
        data.write_bytes((FIXTURES / "vtk_raw.vtu").read_bytes())
        self.convert(data, "a.bin", "--from", "vtu", "--to", "vtu")
        self.assertIn(b"<VTKFile", (self.dir / "a.bin").read_bytes())


if __name__ == "__main__":
    harness.main()
