#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The test of pages is tested: each kind of fault is planted in a page, and must be found; so are links that lead nowhere."""
import importlib.util
import os
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import pages  # noqa: E402
from blocks import PageError, read_blocks  # noqa: E402

CASE = '''dimension = 2
[initial]
curves = [ { file = "examples/naca0012.dat", patch = "airfoil" } ]
box = { min = [-1, -1], max = [2, 1], size = 0.5 }
'''


def load(name, path):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Page(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="slabhull-test-")
        self.addCleanup(scratch.cleanup)
        self.dir = Path(scratch.name)

    def counts(self, text):
        page = self.dir / "page.md"
        page.write_text(text)
        self.told = []
        run, failed, left_out, skipped = pages.run_page(page, self.told.append)
        return run, failed, len(left_out), len(skipped)

    def passes(self, text, run=1):
        self.assertEqual(self.counts(text), (run, 0, 0, 0), self.told)

    def fails(self, text, *words):
        self.assertEqual(self.counts(text)[1], 1, text)
        for word in words:
            self.assertIn(word, self.told[0])


class Blocks(Page):
    def test_commands(self):
        self.passes("```sh\nslabhull --version\n```\n")
        self.fails("\n```sh\nfalse\necho on\n```\n", "page.md:3", "exit code 1")
        self.fails("```sh\nfalse | true\n```\n")
        self.fails("```sh\necho $NOBODY_HAS_SET_THIS\n```\n", "unbound")
        self.fails("```sh\nslabhull info missing.vtu\n```\n", "exit code 3", "missing.vtu")
        self.passes("<!-- exit: 3 -->\n```sh\nslabhull info missing.vtu\n```\n")
        self.fails("<!-- exit: 4 -->\n```sh\nslabhull info missing.vtu\n```\n")

    def test_console(self):
        self.passes("```console\n$ echo one two\none two\n```\n")
        self.fails("```console\n$ echo one two\none three\n```\n", "one three")

    def test_files_stay_for_what_comes(self):
        self.passes("<!-- file: a/b.txt -->\n```text\nhello\n```\n\n```sh\ncp a/b.txt c.txt\n```\n\n"
                    "```sh\ngrep hello c.txt\n```\n", 3)

    def test_output(self):
        block = "```sh\nprintf 'in 3.5 s\\nx = 1.25\\nend\\n'\n```\n\n<!-- output -->\n```text\n{}\n```\n"
        self.passes(block.format("in 9 s\n...\nx = 1..."), 2)
        self.fails(block.format("x = 1.26"), "not:", "x = 1.26")
        self.fails(block.format("end\nx = 1.25"))
        self.fails("<!-- output -->\n```text\nx\n```\n", "No block before")

    def test_python(self):
        self.passes("```python\na = 1\n```\n\n```python\nprint(a + 1)\n```\n\n<!-- output -->\n```text\n2\n```\n", 3)
        self.passes("<!-- first, python:\na = 1\n-->\n```python\nassert a == 1\n```\n", 2)
        self.fails("```python\nimport slabhull\nslabhull.no_such_function()\n```\n", "no_such_function", "line 3")
        self.fails("```python\nraise SystemExit(0)\n```\n")

    def test_cases(self):
        self.passes(f"```toml\n{CASE}```\n")
        self.fails(f"```toml\n{CASE}speed = 3\n```\n", "unknown key")
        self.fails("```toml\n" + CASE.replace("naca0012", "nobody") + "```\n", "nobody.dat")
        self.fails("```toml\nthis is no toml\n```\n", "no TOML")

    def test_fragments(self):
        base = f"<!-- file: base.toml -->\n```toml\n{CASE}```\n\n"
        self.passes(base + "<!-- in: base.toml -->\n```toml\n[time]\nslabs = 2\n```\n", 2)
        self.passes("<!-- in: examples/airfoil.toml -->\n```toml\n[time]\nlayers = 3\n```\n")
        self.fails(base + "<!-- in: base.toml -->\n```toml\n[time]\nslab = 2\n```\n", "time.slab")
        self.fails(base + "```toml\n[time]\nslabs = 2\n```\n", "of which case")
        self.fails("<!-- in: nobody.toml -->\n```toml\n[time]\nslabs = 2\n```\n", "no case nobody.toml")
        turn = '[motion.airfoil]\nkind = "translation"\nvelocity = [0.1, 0]\n'
        self.fails(f"<!-- in: examples/airfoil.toml -->\n```toml\n{turn}```\n", "motion.airfoil.constants")
        self.passes(f"<!-- instead: examples/airfoil.toml -->\n```toml\n{turn}```\n")

    def test_cpp(self):
        code = "#include <slabhull/core/version.h>\nconst int major = SLABHULL_VERSION_MAJOR;\n(void)major;\n"
        self.passes(f"```cpp\n{code}```\n")
        self.fails("```cpp\n" + code.replace("MAJOR", "NOBODY") + "```\n", "SLABHULL_VERSION_NOBODY")
        self.fails("```cpp\nint main() {}\n```\n", "file name")

    def test_what_is_left_out_is_counted(self):
        self.assertEqual(self.counts("<!-- not run: no reason -->\n```sh\nfalse\n```\n"), (0, 0, 1, 0))
        self.assertEqual(self.counts("<!-- page not run: a test -->\n```sh\nfalse\n```\n\n```text\nx\n```\n"), (0, 0, 1, 0))
        pages.NEEDS["nothing there"] = lambda: False
        self.assertEqual(self.counts("<!-- needs: nothing there -->\n```sh\nfalse\n```\n"), (0, 0, 0, 1))
        self.fails("<!-- needs: the moon -->\n```sh\ntrue\n```\n", "the moon")

    def test_pages_that_hide_code(self):
        for text in ("Text\n\n    slabhull build x.toml\n", "```\nslabhull build x.toml\n```\n", "```sh\nno end\n",
                     "<!-- not run: -->\n```sh\nfalse\n```\n", "<!-- not rum: why -->\n```sh\nfalse\n```\n",
                     "<!-- not run: why -->\n\nText\n\n```sh\nfalse\n```\n", "<!-- never ends\n"):
            with self.subTest(text):
                self.assertRaises(PageError, read_blocks, text)
                self.fails(text)
        self.fails("```fortran\nend\n```\n", "fortran")
        self.assertEqual(len(read_blocks("1. List\n\n    more of it\n\n```{toctree}\nx\n```\n")[0]), 0)

    def test_every_page_is_in_a_group(self):
        named = [page for group in ("start", "how-to", "reference") for page in pages.pages_of(group)]
        there = {pages.ROOT / "README.md", *(pages.ROOT / "docs").rglob("*.md")}
        self.assertEqual(len(named), len(set(named)))
        self.assertEqual(there - set(named), set())
        self.assertTrue(all(page.is_file() for page in named))


class Links(Page):
    def setUp(self):
        super().setUp()
        self.links = load("check_links", pages.ROOT / "docs/site/check_links.py")
        (self.dir / "b.html").write_text('<h1 id="there">b</h1>')

    def faults(self, html):
        (self.dir / "a.html").write_text(html)
        return self.links.find_faults(self.dir)

    def test_good_ones(self):
        _, count, faults, external = self.faults('<p id="x"><a href="b.html#there"><a href="#x"><a href="https://x.org/y#z">')
        self.assertEqual((count, faults, list(external)), (3, [], ["https://x.org/y"]))

    def test_planted_ones(self):
        for link in ("c.html", "b.html#nowhere", "#nowhere", "../outside.html"):
            self.assertEqual(len(self.faults(f'<a href="{link}">')[2]), 1, link)
        self.assertEqual(len(self.faults('<img src="c.png">')[2]), 1)


if __name__ == "__main__":
    os.environ.setdefault("SLABHULL_ROOT", str(pages.ROOT))
    unittest.main()
