# SPDX-License-Identifier: BSD-3-Clause
"""The heat equation on a filling, by GetFEM's finite elements instead of ours: python3 heat_getfem.py FILL.getfem

Reads what `slabhull fill SLAB FILL.getfem` or `[fill] formats = ["getfem"]` wrote, in 2D + t or 3D + t, with Debian's
python3-getfem. u = exp(-t) cos x cos y (cos z) is given at the slab's start and on its side; prints the relative error
of what comes out and the order of magnitude of a patch test, a u linear in space and time, which must be rounding."""
import sys

import getfem
import numpy


def solve(mesh, solution, source):
    """u in linear elements: integral of (du/dt v + grad u . grad v) = integral of f v."""
    dimension = mesh.dim()
    elements = getfem.MeshFem(mesh, 1)
    elements.set_fem(getfem.Fem(f"FEM_PK({dimension},1)"))
    rule = getfem.MeshIm(mesh, getfem.Integ("IM_SIMPLEX4D(3)" if dimension == 4 else "IM_TETRAHEDRON(3)"))
    exact = solution(elements.basic_dof_nodes())
    given = 1000  # all of the boundary but the terminating cap, whose attribute is 2
    mesh.set_region(given, numpy.hstack([mesh.region(int(r)) for r in mesh.regions() if r != 2]))
    model = getfem.Model("real")
    model.add_fem_variable("u", elements)
    model.add_initialized_fem_data("exact", elements, exact)
    model.add_initialized_fem_data("source", elements, source(elements.basic_dof_nodes()))
    in_space = "[" + ";".join(["1"] * (dimension - 1) + ["0"]) + "]"
    model.add_nonlinear_term(rule, f"Grad_u({dimension})*Test_u + (Grad_u.*{in_space}).Grad_Test_u - source*Test_u")
    model.add_Dirichlet_condition_with_simplification("u", given, "exact")
    model.solve("max_res", 1e-12)
    return numpy.abs(model.variable("u") - exact).max() / numpy.abs(exact).max()


def main():
    getfem.util_trace_level(0)
    mesh = getfem.Mesh("load", sys.argv[1])
    space = mesh.dim() - 1
    linear = solve(mesh, lambda x: 1 + 2 * x[0] - x[1] + 3 * x[-1], lambda x: 3 + 0 * x[0])
    def wave(x):
        return numpy.exp(-x[-1]) * numpy.prod(numpy.cos(x[:-1]), axis=0)
    error = solve(mesh, wave, lambda x: (space - 1) * wave(x))
    print(f"{mesh.nbcvs()} cells, {mesh.nbpts()} points in {space}D + t: error {error:.2e}, patch test {linear:.2e}")
    return 0 if linear < 1e-9 else 1


if __name__ == "__main__":
    sys.exit(main())
