// SPDX-License-Identifier: BSD-3-Clause
#include "slab/stitch/cap_boundary.h"
#include "core/hash.h"
#include "core/pieces.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>
#include <span>
#include <vector>

namespace slabhull {

namespace {

constexpr std::size_t cells_per_piece = 1 << 15;

/// The facet rotated so that the smallest vertex comes first: a unique form of an oriented facet.
template<int D>
Facet<D> canonical(Facet<D> facet) {
    if constexpr (D == 3) {
        std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
    }
    return facet;
}

/// Finds a boundary facet by its vertices.
template<int D>
class FacetTable {
public:
    explicit FacetTable(std::span<const Facet<D>> facets) : facets_{facets} {
        shift_ = 64 - std::bit_width(2 * facets.size() | 2);
        first_.assign(std::size_t{1} << (64 - shift_), no_index);
        next_.resize(facets.size());
        for (Index f = 0; f < facets.size(); ++f) {
            Index& first = first_[hash(canonical<D>(facets[f]))];
            next_[f] = first;
            first = f;
        }
    }

    /// no_index when there is none.
    Index find(const Facet<D>& wanted) const {
        const Facet<D> key = canonical<D>(wanted);
        Index f = first_[hash(key)];
        while (f != no_index && canonical<D>(facets_[f]) != key) {
            f = next_[f];
        }
        return f;
    }

private:
    std::size_t hash(const Facet<D>& key) const {
        return static_cast<std::size_t>(multiplied_hash(hash_of_all(key)) >> shift_);
    }

    std::span<const Facet<D>> facets_;
    int shift_;
    Array<Index> first_;
    Array<Index> next_; ///< next facet with the same hash
};

[[noreturn]] void refuse(const std::string& what) {
    throw GeometryError("a cap does not fit its boundary: " + what);
}

/// A facet of a cell that has no neighbour, and which boundary facet it is.
struct OpenCellFacet {
    Index boundary_facet;
    CellFacet at;
};

/// Those of some cells of a mesh, the first of which has the number `first`.
template<int D>
std::vector<OpenCellFacet> open_facets(const SpatialMesh<D>& mesh, std::span<const Simplex<D>> cells,
                                       std::span<const Neighbors<D>> neighbors, std::size_t first) {
    const FacetTable<D> table{mesh.boundary_facets};
    return parallel_gather<OpenCellFacet>(
        cells.size(), cells_per_piece,
        [&](std::size_t begin, std::size_t end, std::vector<OpenCellFacet>& found) {
            for (std::size_t c = begin; c < end; ++c) {
                for (std::size_t i = 0; i <= D; ++i) {
                    if (neighbors[c][i] != no_index) {
                        continue;
                    }
                    const Index f = table.find(outward_facet<D>(cells[c], static_cast<int>(i)));
                    if (f == no_index) {
                        refuse(fmt::format("facet {} of cell {} has no neighbour and is not on the boundary",
                                           i, first + c));
                    }
                    found.push_back({f, {static_cast<Index>(first + c), static_cast<std::uint8_t>(i)}});
                }
            }
        });
}

/// In the order of the boundary. `open`: all lists of them.
template<int D, class Lists>
Array<CellFacet> in_order(const SpatialMesh<D>& mesh, const Lists& open) {
    Array<CellFacet> found(mesh.boundary_facets.size(), CellFacet{});
    std::size_t count = 0;
    for (const auto& list : open) {
        for (const OpenCellFacet& facet : list) {
            found[facet.boundary_facet] = facet.at;
            ++count;
        }
    }
    for (std::size_t f = 0; f < found.size(); ++f) {
        if (found[f].cell == no_index) {
            refuse(fmt::format("no cell has boundary facet {} of vertices {}", f,
                               fmt::join(mesh.boundary_facets[f], ", ")));
        }
    }
    if (count != found.size()) {
        refuse(fmt::format("{} facets of cells have no neighbour, and the boundary has {}", count,
                           found.size()));
    }
    return found;
}

} // namespace

template<int D>
Array<CellFacet> find_boundary_facets(const SpatialMesh<D>& mesh) {
    return in_order<D>(mesh, std::array{open_facets<D>(mesh, mesh.cells, mesh.neighbors, 0)});
}

template<int D>
Array<CellFacet> find_boundary_facets(const SpatialMesh<D>& mesh, const CapCells<D>& cells,
                                      Communicator& ranks) {
    const auto mine = together(
        ranks, [&] { return open_facets<D>(mesh, cells.cells, cells.neighbors, cells.range.first); });
    return in_order<D>(mesh, ranks.all_gather<OpenCellFacet>(mine));
}

template Array<CellFacet> find_boundary_facets<2>(const SpatialMesh<2>&);
template Array<CellFacet> find_boundary_facets<3>(const SpatialMesh<3>&);
template Array<CellFacet> find_boundary_facets<2>(const SpatialMesh<2>&, const CapCells<2>&, Communicator&);
template Array<CellFacet> find_boundary_facets<3>(const SpatialMesh<3>&, const CapCells<3>&, Communicator&);

} // namespace slabhull
