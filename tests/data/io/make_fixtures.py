#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the mesh files of this folder with Gmsh, meshio and VTK. They are kept in the repository, so that the tests
need none of these; run this again only to add a variant.

One mesh in all files: the unit cube, volume group 7 "room", face x = 0 in group 3 "inlet", the others in group 4
"walls"; the face z = 1 is in the unnamed group 12, too.
"""
import struct

import gmsh
import meshio
import numpy as np
import vtk


def model(size=0.6):
    gmsh.clear()
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    inlet = gmsh.model.getEntitiesInBoundingBox(-0.1, -0.1, -0.1, 0.1, 1.1, 1.1, 2)
    top = gmsh.model.getEntitiesInBoundingBox(-0.1, -0.1, 0.9, 1.1, 1.1, 1.1, 2)
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    walls = [tag for tag in faces if (2, tag) not in inlet]
    gmsh.model.addPhysicalGroup(3, [1], 7)
    gmsh.model.setPhysicalName(3, 7, "room")
    gmsh.model.addPhysicalGroup(2, [inlet[0][1]], 3)
    gmsh.model.setPhysicalName(2, 3, "inlet")
    gmsh.model.addPhysicalGroup(2, walls, 4)
    gmsh.model.setPhysicalName(2, 4, "walls")
    if size < 1:
        gmsh.model.addPhysicalGroup(2, [top[0][1]], 12)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)


def save(name, version, binary, **options):
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    for option, value in options.items():
        gmsh.option.setNumber("Mesh." + option, value)
    gmsh.write(name)
    for option in options:
        gmsh.option.setNumber("Mesh." + option, 0)


def gmsh_files():
    model()
    gmsh.model.mesh.generate(3)
    save("cube_41_ascii.msh", 4.1, 0)
    save("cube_41_binary.msh", 4.1, 1)
    save("cube_41_parametric.msh", 4.1, 1, SaveParametric=1)
    save("cube_40.msh", 4.0, 0)
    gmsh.model.mesh.partition(2)
    save("cube_partitioned.msh", 4.1, 0)
    model(2)  # without the double group, which MSH 2 can only say by doubling the elements
    gmsh.model.mesh.setPeriodic(2, [2], [1], [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    gmsh.model.mesh.generate(3)
    save("coarse_41_binary.msh", 4.1, 1)
    save("coarse_22_ascii.msh", 2.2, 0)
    save("coarse_22_binary.msh", 2.2, 1)
    gmsh.model.mesh.setOrder(2)
    save("second_order.msh", 4.1, 0)
    model(2)
    gmsh.option.setNumber("Mesh.RecombineAll", 1)
    gmsh.model.mesh.generate(2)
    gmsh.option.setNumber("Mesh.RecombineAll", 0)
    save("quads.msh", 4.1, 1)
    view_file()


def view_file():
    """Data on all nodes and on all tetrahedra, as Gmsh writes a view."""
    model(2)
    gmsh.model.mesh.generate(3)
    nodes, coordinates, _ = gmsh.model.mesh.getNodes()
    save("views.msh", 4.1, 1)
    tets = gmsh.model.mesh.getElementsByType(4)[0]
    name = gmsh.model.getCurrent()
    x = [[value] for value in coordinates[0::3]]
    gmsh.option.setNumber("PostProcessing.SaveMesh", 0)
    for title, kind, tags, values in (
        ("x", "NodeData", nodes, x),
        ("tag", "ElementData", tets, [[float(t)] for t in tets]),
        ("some", "NodeData", nodes[:2], x[:2]),
    ):
        view = gmsh.view.add(title)
        gmsh.view.addModelData(view, 0, name, kind, tags, values)
        gmsh.view.write(view, "views.msh", True)


def gaps_and_disorder():
    """Node and element tags with gaps and out of order, by our own hand, and a comment."""
    mesh = meshio.read("coarse_22_ascii.msh")
    tets = mesh.cells_dict["tetra"]
    order = list(range(len(mesh.points)))[::-1]
    with open("gaps_22.msh", "w") as f:
        f.write("$Comments\nwritten by hand\n$EndComments\n$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
        f.write(f"$Nodes\n{len(order)}\n")
        for i in order:
            f.write(f"{i * i * 1000 + 5} {' '.join(repr(float(x)) for x in mesh.points[i])}\n")
        f.write(f"$EndNodes\n$Elements\n{len(tets)}\n")
        for i, tet in enumerate(tets):
            f.write(f"{7 * (len(tets) - i)} 4 3 7 1 0 {' '.join(str(v * v * 1000 + 5) for v in tet)}\n")
        f.write("$EndElements\n")


def short_size_t():
    """MSH 4.1 binary with data size 4, which a 32-bit Gmsh would write."""
    mesh = meshio.read("coarse_41_binary.msh")
    points, tets = mesh.points, mesh.cells_dict["tetra"]
    with open("size_t_4.msh", "wb") as f:
        f.write(b"$MeshFormat\n4.1 1 4\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n")
        f.write(b"$Entities\n" + struct.pack("<4I", 0, 0, 0, 1))
        f.write(struct.pack("<i6dIiI", 1, 0, 0, 0, 1, 1, 1, 1, 7, 0) + b"\n$EndEntities\n$Nodes\n")
        f.write(struct.pack("<4I", 1, len(points), 1, len(points)) + struct.pack("<3iI", 3, 1, 0, len(points)))
        f.write(np.arange(1, len(points) + 1, dtype="<u4").tobytes() + points.astype("<f8").tobytes())
        f.write(b"\n$EndNodes\n$Elements\n")
        f.write(struct.pack("<4I", 1, len(tets), 1, len(tets)) + struct.pack("<3iI", 3, 1, 4, len(tets)))
        for i, tet in enumerate(tets):
            f.write(struct.pack("<5I", i + 1, *(int(v) + 1 for v in tet)))
        f.write(b"\n$EndElements\n")


def meshio_files():
    mesh = meshio.read("coarse_41_binary.msh")
    points, tets = mesh.points, mesh.cells_dict["tetra"]
    plain = meshio.Mesh(
        points,
        [("tetra", tets)],
        point_data={"x": points[:, 0].copy(), "v": 2 * points},
        cell_data={"number": [np.arange(len(tets))]},
    )
    meshio.write("meshio_41_ascii.msh", plain, file_format="gmsh", binary=False)
    meshio.write("meshio_41_binary.msh", plain, file_format="gmsh", binary=True)
    meshio.write("meshio_22_binary.msh", plain, file_format="gmsh22", binary=True)
    meshio.write("meshio_ascii.vtu", plain, binary=False)
    meshio.write("meshio_base64.vtu", plain, compression=None)
    meshio.write("meshio_zlib.vtu", plain, compression="zlib")
    triangles = meshio.Mesh(points, [("triangle", mesh.cells_dict["triangle"])])
    meshio.write("triangles.vtu", triangles, compression=None)
    mixed = meshio.Mesh(points, [("tetra", tets), ("triangle", tets[:, :3])])
    meshio.write("mixed.vtu", mixed, compression=None)


def vtk_files():
    mesh = meshio.read("coarse_41_binary.msh")
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName("meshio_base64.vtu")
    reader.Update()
    grid = reader.GetOutput()
    names = vtk.vtkStringArray()
    names.SetName("patch_name")
    for text in ("in let", "walls"):
        names.InsertNextValue(text)
    grid.GetFieldData().AddArray(names)
    ids = vtk.vtkIdTypeArray()
    ids.SetName("ids")
    signed = vtk.vtkSignedCharArray()
    signed.SetName("signed")
    for i in range(len(mesh.points)):
        ids.InsertNextValue(10**12 + i)
        signed.InsertNextValue(-i)
    grid.GetPointData().AddArray(ids)
    grid.GetPointData().AddArray(signed)

    def write(name, mode, encode=False, wide=True, big=False, compress=False):
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetInputData(grid)
        writer.SetFileName(name)
        writer.SetDataMode({"ascii": 0, "binary": 1, "appended": 2}[mode])
        writer.SetEncodeAppendedData(encode)
        writer.SetHeaderType(64 if wide else 32)
        if not compress:
            writer.SetCompressorTypeToNone()
        if big:
            writer.SetByteOrderToBigEndian()
        writer.Write()

    write("vtk_ascii.vtu", "ascii")
    write("vtk_base64.vtu", "binary")
    write("vtk_base64_32.vtu", "binary", wide=False)
    write("vtk_raw.vtu", "appended")
    write("vtk_raw_32.vtu", "appended", wide=False)
    write("vtk_appended_base64.vtu", "appended", encode=True)
    write("vtk_big_endian.vtu", "appended", big=True)
    write("vtk_zlib.vtu", "appended", compress=True)


def medit_files():
    """The coarse mesh, with groups as references, in Gmsh's own layout and in meshio's."""
    gmsh.clear()
    gmsh.open("coarse_22_ascii.msh")
    gmsh.option.setNumber("Mesh.SaveElementTagType", 2)
    gmsh.write("coarse_gmsh.mesh")
    mesh = meshio.read("coarse_22_ascii.msh")
    groups = [np.asarray(numbers, dtype=int) for numbers in mesh.cell_data["gmsh:physical"]]
    meshio.Mesh(mesh.points, mesh.cells, cell_data={"ref": groups}).write("coarse_meshio.mesh")


gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 1)
gmsh_files()
medit_files()
gmsh.finalize()
gaps_and_disorder()
short_size_t()
meshio_files()
vtk_files()
