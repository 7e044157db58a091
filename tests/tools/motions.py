# SPDX-License-Identifier: BSD-3-Clause
"""Motions by table and in sequence through the program: where scipy and trigonometry have them, sound between, and
refused with file, line and column where a table is damaged."""
import importlib.util
import math
import random
import shutil

import harness
from harness import ROOT, ProgramTest, slabhull

USAGE, INPUT, GEOMETRY = 2, 3, 4
CENTRE = {2: (0.1, 0.4), 3: (0.1, -0.2, 0.4)}


def plate(x=0.1, y=0.4, length=0.5, width=0.1, count=10):
    """A flat rhombus of a curve about (x, y)."""
    points = []
    for i in range(4 * count):
        quarter, s = divmod(i, count)
        a, b = [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 0)][quarter:quarter + 2]
        p, q = (a[k] + (b[k] - a[k]) * s / count for k in range(2))
        points.append(f"{x + length * p:.12g} {y + width * q:.12g}")
    return "\n".join(points) + "\n"


def octahedron(x=0.1, y=-0.2, z=0.4, a=0.4, b=0.3, c=0.15):
    points = [(x + a, y, z), (x - a, y, z), (x, y + b, z), (x, y - b, z), (x, y, z + c), (x, y, z - c)]
    facets = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    lines = ["OFF", f"{len(points)} {len(facets)} 0"]
    return "\n".join(lines + [" ".join(map(str, p)) for p in points]
                     + ["3 " + " ".join(map(str, f)) for f in facets]) + "\n"


def falling(times):
    """Displacement and angles in degrees by time."""
    return [(t, 0.2 * math.sin(t), 0.1 * t, -0.5 * t * t, 40 * t, 25 * math.sin(2 * t), 130 * t + 10) for t in times]


INSTANTS = [0, 0.15, 0.2, 0.45, 0.6, 0.8, 1]


def csv(header, rows):
    return "\n".join([header] + [",".join(repr(float(v)) for v in row) for row in rows]) + "\n"


class MotionTest(ProgramTest):
    def body_case(self, dimension, motion, time="layers = 3", scheme="exact"):
        """A body in a box with a motion."""
        if dimension == 2:
            (self.dir / "body.dat").write_text(plate())
            initial = 'curves = [ { file = "body.dat", patch = "body" } ]\nbox = { min = [-2, -2], max = [2, 2], size = 0.5 }'
        else:
            (self.dir / "body.off").write_text(octahedron())
            initial = ('surfaces = [ { file = "body.off", patch = "body" } ]\n'
                       'box = { min = [-1, -1, -1], max = [1, 1, 1], size = 0.5 }')
        return self.case(f'dimension = {dimension}\n[initial]\n{initial}\n[time]\n{time}\n'
                         f'[trajectory]\nscheme = "{scheme}"\n[motion.body]\n{motion}\n')

    def table_case(self, dimension, text, name="table.csv", **more):
        (self.dir / name).write_text(text)
        return self.body_case(dimension, f'kind = "rigid-table"\nfile = "{name}"\ncentre = {list(CENTRE[dimension])}', **more)

    def sound(self, out, slabs):
        for slab in range(slabs):
            result = slabhull("check", out / f"slab_{slab:04}.vtu", "--embedding")
            self.assertEqual(result.code, 0, result.out + result.err)


class Falling(MotionTest):
    """A falling, turning body by rigid-table, every slab of it embedded."""

    def test_in_space(self):
        for file in ("falling-body.csv", "falling-body.off"):
            shutil.copy(ROOT / "examples" / file, self.dir)
        out, report = self.build(shutil.copy(ROOT / "examples" / "falling-body.toml", self.dir))
        self.assertEqual(len(report["slabs"]), 4)
        self.sound(out, 4)

    def test_in_the_plane(self):
        rows = [(t, x, z, yaw) for t, x, _, z, _, _, yaw in falling(INSTANTS)]
        out, _ = self.build(self.table_case(2, csv("time,x,y,angle_deg", rows), time="slabs = 3\nlayers = 3", scheme="rk4"))
        self.sound(out, 3)

    def test_schemes_and_closed_form_come_to_the_same_place(self):
        text = csv("time,x,y,z,roll_deg,pitch_deg,yaw_deg", falling(INSTANTS))
        caps = []
        for scheme in ("exact", "rk4"):
            out, report = self.build(self.table_case(3, text, scheme=scheme), out=scheme)
            caps.append(report["slabs"][0]["measure"])
        self.assertAlmostEqual(caps[0]["terminating"], caps[1]["terminating"], delta=1e-6)
        self.assertAlmostEqual(caps[0]["enclosed"], caps[1]["enclosed"], delta=1e-6)


class Places(MotionTest):
    """Every vertex of the body is where an independent computation has it."""

    def setUp(self):
        super().setUp()
        for module in ("numpy", "scipy", "vtkmodules"):
            if importlib.util.find_spec(module) is None:
                self.skipTest(f"no {module} here")

    def compare(self, case, dimension, place):
        """place(t): linear part and displacement of the body about its centre at t, as from a table."""
        import numpy as np
        from outputs import vtk_arrays
        out, _ = self.build(case)
        seen = vtk_arrays(out / "slab_0000.vtu")
        x, t, track = seen["points"][:, :dimension], seen["t"], seen["track_id"]
        centre = np.array(CENTRE[dimension])
        first = (t == t.min()) & (track >= 0) & (np.abs(x - centre).max(axis=1) < 0.6)
        start = dict(zip(track[first], x[first]))
        turn0, shift0 = place(t.min())
        compared = 0
        for where, when, which in zip(x, t, track):
            if which in start:
                rest = turn0.T @ (start[which] - centre - shift0)
                turn, shift = place(when)
                np.testing.assert_allclose(where, centre + shift + turn @ rest, atol=2e-14)
                compared += 1
        self.assertEqual(compared, 4 * len(start))
        self.assertGreaterEqual(len(start), 6)

    def spline(self, rows):
        import numpy as np
        from scipy.interpolate import CubicSpline
        rows = np.array(rows)
        return CubicSpline(rows[:, 0], rows[:, 1:])

    def by_angles(self, rows, shifts=slice(0, 3)):
        from scipy.spatial.transform import Rotation
        spline = self.spline(rows)

        def place(t):
            values = spline(t)
            return Rotation.from_euler("XYZ", values[3:], degrees=True).as_matrix(), values[shifts]
        return place

    def test_angles_in_degrees_and_radians_and_as_openfoam_writes_them(self):
        rows = falling(INSTANTS)
        place = self.by_angles(rows)
        self.compare(self.table_case(3, csv("time,x,y,z,roll_deg,pitch_deg,yaw_deg", rows)), 3, place)
        radians = [row[:4] + tuple(map(math.radians, row[4:])) for row in rows]
        self.compare(self.table_case(3, csv("time,x,y,z,roll,pitch,yaw", radians)), 3, place)
        foam = [f"({row[0]!r} (({row[1]!r} {row[2]!r} {row[3]!r}) ({row[4]!r} {row[5]!r} {row[6]!r})))" for row in rows]
        self.compare(self.table_case(3, f"{len(rows)}\n(\n" + "\n".join(foam) + "\n)\n", name="motion.dat"), 3, place)

    def test_quaternions_of_either_sign(self):
        import numpy as np
        from scipy.spatial.transform import Rotation
        rows = falling(INSTANTS)
        quaternions = [Rotation.from_euler("XYZ", row[4:], degrees=True).as_quat() for row in rows]
        for before, after in zip(quaternions, quaternions[1:]):
            after *= 1 if before @ after > 0 else -1
        spline = self.spline([(row[0], *q) for row, q in zip(rows, quaternions)])
        shifts = self.spline([row[:4] for row in rows])

        def place(t):
            return Rotation.from_quat(spline(t)).as_matrix(), shifts(t)
        signed = [row[:4] + (s * q[3], s * q[0], s * q[1], s * q[2])
                  for row, q, s in zip(rows, quaternions, np.array([1, -1, -1, 1, -1, 1, -1]))]
        self.compare(self.table_case(3, csv("time,x,y,z,qw,qx,qy,qz", signed)), 3, place)

    def test_one_angle_in_the_plane(self):
        import numpy as np
        rows = [(t, x, z, yaw) for t, x, _, z, _, _, yaw in falling(INSTANTS)]
        spline = self.spline(rows)

        def place(t):
            x, y, angle = spline(t)
            c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
            return np.array([[c, -s], [s, c]]), np.array([x, y])
        self.compare(self.table_case(2, csv("time,x,y,angle_deg", rows)), 2, place)
        space = [(t, x, y, 0, 0, 0, angle) for t, x, y, angle in rows]
        self.compare(self.table_case(2, csv("time,x,y,z,roll_deg,pitch_deg,yaw_deg", space)), 2, place)

    def test_a_rotation_by_a_table_that_starts_before_the_case(self):
        from scipy.spatial.transform import Rotation
        import numpy as np
        rows = [(t, 0.3 * t * t - 1) for t in (-2, -1, 0.1, 0.4, 1, 3)]
        (self.dir / "angle.csv").write_text(csv("time,angle", rows))
        spline = self.spline(rows)
        axis = np.array([1, 2, 2]) / 3

        def place(t):
            return Rotation.from_rotvec(spline(t)[0] * axis).as_matrix(), np.zeros(3)
        self.compare(self.body_case(3, 'kind = "rotation"\ntable = "angle.csv"\naxis = [1, 2, 2]\n'
                                       f'centre = {list(CENTRE[3])}'), 3, place)

    def test_a_sequence_of_a_flapping_wing_on_a_turning_hinge(self):
        import numpy as np
        centre = np.array(CENTRE[2])

        def turn(angle):
            return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])

        def place(t):  # about its own centre by 0.8 t, that about (0, 0) by -0.5 t, and all along
            return turn(0.3 * t), turn(-0.5 * t) @ centre - centre + np.array([0.1 * t, 0])
        steps = (f'{{ kind = "rotation", centre = {list(CENTRE[2])}, rate = 0.8 }}, '
                 '{ kind = "sequence", steps = [ { kind = "rotation", centre = [0, 0], rate = -0.5 } ] }, '
                 '{ kind = "translation", velocity = [0.1, 0] }')
        self.compare(self.body_case(2, f'kind = "sequence"\nsteps = [ {steps} ]'), 2, place)


GOOD = csv("time,x,y,angle_deg", [(0, 0, 0, 0), (0.5, 0, 0, 5), (1, 0, 0, 9)])


class BadTables(MotionTest):
    def test_the_table_itself_is_good(self):
        self.build(self.table_case(2, GOOD))

    def test_damage_is_named_by_file_line_and_column(self):
        lines = GOOD.splitlines()
        for text, words in [
            (GOOD.replace("5.0", "nan"), ["line 3", "angle_deg", "nan"]),
            (GOOD.replace("5.0", "five"), ["line 3", "angle_deg", "five"]),
            (GOOD.replace("1.0,", "0.25,"), ["line 4", "0.25", "after"]),
            (GOOD.replace("1.0,", "0.5,"), ["line 4", "0.5", "after"]),
            ("\n".join(lines[:2]) + "\n", ["two rows"]),
            (lines[0] + "\n", ["two rows"]),
            ("", ["empty"]),
            ("\n".join(lines[1:]), ["line 1", "column 1"]),
            (GOOD.replace(",y,", ",v,"), ["no column \"y\"", "time, x, v, angle_deg"]),
            (GOOD.replace("angle_deg", "angel_deg"), ["\"angel_deg\"", "no meaning"]),
            (GOOD.replace("time", "t"), ["no column \"time\""]),
            (GOOD[:-9], ["line 4", "\"y\"", "2 values"]),
            (GOOD.replace("1.0,", "0.99,"), ["from t = 0 to 0.99", "from 0 to 1", "[time]"]),
            (GOOD.replace("\n0.0,", "\n0.01,"), ["from t = 0.01 to 1"]),
            ("time\n0\n1\n", ["neither"]),
            (csv("time,x,y,z,roll,pitch,yaw", [(0, 0, 0, 0, 0, 0, 0), (1, 0, 0, 0.1, 0, 0, 0)]), ["line 3", "\"z\"", "plane"]),
            ("((0 ((0 0 0) (0 0 0))) (1 ((0 0 0) (0 0", ["line 1", "yaw_deg"]),
        ]:
            with self.subTest(words):
                self.refused(self.table_case(2, text), INPUT, "table.csv", *words)

    def test_damage_in_space(self):
        header = "time,qw,qx,qy,qz"
        for rows, words in [
            ([(0, 1, 0, 0, 0), (1, 0, 0, 0, 0)], ["line 3", "length 0"]),
            ([(0, 1, 0, 0, 0), (1, 0, 1, 0, 0)], ["line 3", "half a turn"]),
            ([(0, 1, 0, 0, 0), (0.5, 2, 0, 0, 0), (1, 1, 0, 0, 0)], ["line 3", "length 2"]),
        ]:
            self.refused(self.table_case(3, csv(header, rows)), INPUT, "table.csv", *words)
        self.refused(self.table_case(3, csv("time,x,y,z,roll,pitch", [(0,) * 6, (1,) * 6])), INPUT, "yaw")

    def test_garbage_is_refused_whatever_its_size(self):
        for header in ("", "time,x,y,angle\n", "("):
            path = self.dir / "table.csv"
            case = self.table_case(2, "")
            path.write_bytes(header.encode() + random.Random(7).randbytes(30_000_000))
            result = self.refused(case, INPUT, "table.csv", "line")
            self.assertLess(len(result.err), 500)

    def test_a_table_that_is_not_there(self):
        self.refused(self.body_case(2, 'kind = "rigid-table"\nfile = "none.csv"\ncentre = [0, 0]'), INPUT, "none.csv")

    def test_keys_that_are_wrong(self):
        for motion, words in [
            ('kind = "rigid-table"\ncentre = [0, 0]', ["motion.body.file"]),
            ('kind = "rigid-table"\nfile = "a.csv"', ["motion.body.centre"]),
            ('kind = "rotation"\ncentre = [0, 0]\nrate = 1\ntable = "a.csv"', ["motion.body.table"]),
            ('kind = "sequence"', ["motion.body.steps"]),
            ('kind = "sequence"\nsteps = []', ["motion.body.steps"]),
            ('kind = "sequence"\nsteps = [ 3 ]', ["motion.body.steps"]),
            ('kind = "sequence"\nsteps = [ { kind = "translation", velocity = [1, 0], rate = 2 } ]', ["motion.body.steps[0].rate"]),
            ('kind = "sequence"\nsteps = [ { kind = "translation", velocity = [1, 0] }, '
             '{ kind = "velocity", formula = ["y", "x"] } ]', ["[motion.body]", "step 2", "closed form"]),
        ]:
            with self.subTest(motion):
                self.refused(self.body_case(2, motion), USAGE, *words)


if __name__ == "__main__":
    harness.main()
