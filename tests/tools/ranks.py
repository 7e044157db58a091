# SPDX-License-Identifier: BSD-3-Clause
"""`mpirun -n N slabhull build`: the bytes of one process that writes as many pieces, errors that all ranks end with, ranks that die."""
import json
import os
import shutil
import signal
import subprocess
import time
import unittest
from pathlib import Path

import harness
from harness import PROGRAM, ROOT, ProgramTest, Result, slabhull

MPIRUN = shutil.which("mpirun")
LAUNCH = [MPIRUN, "--oversubscribe", "--bind-to", "none", "-n"]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_orte_tmpdir_base": "/tmp"}


def mpirun(ranks, *arguments, timeout=120):
    done = subprocess.run([*LAUNCH, str(ranks), PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=timeout, env=ENVIRONMENT)
    return Result(done)


def have_mpi():
    """Whether there is an mpirun that starts this program, and it was built with MPI."""
    if MPIRUN is None:
        return False
    told = mpirun(1, "build", "/nowhere.toml")
    return "no MPI" not in told.err and "/nowhere.toml" in told.err


HAVE_MPI = have_mpi()

OUTPUT = '[output]\nformats = ["pvtu", "msh"]\n'


def sphere(split, level=1, more=""):
    return f"""[initial]
experiment = "expanding-sphere"
level = {level}
[time]
slabs = 2
layers = 2
[side]
split = "{split}"
{more}{OUTPUT}"""


def circle(split, more=""):
    return f"""[initial]
experiment = "expanding-circle"
level = 1
[time]
slabs = 2
[side]
split = "{split}"
{more}{OUTPUT}"""


def our_lines(text):
    return [line for line in text.splitlines() if line.startswith("slabhull:")]


@unittest.skipUnless(HAVE_MPI, "no mpirun here, or a build without MPI")
class RanksTest(ProgramTest):
    def in_ranks(self, ranks, case, *options, out="ranks"):
        result = mpirun(ranks, "build", case, "--out", self.dir / out, "--quiet", *options)
        self.assertEqual(result.code, 0, result.out + result.err)
        return self.dir / out

    def same_files(self, one, other):
        """All files but reports are the same, byte for byte."""
        names = sorted(path.name for path in one.iterdir())
        self.assertEqual(sorted(path.name for path in other.iterdir()), names)
        compared = 0
        for name in names:
            if name not in ("report.json", "slabs.jsonl", "march.state"):  # these have times
                self.assertEqual((one / name).read_bytes(), (other / name).read_bytes(), name)
                compared += 1
        self.assertGreater(compared, 4)

    def alone(self, text, ranks, out, blocks=False):
        pieces = text.replace("[output]\n", f"[output]\npieces = {ranks}\n")
        if blocks:
            pieces += f"[cap]\nblocks = {ranks}\n"
        case = self.case(pieces, name=f"{out}.toml")
        return self.build(case, out=out)[0]


class SameBytes(RanksTest):
    def test_in_space(self):
        # each split once, and each number of ranks
        for ranks, split in ((1, "C"), (2, "A"), (3, "B"), (4, "E"), (2, "D")):
            with self.subTest(ranks=ranks, split=split):
                text = sphere(split)
                whole = self.alone(text, ranks, f"alone-{split}", blocks=True)
                self.same_files(whole, self.in_ranks(ranks, self.case(text), out=f"ranks-{split}"))

    def test_in_the_plane(self):
        for ranks, split in ((1, "diagonal"), (2, "centre"), (4, "diagonal")):
            with self.subTest(ranks=ranks, split=split):
                text = circle(split)
                whole = self.alone(text, ranks, f"alone-{ranks}")
                self.same_files(whole, self.in_ranks(ranks, self.case(text), out=f"ranks-{ranks}"))

    def test_caps_that_are_moved(self):
        text = sphere("C", more='[cap]\nreuse = "move"\nblocks = 1\n')
        whole = self.alone(text, 3, "alone")
        self.same_files(whole, self.in_ranks(3, self.case(text)))

    def test_a_run_that_goes_on_with_another_number_of_ranks(self):
        text = sphere("C", more="[cap]\nblocks = 2\n")
        case = self.case(text)
        short = self.case(text.replace("[time]\n", "[time]\nend = 0.5\n").replace("slabs = 2", "slabs = 1"), name="short.toml")
        out = self.in_ranks(2, short)
        self.in_ranks(3, case, "--resume")
        report = json.loads((out / "report.json").read_text())
        self.assertEqual([slab["slab"] for slab in report["slabs"]], [0, 1])
        self.assertEqual(report["slabs"][1]["ranks"]["number"], 3)
        whole = self.alone(text, 3, "alone")
        for piece in range(3):
            name = f"slab_0001_{piece}.vtu"
            self.assertEqual((whole / name).read_bytes(), (out / name).read_bytes())


class Report(RanksTest):
    def test_tells_of_each_rank(self):
        out = self.in_ranks(2, self.case(circle("centre")))
        report = json.loads((out / "report.json").read_text())
        ranks = report["slabs"][0]["ranks"]
        self.assertEqual(ranks["number"], 2)
        self.assertLessEqual(abs(ranks["cells"][0] - ranks["cells"][1]), 1)
        self.assertEqual(len(ranks["peak_memory"]), 2)

    def test_one_rank_speaks(self):
        result = mpirun(3, "build", self.case(circle("centre")), "--out", self.dir / "out")
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual(len([line for line in result.out.splitlines() if "checked, in" in line]), 1)
        for piece in range(3):
            self.assertIn(f"slab_0000_{piece}.vtu", result.out)


class Refused(RanksTest):
    def refused_in_ranks(self, text, code, *words):
        result = mpirun(2, "build", self.case(text), "--out", self.dir / "out")
        self.assertEqual(result.code, code, result.out + result.err)
        lines = our_lines(result.err)
        self.assertEqual(len(lines), 1, result.err)
        for word in words:
            self.assertIn(word, lines[0])
        left = list((self.dir / "out").rglob("*")) if (self.dir / "out").exists() else []
        self.assertEqual(left, [])

    def test_what_ranks_cannot_do(self):
        self.refused_in_ranks(circle("centre").replace('"pvtu"', '"vtu"'), 2, "output.formats", "vtu")
        self.refused_in_ranks(circle("centre") + "pieces = 5\n", 2, "output.pieces", "2 ranks")
        self.refused_in_ranks(circle("centre", '[cap]\nreuse = "adapt"\n'), 2, "cap.reuse", "adapt")
        self.refused_in_ranks(circle("centre", '[cap]\nreuse = "move"\n[fill]\nformats = ["mfem"]\n'), 2, "[fill]")

    def test_a_case_file_that_is_not_there(self):
        result = mpirun(3, "build", self.dir / "none.toml")
        self.assertEqual(result.code, 3, result.err)
        self.assertEqual(len(our_lines(result.err)), 1, result.err)

    def test_other_subcommands(self):
        result = mpirun(2, "info", ROOT / "examples/room.msh")
        self.assertEqual(result.code, 2, result.out + result.err)
        self.assertEqual(len(our_lines(result.err)), 1, result.err)
        self.assertIn("build", our_lines(result.err)[0])


class Faults(RanksTest):
    def start(self, case, out):
        return subprocess.Popen([*LAUNCH, "3", PROGRAM, "build", str(case), "--out", str(out), "--quiet"],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)

    def ranks_of(self, run):
        """The processes of the ranks that a run has started."""
        found = []
        for entry in Path("/proc").iterdir():
            if entry.name.isdigit():
                try:
                    words = (entry / "stat").read_text().rsplit(")", 1)[1].split()
                    if int(words[1]) == run.pid and Path(os.readlink(entry / "exe")) == Path(PROGRAM).resolve():
                        found.append(int(entry.name))
                except (OSError, IndexError):
                    pass
        return sorted(found)

    def long_case(self):
        return self.case(sphere("C", level=1, more="[cap]\nblocks = 3\n").replace("slabs = 2", "slabs = 40"))

    def test_a_rank_that_is_killed_ends_the_run_which_goes_on(self):
        case = self.long_case()
        out = self.dir / "out"
        run = self.start(case, out)
        deadline = time.monotonic() + 60
        while not (out / "slab_0001.pvtu").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        ranks = self.ranks_of(run)
        self.assertEqual(len(ranks), 3)
        os.kill(ranks[1], signal.SIGKILL)
        killed = time.monotonic()
        _, told = run.communicate(timeout=60)
        self.assertLess(time.monotonic() - killed, 20)
        self.assertNotEqual(run.returncode, 0)
        self.assertLessEqual(len(our_lines(told)), 1, told)
        for index in out.glob("slab_*.pvtu"):  # what is there is whole
            for piece in range(3):
                self.assertTrue(index.with_name(f"{index.stem}_{piece}.vtu").exists())
        self.assertGreater(self.start_and_stop(case, out), 2)

    def start_and_stop(self, case, out):
        """Goes on until another slab is there; returns the number of slabs."""
        before = len(list(out.glob("slab_*.pvtu")))
        run = subprocess.Popen([*LAUNCH, "2", PROGRAM, "build", str(case), "--out", str(out), "--quiet", "--resume"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
        deadline = time.monotonic() + 60
        while len(list(out.glob("slab_*.pvtu"))) < before + 1 and time.monotonic() < deadline:
            time.sleep(0.02)
        run.send_signal(signal.SIGINT)
        _, told = run.communicate(timeout=60)
        self.assertLessEqual(len(our_lines(told)), 1, told)
        self.assertEqual(list(out.glob("*.part")), [])
        return len(list(out.glob("slab_*.pvtu")))


@unittest.skipIf(MPIRUN is None or HAVE_MPI, "for builds without MPI")
class WithoutMpi(ProgramTest):
    def test_is_refused(self):
        result = mpirun(2, "build", self.case(circle("centre")), "--out", self.dir / "out")
        self.assertEqual(result.code, 2)
        self.assertEqual(len(our_lines(result.err)), 1, result.err)


if __name__ == "__main__":
    harness.main()
