# SPDX-License-Identifier: BSD-3-Clause
"""Layers that follow from the motion: an egg that turns, a body thrown out of its box and back, layers that are too few."""
import json
import math
import re

import harness
from harness import ProgramTest, slabhull

GEOMETRY = 4


def egg(rings=10, around=16):
    """A closed surface that is thicker at one end, as OFF."""
    points, facets = [(0, 1.6, 0)], []
    for i in range(1, rings):
        s = math.pi * i / rings
        width = math.sin(s) * (1 + 0.25 * math.cos(s))
        points += [(0.8 * width * math.cos(2 * math.pi * j / around), 1.6 * math.cos(s),
                    width * math.sin(2 * math.pi * j / around)) for j in range(around)]
    points.append((0, -1.6, 0))
    last = len(points) - 1
    for j in range(around):
        k = (j + 1) % around
        facets += [(0, 1 + k, 1 + j), (last, last - around + j, last - around + k)]
        for i in range(rings - 2):
            a, b = 1 + i * around, 1 + (i + 1) * around
            facets += [(a + j, a + k, b + j), (a + k, b + k, b + j)]
    return "\n".join([f"OFF\n{len(points)} {len(facets)} 0"] + [" ".join(map(repr, p)) for p in points]
                     + ["3 " + " ".join(map(str, f)) for f in facets]) + "\n"


class LayersTest(ProgramTest):
    def egg_case(self, motion, time=""):
        (self.dir / "egg.off").write_text(egg())
        return self.case('dimension = 3\n[initial]\nsurfaces = [ { file = "egg.off", patch = "egg" } ]\n'
                         'box = { min = [-3, -3, -3], max = [3, 3, 3], size = 1.0 }\n'
                         f'[time]\n{time}\n[motion.egg]\n{motion}\n[output]\nformats = ["vtu"]\n')

    def turned(self, angle, time=""):
        return self.egg_case(f'kind = "rotation"\naxis = [0, 0, 1]\ncentre = [0, 0, 0]\nrate = {angle}', time)

    def slab(self, case, out="out"):
        return self.build(case, out=out)[1]["slabs"][0]

    @harness.long
    def test_all_defaults_have_the_measure_of_200_layers(self):
        for angle in (1.0, math.pi):
            by_itself = self.slab(self.turned(angle))
            many = self.slab(self.turned(angle, "layers = 200"))
            side, expected = (slab["measure"]["intermediate"] for slab in (by_itself, many))
            self.assertLess(abs(side / expected - 1), 0.002, angle)
            layers = by_itself["layers"]
            self.assertEqual(layers["number"], by_itself["counts"]["layers"])
            self.assertLess(layers["number"], 40)
            self.assertLessEqual(layers["largest_deviation"], 0.05)
            self.assertLessEqual(layers["largest_turn"], 30)
            self.assertTrue(layers["sound"])
            self.assertNotIn("would_do", layers)

    def test_given_layers_that_are_too_few_are_warned_of_with_the_number_that_would_do(self):
        case = self.turned(math.pi, "layers = 3")
        result = slabhull("build", case, "--out", self.dir / "few", "--quiet")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("3 layers are too few for the motion of patch egg", result.err)
        enough = int(re.search(r"(\d+) would do", result.err)[1])
        slab = json.loads((self.dir / "few" / "report.json").read_text())["slabs"][0]
        self.assertEqual(slab["layers"]["would_do"], enough)
        self.assertFalse(slab["layers"]["sound"])
        result = slabhull("build", self.turned(math.pi, f"layers = {enough}"), "--out", self.dir / "out", "--quiet")
        self.assertEqual((result.code, result.err), (0, ""))

    def test_the_warning_comes_once(self):
        result = slabhull("build", self.turned(math.pi, "layers = 1\nslabs = 3"), "--out", self.dir / "out", "--quiet")
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual(result.err.count("too few"), 1)

    def test_a_looser_tolerance_takes_fewer_layers(self):
        self.assertLess(self.slab(self.turned(2, "layer_tolerance = 0.2"))["layers"]["number"],
                        self.slab(self.turned(2))["layers"]["number"])

    def test_each_slab_has_the_layers_that_it_needs(self):
        motion = 'kind = "velocity"\nformula = ["-9 * t^2 * y", "9 * t^2 * x", "0"]'
        _, report = self.build(self.egg_case(motion, "slabs = 3"))
        numbers = [slab["layers"]["number"] for slab in report["slabs"]]
        self.assertEqual(numbers, sorted(numbers))
        self.assertLess(numbers[0], numbers[2])

    def test_a_body_thrown_out_of_its_box_and_back_is_refused(self):
        motion = 'kind = "velocity"\nformula = ["40 * pi * cos(2 * pi * t)", "0", "0"]'
        self.refused(self.egg_case(motion), GEOMETRY, "patches egg and walls cross at t = 0.0")

    def test_a_motion_that_needs_too_many_layers_is_refused_by_patch_and_time(self):
        self.refused(self.turned(1e5), GEOMETRY, "patch egg would need more than 10000 layers", "near t = ")

    def test_an_unsound_tolerance_is_refused(self):
        self.refused(self.turned(1, "layer_tolerance = 0"), 2, "layer_tolerance", "positive")


if __name__ == "__main__":
    harness.main()
