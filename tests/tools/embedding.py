# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that pass through each other between two levels are found by `build` and `check`, sound hulls are not blamed."""
import json
import re
import shutil

import harness
from harness import ROOT, ProgramTest, slabhull

BOX = {2: 'box = { min = [-2, -2], max = [2, 2], size = 0.5, patch = "walls" }',
       3: 'box = { min = [-2, -2, -2], max = [2, 2, 2], size = 0.8, patch = "walls" }'}
RADIUS = 0.4
OFFSET = 0.01  # of the second body, so that nothing touches by symmetry


def octahedron(x, y):
    """An OFF octahedron about (x, y, 0)."""
    points = [(x + RADIUS, y, 0), (x - RADIUS, y, 0), (x, y + RADIUS, 0), (x, y - RADIUS, 0), (x, y, RADIUS),
              (x, y, -RADIUS)]
    facets = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    lines = ["OFF", f"{len(points)} {len(facets)} 0"]
    lines += [" ".join(map(str, p)) for p in points] + ["3 " + " ".join(map(str, f)) for f in facets]
    return "\n".join(lines) + "\n"


def diamond(x, y):
    corners = [(x + RADIUS, y), (x, y + RADIUS), (x - RADIUS, y), (x, y - RADIUS)]
    return "\n".join(f"{p} {q}" for p, q in corners) + "\n"


class Embedding(ProgramTest):
    def two_bodies(self, dimension, offset, layers=1, split=None, check=True):
        """Body a goes from x = -1 to 1 as b goes back; `offset` is how far apart in y they pass."""
        write, suffix, key = ((octahedron, "off", "surfaces"), (diamond, "dat", "curves"))[3 - dimension]
        for name, x, y in (("a", -1, 0), ("b", 1, offset)):
            (self.dir / f"{name}.{suffix}").write_text(write(x, y))
        bodies = ", ".join(f'{{ file = "{name}.{suffix}", patch = "{name}" }}' for name in "ab")
        zero = ", 0" * (dimension - 1)
        side = f'[side]\nsplit = "{split}"\n' if split else ""
        return self.case(f"dimension = {dimension}\n[initial]\n{key} = [ {bodies} ]\n{BOX[dimension]}\n"
                         f'[check]\nembedding = {"true" if check else "false"}\n'
                         f"[time]\nstart = 3\nend = 5\nlayers = {layers}\n{side}"
                         f'[motion.a]\nkind = "translation"\nvelocity = [1{zero}]\n'
                         f'[motion.b]\nkind = "translation"\nvelocity = [-1{zero}]\n')

    def test_bodies_that_change_places_within_a_layer_are_found_with_cells_patches_and_time(self):
        for dimension in (2, 3):
            with self.subTest(dimension):
                out, report = self.build(self.two_bodies(dimension, OFFSET, check=False), out=f"through{dimension}")
                self.assertIsNone(report["slabs"][0]["embedding"])
                self.assertFalse(report["settings"]["check_embedding"])
                hull = out / "slab_0000.vtu"
                left_out = slabhull("check", hull, "--no-embedding", "--json")
                self.assertEqual(left_out.code, 0)  # every level is sound
                self.assertIn("--no-embedding", " ".join(json.loads(left_out.out)["skipped"]))
                result = slabhull("check", hull, "--json")
                self.assertEqual(result.code, 1, result.err)
                document = json.loads(result.out)
                self.assertEqual(set(document["defects"]), {"self-crossing"})
                self.assertTrue(document["embedding"]["caps_proven"])
                self.assertEqual(document["embedding"]["crossings"], document["defects"]["self-crossing"])
                for finding in document["findings"]:
                    self.check_text(finding)

    def test_build_refuses_bodies_that_change_places_within_a_layer(self):
        for dimension in (2, 3):
            with self.subTest(dimension):
                self.refused(self.two_bodies(dimension, OFFSET), 4, "crosses itself", "patch a", "patch b", "meet at t = ")

    def test_build_warns_where_nothing_is_proven(self):
        result = slabhull("build", self.two_bodies(2, 0.9, check=False), "--out", self.dir / "out", "--quiet")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("check.embedding is false", result.err)

    def test_a_half_turn_in_one_layer_is_refused_soon(self):
        case = self.case('[initial]\nexperiment = "ellipsoid"\n[time]\nlayers = 1\n[motion.body]\nkind = "rotation"\n'
                         'axis = [0, 0, 1]\ncentre = [0, 0, 0]\nrate = 3.14159265\n')
        self.refused(case, 4, "crosses itself", "patch body", "more")

    def check_text(self, finding):
        """Cells of both bodies by number, meeting where and when both bodies' surfaces are."""
        text = finding["text"]
        cells = re.findall(r"cell (\d+) \(patch ([ab]), t = [345]", text)
        self.assertEqual([("cell", int(number)) for number, _ in cells],
                         [(e["kind"], e["number"]) for e in finding["entities"]])
        self.assertEqual({patch for _, patch in cells}, {"a", "b"})
        meeting = re.search(r"meet at t = (\S+) near \((.*)\)$", text)
        time, place = float(meeting[1]), [float(x) for x in meeting[2].split(", ")]
        for x, y in ((time - 4, 0), (4 - time, OFFSET)):
            off_centre = abs(place[0] - x) + abs(place[1] - y) + sum(map(abs, place[2:]))
            self.assertAlmostEqual(off_centre, RADIUS, delta=1e-4)

    @harness.long
    def test_bodies_that_pass_each_other_are_not_blamed(self):
        for dimension, splits in ((2, ("centre", "diagonal")), (3, ("C", "E"))):
            for split in splits:
                for layers in (1, 3):
                    with self.subTest((split, layers)):
                        out, _ = self.build(self.two_bodies(dimension, 0.9, layers, split), out=f"{split}{layers}")
                        for file in ("slab_0000.vtu", "slab_0000.msh"):
                            self.sound(out / file)

    def sound(self, hull):
        result = slabhull("check", hull, "--embedding", "--json", "--no-betti")
        self.assertEqual(result.code, 0, result.out + result.err)
        embedding = json.loads(result.out)["embedding"]
        self.assertEqual(embedding["crossings"], 0)
        self.assertTrue(embedding["caps_proven"])
        self.assertGreater(embedding["stars"], 0)
        self.assertLess(embedding["tested_pairs"], 10 * embedding["tested_cells"])

    def test_the_report_does_not_depend_on_the_number_of_threads(self):
        out, _ = self.build(self.two_bodies(3, OFFSET, check=False))
        reports = {slabhull("check", out / "slab_0000.vtu", "--embedding", "--json", "--threads", n).out
                   for n in (1, 2, 7)}
        self.assertEqual(len(reports), 1)

    @harness.long
    def test_the_examples_are_embedded(self):
        for name, *files in (("room.toml", "room.msh"), ("airfoil.toml", "naca0012.dat")):
            for file in files:
                shutil.copy(ROOT / "examples" / file, self.dir)
            case = shutil.copy(ROOT / "examples" / name, self.dir)
            out, report = self.build(case, out=f"out_{name}")
            for slab in range(len(report["slabs"])):
                self.sound(out / f"slab_{slab:04}.vtu")

    def test_a_mesh_in_space_has_no_such_check(self):
        out, _ = self.build(self.two_bodies(2, 0.9))
        result = slabhull("check", out / "cap_0001.vtu", "--embedding")
        self.assertEqual(result.code, 2)
        self.assertIn("--embedding", result.err)


if __name__ == "__main__":
    harness.main()
