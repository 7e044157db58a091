# SPDX-License-Identifier: BSD-3-Clause
"""Bad input of every kind gets a message and the documented exit code, and leaves no file behind. The mistakes that are
made most often stand in mistakes.py, with their answers."""
import os
import struct
import zlib

import harness
from harness import ProgramTest, slabhull

USAGE, INPUT, GEOMETRY, OUTPUT = 2, 3, 4, 5

CIRCLE = """
[initial]
experiment = "circle"
level = 1
"""

BOX = 'box = { min = [-2, -2, -2], max = [2, 2, 2], size = 0.8, patch = "walls" }'
SQUARE = 'box = { min = [-2, -2], max = [2, 2], size = 0.4, patch = "walls" }'


def octahedron(centre=(0, 0, 0), radius=0.5):
    """An OFF octahedron."""
    x, y, z = centre
    r = radius
    points = [(x + r, y, z), (x - r, y, z), (x, y + r, z), (x, y - r, z), (x, y, z + r), (x, y, z - r)]
    facets = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    lines = ["OFF", f"{len(points)} {len(facets)} 0"]
    lines += [" ".join(map(str, p)) for p in points] + ["3 " + " ".join(map(str, f)) for f in facets]
    return "\n".join(lines) + "\n"


def solid(*bodies, motion="", box=BOX):
    surfaces = ", ".join(f'{{ file = "{b}.off", patch = "{b}" }}' for b in bodies)
    return f"dimension = 3\n[initial]\nsurfaces = [ {surfaces} ]\n{box}\n{motion}"


class CaseFiles(ProgramTest):
    def test_an_empty_case_file(self):
        self.refused(self.case(""), USAGE, "initial")

    def test_a_file_that_is_not_toml(self):
        self.refused(self.case("dimension = = 3\n"), USAGE, "line 1")

    def test_values_out_of_range_or_of_the_wrong_kind(self):
        for text, word in [
            ("[time]\nlayers = 2.5\n", "time.layers"),
            ("[time]\nstart = 1\nend = 1\n", "time.end"),
            ("[time]\nlayers = 2\nspacing = 0.1\n", "time.spacing"),
            ("[time]\nend = inf\n", "time.end"),
            ("[time]\nstart = -1e308\nend = 1e308\n", "time.end"),
            ("[time]\nstart = 1\nend = 1.0000000000000002\nlayers = 10\n", "time.end"),
            ("[side]\nsplit = \"C\"\n", "side.split"),
            ("[trajectory]\nscheme = \"rk5\"\n", "trajectory.scheme"),
            ("[motion.body]\nkind = \"rotation\"\nrate = 1\n", "motion.body.centre"),
            ("[motion.body]\nkind = \"expansion\"\ncentre = [0, 0]\nrate = -1.5\n", "motion.body.rate"),
            ("[cap]\norder = \"hilbert\"\n", "cap.order"),
            ("[cap]\nreuse = \"keep\"\n", "cap.reuse"),
            ("[cap]\nblocks = 2\n", "cap.blocks"),
            ("[cap]\nmesher = \"hxt\"\n", "cap.mesher"),
            ("[cap]\nreuse_angle = -1\n", "cap.reuse_angle"),
            ("[cap]\nreuse_angle = 61\n", "cap.reuse_angle"),
        ]:
            with self.subTest(text):
                self.refused(self.case(CIRCLE + text), USAGE, word, "line")

    def test_wrong_arguments(self):
        for arguments in [[], ["build"], ["bild", "x"], ["build", "x.toml", "--thread", "2"], ["check"]]:
            with self.subTest(arguments):
                self.assertEqual(slabhull(*arguments).code, USAGE)


class Surfaces(ProgramTest):
    def write(self, name, text):
        (self.dir / name).write_text(text)

    def test_an_empty_surface_file(self):
        self.write("body.off", "")
        self.refused(self.case(solid("body")), INPUT, "body.off")

    def test_a_surface_with_an_edge_in_three_facets(self):
        text = octahedron().replace("6 8 0", "6 9 0") + "3 0 2 3\n"
        self.write("body.off", text)
        self.refused(self.case(solid("body")), INPUT, "body.off")

    def test_a_coordinate_that_is_no_number(self):
        self.write("body.off", octahedron().replace("0.5 0 0", "nan 0 0"))
        self.refused(self.case(solid("body")), INPUT, "body.off")

    def test_a_motion_through_another_body_names_facets_patches_and_time(self):
        self.write("a.off", octahedron(centre=(-1, 0.01, 0.02)))
        self.write("b.off", octahedron(centre=(1, 0, 0)))
        motion = '[motion.a]\nkind = "translation"\nvelocity = [1.5, 0, 0]\n'
        self.refused(self.case(solid("a", "b", motion=motion)), GEOMETRY, "patches a and b cross at t = 0.6875 near", "facets")

    def test_a_motion_out_of_the_box(self):
        self.write("a.off", octahedron())
        for velocity, contact in ((1.8, "0.83"), (10, "0.15")):  # through the wall, and past it
            motion = f'[motion.a]\nkind = "translation"\nvelocity = [{velocity}, 0, 0]\n'
            with self.subTest(velocity):
                self.refused(self.case(solid("a", motion=motion)), GEOMETRY, "a", "walls", "t = " + contact)


# A square of two triangles, its boundary in two groups that share two corners.
SPLIT_SQUARE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "left"
1 2 "right"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
6
1 1 2 1 1 1 2
2 1 2 2 2 2 3
3 1 2 2 2 3 4
4 1 2 1 1 4 1
5 2 2 5 1 1 2 3
6 2 2 5 1 1 3 4
$EndElements
"""


class Meshes(ProgramTest):
    CASE = 'dimension = 2\n[initial]\nmesh = "square.msh"\n'

    def mesh(self, text):
        (self.dir / "square.msh").write_text(text)
        return self.case(self.CASE)

    def test_the_mesh_itself_is_good(self):
        self.build(self.mesh(SPLIT_SQUARE))

    def test_a_boundary_in_no_group_becomes_a_patch_with_a_warning_that_counts(self):
        text = SPLIT_SQUARE.replace("1 1 2 1 1 1 2\n", "").replace("$Elements\n6", "$Elements\n5")
        result = slabhull("build", self.mesh(text), "--out", self.dir / "out")
        self.assertEqual(result.code, 0, result.err)
        self.assertIn("1 of 4 boundary facets", result.err)
        self.assertIn("boundary", harness.json.loads((self.dir / "out/report.json").read_text())["patches"].values())

    def test_overlapping_cells(self):
        text = SPLIT_SQUARE.replace("4 0 1 0", "4 0.9 0.1 0")
        self.refused(self.mesh(text), INPUT, "square.msh")

    def test_a_degenerate_cell(self):
        self.refused(self.mesh(SPLIT_SQUARE.replace("3 1 1 0", "3 2 0 0")), INPUT, "square.msh", "5")

    def test_a_coordinate_that_is_no_number(self):
        for word in ("nan", "inf", "zero"):
            self.refused(self.mesh(SPLIT_SQUARE.replace("3 1 1 0", f"3 1 {word} 0")), INPUT, "square.msh")

    def test_a_node_that_there_is_not(self):
        self.refused(self.mesh(SPLIT_SQUARE.replace("6 2 2 5 1 1 3 4", "6 2 2 5 1 1 3 9")), INPUT, "square.msh", "9")

    def test_a_torn_file(self):
        for length in (0, 10, 60, 150, 200, len(SPLIT_SQUARE) - 20):
            with self.subTest(length):
                self.refused(self.mesh(SPLIT_SQUARE[:length]), INPUT, "square.msh")


HUGE = 10**18

# Small files of each format: what in them is replaced, by what, and the words that the message must have.
MSH = SPLIT_SQUARE
MSH4 = """$MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
1 3 1 3
2 1 0 3
1
2
3
0 0 0
1 0 0
0 1 0
$EndNodes
$Elements
1 1 1 1
2 1 2 1
1 1 2 3
$EndElements
"""
VTU = """<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="1">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">5</DataArray></Cells>
<PointData><DataArray type="Float64" Name="t" format="appended" offset="0"/></PointData>
</Piece></UnstructuredGrid>
<AppendedData encoding="raw">
_""" + struct.pack("<Q3d", 24, 0, 1, 2).decode("latin-1") + """
</AppendedData></VTKFile>
"""
VTK = """# vtk DataFile Version 3.0
t
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 3 double
0 0 0 1 0 0 0 1 0
CELLS 1 4
3 0 1 2
CELL_TYPES 1
5
POINT_DATA 3
FIELD f 1
t 1 3 double
0 1 2
"""
MEDIT = ("MeshVersionFormatted 2\nDimension 3\nVertices\n3\n0 0 0 0\n1 0 0 0\n0 1 0 0\n"
         "Triangles\n1\n1 2 3 5\nEnd\n")
MFEM = ("MFEM mesh v1.0\n\ndimension\n2\n\nelements\n1\n1 2 0 1 2\n\nboundary\n1\n3 1 0 1\n\n"
        "vertices\n3\n2\n0 0\n1 0\n0 1\n")
AVRO = '{"dim":3,"number":2,"type":"simplex",\n"vertices":[0,0,0,1,0,0,0,1,0],\n"elements":[0,1,2]\n}\n'
OFF = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
PLY = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
       "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
STL = ("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
       "endsolid\n")
NODE = "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n"
ELE = "1 3 0\n0 0 1 2\n"

CLAIMS = [  # counts that no file could hold
    ("a.msh", MSH, "$Nodes\n4", f"$Nodes\n{HUGE}", "line", f"{HUGE} nodes"),
    ("a.msh", MSH, "$Elements\n6", f"$Elements\n{HUGE}", "line", f"{HUGE} elements"),
    ("a.msh", MSH, "$PhysicalNames\n2", f"$PhysicalNames\n{HUGE}", "line", f"{HUGE} names"),
    ("a.msh", MSH, "1 1 2 1 1 1 2", f"1 1 {2 * 10**9} 1 1 1 2", "line"),
    ("a.msh", MSH4, "1 3 1 3", f"1 {HUGE} 1 3", "line", f"{HUGE} nodes"),
    ("a.msh", MSH4, "1 3 1 3", f"{HUGE} 3 1 3", "line", f"{HUGE} blocks"),
    ("a.msh", MSH4, "2 1 2 1\n1 1", f"2 1 2 {HUGE}\n1 1", "line", f"{HUGE} elements"),
    ("a.vtu", VTU, 'Points="3"', f'Points="{HUGE}"', "points", str(HUGE)),
    ("a.vtu", VTU, 'Cells="1"', f'Cells="{HUGE}"', "cells", str(HUGE)),
    ("a.vtu", VTU, 'Name="t"', f'Name="t" NumberOfComponents="{2**31 - 1}"', '"t"', "rows"),
    ("a.vtu", VTU, "_\x18", "_\x18\x00\x00\x00\x00\x10\x00\x00", '"t"', "end of the file"),
    ("a.vtu", VTU, 'offset="0"', f'offset="{HUGE}"', '"t"', "end of the file"),
    ("a.vtk", VTK, "POINTS 3", f"POINTS {HUGE}", "line", str(HUGE)),
    ("a.vtk", VTK, "CELLS 1 4", f"CELLS {HUGE} {4 * HUGE}", "line", "values of cells"),
    ("a.vtk", VTK, "CELL_TYPES 1", f"CELL_TYPES {HUGE}", "line", f"{HUGE} cell types"),
    ("a.vtk", VTK, "POINT_DATA 3", f"POINT_DATA {HUGE}", "line", f"{HUGE} points"),
    ("a.vtk", VTK, "t 1 3 double", f"t {HUGE} 3 double", "line", str(HUGE)),
    ("a.vtk", VTK, "FIELD f 1", f"FIELD f {HUGE}", "line"),
    ("a.mesh", MEDIT, "Vertices\n3", f"Vertices\n{HUGE}", "line", f"{HUGE} vertices"),
    ("a.mesh", MEDIT, "Triangles\n1", f"Triangles\n{HUGE}", "line", f"{HUGE} Triangles"),
    ("a.mfem", MFEM, "elements\n1", f"elements\n{HUGE}", "line", f"{HUGE} elements"),
    ("a.mfem", MFEM, "boundary\n1", f"boundary\n{HUGE}", "line", f"{HUGE} boundary"),
    ("a.mfem", MFEM, "vertices\n3", f"vertices\n{HUGE}", "line", f"{HUGE} vertices"),
    ("a.avro", AVRO, '"dim":3', f'"dim":{HUGE}', "line", "dimension"),
    ("a.off", OFF, "3 1 0", f"{HUGE} 1 0", "line", f"{HUGE} vertices"),
    ("a.off", OFF, "3 1 0", f"3 {HUGE} 0", "line", f"{HUGE} faces"),
    ("a.off", OFF, "3 0 1 2", f"{HUGE} 0 1 2", "line", f"{HUGE} vertices"),
    ("a.ply", PLY, "vertex 3", f"vertex {HUGE}", "line", f"{HUGE} vertex"),
    ("a.ply", PLY, "face 1", f"face {HUGE}", "line", f"{HUGE} face"),
    ("a.ply", PLY, "\n3 0 1 2", f"\n{HUGE} 0 1 2", "line", "face 0"),
    ("a.stl", "x" * 80 + "\x7f" * 4 + "y" * 50, "", "", "byte", "facets take"),
    ("a.node", NODE, "3 2 0 0", f"{HUGE} 2 0 0", "line", f"{HUGE} points"),
    ("a.node", NODE, "3 2 0 0", f"3 2 {HUGE} 0", "line", f"{HUGE} attributes"),
    ("a.ele", ELE, "1 3 0", f"{HUGE} 3 0", "a.ele", "line", f"{HUGE} cells"),
    ("a.ele", ELE, "1 3 0", f"1 {HUGE} 0", "a.ele", "line", f"{HUGE} corners"),
    ("a.face", "1 0\n0 0 1 2\n", "1 0", f"{HUGE} 0", "a.face", "line", f"{HUGE} triangles"),
]

NOT_A_NUMBER = [
    ("a.msh", MSH, "2 1 0 0\n", "2 1 nan 0\n", "line 12", "node 2"),
    ("a.msh", MSH4, "1 0 0\n", "1 inf 0\n", "line", "node 2"),
    ("a.vtu", VTU, "0 0 0 1 0 0", "0 0 0 nan 0 0", "point 1"),
    ("a.vtk", VTK, "0 0 0 1 0 0", "0 0 0 nan 0 0", "line 6", "point 1"),
    ("a.mesh", MEDIT, "1 0 0 0", "1 nan 0 0", "line 6", "vertex 2"),
    ("a.mfem", MFEM, "1 0\n0 1\n", "1 -inf\n0 1\n", "line 18", "vertex 1"),
    ("a.avro", AVRO, "1,0,0,0,1,0", "1e999,0,0,0,1,0", "line 2", "coordinate"),
    ("a.off", OFF, "1 0 0", "1 nan 0", "line 4", "vertex 1"),
    ("a.obj", OBJ, "v 1 0 0", "v 1 nan 0", "line 2", "vertex 2"),
    ("a.ply", PLY, "1 0 0", "1 nan 0", "line 11", "vertex 1"),
    ("a.stl", STL, "vertex 1 0 0", "vertex 1 nan 0", "line 5", "facet 0"),
    ("a.node", NODE, "1 1 0", "1 nan 0", "line 3", "point 1"),
]

OUT_OF_RANGE = [
    ("a.msh", MSH, "6 2 2 5 1 1 3 4", "6 2 2 5 1 1 3 5", "line", "element 6", "5"),
    ("a.msh", MSH4, "1 1 2 3\n", f"1 1 2 {HUGE}\n", "line", "element 1", str(HUGE)),
    ("a.vtu", VTU, ">0 1 2<", ">0 1 3<", "cell 0"),
    ("a.vtu", VTU, ">0 1 2<", ">0 -1 2<", "cell 0"),
    ("a.vtk", VTK, "3 0 1 2", "3 0 1 3", "line 8", "cell 0", "point 3"),
    ("a.mesh", MEDIT, "1 2 3 5", "1 2 4 5", "line 10", "Triangles number 1", "vertex 4"),
    ("a.mfem", MFEM, "1 2 0 1 2", "1 2 0 1 3", "line", "element 0", "vertex 3"),
    ("a.avro", AVRO, "[0,1,2]", "[0,1,3]", "line 3", "element 0", "vertex 3"),
    ("a.off", OFF, "3 0 1 2", "3 0 1 3", "line 6", "face 0", "vertex 3"),
    ("a.obj", OBJ, "f 1 2 3", "f 1 2 4", "line 4", "face 1", "vertex 4"),
    ("a.ply", PLY, "3 0 1 2", "3 0 1 3", "line 13", "face 0"),
    ("a.ele", ELE, "0 0 1 2", "0 0 1 3", "a.ele", "line 2", "cell 0", "point 3"),
]

WHOLE = {"a.msh": MSH, "a.vtu": VTU, "a.vtk": VTK, "a.mesh": MEDIT, "a.mfem": MFEM, "a.avro": AVRO, "a.off": OFF,
         "a.obj": OBJ, "a.ply": PLY, "a.stl": STL, "a.ele": ELE}


class Formats(ProgramTest):
    """What is wrong in a file of any format is refused with its place, and in memory that goes with its size."""

    def setUp(self):
        super().setUp()
        self.put("a.node", NODE)  # beside the .ele and .face
        self.least = self.peak("--help")[1]

    def put(self, name, text):
        path = self.dir / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode("latin-1"))
        return path

    def peak(self, *arguments):
        """Exit code, peak memory in bytes and messages."""
        child = harness.subprocess.Popen([harness.PROGRAM, *map(str, arguments)], stdout=harness.subprocess.DEVNULL,
                                         stderr=harness.subprocess.PIPE)
        messages = child.stderr.read().decode(errors="replace")
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        child.stderr.close()
        return child.returncode, 1024 * usage.ru_maxrss, messages

    def refused_file(self, name, data, *words):
        path = self.put(name, data)
        code, peak, messages = self.peak("info", path)
        self.assertEqual(code, INPUT, messages)
        self.assertIn(str(self.dir), messages)
        for word in words:
            self.assertIn(word, messages)
        self.assertLess(len(messages), 1000)
        self.assertLess(peak, self.least + 50 * 2**20 + 100 * path.stat().st_size)

    def refused_each(self, table):
        for name, text, before, after, *words in table:
            with self.subTest(name, before=before, after=after[:30]):
                self.skip_if_left_out(name)
                self.assertIn(before, text)
                self.put("a.node", NODE)
                self.refused_file(name, text.replace(before, after, 1), *words)

    def test_the_files_themselves_are_good(self):
        for name, text in WHOLE.items():
            with self.subTest(name):
                self.skip_if_left_out(name)
                self.assertEqual(slabhull("info", self.put(name, text)).code, 0)

    def test_counts_that_no_file_could_hold(self):
        self.refused_each(CLAIMS)

    def test_coordinates_that_are_no_finite_numbers(self):
        self.refused_each(NOT_A_NUMBER)

    def test_indices_out_of_range(self):
        self.refused_each(OUT_OF_RANGE)

    def test_torn_files(self):
        for name, text in WHOLE.items():
            with self.subTest(name):
                self.skip_if_left_out(name)
                self.refused_file(name, text[:len(text) // 2])
                self.refused_file(name, "")

    def test_huge_strings(self):
        """Words, names and lines of megabytes are refused with short messages, or are names like others."""
        long = "x" * (4 << 20)
        for name, text, before, after in (
                ("a.msh", MSH, "2.2 0 8", long), ("a.msh", MSH, "$Nodes", "$" + long), ("a.vtu", VTU, "Float64", long),
                ("a.vtu", VTU, "UnstructuredGrid", long), ("a.vtk", VTK, "double", long), ("a.vtk", VTK, "CELLS", long),
                ("a.mesh", MEDIT, "Triangles", long), ("a.mfem", MFEM, "elements", long), ("a.avro", AVRO, "dim", long),
                ("a.off", OFF, "OFF", long), ("a.obj", OBJ, "f 1", "f " + long), ("a.ply", PLY, "double", long),
                ("a.stl", STL, "facet", long), ("a.stl", STL, "endloop", long), ("a.node", NODE, "1 1 0", "1 1 " + long)):
            with self.subTest(name, before=before):
                self.skip_if_left_out(name)
                self.refused_file(name, text.replace(before, after, 1))

    def test_deep_nesting(self):
        deep = 500_000
        self.refused_file("a.vtu", "<a>" * deep)
        self.refused_file("a.vtu", "<VTKFile>" + "<a>" * deep + "</a>" * deep + "</VTKFile>")
        self.skip_if_left_out("a.avro")
        self.refused_file("a.avro", '{"a":' + "[" * deep)
        self.refused_file("a.avro", '{"a":' + "[" * deep + "]" * deep + "}")

    def test_packed_data_that_hold_more_than_they_may(self):
        """Of 64 MiB in 64 KiB not more is unpacked than the XML has a place for."""
        bomb = zlib.compress(bytes(64 << 20))
        words = struct.pack("<4Q", 1, 64 << 20, 0, len(bomb))
        for text in (VTU, VTU.replace('NumberOfPoints="3"', f'NumberOfPoints="{HUGE}"')):
            head, tail = text.replace("<VTKFile", '<VTKFile compressor="vtkZLibDataCompressor"').encode("latin-1").split(b"_\x18")
            self.refused_file("a.vtu", head + b"_" + words + bomb + tail[31:])
        lz4 = b"\x1f\0\1\0" + b"\xff" * (256 << 10) + b"\0\x50" + bytes(5)
        words = struct.pack("<4Q", 1, 64 << 20, 0, len(lz4))
        head, tail = VTU.replace("<VTKFile", '<VTKFile compressor="vtkLZ4DataCompressor"').encode("latin-1").split(b"_\x18")
        self.refused_file("a.vtu", head + b"_" + words + lz4 + tail[31:], '"t"')


class Output(ProgramTest):
    def test_a_disk_that_fills_up_loses_nothing_that_was_there(self):
        out, _ = self.build(self.case(CIRCLE))
        before = {p.name: p.read_bytes() for p in out.iterdir()}
        limited = harness.subprocess.run(
            ["bash", "-c", 'ulimit -f 100; exec "$@"', "-", harness.PROGRAM, "build", str(self.case(CIRCLE)),
             "--out", str(out)], capture_output=True, text=True)
        self.assertEqual(limited.returncode, OUTPUT, limited.stderr)
        self.assertEqual({p.name: p.read_bytes() for p in out.iterdir()}, before)


if __name__ == "__main__":
    harness.main()
