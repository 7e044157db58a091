#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Names that several groups share, numbers and names that a format cannot hold, and inputs that no output replaces."""
import re
import shutil
import unittest

import harness
from harness import CIRCLE, ROOT, SPHERE, ProgramTest, needs_formats, slabhull

USAGE, INPUT, OUTPUT = 2, 3, 5

# A square of four triangles around a middle point.
NODES = "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0.5 0.5 0\n$EndNodes\n"
SIDES = [(1, 2), (2, 3), (3, 4), (4, 1)]


def square(sides, cells=(9, 9, 9, 9), names=()):
    """MSH 2.2, with the groups of the sides and of the triangles; `names`: rows of $PhysicalNames."""
    rows = [f"{k + 1} 1 2 {g} {k + 1} {a} {b}" for k, (g, (a, b)) in enumerate(zip(sides, SIDES))]
    rows += [f"{k + 5} 2 2 {g} {k + 1} {a} {b} 5" for k, (g, (a, b)) in enumerate(zip(cells, SIDES))]
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    if names:
        text += f"$PhysicalNames\n{len(names)}\n" + "".join(f"{row}\n" for row in names) + "$EndPhysicalNames\n"
    return text + NODES + f"$Elements\n{len(rows)}\n" + "".join(f"{row}\n" for row in rows) + "$EndElements\n"


PLATE = 'dimension = 2\n[initial]\nmesh = "plate.msh"\n'
VTU = '[output]\nformats = ["vtu"]\n'
STILL = "[time]\nlayers = 2\nend = 0.2\n"


class Files(ProgramTest):
    def plate(self, more="", initial="", **mesh):
        (self.dir / "plate.msh").write_text(square(**mesh))
        return self.case(PLATE + initial + STILL + more)

    def told(self, *arguments):
        result = slabhull(*arguments)
        self.assertEqual(result.code, 0, result.err)
        return result

    def triangles(self, path):
        return int(re.search(r"(\d+) triangles", self.told("info", path).out)[1])


class SameNames(Files):
    GROWS = '[motion.{}]\nkind = "expansion"\ncentre = [0.5, 0.5]\nrate = 0.3\n'

    def moving(self, **mesh):
        out = self.told("build", self.plate(self.GROWS.format(mesh.pop("moved", "side")), **mesh), "--dry-run").out
        return [line for line in out.splitlines() if "moves" in line]

    def test_a_name_moves_all_groups_that_have_it(self):
        names = ('1 1 "side"', '1 2 "side"', '1 3 "side"', '1 4 "side"')
        self.assertEqual(len(self.moving(sides=(1, 2, 3, 4), names=names)), 4)

    def test_a_number_is_the_name_of_a_group_without_one(self):
        names = ('1 1 "2"', '1 3 "2"', '1 4 "2"')
        self.assertEqual(len(self.moving(sides=(1, 2, 3, 4), names=names, moved="2")), 4)

    def test_projection_stretch_and_adaptation_are_of_all_groups_of_the_name(self):
        names = ('1 1 "side"', '1 2 "side"', '1 3 "side"', '1 4 "side"')
        moved = self.GROWS.format("side") + '[adapt.side]\nsize = 0.4\n[adapt]\nboundary = true\n[cap]\nreuse = "adapt"\n'
        self.build(self.plate(moved, sides=(1, 2, 3, 4), names=names))
        surface = '[project.side]\nsurface = "circle"\ncentre = [0.5, 0.5]\nradius = 0.7071067811865476\n'
        out = self.told("build", self.plate(surface, sides=(1, 2, 3, 4), names=names), "--dry-run").out
        self.assertEqual(out.count("moves"), 4)
        two = ('1 1 "side"', '1 2 "open"', '1 3 "side"', '1 4 "open"')
        out = self.told("build", self.plate('[motion.open]\nkind = "stretch"\n', sides=(1, 2, 3, 4), names=two),
                        "--dry-run").out
        self.assertEqual(out.count("moves"), 2)

    def test_a_region_is_all_groups_of_its_name(self):
        case = self.plate(initial='regions = ["fluid"]\n', sides=(1, 1, 1, 1), cells=(5, 6, 7, 7),
                          names=('2 5 "fluid"', '2 6 "fluid"', '2 7 "solid"'))
        out, _ = self.build(case)
        self.assertIn("measure 0.5\n", self.told("info", out / "cap_0001.vtu").out)

    def test_convert_takes_all_patches_of_a_name(self):
        out, _ = self.build(self.plate('[output]\nformats = ["vtu", "msh"]\n', sides=(1, 2, 3, 4),
                                       names=('1 1 "side"', '1 2 "side"', '1 3 "rest"')))
        for name in ("slab_0000.vtu", "slab_0000.msh"):
            for patch, facets in (("side", 2), ("rest", 1), ("4", 1)):
                part, side = self.dir / f"part_{name}", self.dir / f"side_{name}"
                self.told("convert", out / name, part, "--patch", patch)
                self.told("convert", out / name, side, "--region", "side")
                self.assertEqual(4 * self.triangles(part), facets * self.triangles(side))


class Numbers(Files):
    LARGE = 2**31 - 1

    def test_numbers_that_leave_none_for_the_caps_are_refused_at_the_start(self):
        for more in ('[output]\nformats = ["msh"]\n', '[cap]\nreuse = "move"\n[fill]\nformats = ["mfem"]\n' + VTU):
            case = self.plate(more, sides=(self.LARGE, 1, 1, 1))
            for options in ((), ("--dry-run",)):
                result = slabhull("build", case, "--out", self.dir / "out", *options)
                self.assertEqual(result.code, OUTPUT, result.err)
                self.assertIn(f"{self.LARGE}", result.err)
            self.refused(case, OUTPUT, f"{self.LARGE - 2}", "smaller number")

    def test_vtu_holds_them_and_info_tells_them(self):
        out, _ = self.build(self.plate(VTU, sides=(self.LARGE, 1, 1, 1), names=(f'1 {self.LARGE} "last"',)))
        self.assertIn(f'{self.LARGE} "last"', self.told("info", out / "slab_0000.vtu").out)
        result = slabhull("fill", out / "slab_0000.vtu", self.dir / "f.mfem", "--method", "tetgen")
        self.assertEqual(result.code, OUTPUT, result.err)

    @needs_formats("mfem")
    def test_mfem_gets_positive_attributes(self):
        (self.dir / "plate.msh").write_text(square(sides=(self.LARGE, 0, 1, 2), cells=(self.LARGE, 0, 1, 2)))
        self.told("convert", self.dir / "plate.msh", self.dir / "plate.mfem")
        text = (self.dir / "plate.mfem").read_text()
        self.assertNotIn("-", text.split("vertices")[0])
        self.assertIn("\n3 2 ", text)

    def test_numbers_of_vtu_that_are_none_are_told(self):
        self.mixed_vtu([1, -5, 2**31, 7])
        case = self.case('dimension = 2\n[initial]\nmesh = "plate.vtu"\n' + STILL)
        result = self.told("build", case, "--dry-run")
        self.assertIn("2 cells have group numbers that are negative or above 2147483647, the first -5", result.err)

    def mixed_vtu(self, sides):
        def array(name, kind, values):
            return f'<DataArray Name="{name}" type="{kind}" format="ascii">{" ".join(map(str, values))}</DataArray>'

        points = "0 0 0 1 0 0 1 1 0 0 1 0"
        (self.dir / "plate.vtu").write_text(
            '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>'
            f'<Piece NumberOfPoints="4" NumberOfCells="6"><Points><DataArray type="Float64" NumberOfComponents="3" '
            f'format="ascii">{points}</DataArray></Points><CellData>' + array("patch", "Int64", [0, 0, *sides]) +
            "</CellData><Cells>" + array("connectivity", "Int64", [0, 1, 2, 0, 2, 3, 0, 1, 1, 2, 2, 3, 3, 0]) +
            array("offsets", "Int64", [3, 6, 8, 10, 12, 14]) + array("types", "UInt8", [5, 5, 3, 3, 3, 3]) +
            "</Cells></Piece></UnstructuredGrid></VTKFile>")


class CannotHold(Files):
    def test_a_quote_in_a_name_is_refused_at_the_start(self):
        mesh = {"sides": (1, 1, 1, 1), "names": ('1 1 "a"b"',)}
        for more in ('[output]\nformats = ["msh"]\n', VTU + '[cap]\nreuse = "move"\n[fill]\nformats = ["msh"]\n'):
            case = self.plate(more, **mesh)
            self.refused(case, OUTPUT, "double quote", 'a"b', "rename it")
            self.assertEqual(slabhull("build", case, "--dry-run").code, OUTPUT)
        self.build(self.plate(VTU, **mesh))

    @unittest.skipIf(harness.LEFT_OUT, "left out of this build: some formats")
    def test_every_format_refuses_other_simplices_with_one_code(self):
        room = ROOT / "examples/room.msh"
        for name in ("a.off", "a.stl", "a.obj", "a.ply", "a.face"):
            with self.subTest(name):
                result = slabhull("convert", room, self.dir / name)
                self.assertEqual(result.code, OUTPUT, result.err)
                self.assertFalse((self.dir / name).exists())


class Inputs(Files):
    def unchanged(self, files, code, *arguments):
        before = [file.read_bytes() for file in files]
        result = slabhull(*arguments)
        self.assertEqual(result.code, code, result.out + result.err)
        self.assertEqual([file.read_bytes() for file in files], before)
        return result.err

    def test_no_output_replaces_an_input(self):
        out, _ = self.build(self.case(CIRCLE + "[time]\nslabs = 2\n"))
        hulls = sorted(out.glob("slab_*.vtu"))
        self.assertEqual(len(hulls), 2)
        link = self.dir / "link.vtu"
        link.symlink_to(hulls[0])
        self.assertIn("slab_0000.vtu", self.unchanged(
            hulls, USAGE, "slice", *hulls, "--times", "0:0.1:3", "--out", out / "slab.pvd"))
        for target in (hulls[0], link):
            self.unchanged(hulls, USAGE, "slice", hulls[0], "--time", 0, "--out", target)
            self.unchanged(hulls, USAGE, "convert", hulls[0], target)
            self.unchanged(hulls, USAGE, "fill", hulls[0], target, "--method", "tetgen")
        self.unchanged(hulls, USAGE, "convert", link, hulls[0])

    def test_no_piece_or_part_replaces_an_input(self):
        out, _ = self.build(self.case(CIRCLE))
        hull = out / "slab_0000.vtu"
        shutil.copy(hull, self.dir / "a_1.vtu")
        self.unchanged([self.dir / "a_1.vtu"], USAGE, "convert", self.dir / "a_1.vtu", self.dir / "a.pvtu", "--pieces", 2)
        shutil.copy(hull, self.dir / "b_initial.vtu")
        self.unchanged([self.dir / "b_initial.vtu"], USAGE, "convert", self.dir / "b_initial.vtu", self.dir / "b.vtu",
                       "--split-output")
        self.told("convert", hull, self.dir / "c.pvtu", "--pieces", 2)
        self.unchanged([self.dir / "c_1.vtu"], USAGE, "convert", self.dir / "c.pvtu", self.dir / "c_1.vtu")

    def test_a_run_does_not_replace_what_it_starts_from(self):
        out, _ = self.build(self.case(CIRCLE))
        cap = out / "cap_0001.vtu"
        case = self.case('dimension = 2\n[initial]\nmesh = "out/cap_0001.vtu"\n[output]\ndirectory = "out"\n', "next.toml")
        for options in ((), ("--dry-run",)):
            self.assertIn("initial.mesh", self.unchanged([cap], USAGE, "build", case, *options))
        self.told("build", case, "--out", self.dir / "other", "--quiet")
        series = self.case(CIRCLE + '[motion.body]\nkind = "displacement-series"\npattern = "out/cap_*.vtu"\n'
                           '[output]\ndirectory = "out"\n', "series.toml")
        self.assertIn("motion.body.pattern", self.unchanged([cap], USAGE, "build", series, "--dry-run"))


class Adapted(Files):
    def test_an_edited_hull_loses_what_filling_it_needs(self):
        out, _ = self.build(self.case(SPHERE + '[side]\nsplit = "A"\n[cap]\nreuse = "adapt"\n' + VTU))
        hull = out / "slab_0000.vtu"
        for options in (("--scale", 3), ("--renumber", "curve"), ("--region", "side"), ("--split-output",)):
            result = self.told("convert", hull, self.dir / "edited.vtu", *options)
            self.assertIn("adapt_spacing left out", result.err)
        self.assertNotIn("adapt", self.told("convert", hull, self.dir / "same.vtu", "--weld", 0, "--scale", 1).err)
        self.told("fill", self.dir / "same.vtu", self.dir / "same.h5")
        self.told("convert", hull, self.dir / "scaled.vtu", "--scale", 3)
        self.assertNotIn("cannot be made again", slabhull("fill", self.dir / "scaled.vtu", self.dir / "a.h5").err)


class Fillings(Files):
    @needs_formats("xdmf")
    def test_hulls_and_caps_do_not_become_fillings(self):
        out, _ = self.build(self.case(SPHERE))
        for file, word in (("slab_0000.vtu", "hull"), ("cap_0001.vtu", "cap")):
            for target in ("a.h5", "a.getfem"):
                result = slabhull("convert", out / file, self.dir / target)
                self.assertEqual(result.code, INPUT, result.err)
                self.assertIn(word, result.err)
                self.assertFalse((self.dir / target).exists())

    @needs_formats("xdmf")
    def test_fillings_are_told_with_what_is_lost(self):
        out, _ = self.build(self.case(CIRCLE + '[cap]\nreuse = "move"\n[fill]\nformats = ["vtu"]\n'))
        filling = out / "fill_0000.vtu"
        result = self.told("convert", filling, self.dir / "a.getfem")
        self.assertRegex(result.out, r"a.getfem: \d+ points, \d+ tetrahedra\n")
        self.assertIn("track_id", result.err)
        result = self.told("convert", filling, self.dir / "a.h5")
        self.assertNotIn("track_id", result.err)
        self.assertIn("field data slab", result.err)
        for options in (("--encoding", "raw"), ("--version", "4.1"), ("--pieces", 2), ("--four-dimensional",), ("--linear",)):
            result = slabhull("convert", filling, self.dir / "b.h5", *options)
            self.assertEqual(result.code, USAGE, result.err)
            self.assertFalse((self.dir / "b.h5").exists())


if __name__ == "__main__":
    harness.main()
