// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/integer_list.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace slabhull {

/// Part of the boundary of a slab; the values are those in files.
enum class Region : int { initial = 0, intermediate = 1, terminating = 2 };

/// Cells of a hull's side over one facet of the boundary, or one change of it, in one layer.
struct SidePart {
    Index first; ///< the part's first cell
    PatchNumber patch;
    std::int32_t layer;
};

/// In which order the cells and the points of a hull stand, and what follows from that: all that a rank which
/// holds some of the cells knows of the others.
///
/// Cells are stored in the order initial cap, side, terminating cap; the side by layer, then by boundary
/// facet, then by place in the prism's split. So region, layer and patch of a cell follow from its number and
/// cost nothing.
template<int D>
struct HullOrder {
    std::size_t initial_points = 0; ///< vertices of the initial cap come first,
    std::size_t side_points = 0;    ///< then those in neither cap, then the terminating cap's
    std::size_t initial_cells = 0;
    std::size_t side_cells = 0;
    std::size_t layers = 0;
    std::size_t cells_per_prism = 1;
    std::vector<PatchNumber> facet_patch; ///< of each boundary facet that is swept (of the last level's)
    /// Of a side over a boundary that changes from layer to layer, instead of equal prisms; else empty.
    std::vector<SidePart> side_parts;
    PatchList patches;

    int slab = 0;
    std::array<double, 2> time{}; ///< start and end of the slab

    /// Of a cap that was adapted, what it was held to, so that its changes can be made again when the hull is
    /// filled (slab/adapt.h: settings_as_numbers()), and the target length at each swept vertex; else empty.
    std::vector<double> adapt_settings;
    std::vector<double> adapt_spacing;

    /// Whether the boundary's connectivity changes within the slab, so that tracks on the side may begin and
    /// end there.
    bool boundary_changes() const { return !side_parts.empty(); }

    std::size_t terminating_begin() const { return initial_cells + side_cells; }
    std::size_t terminating_points_begin() const { return initial_points + side_points; }

    Region region(std::size_t cell) const {
        if (cell < initial_cells) {
            return Region::initial;
        }
        return cell < terminating_begin() ? Region::intermediate : Region::terminating;
    }
    /// Time layer of a side cell from 0, -1 for cap cells.
    int layer(std::size_t cell) const {
        if (region(cell) != Region::intermediate) {
            return -1;
        }
        return side_parts.empty() ? static_cast<int>(prism(cell) / facet_patch.size()) : part(cell)->layer;
    }
    /// Patch of a side cell, 0 for cap cells.
    PatchNumber patch(std::size_t cell) const {
        if (region(cell) != Region::intermediate) {
            return 0;
        }
        return side_parts.empty() ? facet_patch[prism(cell) % facet_patch.size()] : part(cell)->patch;
    }

    /// The cell after the last one of a cell's region; a number above all cells for the terminating cap.
    std::size_t region_end(std::size_t cell) const {
        if (cell < initial_cells) {
            return initial_cells;
        }
        return cell < terminating_begin() ? terminating_begin() : std::numeric_limits<std::size_t>::max();
    }
    /// The same for a side cell's prism and its layer; for a cap's, its region.
    std::size_t prism_end(std::size_t cell) const {
        if (side_parts.empty() || region(cell) != Region::intermediate) {
            return end_by(cells_per_prism, cell);
        }
        const auto next = part(cell) + 1;
        return next == side_parts.end() ? terminating_begin() : next->first;
    }
    std::size_t layer_end(std::size_t cell) const {
        return side_parts.empty() ? end_by(facet_patch.size() * cells_per_prism, cell) : prism_end(cell);
    }

private:
    std::vector<SidePart>::const_iterator part(std::size_t cell) const {
        return std::upper_bound(side_parts.begin(), side_parts.end(), cell,
                                [](std::size_t c, const SidePart& each) { return c < each.first; }) -
               1;
    }
    std::size_t end_by(std::size_t length, std::size_t cell) const {
        return region(cell) == Region::intermediate
                   ? initial_cells + ((cell - initial_cells) / length + 1) * length
                   : region_end(cell);
    }
    std::size_t prism(std::size_t cell) const { return (cell - initial_cells) / cells_per_prism; }
};

/// The boundary of one space-time slab: a closed D-manifold of D-simplices in R^(D+1), time last. Each
/// simplex is ordered so that its normal N, det[e_1 .. e_D, N] > 0, points out of the slab.
template<int D>
struct Hull : HullOrder<D> {
    Array<Point<D + 1>> points;
    Array<Simplex<D>> cells;
    Array<Neighbors<D>> neighbors; ///< closed: every entry names a cell
    IntegerList vertex_ids;
    IntegerList track_ids;

    /// Those of HullOrder; the terminating cap ends with the cells.
    std::size_t region_end(std::size_t cell) const {
        return std::min(HullOrder<D>::region_end(cell), cells.size());
    }
    std::size_t prism_end(std::size_t cell) const {
        return std::min(HullOrder<D>::prism_end(cell), cells.size());
    }
    std::size_t layer_end(std::size_t cell) const {
        return std::min(HullOrder<D>::layer_end(cell), cells.size());
    }
};

} // namespace slabhull
