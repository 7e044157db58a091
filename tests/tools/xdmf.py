# SPDX-License-Identifier: BSD-3-Clause
"""XDMF through `slabhull convert`, against meshio (with h5py): what it writes and what it reads."""
import importlib.util
import unittest

import harness
from harness import CIRCLE, SPHERE, ROOT, ProgramTest, needs_formats, slabhull

ROOM = ROOT / "examples/room.msh"
HAVE_READERS = all(importlib.util.find_spec(module) for module in ("meshio", "numpy", "h5py"))


@needs_formats("xdmf")
class Xdmf(ProgramTest):
    def setUp(self):
        super().setUp()
        probe = slabhull("convert", ROOM, self.dir / "probe.xdmf")
        if "without it" in probe.err:
            self.assertEqual(probe.code, 2)
            self.assertIn("SLABHULL_HDF5", probe.err)
            self.assertEqual(list(self.dir.iterdir()), [])
            self.skipTest("a build without HDF5")

    def convert(self, source, target):
        result = slabhull("convert", source, self.dir / target)
        self.assertEqual(result.code, 0, result.err)
        return self.dir / target

    def hulls(self):
        for text in (CIRCLE, SPHERE):
            out, _ = self.build(self.case(text))
            yield out / "slab_0000.vtu"

    def test_a_hull_through_xdmf_comes_back_with_the_same_bytes(self):
        for vtu in self.hulls():
            through = self.convert(vtu, "through.xdmf")
            self.assertEqual(self.convert(through, "again.vtu").read_bytes(), vtu.read_bytes())

    def test_a_failed_write_leaves_nothing(self):
        vtu = next(self.hulls())
        (self.dir / "a.h5").mkdir()
        result = slabhull("convert", vtu, self.dir / "a.xdmf")
        self.assertEqual(result.code, 5, result.err)
        self.assertIn("a.h5", result.err)
        self.assertEqual([p.name for p in self.dir.glob("a.x*")], [])

    def test_damage_is_told_with_the_file(self):
        through = self.convert(ROOM, "room.xdmf")
        data = self.dir / "room.h5"
        data.write_bytes(data.read_bytes()[:-1000])
        result = slabhull("info", through)
        self.assertEqual(result.code, 3, result.err)
        self.assertIn("room.h5", result.err)

    @unittest.skipUnless(HAVE_READERS, "no meshio with h5py here")
    def test_meshio_sees_what_we_write(self):
        import meshio
        import numpy as np
        for vtu in self.hulls():
            first, second = meshio.read(vtu), meshio.read(self.convert(vtu, "hull.xdmf"))
            np.testing.assert_array_equal(second.points, first.points)
            np.testing.assert_array_equal(second.cells[0].data, first.cells[0].data)
            self.assertEqual(second.cells[0].type, first.cells[0].type)
            if first.cells[0].type == "tetra":
                np.testing.assert_array_equal(second.point_data.pop("xyzt"),
                                              np.column_stack([first.points, first.point_data["t"]]))
            self.assertEqual(list(second.point_data), list(first.point_data))
            self.assertEqual(list(second.cell_data), list(first.cell_data))
            for name, values in first.point_data.items():
                np.testing.assert_array_equal(second.point_data[name], values, name)
                self.assertEqual(second.point_data[name].dtype, values.dtype)
            for name, values in first.cell_data.items():
                np.testing.assert_array_equal(second.cell_data[name][0], values[0], name)
                self.assertEqual(second.cell_data[name][0].dtype, values[0].dtype)

    def variants(self):
        """Each mesh in each way in which meshio writes it."""
        import meshio
        import numpy as np
        room = meshio.read(ROOM)
        for kinds in (["line"], ["triangle"], ["tetra"], ["triangle", "tetra"]):
            cells = [(kind, room.get_cells_type(kind)) for kind in kinds if kind != "line"]
            cells = cells or [("line", np.unique(room.get_cells_type("triangle")[:, :2], axis=0))]
            count = sum(len(rows) for _, rows in cells)
            rows = np.split(np.arange(count) ** 2 + 2**60, [len(cells[0][1])])[:len(cells)]
            for single in (np.float64, np.float32):
                mesh = meshio.Mesh(room.points.astype(single), cells,
                                   point_data={"x": room.points[:, 0], "v": 2 * room.points},
                                   cell_data={"number": rows})
                for name, options in (("xml", {"data_format": "XML"}), ("binary", {"data_format": "Binary"}),
                                      ("gzip", {}), ("plain", {"compression": None})):
                    path = self.dir / f"{name}_{'_'.join(kinds)}_{single.__name__}.xdmf"
                    meshio.xdmf.write(str(path), mesh, **options)
                    yield path, mesh, kinds[-1]

    @unittest.skipUnless(HAVE_READERS, "no meshio with h5py here")
    def test_we_see_what_meshio_writes_in_each_variant(self):
        import meshio
        import numpy as np
        seen = 0
        for path, mesh, kind in self.variants():
            ours = meshio.read(self.convert(path, "ours.vtu"))
            exact = "xml" not in path.name or mesh.points.dtype == np.float64  # it prints 8 digits of single ones
            np.testing.assert_allclose(ours.points, mesh.points, rtol=0 if exact else 1e-7, atol=0)
            np.testing.assert_array_equal(ours.get_cells_type(kind), mesh.get_cells_type(kind))
            np.testing.assert_array_equal(ours.point_data["x"], mesh.point_data["x"])
            np.testing.assert_array_equal(ours.point_data["v"], mesh.point_data["v"])
            np.testing.assert_array_equal(ours.get_cell_data("number", kind), mesh.get_cell_data("number", kind))
            seen += 1
        self.assertEqual(seen, 32)


if __name__ == "__main__":
    harness.main()
