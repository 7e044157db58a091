# SPDX-License-Identifier: BSD-3-Clause
"""slabhull study: the experiments against exact measures and the paper's counts, as CSV, JSON and a page."""
import csv
import json
import math
import os
import resource
import shutil
import signal
import struct
import subprocess
import time
import unittest
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

import harness
from harness import ProgramTest, slabhull

USAGE, GEOMETRY, OUTPUT = 2, 4, 5
MEASURES = ("hull", "initial", "side", "terminating", "enclosed")
# The paper's tables: simplices and vertices of the levels that are built here.
PAPER = {("circle", 1): (2714, 1357), ("circle", 2): (5308, 2654), ("circle", 3): (10022, 5011),
         ("circle", 4): (20142, 10071), ("circle", 5): (38792, 19396),
         ("sphere", 1): (144431, 30813)}
SVG = "{http://www.w3.org/2000/svg}"


class StudyTest(ProgramTest):
    def study(self, *arguments, out="out"):
        result = slabhull("study", *arguments, "--out", self.dir / out)
        self.assertEqual(result.code, 0, result.err)
        with open(self.dir / out / "study.csv", newline="") as file:
            table = list(csv.DictReader(file))
        return table, json.loads((self.dir / out / "study.json").read_text()), result


class Tables(StudyTest):
    def test_levels_of_a_plane_case_have_the_papers_counts_and_errors_of_order_2(self):
        table, document, result = self.study("circle", "--levels", "1-5")
        self.assertEqual([(row["case"], int(row["level"])) for row in table], [("circle", n) for n in range(1, 6)])
        for row in table:
            cells, vertices = PAPER["circle", int(row["level"])]
            self.assertEqual((int(row["paper_cells"]), int(row["paper_vertices"])), (cells, vertices))
            self.assertAlmostEqual(int(row["cells"]) / cells, 1, delta=0.03)
            self.assertEqual(int(row["cells"]), 2 * int(row["vertices"]))
            self.assertEqual(int(row["side_cells"]), 4 * int(row["layers"]) * int(row["boundary_facets"]))
            self.assertAlmostEqual(float(row["hull_exact"]), 2 * (100 - math.pi) + 40 + 2 * math.pi, places=11)
            for name in MEASURES:
                error = float(row[f"{name}_measure"]) / float(row[f"{name}_exact"]) - 1
                self.assertAlmostEqual(float(row[f"{name}_error"]), error, delta=1e-15)
            self.assertGreater(float(row["side_smallest_angle"]), 0)
            self.assertGreaterEqual(float(row["caps_mean_aspect"]), 1)
        rates = document["rates"][0]
        for name in MEASURES:
            self.assertAlmostEqual(rates["order"][name], self.order_of(table, name), places=9)
            self.assertTrue(1.9 < rates["order"][name] < 2.2)
        self.assertIn("orders hull", result.out)

    @staticmethod
    def order_of(table, name):
        """The slope of log error over log N^(-1/2), the textbook's way."""
        x = [-math.log(int(row["cells"])) / 2 for row in table]
        y = [math.log(abs(float(row[f"{name}_error"]))) for row in table]
        mx, my = sum(x) / len(x), sum(y) / len(y)
        return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)

    def test_a_level_in_space_is_mostly_side_and_its_process_tells_time_and_memory(self):
        table, document, _ = self.study("sphere", "--levels", "1", "--hulls")
        row, cells = table[0], int(table[0]["cells"])
        self.assertEqual(row["split"], "E")
        self.assertAlmostEqual(cells / PAPER["sphere", 1][0], 1, delta=0.03)
        self.assertAlmostEqual(int(row["vertices"]) / PAPER["sphere", 1][1], 1, delta=0.03)
        self.assertGreater(int(row["side_cells"]) / cells, 0.8)
        self.assertEqual(int(row["side_cells"]), 14 * int(row["layers"]) * int(row["boundary_facets"]))
        self.assertEqual(int(row["centres"]), 5 * int(row["layers"]) * int(row["boundary_facets"]) // 2)
        self.assertGreater(int(row["peak_bytes"]), 64 * cells)  # cells and neighbours alone are 32 bytes, checked
        self.assertGreater(float(row["cpu_seconds"]), 0)
        full = document["rows"][0]
        self.assertEqual(sum(full["side"]["histogram"]), 6 * int(row["side_cells"]))
        self.assertIn("cap meshing", full["seconds"])
        self.assertIsNone(document["rates"][0]["order"]["hull"])  # one level has no rate
        checked = self.check(self.dir / "out/sphere-E-1.vtu")
        self.assertEqual(checked["counts"]["cells"], cells)
        for ours, theirs in (("hull", "hull"), ("side", "intermediate"), ("enclosed", "enclosed")):
            self.assertAlmostEqual(float(row[f"{ours}_measure"]) / checked["measure"][theirs], 1, delta=1e-12)

    def test_numbers_but_times_do_not_depend_on_threads(self):
        timed = ("seconds", "cpu_seconds", "peak_bytes", "mesher_peak_bytes")
        tables = [self.study("expanding-circle", "--levels", "2", "--threads", n, out=f"out{n}")[0] for n in (1, 2)]
        for table in tables:
            for name in timed:
                del table[0][name]
        self.assertEqual(tables[0], tables[1])


class Splits(StudyTest):
    def test_splits_side_by_side_share_boundary_and_caps(self):
        table, _, _ = self.study("circle", "--levels", "1", "--split", "all")
        self.assertEqual([row["split"] for row in table], ["centre", "diagonal"])
        self.assertEqual(table[0]["boundary_facets"], table[1]["boundary_facets"])
        self.assertEqual(int(table[0]["side_cells"]), 2 * int(table[1]["side_cells"]))
        self.assertEqual(int(table[1]["centres"]), 0)
        page = (self.dir / "out/study.html").read_text()
        self.assertIn("splits side by side", page)
        self.assertTrue((self.dir / "out/plots/split-angles-circle.svg").exists())


class Page(StudyTest):
    def page(self, *arguments):
        self.study(*arguments)
        return self.dir / "out/study.html"

    def test_the_page_is_well_formed_and_needs_nothing_else(self):
        text = self.page("circle", "--levels", "1-2").read_text()
        self.assertTrue(text.startswith("<!DOCTYPE html>"))
        tree = ElementTree.fromstring(text)
        tags = [element.tag.split("}")[1] for element in tree.iter()]
        for foreign in ("script", "link", "img", "iframe", "object"):
            self.assertNotIn(foreign, tags)
        for element in tree.iter():
            for name, value in element.attrib.items():
                self.assertNotIn(name, ("src", "href", "onload"))
                self.assertNotIn("http", value)
        self.assertNotIn("url(", text)
        self.assertNotIn("@import", text)

    def test_plots_and_tables_say_what_they_are(self):
        tree = ElementTree.parse(self.page("circle", "--levels", "1-2"))
        plots = list(tree.iter(f"{SVG}svg"))
        self.assertEqual(len(plots), 4)  # errors, angles, time, memory
        for plot in plots:
            self.assertEqual(plot.get("role"), "img")
            self.assertGreater(len(plot.get("aria-label")), 20)
            self.assertTrue(plot.find(f"{SVG}title").text)
        xhtml = "{http://www.w3.org/1999/xhtml}"
        for table in tree.iter(f"{xhtml}table"):
            self.assertTrue(table.find(f"{xhtml}caption").text)
            width = len(table.find(f"{xhtml}thead/{xhtml}tr"))
            for row in table.iter(f"{xhtml}tr"):
                self.assertEqual(len(row), width)
        style = "".join(element.text for element in tree.iter(f"{xhtml}style"))
        self.assertIn("prefers-color-scheme:dark", style)

    def test_every_point_of_the_errors_is_drawn_inside_the_frame(self):
        self.page("circle", "--levels", "1-2")
        svg = ElementTree.parse(self.dir / "out/plots/errors-circle-centre.svg").getroot()
        frame = next(r for r in svg.iter(f"{SVG}rect") if r.get("class") == "frame")
        left, top = float(frame.get("x")), float(frame.get("y"))
        right = left + float(frame.get("width"))
        marks = [c for c in svg.iter(f"{SVG}circle") if c.get("class") == "mark s0" and float(c.get("cx")) < right]
        self.assertEqual(len(marks), 2)  # of the first curve, a level each
        for mark in marks:
            self.assertTrue(left < float(mark.get("cx")))
            self.assertTrue(top < float(mark.get("cy")) < top + float(frame.get("height")))

    @unittest.skipIf(shutil.which("chromium") is None, "no chromium here")
    def test_chromium_draws_the_page(self):
        page = self.page("circle", "--levels", "1-2")
        shot = self.dir / "shot.png"
        subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
                        f"--user-data-dir={self.dir / 'chromium'}", "--window-size=1200,3000",
                        f"--screenshot={shot}", page.as_uri()], check=True, capture_output=True, timeout=300)
        colours = self.colours(shot.read_bytes())
        for wanted in ((0x00, 0x72, 0xb2), (0xc0, 0x4a, 0x00)):  # the first curves of the plots
            self.assertIn(wanted, colours)

    @staticmethod
    def colours(png):
        """The colours of an 8-bit PNG without interlacing."""
        width, height, depth, kind = struct.unpack(">IIBB", png[16:26])
        assert depth == 8 and kind in (2, 6)
        size = 3 if kind == 2 else 4
        data, at = b"", 8
        while at < len(png):
            length, name = struct.unpack(">I4s", png[at:at + 8])
            data += png[at + 8:at + 8 + length] if name == b"IDAT" else b""
            at += 12 + length
        raw, stride, seen = zlib.decompress(data), width * size, set()
        before = bytearray(stride)
        for y in range(height):
            line = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
            unfilter(raw[y * (stride + 1)], line, before, size)
            seen.update(zip(line[0::size], line[1::size], line[2::size]))
            before = line
        return seen


def unfilter(kind, line, before, size):
    if kind == 0:
        return
    for i in range(len(line)):
        a = line[i - size] if i >= size else 0
        b, c = before[i], before[i - size] if i >= size else 0
        if kind == 4:
            p = a + b - c
            distances = (abs(p - a), abs(p - b), abs(p - c))
            guess = (a, b, c)[distances.index(min(distances))]
        else:
            guess = {1: a, 2: b, 3: (a + b) // 2}[kind]
        line[i] = (line[i] + guess) & 255


class Levels(ProgramTest):
    """Each is built by a process of its own, which fails alone."""

    def study(self, *arguments, **how):
        command = [harness.PROGRAM, "study", *arguments, "--out", str(self.dir / "out")]
        return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **how)

    def test_a_level_that_cannot_be_written_is_named_with_the_cause_and_its_exit_code(self):
        (self.dir / "out/circle-centre-2.vtu").mkdir(parents=True)
        result = slabhull("study", "circle", "--levels", "1-2", "--hulls", "--out", self.dir / "out")
        self.assertEqual(result.code, OUTPUT)
        self.assertIn("circle, level 2, split centre: ", result.err)
        self.assertIn("circle-centre-2.vtu", result.err)
        self.assertTrue((self.dir / "out/study.csv").exists())  # with level 1

    def test_a_file_size_limit_is_a_message_there_too(self):
        study = self.study("circle", "--levels", "4", "--hulls",
                           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000)))
        _, messages = study.communicate(timeout=600)
        self.assertEqual(study.returncode, OUTPUT, messages)
        self.assertIn("circle, level 4, split centre: ", messages)

    def test_a_process_that_is_killed_is_named_with_the_signal(self):
        study = self.study("sphere", "--levels", "6")
        children = Path(f"/proc/{study.pid}/task/{study.pid}/children")
        while study.poll() is None and not children.read_text():
            time.sleep(0.01)
        os.kill(int(children.read_text().split()[0]), signal.SIGKILL)
        _, messages = study.communicate(timeout=600)
        self.assertEqual(study.returncode, GEOMETRY, messages)
        self.assertIn("sphere, level 6, split E: its process was ended by signal 9", messages)


class Refusals(ProgramTest):
    def fails(self, code, word, *arguments):
        result = slabhull("study", *arguments)
        self.assertEqual(result.code, code, result.out + result.err)
        self.assertIn(word, result.err)
        self.assertFalse((self.dir / "out").exists())

    def test_bad_arguments_are_wrong_usage_and_leave_nothing_behind(self):
        out = ("--out", self.dir / "out")
        self.fails(USAGE, "tandem-ellipsoids", "square", *out)
        self.fails(USAGE, "from 1 to 8", "sphere", "--levels", "9", *out)
        self.fails(USAGE, "from 1 to 8", "sphere", "--levels", "7-9", *out)
        for levels in ("0", "x", "2-1", "1-", "-3", "1,2"):
            self.fails(USAGE, "--levels", "circle", f"--levels={levels}", *out)
        self.fails(USAGE, "centre", "circle", "--split", "A", *out)
        self.fails(USAGE, "A", "sphere", "--split", "C,,E", *out)
        self.fails(USAGE, "--out", "circle")
        self.fails(USAGE, "--threads", "circle", "--threads", "-1", *out)
        self.fails(USAGE, "from 1 to", "all", "--levels", "10-12", *out)

    def test_an_output_directory_that_cannot_be_made(self):
        (self.dir / "file").write_text("")
        self.fails(OUTPUT, "file", "circle", "--levels", "1", "--out", self.dir / "file" / "below")


if __name__ == "__main__":
    harness.main()
