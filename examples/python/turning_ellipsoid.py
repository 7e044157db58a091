# SPDX-License-Identifier: BSD-3-Clause
"""The paper's turning ellipsoid: march, check, cut, draw. python3 turning_ellipsoid.py [--small]"""
import sys

import numpy
import pictures
import slabhull

# %% The case as its file would say it: an ellipsoid that makes a quarter turn about z in a box.
small = "--small" in sys.argv
case = slabhull.Case({"initial": {"experiment": "ellipsoid", "level": 1},
                      "time": {"slabs": 2 if small else 4, "layers": 2 if small else 6}})
march = case.march()
print(f"{march.dimension}D + t, patches {march.patches}, {len(march.cap.cells)} tetrahedra at the start")

# %% Slab after slab. A hull's arrays are views of numpy: nothing is copied.
slabs = []
for k in range(case.slabs):
    slab = march.step(case.level_times(k))
    print(slab.hull)
    print(" ", slabhull.check(slab))
    slabs.append(slab)

# %% How fast each cell of the side moves along its normal: N = (n, -v_n) up to a factor.
hull = slabs[0].hull
side = hull.region == 1
corners = hull.points[hull.cells[side]]
edges = corners[:, 1:] - corners[:, :1]
normal = numpy.stack([(-1) ** (i + 1) * numpy.linalg.det(numpy.delete(edges, i, axis=2)) for i in range(4)], axis=1)
speed = abs(normal[:, 3]) / numpy.linalg.norm(normal[:, :3], axis=1)
print(f"largest normal speed of the side {speed.max():.3f}")

# %% Sections: the boundary of the domain at any instant. The body is the patch that is not the walls.
times = numpy.linspace(case.start, case.end, 4)
scenes = []
for time in times:
    slab = next(each for each in slabs if each.hull.time[0] <= time <= each.hull.time[1])
    section = slabhull.slice(slab, time)
    print(f"t = {time:.3f}: areas {section.measure_by_patch}, encloses {section.enclosed:.6f}")
    body = [number for number, name in section.patches.items() if name != "walls"]
    scenes.append(section.points[section.facets[numpy.isin(section.patch, body)]])

# %% A picture, side by side.
print("drawn:", pictures.draw(scenes, "turning_ellipsoid"))
