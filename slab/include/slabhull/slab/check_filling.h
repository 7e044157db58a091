// SPDX-License-Identifier: BSD-3-Clause
// The check of space-time meshes that fill a slab.
#pragma once

#include "slabhull/core/column.h"
#include "slabhull/slab/check.h"
#include "slabhull/topology/filling.h"
#include "slabhull/topology/hull.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>

namespace slabhull {

/// A filling as a file has it: simplices of dimension D + 1, and optional claims. What it refers to must
/// outlive it.
template<int D>
struct FillingColumns {
    std::span<const Point<D + 1>> points; ///< time last
    std::span<const Simplex<D + 1>> cells;

    /// The boundary, whose normals point out; empty: not given.
    std::span<const Simplex<D>> facets;
    Column<std::int64_t> facet_attribute;
    std::span<const Neighbors<D + 1>> neighbors; ///< empty: not given
};

template<int D>
FillingColumns<D> columns_of(const Filling<D>& filling);

struct FillingReport : CheckResult {
    int dimension = 0; ///< of space
    std::size_t vertices = 0;
    std::size_t cells = 0;
    std::size_t boundary_facets = 0;                         ///< facets in one simplex
    std::array<double, 2> time{};                            ///< of the vertices
    double volume = 0;                                       ///< of all simplices
    double enclosed = 0;                                     ///< volume enclosed by the facets in one simplex
    double smallest_volume = 0;                              ///< signed volume of a simplex
    std::map<std::int64_t, std::size_t> facets_by_attribute; ///< as claimed
};

/// Checks a filling from its cells and coordinates, and compares with its claims: every simplex positive by
/// exact sign, facets in two agreeing simplices inside and in one on the boundary, no vertex unused or
/// double, simplices around each vertex once, a boundary that is a manifold, and the volume that the boundary
/// encloses, within 1e-12. With a hull: the boundary facets are exactly the hull's cells, with the same
/// orientation, and the hull's vertices are the first, bit for bit.
///
/// Positive simplices that are paired across all inner facets, and whose boundary is embedded and occurs
/// once, cover the slab exactly once: a point is covered as often as the boundary winds around it. So the
/// filling of a hull whose check is clean and that does not cross itself has no overlap and no gap. The links
/// of its vertices are spheres inside and balls on the hull; docs/filling.md says what is proven without a
/// hull.
///
/// Cost: near-linear; some 60 extra bytes per simplex. The same report for any number of threads.
template<int D>
FillingReport check_filling(const FillingColumns<D>& filling, const Hull<D>* hull = nullptr,
                            const CheckOptions& options = {});

} // namespace slabhull
