# SPDX-License-Identifier: BSD-3-Clause
"""Writes one mesh by VTK and meshio in every variant that they offer: mesh_samples.py DIRECTORY.

vtu/*.vtu all hold the mesh whose numbers stand beside them as numpy left them: vtu/NAME.f64 and vtu/NAME.i64, 64-bit
values in the machine's byte order. pieces/*.vtu hold it in parts, whose points and cells come in another order."""
import itertools
import sys
from pathlib import Path

try:
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
        grid = vtk.vtkUnstructuredGrid()
        points = vtk.vtkPoints()
        points.SetData(numpy_to_vtk(self.points, deep=True))
        grid.SetPoints(points)
        flat = np.hstack([np.full((CELLS, 1), 4), self.cells]).astype(np.int64).ravel()
        cells = vtk.vtkCellArray()
        cells.SetCells(CELLS, numpy_to_vtkIdTypeArray(flat, deep=True))
        grid.SetCells(vtk.VTK_TETRA, cells)
        for data, attributes in ((self.point_data, grid.GetPointData()), (self.cell_data, grid.GetCellData())):
            for name, values in data.items():
                array = numpy_to_vtk(values, deep=True)
                array.SetName(name)
                attributes.AddArray(array)
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


def main():
    top = Path(sys.argv[1])
    mesh = Mesh()
    for name in ("vtu", "pieces"):
        (top / name).mkdir(parents=True, exist_ok=True)
    mesh.save_numbers(top / "vtu")
    write_by_vtk(top / "vtu", mesh)
    write_by_meshio(top / "vtu", mesh)
    write_pieces(top / "pieces", mesh)


main()
