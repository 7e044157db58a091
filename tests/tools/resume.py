#!/usr/bin/env python3
"""Runs that are interrupted, by SIGKILL at random moments or by a full disk, and go on as if they had not been."""
import json
import random
import re
import shutil
import signal
import struct
import subprocess
import time
import zlib

from harness import PROGRAM, ProgramTest, main, slabhull

CASE = """
dimension = {dimension}
[initial]
experiment = "{experiment}"
level = 1
[time]
start = 0.0
end = 1.0
slabs = {slabs}
layers = 1
[output]
formats = {formats}
"""
TIMED = ("report.json", "slabs.jsonl", "march.state")  # tell how long it took


def contents(directory):
    return {p.name: p.read_bytes() for p in sorted(directory.iterdir()) if p.name not in TIMED}


class Interrupted(ProgramTest):
    def reference(self, dimension, experiment, slabs, formats='["vtu"]'):
        case = self.case(CASE.format(dimension=dimension, experiment=experiment, slabs=slabs, formats=formats))
        begin = time.monotonic()
        out, report = self.build(case, out="reference")
        self.assertEqual(len(report["slabs"]), slabs)
        return case, contents(out), time.monotonic() - begin

    def kill_at_random(self, case, out, longest, rng):
        """Starts a run that resumes and kills it; False when it came to its end before."""
        run = subprocess.Popen([PROGRAM, "build", case, "--out", out, "--quiet", "--resume"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        time.sleep(rng.uniform(0, longest))
        killed = run.poll() is None
        run.send_signal(signal.SIGKILL)
        error = run.communicate()[1].decode()
        if not killed:
            self.assertEqual(run.returncode, 0, error)
        return killed

    def killed_runs(self, dimension, experiment, slabs, kills, seed, **formats):
        case, expected, duration = self.reference(dimension, experiment, slabs, **formats)
        rng = random.Random(seed)
        out = self.dir / "out"
        done, most = 0, 0
        while done < kills:
            if self.kill_at_random(case, out, duration / 4, rng):
                done += 1
            else:  # finished between kills: compare, then begin anew
                self.assertEqual(contents(out), expected)
                shutil.rmtree(out)
            accepted = self.accepted(out)
            self.assertTrue(accepted >= most or accepted == 0)
            most = accepted
        result = slabhull("build", case, "--out", out, "--quiet", "--resume")
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual(contents(out), expected)
        report = json.loads((out / "report.json").read_text())
        self.assertEqual([slab["slab"] for slab in report["slabs"]], list(range(slabs)))

    def accepted(self, out):
        """Slabs accepted: the number in the checkpoint, which must be whole at any moment."""
        path = out / "march.state"
        if not path.exists():
            return 0
        state = path.read_bytes()
        self.assertEqual(zlib.crc32(state[:-4]), struct.unpack("<I", state[-4:])[0])
        return struct.unpack_from("<i", state, len(b"slabhull march 3\n") + 4)[0]

    def test_fifty_kills_of_a_long_march(self):
        self.killed_runs(2, "expanding-circle", 40, 50, seed=4)

    def test_kills_of_a_march_with_hulls_in_pieces(self):
        self.killed_runs(2, "expanding-circle", 10, 10, seed=6, formats='["pvtu", "msh"]\npieces = 3')

    def test_kills_while_tetgen_works(self):
        self.killed_runs(3, "sphere", 3, 4, seed=5)

    def test_a_resumed_run_that_is_complete_has_nothing_to_do(self):
        case, expected, _ = self.reference(2, "circle", 3)
        out = self.dir / "reference"
        before = (out / "march.state").read_bytes()
        result = slabhull("build", case, "--out", out, "--resume")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("0 slabs", result.out)
        self.assertEqual(contents(out), expected)
        self.assertEqual((out / "march.state").read_bytes(), before)

    def test_a_table_that_was_changed_since_is_told(self):
        table = self.dir / "spin.csv"
        table.write_text("time, angle\n0, 0\n1, 0.2\n")
        case = self.case('[initial]\nexperiment = "circle"\nlevel = 1\n[motion.body]\nkind = "rotation"\ncentre = [0, 0]\n'
                         'table = "spin.csv"\n[time]\nlayers = 8\n')
        out, _ = self.build(case)
        for angle, told in ((0.2, False), (0.3, True)):
            table.write_text(f"time, angle\n0, 0\n1, {angle}\n")
            result = slabhull("build", case, "--out", out, "--resume")
            self.assertEqual(result.code, 0, result.err)
            self.assertEqual("or a table or surface that it names, is not what it was" in result.err, told, result.err)

    def test_without_a_checkpoint_it_begins_and_says_so(self):
        case, expected, _ = self.reference(2, "circle", 2)
        result = slabhull("build", case, "--out", self.dir / "out", "--resume")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("from the beginning", result.err)
        self.assertEqual(contents(self.dir / "out"), expected)

    def test_damaged_files_are_not_gone_on_from(self):
        case, _, _ = self.reference(2, "circle", 2)
        out = self.dir / "reference"
        for name in ("march.state", "cap_0002.vtu", "slabs.jsonl"):
            with self.subTest(name):
                sound = (out / name).read_bytes()
                (out / name).write_bytes(sound[:len(sound) // 2])
                result = slabhull("build", case, "--out", out, "--resume")
                self.assertEqual(result.code, 3, result.err)
                self.assertIn(name, result.err)
                (out / name).write_bytes(sound)

    def test_a_flipped_bit_of_the_journal_is_found(self):
        case, _, _ = self.reference(2, "circle", 2)
        journal = self.dir / "reference" / "slabs.jsonl"
        sound = journal.read_bytes()
        for at in random.Random(8).sample(range(len(sound)), 20):
            journal.write_bytes(sound[:at] + bytes([sound[at] ^ 1]) + sound[at + 1:])
            result = slabhull("build", case, "--out", journal.parent, "--resume")
            self.assertEqual(result.code, 3, result.err)
            self.assertIn("slabs.jsonl: is damaged: its checksum is wrong; start the run anew", result.err)

    def test_finished_slabs_are_there_and_as_long_as_they_were(self):
        case, _, _ = self.reference(2, "circle", 2)
        out = self.dir / "reference"
        slab = out / "slab_0000.vtu"
        sound = slab.read_bytes()
        slab.write_bytes(sound[:100])
        result = slabhull("build", case, "--out", out, "--resume")
        self.assertEqual(result.code, 3, result.err)
        self.assertIn(f"slab_0000.vtu: is damaged: it has 100 bytes, and had {len(sound)}", result.err)
        slab.unlink()
        result = slabhull("build", case, "--out", out, "--resume")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("1 files of finished slabs are not there any more, the first slab_0000.vtu", result.err)
        self.assertNotIn("slab_0000", (out / "slabs.pvd").read_text())
        self.assertIn("slab_0001.vtu", (out / "slabs.pvd").read_text())

    def test_other_formats_from_here_on_leave_series_of_what_is_there(self):
        for before, after in (("vtu", "msh"), ("msh", "vtu"), ("vtu", "pvtu")):
            with self.subTest(before=before, after=after):
                text = CASE.format(dimension=2, experiment="circle", slabs="{slabs}", formats='["{format}"]')
                text = text.replace("end = 1.0", "end = 0.{slabs}")
                out = self.build(self.case(text.format(slabs=2, format=before)), out=before + after)[0]
                self.build(self.case(text.format(slabs=4, format=after)), "--resume", out=before + after)
                series = (out / "slabs.pvd").read_text()
                listed = set(re.findall('file="([^"]*)"', series))
                self.assertEqual(listed, {f"slab_000{k}.{format}" for k, format in enumerate(2 * [before] + 2 * [after])
                                          if format != "msh"})
                for name in listed:
                    self.assertTrue((out / name).exists())


class OneAtATime(ProgramTest):
    def start(self, *arguments):
        run = subprocess.Popen([PROGRAM, *map(str, arguments), "--quiet"], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run

    def wait_for(self, path, run):
        while not path.exists():
            self.assertIsNone(run.poll())
            time.sleep(0.01)

    def test_a_folder_has_one_run_at_a_time(self):
        case = self.case(CASE.format(dimension=3, experiment="sphere", slabs=100, formats='["vtu"]'))
        out = self.dir / "out"
        first = self.start("build", case, "--out", out)
        self.wait_for(out / "march.state", first)
        for options in ((), ("--resume",)):
            second = slabhull("build", case, "--out", out, *options)
            self.assertEqual(second.code, 2, second.err)
            self.assertIn(f"{out}: another run is at work in this folder", second.err)
        self.assertIsNone(first.poll())

    def test_a_killed_run_frees_its_folder_with_its_meshers(self):
        case = self.case(CASE.format(dimension=3, experiment="sphere", slabs=100, formats='["vtu"]'))
        out = self.dir / "out"
        for _ in range(3):
            run = self.start("build", case, "--out", out, "--resume")
            self.wait_for(out / "march.state", run)
            run.kill()
            run.wait()
        short = case.read_text().replace("slabs = 100", "slabs = 1")
        result = slabhull("build", self.case(short), "--out", out, "--quiet")
        self.assertEqual(result.code, 0, result.err)

    def test_studies_write_into_a_folder_one_at_a_time(self):
        out = self.dir / "out"
        first = self.start("study", "ellipsoid", "--out", out)
        self.wait_for(out, first)
        time.sleep(0.05)
        second = slabhull("study", "circle", "--levels", "1", "--out", out, "--quiet")
        self.assertEqual(second.code, 2, second.err)
        self.assertIn("another run", second.err)


class FullDisk(ProgramTest):
    def test_a_full_disk_loses_nothing_accepted(self):
        case = self.case(CASE.format(dimension=2, experiment="circle", slabs=12, formats='["vtu"]'))
        expected = contents(self.build(case, out="reference")[0])
        disk = self.dir / "disk"
        disk.mkdir()
        half = sum(map(len, expected.values())) // 2
        if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={half}", "tmpfs", disk],
                          capture_output=True).returncode != 0:
            self.skipTest("a small file system cannot be mounted here")
        self.addCleanup(subprocess.run, ["umount", disk])
        full = slabhull("build", case, "--out", disk, "--quiet")
        self.assertEqual(full.code, 5, full.err)
        self.assertIn("No space left", full.err)
        there = contents(disk)
        self.assertGreater(len(there), 4)
        for name, content in there.items():
            if not name.endswith(".pvd"):
                self.assertEqual(content, expected[name], name)
        subprocess.run(["mount", "-o", f"remount,size={4 * half}", disk], check=True)
        result = slabhull("build", case, "--out", disk, "--quiet", "--resume")
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual(contents(disk), expected)


if __name__ == "__main__":
    main()
