# SPDX-License-Identifier: BSD-3-Clause
"""Bad input of every kind gets a message and the documented exit code, and leaves no file behind."""
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


def octahedron(centre=(0, 0, 0), radius=0.5, drop=0):
    """An OFF octahedron; `drop` leaves out so many of its facets."""
    x, y, z = centre
    r = radius
    points = [(x + r, y, z), (x - r, y, z), (x, y + r, z), (x, y - r, z), (x, y, z + r), (x, y, z - r)]
    facets = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    facets = facets[drop:]
    lines = ["OFF", f"{len(points)} {len(facets)} 0"]
    lines += [" ".join(map(str, p)) for p in points] + ["3 " + " ".join(map(str, f)) for f in facets]
    return "\n".join(lines) + "\n"


def solid(*bodies, motion="", box=BOX):
    surfaces = ", ".join(f'{{ file = "{b}.off", patch = "{b}" }}' for b in bodies)
    return f"dimension = 3\n[initial]\nsurfaces = [ {surfaces} ]\n{box}\n{motion}"


class CaseFiles(ProgramTest):
    def test_a_case_file_that_is_not_there(self):
        self.refused(self.dir / "none.toml", INPUT, "none.toml")

    def test_an_empty_case_file(self):
        self.refused(self.case(""), USAGE, "initial")

    def test_a_file_that_is_not_toml(self):
        self.refused(self.case("dimension = = 3\n"), USAGE, "line 1")

    def test_an_unknown_key_names_its_line_and_the_nearest_known_one(self):
        self.refused(self.case(CIRCLE + "[cap]\nsiize = 0.3\n"), USAGE, "line 6", "cap.siize", "cap.size")

    def test_an_unknown_table(self):
        self.refused(self.case(CIRCLE + "[trajectry]\nsubsteps = 3\n"), USAGE, "trajectry", "trajectory")

    def test_values_out_of_range_or_of_the_wrong_kind(self):
        for text, word in [
            ("[time]\nlayers = 0\n", "time.layers"),
            ("[time]\nlayers = 2.5\n", "time.layers"),
            ("[time]\nstart = 1\nend = 1\n", "time.end"),
            ("[time]\nlayers = 2\nspacing = 0.1\n", "time.spacing"),
            ("[time]\nend = inf\n", "time.end"),
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
            ("[output]\nformats = [\"xyz\"]\n", "output.formats"),
        ]:
            with self.subTest(text):
                self.refused(self.case(CIRCLE + text), USAGE, word, "line")

    def test_an_experiment_or_level_that_there_is_not(self):
        self.refused(self.case('[initial]\nexperiment = "square"\n'), USAGE, "tandem-ellipsoids")
        self.refused(self.case('[initial]\nexperiment = "circle"\nlevel = 99\n'), USAGE, "levels 1 to")

    def test_the_motion_of_a_patch_that_there_is_not(self):
        motion = '[motion.rotor]\nkind = "translation"\nvelocity = [1, 0]\n'
        self.refused(self.case(CIRCLE + motion), USAGE, "rotor", "body", "walls")

    def test_a_formula_that_is_none(self):
        motion = '[motion.body]\nkind = "velocity"\nformula = ["y +* 2", "x"]\n'
        self.refused(self.case(CIRCLE + motion), USAGE, "y +* 2")

    def test_wrong_arguments(self):
        for arguments in [[], ["build"], ["bild", "x"], ["build", "x.toml", "--thread", "2"], ["check"]]:
            with self.subTest(arguments):
                self.assertEqual(slabhull(*arguments).code, USAGE)


class Surfaces(ProgramTest):
    def write(self, name, text):
        (self.dir / name).write_text(text)

    def test_a_surface_that_is_not_there(self):
        self.refused(self.case(solid("body")), INPUT, "body.off")

    def test_an_empty_surface_file(self):
        self.write("body.off", "")
        self.refused(self.case(solid("body")), INPUT, "body.off")

    def test_an_open_surface(self):
        self.write("body.off", octahedron(drop=1))
        self.refused(self.case(solid("body")), INPUT, "body.off")

    def test_a_surface_with_an_edge_in_three_facets(self):
        text = octahedron().replace("6 8 0", "6 9 0") + "3 0 2 3\n"
        self.write("body.off", text)
        self.refused(self.case(solid("body")), INPUT, "body.off")

    def test_a_coordinate_that_is_no_number(self):
        self.write("body.off", octahedron().replace("0.5 0 0", "nan 0 0"))
        self.refused(self.case(solid("body")), INPUT, "body.off")

    def test_two_bodies_that_cross(self):
        self.write("a.off", octahedron())
        self.write("b.off", octahedron(centre=(0.4, 0.05, 0.03)))
        self.refused(self.case(solid("a", "b")), INPUT, "cross")

    def test_a_body_outside_the_box(self):
        self.write("a.off", octahedron(centre=(5, 0, 0)))
        self.refused(self.case(solid("a")), INPUT, "a")

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

    def test_motions_that_disagree_on_shared_vertices(self):
        (self.dir / "square.msh").write_text(SPLIT_SQUARE)
        for velocity, code in (("[0.1, 0]", GEOMETRY), ("[0, 0]", 0)):
            case = self.case('dimension = 2\n[initial]\nmesh = "square.msh"\n'
                             f'[motion.left]\nkind = "translation"\nvelocity = {velocity}\n')
            if code:
                self.refused(case, code, "left", "right", "share 2 vertices")
            else:
                self.build(case)


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

    def test_an_inverted_cell_is_named_by_its_tag(self):
        self.refused(self.mesh(SPLIT_SQUARE.replace("5 2 2 5 1 1 2 3", "5 2 2 5 1 2 1 3")), INPUT, "inverted", "square.msh")

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

    def test_the_wrong_dimension(self):
        case = self.case('dimension = 3\n[initial]\nmesh = "square.msh"\n')
        (self.dir / "square.msh").write_text(SPLIT_SQUARE)
        self.refused(case, INPUT, "tetrahedra")


class Output(ProgramTest):
    def test_a_directory_that_cannot_be_made(self):
        (self.dir / "file").write_text("")
        result = slabhull("build", self.case(CIRCLE), "--out", self.dir / "file" / "out")
        self.assertEqual(result.code, OUTPUT)
        self.assertIn("file/out", result.err)

    def test_a_disk_that_fills_up_loses_nothing_that_was_there(self):
        out, _ = self.build(self.case(CIRCLE))
        before = {p.name: p.read_bytes() for p in out.iterdir()}
        limited = harness.subprocess.run(
            ["bash", "-c", 'ulimit -f 100; exec "$@"', "-", harness.PROGRAM, "build", str(self.case(CIRCLE)),
             "--out", str(out)], capture_output=True, text=True)
        self.assertEqual(limited.returncode, OUTPUT, limited.stderr)
        self.assertEqual({p.name: p.read_bytes() for p in out.iterdir()}, before)

    def test_check_of_a_file_that_is_no_mesh(self):
        path = self.dir / "x.vtu"
        path.write_text("no mesh")
        self.assertEqual(slabhull("check", path).code, INPUT)


if __name__ == "__main__":
    harness.main()
