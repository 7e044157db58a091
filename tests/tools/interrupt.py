#!/usr/bin/env python3
"""Ctrl-C and SIGTERM: the program ends within a second, says so, leaves nothing half-written, and goes on by --resume."""
import os
import random
import shutil
import signal
import subprocess
import time

from harness import PROGRAM, SANITIZED, ProgramTest, long, main, slabhull

CASE = """
dimension = {dimension}
[initial]
experiment = "{experiment}"
level = {level}
[time]
start = 0.0
end = 1.0
slabs = {slabs}
layers = {layers}
[output]
formats = ["vtu"]
"""


class Interrupt(ProgramTest):
    def start(self, *arguments):
        return subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                start_new_session=True)

    def wait_for_handler(self, run, number):
        """Before that, while libraries are loaded, a signal ends the process as it does any other."""
        caught = 0
        while not caught >> (number - 1) & 1 and run.poll() is None:
            with open(f"/proc/{run.pid}/status") as status:
                caught = next((int(line.split()[1], 16) for line in status if line.startswith("SigCgt")), 0)

    def stop(self, run, number, wait, group=False):
        """Sends the signal, to all processes of the run where `group`, as a terminal does; the seconds that it took, or
        None when the run had ended before."""
        self.wait_for_handler(run, number)
        time.sleep(wait)
        if run.poll() is not None:
            run.communicate()
            return None
        begin = time.monotonic()
        os.killpg(run.pid, number) if group else run.send_signal(number)
        error = run.communicate(timeout=60)[1].decode()
        took = time.monotonic() - begin
        if run.returncode == 0:  # it was done already
            return None
        self.assertEqual(run.returncode, 128 + number, error)
        self.assertIn("interrupted", error)
        return took

    def left_over(self, out):
        return [p.name for p in out.iterdir() if p.name.endswith(".part")] if out.exists() else []

    def interrupted_builds(self, dimension, experiment, level, slabs, layers):
        case = self.case(CASE.format(dimension=dimension, experiment=experiment, level=level, slabs=slabs, layers=layers))
        begin = time.monotonic()
        whole, _ = self.build(case, out="whole")
        duration = time.monotonic() - begin
        rng = random.Random(7)
        longest, stopped, wanted = 0, 0, 3 if SANITIZED else 8
        out = self.dir / "out"
        for k in range(100):
            if stopped == wanted:
                break
            number = (signal.SIGINT, signal.SIGTERM)[k % 2]
            run = self.start("build", case, "--out", out, "--quiet", "--resume")
            took = self.stop(run, number, rng.uniform(0, duration / 4), group=k % 4 < 2)
            self.assertEqual(self.left_over(out), [])
            if took is None:  # it came to its end
                shutil.rmtree(out)
            else:
                stopped, longest = stopped + 1, max(longest, took)
        self.assertEqual(stopped, wanted)
        print(f"{experiment}: {stopped} builds stopped, the slowest after {longest:.2f} s")
        result = slabhull("build", case, "--out", out, "--quiet", "--resume")
        self.assertEqual(result.code, 0, result.err)
        for file in sorted(whole.glob("*.vtu")):
            self.assertEqual(file.read_bytes(), (out / file.name).read_bytes(), file.name)

    def test_builds_in_2d(self):
        self.interrupted_builds(2, "expanding-circle", 3, 8, 10)

    def test_builds_in_3d(self):
        self.interrupted_builds(3, "ellipsoid", 1, 6, 4)

    def test_check(self):
        case = self.case(CASE.format(dimension=3, experiment="ellipsoid", level=1, slabs=1, layers=40))
        out, _ = self.build(case)
        run = self.start("check", out / "slab_0000.vtu")
        self.stop(run, signal.SIGINT, 0.1)

    @long
    def test_a_study_leaves_no_part_of_the_hull_that_it_was_writing(self):
        out = self.dir / "study"
        for number in (signal.SIGINT, signal.SIGTERM):
            run = self.start("study", "ellipsoid", "--levels", "2-4", "--hulls", "--out", out)
            while run.poll() is None and not self.left_over(out):
                time.sleep(0.001)
            self.assertIsNotNone(self.stop(run, number, 0))
            self.assertEqual(self.left_over(out), [])

    def test_a_signal_that_is_ignored_stays_ignored(self):
        case = self.case(CASE.format(dimension=2, experiment="circle", level=1, slabs=20, layers=4))
        out = self.dir / "nohup"
        run = subprocess.Popen(["/bin/sh", "-c", 'trap "" INT; exec "$@"', "sh", PROGRAM, "build", str(case), "--out",
                                str(out), "--quiet"], stderr=subprocess.PIPE)
        self.wait_for_handler(run, signal.SIGTERM)
        run.send_signal(signal.SIGINT)
        error = run.communicate(timeout=120)[1].decode()
        self.assertEqual(run.returncode, 0, error)


if __name__ == "__main__":
    main()
