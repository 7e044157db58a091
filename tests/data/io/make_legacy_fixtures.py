#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the legacy VTK files of this folder with VTK and meshio, from the mesh in meshio_base64.vtu and the triangles
in triangles.vtu. Run it again only to add a variant."""
import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk


def read(name):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()


def add(attributes, name, values, kind=None):
    array = numpy_to_vtk(np.asarray(values), deep=True, array_type=kind)
    array.SetName(name)
    attributes.AddArray(array)
    return array


def dressed_grid():
    """With attributes of several kinds, a text array, metadata and a name with a blank."""
    grid = read("meshio_base64.vtu")
    points, cells = grid.GetPointData(), grid.GetCellData()
    count = grid.GetNumberOfPoints()
    points.SetScalars(points.GetArray("x"))
    points.SetVectors(points.GetArray("v"))
    add(points, "long ids", 10**12 + np.arange(count), vtk.VTK_LONG_LONG).SetComponentName(0, "an id")
    add(points, "signed", -np.arange(count), vtk.VTK_SIGNED_CHAR if count < 128 else None)
    add(points, "after", 0.5 * np.arange(count, dtype=np.float32))
    cells.SetTensors(add(cells, "tensor", np.ones((grid.GetNumberOfCells(), 9))))
    names = vtk.vtkStringArray()
    names.SetName("patch_name")
    for text in ("in let", "", 100 * "w"):
        names.InsertNextValue(text)
    grid.GetFieldData().AddArray(names)
    return grid


def surface():
    triangles = read("triangles.vtu")
    polygons = vtk.vtkPolyData()
    polygons.SetPoints(triangles.GetPoints())
    polygons.SetPolys(triangles.GetCells())
    return polygons


def write(writer, data, name, version, binary):
    writer.SetInputData(data)
    writer.SetFileName(name)
    writer.SetFileVersion(version)
    writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
    if not writer.Write():
        raise RuntimeError(name)


for version in (42, 51):
    write(vtk.vtkPolyDataWriter(), surface(), f"vtk_poly_{version}.vtk", version, version == 42)
    for encoding in ("ascii", "binary"):
        binary = encoding == "binary"
        write(vtk.vtkUnstructuredGridWriter(), dressed_grid(), f"vtk_{version}_{encoding}.vtk", version, binary)
        dotted = f"{version // 10}.{version % 10}"
        name = f"meshio_{version}_{encoding}.vtk"
        meshio.vtk.write(name, meshio.read("meshio_base64.vtu"), fmt_version=dotted, binary=binary)
