# SPDX-License-Identifier: BSD-3-Clause
"""Files of hulls, fillings and meshes; cases; other libraries; the program; the examples."""
import io
import os
import subprocess
import sys
import warnings

import harness
import numpy
import slabhull
from harness import CIRCLE, needs, program


def built(name):
    """Whether this build has a format."""
    line = next(line for line in program("convert", "--help").stdout.splitlines() if line.split()[:1] == [name])
    return "not in this build" not in line


class Files(harness.PythonTest):
    @classmethod
    def setUpClass(cls):
        cls.slabs = {}
        for dimension in (2, 3):
            march = slabhull.March(harness.domain(dimension), motions={"body": harness.swing}, reuse="move")
            cls.slabs[dimension] = march.step([0.0, 0.1, 0.2])

    def test_hulls_come_back_from_every_format_that_holds_them(self):
        for dimension, slab in self.slabs.items():
            for name, options in [("a.vtu", {}), ("b.vtu", {"encoding": "zlib"}), ("c.msh", {}),
                                  ("d.msh", {"version": "2.2"}), ("e.pvtu", {"pieces": 3}), ("f.vtk", {}),
                                  ("g.xdmf", {})]:
                if not built({"f.vtk": "vtk", "g.xdmf": "xdmf"}.get(name, "vtu")):
                    continue
                with self.subTest(name, dimension=dimension):
                    path = self.dir / f"{dimension}{name}"
                    slab.hull.write(path, **options)
                    self.assert_same_hull(slabhull.read(path), slab.hull)

    def test_what_a_format_cannot_hold_is_a_warning(self):
        with self.assertWarnsRegex(UserWarning, "STL does not hold: .*track_id"):
            self.slabs[2].hull.write(self.dir / "hull.stl")
        with self.assertRaisesRegex(slabhull.UsageError, "no place for"):
            self.slabs[3].hull.write(self.dir / "hull.stl")
        with self.assertRaisesRegex(slabhull.UsageError, "no format has this extension"):
            self.slabs[2].hull.write(self.dir / "hull.doc")
        with self.assertRaisesRegex(slabhull.UsageError, 'no option "encodng"'):
            self.slabs[2].hull.write(self.dir / "hull.vtu", encodng="zlib")
        self.assertEqual([each.name for each in self.dir.iterdir()], ["hull.stl"])

    def test_nowhere_to_write_is_an_output_error(self):
        with self.assertRaises(slabhull.OutputError):
            self.slabs[2].hull.write(self.dir / "no" / "where.vtu")

    def test_fillings_come_back(self):
        for dimension, slab in self.slabs.items():
            filling = slabhull.fill(slab)
            for name in ("a.mfem", "b.getfem", "c.h5"):
                if name == "c.h5" and "h5" not in self.formats_of_fillings():
                    continue
                with self.subTest(name, dimension=dimension):
                    path = self.dir / f"{dimension}{name}"
                    filling.write(path)
                    back = slabhull.read(path) if name != "a.mfem" or dimension == 3 else slabhull.read_filling(path)
                    self.assertIsInstance(back, slabhull.Filling)
                    self.assertEqual(back.dimension, dimension)
                    self.assertEqual(len(back.cells), len(filling.cells))
                    self.assertTrue(slabhull.check(back).clean)

    def formats_of_fillings(self):
        try:
            slabhull.fill(self.slabs[2]).write(self.dir / "try.h5")
        except slabhull.UsageError:
            return ()
        return ("h5",)

    def test_a_mesh_of_arrays_comes_back_from_every_format(self):
        points, cells = harness.grid(3, 3)
        mesh = slabhull.Mesh(points, cells, {"height": points[:, 2], "number": numpy.arange(len(points))},
                             {"half": numpy.arange(len(cells)) % 2}, numpy.arange(len(cells)) % 3 + 1,
                             {1: "a", 2: "b", 3: "c"})
        for name in ("msh", "vtu", "vtk", "xdmf", "medit", "mfem", "avro"):
            if not built(name):
                continue
            with self.subTest(name), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                path = self.dir / f"mesh.{name}"
                mesh.write(path, format=name)
                back = slabhull.read_mesh(path)
                self.assert_same(back.points, mesh.points)
                self.assert_same(back.cells, mesh.cells)
                if name in ("msh", "vtu", "vtk", "xdmf"):
                    self.assert_same(back.point_data["height"], mesh.point_data["height"])
        mesh.write(self.dir / "groups.msh")
        back = slabhull.read_mesh(self.dir / "groups.msh")
        self.assertEqual(back.groups, {3: {1: "a", 2: "b", 3: "c"}})
        order = numpy.lexsort(back.cells.T)
        ours = numpy.lexsort(mesh.cells.T)
        self.assert_same(back.simplex_groups(3)[order], mesh.simplex_groups(3)[ours])

    def test_a_mesh_of_wrong_arrays_is_refused(self):
        points, cells = harness.grid(3, 2)
        for words, arguments in [("there is no point 99", (points, [[0, 1, 99]])),
                                 ("numbers for", (points, cells, {"u": [1.0]})),
                                 ("one to four", (points, [[0, 1, 2, 3, 4]]))]:
            with self.subTest(words), self.assertRaisesRegex(slabhull.UsageError, words):
                slabhull.Mesh(*arguments)

    def test_a_hull_with_defects_is_not_read_but_checked(self):
        mesh = self.slabs[2].hull.to_mesh()
        cells = mesh.cells.copy()
        cells[0] = cells[0][[1, 0, 2]]
        slabhull.Mesh(mesh.points, cells, {"t": mesh.point_data["t"]}).write(self.dir / "bad.vtu")
        with self.assertRaisesRegex(slabhull.InputError, "slabhull.check") as raised:
            slabhull.read(self.dir / "bad.vtu")
        self.assertTrue(raised.exception.entities)
        self.assertFalse(slabhull.check(self.dir / "bad.vtu").clean)


class Cases(harness.PythonTest):
    def test_a_dict_is_the_case_that_its_file_says(self):
        (self.dir / "case.toml").write_text('[initial]\nexperiment = "expanding-circle"\nlevel = 1\n'
                                            "[time]\nlayers = 2\nslabs = 2\n")
        from_file = slabhull.Case(self.dir / "case.toml")
        from_dict = slabhull.Case(CIRCLE)
        for k in range(2):
            self.assertEqual(from_file.level_times(k), from_dict.level_times(k))
        for case, out in ((from_file, "file"), (from_dict, "dict")):
            case.run(out=self.dir / out)
        for name in ("slab_0000.vtu", "slab_0001.vtu", "slab_0001.msh", "cap_0002.vtu"):
            self.assertEqual((self.dir / "file" / name).read_bytes(), (self.dir / "dict" / name).read_bytes())

    def test_a_dict_may_hold_paths_arrays_and_tables_in_lists(self):
        case = slabhull.Case({"dimension": 3, "initial": {"mesh": harness.ROOT / "examples" / "room.msh"},
                              "time": {"layers": numpy.int64(2)},
                              "motion": {"bar": {"kind": "sequence", "steps": [
                                  {"kind": "rotation", "centre": numpy.array([1.5, 1.5, 1.25]), "axis": (0, 0, 1),
                                   "rate": numpy.float64(0.5)},
                                  {"kind": "translation", "velocity": [0, 0, 0.1]}]}}})
        self.assertEqual(case.domain().mesh.patches, {1: "bar", 2: "duct", 3: "walls"})
        case.march().propose(case.level_times(0)[:2])
        with self.assertRaisesRegex(slabhull.UsageError, "time.layers: a object is nothing"):
            slabhull.Case({"time": {"layers": object()}})
        with self.assertRaisesRegex(slabhull.UsageError, 'unknown key "time.layrs"'):
            slabhull.Case({**CIRCLE, "time": {"layrs": 1}})

    def test_a_march_of_a_case_makes_the_hulls_that_the_program_writes(self):
        for text in ('[initial]\nexperiment = "expanding-circle"\nlevel = 1\n[time]\nslabs = 2\nlayers = 2\n',
                     '[initial]\nexperiment = "expanding-sphere"\nlevel = 1\n[time]\nlayers = 2\nslabs = 2\n'):
            path = self.dir / "case.toml"
            path.write_text(text)
            self.assertEqual(program("build", path, "--out", self.dir / "out", "--quiet").returncode, 0)
            case = slabhull.Case(path)
            march = case.march()
            for k in range(case.slabs):
                hull = march.step(case.level_times(k)).hull
                hull.write(self.dir / "ours.vtu")
                self.assertEqual((self.dir / "ours.vtu").read_bytes(),
                                 (self.dir / "out" / f"slab_{k:04}.vtu").read_bytes())
                self.assert_same_hull(hull, slabhull.read(self.dir / "out" / f"slab_{k:04}.vtu"))

    def test_a_run_tells_its_progress_and_can_be_stopped_and_resumed(self):
        told = []

        def stop_in_second(progress):
            told.append((progress.share, progress.cells, progress.stage))
            return progress.slab != 1

        case = slabhull.Case(CIRCLE)
        with self.assertRaises(slabhull.Interrupted):
            case.run(out=self.dir / "out", on_progress=stop_in_second)
        shares = [share for share, cells, stage in told]
        self.assertEqual(shares, sorted(shares))
        self.assertGreater(told[-1][1], 0)
        self.assertIn("cap meshing", [stage for share, cells, stage in told])
        with slabhull.ProgressBar(io.StringIO()) as bar:
            summary = case.run(out=self.dir / "out", resume=True, on_progress=bar)
        self.assertIn(summary["slabs"], [1, 2])  # the first one may still have been on its way to the disk
        self.assertTrue(slabhull.check(self.dir / "out" / "slab_0001.vtu").clean)


class Others(harness.PythonTest):
    def setUp(self):
        super().setUp()
        self.march = slabhull.March(harness.domain(3), motions={"body": harness.swing}, reuse="move")
        self.hull = self.march.step([0.0, 0.1]).hull

    def meshes(self):
        flat = slabhull.March(harness.domain(2), motions={"body": harness.swing}, reuse="move").step([0.0, 0.1])
        filling = slabhull.fill(flat)
        return [self.hull, flat.hull, filling, self.march.cap, slabhull.slice(self.hull, 0.05),
                slabhull.slice(flat.hull, 0.05), slabhull.slice(filling, 0.05), self.hull.to_mesh()]

    @needs("meshio")
    def test_meshio_gets_points_cells_and_data(self):
        for mesh in self.meshes():
            with self.subTest(type(mesh).__name__):
                theirs = mesh.to_meshio()
                ours = mesh.facets if isinstance(mesh, slabhull.Section) else mesh.cells
                self.assertTrue(numpy.array_equal(theirs.cells[0].data, ours))
                self.assertEqual(theirs.points.shape, (len(mesh.points), 3))
        theirs = self.hull.to_meshio()
        self.assertTrue(numpy.array_equal(theirs.point_data["t"], self.hull.points[:, 3]))
        self.assertTrue(numpy.array_equal(theirs.cell_data["patch"][0], self.hull.patch))

    @needs("vtkmodules")
    def test_vtk_gets_points_cells_and_data(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy

        for mesh in self.meshes():
            with self.subTest(type(mesh).__name__):
                grid = mesh.to_vtk()
                ours = mesh.facets if isinstance(mesh, slabhull.Section) else mesh.cells
                corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(ours.shape)
                self.assertTrue(numpy.array_equal(corners, ours))
                self.assertEqual(grid.GetNumberOfPoints(), len(mesh.points))
        regions = vtk_to_numpy(self.hull.to_vtk().GetCellData().GetArray("region"))
        self.assertTrue(numpy.array_equal(regions, self.hull.region))

    @needs("meshio")
    def test_pentatopes_are_for_nobody_else(self):
        with self.assertRaisesRegex(slabhull.UsageError, "pentatopes"):
            slabhull.fill(self.march.step([0.1, 0.2])).to_meshio()


class Program(harness.PythonTest):
    def run_module(self, *arguments):
        return subprocess.run([sys.executable, "-m", "slabhull", *arguments], capture_output=True, text=True)

    def test_the_module_is_the_program(self):
        done = self.run_module("--version")
        self.assertEqual((done.returncode, done.stdout.strip()), (0, slabhull.__version__))
        self.assertEqual(self.run_module("check", "nowhere.vtu").returncode, 3)

    @staticmethod
    def example(name, *arguments, cwd):
        environment = {**os.environ, "MPLBACKEND": "Agg"}
        return subprocess.run([sys.executable, harness.ROOT / "examples" / "python" / name, *arguments], cwd=cwd,
                              env=environment, capture_output=True, text=True, timeout=120)

    def test_the_turning_ellipsoid_makes_pictures(self):
        done = self.example("turning_ellipsoid.py", "--small", cwd=self.dir)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("nothing found", done.stdout)

    def test_the_predictor_corrector_converges(self):
        done = self.example("predictor_corrector.py", "--small", cwd=self.dir)
        self.assertEqual(done.returncode, 0, done.stderr)

    @needs("getfem")
    def test_the_heat_equation_is_solved_by_getfem(self):
        done = self.example("heat.py", "--small", cwd=self.dir)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    harness.main()
