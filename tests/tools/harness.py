# SPDX-License-Identifier: BSD-3-Clause
"""What the end-to-end tests share: running the program, scratch directories, case files, reading results."""
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["SLABHULL_PROGRAM"]
ROOT = Path(os.environ["SLABHULL_ROOT"])
SANITIZED = "SLABHULL_SANITIZED" in os.environ  # ten times slower: fewer rounds do there
LARGE = "SLABHULL_LARGE" in os.environ  # minutes, not seconds
long = unittest.skipIf(SANITIZED, "too long under sanitizers, and shorter tests run the same code")
longest = unittest.skipUnless(LARGE, "in the test of the same name and _longer")
SKIPPED = 77  # ctest's SKIP_RETURN_CODE

# Hulls of 6,000 triangles and 30,000 tetrahedra, for what does not depend on their size.
CIRCLE = '[initial]\nexperiment = "expanding-circle"\nlevel = 2\n'
SPHERE = '[initial]\nexperiment = "expanding-sphere"\nlevel = 1\n[time]\nlayers = 2\n'


class Result:
    def __init__(self, done):
        self.code, self.out, self.err = done.returncode, done.stdout, done.stderr


def slabhull(*arguments, timeout=600):
    """Runs the program; a crash (negative return code) is never what a test wants."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=timeout)
    assert done.returncode >= 0, f"killed by signal {-done.returncode}: {done.stderr}"
    return Result(done)


def find_left_out():
    """The formats that this build was configured without, by name, and their extensions."""
    rows = [line.split() for line in slabhull("convert", "--help").out.splitlines() if "(not in this build)" in line]
    return {row[0]: row[1:row.index("(not")] for row in rows}


LEFT_OUT = find_left_out()


def needs_formats(*names):
    """Skips a test, with the names, in a build that has not all of these formats."""
    missing = [name for name in names if name in LEFT_OUT]
    return unittest.skipIf(missing, f"left out of this build: {', '.join(missing)}")


class ProgramTest(unittest.TestCase):
    """A test with a scratch directory of its own."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="slabhull-test-")
        self.addCleanup(scratch.cleanup)
        self.dir = Path(scratch.name)

    def skip_if_left_out(self, file):
        """Skips the (sub)test when its file is of a format that this build has not."""
        for name, extensions in LEFT_OUT.items():
            if Path(file).suffix in extensions:
                self.skipTest(f"left out of this build: {name}")

    def case(self, text, name="case.toml"):
        path = self.dir / name
        path.write_text(text)
        return path

    def build(self, case, *options, out="out"):
        """Builds a case that must succeed; returns the directory and the report."""
        result = slabhull("build", case, "--out", self.dir / out, "--quiet", *options)
        self.assertEqual(result.code, 0, result.err)
        return self.dir / out, json.loads((self.dir / out / "report.json").read_text())

    def check(self, path):
        """Checks a file that must be sound; returns the JSON document."""
        result = slabhull("check", path, "--json")
        self.assertEqual(result.code, 0, result.out + result.err)
        return json.loads(result.out)

    def refused(self, case, code, *words):
        """The case must fail with this exit code, name all the words, and leave nothing behind."""
        result = slabhull("build", case, "--out", self.dir / "out")
        self.assertEqual(result.code, code, f"{result.out}{result.err}")
        for word in words:
            self.assertIn(word, result.err)
        left = [str(p) for p in (self.dir / "out").rglob("*") if p.is_file()] if (self.dir / "out").exists() else []
        self.assertEqual(left, [])
        return result


def main():
    program = unittest.main(exit=False)
    result = program.result
    if result.wasSuccessful() and result.testsRun > 0 and len(result.skipped) == result.testsRun:
        raise SystemExit(SKIPPED)
    raise SystemExit(0 if result.wasSuccessful() and result.testsRun > 0 else 1)
