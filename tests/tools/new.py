#!/usr/bin/env python3
"""Starting cases for meshes, surfaces and curves; what a run would take."""

import harness
from harness import ProgramTest, main, slabhull

EXAMPLES = harness.ROOT / "examples"


def scaled(source, target, factor):
    """An OFF file with its points scaled."""
    lines = source.read_text().split("\n")
    points = int(lines[1].split()[0])
    for k in range(2, 2 + points):
        lines[k] = " ".join(repr(factor * float(x)) for x in lines[k].split())
    target.write_text("\n".join(lines))


class New(ProgramTest):
    def new(self, *files, name="new.toml"):
        path = self.dir / name
        path.unlink(missing_ok=True)
        result = slabhull("new", *files, "--out", path)
        self.assertEqual(result.code, 0, result.err)
        self.assertIn(f"slabhull build {path}", result.out)
        return path, path.read_text()

    def planned(self, case):
        result = slabhull("build", case, "--dry-run", "--out", self.dir / "out")
        self.assertEqual(result.code, 0, result.err)
        self.assertFalse((self.dir / "out").exists())
        return result.out

    def test_a_curve_gets_a_box_and_the_case_runs_as_it_is(self):
        case, text = self.new(EXAMPLES / "naca0012.dat")
        self.assertIn("dimension = 2", text)
        self.assertIn("box = ", text)
        self.assertRegex(text, r"#   naca0012: \d+ edges, from \[.*\] to \[1, ")
        _, report = self.build(case)
        self.assertEqual(len(report["slabs"]), 4)

    def test_a_body_far_from_the_origin_is_inside_of_its_box(self):
        lines = (EXAMPLES / "sphere.off").read_text().split("\n")
        count = int(lines[1].split()[0])
        for at in (1e6, -5412345.0, 1e9):
            moved = [" ".join(str(float(x) + at) for x in line.split()) for line in lines[2:2 + count]]
            (self.dir / "far.off").write_text("\n".join(lines[:2] + moved + lines[2 + count:]))
            case, _ = self.new(self.dir / "far.off")
            plan = self.planned(case)
            self.assertIn("patch far: ", plan)
            self.assertIn("from t = 0 to 0.25: 1 layer, ", plan)
            untitled = self.case("\n".join(case.read_text().split("\n")[1:]), "untitled.toml")
            self.assertTrue(self.planned(untitled).startswith(f"{untitled}: 3D+t, "))

    def test_a_mesh_keeps_its_patches(self):
        case, text = self.new(EXAMPLES / "piston.msh")
        self.assertIn("mesh = ", text)
        self.assertNotIn("box = ", text)
        for patch in ("head", "piston", "wall"):
            self.assertIn(f"#   {patch}: ", text)
            self.assertIn(f"# [motion.{patch}]", text)
        plan = self.planned(case)
        self.assertIn("patch piston", plan)
        self.assertEqual(plan.count("stands still"), 3)

    def test_a_surface_that_has_the_others_inside_is_the_outer_boundary(self):
        scaled(EXAMPLES / "sphere.off", self.dir / "vessel.off", 3)
        case, text = self.new(EXAMPLES / "sphere.off", self.dir / "vessel.off")
        self.assertIn('outer = { file = "vessel.off"', text)
        self.assertNotIn("box = ", text)
        self.planned(case)
        alone, text = self.new(EXAMPLES / "sphere.off", name="alone.toml")
        self.assertIn("box = ", text)
        self.assertIn("patch walls", self.planned(alone))

    def test_sections_that_are_commented_out_can_be_taken_in(self):
        _, text = self.new(EXAMPLES / "sphere.off")
        lines = [line[2:] if line.startswith("# ") and not line.startswith("# A ") and "(docs" not in line and
                 not line.startswith(("#   ", "# Pat", "# disp")) else line for line in text.split("\n")]
        lines = "\n".join(lines)
        begin, end = lines.index("[project."), lines.index("[trajectory]")  # names a file that is not there
        plan = self.planned(self.case(lines[:begin] + lines[end:].replace('reuse = "none"', 'reuse = "adapt"')))
        self.assertIn("moves", plan)

    def test_files_that_are_no_start_are_refused(self):
        out, _ = self.build(self.case('dimension = 2\n[initial]\nexperiment = "circle"\nlevel = 1\n'))
        for files, code, words in (([out / "slab_0000.vtu"], 3, ["hull"]),
                                   ([EXAMPLES / "piston.msh", EXAMPLES / "sphere.off"], 2, ["piston.msh", "alone"]),
                                   ([EXAMPLES / "naca0012.dat", EXAMPLES / "sphere.off"], 2, ["dimension"]),
                                   ([self.dir / "none.stl"], 3, ["none.stl"])):
            result = slabhull("new", *files, "--out", self.dir / "refused.toml")
            self.assertEqual(result.code, code, result.err)
            for word in words:
                self.assertIn(word, result.err)
            self.assertFalse((self.dir / "refused.toml").exists())

    def test_a_case_that_is_there_is_kept(self):
        case, text = self.new(EXAMPLES / "sphere.off")
        case.write_text("mine")
        result = slabhull("new", EXAMPLES / "sphere.off", "--out", case)
        self.assertEqual(result.code, 2, result.err)
        self.assertEqual(case.read_text(), "mine")

    def test_a_plan_has_the_layers_and_simplices_of_the_run(self):
        case = self.case('[initial]\nexperiment = "ellipsoid"\nlevel = 1\n[time]\nslabs = 2\n'
                         '[output]\nformats = ["vtu"]\n')
        plan = self.planned(case)
        _, report = self.build(case)
        for slab in report["slabs"]:
            self.assertIn(f"{slab['layers']['number']} layers, {slab['cells_by_region']['intermediate']} simplices",
                          plan.split(f"slab {slab['slab']} from")[1])
        caps = report["slabs"][0]["cells_by_region"]["initial"]
        told = float(plan.split("caps of about ")[1].split()[0])
        self.assertLess(max(told / caps, caps / told), 2)
        wrong = self.case('[initial]\nexperiment = "ellipsoid"\nlevel = 1\n[motion.nobody]\nkind = "rotation"\n')
        self.assertNotEqual(slabhull("build", wrong, "--dry-run").code, 0)


if __name__ == "__main__":
    main()
