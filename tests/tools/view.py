# SPDX-License-Identifier: BSD-3-Clause
"""`slabhull view`: the page in Chromium. Its sections against `slabhull slice`, pictures, keys, picking, thinning; what is
refused, and how."""
import base64
import json
import math
import os
import tempfile
import unittest
from pathlib import Path

import harness
from browser import CHROMIUM, Browser
from harness import ROOT, SPHERE, ProgramTest, slabhull

CIRCLE = '[initial]\nexperiment = "expanding-circle"\nlevel = 1\n[time]\nslabs = 2\n'
FILLED = SPHERE + '[side]\nsplit = "A"\n[cap]\nreuse = "move"\n[fill]\nformats = ["h5"]\n'
PICTURES = ROOT / "tests/data/view"
LEFT_OUT = "has no three.js" in slabhull("view", "x", "--out", "x.html").err
needs_three = unittest.skipIf(LEFT_OUT, "left out of this build: three.js")
needs_browser = unittest.skipIf(CHROMIUM is None, "no chromium here")

# The picture of the canvas in small, as numbers and as a PNG.
SMALL = """
    slabhull.draw();
    const small = document.createElement("canvas");
    [small.width, small.height] = [60, 42];
    const pen = small.getContext("2d");
    pen.drawImage(document.getElementById("canvas"), 0, 0, 60, 42);
    const pixels = [...pen.getImageData(0, 0, 60, 42).data];
    return {pixels, png: small.toDataURL("image/png").split(",")[1]};
"""
PIXELS_OF = """
    const image = new Image();
    image.src = "data:image/png;base64," + PNG;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [60, 42];
    const pen = canvas.getContext("2d");
    pen.drawImage(image, 0, 0);
    return [...pen.getImageData(0, 0, 60, 42).data];
"""


class PageTest(ProgramTest):
    def view(self, *files, options=()):
        """Makes a page, which must succeed; returns its path and what was said on stderr."""
        page = self.dir / "page.html"
        result = slabhull("view", *files, "--out", page, *options)
        self.assertEqual(result.code, 0, result.err)
        return page, result.err


@needs_three
@needs_browser
class PageInBrowser(PageTest):
    @classmethod
    def setUpClass(cls):
        profile = tempfile.TemporaryDirectory(prefix="slabhull-chromium-", ignore_cleanup_errors=True)
        cls.addClassCleanup(profile.cleanup)
        cls.browser = Browser(profile.name)
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        super().setUp()
        self.browser.messages.clear()
        self.browser.requests.clear()
        self.browser.prefer("light")
        self.browser.size(1280, 800)

    def tearDown(self):
        self.assertEqual(self.browser.messages, [])
        for address in self.browser.requests:
            self.assertTrue(address.startswith(("file:", "data:")), address)

    def open(self, *files, options=()):
        page, said = self.view(*files, options=options)
        self.browser.open(page)
        return said

    def section(self, time):
        return self.browser.run(f"return {{...slabhull.setTime({time!r}), inside: slabhull.inside()}}")

    def slices(self, files, times):
        result = slabhull("slice", *files, "--times", ",".join(map(repr, times)), "--out", self.dir / "cut", "--json")
        self.assertEqual(result.code, 0, result.err)
        return json.loads(result.out)["sections"]

    def same_sections(self, files, times):
        for cut in self.slices(files, times):
            with self.subTest(time=cut["time"]):
                seen = self.section(cut["time"])
                self.assertEqual(seen["facets"], cut["counts"]["facets"])
                self.near(seen["measure"], cut["measure"]["boundary"])
                self.near(seen["enclosed"], cut["measure"]["enclosed"])
                for measure, patch in zip(seen["patches"], cut["patches"], strict=True):
                    self.near(measure, patch["measure"])

    def near(self, a, b):
        self.assertTrue(math.isclose(a, b, rel_tol=1e-6), f"{a} for {b}")

    def test_a_series_in_the_plane_has_the_sections_of_slice(self):
        out, _ = self.build(self.case(CIRCLE))
        self.open(out / "slabs.pvd")
        self.same_sections([out / "slab_0000.vtu", out / "slab_0001.vtu"], [0.0, 0.1, 1 / 3, 0.5, 0.77, 1.0])
        self.near(self.section(0.5)["inside"]["measure"], self.section(0.5)["enclosed"])  # the cap's cells

    def test_hulls_in_space_have_the_sections_of_slice(self):
        for split in "ACE":
            with self.subTest(split=split):
                out, _ = self.build(self.case(SPHERE + f'[side]\nsplit = "{split}"\n'), out=split)
                self.open(out / "slab_0000.vtu")
                self.same_sections([out / "slab_0000.vtu"], [0.0, 0.2, 0.25, 0.5, 0.9, 1.0])
                self.near(self.section(1)["inside"]["measure"], self.section(1)["enclosed"])

    @harness.needs_formats("xdmf")
    def test_a_filling_has_the_inside_of_slice(self):
        out, _ = self.build(self.case(FILLED))
        self.open(out / "fill_0000.h5")
        for cut in self.slices([out / "fill_0000.h5"], [0.0, 0.2, 0.5, 1.0]):
            seen = self.section(cut["time"])
            self.near(seen["inside"]["measure"], cut["measure"]["domain"])
            self.near(seen["enclosed"], cut["measure"]["domain"])

    def test_a_filling_in_the_plane_may_be_vtu(self):
        out, _ = self.build(self.case(CIRCLE + '[cap]\nreuse = "move"\n[fill]\nformats = ["vtu"]\n'))
        self.open(out / "fill_0000.vtu", out / "fill_0001.vtu")
        for cut in self.slices([out / "slab_0000.vtu", out / "slab_0001.vtu"], [0.1, 0.5, 0.8]):
            seen = self.section(cut["time"])
            self.near(seen["measure"], cut["measure"]["boundary"])
            self.near(seen["inside"]["measure"], cut["measure"]["enclosed"])

    def test_a_large_hull_is_thinned_to_levels_that_are_exact_and_says_so(self):
        out, _ = self.build(self.case(SPHERE.replace("layers = 2", "layers = 8")))
        said = self.open(out / "slab_0000.vtu", options=["--most-cells", 20000])
        self.assertIn("thinned from", said)
        self.assertEqual(self.browser.run("return slabhull.head.notes.length"), 1)
        self.assertIn("thinned from", self.browser.run("return document.getElementById('notes').textContent"))
        cells = self.browser.run("return slabhull.head.slabs[0].side[1]")
        self.assertTrue(0 < cells <= 20000, cells)
        self.same_sections([out / "slab_0000.vtu"], [0.0, 1.0])
        between, exact = self.section(0.5), self.slices([out / "slab_0000.vtu"], [0.5])[0]["measure"]
        self.assertAlmostEqual(between["enclosed"] / exact["enclosed"], 1, delta=1e-3)

    def test_the_picture_is_as_it_was(self):
        circle, _ = self.build(self.case(CIRCLE), out="circle")
        sphere, _ = self.build(self.case(SPHERE), out="sphere")
        for name, file, script in (("plane", circle / "slabs.pvd", "slabhull.setTime(0.3);"),
                                   ("space", sphere / "slab_0000.vtu", "slabhull.setTime(0.3);"),
                                   ("clipped", sphere / "slab_0000.vtu",
                                    "slabhull.set('clip', true); slabhull.setTime(1);"),
                                   ("speed", sphere / "slab_0000.vtu",
                                    "slabhull.setColour('speed'); slabhull.setTheme('dark');")):
            with self.subTest(picture=name):
                self.open(file)
                self.browser.settle()
                self.compare(name, self.browser.run(script + SMALL))

    def compare(self, name, small):
        """With the picture in the repository; SLABHULL_NEW_PICTURES makes it anew, to be looked at."""
        path = PICTURES / f"{name}.png"
        if "SLABHULL_NEW_PICTURES" in os.environ:
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(base64.b64decode(small["png"]))
        png = base64.b64encode(path.read_bytes()).decode()
        wanted = self.browser.run(PIXELS_OF.replace("PNG", json.dumps(png)))
        far = sum(abs(a - b) > 24 for a, b in zip(small["pixels"], wanted, strict=True)) / len(wanted)
        self.assertLess(far, 0.02)
        self.assertGreater(len(set(zip(*[iter(small["pixels"])] * 4))), 10)  # not blank

    def test_keys_and_the_wish_for_dark_are_followed(self):
        out, _ = self.build(self.case(CIRCLE))
        self.browser.prefer("dark")
        self.open(out / "slabs.pvd")
        theme = "return document.documentElement.dataset.theme"
        self.assertEqual(self.browser.run(theme), "dark")
        self.browser.press("l")
        self.assertEqual(self.browser.run(theme), "light")
        time = "return Number(document.getElementById('slider').value)"
        self.browser.press("End")
        self.assertEqual(self.browser.run(time), 1)
        self.browser.press("ArrowLeft")
        level = self.browser.run(time)
        self.assertTrue(0.5 < level < 1)
        self.browser.press("Home")
        self.browser.press(" ")
        self.browser.run("await new Promise(go => setTimeout(go, 400))")
        self.browser.press(" ")
        self.assertTrue(0 < self.browser.run(time) < 1)
        self.browser.press("c")
        legend = "return document.getElementById('speed_most').textContent"
        self.assertAlmostEqual(float(self.browser.run(legend)), 0.25, delta=0.002)  # R(t) = 1 + 0.25 t, of a polygon

    def test_clicks_and_taps_pick_cells(self):
        out, _ = self.build(self.case(SPHERE))
        self.open(out / "slab_0000.vtu")
        self.browser.settle()
        self.browser.click(500, 400)  # the middle of the picture
        self.told_of("body")
        self.browser.size(390, 844, mobile=True)
        self.open(out / "slab_0000.vtu")
        self.browser.settle()
        self.browser.tap(195, 423)
        self.told_of("body")

    def told_of(self, patch):
        self.assertEqual(self.browser.run("return document.getElementById('picked_name').textContent"), patch)
        rows = self.browser.run("return [...document.querySelectorAll('#picked tr')].map(row => "
                                "[...row.children].map(cell => cell.textContent))")
        self.assertEqual(rows[0], ["vertex id", "track", "t"])
        self.assertEqual(len(rows), 5)
        self.assertTrue(all(int(row[0]) >= 0 for row in rows[1:]))


@needs_three
class Files(PageTest):
    def refused(self, code, *arguments, words=()):
        result = slabhull("view", *arguments)
        self.assertEqual(result.code, code, result.out + result.err)
        for word in words:
            self.assertIn(word, result.err)
        self.assertEqual(list(self.dir.glob("*.html*")), [])

    def test_what_is_no_hull_is_refused(self):
        out, _ = self.build(self.case(CIRCLE))
        page = self.dir / "page.html"
        (self.dir / "bad.pvd").write_text("<VTKFile>")
        (self.dir / "empty.pvd").write_text("<VTKFile><Collection></Collection></VTKFile>")
        (self.dir / "lost.pvd").write_text(
            '<VTKFile><Collection><DataSet timestep="0" file="lost.vtu"/></Collection></VTKFile>')
        (self.dir / "when.pvd").write_text(
            '<VTKFile><Collection><DataSet timestep="x" file="lost.vtu"/></Collection></VTKFile>')
        self.refused(3, self.dir / "none.vtu", "--out", page, words=["none.vtu"])
        self.refused(3, out / "cap_0001.vtu", "--out", page, words=["neither the hull nor a filling"])
        self.refused(3, out / "caps.pvd", "--out", page, words=["cap_0001.vtu"])
        self.refused(3, self.dir / "bad.pvd", "--out", page, words=["no PVD file"])
        self.refused(3, self.dir / "empty.pvd", "--out", page, words=["no files"])
        self.refused(3, self.dir / "lost.pvd", "--out", page, words=["lost.vtu"])
        self.refused(3, self.dir / "when.pvd", "--out", page, words=["timestep"])
        self.refused(2, out / "slabs.pvd", "--out", out / "slab_0000.vtu", words=[".html"])
        self.refused(2, out / "slabs.pvd", words=["--out"])

    def test_hulls_of_two_dimensions_make_no_page(self):
        circle, _ = self.build(self.case(CIRCLE), out="circle")
        sphere, _ = self.build(self.case(SPHERE), out="sphere")
        self.refused(2, circle / "slab_0000.vtu", sphere / "slab_0000.vtu", "--out", self.dir / "page.html",
                     words=["2D+t", "3D+t"])

    def test_a_page_that_cannot_be_written_leaves_what_was_there(self):
        out, _ = self.build(self.case(CIRCLE))
        (self.dir / "file").write_text("kept")
        result = slabhull("view", out / "slabs.pvd", "--out", self.dir / "file" / "page.html")
        self.assertEqual(result.code, 5, result.err)
        self.assertEqual((self.dir / "file").read_text(), "kept")

    def test_names_cannot_write_into_the_page(self):
        out, _ = self.build(self.case(CIRCLE))
        odd = self.dir / "<b>&<script>"
        odd.mkdir()
        (out / "slab_0000.vtu").rename(odd / "a.vtu")
        page, _ = self.view(odd / "a.vtu")
        self.assertNotIn("<b>&<script>", page.read_text())

    def test_slabs_out_of_order_or_twice_are_refused(self):
        out, _ = self.build(self.case(CIRCLE))
        first, second = out / "slab_0000.vtu", out / "slab_0001.vtu"
        for files in ((second, first), (first, first), (first, second, first)):
            result = slabhull("view", *files, "--out", self.dir / "page.html")
            self.assertEqual(result.code, 2, result.err)
            self.assertIn("give slabs in the order of their times, each once", result.err)
            self.assertFalse((self.dir / "page.html").exists())

    def test_the_same_hull_makes_the_same_page_on_any_number_of_threads(self):
        out, _ = self.build(self.case(SPHERE))
        pages = [self.view(out / "slabs.pvd", options=["--threads", threads])[0].read_bytes() for threads in (1, 2)]
        self.assertEqual(pages[0], pages[1])


if __name__ == "__main__":
    harness.main()
