# SPDX-License-Identifier: BSD-3-Clause
"""`slabhull slice`: sections against VTK's own contours, measures and the caps; series; what is refused, and how."""
import importlib.util
import json
import math
import unittest
import xml.etree.ElementTree as xml

import harness
from harness import SPHERE, ProgramTest, slabhull

CIRCLE = harness.CIRCLE + "[time]\nslabs = 2\n"
PAST = 'dimension = 2\n[initial]\ncurves = [ { file = "square.dat", patch = "body" } ]\n' \
       'box = { min = [-3, -3], max = [3, 3], size = 1, patch = "walls" }\n' \
       '[time]\nstart = -1\nend = -0.5\nlayers = 2\n' \
       '[motion.body]\nkind = "translation"\nvelocity = [1, 0]\n'
HAVE_VTK = all(importlib.util.find_spec(module) for module in ("vtkmodules", "numpy"))


def grid_of(path):
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def array(data, name):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    return vtk_to_numpy(data.GetArray(name))


def points_and_cells(grid):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1)
    return vtk_to_numpy(grid.GetPoints().GetData()), cells


def mass_properties(grid):
    from vtkmodules.vtkFiltersCore import vtkMassProperties
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
    surface = vtkGeometryFilter()
    surface.SetInputData(grid)
    mass = vtkMassProperties()
    mass.SetInputConnection(surface.GetOutputPort())
    mass.Update()
    return mass.GetSurfaceArea(), mass.GetVolume()


def vtk_contour_measure(grid, dimension, time):
    """Length or area of VTK's contour t = time of the side's cells."""
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkDataObject
    from vtkmodules.vtkFiltersCore import vtkContourFilter
    contour = vtkContourFilter()
    contour.SetInputData(grid)
    contour.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "t")
    contour.SetValue(0, time)
    contour.GenerateTrianglesOn()
    contour.Update()
    cut = contour.GetOutput()
    points = vtk_to_numpy(cut.GetPoints().GetData()).astype(float)
    if dimension == 2:
        lines = vtk_to_numpy(cut.GetLines().GetConnectivityArray()).reshape(-1, 2)
        return np.linalg.norm(points[lines[:, 1]] - points[lines[:, 0]], axis=1).sum()
    corners = points[vtk_to_numpy(cut.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.linalg.norm(normals, axis=1).sum() / 2


def boundary_by_ids(path):
    """The boundary facets of a cap file, each as the set of its vertices' ids."""
    import numpy as np
    grid = grid_of(path)
    _, cells = points_and_cells(grid)
    ids = array(grid.GetPointData(), "vertex_id")
    facets = np.concatenate([np.delete(cells, i, axis=1) for i in range(cells.shape[1])])
    unique, count = np.unique(np.sort(ids[facets], axis=1), axis=0, return_counts=True)
    return {tuple(row) for row in unique[count == 1]}


class SliceTest(ProgramTest):
    def slice(self, *arguments):
        """A slice that must succeed; returns the JSON document."""
        result = slabhull("slice", *arguments, "--json")
        self.assertEqual(result.code, 0, result.err)
        return json.loads(result.out)


@unittest.skipUnless(HAVE_VTK, "no VTK here")
class Sections(SliceTest):
    def test_vtk_measures_every_section_of_a_series_as_we_do(self):
        out, _ = self.build(self.case(SPHERE))
        document = self.slice(out / "slab_0000.vtu", "--times", "0:1:4", "--out", self.dir / "s.pvd")
        files = [(float(e.get("timestep")), e.get("file")) for e in xml.parse(self.dir / "s.pvd").iter("DataSet")]
        self.assertEqual([time for time, _ in files], [s["time"] for s in document["sections"]])
        self.assertEqual(document["series"], str(self.dir / "s.pvd"))
        for (time, file), section in zip(files, document["sections"]):
            self.assertEqual(section["file"], str(self.dir / file))
            area, volume = mass_properties(grid_of(self.dir / file))
            self.assertAlmostEqual(section["measure"]["boundary"] / area, 1, delta=1e-9)
            self.assertAlmostEqual(section["measure"]["enclosed"] / volume, 1, delta=1e-9)
            body = next(p for p in section["patches"] if p["name"] == "body")
            radius = 1 + time / 4
            self.assertAlmostEqual(body["measure"] / (4 * math.pi * radius**2), 1, delta=0.02)
            self.assertAlmostEqual(sum(p["measure"] for p in section["patches"]), section["measure"]["boundary"])

    def test_sections_are_as_large_as_vtks_contours_of_the_hull(self):
        for text, dimension in ((CIRCLE, 2), (SPHERE, 3)):
            out, _ = self.build(self.case(text), out=f"out{dimension}")
            hull = grid_of(out / "slab_0000.vtu")
            times = [0.0123, 0.1, 0.2, 0.37, 0.444]
            document = self.slice(out / "slab_0000.vtu", "--times", ",".join(map(str, times)), "--out",
                                  self.dir / f"s{dimension}")
            for section in document["sections"]:
                theirs = vtk_contour_measure(hull, dimension, section["time"])
                self.assertAlmostEqual(section["measure"]["boundary"] / theirs, 1, delta=1e-6)  # VTK cuts in floats

    def test_the_section_at_a_caps_time_is_the_caps_boundary(self):
        import numpy as np
        for text in (CIRCLE, SPHERE):
            out, _ = self.build(self.case(text), out=text[30:40])
            slabs = sorted(out.glob("slab_*.vtu"))
            for k, slab in enumerate(slabs):
                end = (k + 1) / len(slabs)
                self.slice(slab, "--time", end, "--out", self.dir / "end.vtu")
                section = grid_of(self.dir / "end.vtu")
                _, facets = points_and_cells(section)
                ids = array(section.GetPointData(), "vertex_id")
                seen = {tuple(row) for row in np.sort(ids[facets], axis=1)}
                self.assertEqual(seen, boundary_by_ids(out / f"cap_{k + 1:04}.vtu"))

    def test_arrays_of_a_section(self):
        import numpy as np
        out, _ = self.build(self.case(SPHERE))
        self.slice(out / "slab_0000.vtu", "--time", "0.3", "--out", self.dir / "a.vtu")
        section, hull = grid_of(self.dir / "a.vtu"), grid_of(out / "slab_0000.vtu")
        fields = section.GetFieldData()
        self.assertEqual(array(fields, "time")[0], 0.3)
        self.assertEqual(array(fields, "dimension")[0], 3)
        self.assertEqual(bytes(array(fields, "patch_name")).split(b"\0")[:-1], [b"body", b"walls"])
        cell = array(section.GetCellData(), "hull_cell")
        patch = array(section.GetCellData(), "patch")
        np.testing.assert_array_equal(patch, array(hull.GetCellData(), "patch")[cell])
        self.assertEqual(set(array(hull.GetCellData(), "region")[cell]), {1})
        # A point of a track has the track's place at that time: the sphere grows radially, the box stands.
        tracks = array(section.GetPointData(), "track_id")
        points, facets = points_and_cells(section)
        on_body = np.zeros(len(points), dtype=bool)
        on_body[facets[patch == array(fields, "patch_number")[0]]] = True
        radii = np.linalg.norm(points[on_body & (tracks >= 0)], axis=1)
        self.assertGreater(len(radii), 100)
        np.testing.assert_allclose(radii, 1.075, rtol=1e-12)


class Files(SliceTest):
    def test_a_time_is_cut_from_the_first_file_that_contains_it(self):
        out, _ = self.build(self.case(CIRCLE))
        slabs = [out / "slab_0000.vtu", out / "slab_0001.vtu"]
        for files in (slabs, slabs[::-1]):
            document = self.slice(*files, "--times", "1,0.25,0.5,0.25,0.75", "--out", self.dir / "s")
            hulls = {s["time"]: s["hull"] for s in document["sections"]}
            self.assertEqual(list(hulls), [0.25, 0.5, 0.75, 1])
            self.assertEqual(hulls, {0.25: str(slabs[0]), 0.5: str(files[0]), 0.75: str(slabs[1]), 1: str(slabs[1])})
        self.assertEqual(sorted(p.name for p in (self.dir / "s").iterdir()),
                         ["section_0000.vtu", "section_0001.vtu", "section_0002.vtu", "section_0003.vtu",
                          "sections.pvd"])

    def test_both_slabs_have_one_section_at_their_common_cap(self):
        out, _ = self.build(self.case(CIRCLE))
        measures = [self.slice(out / f"slab_000{k}.vtu", "--time", "0.5", "--out", self.dir / f"{k}.vtu")
                    ["sections"][0] for k in (0, 1)]
        self.assertEqual(measures[0]["counts"], measures[1]["counts"])
        self.assertAlmostEqual(measures[0]["measure"]["boundary"], measures[1]["measure"]["boundary"], delta=1e-12)
        self.assertAlmostEqual(measures[0]["measure"]["enclosed"], measures[1]["measure"]["enclosed"], delta=1e-12)

    def test_the_bytes_depend_neither_on_format_nor_on_threads_nor_on_other_times(self):
        out, _ = self.build(self.case(CIRCLE))
        for name, arguments in {"vtu": ("slab_0000.vtu", "--time", "0.3"), "msh": ("slab_0000.msh", "--time", "0.3"),
                                "one": ("slab_0000.vtu", "--time", "0.3", "--threads", "1"),
                                "series": ("slab_0000.vtu", "--times", "0:0.5:6")}.items():
            target = self.dir / (f"{name}.pvd" if name == "series" else f"{name}.vtu")
            self.slice(out / arguments[0], *arguments[1:], "--out", target)
        first = (self.dir / "vtu.vtu").read_bytes()
        for name in ("msh", "one", "series_0003"):
            self.assertEqual((self.dir / f"{name}.vtu").read_bytes(), first, name)

    def test_times_before_zero_and_the_words_on_stdout(self):
        (self.dir / "square.dat").write_text("-1 -1\n1 -1\n1 1\n-1 1\n")
        out, _ = self.build(self.case(PAST))
        result = slabhull("slice", out / "slab_0000.msh", "--time", "-0.7", "--out", self.dir / "a.vtu")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("a.vtu: t = -0.7, cut from", result.out)
        self.assertIn("2 closed curves", result.out)
        self.assertIn("(body 8, walls 24), encloses 32", result.out)


class Refusals(SliceTest):
    def hull(self):
        out, _ = self.build(self.case(CIRCLE))
        return out / "slab_0000.vtu"

    def refuse(self, code, words, *arguments):
        """Refused with this code and these words, and nothing is left or lost."""
        keep = self.dir / "kept.vtu"
        keep.write_text("kept")
        before = sorted(p for p in self.dir.rglob("*") if p.is_file())
        result = slabhull("slice", *arguments)
        self.assertEqual(result.code, code, f"{arguments}: {result.out}{result.err}")
        for word in words:
            self.assertIn(word, result.err + result.out)
        self.assertEqual(sorted(p for p in self.dir.rglob("*") if p.is_file()), before)
        self.assertEqual(keep.read_text(), "kept")

    def test_times_that_are_none_or_in_no_hull(self):
        hull = self.hull()
        out = ("--out", self.dir / "s")
        for option, time, words in (("--time", "noon", ["--time", "noon"]), ("--time", "nan", ["finite"]),
                                    ("--time", "0.2x", ["0.2x"]), ("--time", "0.7", ["t = 0.7", "from 0 to 0.5"]),
                                    ("--time", "-1e-9", ["none of the files"]), ("--times", "0:1", ["first:last"]),
                                    ("--times", "0:1:1", ["2 to"]), ("--times", "0:1:1e9", ["2 to"]),
                                    ("--times", "0:1:3", ["t = 1", "from 0 to 0.5"]), ("--times", "0,,1", ["\"\""]),
                                    ("--time", "", ["--time: expected"]), ("--times", "", [])):
            self.refuse(2, words, hull, option, time, *out)
        self.refuse(2, [], hull, *out)
        self.refuse(2, [], hull, "--time", "0.1", "--times", "0,0.1", *out)

    def test_places_that_sections_do_not_go_to(self):
        hull = self.hull()
        self.refuse(2, ["one section"], hull, "--times", "0,0.1", "--out", self.dir / "kept.vtu")
        self.refuse(2, [".vtk"], hull, "--time", "0", "--out", self.dir / "a.vtk")
        self.refuse(2, ["--out"], hull, "--time", "0")
        (self.dir / "d.vtu").mkdir()
        self.refuse(5, ["d.vtu"], hull, "--time", "0", "--out", self.dir / "d.vtu")
        self.refuse(5, ["kept.vtu"], hull, "--time", "0", "--out", self.dir / "kept.vtu" / "a.vtu")
        self.refuse(5, [], hull, "--time", "0", "--out", "/proc/nowhere/a.vtu")

    def test_files_that_are_no_hulls(self):
        hull = self.hull()
        out = ("--time", "0.2", "--out", self.dir / "kept.vtu")
        self.refuse(3, ["none.vtu"], self.dir / "none.vtu", *out)
        self.refuse(3, ["neither the hull"], hull.with_name("cap_0001.vtu"), *out)
        (self.dir / "junk.msh").write_text("junk")
        self.refuse(3, ["junk.msh"], self.dir / "junk.msh", *out)
        self.refuse(3, ["junk.msh"], hull, self.dir / "junk.msh", *out)
        ball, _ = self.build(self.case(SPHERE), out="ball")
        self.refuse(2, ["3D+t", "2D+t"], hull, ball / "slab_0000.vtu", *out)

    def test_a_section_is_no_hull_and_no_plane_mesh(self):
        out, _ = self.build(self.case(SPHERE))
        self.slice(out / "slab_0000.vtu", "--time", "0.2", "--out", self.dir / "ball.vtu")
        self.refuse(3, ["neither the hull"], self.dir / "ball.vtu", "--time", "0.2", "--out", self.dir / "a.vtu")
        result = slabhull("check", self.dir / "ball.vtu")
        self.assertEqual(result.code, 3)
        self.assertIn("plane mesh", result.err)

    @unittest.skipUnless(HAVE_VTK, "no VTK here")
    def test_a_hull_with_a_missing_cell_has_no_section_there(self):
        import numpy as np
        grid = grid_of(self.hull())
        points, cells = points_and_cells(grid)
        times = points[cells][:, :, 2]
        lost = np.flatnonzero((times.min(axis=1) < 0.2) & (times.max(axis=1) > 0.2))[7]
        self.write_triangles("whole.vtu", points, cells)
        self.write_triangles("open.vtu", points, np.delete(cells, lost, axis=0))
        self.slice(self.dir / "whole.vtu", "--time", "0.2", "--out", self.dir / "fine.vtu")
        self.refuse(3, ["open.vtu", "not closed", "near (", "cell"], self.dir / "open.vtu", "--time", "0.2", "--out",
                    self.dir / "kept.vtu")
        self.refuse(3, ["not closed"], self.dir / "open.vtu", "--times", "0:0.5:6", "--out", self.dir / "s")

    def write_triangles(self, name, points, cells):
        """A hull of triangles as others would write it: points, t and cells, in text."""
        def data(kind, values, attributes):
            return f'<DataArray type="{kind}" format="ascii" {attributes}>{" ".join(map(repr, values))}</DataArray>'

        flat = points.astype(float).ravel().tolist()
        arrays = {"t": data("Float64", flat[2::3], 'Name="t"'),
                  "points": data("Float64", flat, 'NumberOfComponents="3"'),
                  "connectivity": data("Int64", cells.ravel().tolist(), 'Name="connectivity"'),
                  "offsets": data("Int64", range(3, 3 * len(cells) + 1, 3), 'Name="offsets"'),
                  "types": data("UInt8", [5] * len(cells), 'Name="types"')}
        (self.dir / name).write_text(
            '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>'
            f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">'
            f'<PointData>{arrays["t"]}</PointData><Points>{arrays["points"]}</Points>'
            f'<Cells>{arrays["connectivity"]}{arrays["offsets"]}{arrays["types"]}</Cells>'
            '</Piece></UnstructuredGrid></VTKFile>')


if __name__ == "__main__":
    harness.main()
