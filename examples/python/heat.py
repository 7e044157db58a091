# SPDX-License-Identifier: BSD-3-Clause
"""The heat equation around a turning body by GetFEM (Debian's python3-getfem) on a slab that is filled with
simplices of space-time. python3 heat.py [--small]

The body is warm (u = 1), the box is cold (u = 0) and so is the domain at the start: du/dt = k times the Laplacian."""
import os
import sys
import tempfile

import getfem
import numpy
import pictures
import slabhull

# %% A slab of the paper's ellipsoid whose cap is moved, so that it can be filled.
small = "--small" in sys.argv
case = slabhull.Case({"initial": {"experiment": "ellipsoid", "level": 1},
                      "time": {"slabs": 16, "layers": 1 if small else 4},
                      "side": {"split": "A"}, "cap": {"reuse": "move"}})
march = case.march()
slab = march.step(case.level_times(0))
filling = slabhull.fill(slab)
report = slabhull.check(filling, hull=slab.hull)
assert report.clean, report
print(filling)

# %% GetFEM reads the filling. Regions are the facets' attributes: 1 initial cap, 2 terminating cap, 2 + patch the side.
getfem.util_trace_level(0)
with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "filling.getfem")
    filling.write(path)
    mesh = getfem.Mesh("load", path)
space = filling.dimension
elements = getfem.MeshFem(mesh, 1)
elements.set_fem(getfem.Fem(f"FEM_PK({space + 1},1)"))
rule = getfem.MeshIm(mesh, getfem.Integ("IM_SIMPLEX4D(3)" if space == 3 else "IM_TETRAHEDRON(3)"))

# %% The equation in linear elements; u is given where the slab begins and on its side.
given = 1000
mesh.set_region(given, numpy.hstack([mesh.region(int(r)) for r in mesh.regions() if r != 2]))
warm = [number for number, name in filling.patches.items() if name != "walls"]
on_body = numpy.zeros(len(filling.points))
on_body[filling.facets[numpy.isin(filling.facet_attribute, [2 + number for number in warm])]] = 1
vertex_of = {tuple(point): v for v, point in enumerate(filling.points)}
order = numpy.array([vertex_of[tuple(point)] for point in elements.basic_dof_nodes().T])
model = getfem.Model("real")
model.add_fem_variable("u", elements)
model.add_initialized_fem_data("wanted", elements, on_body[order])
model.add_initialized_data("k", [0.5])
in_space = "[" + ";".join(["1"] * space + ["0"]) + "]"
model.add_nonlinear_term(rule, f"Grad_u({space + 1})*Test_u + k*(Grad_u.*{in_space}).Grad_Test_u")
model.add_Dirichlet_condition_with_simplification("u", given, "wanted")
model.solve("max_res", 1e-10)
u = numpy.empty(len(filling.points))
u[order] = model.variable("u")
print(f"u from {u.min():.3f} to {u.max():.3f}")
assert u.max() > 0.99

# %% The domain's mesh at the end, with u on it: a VTU for ParaView, and a picture of the cells with z < 0.
section = slabhull.slice(filling, filling.time[1])
section.write("heat.vtu", {"u": u})
at_points = section.value(u)
kept = (section.points[section.cells].mean(axis=1)[:, 2] < 0) & (abs(section.points[section.cells]) < 4.5).all((1, 2))
outer = []
for i in range(space + 1):
    across = section.neighbors[:, i]
    shown = kept & ~(kept[across] & (across >= 0))
    outer.append(numpy.delete(section.cells[shown], i, axis=1))
outer = numpy.concatenate(outer)
temperature = numpy.clip(at_points[outer].mean(axis=1), 0, 1)
colours = numpy.stack([0.3 + 0.65 * temperature, 0.45 + 0 * temperature, 0.9 - 0.7 * temperature], axis=1)
print("drawn:", pictures.draw([section.points[outer]], "heat", [colours]), "and heat.vtu")
