# SPDX-License-Identifier: BSD-3-Clause
"""`mpirun -n N slabhull build`: the bytes of one process that writes as many pieces, fillings, errors that all ranks end with, ranks that die."""
import json
import os
import shutil
import signal
import subprocess
import time
import unittest
from pathlib import Path
from random import Random

import harness
from harness import LARGE, PROGRAM, ROOT, ProgramTest, Result, needs_formats, slabhull

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
        # in all, each split once, and each number of ranks
        for ranks, split in [(3, "B"), (4, "E")] + ([(1, "C"), (2, "A"), (2, "D")] if LARGE else []):
            with self.subTest(ranks=ranks, split=split):
                text = sphere(split)
                whole = self.alone(text, ranks, f"alone-{split}", blocks=True)
                self.same_files(whole, self.in_ranks(ranks, self.case(text), out=f"ranks-{split}"))

    def test_in_the_plane(self):
        for ranks, split in ((2, "centre"), (4, "diagonal")):
            with self.subTest(ranks=ranks, split=split):
                text = circle(split)
                whole = self.alone(text, ranks, f"alone-{ranks}")
                self.same_files(whole, self.in_ranks(ranks, self.case(text), out=f"ranks-{ranks}"))

    def test_caps_that_are_moved(self):
        text = sphere("C", more='[cap]\nreuse = "move"\nblocks = 1\n')
        whole = self.alone(text, 3, "alone")
        self.same_files(whole, self.in_ranks(3, self.case(text)))

    def test_caps_that_are_moved_from_level_to_level(self):
        # After 90 degrees in one step, angles are too small. Of 5 ranks two have no layer.
        text = sphere("A", more='[cap]\nreuse = "move"\nreuse_angle = 0.5\nblocks = 1\n').replace("expanding-sphere", "ellipsoid")
        text = text.replace("slabs = 2\nlayers = 2", "slabs = 1\nlayers = 3\nend = 1")
        whole = self.alone(text, 5, "alone")
        out = self.in_ranks(5, self.case(text))
        self.same_files(whole, out)
        self.assertEqual(json.loads((out / "report.json").read_text())["slabs"][0]["cap"]["made"], "moved")


MOVED = '[cap]\nreuse = "move"\n'


def fill_table(formats, more=""):
    return f'[fill]\nformats = {json.dumps(formats)}\n{more}'


class Fill(RanksTest):
    """The first rank gathers each hull and fills it."""

    def fill_reports(self, out):
        """By slab, what the report tells of its filling, without the time that it took."""
        slabs = json.loads((out / "report.json").read_text())["slabs"]
        return [{key: value for key, value in slab.get("fill", {}).items() if key != "seconds"} for slab in slabs]

    def same_fillings(self, text, ranks, count, name="a"):
        """Builds alone and in ranks; `count` fillings come out. Returns the folder of the ranks."""
        whole = self.alone(text, ranks, f"alone-{name}-{ranks}")
        out = self.in_ranks(ranks, self.case(text), out=f"ranks-{name}-{ranks}")
        self.same_files(whole, out)
        self.assertEqual(self.fill_reports(whole), self.fill_reports(out))
        self.assertEqual(len(list(out.glob("fill_*"))), count)
        return out

    def test_in_the_plane(self):
        text = circle("centre", MOVED + fill_table(["mfem", "getfem", "vtu", "msh"]))
        for ranks in (1, 2, 3):
            with self.subTest(ranks=ranks):
                self.same_fillings(text, ranks, 8)

    def test_in_space(self):
        for ranks, split in [(2, "A"), (3, "C")] + ([(1, "B"), (4, "E")] if LARGE else []):
            with self.subTest(ranks=ranks, split=split):
                text = sphere(split, more=f"{MOVED}blocks = {ranks}\n" + fill_table(["mfem", "getfem"]))
                self.same_fillings(text.replace("layers = 2", "layers = 3"), ranks, 4, split)

    @needs_formats("h5")
    def test_hdf5(self):
        self.same_fillings(circle("diagonal", MOVED + fill_table(["h5"])), 2, 2)

    def test_by_tetgen(self):
        self.same_fillings(circle("centre", fill_table(["vtu"], 'method = "tetgen"\n')), 2, 2)

    def test_a_slab_meshed_anew_is_not_filled_and_one_rank_says_so(self):
        case = self.case(circle("centre", MOVED + "reuse_angle = 60\n" + fill_table(["mfem"])))
        alone = slabhull("build", case, "--out", self.dir / "alone", "--quiet")
        result = mpirun(2, "build", self.case(case.read_text()), "--out", self.dir / "out", "--quiet")
        self.assertEqual((alone.code, result.code), (0, 0), result.err)
        self.assertEqual(our_lines(result.err), our_lines(alone.err))
        self.assertIn("is not filled", result.err)
        self.assertEqual(list((self.dir / "out").glob("fill_*")), [])

    def test_simplices_that_would_be_inverted_end_the_run_on_all_ranks(self):
        text = sphere("A", more=MOVED + "blocks = 1\nreuse_angle = 0.1\n" + fill_table(["mfem"])).replace("layers = 2", "layers = 1")
        text = text.replace("expanding-sphere", "ellipsoid").replace("slabs = 2", "slabs = 1\nend = 0.4")  # turns by 36 degrees
        alone = slabhull("build", self.case(text), "--out", self.dir / "alone", "--quiet")
        self.assertEqual(alone.code, 4, alone.err)
        self.assertIn("simplices of the filling would be inside out", alone.err)
        result = mpirun(3, "build", self.case(text), "--out", self.dir / "out", "--quiet")
        self.assertEqual(result.code, 4, result.err)
        self.assertEqual(our_lines(result.err), our_lines(alone.err))
        self.assertEqual(list((self.dir / "out").iterdir()), [])

    def test_a_run_goes_on_in_another_number_of_ranks(self):
        text = circle("diagonal", MOVED + fill_table(["mfem", "vtu"]))
        whole = self.in_ranks(3, self.case(text), out="whole")
        out = self.in_ranks(2, self.case(text.replace("slabs = 2", "slabs = 1\nend = 0.5")), out="out")
        self.in_ranks(3, self.case(text), "--resume", out="out")
        for path in [*whole.glob("fill_*"), *whole.glob("slab_0001*"), *whole.glob("cap_*")]:
            self.assertEqual((out / path.name).read_bytes(), path.read_bytes(), path.name)
        self.assertEqual(self.fill_reports(out), self.fill_reports(whole))


class Report(RanksTest):
    def test_tells_of_each_rank_and_one_rank_speaks(self):
        out = self.dir / "out"
        result = mpirun(3, "build", self.case(circle("centre")), "--out", out)
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual(len([line for line in result.out.splitlines() if "checked, in" in line]), 1)
        for piece in range(3):
            self.assertIn(f"slab_0000_{piece}.vtu", result.out)
        ranks = json.loads((out / "report.json").read_text())["slabs"][0]["ranks"]
        self.assertEqual(ranks["number"], 3)
        self.assertLessEqual(max(ranks["cells"]) - min(ranks["cells"]), 1)
        self.assertEqual(len(ranks["peak_memory"]), 3)
        self.assertGreater(ranks["meetings"], 10)
        for sent, cells in zip(ranks["sent_bytes"], ranks["cells"]):
            self.assertTrue(0 < sent < 1000 * cells, f"{sent} bytes for {cells} cells")


class Refused(RanksTest):
    def refused_in_ranks(self, text, code, *words, ranks=2):
        result = mpirun(ranks, "build", self.case(text), "--out", self.dir / "out")
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

    def test_a_boundary_that_tangles(self):
        """In a level of a later rank, in the words of one process."""
        motion = '[motion.body]\nkind = "translation"\nvelocity = [5, 0]\n'
        text = circle("centre", motion).replace("slabs = 2", "slabs = 1\nlayers = 8")
        alone = slabhull("build", self.case(text), "--out", self.dir / "alone")
        self.assertIn("cross", alone.err)
        for ranks in (2, 3):
            result = mpirun(ranks, "build", self.case(text), "--out", self.dir / "out")
            self.assertEqual((result.code, our_lines(result.err)), (alone.code, our_lines(alone.err)))

    def test_a_case_file_that_is_not_there(self):
        result = mpirun(3, "build", self.dir / "none.toml")
        self.assertEqual(result.code, 3, result.err)
        self.assertEqual(len(our_lines(result.err)), 1, result.err)

    def test_the_message_comes_before_mpirun_ends_the_ranks(self):
        """Of many ranks, most of which end first, where it was lost in a run of five."""
        for _ in range(30 if LARGE else 4):
            self.refused_in_ranks(sphere("A").replace("expanding-sphere", "shrinking-sphere"), 2, "shrinking-sphere", ranks=12)

    def test_other_subcommands(self):
        result = mpirun(2, "info", ROOT / "examples/room.msh")
        self.assertEqual(result.code, 2, result.out + result.err)
        self.assertEqual(len(our_lines(result.err)), 1, result.err)
        self.assertIn("build", our_lines(result.err)[0])


class Faults(RanksTest):
    """One rank is killed, stops answering, or has no room on its disk."""

    def start(self, ranks, case, out, *options, **environment):
        command = [*LAUNCH, str(ranks), PROGRAM, "build", str(case), "--out", str(out), "--quiet", *options]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env={**ENVIRONMENT, **environment})
        self.addCleanup(self.end, run)
        return run

    @staticmethod
    def end(run):
        if run.poll() is None:
            run.kill()
        run.communicate()

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

    def wait_for_ranks(self, run, number):
        deadline = time.monotonic() + 60
        ranks = []
        while len(ranks) < number and run.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)
            ranks = self.ranks_of(run)
        return ranks

    def ended(self, run, ranks, within):
        """What the run says when it ends, which all its ranks do, soon; with one message of ours at most."""
        begin = time.monotonic()
        _, told = run.communicate(timeout=60)
        self.assertLess(time.monotonic() - begin, within)
        left = set(ranks)
        while left and time.monotonic() < begin + within:  # mpirun may end a little before them
            left = {rank for rank in left if Path(f"/proc/{rank}").exists()}
            time.sleep(0.01)
        self.assertEqual(left, set())
        self.assertLessEqual(len(our_lines(told)), 1, told)
        return told

    def case_in_two_blocks(self, slabs):
        text = sphere("C", more="[cap]\nblocks = 2\n").replace("slabs = 2", f"slabs = {slabs}")
        return self.case(text.replace("layers = 2", "layers = 1"))

    @staticmethod
    def accepted(out):
        """The number of slabs that the journal has, after a line for the initial cap."""
        path = out / "slabs.jsonl"
        return max(0, path.read_text().count("\n") - 1) if path.exists() else 0

    def slabs_are_whole(self, out, undisturbed):
        """Each accepted slab, and each that an index names, has the files of an undisturbed run in as many ranks."""
        indices = {int(path.stem[5:]): path for path in out.glob("slab_*.pvtu")}
        for slab in range(self.accepted(out)):
            self.assertIn(slab, indices)
        for slab, index in indices.items():
            ranks = index.read_text().count("<Piece ")
            kinds = "vtu", "msh", "pvtu"
            for kind in kinds if slab < self.accepted(out) else kinds[:1]:
                expected = sorted(undisturbed[ranks].glob(f"slab_{slab:04}*.{kind}"))
                self.assertGreater(len(expected), 0)
                for path in expected:
                    self.assertEqual((out / path.name).read_bytes(), path.read_bytes(), path.name)
        return indices

    def test_ranks_that_are_killed_at_random(self):
        slabs, rounds = (12, 20) if LARGE else (8, 3)
        case = self.case_in_two_blocks(slabs) if LARGE else self.case(circle("centre").replace("slabs = 2", f"slabs = {slabs}"))
        undisturbed = {}
        for ranks in (2, 3):
            begin = time.monotonic()
            undisturbed[ranks] = self.in_ranks(ranks, case, out=f"undisturbed-{ranks}")
        longest = time.monotonic() - begin
        out, random, killed, most = self.dir / "out", Random(20261130), 0, 0
        while killed < rounds or self.accepted(out) < slabs:
            number = random.choice((2, 3))
            run = self.start(number, case, out, "--resume")
            ranks = self.wait_for_ranks(run, number)
            victim, moment = random.choice(ranks), random.uniform(0, longest)
            try:
                run.wait(timeout=moment if killed < rounds else 120)
            except subprocess.TimeoutExpired:
                os.kill(victim, signal.SIGKILL)
                killed += 1
            told = self.ended(run, ranks, 10)
            if run.returncode == 0:  # it came to its end before
                self.assertEqual(self.accepted(out), slabs, told)
            self.slabs_are_whole(out, undisturbed)
            self.assertGreaterEqual(self.accepted(out), most)
            most = self.accepted(out)
            if most == slabs and killed < rounds:
                self.everything_is_there(out, undisturbed)
                shutil.rmtree(out)
                most = 0
        self.everything_is_there(out, undisturbed)

    def everything_is_there(self, out, undisturbed):
        """No file is missing, none is left over, and none differs."""
        indices = self.slabs_are_whole(out, undisturbed)
        expected = {path.name for path in undisturbed[2].iterdir() if not path.name.startswith("slab_")}
        for slab, index in indices.items():
            ranks = index.read_text().count("<Piece ")
            expected |= {path.name for path in undisturbed[ranks].glob(f"slab_{slab:04}*")}
        self.assertEqual({path.name for path in out.iterdir()}, expected)
        for path in undisturbed[2].glob("cap_*.vtu"):
            self.assertEqual((out / path.name).read_bytes(), path.read_bytes(), path.name)
        report = json.loads((out / "report.json").read_text())
        self.assertEqual([slab["slab"] for slab in report["slabs"]], list(range(len(indices))))

    def test_a_rank_that_stops_answering(self):
        run = self.start(3, self.case_in_two_blocks(400), self.dir / "out", SLABHULL_RANK_TIMEOUT="4")
        ranks = self.wait_for_ranks(run, 3)
        while self.accepted(self.dir / "out") < 1 and run.poll() is None:
            time.sleep(0.02)
        os.kill(ranks[1], signal.SIGSTOP)
        told = self.ended(run, ranks, 20)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("not been heard of", our_lines(told)[0])

    def test_a_time_out_that_is_no_number(self):
        run = self.start(2, self.case_in_two_blocks(1), self.dir / "out", SLABHULL_RANK_TIMEOUT="soon")
        _, told = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 2, told)
        self.assertIn("SLABHULL_RANK_TIMEOUT", told)

    def test_a_disk_that_is_full_for_one_rank(self):
        case = self.case(circle("centre").replace("slabs = 2", "slabs = 3"))
        undisturbed = {2: self.in_ranks(2, case, out="undisturbed")}
        out, disk = self.dir / "out", self.dir / "disk"
        out.mkdir()
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=32k", "tmpfs", disk], capture_output=True).returncode != 0:
            self.skipTest("a small file system cannot be mounted here")
        self.addCleanup(subprocess.run, ["umount", disk])
        (disk / "there.vtu").touch()
        (out / "slab_0001_1.vtu").symlink_to(disk / "there.vtu")  # the second rank's file of the second slab
        run = self.start(2, case, out)
        told = self.ended(run, self.wait_for_ranks(run, 2), 60)
        self.assertEqual(run.returncode, 5, told)
        self.assertIn("slab_0001_1.vtu", our_lines(told)[0])
        self.assertIn("No space left", our_lines(told)[0])
        self.assertEqual(self.accepted(out), 1)
        self.assertEqual(sorted(self.slabs_are_whole(out, undisturbed)), [0])
        self.assertEqual(list(self.dir.rglob("*.part")), [])
        self.in_ranks(2, case, "--resume", out="out")
        self.everything_is_there(out, undisturbed)

    def test_files_that_may_not_grow_on_one_rank(self):
        case = self.case_in_two_blocks(3)
        build = [PROGRAM, "build", str(case), "--out", str(self.dir / "out"), "--quiet"]
        limited = ["sh", "-c", 'ulimit -f 32; exec "$@"', "-", *build]
        done = subprocess.run([*LAUNCH, "2", *build, ":", "-n", "1", *limited], capture_output=True, text=True,
                              timeout=120, env={**ENVIRONMENT, "OMPI_MCA_btl": "self,tcp"})  # no shared files
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertEqual(len(our_lines(done.stderr)), 1, done.stderr)
        self.assertIn("slab_0000_2", our_lines(done.stderr)[0])
        self.assertEqual(list((self.dir / "out").glob("slab_*")), [])


@unittest.skipIf(MPIRUN is None or HAVE_MPI, "for builds without MPI")
class WithoutMpi(ProgramTest):
    def test_is_refused(self):
        result = mpirun(2, "build", self.case(circle("centre")), "--out", self.dir / "out")
        self.assertEqual(result.code, 2)
        self.assertEqual(len(our_lines(result.err)), 1, result.err)


if __name__ == "__main__":
    harness.main()
