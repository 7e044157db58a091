#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""legacy_readers.py A.vtu A.vtk: the mesh of a VTU as VTK sees it, and of a legacy VTK file as VTK and meshio see it: the
same points, cells and data, bit for bit. Of tetrahedra also those of A.ele as meshio sees them.

Exit code 0: all agree; 1: they differ, or a reader fails; 77: a reader is not installed.
"""
import sys

import independent_readers  # ends with 77 where a package is missing
import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy


def by_vtk(path):
    kinds = {"vtu": vtk.vtkXMLUnstructuredGridReader, "vtk": vtk.vtkUnstructuredGridReader}
    reader = kinds[path[-3:]]()
    failures = []
    reader.AddObserver("ErrorEvent", lambda *_: failures.append("error event"))
    reader.SetFileName(path)
    if path.endswith("vtk"):
        reader.ReadAllScalarsOn()
        reader.ReadAllFieldsOn()
    reader.Update()
    if failures or reader.GetErrorCode():
        raise RuntimeError("VTK cannot read it")
    grid = reader.GetOutput()
    corners = grid.GetCell(0).GetNumberOfPoints()
    seen = {
        "points": vtk_to_numpy(grid.GetPoints().GetData()),
        "cells": vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, corners),
        "types": vtk_to_numpy(grid.GetCellTypesArray()),
    }
    for kind in ("Point", "Cell", "Field"):
        attributes = getattr(grid, f"Get{kind}Data")()
        for i in range(attributes.GetNumberOfArrays()):
            if attributes.GetArrayName(i) != "padding":  # of a VTU, of no meaning
                seen[f"{kind} {attributes.GetArrayName(i)}"] = vtk_to_numpy(attributes.GetArray(i))
    return seen


def by_meshio(path):
    """meshio keeps no field data."""
    mesh = meshio.read(path)
    types = {"line": 3, "triangle": 5, "tetra": 10}[mesh.cells[0].type]
    seen = {"points": mesh.points, "cells": mesh.cells[0].data, "types": np.full(len(mesh.cells[0].data), types)}
    seen.update({f"Point {name}": values for name, values in mesh.point_data.items()})
    seen.update({f"Cell {name}": values[0] for name, values in mesh.cell_data.items()})
    return seen


def by_tetgen(path, wanted):
    """meshio has no names for the attributes, which come in our order behind the group."""
    mesh = meshio.read(path)
    cell_attributes = list(mesh.cell_data.values())[1:]
    pair = np.column_stack([cell_attributes[0][0], cell_attributes[1][0]])
    return {
        "points": mesh.points,
        "cells": mesh.cells[0].data,
        "types": wanted["types"],
        "Point t": mesh.point_data["tetgen:attr1"],
        "Point vertex_id": mesh.point_data["tetgen:attr2"],
        "Cell pair": pair,
        "Cell region": cell_attributes[2][0],
    }


def differences(wanted, seen):
    yield from (f"only one has {name}" for name in sorted(set(wanted) ^ set(seen)))
    for name in set(wanted) & set(seen):
        if not np.array_equal(wanted[name], seen[name]):
            yield f"{name} is not the same"


def main(vtu, legacy):
    wanted = by_vtk(vtu)
    no_field = {name: values for name, values in wanted.items() if not name.startswith("Field")}
    found = [f"VTK: {text}" for text in differences(wanted, by_vtk(legacy))]
    found += [f"meshio: {text}" for text in differences(no_field, by_meshio(legacy))]
    if wanted["types"][0] == 10:
        ele = legacy.replace(".vtk", ".ele")
        found += [f"meshio, .ele: {text}" for text in differences(no_field, by_tetgen(ele, wanted))]
    print(f"{legacy}: {len(wanted['points'])} points, {len(wanted['cells'])} cells, {len(wanted) - 3} arrays")
    print("".join(f"  DIFFERS: {text}\n" for text in found), end="")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        print(__doc__)
        sys.exit(2)
    assert independent_readers
    sys.exit(main(*sys.argv[1:]))
