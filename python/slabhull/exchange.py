# SPDX-License-Identifier: BSD-3-Clause
"""Meshes for other libraries of Python, where these are installed."""
from typing import Any, Dict, NamedTuple

import numpy

from . import _slabhull
from .errors import UsageError

_MESHIO = {1: "vertex", 2: "line", 3: "triangle", 4: "tetra"}  # by the number of corners
_VTK = {1: 1, 2: 3, 3: 5, 4: 10}


class _Parts(NamedTuple):
    points: numpy.ndarray  # (n, 3)
    cells: numpy.ndarray
    point_data: Dict[str, numpy.ndarray]
    cell_data: Dict[str, numpy.ndarray]


def _in_space(points):
    """Three coordinates; a view where there are three already."""
    if points.shape[1] == 3:
        return points
    return numpy.column_stack([points, numpy.zeros(len(points))])


def _of_hull(hull):
    times = numpy.ascontiguousarray(hull.points[:, -1])
    points = hull.points if hull.dimension == 2 else hull.points[:, :3]
    return _Parts(points, hull.cells, {"t": times, "vertex_id": hull.vertex_ids, "track_id": hull.track_ids},
                  {"region": hull.region, "patch": hull.patch, "layer": hull.layer, "neighbors": hull.neighbors})


def _of_filling(filling):
    if filling.dimension == 3:
        raise UsageError("pentatopes are for GetFEM, MFEM and HDF5: Filling.write(); sections are for others: slice()")
    times = numpy.ascontiguousarray(filling.points[:, -1])
    return _Parts(filling.points, filling.cells,
                  {"t": times, "vertex_id": filling.vertex_ids, "track_id": filling.track_ids}, {})


def _of_section(section):
    return _Parts(_in_space(section.points), section.facets,
                  {"vertex_id": section.vertex_ids, "track_id": section.track_ids},
                  {"patch": section.patch, "cell": section.hull_cell})


def _of_spatial_mesh(mesh):
    return _Parts(_in_space(mesh.points), mesh.cells, {"vertex_id": mesh.vertex_ids, "track_id": mesh.track_ids}, {})


def _of_filling_section(section):
    return _Parts(_in_space(section.points), section.cells, {}, {"cell": section.filling_cell})


def _of_mesh(mesh):
    def numbers(data):
        return {name: values for name, values in data.items() if isinstance(values, numpy.ndarray)}

    cell_data = numbers(mesh.cell_data)
    groups = mesh.simplex_groups(mesh.dimension)
    if groups.any():
        cell_data["group"] = groups
    return _Parts(mesh.points, mesh.cells, numbers(mesh.point_data), cell_data)


_PARTS = {_slabhull.Hull: _of_hull, _slabhull.Filling: _of_filling, _slabhull.Section: _of_section,
          _slabhull.SpatialMesh: _of_spatial_mesh, _slabhull.FillingSection: _of_filling_section,
          _slabhull.Mesh: _of_mesh}


def _parts_of(mesh) -> _Parts:
    try:
        return _PARTS[type(mesh)](mesh)
    except KeyError:
        raise UsageError(f"a {type(mesh).__name__} is no mesh") from None


def to_meshio(mesh) -> Any:
    """A meshio.Mesh. Points and cells are copied only where meshio does so."""
    import meshio

    parts = _parts_of(mesh)
    kind = _MESHIO[parts.cells.shape[1]]
    return meshio.Mesh(parts.points, [(kind, parts.cells)], point_data=parts.point_data,
                       cell_data={name: [values] for name, values in parts.cell_data.items()})


def to_vtk(mesh) -> Any:
    """A vtkUnstructuredGrid with copies of the arrays."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid

    parts = _parts_of(mesh)
    corners = parts.cells.shape[1]
    places = vtkPoints()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(parts.points), deep=True))
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtkIdTypeArray(numpy.arange(0, parts.cells.size + 1, corners, dtype=numpy.int64), deep=True),
                  numpy_to_vtkIdTypeArray(parts.cells.astype(numpy.int64).ravel(), deep=True))
    grid = vtkUnstructuredGrid()
    grid.SetPoints(places)
    grid.SetCells(_VTK[corners], cells)
    for attributes, arrays in ((grid.GetPointData(), parts.point_data), (grid.GetCellData(), parts.cell_data)):
        for name, values in arrays.items():
            array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
            array.SetName(name)
            attributes.AddArray(array)
    return grid
