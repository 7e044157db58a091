// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/column.h"
#include "slabhull/core/error.h"
#include "slabhull/core/patch.h"
#include "slabhull/core/point.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/hull.h"
#include "slabhull/topology/manifold.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slabhull {

/// What can be wrong with a hull or a spatial mesh. defect_name() gives the stable name of each in reports.
enum class Defect {
    // The columns themselves
    no_cells,
    column_length,      ///< a claim has a wrong number of rows or components
    index_out_of_range, ///< a cell names a vertex that does not exist
    non_finite_coordinate,
    // Connectivity: see ManifoldDefect
    repeated_vertex,
    duplicate_cell,
    unused_vertex,
    open_facet,
    overfull_facet,
    disoriented_facet,
    singular_edge,
    singular_vertex,
    euler_mismatch, ///< the hull's Euler characteristic is not the one that follows from its caps (D = 2)
    // Shape
    coincident_vertices,
    degenerate_cell,    ///< measure below 1e-14 of what its lengths and its duration allow
    not_closed,         ///< sum of normals is not zero to rounding, though every facet is closed
    inward_orientation, ///< the enclosed measure is not positive
    inverted_cell,      ///< a cap cell facing into its cap; in a spatial mesh, a sign other than most
    self_crossing,      ///< two cells meet elsewhere than in the face they share: check_embedding()
    // Time and regions
    no_duration,     ///< all vertices at one time
    wrong_slab_time, ///< no cap at a claimed time of the slab
    time_outside_slab,
    missing_cap,
    cap_not_flat,   ///< a cell claimed for a cap has vertices off the cap's time
    wrong_region,   ///< claimed for another region than its vertices' times show
    flat_side_cell, ///< a side cell at one instant
    // Boundary and tracks
    untracked_boundary,      ///< a vertex where a cap meets the side has no track
    stray_track,             ///< a vertex inside a cap is on a track of the boundary
    track_repeats_time,      ///< two vertices of a track at one time
    track_incomplete,        ///< a track does not lead from the slab's start to its end
    boundary_facet_lost,     ///< the terminating cap lacks the image of a facet of the initial cap's boundary
    boundary_facet_added,    ///< the terminating cap's boundary has a facet that is not such an image
    boundary_facet_reversed, ///< the image is there, with the other orientation
    // Claims
    negative_vertex_id,
    duplicate_vertex_id,
    wrong_patch,    ///< not positive on the side, or not 0 in a cap
    unknown_patch,  ///< not in the list of patches
    patch_mismatch, ///< the side over one boundary facet carries different patches
    wrong_layer,    ///< not -1 in a cap, negative on the side, or the cell's times are not those of its layer
    layer_gap,      ///< a layer is empty, or does not start where the one before ends
    wrong_neighbor,
    wrong_vertex_cell, ///< the cell claimed to use a vertex does not
    // Spatial meshes only
    folded_facet,             ///< two cells of the same sign on the same side of their common facet
    singular_boundary_ridge,  ///< not two boundary facets meet there (D = 3: an edge, D = 2: a vertex)
    singular_boundary_vertex, ///< boundary facets at the vertex are not one fan (D = 3)
    // Fillings only: see check_filling.h
    hull_facet_lost,     ///< no simplex of the filling has this facet of the hull
    hull_facet_added,    ///< a facet in one simplex only that the hull does not have
    hull_facet_reversed, ///< the facet is the hull's, with the other orientation
    hull_vertex_moved,   ///< a vertex of the hull is elsewhere in the filling
    wrong_attribute,     ///< a facet's attribute is not that of its region and patch in the hull
    volume_mismatch      ///< the simplices' volume is not the measure that their boundary encloses
};
inline constexpr std::size_t defect_kinds = static_cast<std::size_t>(Defect::volume_mismatch) + 1;

/// Such as "open-facet".
std::string_view defect_name(Defect what);

struct Finding {
    Defect what;
    std::vector<Entity> entities; ///< kinds "vertex", "cell", "track", "patch", "layer"; the main one first
    std::string text;             ///< a line for the user
};

struct CheckOptions {
    std::size_t betti_cells = 0;    ///< also compute Betti numbers of hulls with at most so many cells
    std::size_t most_findings = 20; ///< kept of each kind; all are counted
    /// The user's numbers of vertices and cells; empty: counted from 0.
    std::function<std::int64_t(Index)> vertex_number;
    std::function<std::int64_t(Index)> cell_number;
};

/// The findings of a check, and the checks that they made impossible.
struct CheckResult {
    std::vector<Finding> findings;
    std::array<std::size_t, defect_kinds> found{}; ///< of each kind, kept or not
    std::vector<std::string> skipped;              ///< checks not done, each with its reason

    std::size_t count(Defect what) const { return found[static_cast<std::size_t>(what)]; }
    std::size_t total() const;
    bool clean() const { return total() == 0; }
};

/// The findings as lines of text, kind by kind, with the number of those not kept.
std::string findings_as_text(const CheckResult& result);

/// A hull as a file has it: points, cells, and optional claims.
/// What it refers to must outlive it.
template<int D>
struct HullColumns {
    std::span<const Point<D + 1>> points; ///< time last
    std::span<const Simplex<D>> cells;

    Column<std::int64_t> region;
    Column<std::int64_t> patch;
    Column<std::int64_t> layer;
    Column<std::int64_t> neighbors; ///< D + 1 components; -1 for none
    Column<std::int64_t> vertex_id;
    Column<std::int64_t> track_id;
    Column<std::int64_t> cell_of_vertex;
    PatchList patches; ///< empty: not given
    std::optional<std::array<double, 2>> time;

    /// `neighbors` as a table in memory, if there is one. If it proves right, no other is built.
    std::span<const Neighbors<D>> neighbor_table = {};
};

/// The columns of a hull, which must outlive them; without cell_of_vertex, which a hull does not store.
template<int D>
HullColumns<D> columns_of(const Hull<D>& hull);

struct PatchCount {
    PatchNumber number = 0;
    std::size_t cells = 0;
};

struct HullReport : CheckResult {
    int dimension = 0;
    ManifoldCounts counts;
    bool table_confirmed = false;                 ///< the neighbor_table was given and found right
    std::array<double, 2> time{};                 ///< as the vertices show it
    std::array<std::size_t, 3> cells_by_region{}; ///< as the vertices' times show it
    std::vector<PatchCount> cells_by_patch;       ///< of the side, by number, as claimed
    std::size_t layers = 0;                       ///< as claimed
    double measure = 0;
    std::array<double, 3> measure_by_region{};
    double enclosed = 0;
    double closure = 0; ///< |sum of N|
    AngleRange angles{180, 0};
    std::vector<std::size_t> betti; ///< empty unless asked for and the hull is a manifold
};

/// Checks a hull completely. Recomputes everything from connectivity and coordinates; claims are only
/// compared. Checks build on each other: those whose basis is missing are listed as skipped. Cost:
/// near-linear; about 5 extra bytes per cell of a sound hull with a neighbor_table, else 30 (95 with Betti
/// numbers). The same report for any number of threads.
template<int D>
HullReport check_hull(const HullColumns<D>& hull, const CheckOptions& options = {});

/// The same for a hull as the library builds it.
template<int D>
HullReport check_hull(const Hull<D>& hull, const CheckOptions& options = {}) {
    return check_hull<D>(columns_of(hull), options);
}

struct MeshReport : CheckResult {
    int dimension = 0;
    std::size_t vertices = 0; ///< used ones
    std::size_t cells = 0;
    std::size_t boundary_facets = 0;
    std::size_t components = 0;
    int orientation = 1; ///< sign of most cells
    double measure = 0;  ///< of all cells, positive when most are
    AngleRange angles{180, 0};
};

/// Checks a spatial mesh in R^D: cells, facets and boundary.
template<int D>
MeshReport check_mesh(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
                      const CheckOptions& options = {});

} // namespace slabhull
