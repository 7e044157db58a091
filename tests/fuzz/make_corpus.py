#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the seeds of the fuzzers, small files of each variant: make_corpus.py PROGRAM, the slabhull that converts some.

By Gmsh, VTK and meshio, by our own writers, and by hand what none of them writes. They are kept in the repository; run
this again only to add a variant. scripts/fuzz.sh --merge adds what fuzzing finds."""
import itertools
import subprocess
import sys
from pathlib import Path

import gmsh
import meshio
import numpy as np
import vtk

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "io"))
from mesh_samples import COMPRESSORS, MODES, ORDERS, WORDS, saved_by_gmsh, vtk_grid, write_turned  # noqa: E402

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1.25, 1, 1 / 3]])
CELLS = {"tetra": np.array([[0, 1, 2, 3], [1, 2, 3, 4]]), "triangle": np.array([[0, 1, 2], [1, 3, 2], [0, 3, 1]]),
         "line": np.array([[0, 1], [1, 2], [2, 3], [3, 0]])}
VTK_TYPE = {"tetra": vtk.VTK_TETRA, "triangle": vtk.VTK_TRIANGLE, "line": vtk.VTK_LINE}


def seeds_of(reader):
    folder = HERE / "corpus" / reader
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def place(reader, name):
    return seeds_of(reader) / name


def put(reader, name, text):
    place(reader, name).write_bytes(text if isinstance(text, bytes) else text.encode())


# --- VTK

def grid(kind="tetra"):
    cells = CELLS[kind]
    return vtk_grid(VTK_TYPE[kind], POINTS, cells,
                    {"t": np.linspace(0, 1, 5), "id": np.arange(5, dtype=np.int64)},
                    {"pair": np.arange(2 * len(cells), dtype=np.int8).reshape(-1, 2)})


def vtu_by_vtk():
    turns = itertools.cycle(itertools.product(WORDS, ORDERS))
    for mode, compressor in itertools.product(MODES, COMPRESSORS):
        if mode == "ascii" and compressor != "plain":
            continue
        word, order = next(turns)
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(place("vtu", f"vtk_{mode}_{compressor}_{word}_{order}.vtu")))
        writer.SetInputData(grid())
        for table, choice in ((MODES, mode), (COMPRESSORS, compressor), (WORDS, word), (ORDERS, order)):
            table[choice](writer)
        writer.SetBlockSize(64)
        assert writer.Write() == 1
    for kind in ("triangle", "line"):
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(place("vtu", f"vtk_{kind}.vtu")))
        writer.SetInputData(grid(kind))
        writer.SetDataModeToAscii()
        assert writer.Write() == 1
    extract = vtk.vtkExtractUnstructuredGridPiece()
    extract.SetInputData(grid())
    extract.CreateGhostCellsOff()
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(place("vtu", "vtk_pieces.vtu")))
    writer.SetInputConnection(extract.GetOutputPort())
    writer.SetNumberOfPieces(2)
    writer.SetDataModeToAscii()
    assert writer.Write() == 1


def legacy_by_vtk():
    for version, binary in itertools.product((42, 51), (False, True)):
        writer = vtk.vtkUnstructuredGridWriter()
        writer.SetFileName(str(place("vtk", f"vtk_{version}_{'binary' if binary else 'ascii'}.vtk")))
        data = grid()
        data.GetPointData().SetScalars(data.GetPointData().GetArray("t"))
        writer.SetInputData(data)
        writer.SetFileVersion(version)
        writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
        assert writer.Write() == 1
        surface = vtk.vtkPolyData()
        triangles = grid("triangle")
        surface.SetPoints(triangles.GetPoints())
        surface.SetPolys(triangles.GetCells())
        writer = vtk.vtkPolyDataWriter()
        writer.SetFileName(str(place("vtk", f"vtk_poly_{version}_{'binary' if binary else 'ascii'}.vtk")))
        writer.SetInputData(surface)
        writer.SetFileVersion(version)
        writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
        assert writer.Write() == 1


def legacy_by_hand():
    put("vtk", "mixed.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n"
        "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nCELLS 4 14\n1 0\n2 0 1\n3 0 1 2\n4 0 1 2 3\nCELL_TYPES 4\n1\n3\n5\n10\n"
        "CELL_DATA 4\nSCALARS s int 1\nLOOKUP_TABLE default\n1 2 3 4\nCOLOR_SCALARS c 3\n"
        "0 0 0 1 1 1 0 0 0 1 1 1\nLOOKUP_TABLE l 1\n0 0 0 1\nPOINT_DATA 5\nVECTORS v double\n"
        "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\nTENSORS m float\n" + "1 2 3 4 5 6 7 8 9\n" * 5 +
        "TEXTURE_COORDINATES c 2 float\n0 0 1 1 2 2 3 3 4 4\nGLOBAL_IDS g vtkIdType\n0 1 2 3 4\n"
        "METADATA\nINFORMATION 0\n\nFIELD f 2\na%20b 1 5 unsigned_char\n1 2 3 4 5\nw 1 5 string\na\nb\n\nd\n%41\n")


# --- meshio

def mesh(*kinds):
    kinds = kinds or ("tetra",)
    cells = [(kind, CELLS[kind]) for kind in kinds]
    groups = [np.arange(1, 1 + len(block), dtype=np.int32) for _, block in cells]
    return meshio.Mesh(POINTS, cells, point_data={"t": np.linspace(0, 1, 5)},
                       cell_data={"gmsh:physical": groups, "gmsh:geometrical": groups})


def by_meshio():
    plain = meshio.Mesh(POINTS, [("tetra", CELLS["tetra"])], point_data={"t": np.linspace(0, 1, 5)},
                        cell_data={"c": [np.arange(2.0)]})
    for name, options in {"ascii": {"binary": False}, "plain": {"compression": None}, "zlib": {"compression": "zlib"}}.items():
        meshio.write(place("vtu", f"meshio_{name}.vtu"), plain, **options)
    for version, binary in itertools.product(("gmsh22", "gmsh"), (False, True)):
        meshio.write(place("msh", f"meshio_{version}_{'binary' if binary else 'ascii'}.msh"), 
                     mesh("triangle", "tetra") if version == "gmsh22" else mesh(), file_format=version, binary=binary)
    for version, binary in itertools.product(("vtk42", "vtk51"), (False, True)):
        meshio.write(place("vtk", f"meshio_{version}_{'binary' if binary else 'ascii'}.vtk"), plain, file_format=version,
                     binary=binary)
    bare = meshio.Mesh(POINTS, [("triangle", CELLS["triangle"]), ("tetra", CELLS["tetra"])])
    meshio.write(place("medit", "meshio.mesh"), bare)
    surface = meshio.Mesh(POINTS, [("triangle", CELLS["triangle"])])
    for name in ("off", "obj"):
        meshio.write(place(name, f"meshio.{name}"), surface)
    for name, binary in itertools.product(("stl", "ply"), (False, True)):
        meshio.write(place(name, f"meshio_{'binary' if binary else 'ascii'}.{name}"), surface, binary=binary)


# --- Gmsh

def two_tetrahedra():
    """Two volumes with a face in common, each one cell."""
    geo = gmsh.model.geo
    points = [geo.addPoint(*x) for x in POINTS]
    lines = {pair: geo.addLine(*(points[i] for i in pair)) for pair in itertools.combinations(range(5), 2) if pair != (0, 4)}
    faces = {}
    for a, b, c in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3), (1, 2, 4), (1, 3, 4), (2, 3, 4)):
        loop = geo.addCurveLoop([lines[a, b], lines[b, c], -lines[a, c]])
        faces[a, b, c] = geo.addPlaneSurface([loop])
    for corners in ((0, 1, 2, 3), (1, 2, 3, 4)):
        geo.addVolume([geo.addSurfaceLoop([faces[face] for face in itertools.combinations(corners, 3)])])
    geo.synchronize()


def by_gmsh():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    two_tetrahedra()
    for dimension, entities, number, name in ((2, [1], 3, "in let"), (2, [2, 3, 5, 6, 7], 4, "walls"), (3, [1, 2], 7, "room")):
        gmsh.model.addPhysicalGroup(dimension, entities, number)
        gmsh.model.setPhysicalName(dimension, number, name)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 3)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 3)
    gmsh.model.mesh.generate(3)
    save_msh("box")
    gmsh.write(str(place("medit", "gmsh.mesh")))
    gmsh.write(str(place("stl", "gmsh.stl")))
    view = gmsh.view.add("t")
    tags = [int(tag) for tag in gmsh.model.mesh.getNodes()[0]]
    gmsh.view.addModelData(view, 0, gmsh.model.getCurrent(), "NodeData", tags, [[0.5 * tag] for tag in tags])
    elements = [int(tag) for tag in gmsh.model.mesh.getElementsByType(4)[0]]
    other = gmsh.view.add("e")
    gmsh.view.addModelData(other, 0, gmsh.model.getCurrent(), "ElementData", elements, [[0.5 * tag] for tag in elements])
    for binary in (0, 1):
        gmsh.option.setNumber("Mesh.Binary", binary)
        path = place("msh", f"gmsh_views_{binary}.msh")
        gmsh.view.write(view, str(path))
        gmsh.view.write(other, str(path), append=True)
    gmsh.model.mesh.partition(2)
    save_msh("parts", PartitionCreateGhostCells=1)
    gmsh.finalize()


def save_msh(name, **options):
    for path in saved_by_gmsh(seeds_of("msh"), f"gmsh_{name}", **options):
        if name != "parts":
            write_turned(path)


# --- by hand

def bundle(**files):
    """As the fuzzer wants several files of one stem; the first is read."""
    return "".join(f"%% .{extension}\n{text}" for extension, text in files.items())


def by_hand():
    node = "# corner\n5 3 1 1 # header\n1 0 0 0 0.5 7\n2 1 0 0 1.5 -1\n3 0 1 0 2.5 0\n4 0 0 1 3.5 2\n5 1 1 1 4.5 2\n# end\n"
    ele = "2 4 1\n1 1 2 3 4 10\n2 5 2 3 4 20\n"
    neigh = "2 4\n1 2 -1 -1 -1\n2 1 -1 -1 -1\n"
    face = "2 1\n1 1 2 3 4\n2 1 2 4 -9\n"
    smesh = ("4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n2 1\n3 0 1 2 5\n3 0 1 3 -5\n1\n0 0.5 0.5 0.5\n2\n0 1 2 3 4 0.25\n"
             "1 1 2 3 5\n")
    poly = "4 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n2 1\n2 0 6\n3 1 2 3\n3 1 2 4\n1\n3 2 3 4\n0\n0\n"
    put("tetgen", "all", bundle(ele=ele, node=node, neigh=neigh, face=face))
    put("tetgen", "node", bundle(node=node, ele=ele, face=face))
    put("tetgen", "face", bundle(face=face, node=node))
    put("tetgen", "smesh", bundle(smesh=smesh))
    put("tetgen", "poly", bundle(poly=poly))
    put("tetgen", "poly_beside", bundle(poly="0 3\n" + poly.split("\n", 5)[5], node="4 3\n" + "\n".join(
        poly.split("\n")[1:5]) + "\n"))
    put("tetgen", "planar", bundle(ele="1 3 0\n0 0 1 2\n", node="3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n"))
    put("tetgen", "attributes", bundle(
        node="# attributes: t:real:1 a%20b:integer:2\n2 3 3 0\n0 0 0 0 0.5 1 2\n1 1 0 0 1.5 -3 4\n"))
    put("msh", "parametric.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\nby hand\n$EndComments\n$Nodes\n3 3 1 9\n"
        "0 1 0 1\n1\n0 0 0\n1 1 1 1\n9\n1 0 0 0.5\n2 1 1 1\n3\n0 1 0 0.5 0.25\n$EndNodes\n$Elements\n2 2 5 8\n0 1 15 1\n"
        "8 1\n2 1 2 1\n5 1 9 3\n$EndElements\n$Periodic\n1\n$EndPeriodic\n")
    put("msh", "parametric_22.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n4\n1 0 0 0 0 1\n2 1 0 0 1 1 0.5\n"
        "3 0 1 0 2 1 0.5 0.25\n4 0 0 1 3 1\n$EndParametricNodes\n$Elements\n1\n7 4 4 3 1 1 2 1 2 3 4\n$EndElements\n")
    put("medit", "four.mesh", "MeshVersionFormatted 2\n# a comment\nDimension 4\nVertices\n5\n0 0 0 0 0\n1 0 0 0.5 1\n"
        "0 1 0 0 2\n0 0 1 1e-3 0\n1 1 1 -2 0\nTetrahedra\n2\n1 2 3 4 7\n2 3 4 5 0\nEnd\n")
    put("medit", "flat.mesh", "MeshVersionFormatted 1 Dimension 2\nVertices 3 0 0 1 1 0 1 0 1 1\nCorners 2 1 2\n"
        "Edges 2 1 2 3 2 3 4\nRidges 1 1\nRequiredVertices 1 1\nTriangles 1 1 2 3 9\nNormals 1 0 1\n"
        "NormalAtVertices 1 1 1\nTangents 1 1 0\nQuadrilaterals 0\nSubDomainFromMesh 1 3 1 1 1\nEnd")
    put("mfem", "square", "MFEM mesh v1.0\n\n# SEGMENT = 1, TRIANGLE = 2\n\ndimension\n2\n\nelements\n2\n1 2 0 1 2\n"
        "7 2 0 2 3\n\nboundary\n4\n3 1 0 1\n# a comment\n3 1 1 2\n4 1 2 3\n4 1 3 0\n\nvertices\n4\n2\n0 0\n1 0\n1 1\n0 1.5\n")
    put("mfem", "line", "MFEM mesh v1.0\ndimension\n1\nelements\n2\n1 1 0 1\n2 1 1 2\nboundary\n2\n1 0 0\n1 0 2\n"
        "vertices\n3\n1\n0\n0.5\n1\n")
    put("filling", "pentatope", "MFEM mesh v1.0\n\n# a comment\ndimension\n4\n\nelements\n1\n1 6 0 1 2 3 4\n\nboundary\n2\n"
        "1 4 0 1 2 3\n3 4 1 2 3 4\n\nvertices\n5\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 1e-3\n0 0 0 1\n")
    put("filling", "tetrahedra", "MFEM mesh v1.0\ndimension\n3\nelements\n2\n1 4 0 1 2 3\n1 4 1 2 3 4\nboundary\n1\n2 2 0 1 2\n"
        "vertices\n5\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1.5\n")
    put("filling", "getfem", "% GETFEM MESH FILE\n% GETFEM VERSION 5.4.2\nBEGIN POINTS LIST\nPOINT COUNT 5\nPOINT 0 0 0 0\n"
        "POINT 1 1 0 0\nPOINT 7 0 1 0\nPOINT 3 0 0 1\nPOINT 4 1 1 1.5\nEND POINTS LIST\n"
        "BEGIN MESH STRUCTURE DESCRIPTION\nCONVEX COUNT 2\nCONVEX 0 'GT_PK(3,1)' 0 1 7 3\nCONVEX 5 'GT_PK(3,1)' 1 7 3 4\n"
        "END MESH STRUCTURE DESCRIPTION\nBEGIN REGION 3\n0/3 5/0 \nEND REGION 3\nBEGIN REGION 4\n5\nEND REGION 4\n"
        "BEGIN MESH_FEM\nQDIM 1\nEND MESH_FEM\n")
    put("filling", "getfem_4d", "% GETFEM MESH FILE\nBEGIN POINTS LIST\nPOINT 0 0 0 0 0\nPOINT 1 1 0 0 0\nPOINT 2 0 1 0 0\n"
        "POINT 3 0 0 1 0\nPOINT 4 0 0 0 1\nEND POINTS LIST\nBEGIN MESH STRUCTURE DESCRIPTION\n"
        "CONVEX 0 'GT_PK(4,1)' 0 1 2 3 4\nEND MESH STRUCTURE DESCRIPTION\nBEGIN REGION 1\n0/4\nEND REGION 1\n")
    put("medit", "curved.mesh", "MeshVersionFormatted 2 Dimension 2 Vertices 6 0 0 0 2 0 0 0 2 0 1 0 0 1 1 0 0 1 0\n"
        "EdgesP2 1 1 2 4 3 TrianglesP2 1 1 2 3 4 5 6 7 End\n")
    curved = [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1)]
    put("tetgen", "curved", bundle(ele="1 10 0\n1 1 2 3 4 5 6 7 8 9 10\n", face="1 1\n1 1 2 3 5 8 6 4\n", node="10 3 0 0\n" + "".join(
        f"{k + 1} {x} {y} {z}\n" for k, (x, y, z) in enumerate(curved))))
    put("avro", "four", '{\n"dim":4,\n"nb_ghost": 0,\n"number": 3,\n"type": "simplex",\n"other": {"a": [1, "]}", null]},\n'
        '"vertices": [0,0,0,0.5, 1,0,0,0.5, 0,1,0,1e-3, 0,0,1,-2],\n"elements":\n[ 0, 1, 2, 3 ]\n}\n')
    put("avro", "flat", '{"elements":[0,1,2],"type":"simplex","vertices":[0,0,1,0,0,1],"number":2,"dim":2}')
    put("stl", "two.stl", "solid a b\n" + "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\n" * 1 + "endsolid a b\nSOLID\nFACET NORMAL nan 0 1\nOUTER LOOP\nVERTEX 0 0 0\n"
        "VERTEX 1 0 0\nVERTEX 0 -1e-3 0\nENDLOOP\nENDFACET\nENDSOLID\n")
    put("off", "colours.off", "# comment\nCOFF\n4 2 0 # counts\n0 0 0 255 0 0 255\n1 0 0 1 1 1\n\n0 1 0\n0 0 1e-3\n"
        "3 0 1 2 0.5 0.5 0.5\n3 0 3 1\n")
    put("obj", "references.obj", "mtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 +1e-3\nvt 0 0\nvn 0 0 1\ng a\nusemtl m\n"
        "s off\nf 1 2 3\nf 1/1 2/1 3/1\nf -3//1 -2//1 -1//1\nf 1/1/1 2/1/1 3/1/1 # end\n")
    head = ("ply\nformat {}\ncomment by hand\nobj_info x\nelement vertex 3\nproperty double x\nproperty float y\nproperty int z\n"
            "property uchar red\nelement face 1\nproperty uchar flags\nproperty list uchar int vertex_indices\n"
            "property list ushort short other\nelement edge 1\nproperty uint a\nproperty char b\nend_header\n")
    put("ply", "all_ascii.ply", head.format("ascii 1.0") + "0 0 0 1\n1 0 0 2\n0 1.5 1 3\n9 3 0 1 2 2 -5 6\n1 -2\n")
    for order, sign in (("little", "<"), ("big", ">")):
        body = b"".join(np.array([row], dtype=np.dtype([("x", sign + "f8"), ("y", sign + "f4"), ("z", sign + "i4"),
                                                        ("r", "u1")])).tobytes()
                        for row in ((0, 0, 0, 1), (1, 0, 0, 2), (0, 1.5, 1, 3)))
        body += bytes([9, 3]) + np.array([0, 1, 2], dtype=sign + "i4").tobytes()
        body += np.array([2], dtype=sign + "u2").tobytes() + np.array([-5, 6], dtype=sign + "i2").tobytes()
        body += np.array([1], dtype=sign + "u4").tobytes() + b"\xfe"
        put("ply", f"all_{order}.ply", head.format(f"binary_{order}_endian 1.0").encode() + body)
    put("curve", "airfoil", "NACA 0012\n# a comment\n1 0\n0.5 0.06\n0 0\n0.5 -0.06\r\n\n1 0\n")
    put("curve", "lednicer", "AIRFOIL\n 4. 3.\n\n0 0\n0.2 0.1\n0.6 0.1\n1 0.01\n\n0 0\n0.5 -0.1\n1 -0.01\n")
    put("off", "polygons.off", "OFF 7 3 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 1\n6 0 1 2 3 4 5\n3 0 6 1\n4 1 2 3 4\n")
    put("ply", "patches.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_index\nproperty int patch\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
        "4 0 1 2 3 5\n3 0 2 1 -1\n")
    put("vtu", "mixed.vtu", '<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="4"><Points>'
        '<DataArray type="Float64" NumberOfComponents="3">0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points><Cells>'
        '<DataArray type="Int64" Name="connectivity">0 1 3 0 1 2 0 2 3</DataArray>'
        '<DataArray type="Int64" Name="offsets">2 3 6 9</DataArray><DataArray type="UInt8" Name="types">3 1 5 5</DataArray></Cells>'
        '<CellData><DataArray type="Int64" Name="patch">4 5 9 -1</DataArray></CellData></Piece></UnstructuredGrid></VTKFile>')
    put("csv", "commas", "time,x,angle_deg\n0,1.5,-90\n2,2.5e-3,45\n")
    put("csv", "semicolons", "time;x;angle_deg\r\n0;1.5;-90\r\n2;2.5e-3;45")
    put("csv", "blanks", "# time x angle_deg\n0 1.5 -90\n2\t2.5e-3  45\n")
    put("csv", "quotes", '\ufeff\n"time", "x"\n\n# first\n 0 , +1.5\n"2",0.0025\n')
    put("csv", "foam", "// of OpenFOAM\n2\n(\n(0 ((0.25 0.50 1.0) (1.0 2.0 1.5))) /* first */\n(0.5 ((0 -1 2) (10 20 30)))\n);\n")


# --- our own writers

def by_us(program):
    tetrahedra, triangles, lines = (place("vtu", f"ours_{kind}.vtu") for kind in ("tetra", "triangle", "line"))
    for path, seed in ((tetrahedra, "vtk_ascii_plain_32_little.vtu"), (triangles, "vtk_triangle.vtu"), (lines, "vtk_line.vtu")):
        subprocess.run([program, "convert", place("vtu", seed), path], check=True, stdout=subprocess.DEVNULL)
    for path, targets in ((tetrahedra, ("msh", "vtk", "mesh", "mfem", "avro")), (lines, ("mesh", "mfem")),
                          (triangles, ("msh", "stl", "off", "obj", "ply", "mfem"))):
        for extension in targets:
            reader = {"mesh": "medit"}.get(extension, extension)
            subprocess.run([program, "convert", path, place(reader, f"{path.stem}.{extension}")], check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


if __name__ == "__main__":
    for case in (HERE.parent.parent / "examples").glob("*.toml"):
        put("case", case.name, case.read_bytes())
    vtu_by_vtk()
    legacy_by_vtk()
    legacy_by_hand()
    by_meshio()
    by_gmsh()
    by_hand()
    by_us(sys.argv[1])
    for file in sorted((HERE / "corpus").rglob("*")):
        if file.is_file() and file.stat().st_size > 4096:
            print(f"{file.relative_to(HERE)} is large: {file.stat().st_size} bytes")
