# SPDX-License-Identifier: BSD-3-Clause
"""Space-time hulls of moving domains: closed, conforming, checked.

    domain = slabhull.Domain(points, cells, facets={"body": facets})
    march = slabhull.March(domain, motions={"body": lambda x, t: velocity})
    slab = march.step([0.0, 0.1, 0.2])
    assert slabhull.check(slab.hull).clean
    slab.hull.points, slab.hull.cells            # views of numpy

docs/python.md says what is a view, what is copied, and how long it lives.
"""
import os as _os

from . import _slabhull
from ._slabhull import (Case, Domain, Filling, FillingSection, Hull, March, Mesh, Motion, Progress, Projection, Section, Slab,
                        SpatialMesh, TrackMotion, __version__, cylinder, ellipsoid, expansion, experiment_names,
                        formula, plane, read_filling, read_hull, read_mesh, rotation, sequence, set_thread_count,
                        sphere, thread_count, track_motion, translation)
from .errors import (Entity, Error, FormatLimit, GeometryError, InputError, Interrupted, LimitError, OutputError,
                     TangledBoundary, TooManyLayers, UsageError)
from .exchange import to_meshio, to_vtk
from .progress import ProgressBar
from .report import Finding, Report, report_of as _report_of

__all__ = ["Case", "Domain", "Entity", "Error", "Filling", "FillingSection", "Finding", "FormatLimit",
           "GeometryError", "Hull", "InputError", "Interrupted", "LimitError", "March", "Mesh", "Motion",
           "OutputError", "Progress", "ProgressBar", "Projection", "Report", "Section", "Slab", "SpatialMesh", "TangledBoundary",
           "TooManyLayers", "TrackMotion", "UsageError", "check", "check_arrays", "cylinder", "ellipsoid",
           "expansion", "experiment_names", "fill", "formula", "plane", "read", "read_filling", "read_hull",
           "read_mesh", "rotation", "sequence", "set_thread_count", "slice", "sphere", "thread_count", "to_meshio",
           "to_vtk", "track_motion", "translation"]

for _each in (Filling, FillingSection, Hull, Mesh, Section, SpatialMesh):
    _each.to_meshio = to_meshio
    _each.to_vtk = to_vtk


def check(what, *, hull=None, betti=False, embedding=True):
    """Checks a Hull, a Slab, a Filling (compared with `hull` if given), or a file as `slabhull check` does.

    Returns a Report. `betti`: also Betti numbers; `embedding`: also that a hull does not cross itself.
    """
    if isinstance(what, Slab):
        what = what.hull
    if isinstance(what, (str, _os.PathLike)):
        if _slabhull.is_filling_file(what):
            what = read_filling(what)
        else:
            return _report_of(_slabhull.check_file(what, betti, embedding))
    if isinstance(what, Filling):
        return _report_of(_slabhull.check_filling(what, hull))
    if isinstance(what, SpatialMesh):
        return _report_of(_slabhull.check_mesh_arrays(what.points, what.cells))
    return _report_of(_slabhull.check_hull(what, betti, embedding))


def check_arrays(points, cells, *, betti=False, embedding=True, **claims):
    """Checks arrays: as many coordinates as a cell has corners are a hull's, one less is a mesh in space.

    `claims` about a hull are compared: region, patch, layer, neighbors, vertex_ids, track_ids.
    """
    known = ("region", "patch", "layer", "neighbors", "vertex_ids", "track_ids")
    for name in claims:
        if name not in known:
            raise UsageError(f"there is no claim \"{name}\"; there are {', '.join(known)}")
    width = len(points[0]) if len(points) else 0
    if len(cells) and len(cells[0]) == width + 1:
        return _report_of(_slabhull.check_mesh_arrays(points, cells))
    return _report_of(_slabhull.check_hull_arrays(points, cells, claims, betti, embedding))


def slice(what, time):
    """The section of a Hull (a Section: the domain's boundary) or a Filling (a FillingSection: its mesh) at a time.

    Several times, ascending, give a list.
    """
    if isinstance(what, Slab):
        what = what.hull
    times = [time] if not hasattr(time, "__len__") else list(time)
    if isinstance(what, Filling):
        sections = [_slabhull.slice_filling(what, each) for each in times]
    else:
        sections = _slabhull.slice_hull(what, times)
    return sections if hasattr(time, "__len__") else sections[0]


def fill(what, *, method="march", time_scale=0.0, on_progress=None):
    """Fills a Slab, or a Hull such as one from a file, with simplices of space-time.

    "march" extrudes the cells of caps that are one mesh moved or adapted; "tetgen" fills any hull in 2D+t.
    """
    if method == "tetgen":
        hull = what.hull if isinstance(what, Slab) else what
        return _slabhull.fill_by_tetgen(hull, time_scale, on_progress)
    if method != "march":
        raise UsageError(f"method: expected \"march\" or \"tetgen\", not \"{method}\"")
    if isinstance(what, Slab):
        return _slabhull.fill_slab(what, on_progress)
    return _slabhull.fill_hull(what, on_progress)


def read(path):
    """What is in a file: a Hull, a Filling, or else a Mesh."""
    kind = _slabhull.kind_of_file(path)
    return {"hull": read_hull, "filling": read_filling, "mesh": read_mesh}[kind](path)
