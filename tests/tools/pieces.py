# SPDX-License-Identifier: BSD-3-Clause
"""`slabhull convert --pieces`, and hulls that `build` writes so: what independent readers see of the pieces, what comes back, what is refused."""
import importlib.util
import json
import resource
import subprocess
import unittest

import harness
from harness import CIRCLE, PROGRAM, ROOT, SPHERE, ProgramTest, slabhull

ROOM = ROOT / "examples/room.msh"
HAVE_GMSH = all(importlib.util.find_spec(module) for module in ("gmsh", "numpy"))
HAVE_VTK = all(importlib.util.find_spec(module) for module in ("vtk", "numpy"))


class PiecesTest(ProgramTest):
    def hull(self, text):
        out, _ = self.build(self.case(text))
        return out / "slab_0000.vtu"

    def convert(self, source, target, *options):
        result = slabhull("convert", source, self.dir / target, *options)
        self.assertEqual(result.code, 0, result.err)
        return self.dir / target

    def refused(self, code, words, *arguments):
        result = slabhull("convert", *arguments)
        self.assertEqual(result.code, code, result.out + result.err)
        for word in words:
            self.assertIn(word, result.err)


class Pvtu(PiecesTest):
    def test_a_hull_in_pieces_comes_back_with_the_same_bytes(self):
        for text in (CIRCLE, SPHERE):
            hull = self.hull(text)
            for pieces in (1, 2, 7):
                whole = self.convert(hull, "whole.pvtu", "--pieces", pieces)
                self.assertEqual(self.convert(whole, "back.vtu").read_bytes(), hull.read_bytes())

    def test_each_piece_has_its_own_points_and_a_fair_share_of_the_cells(self):
        hull = self.hull(SPHERE)
        self.convert(hull, "whole.pvtu", "--pieces", 4)
        self.assertEqual(sorted(p.name for p in self.dir.glob("whole*")),
                         ["whole.pvtu", "whole_0.vtu", "whole_1.vtu", "whole_2.vtu", "whole_3.vtu"])
        sizes = [p.stat().st_size for p in self.dir.glob("whole_*.vtu")]
        self.assertLess(max(sizes), 0.4 * hull.stat().st_size)

    @unittest.skipUnless(HAVE_VTK, "no VTK here")
    def test_vtk_reads_the_pieces_and_sees_the_same_mesh(self):
        import numpy as np
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy

        def seen(reader, path):
            failures = []
            reader.AddObserver("ErrorEvent", lambda *_: failures.append(path))
            reader.SetFileName(str(path))
            reader.Update()
            self.assertEqual(failures, [])
            grid = reader.GetOutput()
            corners = grid.GetCell(0).GetNumberOfPoints()
            arrays = {}
            for attributes in (grid.GetPointData(), grid.GetCellData()):
                for i in range(attributes.GetNumberOfArrays()):
                    arrays[attributes.GetArrayName(i)] = vtk_to_numpy(attributes.GetArray(i))
            return (grid, vtk_to_numpy(grid.GetPoints().GetData()),
                    vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, corners), arrays)

        for text in (CIRCLE, SPHERE):
            hull = self.hull(text)
            _, points, cells, arrays = seen(vtk.vtkXMLUnstructuredGridReader(), hull)
            whole = self.convert(hull, "whole.pvtu", "--pieces", 5)
            grid, their_points, their_cells, theirs = seen(vtk.vtkXMLPUnstructuredGridReader(), whole)
            numbers = theirs.pop("GlobalPointIds")
            self.assertEqual(grid.GetPointData().GetGlobalIds().GetName(), "GlobalPointIds")
            self.assertEqual(grid.GetCellData().GetGlobalIds().GetName(), "GlobalCellIds")
            np.testing.assert_array_equal(theirs.pop("GlobalCellIds"), np.arange(len(cells)))
            np.testing.assert_array_equal(np.unique(numbers), np.arange(len(points)))
            np.testing.assert_array_equal(their_points, points[numbers])
            np.testing.assert_array_equal(numbers[their_cells], cells)
            self.assertEqual(set(theirs), set(arrays))
            for name, values in arrays.items():
                expected = values[numbers] if len(values) == len(points) else values
                np.testing.assert_array_equal(theirs[name], expected, name)

    @unittest.skipUnless(HAVE_VTK, "no VTK here")
    def test_pieces_that_vtk_wrote_with_ghost_cells_are_joined_to_the_mesh_that_was_cut(self):
        import vtk
        hull = self.hull(SPHERE)
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(hull))
        ids = vtk.vtkIdFilter()
        ids.SetPointIdsArrayName("GlobalPointIds")
        ids.SetCellIdsArrayName("GlobalCellIds")
        ids.SetInputConnection(reader.GetOutputPort())
        cut = vtk.vtkExtractUnstructuredGridPiece()
        cut.CreateGhostCellsOn()
        cut.SetInputConnection(ids.GetOutputPort())
        writer = vtk.vtkXMLPUnstructuredGridWriter()
        writer.SetNumberOfPieces(3)
        writer.SetEndPiece(2)
        writer.SetGhostLevel(1)
        writer.SetFileName(str(self.dir / "parts.pvtu"))
        writer.SetInputConnection(cut.GetOutputPort())
        self.assertEqual(writer.Write(), 1)
        self.assertIn("vtkGhostType", (self.dir / "parts.pvtu").read_text())
        back = self.convert(self.dir / "parts.pvtu", "back.vtu")
        self.assertEqual(self.check(back)["counts"], self.check(hull)["counts"])

    def test_points_with_the_same_number_in_different_places_are_refused(self):
        whole = self.convert(self.hull(CIRCLE), "whole.pvtu", "--pieces", 2)
        moved = self.convert(self.dir / "whole_1.vtu", "moved.vtu", "--scale", 2)
        moved.replace(self.dir / "whole_1.vtu")
        self.refused(3, ["whole.pvtu", "GlobalPointIds", "different places"], whole, self.dir / "back.vtu")

    def test_a_missing_piece_and_one_named_twice_are_refused(self):
        whole = self.convert(self.hull(CIRCLE), "whole.pvtu", "--pieces", 2)
        (self.dir / "twice.pvtu").write_text(whole.read_text().replace("whole_1", "whole_0"))
        self.refused(3, ["whole_0.vtu", "twice"], self.dir / "twice.pvtu", self.dir / "back.vtu")
        (self.dir / "whole_1.vtu").unlink()
        self.refused(3, ["whole_1.vtu"], whole, self.dir / "back.vtu")

    def test_wrong_numbers_of_pieces_and_formats_are_refused(self):
        self.refused(2, ["--pieces"], ROOM, self.dir / "room.pvtu", "--pieces", 0)
        self.refused(2, ["4.1"], ROOM, self.dir / "out.msh", "--pieces", 2, "--version", "2.2")
        self.refused(2, ["--pieces", "4.1"], self.dir / "none.msh", self.dir / "out.msh", "--pieces", 2, "--encoding", "ascii")
        self.refused(2, ["10000000 pieces"], ROOM, self.dir / "room.pvtu", "--pieces", 10000000)
        self.refused(2, ["not written in pieces"], ROOM, self.dir / "room.off", "--pieces", 2)
        self.assertEqual(list(self.dir.iterdir()), [])

    def test_a_disk_that_is_full_midway_leaves_no_piece_and_keeps_what_was_there(self):
        hull = self.hull(SPHERE)
        whole = self.convert(hull, "whole.pvtu", "--pieces", 3)
        before = {p.name: p.read_bytes() for p in self.dir.glob("whole*")}
        limit = max(len(content) for content in before.values()) // 2
        done = subprocess.run([PROGRAM, "convert", hull, whole, "--pieces", "2"], capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertEqual({p.name: p.read_bytes() for p in self.dir.glob("*whole*")}, before)


class Msh(PiecesTest):
    def seen_by_gmsh(self, *files):
        """Nodes and elements by tag, views and partitions; whatever Gmsh complains about fails."""
        import gmsh
        import numpy as np
        gmsh.initialize()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.logger.start()
            gmsh.open(str(files[0]))
            for file in files[1:]:
                gmsh.merge(str(file))
            complaints = [line for line in gmsh.logger.get() if line.startswith(("Error", "Warning"))]
            self.assertEqual(complaints, [])
            top = gmsh.model.getDimension()
            tags, x, _ = gmsh.model.mesh.getNodes()
            nodes = dict(zip(tags.tolist(), map(tuple, x.reshape(-1, 3).tolist())))
            elements = {}
            for dimension in range(1, top + 1):
                for tag, corners in zip(*self.rows_of(gmsh, dimension)):
                    elements[int(tag)] = tuple(map(int, corners))
            groups = {}
            for dimension, number in gmsh.model.getPhysicalGroups():
                name = gmsh.model.getPhysicalName(dimension, number)
                members = [gmsh.model.mesh.getElements(dimension, entity)[1]
                           for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, number)]
                groups[name] = sorted(int(t) for lists in members for tags in lists for t in tags)
            views = {}
            for tag in gmsh.view.getTags():
                name = gmsh.option.getString(f"View[{gmsh.view.getIndex(tag)}].Name")
                _, where, values, _, _ = gmsh.view.getModelData(tag, 0)
                views.setdefault(name, {}).update(zip(map(int, where), map(float, np.concatenate(values))))
            partitions = {int(p) for entity in gmsh.model.getEntities(top)
                          for p in gmsh.model.getPartitions(*entity)}
            return nodes, elements, groups, views, partitions
        finally:
            gmsh.logger.stop()
            gmsh.finalize()

    @staticmethod
    def rows_of(gmsh, dimension):
        tags, corners = gmsh.model.mesh.getElementsByType({1: 1, 2: 2, 3: 4}[dimension])
        return tags, corners.reshape(-1, dimension + 1)

    @unittest.skipUnless(HAVE_GMSH, "no Gmsh here")
    def test_gmsh_puts_the_pieces_together_to_the_same_mesh(self):
        hull = self.hull(CIRCLE)
        for source, pieces in ((ROOM, 3), (hull, 4)):
            whole = self.convert(source, "whole.msh")
            self.convert(source, "split.msh", "--pieces", pieces)
            files = [self.dir / f"split_{k + 1}.msh" for k in range(pieces)]
            self.assertEqual(sorted(self.dir.glob("split*")), files)
            *expected, _ = self.seen_by_gmsh(whole)
            *seen, partitions = self.seen_by_gmsh(*files)
            for ours, theirs in zip(seen, expected):
                self.assertEqual(ours, theirs)
            self.assertEqual(partitions, set(range(1, pieces + 1)))
            for file in files:
                file.unlink()

    def test_each_piece_is_read_again_with_the_numbers_of_the_whole_mesh(self):
        self.convert(ROOM, "split.msh", "--pieces", 3)
        cells = 0
        for k in (1, 2, 3):
            found = json.loads(slabhull("info", self.dir / f"split_{k}.msh", "--json").out)
            cells += found["counts"]["tetrahedra"]
        whole = json.loads(slabhull("info", ROOM, "--json").out)
        self.assertEqual(cells, whole["counts"]["tetrahedra"])


class Build(PiecesTest):
    PIECES = '[output]\nformats = ["pvtu", "msh"]\npieces = 3\n'

    def test_hulls_are_written_in_the_pieces_that_convert_makes(self):
        for text in (CIRCLE, SPHERE):
            whole, _ = self.build(self.case(text), out="whole")
            out, _ = self.build(self.case(text + self.PIECES), out="out")
            self.convert(whole / "slab_0000.vtu", "slab_0000.pvtu", "--pieces", 3)
            self.convert(whole / "slab_0000.msh", "slab_0000.msh", "--pieces", 3)
            expected = {p.name: p.read_bytes() for p in self.dir.glob("slab_0000*")}
            self.assertEqual(len(expected), 7)
            self.assertEqual({p.name: p.read_bytes() for p in out.glob("slab_0000*")}, expected)
            self.assertEqual((out / "cap_0001.vtu").read_bytes(), (whole / "cap_0001.vtu").read_bytes())
            self.assertIn('"slab_0000.pvtu"', (out / "slabs.pvd").read_text())
            self.check(out / "slab_0000.pvtu")

    def test_all_files_of_a_slab_are_told(self):
        result = slabhull("build", self.case(CIRCLE + self.PIECES), "--out", self.dir / "out")
        self.assertEqual(result.code, 0, result.err)
        told = [line.strip().rsplit("/", 1)[-1] for line in result.out.splitlines()[1:]]
        self.assertEqual(sorted(told + ["march.state", "slabs.jsonl"]),
                         sorted(p.name for p in (self.dir / "out").iterdir()))
        self.assertEqual(told[:4], ["slab_0000_0.vtu", "slab_0000_1.vtu", "slab_0000_2.vtu", "slab_0000.pvtu"])

    def test_a_pvtu_without_a_number_of_pieces_has_one_packed_as_the_case_says(self):
        out, _ = self.build(self.case(CIRCLE + '[output]\nformats = ["pvtu"]\n[output.pvtu]\nencoding = "zlib"\n'))
        self.assertEqual(sorted(p.name for p in out.glob("slab*")),
                         ["slab_0000.pvtu", "slab_0000_0.vtu", "slabs.jsonl", "slabs.pvd"])
        self.assertIn(b"vtkZLibDataCompressor", (out / "slab_0000_0.vtu").read_bytes())
        self.check(out / "slab_0000.pvtu")

    def test_formats_and_numbers_that_make_no_pieces_are_refused_before_anything_is_built(self):
        for output, *words in (
                ("pieces = 2\n", "line 5", "output.pieces", "VTU is not written in pieces; .pvtu and MSH are"),
                ('formats = ["pvtu", "vtu"]\npieces = 2\n', "output.pieces", "VTU is not written in pieces"),
                ('formats = ["msh"]\npieces = 2\n[output.msh]\nversion = "2.2"\n', "output.pieces", "4.1, binary"),
                ('formats = ["msh"]\npieces = 2\n[output.msh]\nencoding = "ascii"\n', "output.pieces", "4.1, binary"),
                ('formats = ["msh"]\npieces = 0\n', "output.pieces", "from 1 to"),
                ('formats = ["msh"]\npieces = "two"\n', "output.pieces", "a whole number")):
            self.refused_build(2, words, output)
            self.assertFalse((self.dir / "out").exists())

    def test_a_hull_of_fewer_cells_than_pieces_leaves_no_slab(self):
        self.refused_build(2, ["1000000 pieces"], 'formats = ["msh", "pvtu"]\npieces = 1000000\n')
        self.assertEqual(list((self.dir / "out").iterdir()), [])

    def test_a_disk_that_is_full_midway_leaves_no_piece_and_keeps_what_was_there(self):
        case = self.case(CIRCLE + self.PIECES)
        out, _ = self.build(case)
        before = {p.name: p.read_bytes() for p in out.iterdir()}
        limit = max(p.stat().st_size for p in out.glob("slab_0000*.vtu")) - 1000
        done = subprocess.run([PROGRAM, "build", case, "--out", out], capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertEqual({p.name: p.read_bytes() for p in out.iterdir()}, before)

    def refused_build(self, code, words, output):
        result = slabhull("build", self.case(CIRCLE + "[output]\n" + output), "--out", self.dir / "out")
        self.assertEqual(result.code, code, result.out + result.err)
        for word in words:
            self.assertIn(word, result.err)


if __name__ == "__main__":
    harness.main()
