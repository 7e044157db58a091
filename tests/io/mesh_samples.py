# SPDX-License-Identifier: BSD-3-Clause
"""Writes meshes by VTK, meshio and Gmsh in every variant that they offer: mesh_samples.py DIRECTORY.

vtu/*.vtu all hold the mesh whose numbers stand beside them as numpy left them: vtu/NAME.f64 and vtu/NAME.i64, 64-bit
values in the machine's byte order. pieces/*.vtu hold it in parts, whose points and cells come in another order.
msh/*.msh all hold the same ball of tetrahedra, in group 7, its surface in group 3; numbers beside them again. The
big-endian ones are turned by us; Gmsh reads them."""
import itertools
import struct
import sys
from pathlib import Path

try:
    import gmsh
    import meshio
    import numpy as np
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
except ImportError as missing:
    print(f"{missing}: no mesh samples")
    raise SystemExit(77)

POINTS, CELLS = 700, 1500
INTEGERS = ("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64")


class Mesh:
    def __init__(self):
        random = np.random.default_rng(5)
        self.points = random.normal(size=(POINTS, 3)) * 10.0 ** random.integers(-9, 9, (POINTS, 3))
        self.cells = np.array([random.choice(POINTS, 4, replace=False) for _ in range(CELLS)], dtype=np.int64)
        self.point_data = {name: random.integers(np.iinfo(name).min, np.iinfo(name).max, POINTS, dtype=name)
                           for name in INTEGERS[:-1]}
        self.point_data["uint64"] = random.integers(0, 2**62, POINTS, dtype="uint64")
        self.point_data["float64"] = random.normal(size=(POINTS, 3))
        self.cell_data = {"float32": random.normal(size=CELLS).astype(np.float32),
                          "constant": np.full(CELLS, 7, dtype=np.int32)}

    def save_numbers(self, directory):
        self.points.tofile(directory / "points.f64")
        self.cells.tofile(directory / "cells.i64")
        for name, values in (self.point_data | self.cell_data).items():
            real = values.dtype.kind == "f"
            values.astype(np.float64 if real else np.int64).tofile(directory / f"{name}.{'f64' if real else 'i64'}")

    def vtk_grid(self):
        return vtk_grid(vtk.VTK_TETRA, self.points, self.cells, self.point_data, self.cell_data)


def vtk_grid(cell_type, points, cells, point_data, cell_data):
    """With an array of strings over the whole grid, too."""
    grid = vtk.vtkUnstructuredGrid()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(places)
    flat = np.hstack([np.full((len(cells), 1), cells.shape[1]), cells]).astype(np.int64).ravel()
    array = vtk.vtkCellArray()
    array.SetCells(len(cells), numpy_to_vtkIdTypeArray(flat, deep=True))
    grid.SetCells(cell_type, array)
    for data, attributes in ((point_data, grid.GetPointData()), (cell_data, grid.GetCellData())):
        for name, values in data.items():
            column = numpy_to_vtk(values, deep=True)
            column.SetName(name)
            attributes.AddArray(column)
    names = vtk.vtkStringArray()
    names.SetName("names")
    for name in ("in let", "", "walls"):
        names.InsertNextValue(name)
    grid.GetFieldData().AddArray(names)
    return grid


MODES = {
    "ascii": lambda w: w.SetDataModeToAscii(),
    "inline": lambda w: w.SetDataModeToBinary(),
    "base64": lambda w: (w.SetDataModeToAppended(), w.EncodeAppendedDataOn()),
    "raw": lambda w: (w.SetDataModeToAppended(), w.EncodeAppendedDataOff()),
}
COMPRESSORS = {
    "plain": lambda w: w.SetCompressorTypeToNone(),
    "zlib": lambda w: w.SetCompressorTypeToZLib(),
    "lz4": lambda w: w.SetCompressorTypeToLZ4(),
}
WORDS = {"32": lambda w: w.SetHeaderTypeToUInt32(), "64": lambda w: w.SetHeaderTypeToUInt64()}
ORDERS = {"little": lambda w: w.SetByteOrderToLittleEndian(), "big": lambda w: w.SetByteOrderToBigEndian()}


def vtk_writer(path, choices):
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetBlockSize(4096)  # several blocks, the last one shorter
    for choose in choices:
        choose(writer)
    return writer


def write_by_vtk(directory, mesh):
    grid = mesh.vtk_grid()
    for names in itertools.product(MODES, COMPRESSORS, WORDS, ORDERS):
        choices = [table[name] for table, name in zip((MODES, COMPRESSORS, WORDS, ORDERS), names)]
        writer = vtk_writer(directory / f"vtk_{'_'.join(names)}.vtu", choices)
        writer.SetInputData(grid)
        assert writer.Write() == 1


def write_pieces(directory, mesh):
    extract = vtk.vtkExtractUnstructuredGridPiece()
    extract.SetInputData(mesh.vtk_grid())
    extract.CreateGhostCellsOff()
    for mode, compressor in (("ascii", "plain"), ("inline", "zlib"), ("base64", "lz4"), ("raw", "plain"), ("raw", "lz4")):
        writer = vtk_writer(directory / f"{mode}_{compressor}.vtu", (MODES[mode], COMPRESSORS[compressor]))
        writer.SetInputConnection(extract.GetOutputPort())
        writer.SetNumberOfPieces(3)
        assert writer.Write() == 1
        assert (directory / f"{mode}_{compressor}.vtu").read_bytes().count(b"<Piece ") == 3


def write_by_meshio(directory, mesh):
    plain = meshio.Mesh(mesh.points, [("tetra", mesh.cells)], point_data=mesh.point_data,
                        cell_data={name: [values] for name, values in mesh.cell_data.items()})
    meshio.write(directory / "meshio_ascii.vtu", plain, binary=False)
    meshio.write(directory / "meshio_plain.vtu", plain, compression=None)
    meshio.write(directory / "meshio_zlib.vtu", plain, compression="zlib")
    for header in ("UInt32", "UInt64"):
        meshio.write(directory / f"meshio_zlib_{header}.vtu", plain, compression="zlib", header_type=header)


def ball():
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.6)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
    gmsh.model.add("ball")
    gmsh.model.occ.addSphere(0, 0, 0, 1)
    gmsh.model.occ.synchronize()
    name_groups(1, 1)
    gmsh.model.mesh.generate(3)


def name_groups(surface, volume):
    for dimension, entity, number, name in ((2, surface, 3, "skin"), (3, volume, 7, "ball")):
        gmsh.model.addPhysicalGroup(dimension, [entity], number)
        gmsh.model.setPhysicalName(dimension, number, name)


def gmsh_numbers():
    """Coordinates, triangles and tetrahedra, nodes counted from 0 by their tags; for triangles and tetrahedra as many."""
    tags, points, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tags)
    simplices = [np.searchsorted(tags[order], gmsh.model.mesh.getElementsByType(kind)[1]) for kind in (2, 4)]
    return np.reshape(points, (-1, 3))[order], *(np.asarray(s, dtype=np.int64) for s in simplices)


def saved_by_gmsh(directory, name, **options):
    """As both versions, as text and binary; goes through the binary ones."""
    for option, value in options.items():
        gmsh.option.setNumber(f"Mesh.{option}", value)
    for version in (2.2, 4.1):
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        for binary in (0, 1):
            gmsh.option.setNumber("Mesh.Binary", binary)
            path = directory / f"{name}_{version}_{'binary' if binary else 'ascii'}.msh"
            gmsh.write(str(path))
        yield path
    for option in options:
        gmsh.option.setNumber(f"Mesh.{option}", 0)


def write_turned(path):
    """The same in the opposite byte order; returns the path."""
    big = path.with_name(path.name.replace("_binary.msh", "_big.msh"))
    big.write_bytes(Turned(path.read_bytes()).out)
    return big


def save_gmsh(directory, name, **options):
    """As both versions, as text and binary in both byte orders."""
    for path in saved_by_gmsh(directory, name, **options):
        big = write_turned(path)
        counts = count_by_gmsh(path)
        assert counts[0] > 0
        # Gmsh 4.8 stumbles over partitioned entities in the opposite byte order
        assert b"$PartitionedEntities" in big.read_bytes() or count_by_gmsh(big) == counts


def count_by_gmsh(path):
    current = gmsh.model.getCurrent()
    gmsh.open(str(path))
    result = len(gmsh.model.mesh.getNodes()[0]), len(gmsh.model.mesh.getElementsByType(4)[0])
    gmsh.model.remove()
    gmsh.model.setCurrent(current)
    return result


class Turned:
    """A binary MSH file of a little-endian machine in the opposite byte order: `out`."""

    def __init__(self, data):
        self.data, self.at, self.out = data, 0, b""
        while self.at < len(data):
            name = self.line().strip().decode()
            turn = getattr(self, f"{name[1:].lower()}_{'2' if self.data[12:13] == b'2' else '4'}", None)
            if turn:
                turn()
            end = self.data.index(b"$End" + name[1:].encode(), self.at)
            assert not turn or end - self.at <= 1
            self.out += self.data[self.at : end]
            self.at = end
            self.line()

    def line(self):
        end = self.data.index(b"\n", self.at) + 1
        text = self.data[self.at : end]
        self.out += text
        self.at = end
        return text

    def turn(self, kind, count=1):
        values = struct.unpack_from(f"<{count}{kind}", self.data, self.at)
        self.out += struct.pack(f">{count}{kind}", *values)
        self.at += struct.calcsize(f"<{count}{kind}")
        return values if count > 1 else values[0] if values else 0

    def meshformat_4(self):
        self.line()
        self.turn("i")

    meshformat_2 = meshformat_4

    def entities_4(self, partitioned=False):
        for dimension, count in enumerate(self.turn("Q", 4)):
            for _ in range(count):
                self.turn("i", 3 if partitioned else 1)
                if partitioned:
                    self.turn("i", self.turn("Q"))
                self.turn("d", 6 if dimension else 3)
                self.turn("i", self.turn("Q"))
                if dimension:
                    self.turn("i", self.turn("Q"))

    def partitionedentities_4(self):
        self.turn("Q")
        self.turn("i", 2 * self.turn("Q"))
        self.entities_4(True)

    def nodes_4(self):
        for _ in range(self.turn("Q", 4)[0]):
            dimension, _, parametric = self.turn("i", 3)
            count = self.turn("Q")
            self.turn("Q", count)
            self.turn("d", count * (3 + dimension * parametric))

    def elements_4(self):
        for _ in range(self.turn("Q", 4)[0]):
            kind = self.turn("i", 3)[2]
            self.turn("Q", self.turn("Q") * (1 + {15: 1, 1: 2, 2: 3, 4: 4}[kind]))

    def ghostelements_4(self):
        for _ in range(self.turn("Q")):
            self.turn("Q")
            self.turn("i")
            self.turn("i", self.turn("Q"))

    def nodes_2(self, parametric=False):
        for _ in range(int(self.line())):
            self.turn("i")
            self.turn("d", 3)
            if parametric:
                self.turn("d", self.turn("i", 2)[0] % 3)

    def parametricnodes_2(self):
        self.nodes_2(True)

    def elements_2(self):
        left = int(self.line())
        while left > 0:
            kind, count, tags = self.turn("i", 3)
            self.turn("i", count * (1 + tags + {15: 1, 1: 2, 2: 3, 4: 4}[kind]))
            left -= count


def with_gaps():
    """The ball once more, with few of the numbers in use and a very large one."""
    points, triangles, tetrahedra = gmsh_numbers()
    tags = 7 * np.arange(len(points)) ** 2 + 3
    tags[-1] = 2_000_000_000
    gmsh.model.add("gaps")
    surface, volume = gmsh.model.addDiscreteEntity(2), gmsh.model.addDiscreteEntity(3)
    gmsh.model.mesh.addNodes(3, volume, tags, points.ravel())
    gmsh.model.mesh.addElementsByType(surface, 2, 5 * np.arange(len(triangles) // 3) + 11, tags[triangles])
    gmsh.model.mesh.addElementsByType(volume, 4, 9 * np.arange(len(tetrahedra) // 4) + 1_000_000, tags[tetrahedra])
    name_groups(surface, volume)


def write_by_gmsh(directory):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    ball()
    for name, values in zip(("points.f64", "triangles.i64", "tetrahedra.i64"), gmsh_numbers()):
        values.tofile(directory / name)
    save_gmsh(directory, "plain")
    save_gmsh(directory, "parametric", SaveParametric=1)
    with_gaps()
    save_gmsh(directory, "gaps")
    gmsh.model.setCurrent("ball")
    gmsh.model.mesh.partition(3)
    save_gmsh(directory, "partitioned")
    gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", 1)
    gmsh.model.mesh.partition(4)
    save_gmsh(directory, "ghosts")
    gmsh.finalize()


def main():
    top = Path(sys.argv[1])
    mesh = Mesh()
    for name in ("vtu", "pieces", "msh"):
        (top / name).mkdir(parents=True, exist_ok=True)
    mesh.save_numbers(top / "vtu")
    write_by_vtk(top / "vtu", mesh)
    write_by_meshio(top / "vtu", mesh)
    write_pieces(top / "pieces", mesh)
    write_by_gmsh(top / "msh")


if __name__ == "__main__":
    main()
