#!/usr/bin/env python3
"""Caps that are moved and changed locally: filled, resumed, the same whatever the threads; tracks begin and end once."""

import json
import math
import struct

import harness
from harness import ProgramTest, main, slabhull

ELLIPSOID = ('[initial]\nexperiment = "ellipsoid"\nlevel = 1\n[time]\nslabs = {slabs}\nend = {end}\nlayers = 4\n'
             '[side]\nsplit = "C"\n[cap]\nreuse = "adapt"\nsize = 2.5\n[adapt]\nangle = 12\n[fill]\nformats = ["mfem"]\n'
             '[output]\nformats = ["vtu"]\n')
AIRFOIL = """
dimension = 2
[initial]
curves = [ {{ file = "{root}/examples/naca0012.dat", patch = "airfoil" }} ]
box = {{ min = [-2.0, -2.0], max = [4.0, 2.0], size = 0.4, patch = "farfield" }}
[time]
end = 1.0
slabs = 10
layers = 30
[motion.airfoil]
kind = "velocity"
formula = [ "6.283185307179586 * y", "-6.283185307179586 * (x - 0.25)" ]
[cap]
reuse = "adapt"
[fill]
formats = ["vtu"]
[output]
formats = ["vtu"]
"""

# Radius (1 + a t) (1 - a / (1 + a) t): from 1 to 4 and back.
SPHERE = """
dimension = {dimension}
[initial]
{bodies}
box = {{ min = {low}, max = {high}, size = {size}, patch = "walls" }}
[time]
slabs = {slabs}
[motion.body]
kind = "sequence"
steps = [ {{ kind = "expansion", centre = {centre}, rate = 12.928203230275509 }},
          {{ kind = "expansion", centre = {centre}, rate = -0.928203230275509 }} ]
[project.body]
surface = "{surface}"
centre = {centre}
radius = 1
[cap]
reuse = "adapt"
[adapt]
boundary = true
[fill]
formats = ["getfem"]
[output]
formats = ["vtu"]
"""
NEEDLE = """
dimension = 3
[initial]
surfaces = [ {{ file = "{root}/examples/sphere.off", patch = "body" }} ]
box = {{ min = [-6, -6, -6], max = [6, 6, 6], size = 1.5, patch = "walls" }}
[time]
slabs = 5
[motion.body]
kind = "velocity"
formula = [ "1.3862943611198906 * x", "-0.6931471805599453 * y", "-0.6931471805599453 * z" ]
[side]
split = "A"
[cap]
reuse = "adapt"
[adapt.body]
[fill]
formats = ["mfem"]
[output]
formats = ["vtu"]
"""
PISTON = """
dimension = 3
[initial]
mesh = "{root}/examples/piston.msh"
[time]
slabs = 6
{motions}
[side]
split = "A"
[cap]
reuse = "adapt"
[adapt]
boundary = true
[fill]
formats = ["mfem"]
[output]
formats = ["vtu"]
"""


def circle(case):
    turn = [2 * math.pi * k / 24 for k in range(24)]
    (case.dir / "circle.dat").write_text("".join(f"{math.cos(a)!r} {math.sin(a)!r}\n" for a in turn))
    return SPHERE.format(dimension=2, bodies='curves = [ { file = "circle.dat", patch = "body" } ]', low="[-6, -6]",
                         high="[6, 6]", size=1, slabs=20, centre="[0, 0]", surface="circle")


def sphere(slabs):
    body = f'surfaces = [ {{ file = "{harness.ROOT}/examples/sphere.off", patch = "body" }} ]'
    return SPHERE.format(dimension=3, bodies=body, low="[-6, -6, -6]", high="[6, 6, 6]", size=1.5, slabs=slabs,
                         centre="[0, 0, 0]", surface="sphere").replace("[adapt]", '[side]\nsplit = "A"\n[adapt]')


def radius(t):
    return (1 + 12.928203230275509 * t) * (1 - 0.928203230275509 * t)


class Adapted(ProgramTest):
    def sound(self, slab, least_angle):
        self.assertEqual(slab["cap"]["made"], "adapted")
        self.assertGreaterEqual(slab["adapt"]["smallest_angle"], least_angle)
        self.assertLess(abs(slab["fill"]["volume"] / slab["measure"]["enclosed"] - 1), 1e-12)
        self.assertGreater(slab["fill"]["smallest_volume"], 0)

    def checked(self, out, slab, extension):
        result = slabhull("check", out / f"fill_{slab:04}.{extension}", "--hull", out / f"slab_{slab:04}.vtu", "--json")
        self.assertEqual(result.code, 0, result.out + result.err)

    @harness.longest
    def test_an_airfoil_turns_once_and_every_slab_is_filled(self):
        out, report = self.build(self.case(AIRFOIL.format(root=harness.ROOT)))
        self.assertEqual(len(report["slabs"]), 10)
        for slab in report["slabs"]:
            self.sound(slab, 8)
        for slab in (0, 9):
            self.checked(out, slab, "vtu")
            self.check(out / f"slab_{slab:04}.vtu")
        self.assertGreater(sum(slab["adapt"]["splits"] for slab in report["slabs"]), 0)
        self.assertGreater(sum(slab["adapt"]["collapses"] for slab in report["slabs"]), 0)
        cells = [slab["fill"]["cells"] for slab in report["slabs"]]
        self.assertLess(max(cells) / min(cells), 1.2)

    def test_an_ellipsoid_turns_further_than_a_moved_cap_can(self):
        out, report = self.build(self.case(ELLIPSOID.format(slabs=7, end=1.4)))
        for slab in report["slabs"]:
            self.sound(slab, 8)
        self.checked(out, 6, "mfem")
        self.check(out / "slab_0006.vtu")

    def test_a_resumed_run_and_other_threads_write_the_same_bytes(self):
        whole = self.case(ELLIPSOID.format(slabs=2, end=0.4))
        first = self.case(ELLIPSOID.format(slabs=1, end=0.2), "first.toml")
        out, _ = self.build(whole)
        self.build(first, "--threads", "1", out="resumed")
        self.build(whole, "--resume", "--threads", "1", out="resumed")
        for name in ("slab_0000.vtu", "slab_0001.vtu", "cap_0002.vtu", "fill_0001.mfem"):
            self.assertEqual((out / name).read_bytes(), (self.dir / "resumed" / name).read_bytes(), name)

    def test_more_layers_are_taken_where_a_filling_needs_them(self):
        text = ELLIPSOID.format(slabs=2, end=1.0).replace("layers = 4", "layers = 1").replace('split = "C"', 'split = "E"')
        _, report = self.build(self.case(text))
        self.assertGreater(sum(slab["adapt"]["halvings"] for slab in report["slabs"]), 0)
        for slab in report["slabs"]:
            self.sound(slab, 5)
            self.assertEqual(slab["layers"]["number"], 2 ** slab["adapt"]["halvings"])

    def test_a_resumed_run_tells_of_layers_as_the_whole_one(self):
        text = ELLIPSOID.replace("[fill]\n", "").replace('formats = ["mfem"]\n', "")
        whole = self.case(text.format(slabs=3, end=1.5).replace("layers = 4", "layers = 2"))
        first = self.case(text.format(slabs=1, end=0.5).replace("layers = 4", "layers = 2"), "first.toml")
        _, report = self.build(whole)
        self.build(first, out="resumed")
        _, resumed = self.build(whole, "--resume", out="resumed")
        self.assertEqual([slab["layers"] for slab in report["slabs"]], [slab["layers"] for slab in resumed["slabs"]])
        self.assertIn("would_do", report["slabs"][0]["layers"])

    def test_settings_are_checked(self):
        text = ELLIPSOID.format(slabs=1, end=0.1)
        self.refused(self.case(text.replace("angle = 12", "size = 1e-12")), 4, "adapt.size")
        self.refused(self.case(text.replace("angle = 12", "angle = 16")), 2, "angle", "15")
        self.refused(self.case(text.replace("angle = 12", "angle = 0")), 2, "angle", "5")
        self.refused(self.case(text.replace("angle = 12", "angle = 50")), 2, "angle", "15")
        self.refused(self.case(text.replace("angle = 12", "size = -1")), 2, "size")
        self.refused(self.case(text.replace("angle = 12", "angel = 12")), 2, "angel")
        self.refused(self.case(text.replace('reuse = "adapt"', 'reuse = "move"')), 2, "adapt", "reuse")

    def test_a_hull_s_file_alone_is_filled_with_the_same_bytes(self):
        for text, extension in ((ELLIPSOID.format(slabs=2, end=0.4), "mfem"),
                                (AIRFOIL.format(root=harness.ROOT).replace("slabs = 10", "slabs = 2")
                                 .replace("end = 1.0", "end = 0.2"), "vtu")):
            out, report = self.build(self.case(text), out=f"out_{extension}")
            for slab in report["slabs"]:
                self.assertGreater(slab["adapt"]["splits"] + slab["adapt"]["collapses"], 0)
                name = f"{slab['slab']:04}"
                result = slabhull("fill", out / f"slab_{name}.vtu", self.dir / f"again.{extension}")
                self.assertEqual(result.code, 0, result.err)
                self.assertEqual((self.dir / f"again.{extension}").read_bytes(),
                                 (out / f"fill_{name}.{extension}").read_bytes())

    def test_a_file_without_what_was_adapted_is_not_filled_and_the_message_says_what_is(self):
        out, _ = self.build(self.case(ELLIPSOID.format(slabs=1, end=0.2)))
        slabhull("convert", out / "slab_0000.vtu", self.dir / "hull.msh")
        result = slabhull("fill", self.dir / "hull.msh", self.dir / "fill.mfem")
        self.assertEqual(result.code, 4, result.err)
        self.assertIn("[fill]", result.err)
        self.assertFalse((self.dir / "fill.mfem").exists())

    def test_settings_that_lead_to_another_cap_are_refused(self):
        out, _ = self.build(self.case(ELLIPSOID.format(slabs=1, end=0.2)))
        hull = (out / "slab_0000.vtu").read_bytes()
        angle = struct.pack("<d", 12.0)
        at = hull.index(angle, hull.index(b"<AppendedData"))  # in the field adapt_settings: fields come first
        (self.dir / "other.vtu").write_bytes(hull[:at] + struct.pack("<d", 3.0) + hull[at + 8:])
        result = slabhull("fill", self.dir / "other.vtu", self.dir / "fill.mfem")
        self.assertEqual(result.code, 4, result.err)
        self.assertIn("do not lead to its terminating cap", result.err)
        self.assertFalse((self.dir / "fill.mfem").exists())

    def test_too_few_layers_are_halved_and_that_is_said(self):
        text = ELLIPSOID.format(slabs=1, end=1.2).replace("layers = 4", "layers = 1")
        result = slabhull("build", self.case(text), "--out", self.dir / "out")
        self.assertEqual(result.code, 0, result.err)
        slab = json.loads((self.dir / "out" / "report.json").read_text())["slabs"][0]
        self.assertGreater(slab["adapt"]["halvings"], 0)
        self.assertEqual(slab["layers"]["number"], 2 ** slab["adapt"]["halvings"])
        self.assertIn(f"slab 0 has {slab['layers']['number']} layers", result.err)
        self.sound(slab, 5)

    def sections(self, out, slab, times):
        result = slabhull("slice", out / f"slab_{slab:04}.vtu", "--times", ",".join(map(repr, times)), "--out",
                          self.dir / "cut.pvd", "--json")
        self.assertEqual(result.code, 0, result.err)
        return json.loads(result.out)["sections"]

    def on_boundary(self, report):
        return sum(slab["adapt"]["on_boundary"] for slab in report["slabs"])

    def test_a_circle_grows_fourfold_and_back_with_edges_of_one_length(self):
        out, report = self.build(self.case(circle(self)))
        self.assertGreater(self.on_boundary(report), 100)
        for slab in report["slabs"]:
            self.sound(slab, 8)
            self.assertGreater(slab["adapt"]["boundary_edge_length_ratio"][0], 0.6)
            self.assertLess(slab["adapt"]["boundary_edge_length_ratio"][1], 1.6)
        self.checked(out, 9, "getfem")
        for number in (0, 5, 9, 14, 19):
            self.check(out / f"slab_{number:04}.vtu")
            times = [(number + part) / 20 for part in (0.1, 0.3, 0.5, 0.7, 0.9)]
            for time, section in zip(times, self.sections(out, number, times)):
                length = section["patches"][0]["measure"]
                self.assertLess(abs(length / (2 * math.pi * radius(time)) - 1), 0.02)

    def test_a_sphere_grows_and_every_slab_is_filled(self):
        out, report = self.build(self.case(sphere(8).replace("slabs = 8", "slabs = 8\nend = 0.1")))
        self.assertGreater(self.on_boundary(report), 50)
        for slab in report["slabs"]:
            self.sound(slab, 5)
            self.assertLess(slab["adapt"]["boundary_edge_length_ratio"][1], 1.9)
        self.check(out / "slab_0007.vtu")
        self.checked(out, 7, "getfem")
        facets = [self.sections(out, number, [time])[0]["patches"][0] for number, time in ((0, 0.001), (7, 0.099))]
        self.assertGreater(facets[1]["facets"], 2 * facets[0]["facets"])
        self.assertLess(abs(facets[1]["measure"] / (4 * math.pi * radius(0.099) ** 2) - 1), 0.04)

    def test_a_slab_whose_boundary_changes_is_filled_as_it_is_built_and_the_message_says_so(self):
        out, _ = self.build(self.case(circle(self).replace("slabs = 20", "slabs = 20\nend = 0.1")))
        changed = [slab for slab in range(20) if (out / f"slab_{slab:04}.vtu").stat().st_size and
                   slabhull("fill", out / f"slab_{slab:04}.vtu", self.dir / "fill.vtu").code != 0]
        self.assertNotEqual(changed, [])
        result = slabhull("fill", out / f"slab_{changed[0]:04}.vtu", self.dir / "again.vtu")
        self.assertEqual(result.code, 4, result.err)
        self.assertIn("[fill]", result.err)
        self.assertFalse((self.dir / "again.vtu").exists())

    def test_a_run_on_a_changing_boundary_is_resumed_and_does_not_depend_on_threads(self):
        whole = self.case(circle(self))
        first = self.case(circle(self).replace("slabs = 20", "slabs = 10\nend = 0.5"), "first.toml")
        out, _ = self.build(whole)
        self.build(first, "--threads", "1", out="resumed")
        self.build(whole, "--resume", "--threads", "1", out="resumed")
        for name in [f"slab_{slab:04}.vtu" for slab in range(20)] + ["cap_0020.vtu", "fill_0019.getfem"]:
            self.assertEqual((out / name).read_bytes(), (self.dir / "resumed" / name).read_bytes(), name)

    @harness.longest
    def test_a_sphere_becomes_a_needle(self):
        out, report = self.build(self.case(NEEDLE.format(root=harness.ROOT)))
        self.assertGreater(self.on_boundary(report), 50)
        for slab in report["slabs"]:
            self.sound(slab, 5)
        self.checked(out, 4, "mfem")
        self.check(out / "slab_0004.vtu")

    def test_the_wall_of_a_piston_is_adapted_over_its_stroke(self):
        velocity = '"0", "0", "3.141592653589793 * sin(2 * 3.141592653589793 * t) * z / (1 + sin(3.141592653589793 * t)^2)"'
        motions = "".join(f'[motion.{patch}]\nkind = "velocity"\nformula = [ {velocity} ]\n' for patch in ("piston", "wall"))
        out, report = self.build(self.case(PISTON.format(root=harness.ROOT, motions=motions)))
        self.assertGreater(self.on_boundary(report), 20)
        for slab in report["slabs"]:
            self.sound(slab, 5)
        for number in (1, 4):
            self.check(out / f"slab_{number:04}.vtu")
        lids = self.sections(out, 2, [0.5])[0]["patches"]
        self.assertEqual(len(lids), 3)

    def test_patches_are_kept_as_they_are_or_given_a_size(self):
        text = circle(self).replace("slabs = 20", "slabs = 20\nend = 0.2")
        _, fixed = self.build(self.case(text.replace("boundary = true", "[adapt.body]\nfixed = true")), out="fixed")
        self.assertEqual(self.on_boundary(fixed), 0)
        _, fine = self.build(self.case(text.replace("boundary = true", "[adapt.body]\nsize = 0.1")), out="fine")
        _, plain = self.build(self.case(text), out="plain")
        self.assertGreater(self.on_boundary(fine), self.on_boundary(plain))
        self.refused(self.case(text.replace("boundary = true", "[adapt.bodi]\nsize = 0.15")), 2, "bodi", "body")
        self.refused(self.case(text.replace("boundary = true", "[adapt.body]\nsizes = 0.15")), 2, "sizes")
        self.refused(self.case(text.replace("boundary = true", "[adapt.body]\nsize = 0")), 2, "size")
        self.refused(self.case(text.replace("boundary = true", "[adapt.boundary]\nsize = 1")), 2,
                     "adapt.boundary: expected a value, not the table of a patch", "group with a name")
        self.refused(self.case(text.replace("boundary = true", "feature_angle = 120")), 2, "feature_angle")
        self.refused(self.case(text.replace("boundary = true", "distance = -1")), 2, "distance")

    def test_lengths_that_are_not_reached_are_told(self):
        case = self.case("""dimension = 2
initial = { curves = [ { file = "body.dat", patch = "body" } ], box = { min = [-4, -4], max = [4, 4], size = 1 } }
time = { layers = 2, end = 0.3 }
motion.body = { kind = "translation", velocity = [1, 0] }
cap.reuse = "adapt"
adapt.body.size = 1e-7
""")
        (self.dir / "body.dat").write_text("".join(f"{math.cos(k)} {math.sin(k)}\n" for k in range(6)))
        result = slabhull("build", case, "--out", self.dir / "out")
        self.assertEqual(result.code, 0, result.err)
        self.assertRegex(result.err, "edges of the boundary end between .* and .* of the lengths that .adapt. asks for")


if __name__ == "__main__":
    main()
