# SPDX-License-Identifier: BSD-3-Clause
"""Boundaries that tangle at times known in closed form: named with patches, time, place and facets; and slabs that end
before that, with `[time] adapt`."""
import json
import math
import re

import harness
from harness import ProgramTest, slabhull
from motions import octahedron, plate

USAGE, GEOMETRY = 2, 4
SPEED = 0.9
TOUCH = 0.5 / SPEED  # when a tip 0.5 from what it heads for is there


def number(text):
    return float(text.rstrip(".,:"))


class TanglingTest(ProgramTest):
    def slabs(self, out):
        """The slabs of a run that ended early, each one checked."""
        slabs = json.loads((out / "report.json").read_text())["slabs"]
        for slab in slabs:
            result = slabhull("check", out / f"slab_{slab['slab']:04}.vtu", "--embedding")
            self.assertEqual(result.code, 0, result.out + result.err)
        return slabs

    def tangles(self, case, out="out"):
        result = slabhull("build", case, "--out", self.dir / out, "--quiet")
        self.assertEqual(result.code, GEOMETRY, result.out + result.err)
        return result.err

    def bracket(self, message):
        """Until when the boundary is good, when and where it is not, from which to which time the slab was to go."""
        at = re.search(r"at t = (\S+) near \(([^)]*)\), facets? (\d+)", message)
        good = re.search(r"is good until t = (\S+) (\S+) % of the slab from (\S+) to (\S+)", message)
        self.assertTrue(at and good, message)
        bad, good_until, begin, end = (number(m) for m in (at[1], good[1], good[3], good[4]))
        self.assertAlmostEqual(number(good[2]), 100 * (good_until - begin) / (end - begin), delta=0.01)
        self.assertLessEqual(bad - good_until, 1e-3 * (end - begin) + 1e-8)
        return good_until, bad, [float(x) for x in at[2].split(", ")]

    def assert_tangles_at(self, message, time, near=None, delta=0.02):
        good, bad, place = self.bracket(message)
        self.assertLess(good, time + 1e-8)
        self.assertGreater(bad, time - 1e-8)
        if near is not None:
            self.assertLess(math.dist(place, near), delta, message)


def bodies_case(bodies, motions, time):
    """Octahedra with tips 0.4 in x, 0.3 in y and 0.15 in z from their centres, in a box with walls at x = -1.5 and 1.5."""
    surfaces = ", ".join(f'{{ file = "{name}.off", patch = "{name}" }}' for name in bodies)
    return (f'dimension = 3\n[initial]\nsurfaces = [ {surfaces} ]\n'
            f'box = {{ min = [-1.5, -1, -1], max = [1.5, 1, 1], size = 0.5, patch = "casing" }}\n[time]\n{time}\n'
            + "".join(f"[motion.{name}]\n{motion}\n" for name, motion in motions.items())
            + '[output]\nformats = ["vtu"]\n')


class InSpace(TanglingTest):
    def octahedra(self, centres, motions, time="layers = 2"):
        for name, centre in centres.items():
            (self.dir / f"{name}.off").write_text(octahedron(*centre))
        return self.case(bodies_case(centres, motions, time))

    def toward(self, speed, dimension=3):
        return f'kind = "translation"\nvelocity = {[speed] + [0] * (dimension - 1)}'

    def test_two_bodies_that_cross_are_named_with_time_place_and_facets(self):
        # The tips at (-0.2, 0.05, 0.03) and (0.3, 0.05, 0.03) meet.
        case = self.octahedra({"rotor": (-0.6, 0.05, 0.03), "stator": (0.7 - 1e-3, 0.05, 0.03)},
                              {"rotor": self.toward(0.5), "stator": self.toward(-0.4)})
        message = self.tangles(case)
        self.assertIn("patches rotor and stator cross at t = ", message)
        time = (0.5 - 1e-3) / SPEED
        self.assert_tangles_at(message, time, (-0.2 + 0.5 * time, 0.05, 0.03))
        facets = re.search(r"facets (\d+) and ([\d, ]+)", message)
        of_rotor, of_stator = int(facets[1]), [int(f) for f in facets[2].split(", ")]
        self.assertIn(of_rotor, (0, 3, 4, 7))  # those at its tip of larger x
        self.assertTrue(of_stator and set(of_stator) <= {8 + f for f in (1, 2, 5, 6)}, message)

    def test_a_body_that_meets_the_box(self):
        case = self.octahedra({"rotor": (0.6, 0.05, 0.03)}, {"rotor": self.toward(SPEED)})
        message = self.tangles(case)
        self.assertIn("patches rotor and casing cross at t = ", message)
        self.assert_tangles_at(message, TOUCH, (1.5, 0.05, 0.03))

    def test_a_body_that_has_left_the_box_at_the_next_level(self):
        case = self.octahedra({"rotor": (0.6, 0.05, 0.03)}, {"rotor": self.toward(SPEED)}, "end = 30\nlayers = 1")
        message = self.tangles(case)
        self.assertIn("patches rotor and casing cross at t = ", message)
        self.assert_tangles_at(message, TOUCH, (1.5, 0.05, 0.03), 0.05)

    def body(self, points, facets, motion, time):
        text = "\n".join(["OFF", f"{len(points)} {len(facets)} 0"] + [" ".join(map(str, p)) for p in points]
                         + ["3 " + " ".join(map(str, f)) for f in facets]) + "\n"
        (self.dir / "body.off").write_text(text)
        return self.case(bodies_case(["body"], {"body": motion}, time))

    # A cube of edge 0.6; vertex 8 is the middle of its face of smaller z.
    CUBE = [(x, y, z) for z in (-0.3, 0.3) for y in (-0.3, 0.3) for x in (-0.3, 0.3)] + [(0, 0, -0.3)]
    FACETS = [(8, 0, 2), (8, 2, 3), (8, 3, 1), (8, 1, 0), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (1, 3, 7), (1, 7, 5),
              (3, 2, 6), (3, 6, 7), (2, 0, 4), (2, 4, 6)]

    def test_a_vertex_that_goes_through_the_opposite_face(self):
        speed = 0.75
        motion = f'kind = "velocity"\nformula = ["0", "0", "abs(x) + abs(y) < 0.1 ? {speed} : 0"]'
        message = self.tangles(self.body(self.CUBE, self.FACETS, motion, "layers = 4"))
        self.assertIn("patch body crosses itself at t = ", message)
        self.assert_tangles_at(message, 0.6 / speed, (0, 0, 0.3))

    def test_a_facet_that_collapses(self):
        # The middle vertex is on an edge of its face at t = 1/2, which is a level; euler has it there exactly.
        cube = [tuple(c / 0.6 for c in point) for point in self.CUBE]
        motion = 'kind = "velocity"\nformula = ["abs(y) < 0.1 ? 1 : 0", "0", "0"]'
        case = self.body(cube, self.FACETS, motion, 'layers = 2\n[trajectory]\nscheme = "euler"')
        message = self.tangles(case)
        self.assertIn("patch body collapses at t = 0.5 near (0.5, 0.5, -0.5), facet 2\n", message)
        self.assertIn("patch body crosses itself at t = 0.5", message)
        self.assert_tangles_at(message, 0.5)

    def test_slabs_end_before_the_bodies_meet(self):
        time = 'slabs = 4\nlayers = 2\nadapt = true\n'
        case = self.octahedra({"rotor": (-0.6, 0.05, 0.03), "stator": (0.7, 0.05, 0.03)},
                              {"rotor": self.toward(0.5), "stator": self.toward(-0.4)}, time)
        self.assertIn("adapt_floor", self.tangles(case))
        slabs = self.slabs(self.dir / "out")
        times = [0.0] + [slab["time"][1] for slab in slabs]
        self.assertEqual(times[:3], [0, 0.25, 0.5])
        self.assertEqual(len(times), 4)
        self.assertLess(times[3], TOUCH)
        self.assertLess(TOUCH - times[3], 1e-3 * 0.25 + 1e-9)


class InThePlane(TanglingTest):
    """A rhombus whose tip heads for the wall at x = 2."""

    def wall_case(self, time):
        (self.dir / "body.dat").write_text(plate(x=1.0, y=0.1))
        return self.case('dimension = 2\n[initial]\ncurves = [ { file = "body.dat", patch = "body" } ]\n'
                         'box = { min = [-2, -2], max = [2, 2], size = 0.5, patch = "casing" }\n'
                         f'[motion.body]\nkind = "translation"\nvelocity = [{SPEED}, 0]\n[time]\n{time}\n')

    def test_without_adapt_the_slab_fails_and_the_ones_before_stay(self):
        message = self.tangles(self.wall_case("slabs = 4\nlayers = 3"))
        self.assertIn("patches body and casing cross at t = ", message)
        self.assertIn("adapt = true", message)
        self.assert_tangles_at(message, TOUCH, (2, 0.1))
        self.assertEqual([slab["time"] for slab in self.slabs(self.dir / "out")], [[0, 0.25], [0.25, 0.5]])

    def test_with_adapt_slabs_go_on_until_the_floor(self):
        for floor in (None, 1e-5):
            with self.subTest(floor=floor):
                out = f"out{floor}"
                line = "" if floor is None else f"adapt_floor = {floor}\n"
                message = self.tangles(self.wall_case("slabs = 4\nlayers = 3\nadapt = true\n" + line), out)
                self.assertIn("adapt_floor", message)
                self.assertIn("Change the motion, or allow shorter slabs.", message)
                self.assertNotIn("adapt = true", message)  # it is
                self.assert_tangles_at(message, TOUCH)
                slabs = self.slabs(self.dir / out)
                self.assertGreaterEqual(len(slabs), 3)
                self.assertEqual(slabs[1]["time"], [0.25, 0.5])
                for before, after in zip(slabs, slabs[1:]):
                    self.assertEqual(before["time"][1], after["time"][0])
                for slab in slabs[2:]:
                    begin, end = slab["time"]
                    self.assertLess(end, TOUCH)
                    self.assertGreaterEqual(end - begin, (floor or 0.01) * 0.25)
                self.assertLess(TOUCH - slabs[-1]["time"][1], 1e-3 * 0.25)

    def test_a_slab_that_is_too_bold_is_shortened_and_the_run_goes_on_to_its_end(self):
        # One step of euler goes straight on, by SPEED t, and would meet the wall; the velocity that it meets when it
        # looks again, at the time of touching, leads back.
        case = self.case(self.wall_case("layers = 1\nadapt = true").read_text().replace(
            f'"translation"\nvelocity = [{SPEED}, 0]', f'"velocity"\nformula = ["{SPEED} * cos(pi * t)", "0"]')
            + '[trajectory]\nscheme = "euler"\nsubsteps = 1\n')
        out, report = self.build(case)
        slabs = self.slabs(out)
        self.assertEqual(len(slabs), 2)
        self.assertEqual((slabs[0]["time"][0], slabs[1]["time"][1]), (0, 1))
        self.assertEqual(slabs[0]["time"][1], slabs[1]["time"][0])
        self.assertTrue(0 <= TOUCH - slabs[0]["time"][1] <= 1e-3)
        self.assertEqual(report["settings"]["slabs"], 1)

    def test_a_run_that_adapted_is_the_same_when_it_is_resumed(self):
        case = self.wall_case("slabs = 4\nlayers = 3\nadapt = true\nadapt_floor = 1e-5")
        self.tangles(case)
        files = {path.name: path.read_bytes() for path in (self.dir / "out").glob("slab_*.vtu")}
        result = slabhull("build", case, "--out", self.dir / "out", "--quiet", "--resume")
        self.assertEqual(result.code, GEOMETRY)
        self.assertIn("adapt_floor", result.err)
        self.assertEqual(files, {path.name: path.read_bytes() for path in (self.dir / "out").glob("slab_*.vtu")})

    def test_a_shortened_slab_is_told(self):
        result = slabhull("build", self.wall_case("slabs = 4\nadapt = true"), "--out", self.dir / "out")
        self.assertRegex(result.err, r"slab 2 ends at t = 0\.555\d*, before its boundary tangles")

    def test_a_motion_that_does_not_tangle_is_left_alone(self):
        plain, _ = self.build(self.wall_case("end = 0.5\nslabs = 2"), out="plain")
        adapted, _ = self.build(self.wall_case("end = 0.5\nslabs = 2\nadapt = true"), out="adapted")
        for name in ("slab_0000.vtu", "slab_0001.vtu"):
            self.assertEqual((plain / name).read_bytes(), (adapted / name).read_bytes())

    def test_keys_that_are_wrong(self):
        self.refused(self.wall_case("adapt = 1"), USAGE, "time.adapt")
        self.refused(self.wall_case("adapt_floor = 0"), USAGE, "time.adapt_floor")
        self.refused(self.wall_case("adapt_floor = 1.5"), USAGE, "time.adapt_floor", "at most 1")


if __name__ == "__main__":
    harness.main()
