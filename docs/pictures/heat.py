#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what examples/heat found around the turning ellipsoid, side by side at several instants: docs/pictures/heat.png is

    build/release/examples/heat examples/heat/ellipsoid.toml warm out/heat 0.1 0.55 0.95
    docs/pictures/heat.py docs/pictures/heat.png out/heat/heat_{0.1,0.55,0.95}.vtu

The tetrahedra of each instant are clipped by the plane z = 0. Needs python3-vtk9, and a display or xvfb-run."""
import re
import sys

import numpy
import vtkmodules.vtkInteractionStyle  # noqa: F401
import vtkmodules.vtkRenderingFreeType  # noqa: F401  (draws texts)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (registers the renderer)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import vtkPolyDataConnectivityFilter, vtkPolyDataNormals
from vtkmodules.vtkFiltersGeneral import vtkTableBasedClipDataSet
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTextActor,
                                         vtkWindowToImageFilter)

SIZE = (400, 360)  # of one instant
SHADES = 32  # of each of red, green and blue
REACH = 4.4  # what is shown: |x|, |y| up to this
COLOURS = ((0.13, 0.25, 0.50), (0.30, 0.55, 0.78), (0.80, 0.88, 0.92), (0.98, 0.80, 0.42), (0.91, 0.40, 0.16),
           (0.62, 0.08, 0.12))  # from cold to warm


def colours():
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for k in range(256):
        at = k / 255 * (len(COLOURS) - 1)
        low = min(int(at), len(COLOURS) - 2)
        table.SetTableValue(k, *(a + (at - low) * (b - a) for a, b in zip(COLOURS[low], COLOURS[low + 1])))
    table.SetRange(0, 1)
    return table


def clip(source, origin, normal):
    """What is on the side that the normal points to."""
    plane = vtkPlane()
    plane.SetOrigin(*origin)
    plane.SetNormal(*normal)
    rest = vtkTableBasedClipDataSet()
    rest.SetInputConnection(source.GetOutputPort())
    rest.SetClipFunction(plane)
    return rest


def surface(source):
    filter = vtkDataSetSurfaceFilter()
    filter.SetInputConnection(source.GetOutputPort())
    return filter


def body(source):
    """The part of the domain's boundary that is nearest to the middle."""
    outside = surface(source)
    part = vtkPolyDataConnectivityFilter()
    part.SetInputConnection(outside.GetOutputPort())
    part.SetExtractionModeToClosestPointRegion()
    part.SetClosestPoint(0, 0, 0)
    smooth = vtkPolyDataNormals()
    smooth.SetInputConnection(part.GetOutputPort())
    smooth.SplittingOff()
    smooth.FlipNormalsOn()
    return smooth


def actor(source):
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    shown = vtkActor()
    shown.SetMapper(mapper)
    return shown


def medium(source):
    half = clip(source, (0, 0, 0), (0, 0, -1))
    for axis, end in ((0, -1), (0, 1), (1, -1), (1, 1)):
        origin = [0, 0, 0]
        normal = [0, 0, 0]
        origin[axis] = end * REACH
        normal[axis] = -end
        half = clip(half, origin, normal)
    half = clip(half, (0, 0, -1), (0, 0, 1))
    outside = surface(half)
    shown = actor(outside)
    shown.GetMapper().SetScalarModeToUsePointFieldData()
    shown.GetMapper().SelectColorArray("u")
    shown.GetMapper().SetLookupTable(colours())
    shown.GetMapper().SetUseLookupTableScalarRange(True)
    shown.GetMapper().InterpolateScalarsBeforeMappingOn()
    look = shown.GetProperty()
    look.SetAmbient(0.55)
    look.SetDiffuse(0.45)
    edges = actor(outside)
    edges.SetPosition(0, -0.01, 0.02)  # in front of the faces
    edges.GetMapper().ScalarVisibilityOff()
    edges.GetProperty().SetRepresentationToWireframe()
    edges.GetProperty().SetColor(0.1, 0.1, 0.15)
    edges.GetProperty().SetOpacity(0.14)
    return shown, edges


def solid(source):
    shown = actor(body(source))
    shown.GetMapper().ScalarVisibilityOff()
    shown.GetProperty().SetColor(0.86, 0.87, 0.89)
    shown.GetProperty().SetSpecular(0.25)
    shown.GetProperty().SetSpecularPower(30)
    return shown


def text(words, size, x, y):
    label = vtkTextActor()
    label.SetInput(words)
    label.GetTextProperty().SetFontSize(size)
    label.GetTextProperty().SetColor(0.1, 0.1, 0.12)
    label.SetPosition(x, y)
    return label


def scale():
    bar = vtkScalarBarActor()
    bar.SetLookupTable(colours())
    bar.SetNumberOfLabels(3)
    bar.SetUnconstrainedFontSize(True)
    bar.GetLabelTextProperty().SetFontSize(17)
    bar.SetLabelFormat("%.1f")
    bar.SetOrientationToHorizontal()
    bar.SetPosition(0.5, 0.01)
    bar.SetWidth(0.42)
    bar.SetHeight(0.1)
    style = bar.GetLabelTextProperty()
    style.SetColor(0.1, 0.1, 0.12)
    style.ItalicOff()
    style.BoldOff()
    style.ShadowOff()
    return bar


def panel(file, left, right):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(file)
    view = vtkRenderer()
    view.SetViewport(left, 0, right, 1)
    view.SetBackground(1, 1, 1)
    for shown in (*medium(reader), solid(reader)):
        view.AddActor(shown)
    view.AddViewProp(text("t = " + re.search(r"_([0-9.e-]+)\.vtu$", file).group(1), 20, 14, 10))
    camera = view.GetActiveCamera()
    camera.SetPosition(0, -13, 19)
    camera.SetFocalPoint(0, -0.55, -0.6)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(24)
    view.ResetCameraClippingRange()
    return view


def main(picture, files):
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(SIZE[0] * len(files), SIZE[1])
    for k, file in enumerate(files):
        view = panel(file, k / len(files), (k + 1) / len(files))
        window.AddRenderer(view)
    view.AddViewProp(scale())  # in the last one
    view.AddViewProp(text("u =", 20, 150, 10))
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    values = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars())
    values[:] = 255 * numpy.round(values / 255 * SHADES) / SHADES  # for a smaller file
    writer = vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetCompressionLevel(9)
    writer.SetInputData(image.GetOutput())
    writer.Write()


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
