# SPDX-License-Identifier: BSD-3-Clause
"""Checks, sections and fillings, compared with the program's."""
import json

import harness
import numpy
import slabhull
from harness import domain, program, swing

LEVELS = [0.0, 0.1, 0.2]


class Checks(harness.PythonTest):
    def setUp(self):
        super().setUp()
        self.march = slabhull.March(domain(3), motions={"body": swing}, reuse="move", split="A")
        self.slab = self.march.propose(LEVELS)
        self.hull = self.slab.hull

    def claims(self):
        return {name: getattr(self.hull, name).copy()
                for name in ("region", "patch", "layer", "neighbors", "vertex_ids", "track_ids")}

    def test_a_sound_hull_is_clean_with_the_programs_values(self):
        self.hull.write(self.dir / "hull.vtu")
        report = slabhull.check(self.slab, betti=True)
        self.assertTrue(report.clean)
        told = json.loads(program("check", self.dir / "hull.vtu", "--json", "--betti").stdout)
        del told["file"]
        self.assertEqual(report.values, told)
        self.assertEqual(str(report), "nothing found")
        self.assertEqual(slabhull.check(self.dir / "hull.vtu", betti=True).values, told)
        self.assertTrue(slabhull.check_arrays(self.hull.points, self.hull.cells, **self.claims()).clean)

    def test_planted_defects_are_found_and_named(self):
        for defect, name, plant in [("wrong-neighbor", "neighbors", lambda a: a[5].__setitem__(0, 5)),
                                    ("wrong-region", "region", lambda a: a.__setitem__(0, 2)),
                                    ("duplicate-vertex-id", "vertex_ids", lambda a: a.__setitem__(1, a[0])),
                                    ("wrong-layer", "layer", lambda a: a.__setitem__(0, 1)),
                                    ("track-repeats-time", "track_ids", lambda a: a.__setitem__(1, a[0]))]:
            claims = self.claims()
            plant(claims[name])
            report = slabhull.check_arrays(self.hull.points, self.hull.cells, **claims)
            self.assertIn(defect, [finding.what for finding in report.findings])
            self.assertFalse(report.clean)
        cells = self.hull.cells.copy()
        cells[3] = cells[3][[1, 0, 2, 3]]
        report = slabhull.check_arrays(self.hull.points, cells)
        found = [finding for finding in report.findings if finding.what == "disoriented-facet"]
        self.assertEqual(len(found), 4)
        self.assertIn(slabhull.Entity("cell", 3, ""), found[0].entities)
        self.assertIn("disoriented-facet", str(report))

    def test_a_mesh_in_space_is_checked_too(self):
        points, cells = harness.grid(3, 3)
        self.assertTrue(slabhull.check_arrays(points, cells).clean)
        cells[2] = cells[2][[1, 0, 2, 3]]
        report = slabhull.check_arrays(points, cells)
        self.assertEqual(report.findings[0].what, "inverted-cell")

    def test_claims_that_there_are_not(self):
        with self.assertRaisesRegex(slabhull.UsageError, "no claim \"regions\""):
            slabhull.check_arrays(self.hull.points, self.hull.cells, regions=[1])

    def test_a_section_has_the_area_that_the_program_tells(self):
        self.hull.write(self.dir / "hull.vtu")
        section = slabhull.slice(self.slab, 0.13)
        told = json.loads(program("slice", self.dir / "hull.vtu", "--time", "0.13", "--json", "--out",
                                  self.dir / "cut.vtu").stdout)
        self.assertEqual(section.measure, told["sections"][0]["measure"]["boundary"])
        self.assertAlmostEqual(section.measure, sum(section.measure_by_patch.values()), delta=1e-9)
        self.assertAlmostEqual(section.enclosed, 5**3 - 1, delta=1e-9)
        section.write(self.dir / "ours.vtu")
        self.assertEqual((self.dir / "ours.vtu").read_bytes(), (self.dir / "cut.vtu").read_bytes())
        several = slabhull.slice(self.hull, [0.05, 0.13])
        self.assert_same(several[1].points, section.points)
        with self.assertRaises(slabhull.UsageError):
            slabhull.slice(self.hull, 0.5)

    def test_a_filling_fills_the_hull(self):
        filling = slabhull.fill(self.slab)
        self.assertTrue(slabhull.check(filling, hull=self.hull).clean)
        self.assertAlmostEqual(slabhull.check(filling).values["volume"], 0.2 * (5**3 - 1), delta=1e-9)
        self.assert_same(filling.points[:len(self.hull.points)], self.hull.points)
        self.assert_same(filling.facets, self.hull.cells)
        section = slabhull.slice(filling, 0.1)
        at_points = section.value(filling.points @ [1, 2, 3, 4])
        exact = section.points @ [1, 2, 3] + 4 * 0.1
        self.assertLess(abs(at_points - exact).max(), 1e-12)
        other = slabhull.March(domain(3), motions={"body": slabhull.translation([0.1, 0, 0])}).step([0, 1]).hull
        self.assertFalse(slabhull.check(filling, hull=other).clean)

    def test_a_hull_whose_caps_differ_is_filled_in_the_plane_only(self):
        hull = slabhull.March(domain(2), motions={"body": swing}).step(LEVELS).hull
        filling = slabhull.fill(hull, method="tetgen")
        self.assertTrue(slabhull.check(filling, hull=hull).clean)
        with self.assertRaisesRegex(slabhull.UsageError, "in 2D"):
            slabhull.fill(self.hull, method="tetgen")
        with self.assertRaisesRegex(slabhull.UsageError, "method"):
            slabhull.fill(self.hull, method="magic")

    def test_adapted_caps_are_filled(self):
        def spin(x, t):
            return numpy.stack([-(x[:, 1] - 2.5), x[:, 0] - 2.5], axis=1) * 1.5

        march = slabhull.March(domain(2, 9), motions={"body": lambda x, t: spin(x - 2, t)}, reuse="adapt",
                               split="diagonal")
        changes = 0
        for k in range(5):
            slab = march.step(numpy.linspace(0.1 * k, 0.1 * (k + 1), 5))
            changes += slab.adapted["flips"] + slab.adapted["splits"] + slab.adapted["collapses"]
            self.assertTrue(slabhull.check(slabhull.fill(slab), hull=slab.hull).clean)
        self.assertGreater(changes, 0)


if __name__ == "__main__":
    harness.main()
