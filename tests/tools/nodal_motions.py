# SPDX-License-Identifier: BSD-3-Clause
"""Motions that are said of vertices: a plate that flaps by displacement files, a cylinder that stretches behind its
piston, through the program; and refused with file and vertex where a file does not fit."""
import importlib.util
import math
import shutil

import harness
from harness import ROOT, ProgramTest, slabhull

USAGE, INPUT = 2, 3
EXAMPLES = ROOT / "examples"


def make_module():
    """What wrote the example's files."""
    spec = importlib.util.spec_from_file_location("make", EXAMPLES / "flapping-plate" / "make.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def grid_msh(columns=6, rows=4, width=2.0, height=1.0):
    """A rectangle of triangles as MSH 2.2: patches left, right (the piston), walls."""
    nodes = [(width * i / columns, height * j / rows) for j in range(rows + 1) for i in range(columns + 1)]

    def node(i, j):
        return j * (columns + 1) + i + 1

    lines = [(1, node(0, j), node(0, j + 1)) for j in range(rows)]
    lines += [(2, node(columns, j), node(columns, j + 1)) for j in range(rows)]
    lines += [(3, node(i, j), node(i + 1, j)) for i in range(columns) for j in (0, rows)]
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a, b, c, d = node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)
            triangles += [(a, b, c), (a, c, d)]
    text = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '1 1 "left"', '1 2 "right"', '1 3 "walls"',
            "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    text += [f"{n} {x!r} {y!r} 0" for n, (x, y) in enumerate(nodes, 1)]
    text += ["$EndNodes", "$Elements", str(len(lines) + len(triangles))]
    text += [f"{n} 1 2 {group} {group} {a} {b}" for n, (group, a, b) in enumerate(lines, 1)]
    text += [f"{n} 2 2 9 9 {a} {b} {c}" for n, (a, b, c) in enumerate(triangles, len(lines) + 1)]
    return "\n".join(text + ["$EndElements"]) + "\n"


class NodalTest(ProgramTest):
    def sound(self, out, slabs):
        for slab in range(slabs):
            result = slabhull("check", out / f"slab_{slab:04}.vtu", "--embedding")
            self.assertEqual(result.code, 0, result.out + result.err)

    def arrays(self, path):
        for module in ("numpy", "vtkmodules"):
            if importlib.util.find_spec(module) is None:
                self.skipTest(f"no {module} here")
        from outputs import vtk_arrays
        return vtk_arrays(path)

    def plate_case(self, dimension, motion, time="slabs = 2\nlayers = 4", more=""):
        make = make_module()
        points = make.write_plate(dimension, self.dir)
        make.write_displacements(dimension, self.dir, points)
        if dimension == 2:
            initial = 'curves = [ { file = "plate.dat", patch = "plate" } ]\nbox = { min = [-1, -1], max = [2, 1], size = 0.25 }'
        else:
            initial = ('surfaces = [ { file = "plate.off", patch = "plate" } ]\n'
                       'box = { min = [-0.5, -0.8, -0.8], max = [1.5, 0.8, 0.8], size = 0.3 }')
        return self.case(f'dimension = {dimension}\n[initial]\n{initial}\n[time]\n{time}\n'
                         f'[motion.plate]\nkind = "displacement-series"\n{motion}\n{more}')

    def series(self, files='pattern = "d_*.csv"', times=tuple(i / 16 for i in range(17)), more=""):
        return f"{files}\ntimes = {list(times)}\n{more}"


class FlappingPlate(NodalTest):
    def test_the_example(self):
        shutil.copytree(EXAMPLES / "flapping-plate", self.dir / "flapping-plate")
        out, report = self.build(shutil.copy(EXAMPLES / "flapping-plate.toml", self.dir))
        self.sound(out, 2)
        first, last = (report["slabs"][i]["measure"] for i in (0, 1))
        self.assertAlmostEqual(last["terminating"], first["initial"], places=9)  # one period
        self.assertAlmostEqual(first["intermediate"], last["intermediate"], delta=1e-6)  # up and down alike

    def test_the_example_s_files_are_those_that_its_script_writes(self):
        make = make_module()
        make.write_displacements(2, self.dir, make.write_plate(2, self.dir))
        names = sorted(path.name for path in self.dir.iterdir())
        self.assertEqual(len(names), 18)
        for name in names:
            self.assertEqual((self.dir / name).read_text(), (EXAMPLES / "flapping-plate" / name).read_text(), name)

    def test_in_space_by_csv_it_is_sound(self):
        out, _ = self.build(self.plate_case(3, self.series()))
        self.sound(out, 2)

    def places(self, case, dimension, slabs):
        """The largest distance of the plate's vertices from where they should be, on all levels."""
        out, _ = self.build(case)
        make = make_module()
        worst, start, compared = 0, None, 0
        for slab in range(slabs):
            seen = self.arrays(out / f"slab_{slab:04}.vtu")
            t, track = seen["t"], seen["track_id"]
            x = [tuple(point[:dimension]) + (0.0,) * (3 - dimension) for point in seen["points"]]
            if start is None:
                on_plate = set(make.surface()[0] if dimension == 3 else make.curve())
                near = {tuple(round(c, 6) for c in point) for point in on_plate}
                start = {track[i]: x[i] for i in range(len(x))
                         if track[i] >= 0 and t[i] == 0 and tuple(round(c, 6) + 0.0 for c in x[i]) in near}
                self.assertEqual(len(start), len(on_plate))
            for i, point in enumerate(x):
                if track[i] in start:
                    worst = max(worst, math.dist(point, make.displaced(*start[track[i]], t[i])))
                    compared += 1
        self.assertGreaterEqual(compared, 2 * slabs * len(start))
        return worst

    def test_vertices_are_where_the_bending_has_them_at_the_files_times(self):
        for dimension in (2, 3):
            self.assertLess(self.places(self.plate_case(dimension, self.series()), dimension, 2), 2e-7)

    def test_between_the_files_cubic_is_better_than_linear(self):
        time = "slabs = 2\nlayers = 12"
        errors = [self.places(self.plate_case(2, self.series(more=f'interpolation = "{kind}"'), time), 2, 2)
                  for kind in ("linear", "cubic")]
        self.assertLess(errors[1], 1e-4)
        self.assertGreater(errors[0], 20 * errors[1])

    def test_resume_is_refused_where_the_files_have_the_plate_elsewhere(self):
        case = self.plate_case(2, self.series(), "end = 0.25\nlayers = 2")
        out, _ = self.build(case)
        self.plate_case(2, self.series(times=tuple(i / 8 for i in range(17))), "end = 0.5\nslabs = 2\nlayers = 2")
        result = slabhull("build", case, "--out", out, "--resume")
        self.assertEqual(result.code, USAGE, result.out + result.err)
        self.assertIn("patch plate is not what the run began with: at t = 0.25 its vertex", result.err)
        self.assertIn("off the place where the files of motion.plate have it", result.err)
        self.plate_case(2, self.series(), "end = 0.5\nslabs = 2\nlayers = 2")
        result = slabhull("build", case, "--out", out, "--resume")
        self.assertEqual(result.code, 0, result.out + result.err)
        self.sound(out, 2)

    def test_vtu_files_of_meshio(self):
        if importlib.util.find_spec("meshio") is None:
            self.skipTest("no meshio here")
        import meshio
        import numpy as np
        make = make_module()
        points, triangles = make.surface()
        for i in range(9):
            moved = np.array([make.displaced(*point, i / 8) for point in points]) - points
            mesh = meshio.Mesh(np.array(points), [("triangle", np.array(triangles))], point_data={"U": moved})
            mesh.write(self.dir / f"plate{i}.vtu", compression=None)
        motion = self.series('pattern = "plate*.vtu"\narray = "U"', [i / 8 for i in range(9)])
        out, _ = self.build(self.plate_case(3, motion))
        self.sound(out, 2)


class Piston(NodalTest):
    def test_the_example(self):
        shutil.copy(EXAMPLES / "piston.msh", self.dir)
        out, report = self.build(shutil.copy(EXAMPLES / "piston.toml", self.dir))
        self.sound(out, 2)
        first, last = (report["slabs"][i]["measure"] for i in (0, 1))
        self.assertAlmostEqual(last["terminating"], 0.4 * first["initial"], delta=1e-5)
        self.assertAlmostEqual(first["enclosed"] + last["enclosed"], 0.7 * first["initial"], delta=1e-5)
        seen = self.arrays(out / "slab_0001.vtu")
        boundary = (seen["track_id"] >= 0) & (seen["t"] == 1)
        for x, y, z in seen["points"][boundary]:
            self.assertGreaterEqual(z, 0)
            self.assertLessEqual(z, 0.4 + 1e-12)
            if 1e-9 < z < 0.4 - 1e-9:
                self.assertAlmostEqual(math.hypot(x, y), 0.5, delta=1e-14)

    def test_in_the_plane_the_walls_stretch_evenly(self):
        (self.dir / "grid.msh").write_text(grid_msh())
        out, report = self.build(self.case(
            'dimension = 2\n[initial]\nmesh = "grid.msh"\n[time]\nslabs = 2\nlayers = 2\n'
            '[motion.right]\nkind = "translation"\nvelocity = [1.5, 0]\n[motion.walls]\nkind = "stretch"\n'))
        self.sound(out, 2)
        measures = [slab["measure"] for slab in report["slabs"]]
        self.assertAlmostEqual(measures[1]["terminating"], 3.5, places=12)
        self.assertAlmostEqual(measures[0]["enclosed"] + measures[1]["enclosed"], 2.75, places=12)
        seen = self.arrays(out / "slab_0001.vtu")
        top = {round(x, 9) for x, y, t in seen["points"] if y == 1 and t == 1}
        self.assertEqual(top, {round(3.5 * i / 6, 9) for i in range(7)})


class Refused(NodalTest):
    def test_files_that_do_not_fit_are_named_with_the_vertex(self):
        case = self.plate_case(2, self.series())
        self.build(case, out="good")
        good = (self.dir / "d_07.csv").read_text()
        lines = good.splitlines()
        for text, words in [
            ("\n".join(lines[:-1]) + "\n", ["track", "plate", "(0, 0.02)", "nearest", "away"]),
            (good.replace("1,0.02,", "1,0.0202,"), ["(1, 0.02)", "0.0002 away"]),
            (good + "1,0.02,0,0\n", ["(1, 0.02)", "both"]),
            (good.replace("dx", "u"), ["\"u\""]),
            (good.replace(lines[9], lines[9].rsplit(",", 1)[0] + ",inf"), ["line 10"]),
            ("", []),
        ]:
            with self.subTest(words):
                (self.dir / "d_07.csv").write_text(text)
                self.refused(case, INPUT, "d_07.csv", *words)
        (self.dir / "d_07.csv").write_text(good.replace("1,0.02,", "1,0.0202,"))
        self.build(self.plate_case_again("tolerance = 1e-3"), out="tolerant")

    def plate_case_again(self, more):
        """The same case, its files as they are now."""
        return self.case((self.dir / "case.toml").read_text().replace("times =", more + "\ntimes ="))

    def test_keys_that_are_wrong(self):
        for motion, words in [
            (self.series(files=""), ["motion.plate.files", "pattern"]),
            (self.series('files = ["d_00.csv"]\npattern = "d_*.csv"'), ["motion.plate.pattern"]),
            (self.series('pattern = "e_*.csv"'), ["[motion.plate]", "e_*.csv"]),
            (self.series('pattern = "d_00.csv"'), ["[motion.plate]", "'*'"]),
            (self.series('files = ["d_00.csv", "d_01.csv"]'), ["motion.plate.times", "2 times", "17"]),
            (self.series(times=range(16)), ["[motion.plate]", "16 times", "17 files"]),
            (self.series(times=[0] * 17), ["motion.plate.times", "ascend"]),
            (self.series(times=[i / 20 for i in range(17)]), ["[motion.plate]", "from t = 0 to 0.8", "0 to 1"]),
            ('pattern = "d_*.csv"', ["[motion.plate]", "times"]),
            (self.series(more="tolerance = 0"), ["motion.plate.tolerance"]),
            (self.series(more='interpolation = "quintic"'), ["motion.plate.interpolation", "linear", "cubic"]),
        ]:
            with self.subTest(motion):
                self.refused(self.plate_case(2, motion), USAGE, *words)
        self.refused(self.plate_case(2, self.series('files = ["none.csv"]', [0.0])), INPUT, "none.csv")

    def test_a_plate_that_is_bent_at_the_start(self):
        self.refused(self.plate_case(2, self.series(), "start = 0.25\nend = 0.5"), INPUT, "t = 0.25", "plate", "track")

    def test_projection_and_sequences_of_what_has_no_field(self):
        surface = '[project.plate]\nsurface = "circle"\ncentre = [0, 0]\nradius = 1\n'
        self.refused(self.plate_case(2, self.series(), more=surface), USAGE, "project.plate", "displacement-series")
        for step in ('{ kind = "stretch" }', '{ kind = "displacement-series", files = ["a.csv"], times = [0] }'):
            text = self.plate_case(2, self.series()).read_text()
            text = text[:text.index("[motion")] + f'[motion.plate]\nkind = "sequence"\nsteps = [ {step} ]\n'
            self.refused(self.case(text), USAGE, "motion.plate.steps[0].kind", "sequence")

    def test_what_nothing_leads(self):
        (self.dir / "grid.msh").write_text(grid_msh())
        motions = "".join(f'[motion.{patch}]\nkind = "stretch"\n' for patch in ("left", "right", "walls"))
        case = self.case(f'dimension = 2\n[initial]\nmesh = "grid.msh"\n{motions}')
        self.refused(case, USAGE, "stretch", "left", "leads")


if __name__ == "__main__":
    harness.main()
