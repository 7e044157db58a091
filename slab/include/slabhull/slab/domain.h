// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/slab/id_counter.h"
#include "slabhull/topology/spatial_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace slabhull {

template<int D>
struct CapMesh;

/// A meshed domain as a solver or a mesh file has it: plain arrays, with names for messages.
template<int D>
struct DomainInput {
    Array<Point<D>> points;  ///< each used by a cell
    Array<Simplex<D>> cells; ///< numbers of points, from 0; all of one orientation, or of one in each group
    std::vector<std::int32_t> cell_group; ///< of each cell; empty: one group

    /// Boundary facets that belong to a patch, their vertices in any order. A boundary facet that is not
    /// here, or has patch 0, becomes part of the patch "boundary". Of a facet that is here twice, the first
    /// counts.
    Array<Facet<D>> facets;
    std::vector<PatchNumber> facet_patch; ///< of each of these; not negative
    PatchList patches; ///< names; a patch without one goes by its number, and one without facets is left out

    /// The facets are those of a larger mesh: those that no cell here has are passed over, not refused.
    bool facets_of_more = false;

    std::string where = "domain";            ///< put first in messages, such as the name of the file
    std::vector<std::int64_t> cell_numbers;  ///< the user's number of each cell; empty: from 0
    std::vector<std::int64_t> facet_numbers; ///< the same for `facets`
    std::vector<std::int64_t> point_numbers; ///< the same for `points`
};

/// A checked domain that a march starts from.
template<int D>
struct Domain {
    /// Cells are positive. Boundary facets are outward, sorted by patch. Vertices have persistent ids in
    /// their order, and those of the boundary have tracks from 0, in the same order.
    SpatialMesh<D> mesh;
    IdCounter ids;                         ///< what the first slab counts from
    std::size_t facets_without_patch = 0;  ///< boundary facets that became the patch "boundary"
    std::vector<std::size_t> inner_facets; ///< of the input: inside the domain, so without effect; ascending
    /// Facets that the input has twice: the first, which counts, and another. By their vertices.
    std::vector<std::array<std::size_t, 2>> repeated_facets;
};

/// The domain that a mesh is, with points and cells in their order.
/// Throws InputError naming the cells, points or facets at fault: numbers that are out of range, points that
/// are not finite or that no cell uses, cells that are degenerate, inverted against the others of their
/// group, or that overlap; a facet of three cells or more; facets that no cell has; a boundary that is not a
/// closed manifold or that crosses itself. Throws UsageError for arrays of lengths that do not go together.
/// Cost: near-linear.
template<int D>
Domain<D> make_domain(DomainInput<D> input, IdCounter ids = {});

/// The domain that was meshed as `cap` inside `boundary`: mesh_cap() gives the cap for it. Not checked again.
template<int D>
Domain<D> make_domain(CapMesh<D> cap, Surface<D> boundary, IdCounter ids = {});

} // namespace slabhull
