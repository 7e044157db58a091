// SPDX-License-Identifier: BSD-3-Clause
// Filling a hull with simplices, so that a solver can run on the slab.
#pragma once

#include "slabhull/slab/check.h"
#include "slabhull/slab/stage_clock.h"
#include "slabhull/topology/filling.h"
#include "slabhull/topology/hull.h"

namespace slabhull {

/// Fills a slab whose terminating cap is the initial one moved (CapReuse::move), by extrusion: between two
/// levels each cell of the cap sweeps a prism. Prisms whose quadrilaterals have the diagonals that the
/// tracks' order gives become D + 1 simplices and no new vertex; those that meet another split of the hull's
/// side are coned from their centres. Vertices inside the caps are placed on every inner level by move_cap().
///
/// Cells stand by layer, then by cell of the initial cap. Their signs are exact.
///
/// Needs: a sound hull (check_hull()) whose vertices on levels all have tracks.
/// Throws GeometryError when the caps are not one mesh, naming the cells that differ; naming cell and layer
/// where a simplex would be inside out, with what helps: more layers, or a shorter slab.
/// LimitError when the filling is too large for its indices.
/// Cost: linear, but for move_cap() on each inner level. The same bytes with any number of threads.
template<int D>
Filling<D> fill_slab(const Hull<D>& hull, StageClock& clock);
template<int D>
Filling<D> fill_slab(const Hull<D>& hull);

struct UnstructuredFill {
    /// The length that a unit of time counts for, for spacings and shapes. 0: a layer's duration counts for
    /// about the mean edge of the initial cap. Powers of two are free of rounding.
    double time_scale = 0;
};

/// Fills a hull in 2D + t, whatever its caps, with tetrahedra by TetGen in a child process (mesh_cap<3>): the
/// surface is kept, vertices inside are new and in no order of time. Verified as a cap is; signs are exact.
/// Needs: a sound hull that does not cross itself. Throws GeometryError as mesh_cap() does, and where scaling
/// time back turns a tetrahedron inside out by rounding; UsageError for a build without TetGen and for a
/// time scale that is none. Cost: that of mesh_cap().
Filling<2> fill_unstructured(const Hull<2>& hull, StageClock& clock, const UnstructuredFill& options = {});

/// A hull from the columns of a file: what `build` writes, cells and points in the order of Hull<D>.
/// Needs: columns whose check_hull() is clean. Throws GeometryError for tracks that are not given and for
/// another order of the cells or points (as renumbering leaves it), naming the first cell or vertex out of
/// it.
template<int D>
Hull<D> hull_of_columns(const HullColumns<D>& columns);

} // namespace slabhull
