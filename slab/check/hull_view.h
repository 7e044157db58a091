// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/check/findings.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace slabhull {

/// The region of each cell, in two bits.
class RegionList {
public:
    static constexpr std::size_t cells_per_byte = 4;

    /// Puts all cells on the side.
    void reset(std::size_t cells) {
        packed_.assign((cells + cells_per_byte - 1) / cells_per_byte, 0b01010101);
    }
    bool empty() const { return packed_.empty(); }
    Region operator[](std::size_t cell) const {
        return static_cast<Region>(packed_[cell / cells_per_byte] >> shift(cell) & 3u);
    }
    /// Concurrent threads must write different bytes, of cells_per_byte cells each.
    void set(std::size_t cell, Region region) {
        std::uint8_t& four = packed_[cell / cells_per_byte];
        four = static_cast<std::uint8_t>((four & ~(3u << shift(cell))) | static_cast<unsigned>(region)
                                                                             << shift(cell));
    }

private:
    static unsigned shift(std::size_t cell) { return 2 * (cell % cells_per_byte); }

    Array<std::uint8_t> packed_;
};

/// A hull under examination: its claims, and the results of the checks so far.
template<int D>
struct HullView {
    HullColumns<D> hull;
    AdjacencyView<D> adjacency;
    std::array<double, 2> time{};
    RegionList region; ///< of each cell, as its vertices' times show it; in a part also of those outside
    IntegerList track; ///< of each vertex; empty when not given
    std::size_t outside = 0; ///< in a part: cells of others beside it, with numbers after its own

    std::span<const Point<D + 1>> points() const { return hull.points; }
    std::span<const Simplex<D>> cells() const { return hull.cells; }
    double time_of(Index vertex) const { return hull.points[vertex][D]; }
    Region region_of(std::size_t cell) const { return region[cell]; }
    bool in_cap(std::size_t cell) const { return region_of(cell) != Region::intermediate; }
    /// Earliest and latest time of a cell's vertices.
    std::array<double, 2> span_of(std::size_t cell) const {
        std::array<double, 2> span{time_of(hull.cells[cell][0]), time_of(hull.cells[cell][0])};
        for (const Index v : hull.cells[cell]) {
            span[0] = std::min(span[0], time_of(v));
            span[1] = std::max(span[1], time_of(v));
        }
        return span;
    }
};

/// A facet between a cap and the side.
template<int D>
struct BoundaryFacet {
    std::array<TrackId, D> tracks; ///< ascending
    bool odd;                      ///< parity of the outward orientation against the tracks' order
    Facet<D> vertices;             ///< outward, as seen in space
    Index cap_cell;
    Index side_cell;
};

/// Sets a facet's tracks and their parity from its vertices.
template<int D>
void set_tracks(const HullView<D>& view, BoundaryFacet<D>& facet) {
    facet.odd = false;
    for (std::size_t k = 0; k < D; ++k) {
        facet.tracks[k] = view.track[facet.vertices[k]];
        for (std::size_t j = 0; j < k; ++j) {
            facet.odd ^= facet.tracks[j] > facet.tracks[k];
        }
    }
    std::sort(facet.tracks.begin(), facet.tracks.end());
}

/// The boundary facets of the initial and of the terminating cap, sorted by tracks.
template<int D>
using BoundaryFacets = std::array<std::vector<BoundaryFacet<D>>, 2>;

template<int D>
class BoundaryChanges; // boundary_changes.h
template<int D>
struct PartStars; // part_stars.h
class Communicator;

/// Largest sum of normals, relative to the sum of their lengths, that rounding can cause.
inline constexpr double closure_tolerance = 1e-10;

/// Puts the measures of the regions, and what follows from them, into a report. (check.cpp)
template<int D>
void add_measures(const std::array<Measures<D>, 3>& regions, HullReport& report);

// --- check_regions.cpp
// -----------------------------------------------------------------------------------------------

/// Finds the slab's times and the region of each cell, and compares both with the claims.
/// False if a cap is missing, which later checks need.
template<int D>
bool check_regions(HullView<D>& view, Findings& findings);

/// Finds the regions of the cells of one part of a hull, by the slab's times, and compares them with the
/// claims. Tells which regions have a cell.
template<int D>
std::array<bool, 3> check_regions_of_part(HullView<D>& view, Findings& findings);

/// Reports cap cells that do not face out of their cap.
template<int D>
void report_inverted(const HullView<D>& view, std::span<const Index> inverted, Findings& findings);

/// Checks that both caps have the same Euler characteristic, and a hull of dimension 2 twice that.
template<int D>
void check_euler(const HullView<D>& view, const ManifoldCounts& counts, Findings& findings);

/// What the Euler characteristic of a cap follows from (D = 2): it has (3 cells + boundary) / 2 edges.
struct CapCounts {
    std::int64_t vertices = 0;
    std::int64_t cells = 0;
    std::int64_t boundary = 0;
    std::int64_t euler() const { return vertices - (3 * cells + boundary) / 2 + cells; }
};

// --- check_cells.cpp
// ------------------------------------------------------------------------------------------------

/// Results of one pass over the corners of all cells.
template<int D>
struct CellSurvey {
    std::array<Measures<D>, 3> regions;
    std::vector<Index> degenerate; ///< cells that is_degenerate() holds for and that repeat no vertex
    std::vector<Index> inverted;   ///< cap cells that do not face out of their cap
};

/// Needs: the regions. `sign` is 1, or -1 for a hull that is inside out as a whole.
template<int D>
CellSurvey<D> survey_cells(const HullView<D>& view, double sign = 1);

// --- check_tracks.cpp
// ------------------------------------------------------------------------------------------------

/// Checks that each track has one vertex at a time and, on the side, leads from the slab's start to its end,
/// unless a change of the boundary's connectivity begins or ends it.
template<int D>
void check_tracks(const HullView<D>& view, BoundaryChanges<D>& changes, Findings& findings);

/// The facets between caps and side. Checks that their vertices have tracks and that no other cap vertex is
/// on one of these.
template<int D>
BoundaryFacets<D> check_cap_boundaries(const HullView<D>& view, Findings& findings);

/// Checks that the terminating cap's boundary is exactly the image of the initial one's under the tracks and
/// the changes of its connectivity.
template<int D>
void check_boundary_image(const BoundaryFacets<D>& boundary, BoundaryChanges<D>& changes, Findings& findings);

/// Whether check_tracks(), check_cap_boundaries() and check_boundary_image() find nothing in a hull without
/// changes, of which `view` is one part. Collective.
template<int D>
bool tracks_are_sound(const HullView<D>& view, const PartStars<D>& stars, Communicator& ranks);

// --- check_patches.cpp
// -----------------------------------------------------------------------------------------------

/// Checks patch numbers against regions and the list of patches; counts the side's cells by patch.
template<int D>
std::vector<PatchCount> check_patches(const HullView<D>& view, Findings& findings);

/// Checks that the side over each boundary facet has one patch.
template<int D>
void check_patch_columns(const HullView<D>& view, Findings& findings);

/// Whether check_patch_columns() finds nothing in a hull, of which `view` is one part. Collective.
template<int D>
bool patch_columns_agree(const HullView<D>& view, Communicator& ranks);

// --- check_claims.cpp
// ------------------------------------------------------------------------------------------------

/// Reports claims of wrong length or width and removes them.
template<int D>
void check_column_lengths(HullColumns<D>& hull, Findings& findings);
/// Number of cells that begin, or end, at each time.
using TimeCounts = std::map<double, std::size_t>;
/// Numbers of a layer's cells by first time and by last time.
using LayerTimes = std::array<TimeCounts, 2>;
using Layers = std::map<std::int64_t, LayerTimes>;

/// Adds the numbers of one layer to those of the same elsewhere.
void add_layer_times(LayerTimes& sum, const LayerTimes& more);

/// Checks layers against times. Returns their number. `complete` adds the layers of the hull's other parts,
/// where `view` is one of several.
template<int D>
std::size_t check_layers(const HullView<D>& view, Findings& findings,
                         const std::function<void(Layers& layers)>& complete = {});
template<int D>
void check_vertex_ids(const HullView<D>& view, Findings& findings);
template<int D>
void check_neighbors(const HullView<D>& view, Findings& findings);
template<int D>
void check_cell_of_vertex(const HullView<D>& view, Findings& findings);

} // namespace slabhull
