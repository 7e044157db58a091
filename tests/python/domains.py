# SPDX-License-Identifier: BSD-3-Clause
"""Domains from arrays and from files."""
import harness
import numpy
import slabhull
from harness import body_facets, grid


class Domains(harness.PythonTest):
    def test_arrays_become_a_domain_of_their_dimension(self):
        for dimension in (2, 3):
            domain = harness.domain(dimension)
            self.assertEqual(domain.dimension, dimension)
            self.assertEqual(domain.mesh.patches, {1: "body", 2: "boundary"})
            self.assertTrue(slabhull.check(domain.mesh).clean)

    def test_facets_with_numbers_are_the_same_as_facets_by_name(self):
        points, cells = grid(3, 2)
        facets = body_facets(points, cells, 3)
        by_number = slabhull.Domain(points, cells, facets, numpy.full(len(facets), 7), {7: "body"})
        self.assertEqual(by_number.mesh.patches, {7: "body", 8: "boundary"})
        by_name = slabhull.Domain(points, cells, {"body": facets})
        self.assert_same(by_number.mesh.points, by_name.mesh.points)
        self.assertEqual((by_number.mesh.boundary_patch == 7).sum(), (by_name.mesh.boundary_patch == 1).sum())

    def test_any_type_and_layout_of_numbers_will_do(self):
        points, cells = grid(3, 3)
        plain = slabhull.Domain(points, cells)
        for other in (slabhull.Domain(points.tolist(), cells.tolist()),
                      slabhull.Domain(numpy.asfortranarray(points.astype(numpy.float32)), cells.astype(numpy.uint8))):
            self.assert_same(plain.mesh.points, other.mesh.points)
            self.assert_same(plain.mesh.cells, other.mesh.cells)

    def test_the_callers_arrays_are_copied(self):
        points, cells = grid(3, 2)
        domain = slabhull.Domain(points, cells)
        before = domain.mesh.points.copy()
        points[:] = 0
        self.assert_same(domain.mesh.points, before)

    def test_wrong_arrays_are_named(self):
        points, cells = grid(3, 2)
        for words, arguments in [
                ("points: expected an array with two axes", (points.ravel(), cells)),
                ("2 or 3, not 4", (numpy.zeros((5, 4)), cells)),
                (r"cells: expected an array of shape \(n, 3\), not \(96, 2\)|cells: expected an array of shape \(n, 3\)",
                 (points, cells[:, :2])),
                ("cells: expected whole numbers, not float64", (points, cells * 1.0)),
                ("cells: -1 in row 0 is out of range", (points, numpy.array([[-1, 0, 1]]))),
                ("points: expected real numbers, not complex128", (points * 1j, cells)),
                ("points: expected", (object(), cells)),
                ("facet_patch", (points, cells, [[0, 1]]))]:
            with self.subTest(words), self.assertRaisesRegex(slabhull.UsageError, words):
                slabhull.Domain(*arguments)

    def test_what_is_wrong_with_a_mesh_is_in_the_entities(self):
        points, cells = grid(3, 2)
        cells[4] = cells[4][[0, 2, 1]]
        with self.assertRaises(slabhull.InputError) as raised:
            slabhull.Domain(points, cells, where="my mesh")
        self.assertIn("my mesh: ", str(raised.exception))
        self.assertIn(("cell", 4), [(each.kind, each.number) for each in raised.exception.entities])

    def test_a_file_gives_the_domain_that_a_case_gets(self):
        path = harness.ROOT / "examples" / "piston.msh"
        from_file = slabhull.Domain.from_file(path)
        case = slabhull.Case(harness.ROOT / "examples" / "piston.toml")
        self.assert_same(from_file.mesh.points, case.domain().mesh.points)
        self.assertEqual(from_file.mesh.patches, case.domain().mesh.patches)
        self.assert_same(from_file.mesh.cells, slabhull.Domain.from_file(path, dimension=case.dimension).mesh.cells)

    def test_a_missing_file_is_an_input_error(self):
        with self.assertRaisesRegex(slabhull.InputError, "nowhere.msh"):
            slabhull.Domain.from_file(self.dir / "nowhere.msh")


if __name__ == "__main__":
    harness.main()
