# SPDX-License-Identifier: BSD-3-Clause
"""A solver's loop: a body on a spring, pushed by a fluid that fills less space-time where the body moves into it.
Slabs are predicted, corrected until the push agrees with the motion, and accepted. python3 predictor_corrector.py [--small]"""
import itertools
import sys

import numpy
import slabhull

# %% The mesh lies in arrays: a square of cells around a square body, each cut into two triangles.
small = "--small" in sys.argv
n = 9 if small else 27
low, high = n // 3, n - n // 3
number = {}


def vertex(i, j):
    return number.setdefault((i, j), len(number))


cells = []
for i, j in itertools.product(range(n), repeat=2):
    if not (low <= i < high and low <= j < high):
        a, b, c, d = vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
        cells += [(a, b, c), (a, c, d)]
rim = [(i, low) for i in range(low, high)] + [(high, j) for j in range(low, high)]
rim += [(i, high) for i in range(high, low, -1)] + [(low, j) for j in range(high, low, -1)]
body = [(number[a], number[b]) for a, b in zip(rim, rim[1:] + rim[:1])]
domain = slabhull.Domain(numpy.array(list(number)) / n, cells, facets={"body": body})


# %% The push: what a solver would integrate over the part of the hull that the body sweeps.
def push_of(hull):
    """The mean of x over the cells that the body sweeps, weighted by their area."""
    swept = hull.cells[(hull.region == 1) & (hull.patch == 1)]
    corners = hull.points[swept]
    area = numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    return 1 - 2 * numpy.average(corners[:, :, 0].mean(axis=1), weights=area)


# %% The loop. Every proposal has the same ids on the same vertices, so a solver's unknowns keep their numbers.
march = slabhull.March(domain, reuse="move", split="diagonal")
velocity = 0.3
for step in range(3 if small else 8):
    t = march.time
    levels = numpy.linspace(t, t + 0.2, 3)
    guess, ids = velocity, None
    for corrections in itertools.count(1):
        march.move("body", lambda x, time: numpy.tile([guess, 0.0], (len(x), 1)))
        slab = march.propose(levels)
        assert ids is None or numpy.array_equal(ids, slab.hull.vertex_ids)
        ids = slab.hull.vertex_ids
        corrected = velocity + 0.2 * push_of(slab.hull)
        if abs(corrected - guess) < 1e-12:
            break
        guess = corrected
        assert corrections < 50, "the correction does not converge"
    report = slabhull.check(slab)
    assert report.clean, report
    march.accept(slab)
    velocity = guess
    print(f"slab {slab.hull.slab}: t = {t:.1f} to {march.time:.1f}, {corrections} proposals, velocity {velocity:+.6f}")
