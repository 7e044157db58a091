#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""other_formats.py FOLDER: opens the samples of write_samples with meshio, VTK, Gmsh and Python's json and compares
them with the VTU of the same mesh, number by number. Prints a line per file.

Exit code 0: all agree; 1: they differ, or a reader fails; 77: a reader is not installed.
"""
import json
import pathlib
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

GROUPS = (5, 2, 9)  # of the three thirds of the cells, as tests/io/specimens.h has them


def expected_groups(count):
    third = count // 3
    return np.repeat(GROUPS, (third, third, count - 2 * third))


def same(what, found, expected):
    if not np.array_equal(found, expected):
        raise ValueError(f"{what} differ")


def medit_by_meshio(path, reference):
    mesh = meshio.read(path)
    same("points", mesh.points, reference.points)
    same("cells", mesh.cells[0].data, reference.cells[0].data)
    same("references", mesh.cell_data["medit:ref"][0], expected_groups(len(mesh.cells[0].data)))


def medit_4d_by_meshio(path, reference):
    mesh = meshio.read(path)
    same("points", mesh.points, np.column_stack([reference.points, reference.point_data["t"]]))
    same("cells", mesh.cells[0].data, reference.cells[0].data)


def medit_by_gmsh(path, reference):
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        points = coordinates.reshape(-1, 3)[np.argsort(tags)]
        dimension = gmsh.model.getDimension()
        element_tags, corners = gmsh.model.mesh.getElementsByType({1: 1, 2: 2, 3: 4}[dimension])
        cells = corners.reshape(-1, dimension + 1)[np.argsort(element_tags)].astype(int) - 1
        same("points", points, reference.points)
        same("cells", cells, reference.cells[0].data)
    finally:
        gmsh.finalize()


def surface_by_meshio(path, reference):
    mesh = meshio.read(path)
    same("points", mesh.points, reference.points)
    same("cells", np.concatenate([block.data for block in mesh.cells]), reference.cells[0].data)


def stl_by_meshio(path, reference):
    mesh = meshio.read(path)
    corners = reference.points.astype(np.float32)[reference.cells[0].data]
    same("corners", mesh.points[mesh.cells[0].data], corners)
    facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    facets = np.fromfile(path, dtype=facet, offset=84)  # meshio reads no normals from binary files
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if not np.allclose(facets["normal"], normals / np.linalg.norm(normals, axis=1)[:, None], atol=1e-4):
        raise ValueError("normals differ")


def surface_by_vtk(path, reference):
    reader = {".stl": vtk.vtkSTLReader, ".obj": vtk.vtkOBJReader, ".ply": vtk.vtkPLYReader}[path.suffix]()
    reader.SetFileName(str(path))
    reader.Update()
    surface = reader.GetOutput()
    points = vtk_to_numpy(surface.GetPoints().GetData())
    cells = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    expected = reference.points.astype(np.float32)[reference.cells[0].data]
    if not np.allclose(points[cells], expected, atol=1e-6):
        raise ValueError("corners differ")


def avro_by_json(path, reference):
    mesh = json.loads(path.read_text())
    dimension = reference.cells[0].data.shape[1] - 1
    points = reference.points
    if dimension == 3:
        points = np.column_stack([points, reference.point_data["t"]])
    head = (mesh["dim"], mesh["number"], mesh["type"], mesh["nb_ghost"])
    if head != (points.shape[1], dimension, "simplex", 0):
        raise ValueError(f"the head is {head}")
    same("points", np.reshape(mesh["vertices"], points.shape), points)
    same("cells", np.reshape(mesh["elements"], (-1, dimension + 1)), reference.cells[0].data)


def mfem_by_hand(path, reference):
    """Reads as https://mfem.org/mesh-format-v1.0 says; no reader for it comes with Debian."""
    words = [line.split("#")[0] for line in path.read_text().splitlines()]
    if words[0] != "MFEM mesh v1.0":
        raise ValueError("the head is wrong")
    words = iter(" ".join(words[1:]).split())

    def section(name):
        if next(words) != name:
            raise ValueError(f"{name} was expected")
        return int(next(words))

    def elements(name, dimension):
        rows = [[int(next(words)) for _ in range(dimension + 3)] for _ in range(section(name))]
        rows = np.array(rows, dtype=int).reshape(-1, dimension + 3)
        same("geometry types", rows[:, 1], np.full(len(rows), (0, 1, 2, 4)[dimension]))
        return rows[:, 0], rows[:, 2:]

    dimension = section("dimension")
    attributes, cells = elements("elements", dimension)
    boundary_attributes, boundary = elements("boundary", dimension - 1)
    count, width = section("vertices"), int(next(words))
    points = np.array([float(next(words)) for _ in range(count * width)]).reshape(count, width)
    if next(words, None) is not None:
        raise ValueError("something follows the vertices")
    same("points", points, reference.points[:, :width])
    same("cells", cells, reference.cells[0].data)
    same("attributes", attributes, expected_groups(len(cells)))
    same("boundary attributes", boundary_attributes, np.ones(len(boundary)))
    facets = np.sort(np.concatenate([np.delete(cells, i, axis=1) for i in range(dimension + 1)]), axis=1)
    facets, uses = np.unique(facets, axis=0, return_counts=True)
    same("boundary", np.unique(np.sort(boundary, axis=1), axis=0), facets[uses == 1])
    if dimension == 2 and not set(map(tuple, boundary)) <= {
            (a, b) for i, j in ((0, 1), (1, 2), (2, 0)) for a, b in cells[:, (i, j)]}:
        raise ValueError("boundary elements are not oriented as the cells")


def checks(folder):
    for name in ("grid2.off", "grid2.obj", "grid2.ply"):
        yield "grid2.vtu", name, surface_by_meshio
    yield "grid2.vtu", "grid2.stl", stl_by_meshio
    for name in ("grid2.stl", "grid2.obj", "grid2.ply"):
        yield "grid2.vtu", name, surface_by_vtk
    for dimension in (1, 2, 3):
        vtu = f"grid{dimension}.vtu"
        yield vtu, f"grid{dimension}.mesh", medit_by_meshio
        yield vtu, f"grid{dimension}.mesh", medit_by_gmsh
        yield vtu, f"grid{dimension}_4d.mesh", medit_4d_by_meshio
        yield vtu, f"grid{dimension}.avro", avro_by_json
        yield vtu, f"grid{dimension}.mfem", mfem_by_hand


def main(folder):
    bad = 0
    for vtu, name, check in checks(folder):
        try:
            check(folder / name, meshio.read(folder / vtu))
            print(f"{name} {check.__name__}: agrees")
        except Exception as problem:  # whatever a reader throws is a finding
            print(f"{name} {check.__name__}: FAILED: {problem!r}")
            bad += 1
    return 1 if bad else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print(__doc__)
        sys.exit(2)
    sys.exit(main(pathlib.Path(sys.argv[1])))
