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
    Array<Point<D>> points;               ///< each used by a cell
    Array<Simplex<D>> cells;              ///< point numbers from 0, of one orientation in each group
    std::vector<std::int32_t> cell_group; ///< of each cell; empty: one group

    /// Boundary facets that belong to a patch, their vertices in any order. A boundary facet that is not
    /// listed, or has patch 0, becomes part of the patch "boundary". If a facet is repeated, the first
    /// counts.
    Array<Facet<D>> facets;
    std::vector<PatchNumber> facet_patch; ///< of each of these; not negative
    PatchList patches; ///< names; a patch without one goes by its number, and one without facets is left out

    /// The facets belong to a larger mesh: those of no cell here are ignored, not refused.
    bool facets_of_more = false;

    std::string where = "domain";            ///< prefix of messages, such as the file's name
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
    IdCounter ids;                         ///< first slab's new ids start here
    std::size_t facets_without_patch = 0;  ///< boundary facets that became the patch "boundary"
    std::vector<std::size_t> inner_facets; ///< input facets inside the domain, without effect; ascending
    /// Repeated facets of the input, ordered by vertices: the first, which counts, and another.
    std::vector<std::array<std::size_t, 2>> repeated_facets;
};

/// Makes a checked domain from a mesh; points and cells keep their order.
/// Throws InputError naming the cells, points or facets at fault: numbers that are out of range, points that
/// are not finite or that no cell uses, cells that are degenerate, inverted against the others of their
/// group, or that overlap; a facet of three cells or more; facets that no cell has; a boundary that is not a
/// closed manifold or that crosses itself. Throws UsageError for arrays of lengths that do not go together.
/// Cost: near-linear.
template<int D>
Domain<D> make_domain(DomainInput<D> input, IdCounter ids = {});

/// The domain inside `boundary` that mesh_cap() meshed as `cap`. Not checked again.
template<int D>
Domain<D> make_domain(CapMesh<D> cap, Surface<D> boundary, IdCounter ids = {});

} // namespace slabhull
