# SPDX-License-Identifier: BSD-3-Clause
"""Real meshes and surfaces through the program: a room by Gmsh, OpenFOAM's flange and fan, a propeller's STL,
an airfoil's point file."""
import gzip
import importlib.util
import json
import math
import shutil
import struct
import subprocess
import sys
import unittest

import harness
from harness import ROOT, ProgramTest, slabhull

FLANGE = "usr/share/doc/openfoam-examples/examples/resources/geometry/flange.stl.gz"
FAN = ("usr/share/doc/openfoam-examples/examples/incompressible/pimpleFoam/RAS/rotatingFanInRoom/constant/triSurface/"
       "fan.stl.gz")


def example(test, name, *files):
    """Copies an example's case file and inputs to the scratch directory."""
    for file in files:
        shutil.copy(ROOT / "examples" / file, test.dir)
    return shutil.copy(ROOT / "examples" / name, test.dir)


def stl_volume(path):
    """What the triangles of a binary STL file enclose."""
    data = path.read_bytes()
    sixfold = 0.0
    for _, _, _, ax, ay, az, bx, by, bz, cx, cy, cz, _ in struct.iter_unpack("<12fH", data[84:]):
        sixfold += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return sixfold / 6


class Room(ProgramTest):
    def test_the_room_of_the_readme(self):
        out, report = self.build(example(self, "room.toml", "room.msh"))
        document = self.check(out / "slab_0000.vtu")
        self.check(out / "slab_0000.msh")
        self.check(out / "cap_0001.vtu")
        self.assertEqual(report["slabs"][0]["counts"]["layers"], 4)
        # A bar (genus 0) and a ring (genus 1) in a box.
        self.assertEqual(document["betti"], [1, 3, 3, 1])
        # Rigid bodies: |Omega(t)| is that of the mesh, but for the chords of the turn.
        box, caps = 4 * 3 * 2.5, report["slabs"][0]["measure"]
        self.assertLess(caps["terminating"], box)
        self.assertAlmostEqual(caps["terminating"], caps["initial"], delta=1e-7)
        self.assertAlmostEqual(caps["enclosed"], caps["initial"], delta=2e-3 * box)

    @harness.long
    def test_every_format_of_the_room_that_gmsh_writes_gives_a_sound_hull(self):
        if shutil.which("gmsh") is None:
            self.skipTest("no gmsh here")
        counts = set()
        for version in ("msh22", "msh41"):
            for binary in ([], ["-bin"]):
                mesh = self.dir / "room.msh"
                subprocess.run(["gmsh", "-3", "-v", "2", *binary, "-format", version, "-o", mesh,
                                ROOT / "examples" / "room.geo"], check=True, capture_output=True)
                out, report = self.build(example(self, "room.toml"), out=f"{version}{len(binary)}")
                self.check(out / "slab_0000.msh")
                self.assertEqual(sorted(report["patches"].values()), ["bar", "duct", "walls"])
                counts.add((report["initial_cap"]["points"], report["initial_cap"]["cells"]))
        self.assertEqual(len(counts), 1)


class OpenFoamSurfaces(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.package = harness.tempfile.TemporaryDirectory(prefix="slabhull-openfoam-")
        cls.addClassCleanup(cls.package.cleanup)
        path = harness.Path(cls.package.name)
        got = subprocess.run(["apt-get", "download", "openfoam-examples"], cwd=path, capture_output=True, text=True)
        packages = list(path.glob("openfoam-examples*.deb"))
        if got.returncode != 0 or not packages:
            raise unittest.SkipTest("the network says no: openfoam-examples could not be downloaded")
        subprocess.run(["dpkg-deb", "-x", packages[0], path], check=True)
        cls.files = path

    def unpack(self, name, file):
        (self.dir / file).write_bytes(gzip.decompress((self.files / name).read_bytes()))

    def test_the_flange_turns_by_90_degrees_in_a_box(self):
        self.unpack(FLANGE, "flange.stl")
        out, report = self.build(example(self, "flange.toml"))
        document = self.check(out / "slab_0000.vtu")
        # The double of a box without a body of genus 4: one class for the body, one for each handle.
        self.assertEqual(document["betti"], [1, 5, 5, 1])
        self.assertEqual(report["slabs"][0]["counts"]["layers"], 4)
        box = 0.1 * 0.1 * 0.07
        self.assertLess(report["slabs"][0]["measure"]["terminating"], box)

    def test_the_fan_that_crosses_itself_is_refused_with_the_facets_named(self):
        self.unpack(FAN, "fan.stl")
        case = self.case('dimension = 3\n[initial]\nsurfaces = [ { file = "fan.stl", patch = "fan" } ]\n'
                         'box = { min = [-5, 0, 0], max = [0, 4, 4], size = 0.5 }\n')
        self.refused(case, 3, "fan.stl", "cross", "facets")


class Propeller(ProgramTest):
    @harness.long
    def test_three_blades_of_an_stl_file_turn_in_a_box(self):
        out, report = self.build(example(self, "propeller.toml", "propeller.stl"))
        self.assertEqual(len(report["slabs"]), 3)
        for slab in range(3):
            result = slabhull("check", out / f"slab_{slab:04}.vtu", "--embedding", "--json")
            self.assertEqual(result.code, 0, result.out + result.err)
            self.assertEqual(json.loads(result.out)["betti"], [1, 1, 1, 1])
        # A rigid body: |Omega(t)| stays, but for the chords of the turn, and for what the file says of its volume.
        volume = 3.2 * 3.2 * 2.4 - stl_volume(self.dir / "propeller.stl")
        measures = [slab["measure"] for slab in report["slabs"]]
        self.assertAlmostEqual(measures[0]["initial"], volume, delta=1e-6)
        self.assertAlmostEqual(measures[2]["terminating"], volume, delta=1e-6)
        self.assertAlmostEqual(sum(m["enclosed"] for m in measures), volume, delta=1e-3)

    def test_its_script_writes_a_propeller_of_the_same_volume(self):
        if importlib.util.find_spec("gmsh") is None:
            self.skipTest("no gmsh here")
        written = self.dir / "written.stl"
        subprocess.run([sys.executable, ROOT / "examples" / "make_propeller.py", written], check=True, capture_output=True)
        self.assertAlmostEqual(stl_volume(written), stl_volume(ROOT / "examples" / "propeller.stl"), delta=1e-3)


class Airfoil(ProgramTest):
    def test_the_pitching_airfoil(self):
        out, report = self.build(example(self, "airfoil.toml", "naca0012.dat"))
        self.assertEqual(len(report["slabs"]), 2)
        for slab in (0, 1):
            for suffix in ("vtu", "msh"):
                document = self.check(out / f"slab_{slab:04}.{suffix}")
                self.assertEqual(document["betti"], [1, 2, 1])
                self.assertEqual(document["counts"]["cells"], 2 * document["counts"]["vertices"])
        # One period brings the airfoil back.
        first, last = (report["slabs"][i]["measure"] for i in (0, 1))
        self.assertAlmostEqual(last["terminating"], first["initial"], places=6)


if __name__ == "__main__":
    harness.main()
