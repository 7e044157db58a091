# SPDX-License-Identifier: BSD-3-Clause
"""Projection on surfaces from files: a triangulated surface, a curve, a STEP model; what is refused."""
import math
import shutil

import harness
from harness import ProgramTest, slabhull

try:
    import gmsh
except ImportError:
    gmsh = None

try:
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    vtk = None

USAGE, INPUT = 2, 3

# Euler's method spirals outwards: after one turn by 1 rad in 20 steps a point is 2.5 % too far out.
COARSE = '[trajectory]\nscheme = "euler"\nsubsteps = 5\n[time]\nlayers = 4\n'
OCTAHEDRON = "OFF\n6 8 0\n" + "".join(f"{p}\n" for p in (
    "1 0 0", "-1 0 0", "0 1 0", "0 -1 0", "0 0 1", "0 0 -1",
    "3 0 2 4", "3 2 1 4", "3 1 3 4", "3 3 0 4", "3 2 0 5", "3 1 2 5", "3 3 1 5", "3 0 3 5"))


def moving_points(path):
    """The points of a hull at its end that are on a track and off the box."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData())
    data = grid.GetPointData()
    time, track = (vtk_to_numpy(data.GetArray(name)) for name in ("t", "track_id"))
    picked = [p for p, t, i in zip(points, time, track) if t == 1 and i >= 0]
    return [p for p in picked if max(map(abs, p)) < 1.9]


def turned_back(p):
    c, s = math.cos(1), math.sin(1)
    return (c * p[0] + s * p[1], -s * p[0] + c * p[1], p[2])


class Files(ProgramTest):
    def solid(self, project):
        (self.dir / "body.off").write_text(OCTAHEDRON)
        return self.case('dimension = 3\n[initial]\nsurfaces = [ { file = "body.off", patch = "body" } ]\n'
                         'box = { min = [-2, -2, -2], max = [2, 2, 2], size = 1 }\n' + COARSE +
                         '[motion.body]\nkind = "rotation"\naxis = [0, 0, 1]\ncentre = [0, 0, 0]\nrate = 1\n' + project)

    def flat(self, project):
        (self.dir / "body.dat").write_text("diamond\n" + "".join(
            f"{0.1 * i} {1 - 0.1 * i}\n" for i in range(10)) + "1 0\n0 -1\n-1 0\n")
        return self.case('dimension = 2\n[initial]\ncurves = [ { file = "body.dat", patch = "body" } ]\n'
                         'box = { min = [-2, -2], max = [2, 2], size = 0.5 }\n' + COARSE +
                         '[motion.body]\nkind = "rotation"\ncentre = [0, 0]\nrate = 1\n' + project)

    def worst_distance(self, case):
        out, _ = self.build(case)
        self.check(out / "slab_0000.vtu")
        points = moving_points(out / "slab_0000.vtu")
        self.assertGreaterEqual(len(points), 6)
        flat = case.read_text().startswith("dimension = 2")
        return max(abs(sum(map(abs, turned_back((p[0], p[1], 0 if flat else p[2])))) - 1) for p in points)

    @harness.unittest.skipIf(vtk is None, "python3-vtk9 is not installed")
    def test_points_stay_on_a_triangulated_surface_that_turns_with_its_patch(self):
        self.assertGreater(self.worst_distance(self.solid("")), 0.02)
        project = '[project.body]\nsurface = "file"\nfile = "body.off"\n'
        self.assertLess(self.worst_distance(self.solid(project)), 1e-14)

    @harness.unittest.skipIf(vtk is None, "python3-vtk9 is not installed")
    def test_points_stay_on_a_curve_that_turns_with_its_patch(self):
        self.assertGreater(self.worst_distance(self.flat("")), 0.02)
        project = '[project.body]\nsurface = "file"\nfile = "body.dat"\n'
        self.assertLess(self.worst_distance(self.flat(project)), 1e-14)

    def begun(self, case, end, slabs):
        """Builds half of the slabs of a case; returns the text of the case with all of them."""
        text = case.read_text() + '[cap]\nreuse = "adapt"\n'
        times = f"[time]\nend = {end}\nslabs = {slabs}\n"
        half = f"[time]\nend = {end / 2}\nslabs = {slabs // 2}\n"
        self.build(self.case(text.replace("[time]\n", half)))
        return text.replace("[time]\n", times)

    def test_a_resumed_run_goes_on_with_the_same_motion_only(self):
        octahedron = '[project.body]\nsurface = "file"\nfile = "body.off"\n'
        diamond = '[project.body]\nsurface = "file"\nfile = "body.dat"\n'
        for make, project in ((self.solid, octahedron), (self.flat, diamond)):
            with self.subTest(make.__name__):
                text = self.begun(make(project), 0.4, 4)
                changed = self.case(text.replace("rate = 1\n", "rate = 1.05\n"))
                result = slabhull("build", changed, "--out", self.dir / "out", "--resume")
                self.assertEqual(result.code, USAGE, result.err)
                for word in ("--resume", "patch body", "t = 0.2", "off the surface of project.body", "anew"):
                    self.assertIn(word, result.err)
                report = self.build(self.case(text), "--resume")[1]
                self.assertEqual(len(report["slabs"]), 4)
                shutil.rmtree(self.dir / "out")

    def test_a_file_that_is_missing_empty_or_of_an_unknown_kind_is_named(self):
        for name in ("none.stl", "none.step", "none.xyz"):
            with self.subTest(name):
                self.refused(self.solid(f'[project.body]\nsurface = "file"\nfile = "{name}"\n'), INPUT, name)
        (self.dir / "empty.off").write_text("OFF\n0 0 0\n")
        self.refused(self.solid('[project.body]\nsurface = "file"\nfile = "empty.off"\n'), INPUT, "empty.off")
        self.refused(self.flat('[project.body]\nsurface = "file"\nfile = "none.dat"\n'), INPUT, "none.dat")

    def test_the_name_of_the_file_is_required_and_its_key_is_for_files_only(self):
        self.refused(self.solid('[project.body]\nsurface = "file"\n'), USAGE, "project.body.file")
        project = '[project.body]\nsurface = "sphere"\ncentre = [0, 0, 0]\nradius = 1\nfile = "body.off"\n'
        self.refused(self.solid(project), USAGE, "project.body.file")


@harness.unittest.skipIf(gmsh is None, "python3-gmsh is not installed")
class Models(ProgramTest):
    EXPERIMENT = '[initial]\nexperiment = "ellipsoid"\n'

    def test_an_ellipsoid_from_a_step_file_is_the_ellipsoid(self):
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        ball = gmsh.model.occ.addSphere(0, 0, 0, 1)
        gmsh.model.occ.dilate([(3, ball)], 0, 0, 0, 1, 3, 2)
        gmsh.model.occ.synchronize()
        gmsh.write(str(self.dir / "egg.step"))
        gmsh.finalize()
        case = self.case(self.EXPERIMENT + '[project.body]\nsurface = "file"\nfile = "egg.step"\n')
        result = slabhull("build", case, "--out", self.dir / "probe", "--quiet")
        if result.code == USAGE and "OpenCASCADE" in result.err:
            self.skipTest("built without OpenCASCADE")
        reports = [self.build(case, out="file")[1], self.build(self.case(self.EXPERIMENT), out="formula")[1]]
        measures = [report["slabs"][0]["measure"] for report in reports]
        for name in ("initial", "intermediate", "enclosed"):
            self.assertAlmostEqual(measures[0][name] / measures[1][name], 1, delta=1e-9, msg=name)


if __name__ == "__main__":
    harness.main()
