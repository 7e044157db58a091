#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a hull in 2D+t, its regions in colours, opened to show the moving body inside: docs/hull.png is
    slabhull study expanding-circle --levels 2 --hulls --out out
    scripts/draw-hull.py out/expanding-circle-centre-2.vtu docs/hull.png
Needs python3-vtk9, and a display or xvfb-run."""
import sys

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (registers the renderer)
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkThreshold
from vtkmodules.vtkFiltersExtraction import vtkExtractGeometry
from vtkmodules.vtkCommonDataModel import vtkBox
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingCore import (vtkActor, vtkDataSetMapper, vtkRenderer, vtkRenderWindow,
                                         vtkWindowToImageFilter)

HEIGHT = 3.0  # of the slab, in the picture
COLOURS = {"initial": (0.36, 0.68, 0.93), "body": (0.93, 0.55, 0.25), "walls": (0.62, 0.66, 0.71),
           "terminating": (0.30, 0.75, 0.60)}


def threshold(source, name, low, high):
    cells = vtkThreshold()
    cells.SetInputConnection(source.GetOutputPort())
    cells.SetInputArrayToProcess(0, 0, 0, 1, name)
    cells.SetLowerThreshold(low)
    cells.SetUpperThreshold(high)
    cells.SetThresholdFunction(vtkThreshold.THRESHOLD_BETWEEN)
    return cells


def cut_open(source):
    """The cells behind the plane y = 0."""
    box = vtkBox()
    box.SetBounds(-100, 100, 0, 100, -100, 100)
    rest = vtkExtractGeometry()
    rest.SetInputConnection(source.GetOutputPort())
    rest.SetImplicitFunction(box)
    rest.ExtractBoundaryCellsOn()
    return rest


def actor(source, colour):
    mapper = vtkDataSetMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    mapper.ScalarVisibilityOff()
    shown = vtkActor()
    shown.SetMapper(mapper)
    shown.GetProperty().SetColor(*colour)
    shown.GetProperty().EdgeVisibilityOn()
    shown.GetProperty().SetEdgeColor(0.15, 0.17, 0.2)
    shown.GetProperty().SetLineWidth(1.2)
    shown.GetProperty().SetAmbient(0.25)
    return shown


def main(hull, picture):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(hull)
    stretch = vtkTransform()
    stretch.Scale(1, 1, HEIGHT)
    tall = vtkTransformFilter()
    tall.SetTransform(stretch)
    tall.SetInputConnection(reader.GetOutputPort())
    side = threshold(tall, "region", 1, 1)
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor(threshold(tall, "region", 0, 0), COLOURS["initial"]))
    renderer.AddActor(actor(threshold(side, "patch", 1, 1), COLOURS["body"]))
    renderer.AddActor(actor(cut_open(threshold(side, "patch", 2, 99)), COLOURS["walls"]))
    renderer.AddActor(actor(cut_open(threshold(tall, "region", 2, 2)), COLOURS["terminating"]))
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(1040, 680)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(6, -20, 14)
    camera.SetFocalPoint(0, 0, 1)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    camera.Zoom(1.28)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main(*sys.argv[1:])
