// SPDX-License-Identifier: BSD-3-Clause
// Filling a hull with simplices, so that a solver can run on the slab.
#pragma once

#include "slabhull/slab/check.h"
#include "slabhull/slab/slab.h"
#include "slabhull/slab/stage_clock.h"
#include "slabhull/topology/filling.h"
#include "slabhull/topology/hull.h"

namespace slabhull {

/// Fills a slab whose terminating cap is the initial one moved (CapReuse::move), by extrusion: between two
/// levels each cell of the cap sweeps a prism. A prism with the diagonals that the order of tracks gives
/// becomes D + 1 simplices without new vertices; one that meets another split on the hull's side is coned
/// from its centre. Vertices inside the caps are placed on every inner level by move_cap().
///
/// Cells stand by layer, then by cell of the initial cap. Their signs are exact. A cap that was adapted
/// (Hull::adapt_settings) is adapted again to learn what happened inside, then filled by fill_adapted().
///
/// Needs: a sound hull (check_hull()) whose vertices on levels all have tracks.
/// Throws GeometryError when the caps are not one mesh, naming the cells that differ; naming cell and layer
/// where a simplex would be inverted, and the remedy: more layers, or a shorter slab.
/// LimitError when the filling is too large for its indices.
/// Cost: linear, but for move_cap() on each inner level. The same bytes with any number of threads.
template<int D>
Filling<D> fill_slab(const Hull<D>& hull, StageClock& clock);
template<int D>
Filling<D> fill_slab(const Hull<D>& hull);

/// Fills a slab whose cap was moved and changed (CapReuse::adapt): prisms where nothing changed in a layer,
/// split as fill_slab() does, and a cone over each operation's cells. `log` is the slab's own. Throws as
/// fill_slab() does. Cost: near-linear; some twice that of fill_slab().
template<int D>
Filling<D> fill_adapted(const Hull<D>& hull, const AdaptLog<D>& log, StageClock& clock);

/// Fills a slab whose cap was moved or adapted, by the one or the other. Throws as they do.
template<int D>
Filling<D> fill_slab(const Slab<D>& slab, StageClock& clock);
template<int D>
Filling<D> fill_slab(const Slab<D>& slab);

struct UnstructuredFill {
    /// Length that a unit of time counts for in spacings and shapes. 0: a layer's duration counts for about
    /// the mean edge of the initial cap. Powers of two cause no rounding.
    double time_scale = 0;
};

/// Fills a hull in 2D + t, whose caps may differ, with tetrahedra by TetGen in a child process (mesh_cap<3>).
/// The surface is kept; inner vertices are new and lie on no levels. Verified as a cap is; signs are exact.
/// Needs: a sound hull that does not cross itself. Throws GeometryError as mesh_cap() does, and where scaling
/// time back turns a tetrahedron inside out by rounding; UsageError for a build without TetGen and for an
/// invalid time scale. Cost: that of mesh_cap().
Filling<2> fill_unstructured(const Hull<2>& hull, StageClock& clock, const UnstructuredFill& options = {});

/// A hull from the columns of a file: what `build` writes, cells and points in the order of Hull<D>.
/// Needs: columns whose check_hull() is clean. Throws GeometryError if tracks are missing, or if cells or
/// points are in another order (as after renumbering), naming the first cell or vertex out of order.
template<int D>
Hull<D> hull_of_columns(const HullColumns<D>& columns);

} // namespace slabhull
