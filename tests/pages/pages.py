#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs every block of code on pages of the documentation: pages.py GROUP | PAGE...

GROUP is "start", "how-to" or "reference" (all pages that the others have not). Each page has a fresh folder with what a clone
that was built has: examples/, docs/, build/release/. Blocks run in order, and files stay for those below:

  sh        by bash -e, with the program on PATH. `console`: what stands after "$ "
  python    by one interpreter for the page
  toml      as a case file, its first four slabs: slabhull build --dry-run. A fragment says of which case: the tables are put into it
  cpp       compiled as the body of a function, after its #include lines
  text      output: not run

Comments before a block say more:

  <!-- file: wing.toml -->        the block is a file, of any language; what has a main() is compiled by a block of sh
  <!-- in: examples/room.toml --> the toml below is a fragment of this case: a file of the folder, or of tests/pages/cases
  <!-- instead: examples/room.toml --> the same, but the fragment's tables take the place of those of the case
  <!-- exit: 4 -->                the commands end with this exit code
  <!-- output -->                 each line of the text below is in what the block before it printed, in this order; "..." stands
                                  for anything, times and sizes of memory are not compared
  <!-- needs: gmsh -->            skipped by name where that is not there
  <!-- not run: REASON -->        left out, and counted
  <!-- first, python: CODE -->    not shown to the reader: what a snippet takes for granted; or "first, sh"
  <!-- page not run: REASON -->   all blocks of the page
"""
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from blocks import PageError, read_blocks

HERE = Path(__file__).resolve().parent
ROOT = Path(os.environ.get("SLABHULL_ROOT", HERE.parent.parent))
PYTHON = sys.executable
TIMEOUT = 300
MOST_SLABS = 4
SKIPPED = 77  # ctest's SKIP_RETURN_CODE

# An interpreter that runs what it is sent, and answers on a pipe of its own.
SERVER = """
import json, os, sys, traceback
answers = os.fdopen(int(sys.argv[1]), "w")
names = {"__name__": "__main__"}
sys.path.insert(0, "")
for line in sys.stdin:
    code, page, first = json.loads(line)
    try:
        exec(compile("\\n" * (first - 1) + code, page, "exec"), names)
        failed = False
    except BaseException:
        traceback.print_exc()
        failed = True
    sys.stdout.flush(); sys.stderr.flush()
    answers.write("failed\\n" if failed else "done\\n"); answers.flush()
"""


def pages_of(group):
    """The pages of the site, by group."""
    start = [ROOT / "README.md", *(ROOT / "docs" / name for name in ("index.md", "start.md", "method.md"))]
    how_to = sorted((ROOT / "docs" / "how-to").glob("*.md"))
    if group == "start":
        return start
    if group == "how-to":
        return how_to
    others = [ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "bench").glob("*.md")),
              *sorted((ROOT / "docs").rglob("*.md"))]
    return [page for page in others if page not in start + how_to]


class Failed(Exception):
    """A block that does not do what the page says."""


class Skipped(Exception):
    """A block that needs what is not there."""


def has_module(name):
    return subprocess.run([PYTHON, "-c", f"import importlib.util as u, sys; sys.exit(u.find_spec('{name}') is None)"],
                          capture_output=True).returncode == 0


NEEDS = {  # what blocks may need: how to find it
    "gmsh": lambda: shutil.which("gmsh") is not None,
    "getfem": lambda: has_module("getfem"),
    "meshio": lambda: has_module("meshio"),
    "vtk": lambda: has_module("vtkmodules"),
    "h5py": lambda: has_module("h5py"),
    "cmake": lambda: shutil.which("cmake") is not None and os.path.isdir(os.environ.get("SLABHULL_PREFIX", "")),
    "heat": lambda: os.path.exists(os.environ.get("SLABHULL_HEAT", "")),
    "the Python module": lambda: has_module("slabhull"),
    "mpirun": lambda: shutil.which("mpirun") is not None and "/nowhere.toml" in subprocess.run(
        ["mpirun", "-n", "1", os.environ["SLABHULL_PROGRAM"], "build", "/nowhere.toml"], capture_output=True, text=True).stderr,
    "the page of view": lambda: "(not in this build)" not in subprocess.run(
        [os.environ["SLABHULL_PROGRAM"], "view", "--help"], capture_output=True, text=True).stdout,
}
FOUND = {}


def need(name):
    if name not in NEEDS:
        raise Failed(f"nobody knows how to find \"{name}\"; known are {', '.join(NEEDS)}")
    if name not in FOUND:
        FOUND[name] = NEEDS[name]()
    if not FOUND[name]:
        raise Skipped(f"needs {name}")


def put_into(case, tables, instead):
    """Keys of a fragment into the tables of a case. With `instead`, [TABLE], [motion.PATCH] and [project.PATCH] take the place
    of the case's."""
    for key, value in tables.items():
        if isinstance(value, dict) and isinstance(case.get(key), dict) and not instead:
            put_into(case[key], value, False)
        elif instead and key in ("motion", "project"):
            case.setdefault(key, {}).update(value)
        else:
            case[key] = value


def shorten(case):
    """The first four slabs only: a dry run takes all vertices through all slabs."""
    time = case.get("time", {})
    slabs, start = time.get("slabs", 1), time.get("start", 0.0)
    if slabs > MOST_SLABS:
        time["end"] = start + (time.get("end", 1.0) - start) * MOST_SLABS / slabs
        time["slabs"] = MOST_SLABS


def as_toml(value):
    """A value as TOML has it; tables in one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {as_toml(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(as_toml, value)) + "]"
    return json.dumps(value)


def masked(line):
    """Without what differs from run to run."""
    return re.sub(r"\b\d+(\.\d+)?(e-?\d+)? (s|ms|kB|MB|GB)\b", r"# \3", " ".join(line.split()))


def compare_output(expected, printed):
    """Each expected line must be in the output, in this order."""
    lines = [masked(line) for line in printed.split("\n")]
    at = 0
    for line in expected.split("\n"):
        line = masked(line)
        if line in ("", "..."):
            continue
        pattern = ".*".join(re.escape(part) for part in line.split("..."))
        while at < len(lines) and not re.fullmatch(pattern, lines[at]):
            at += 1
        if at == len(lines):
            raise Failed(f"the page says that this is printed, and it is not:\n{line}\nbut:\n{printed}")
        at += 1


class Runner:
    """The blocks of one page, in a folder of its own."""

    def __init__(self, page, folder):
        self.page, self.folder, self.printed, self.python = page, folder, None, None
        for name in ("examples", "docs/pictures"):
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
        for link, target in (("tools/slabhull", os.environ["SLABHULL_PROGRAM"]), ("python", os.environ.get("PYTHONPATH")),
                             ("examples/heat", os.environ.get("SLABHULL_HEAT"))):
            if target:
                (folder / "build/release" / link).parent.mkdir(parents=True, exist_ok=True)
                (folder / "build/release" / link).symlink_to(target)
        self.environment = dict(os.environ, PATH=f"{folder}/build/release/tools:/usr/bin:{os.environ['PATH']}",
                                CMAKE_PREFIX_PATH=os.environ.get("SLABHULL_PREFIX", ""), CMAKE_GENERATOR="Ninja",
                                LC_ALL="C.UTF-8")

    def run(self, block):
        """True if it was run; False if there is nothing to run."""
        markers = block.markers
        for name in markers.get("needs", "").split(","):
            if name.strip():
                need(name.strip())
        if "file" in markers:
            path = self.folder / markers["file"]
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text + "\n")
            if block.language != "toml":
                return True
        if block.language == "text":
            if "output" not in markers:
                return False
            if self.printed is None:
                raise Failed("output of what? No block before it was run")
            compare_output(block.text, self.printed)
            return True
        runs = {"sh": self.run_sh, "console": self.run_console, "python": self.run_python, "toml": self.run_toml,
                "cpp": self.run_cpp}
        if block.language not in runs:
            raise Failed(f"nobody knows how to run \"{block.language}\"; known are {', '.join(runs)}, text")
        runs[block.language](block)
        return True

    def command(self, arguments, wanted=0, text=None):
        done = subprocess.run(arguments, cwd=self.folder, env=self.environment, input=text, text=True, timeout=TIMEOUT,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.printed = done.stdout
        if done.returncode != wanted:
            raise Failed(f"exit code {done.returncode}, not {wanted}:\n{done.stdout}")

    def run_sh(self, block):
        self.command(["bash", "-euo", "pipefail", "-c", block.text], int(block.markers.get("exit", 0)))

    def run_console(self, block):
        commands = [line[2:] for line in block.text.split("\n") if line.startswith("$ ")]
        self.command(["bash", "-euo", "pipefail", "-c", "\n".join(commands)], int(block.markers.get("exit", 0)))
        compare_output("\n".join(line for line in block.text.split("\n") if not line.startswith("$ ")), self.printed)

    def run_toml(self, block):
        try:
            tables = tomllib.loads(block.text)
        except tomllib.TOMLDecodeError as error:
            raise Failed(f"no TOML: {error}") from error
        name = block.markers.get("in", block.markers.get("instead"))
        if name is not None:
            base = next((path for path in (self.folder / name, HERE / "cases" / name) if path.is_file()), None)
            if base is None:
                raise Failed(f"there is no case {name}")
            case = tomllib.loads(base.read_text())
            put_into(case, tables, "instead" in block.markers)
            tables, where = case, base.parent if base.is_relative_to(self.folder) else self.folder
        elif "initial" not in tables:
            raise Failed("a fragment: say of which case, by a comment <!-- in: CASE --> before it")
        else:
            where = (self.folder / block.markers.get("file", ".")).parent if "file" in block.markers else self.folder
        shorten(tables)
        path = where / "case-of-a-page.toml"
        path.write_text("".join(f"{json.dumps(key)} = {as_toml(value)}\n" for key, value in tables.items()))
        self.command(["slabhull", "build", path, "--dry-run"])

    def run_python(self, block):
        need("the Python module")
        if self.python is None:
            answers, write_end = os.pipe()
            self.log = open(self.folder / ".python-output", "w+")
            self.python = subprocess.Popen([PYTHON, "-c", SERVER, str(write_end)], cwd=self.folder, env=self.environment,
                                           stdin=subprocess.PIPE, stdout=self.log, stderr=subprocess.STDOUT, text=True,
                                           pass_fds=[write_end])
            os.close(write_end)
            self.answers = os.fdopen(answers)
        begin = self.log.seek(0, os.SEEK_END)
        self.python.stdin.write(json.dumps([block.text, str(self.page), block.line]) + "\n")
        self.python.stdin.flush()
        answer = self.answers.readline().strip()
        self.log.seek(begin)
        printed = self.log.read()
        if answer != "done":
            raise Failed(printed or "the interpreter ended")
        if "hidden" not in block.markers:
            self.printed = printed

    def run_cpp(self, block):
        if re.search(r"\bint main\(", block.text):
            raise Failed("a program: give it a file name, and compile it in a block of sh")
        lines = block.text.split("\n")
        first = next((k for k, line in enumerate(lines) if line.strip() and not re.match(r"#include|using namespace", line)), 0)
        source = "\n".join([*lines[:first], "void snippet() {", f"#line {block.line + first}", *lines[first:], "}"])
        includes = [f"-I{path}" for path in sorted(ROOT.glob("*/include"))]
        self.command([os.environ.get("CXX", "c++"), "-std=c++20", "-fsyntax-only", *includes, "-x", "c++", "-"], text=source)

    def close(self):
        if self.python is not None:
            self.python.stdin.close()
            self.python.wait(60)
            self.answers.close()
            self.log.close()


def run_page(page, tell=print):
    """Counts of a page: run, failed; and the reasons of those left out and skipped, by line."""
    name = page.relative_to(ROOT) if page.is_relative_to(ROOT) else page
    run, failed, left_out, skipped = 0, 0, [], []
    try:
        blocks, why_not = read_blocks(page.read_text(encoding="utf-8"))
    except PageError as error:
        tell(f"{name}: {error}")
        return run, 1, left_out, skipped
    if why_not is not None:
        left_out = [(f"{name}:{block.line}", why_not) for block in blocks if block.language != "text"]
        return run, failed, left_out, skipped
    with tempfile.TemporaryDirectory(prefix="slabhull-page-") as folder:
        runner = Runner(name, Path(folder).resolve())
        try:
            for block in blocks:
                here = f"{name}:{block.line}"
                if "not run" in block.markers:
                    left_out.append((here, block.markers["not run"]))
                    continue
                try:
                    run += runner.run(block)
                except Skipped as why:
                    skipped.append((here, str(why)))
                    runner.printed = None
                except (Failed, subprocess.TimeoutExpired, OSError, ValueError) as error:
                    tell(f"{here}: {error}")
                    failed += 1
                    break  # what is below may need it
        finally:
            runner.close()
    return run, failed, left_out, skipped


def seconds_used():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main():
    if not sys.argv[1:]:
        raise SystemExit(__doc__)
    pages = []
    for argument in sys.argv[1:]:
        pages += pages_of(argument) if argument in ("start", "how-to", "reference") else [Path(argument).resolve()]
    total, total_failed, all_left_out, all_skipped = 0, 0, [], []
    for page in pages:
        before = seconds_used()
        run, failed, left_out, skipped = run_page(page)
        print(f"{page.relative_to(ROOT) if page.is_relative_to(ROOT) else page}: {run} run, {len(left_out)} left out, "
              f"{len(skipped)} skipped, {failed} failed; {seconds_used() - before:.1f} s", flush=True)
        total, total_failed = total + run, total_failed + failed
        all_left_out += left_out
        all_skipped += skipped
    for title, some in (("left out", all_left_out), ("skipped", all_skipped)):
        for here, why in some:
            print(f"{title}: {here}: {why}")
    print(f"{len(pages)} pages, {total} blocks run, {len(all_left_out)} left out, {len(all_skipped)} skipped, "
          f"{total_failed} failed; {seconds_used():.0f} s of CPU")
    if total_failed:
        return 1
    return SKIPPED if total == 0 and all_skipped else 0


if __name__ == "__main__":
    sys.exit(main())
