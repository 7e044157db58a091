#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Caps meshed in blocks, and by each of the meshers, from the case file to the report."""
import unittest

from harness import ProgramTest, slabhull

SPHERE = """
[initial]
experiment = "sphere"
level = 1
[cap]
size = 2
"""
USAGE, GEOMETRY = 2, 4


class Caps(ProgramTest):
    def test_blocks_are_the_same_on_one_thread_and_on_two(self):
        case = self.case(SPHERE + "blocks = 3\n")
        written = []
        for threads in ("1", "2"):
            out, report = self.build(case, "--threads", threads, out=threads)
            self.assertEqual(report["slabs"][0]["cap"], {"made": "meshed", "blocks": 3})
            self.assertEqual(report["settings"]["cap_blocks"], 3)
            written.append([(out / name).read_bytes() for name in ("slab_0000.vtu", "cap_0001.vtu")])
        self.assertEqual(*written)
        self.check(self.dir / "1" / "slab_0000.vtu")

    def test_one_block_by_default(self):
        _, report = self.build(self.case(SPHERE))
        self.assertEqual(report["slabs"][0]["cap"]["blocks"], 1)
        self.assertIsNone(report["settings"]["cap_blocks"])

    def test_hxt_or_a_word_about_its_absence(self):
        case = self.case(SPHERE + 'mesher = "hxt"\n')
        result = slabhull("build", case, "--out", self.dir / "out", "--quiet")
        if result.code == 0:
            self.check(self.dir / "out" / "slab_0000.vtu")
        else:
            self.assertEqual(result.code, USAGE, result.err)
            self.assertIn("SLABHULL_GMSH", result.err)
            self.assertIn("cap.mesher", result.err)

    def test_a_bound_on_quality_that_no_mesh_meets_ends_with_advice(self):
        result = slabhull("build", self.case(SPHERE + "quality = 1.0\n"), "--out", self.dir / "out", "--quiet")
        self.assertEqual(result.code, GEOMETRY, result.err)
        self.assertIn("comes to no end with a radius-edge bound of 1: give a larger one (cap.quality)", result.err)

    def test_numbers_of_blocks_and_meshers_that_there_are_not(self):
        for text, word in [("blocks = 0", "cap.blocks"), ("blocks = 4097", "cap.blocks"),
                           ("blocks = 1.5", "cap.blocks"), ("quality = 1e9", "cap.quality"),
                           ('mesher = "hxt"\nquality = 1.4', "cap."), ('mesher = "cdt"', "cap.mesher")]:
            with self.subTest(text):
                self.refused(self.case(SPHERE + text + "\n"), USAGE, word, "line")


if __name__ == "__main__":
    unittest.main()
