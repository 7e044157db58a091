#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""independent_readers.py A.vtu A.msh ...: opens each file with VTK, meshio and Gmsh, whichever know its format, and
compares what they see: counts, bounds, and the sums of coordinates, connectivity and data arrays. All files given are
the same mesh. Prints one line per file and reader.

Exit code 0: all agree; 1: they differ, or a reader fails; 77: a reader is not installed.
"""
import sys

try:
    import gmsh
    import meshio
    import numpy as np
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)


def summary(points, cells, data):
    points = np.asarray(points, dtype=float).reshape(-1, 3)
    cells = np.asarray(cells, dtype=np.int64)
    weights = np.arange(1, cells.size + 1).reshape(cells.shape) % 1009  # so that order matters
    return {
        "points": len(points),
        "cells": len(cells),
        "corners": cells.shape[1],
        "min": points.min(axis=0),
        "max": points.max(axis=0),
        "coordinates": (points * (1 + np.arange(points.size).reshape(points.shape) % 1009)).sum(),
        "connectivity": int((cells * weights).sum()),
        "data": {name: float(np.asarray(values, dtype=float).sum()) for name, values in sorted(data.items())},
    }


def split_components(data):
    """Like the MSH files, which hold each component under a name of its own."""
    flat = {}
    for name, values in data.items():
        values = np.asarray(values)
        if values.ndim == 2 and values.shape[1] > 1:
            flat.update({f"{name}_{k}": values[:, k] for k in range(values.shape[1])})
        else:
            flat[name] = values
    return flat


def by_vtk(path):
    failures = []
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.AddObserver("ErrorEvent", lambda *_: failures.append("error event"))
    reader.SetFileName(path)
    reader.Update()
    if failures or reader.GetErrorCode():
        raise RuntimeError("VTK cannot read it")
    grid = reader.GetOutput()
    corners = grid.GetCell(0).GetNumberOfPoints()
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, corners)
    data = {}
    for attributes in (grid.GetPointData(), grid.GetCellData()):
        for i in range(attributes.GetNumberOfArrays()):
            data[attributes.GetArrayName(i)] = vtk_to_numpy(attributes.GetArray(i))
    return summary(vtk_to_numpy(grid.GetPoints().GetData()), cells, split_components(data))


def by_meshio(path):
    mesh = meshio.read(path)
    cells = np.concatenate([block.data for block in mesh.cells])
    data = dict(mesh.point_data)
    data.update({name: np.concatenate(blocks) for name, blocks in mesh.cell_data.items()})
    ours = {name: values for name, values in data.items() if not name.startswith("gmsh:")}
    return summary(mesh.points, cells, split_components(ours))


def by_gmsh(path):
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.logger.start()
        gmsh.open(path)
        complaints = [line for line in gmsh.logger.get() if line.startswith(("Error", "Warning"))]
        if complaints:
            raise RuntimeError(f"Gmsh says: {complaints}")
        dimension = gmsh.model.getDimension()
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        order = np.argsort(tags)
        points = np.asarray(coordinates).reshape(-1, 3)[order]
        element_tags, corners = gmsh.model.mesh.getElementsByType({1: 1, 2: 2, 3: 4}[dimension])
        cells = np.asarray(corners, dtype=np.int64).reshape(-1, dimension + 1)[np.argsort(element_tags)] - 1
        for _, number in gmsh.model.getPhysicalGroups(dimension):
            if not gmsh.model.getPhysicalName(dimension, number):
                raise RuntimeError(f"physical group {number} has no name")
        return summary(points, cells, dict(gmsh_view(tag) for tag in gmsh.view.getTags()))
    finally:
        gmsh.logger.stop()
        gmsh.finalize()


def gmsh_view(tag):
    _, _, values, _, _ = gmsh.view.getModelData(tag, 0)
    index = gmsh.view.getIndex(tag)
    return gmsh.option.getString(f"View[{index}].Name"), np.concatenate(values)


def differences(a, b):
    for key in a:
        if key != "data":
            if not np.array_equal(a[key], b[key]):
                yield f"{key}: {a[key]} and {b[key]}"
    for name in sorted(set(a["data"]) ^ set(b["data"])):
        yield f"only one has the array {name}"
    for name in set(a["data"]) & set(b["data"]):
        if not np.isclose(a["data"][name], b["data"][name], rtol=1e-12, atol=1e-9):
            yield f"array {name}: {a['data'][name]} and {b['data'][name]}"


def readers_of(path):
    if not path.endswith(".vtu"):
        return by_gmsh, by_meshio
    return (by_vtk,) if path.endswith("_lz4.vtu") else (by_vtk, by_meshio)  # meshio knows no LZ4


def main(paths):
    first = None
    bad = 0
    for path in paths:
        for reader in readers_of(path):
            name = f"{path} {reader.__name__}"
            try:
                seen = reader(path)
            except Exception as problem:  # whatever a reader throws is a finding
                print(f"{name}: FAILED: {problem!r}")
                bad += 1
                continue
            print(f"{name}: {seen['points']} points, {seen['cells']} cells, {len(seen['data'])} arrays")
            first = first or seen
            for difference in differences(first, seen):
                print(f"  DIFFERS: {difference}")
                bad += 1
    return 1 if bad else 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        print(__doc__)
        sys.exit(2)
    sys.exit(main(sys.argv[1:]))
