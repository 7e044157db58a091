# SPDX-License-Identifier: BSD-3-Clause
"""What the program writes: the same bytes every time, and the same mesh to every independent reader."""
import importlib.util
import json
import re
import shutil

import harness
from harness import ROOT, ProgramTest, slabhull

ELLIPSOID = '[initial]\nexperiment = "ellipsoid"\nlevel = 1\n'
CIRCLE = '[initial]\nexperiment = "expanding-circle"\nlevel = 2\n[time]\nslabs = 2\n'


def meshes(directory):
    """All that does not tell how long it took."""
    timed = ("report.json", "slabs.jsonl", "march.state")
    return {p.name: p.read_bytes() for p in sorted(directory.iterdir()) if p.name not in timed}


class Determinism(ProgramTest):
    def test_two_runs_and_any_number_of_threads_give_the_same_bytes(self):
        shutil.copy(ROOT / "examples/room.msh", self.dir)
        room = self.case((ROOT / "examples/room.toml").read_text(), "room.toml")
        for case in (self.case(CIRCLE), room):
            first, _ = self.build(case, "--threads", 1, out="first")
            again, _ = self.build(case, "--threads", 1, out="again")
            other, _ = self.build(case, "--threads", 2, out="other")
            self.assertEqual(meshes(first), meshes(again))
            self.assertEqual(meshes(first), meshes(other))
            for directory in (first, again, other):
                shutil.rmtree(directory)


class Files(ProgramTest):
    def test_the_files_and_the_report_of_two_slabs(self):
        out, report = self.build(self.case(CIRCLE))
        self.assertEqual(sorted(p.name for p in out.iterdir()),
                         ["cap_0001.vtu", "cap_0002.vtu", "caps.pvd", "march.state", "report.json", "slab_0000.msh",
                          "slab_0000.vtu", "slab_0001.msh", "slab_0001.vtu", "slabs.jsonl", "slabs.pvd"])
        for slab in report["slabs"]:
            self.assertTrue(slab["clean"])
            self.assertGreater(slab["angle"]["smallest"], 0)
            self.assertIn("cap meshing", slab["seconds"])
        self.assertGreater(report["peak_memory"]["bytes"], 0)

    def test_a_case_whose_own_files_the_run_would_replace_is_refused(self):
        out, _ = self.build(self.case(CIRCLE))
        (self.dir / "link.vtu").symlink_to(out / "cap_0002.vtu")
        inside = {p.name: p.read_bytes() for p in out.iterdir()}
        flat = 'dimension = 2\n[time]\nstart = 1\nend = 2\nlayers = 1\n'
        other = flat + '[initial]\nmesh = "cap_0000.vtu"\n[motion.body]\nkind = "rotation"\ncentre = [0, 0]\n'
        shutil.copy(out / "cap_0002.vtu", self.dir / "cap_0000.vtu")
        for key, text in (("initial.mesh", flat + '[initial]\nmesh = "out/cap_0002.vtu"\n'),
                          ("initial.mesh", flat + '[initial]\nmesh = "link.vtu"\n'),
                          ("motion.body.table", other + 'table = "out/march.state"\n')):
            for options in ((), ("--resume",), ("--dry-run",)):
                result = slabhull("build", self.case(text), "--out", out, *options)
                self.assertEqual(result.code, 2, result.err)
                self.assertIn(f"{key}: ", result.err)
                self.assertIn("replaces or removes files of this name", result.err)
        self.assertEqual({p.name: p.read_bytes() for p in out.iterdir()}, inside)
        again = self.case(flat + '[initial]\nmesh = "out/cap_0002.vtu"\n')
        self.assertEqual(slabhull("build", again, "--out", self.dir / "next", "--quiet").code, 0)

    def test_only_the_formats_asked_for_are_written(self):
        out, _ = self.build(self.case(CIRCLE + '[output]\nformats = ["msh"]\n'))
        self.assertFalse((out / "slab_0000.vtu").exists())
        self.assertTrue((out / "slab_0000.msh").exists())


class Progress(ProgramTest):
    def test_json_tells_stages_shares_cells_and_time(self):
        case = self.case('[initial]\nexperiment = "ellipsoid"\nlevel = 2\n[time]\nslabs = 3\n')
        shown = slabhull("build", case, "--out", self.dir / "out", "--progress", "json", "--quiet").err
        lines = [json.loads(line) for line in shown.splitlines()]
        for line in lines:
            self.assertEqual(list(line), ["stage", "stage_share", "slab", "slabs", "share", "cells", "cells_per_second",
                                          "seconds", "seconds_left"])
        for key in ("share", "cells", "seconds"):
            told = [line[key] for line in lines]
            self.assertEqual(told, sorted(told))
        self.assertEqual(lines[-1]["stage"], "done")
        self.assertEqual(lines[-1]["share"], 1)
        self.assertEqual(lines[-1]["seconds_left"], 0)
        report = json.loads((self.dir / "out/report.json").read_text())
        self.assertEqual(lines[-1]["cells"], sum(slab["counts"]["cells"] for slab in report["slabs"]))

    def test_a_line_is_for_terminals_or_those_who_ask(self):
        out, _ = self.build(self.case(CIRCLE))
        hull = out / "slab_0000.vtu"
        self.assertEqual(slabhull("check", hull).err, "")
        self.assertIn("checking", slabhull("check", hull, "--progress", "line").err)
        asked = slabhull("check", hull, "--progress", "json")
        self.assertIn("reading", [json.loads(line)["stage"] for line in asked.err.splitlines()])
        self.assertEqual(asked.out, slabhull("check", hull).out)


class Report(ProgramTest):
    def test_all_its_keys_are_described(self):
        case = '[initial]\nexperiment = "circle"\nlevel = 1\n[cap]\nreuse = "%s"\n[fill]\n'
        text = (ROOT / "docs/formats.md").read_text() + (ROOT / "docs/adapt.md").read_text()

        def keys(value):
            for key, inner in value.items() if isinstance(value, dict) else ():
                yield key
                if key not in ("patches", "cells_by_patch", "projection", "defects"):
                    yield from keys(inner)

        for reuse in ("none", "move", "adapt"):
            report = self.build(self.case(case % reuse if reuse != "none" else case.split("[cap]")[0]), out=reuse)[1]
            for slab in [report.pop("slabs")[0], report]:
                self.assertEqual([key for key in sorted(set(keys(slab))) if f"`{key}`" not in text], [])


def vtk_arrays(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()

    def arrays(data):
        return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}

    return {"points": vtk_to_numpy(grid.GetPoints().GetData()),
            "cells": vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1),
            **arrays(grid.GetPointData()), **arrays(grid.GetCellData())}


class IndependentReaders(ProgramTest):
    """VTK, meshio and Gmsh see the same points and cells in what we write, and the arrays fit together."""

    def setUp(self):
        super().setUp()
        for module in ("vtkmodules", "meshio", "gmsh", "numpy"):
            if importlib.util.find_spec(module) is None:
                self.skipTest(f"no {module} here")

    def test_the_hulls_of_a_case_in_each_dimension(self):
        for text, kind in ((CIRCLE, "triangle"), (ELLIPSOID, "tetra")):
            out, report = self.build(self.case(text))
            self.compare(out, report["slabs"][0], kind)

    def compare(self, out, slab, kind):
        import meshio
        import numpy as np
        seen = vtk_arrays(out / "slab_0000.vtu")
        counts = slab["counts"]
        self.assertEqual(len(seen["points"]), counts["vertices"])
        self.assertEqual(len(seen["cells"]), counts["cells"])

        vtu = meshio.read(out / "slab_0000.vtu")
        msh = meshio.read(out / "slab_0000.msh")
        for other in (vtu, msh):
            np.testing.assert_array_equal(other.points, seen["points"])
            cells = np.concatenate([block.data for block in other.cells if block.type == kind])
            np.testing.assert_array_equal(cells, seen["cells"])
        for name in ("t", "vertex_id", "track_id", "cell"):
            np.testing.assert_array_equal(vtu.point_data[name], seen[name])
        self.relations(seen, slab)
        self.gmsh_agrees(out / "slab_0000.msh", seen)

    def relations(self, seen, slab):
        import numpy as np
        cells, neighbors = seen["cells"], seen["neighbors"]
        self.assertEqual(len(np.unique(seen["vertex_id"])), len(seen["points"]))
        self.assertTrue((cells[seen["cell"]] == np.arange(len(seen["points"]))[:, None]).any(axis=1).all())
        # Across facet i lies a cell that has the facet's vertices, and that names this cell in return.
        for i in range(cells.shape[1]):
            facet = np.sort(np.delete(cells, i, axis=1))
            across = cells[neighbors[:, i]]
            found = (facet[:, :, None] == across[:, None, :]).any(axis=2).all()
            self.assertTrue(found)
            self.assertTrue((neighbors[neighbors[:, i]] == np.arange(len(cells))[:, None]).any(axis=1).all())
        regions = np.bincount(seen["region"], minlength=3)
        self.assertEqual(list(regions), list(slab["cells_by_region"].values()))

    def gmsh_agrees(self, path, seen):
        import gmsh
        import numpy as np
        gmsh.initialize()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.open(str(path))
            tags, points, _ = gmsh.model.mesh.getNodes()
            np.testing.assert_array_equal(np.sort(tags), np.arange(1, len(seen["points"]) + 1))
            np.testing.assert_array_equal(points.reshape(-1, 3)[np.argsort(tags)], seen["points"])
            dimension = seen["cells"].shape[1] - 1
            names = {gmsh.model.getPhysicalName(*group) for group in gmsh.model.getPhysicalGroups(dimension)}
            self.assertEqual(names, {"initial", "terminating", "body", "walls"})
            _, element_tags, nodes = gmsh.model.mesh.getElements(dimension)
            order = np.argsort(np.concatenate(element_tags))
            cells = np.concatenate(nodes).reshape(-1, dimension + 1)[order]
            np.testing.assert_array_equal(cells, seen["cells"] + 1)
        finally:
            gmsh.finalize()


class Checker(ProgramTest):
    def test_a_damaged_hull_is_found_out_with_exit_code_1(self):
        import numpy as np
        out, _ = self.build(self.case(CIRCLE))
        path = out / "slab_0000.vtu"
        data = bytearray(path.read_bytes())
        seen = vtk_arrays(path)
        # Swap two vertices of the first cell, in place.
        first = seen["cells"][0].astype(np.int32).tobytes()
        at = data.find(first + seen["cells"][1].astype(np.int32).tobytes())
        width = 4
        if at < 0:
            first, width = seen["cells"][0].astype(np.int64).tobytes(), 8
            at = data.find(first)
        data[at:at + 2 * width] = data[at + width:at + 2 * width] + data[at:at + width]
        path.write_bytes(data)
        result = slabhull("check", path, "--json")
        self.assertEqual(result.code, 1)
        self.assertIn("disoriented-facet", json.loads(result.out)["defects"])

    def test_times_that_contradict_the_third_coordinate_are_found(self):
        out, _ = self.build(self.case(CIRCLE))
        path = out / "slab_0000.vtu"
        data = bytearray(path.read_bytes())
        offset = re.search(rb'Name="t"[^>]*offset="(\d+)"', data)
        length_of_block = 8
        at = data.index(b"_", data.index(b"<AppendedData")) + 1 + int(offset[1]) + length_of_block
        data[at + 8 * 17] ^= 1  # the last bit of point 17
        path.write_bytes(data)
        result = slabhull("check", path)
        self.assertEqual(result.code, 3, result.out + result.err)
        self.assertIn("slab_0000.vtu: point 17 has t = ", result.err)


if __name__ == "__main__":
    harness.main()
