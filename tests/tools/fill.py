# SPDX-License-Identifier: BSD-3-Clause
"""`slabhull fill`: every split filled and checked; VTK, Gmsh, meshio and GetFEM on what it writes; refusals."""
import importlib.util
import json
import shutil
import subprocess
import sys
import unittest

import harness
from harness import ProgramTest, slabhull

ELLIPSOID = '[initial]\nexperiment = "ellipsoid"\nlevel = 1\n[time]\nslabs = 2\nend = 0.25\nlayers = 2\n' \
            '[side]\nsplit = "{}"\n[cap]\nreuse = "move"\n'
CIRCLE = '[initial]\nexperiment = "expanding-circle"\nlevel = 1\n[time]\nslabs = 2\nlayers = 3\n' \
         '[side]\nsplit = "{}"\n[cap]\nreuse = "move"\n'


def has(*modules):
    return all(importlib.util.find_spec(module) for module in modules)


def h5_size(path):
    import h5py
    with h5py.File(path, "r") as file:
        return file["cells"].shape, file["facets"].shape, file["neighbors"].shape


class Filling(ProgramTest):
    def fill(self, hull, out, *options):
        result = slabhull("fill", hull, out, "--json", *options)
        self.assertEqual(result.code, 0, result.err)
        return json.loads(result.out)

    def checked(self, filling, hull):
        result = slabhull("check", filling, "--hull", hull, "--json")
        self.assertEqual(result.code, 0, result.out + result.err)
        return json.loads(result.out)

    def test_every_split_is_filled_with_the_volume_that_the_hull_encloses(self):
        for case, splits in ((ELLIPSOID, "ABCDE"), (CIRCLE, ("diagonal", "centre"))):
            for split in splits:
                with self.subTest(split=split):
                    out, _ = self.build(self.case(case.format(split)), out=f"out_{split}")
                    for slab in ("slab_0000", "slab_0001"):
                        told = self.fill(out / f"{slab}.vtu", self.dir / "fill.mfem")
                        hull = self.check(out / f"{slab}.vtu")
                        found = self.checked(self.dir / "fill.mfem", out / f"{slab}.vtu")
                        self.assertEqual(found["counts"], told["counts"])
                        self.assertLess(abs(told["volume"] / hull["measure"]["enclosed"] - 1), 1e-12)
                        self.assertEqual(told["counts"]["boundary_facets"], hull["counts"]["cells"])

    def test_a_filling_is_cut_to_meshes_in_space(self):
        for case, split in ((ELLIPSOID, "A"), (CIRCLE, "centre")):
            out, _ = self.build(self.case(case.format(split)), out=f"out_{split}")
            hull, filling = out / "slab_0000.vtu", self.dir / f"{split}.h5"
            if slabhull("fill", hull, filling).code != 0:  # a build without HDF5
                self.skipTest("no HDF5")
            sections = {}
            for kind, file in (("hull", hull), ("filling", filling)):
                result = slabhull("slice", file, "--times", "0.01,0.02", "--out", self.dir / kind, "--json")
                self.assertEqual(result.code, 0, result.err)
                sections[kind] = json.loads(result.out)["sections"]
            for cut, mesh in zip(sections["hull"], sections["filling"]):
                self.assertLess(abs(mesh["measure"]["domain"] / cut["measure"]["enclosed"] - 1), 1e-12)
                self.assertEqual(slabhull("check", mesh["file"]).code, 0)
            self.assertEqual(slabhull("slice", filling, "--time", "7", "--out", self.dir / "x.vtu").code, 2)

    def test_wrong_claims_of_the_boundary_are_found_in_files_of_every_dimension(self):
        for case, split in ((ELLIPSOID, "A"), (CIRCLE, "centre")):
            out, _ = self.build(self.case(case.format(split)), out=f"out_{split}")
            hull = out / "slab_0000.vtu"
            self.fill(hull, self.dir / "f.mfem")
            lines = (self.dir / "f.mfem").read_text().split("\n")
            first = lines.index("boundary") + 2
            words = lines[first].split()
            count = str(int(lines[first - 1]) - 1)
            for planted, defect in (([" ".join([str(int(words[0]) % 3 + 1), *words[1:]])], "wrong-attribute"),
                                    ([" ".join([*words[:2], words[3], words[2], *words[4:]])], "hull-facet-reversed"),
                                    ([], "hull-facet-added")):
                with self.subTest(split=split, defect=defect):
                    size = [lines[first - 1] if planted else count]
                    (self.dir / "wrong.mfem").write_text("\n".join(lines[:first - 1] + size + planted + lines[first + 1:]))
                    result = slabhull("check", self.dir / "wrong.mfem", "--hull", hull, "--json")
                    self.assertEqual(result.code, 1, result.out + result.err)
                    self.assertEqual(json.loads(result.out)["defects"], {defect: 1})

    @unittest.skipUnless(has("h5py"), "no h5py")
    def test_hdf5_and_mfem_hold_the_same_mesh(self):
        out, _ = self.build(self.case(ELLIPSOID.format("A")))
        if slabhull("fill", out / "slab_0000.vtu", self.dir / "f.h5").code == 2:
            self.skipTest("a build without HDF5")
        by_h5 = self.checked(self.dir / "f.h5", out / "slab_0000.vtu")
        self.fill(out / "slab_0000.vtu", self.dir / "f.mfem", "--pentatope-code", 8)
        self.assertEqual(self.checked(self.dir / "f.mfem", out / "slab_0000.vtu")["volume"], by_h5["volume"])
        count = by_h5["counts"]
        self.assertEqual(h5_size(self.dir / "f.h5"), ((count["cells"], 5), (count["boundary_facets"], 4),
                                                     (count["cells"], 5)))
        lines = (self.dir / "f.mfem").read_text().split("\n")
        self.assertEqual(lines[lines.index("elements") + 2].split()[:2], ["1", "8"])

    @unittest.skipUnless(has("getfem"), "no GetFEM")
    @harness.long
    def test_getfem_finds_the_volume_and_the_outer_faces(self):
        import getfem
        for case, split, rule in ((ELLIPSOID, "C", "IM_SIMPLEX4D(3)"), (CIRCLE, "centre", "IM_TETRAHEDRON(3)")):
            out, _ = self.build(self.case(case.format(split)), out=f"out_{split}")
            told = self.fill(out / "slab_0000.vtu", self.dir / "fill.getfem")
            mesh = getfem.Mesh("load", str(self.dir / "fill.getfem"))
            self.assertEqual((mesh.nbcvs(), mesh.nbpts()), (told["counts"]["cells"], told["counts"]["vertices"]))
            outer = set(map(tuple, mesh.outer_faces().T))
            ours = {int(r): set(map(tuple, mesh.region(int(r)).T)) for r in mesh.regions()}
            self.assertEqual({str(r): len(faces) for r, faces in ours.items()}, told["facets_by_attribute"])
            self.assertEqual(set().union(*ours.values()), outer)
            volume = getfem.asm_generic(getfem.MeshIm(mesh, getfem.Integ(rule)), 0, "1", -1)
            self.assertLess(abs(float(volume) / told["volume"] - 1), 1e-12)

    @unittest.skipUnless(has("getfem"), "no GetFEM")
    @harness.long
    def test_what_getfem_saves_is_read(self):
        import getfem
        for case, split in ((ELLIPSOID, "A"), (CIRCLE, "centre")):
            out, _ = self.build(self.case(case.format(split)), out=f"out_{split}")
            told = self.fill(out / "slab_0000.vtu", self.dir / "ours.getfem")
            mesh = getfem.Mesh("load", str(self.dir / "ours.getfem"))
            mesh.save(str(self.dir / "saved.getfem"))
            found = json.loads(slabhull("check", self.dir / "saved.getfem", "--json").out)
            self.assertEqual(found["defects"], {})
            for key in ("counts", "facets_by_attribute"):
                self.assertEqual(found[key], told[key])
            self.assertLess(abs(found["volume"] / told["volume"] - 1), 1e-12)

    @unittest.skipUnless(has("getfem", "numpy"), "no GetFEM")
    @harness.long
    def test_getfem_solves_on_our_pentatopes(self):
        out, _ = self.build(self.case(ELLIPSOID.format("A")))
        self.fill(out / "slab_0001.vtu", self.dir / "fill.getfem")
        done = subprocess.run([sys.executable, harness.ROOT / "examples" / "heat_getfem.py", self.dir / "fill.getfem"],
                              capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)  # a linear u is found to rounding
        self.assertIn("in 3D + t", done.stdout)

    def test_build_fills_slabs_and_tells_of_them(self):
        out, report = self.build(self.case(CIRCLE.format("centre") + '[fill]\nformats = ["mfem", "vtu"]\n'))
        for slab in report["slabs"]:
            name = f"fill_{slab['slab']:04}"
            found = self.checked(out / f"{name}.mfem", out / f"slab_{slab['slab']:04}.vtu")
            self.assertEqual(found["counts"]["cells"], slab["fill"]["cells"])
            smallest, one_per_cent, median = slab["fill"]["mean_ratio"]
            self.assertTrue(0 < smallest < one_per_cent < median < 1)
            angle = slab["fill"]["angle"]
            self.assertTrue(0 < angle["smallest"] < 70.53 < angle["largest"] < 180)  # of the regular tetrahedron
            self.assertLess(abs(slab["fill"]["volume"] / slab["measure"]["enclosed"] - 1), 1e-12)
            self.assertTrue((out / f"{name}.vtu").exists())

    @harness.long
    def test_the_examples_with_large_turns_are_filled(self):
        """The airfoil and, in the long test, the falling brick as they are shipped, the room with more layers."""
        room = ("layers = 4", "layers = 16")
        moving = '\n[cap]\nreuse = "move"\nreuse_angle = 0.5\n[fill]\n'
        brick = [("falling-body", None, "", 4, set(range(4)))] if harness.LARGE else []
        for name, change, more, slabs, filled in (("airfoil", None, "", 2, {0, 1}), ("room", room, moving, 1, {0}), *brick):
            with self.subTest(name):
                for file in (harness.ROOT / "examples").glob("*.*"):
                    shutil.copy(file, self.dir)
                text = (self.dir / f"{name}.toml").read_text()
                if change:
                    text = text.replace(*change)
                out, report = self.build(self.case(text + more, f"{name}.toml"), out=f"out_{name}")
                self.assertEqual(len(report["slabs"]), slabs)
                self.assertEqual({slab["slab"] for slab in report["slabs"] if "fill" in slab}, filled)
                for slab in report["slabs"]:
                    if "fill" in slab:
                        self.assertLess(abs(slab["fill"]["volume"] / slab["measure"]["enclosed"] - 1), 1e-12)
                        self.assertGreater(slab["fill"]["smallest_volume"], 0)

    def test_tetgen_fills_hulls_whatever_their_caps(self):
        still = CIRCLE.format("centre").replace('[cap]\nreuse = "move"\n', "")
        out, report = self.build(self.case(still + '[fill]\nmethod = "tetgen"\nformats = ["vtu", "mfem"]\n'), out="filled")
        for slab in report["slabs"]:
            name = f"{slab['slab']:04}"
            found = self.checked(out / f"fill_{name}.mfem", out / f"slab_{name}.vtu")
            self.assertEqual(found["counts"]["cells"], slab["fill"]["cells"])
            self.assertLess(abs(slab["fill"]["volume"] / slab["measure"]["enclosed"] - 1), 1e-12)
            few = self.fill(out / f"slab_{name}.vtu", self.dir / "few.mfem", "--method", "tetgen", "--time-scale", 0.5)
            self.checked(self.dir / "few.mfem", out / f"slab_{name}.vtu")
            self.assertNotEqual(few["counts"]["cells"], slab["fill"]["cells"])
        self.refused(self.case(still + '[fill]\nmethod = "tetgen"\ntime_scale = 0\n'), 2, "time_scale")
        self.refused(self.case(ELLIPSOID.format("A") + '[fill]\nmethod = "tetgen"\n'), 2, "2D+t")
        result = slabhull("fill", out / "slab_0000.vtu", self.dir / "f.vtu", "--method", "tetgen", "--time-scale", 1e-9)
        self.assertEqual(result.code, 4)
        self.assertIn("another time scale", result.err)
        for options in (("--time-scale", 2), ("--method", "tetgen", "--time-scale", -1)):
            self.assertEqual(slabhull("fill", out / "slab_0000.vtu", self.dir / "f.vtu", *options).code, 2)
        solid, _ = self.build(self.case(ELLIPSOID.format("A").replace("slabs = 2", "slabs = 1")), out="solid")
        result = slabhull("fill", solid / "slab_0000.vtu", self.dir / "f.mfem", "--method", "tetgen")
        self.assertEqual(result.code, 2)
        self.assertIn("2D+t", result.err)

    @harness.long
    def test_fillings_are_converted_and_told_of(self):
        for case, names in ((ELLIPSOID.format("C"), ("a.mfem", "b.h5", "c.mfem", "d.getfem")),
                            (CIRCLE.format("centre"), ("a.h5", "b.getfem", "c.msh", "d.h5", "e.vtu"))):
            out, _ = self.build(self.case(case), out=f"out_{len(names)}")
            hull = out / "slab_0000.vtu"
            told = self.fill(hull, self.dir / names[0])
            for before, after in zip(names, names[1:]):
                result = slabhull("convert", self.dir / before, self.dir / after)
                self.assertEqual(result.code, 0, result.err)
                found = self.checked(self.dir / after, hull)
                self.assertEqual(found["counts"], told["counts"])
                if after.endswith((".h5", ".getfem")):
                    self.assertEqual(found["facets_by_attribute"], told["facets_by_attribute"])
            seen = json.loads(slabhull("info", self.dir / names[0], "--json").out)
            self.assertEqual((seen["kind"], seen["counts"]), ("filling", told["counts"]))
            self.assertEqual(seen["facets_by_attribute"], told["facets_by_attribute"])
            self.assertIn("filling of a slab", slabhull("info", self.dir / names[0]).out)
            self.assertEqual(slabhull("convert", self.dir / names[0], self.dir / "x.mfem", "--reverse").code, 2)
            self.assertEqual(slabhull("convert", self.dir / names[0], self.dir / "x.stl").code, 2)
        self.assertEqual((self.dir / "a.mfem").read_bytes(), (self.dir / "c.mfem").read_bytes())

    def test_an_earlier_run_leaves_nothing_beside_a_new_one(self):
        case = CIRCLE.format("centre").replace("slabs = 2", "slabs = 3") + '[fill]\nformats = ["mfem", "vtu"]\n'
        out, _ = self.build(self.case(case))
        foreign = ("slab_0001.txt", "fill_0007.mfem", "notes.vtu")  # none that the run made
        for name in foreign:
            (out / name).write_text("mine")
        fewer = case.replace("slabs = 3", "slabs = 1").split("[fill]")[0] + '[output]\nformats = ["msh"]\n'
        self.build(self.case(fewer))
        self.assertEqual(sorted(p.name for p in out.iterdir()),
                         sorted(("cap_0001.vtu", "caps.pvd", "march.state", "report.json", "slab_0000.msh", "slabs.jsonl",
                                 *foreign)))

    def test_fill_wants_caps_that_move_and_formats_that_there_are(self):
        still = CIRCLE.format("centre").replace('[cap]\nreuse = "move"\n', "")
        self.refused(self.case(still + "[fill]\n"), 2, "fill", "reuse")
        self.refused(self.case(ELLIPSOID.format("A") + '[fill]\nformats = ["vtu"]\n'), 2, "formats", "getfem")
        self.refused(self.case(CIRCLE.format("centre") + "[fill]\nformat = 1\n"), 2, "format")

    def test_a_slab_meshed_anew_is_not_filled_and_the_run_goes_on(self):
        text = CIRCLE.format("centre").replace('reuse = "move"', 'reuse = "move"\nreuse_angle = 60')
        result = slabhull("build", self.case(text + "[fill]\n"), "--out", self.dir / "out", "--quiet")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("is not filled", result.err)
        self.assertEqual(list((self.dir / "out").glob("fill_*")), [])

    @unittest.skipUnless(has("vtkmodules", "numpy"), "no VTK")
    def test_vtk_finds_the_volume_of_a_planar_filling(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        out, _ = self.build(self.case(CIRCLE.format("centre")))
        told = self.fill(out / "slab_0001.vtu", self.dir / "fill.vtu")
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.dir / "fill.vtu"))
        size = vtkCellSizeFilter()
        size.SetInputConnection(reader.GetOutputPort())
        size.Update()
        volumes = vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Volume"))
        self.assertEqual(len(volumes), told["counts"]["cells"])
        self.assertGreater(volumes.min(), 0)
        self.assertLess(abs(volumes.sum() / told["volume"] - 1), 1e-12)

    @unittest.skipUnless(has("gmsh", "meshio", "numpy"), "no Gmsh or meshio")
    def test_gmsh_and_meshio_find_the_boundary_of_a_planar_filling(self):
        import gmsh
        import meshio
        import numpy
        out, _ = self.build(self.case(CIRCLE.format("diagonal")))
        told = self.fill(out / "slab_0000.vtu", self.dir / "fill.msh")
        gmsh.initialize()
        self.addCleanup(gmsh.finalize)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(self.dir / "fill.msh"))
        names = {gmsh.model.getPhysicalName(d, tag): tag for d, tag in gmsh.model.getPhysicalGroups(2)}
        self.assertEqual(names["initial"], 1)
        self.assertEqual(names["terminating"], 2)
        triangles = sum(len(tags) for tags in gmsh.model.mesh.getElements(2)[1])
        self.assertEqual(triangles, told["counts"]["boundary_facets"])
        mesh = meshio.read(self.dir / "fill.msh")
        cells = numpy.vstack([block.data for block in mesh.cells if block.type == "tetra"])
        corners = mesh.points[cells]
        volume = numpy.linalg.det(corners[:, 1:] - corners[:, :1]).sum() / 6
        self.assertLess(abs(volume / told["volume"] - 1), 1e-12)

    def test_caps_meshed_anew_are_refused_with_what_would_help(self):
        out, _ = self.build(self.case(CIRCLE.format("centre").replace('reuse = "move"', '')))
        result = slabhull("fill", out / "slab_0000.vtu", self.dir / "fill.vtu")
        self.assertEqual(result.code, 4, result.err)
        self.assertIn('cap.reuse = "move"', result.err)
        self.assertFalse((self.dir / "fill.vtu").exists())

    def test_a_slab_that_turns_too_far_is_refused_with_cell_and_layer(self):
        text = ELLIPSOID.format("A").replace("layers = 2", "layers = 1").replace("end = 0.25", "end = 0.5")
        out, _ = self.build(self.case(text))
        result = slabhull("fill", out / "slab_0000.vtu", self.dir / "fill.mfem")
        self.assertEqual(result.code, 4, result.err)
        self.assertIn("in layer 0", result.err)
        self.assertIn("more layers", result.err)

    def test_wrong_usage_and_wrong_files_are_refused(self):
        out, _ = self.build(self.case(ELLIPSOID.format("A").replace("slabs = 2", "slabs = 1")))
        hull = out / "slab_0000.vtu"
        self.assertEqual(slabhull("fill", hull, self.dir / "fill.vtu").code, 2)  # no pentatopes in VTU
        self.assertEqual(slabhull("fill", hull, self.dir / "fill").code, 2)
        self.assertEqual(slabhull("fill", hull, self.dir / "f.mfem", "--method", "guess").code, 2)
        self.assertEqual(slabhull("fill", out / "cap_0001.vtu", self.dir / "f.mfem").code, 2)
        self.assertEqual(slabhull("fill", self.dir / "none.vtu", self.dir / "f.mfem").code, 3)
        renumbered = self.dir / "renumbered.vtu"
        self.assertEqual(slabhull("convert", hull, renumbered, "--renumber", "curve").code, 0)
        result = slabhull("fill", renumbered, self.dir / "f.mfem")
        self.assertEqual(result.code, 4, result.err)
        self.assertIn("as build writes them", result.err)
        self.assertEqual(slabhull("fill", hull, self.dir / "nowhere" / "f.mfem").code, 5)

    def test_damaged_fillings_are_told_or_refused(self):
        out, _ = self.build(self.case(ELLIPSOID.format("A").replace("slabs = 2", "slabs = 1")))
        hull = out / "slab_0000.vtu"
        self.fill(hull, self.dir / "f.mfem")
        text = (self.dir / "f.mfem").read_text()
        lines = text.split("\n")
        first = lines.index("elements") + 2
        broken = self.dir / "broken.mfem"
        swapped = lines[first].split()
        swapped[2], swapped[3] = swapped[3], swapped[2]
        broken.write_text("\n".join(lines[:first] + [" ".join(swapped)] + lines[first + 1:]))
        result = slabhull("check", broken)
        self.assertEqual(result.code, 1, result.err)
        self.assertIn("inverted-cell: cell 0", result.out)
        swapped[2] = "99999999"
        broken.write_text("\n".join(lines[:first] + [" ".join(swapped)] + lines[first + 1:]))
        result = slabhull("check", broken)
        self.assertEqual(result.code, 3)
        self.assertIn("cell 0 has the vertex 99999999", result.err)
        for cut in (30, len(text) // 3, len(text) - 20):
            broken.write_text(text[:cut])
            self.assertIn(slabhull("check", broken).code, (2, 3))


if __name__ == "__main__":
    harness.main()
