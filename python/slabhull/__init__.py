# SPDX-License-Identifier: BSD-3-Clause
"""Space-time hulls of moving domains: closed, conforming, checked."""
from ._slabhull import (Domain, Hull, March, Motion, Projection, Slab, SpatialMesh, TrackMotion, __version__, cylinder,
                        ellipsoid, expansion, formula, plane, rotation, sequence, set_thread_count, sphere,
                        thread_count, track_motion, translation)
from ._slabhull import check_hull as _check_hull
from .errors import (Entity, Error, FormatLimit, GeometryError, InputError, Interrupted, LimitError, OutputError,
                     TangledBoundary, TooManyLayers, UsageError)
from .report import Finding, Report, report_of


def check(what, *, betti=False, embedding=True):
    return report_of(_check_hull(what, betti, embedding))
