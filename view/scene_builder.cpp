// SPDX-License-Identifier: BSD-3-Clause
#include "view/scene_builder.h"

#include "slabhull/core/error.h"
#include "slabhull/slab/slice.h"
#include "slabhull/slab/slice_filling.h"
#include "view/thin_side.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <numeric>
#include <span>

namespace slabhull {

namespace {

/// All rows of a column, or -1 for each where it is not given.
Array<std::int64_t> rows_of(const Column<std::int64_t>& column, std::size_t count, const char* name) {
    Array<std::int64_t> rows;
    rows.assign(count, -1);
    if (column.given()) {
        if (column.rows() != count || column.components() != 1) {
            throw InputError{fmt::format("{}: {} values for {} entities", name, column.rows(), count)};
        }
        column.fill(0, count, rows.data());
    }
    return rows;
}

/// Digits in groups of three.
std::string grouped(std::size_t number) {
    std::string text = std::to_string(number);
    for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3) {
        text.insert(static_cast<std::size_t>(at), ",");
    }
    return text;
}

// --- Vertices and cells of one slab -------------------------------------------------------------------

/// Vertices of a slab, with time last.
template<int D>
struct SlabVertices {
    std::span<const Point<D + 1>> points;
    Array<std::int64_t> ids, tracks;
};

/// Takes cells into a scene; a vertex gets its number with the first cell that has it.
template<int D>
class CellTaker {
public:
    CellTaker(Scene& scene, const SlabVertices<D>& vertices) : scene_{scene}, vertices_{vertices} {
        numbers_.assign(vertices.points.size(), no_index);
    }

    template<std::size_t N>
    void take(const std::array<Index, N>& cell, Array<Index>& cells) {
        for (const Index vertex : cell) {
            if (numbers_[vertex] == no_index) {
                numbers_[vertex] = number_of(vertex);
            }
            cells.push_back(numbers_[vertex]);
        }
    }

private:
    Index number_of(Index vertex) {
        const Point<D + 1>& point = vertices_.points[vertex];
        for (std::size_t k = 0; k < D; ++k) {
            scene_.points.push_back(static_cast<float>(point[k] - scene_.centre[k]));
        }
        scene_.times.push_back(point[D]);
        scene_.ids.push_back(vertices_.ids[vertex]);
        scene_.tracks.push_back(vertices_.tracks[vertex]);
        return checked_index(scene_.times.size() - 1, "vertices of the page");
    }

    Scene& scene_;
    const SlabVertices<D>& vertices_;
    Array<Index> numbers_; ///< in the scene
};

/// First and last time of a cell.
template<int D, std::size_t N>
std::array<double, 2> span_of(const std::array<Index, N>& cell, std::span<const Point<D + 1>> points) {
    std::array<double, 2> span{points[cell[0]][D], points[cell[0]][D]};
    for (const Index vertex : cell) {
        span = {std::min(span[0], points[vertex][D]), std::max(span[1], points[vertex][D])};
    }
    return span;
}

/// Sorts numbers of cells by their first times, so that an instant meets few pieces of the list.
template<int D, std::size_t N>
void sort_by_start(std::vector<Index>& numbers, std::span<const std::array<Index, N>> cells,
                   std::span<const Point<D + 1>> points) {
    std::stable_sort(numbers.begin(), numbers.end(), [&](Index a, Index b) {
        return span_of<D>(cells[a], points)[0] < span_of<D>(cells[b], points)[0];
    });
}

/// Numbers of cells; those that last are the side's, the others the caps'.
struct CellKinds {
    std::vector<Index> side;
    std::vector<Index> caps;
};

template<int D>
CellKinds kinds_of(const HullColumns<D>& hull, double tolerance) {
    CellKinds kinds;
    for (std::size_t c = 0; c < hull.cells.size(); ++c) {
        const auto [first, last] = span_of<D>(hull.cells[c], hull.points);
        (last - first > tolerance ? kinds.side : kinds.caps).push_back(static_cast<Index>(c));
    }
    return kinds;
}

// --- The scene -------------------------------------------------------------------------------------------

/// The middle of the points' box.
template<int D>
std::vector<double> middle_of(std::span<const Point<D + 1>> points) {
    std::vector<double> middle(D);
    for (std::size_t k = 0; k < D; ++k) {
        const auto [least, most] = std::minmax_element(
            points.begin(), points.end(), [k](const auto& a, const auto& b) { return a[k] < b[k]; });
        middle[k] = ((*least)[k] + (*most)[k]) / 2;
    }
    return middle;
}

template<int D>
void begin_slab(Scene& scene, const std::string& name, const TimeSpan& span,
                std::span<const Point<D + 1>> points, bool filled) {
    if (scene.slabs.empty()) {
        scene.dimension = D;
        scene.filled = filled;
        scene.centre = middle_of<D>(points);
    }
    if (scene.dimension != D || scene.filled != filled) {
        throw UsageError{fmt::format("{}: a {} in {}D+t, {} is a {} in {}D+t; a page shows one kind", name,
                                     filled ? "filling" : "hull", D, scene.slabs.front().name,
                                     scene.filled ? "filling" : "hull", scene.dimension)};
    }
    scene.tolerance = std::max(scene.tolerance, span.tolerance());
    if (!scene.slabs.empty() && span.first < scene.slabs.back().last - scene.tolerance) {
        throw UsageError{
            fmt::format("{} begins at t = {:.9g}, before {} ends, at t = {:.9g}; give slabs in the "
                        "order of their times, each once",
                        name, span.first, scene.slabs.back().name, scene.slabs.back().last)};
    }
    const std::size_t side = scene.side_patch.size();
    const std::size_t inside = scene.inside.size() / static_cast<std::size_t>(scene.inside_corners());
    scene.slabs.push_back({name, span.first, span.last, {side, side}, {inside, inside}});
}

void end_slab(Scene& scene) {
    SceneSlab& slab = scene.slabs.back();
    slab.side.end = scene.side_patch.size();
    slab.inside.end = scene.inside.size() / static_cast<std::size_t>(scene.inside_corners());
}

void add_patches(Scene& scene, const PatchList& patches) {
    for (const Patch& patch : patches) {
        const auto known = std::find_if(scene.patches.begin(), scene.patches.end(),
                                        [&](const Patch& other) { return other.number == patch.number; });
        if (known == scene.patches.end()) {
            scene.patches.push_back(patch);
        }
    }
}

void add_angles(Scene& scene, const AngleHistogram& angles) {
    std::transform(angles.begin(), angles.end(), scene.angles.begin(), scene.angles.begin(), std::plus<>{});
}

/// Adds the thinned side if it can be thinned, and says so.
template<int D>
bool thinned(Scene& scene, const std::string& name, const HullColumns<D>& hull, std::size_t cells,
             std::size_t most, std::vector<std::string>& notes) {
    if (cells <= most) {
        return false;
    }
    const std::optional<ThinSide<D>> side = thin_side(hull, most);
    if (!side || side->cells.size() >= cells) {
        notes.push_back(fmt::format("{}: its {} side cells are more than a page should have, but cannot be "
                                    "thinned; it may open slowly",
                                    name, grouped(cells)));
        return false;
    }
    const SlabVertices<D> vertices{side->points, side->vertex_id, side->track_id};
    CellTaker<D> taker{scene, vertices};
    for (std::size_t c = 0; c < side->cells.size(); ++c) {
        taker.take(side->cells[c], scene.side);
        scene.side_patch.push_back(side->patch[c]);
    }
    notes.push_back(fmt::format("{}: thinned from {} side cells to {}. Shown are {} of its {} levels, on "
                                "which the boundary is exact; between them vertices move in straight lines",
                                name, grouped(cells), grouped(side->cells.size()), side->levels,
                                side->all_levels));
    return true;
}

/// Whether cells inside are few enough to be shown; else says that they are left out.
bool shows_inside(const std::string& name, const char* what, std::size_t cells, std::size_t most,
                  std::vector<std::string>& notes) {
    if (cells > most) {
        notes.push_back(
            fmt::format("{}: its {} {} are too many for a page and left out", name, grouped(cells), what));
    }
    return cells <= most;
}

} // namespace

template<int D>
void add_slab(Scene& scene, const std::string& name, const HullColumns<D>& hull, const SceneLimits& limits,
              std::vector<std::string>& notes) {
    const TimeSpan span = time_span(hull);
    begin_slab<D>(scene, name, span, hull.points, false);
    add_patches(scene, hull.patches);
    add_angles(scene, angle_histogram<D, D + 1>(hull.points, hull.cells));

    CellKinds kinds = kinds_of(hull, span.tolerance());
    const SlabVertices<D> vertices{hull.points, rows_of(hull.vertex_id, hull.points.size(), "vertex_id"),
                                   rows_of(hull.track_id, hull.points.size(), "track_id")};
    CellTaker<D> taker{scene, vertices};
    if (!thinned(scene, name, hull, kinds.side.size(), limits.side_cells, notes)) {
        const Array<std::int64_t> patch = rows_of(hull.patch, hull.cells.size(), "patch");
        sort_by_start<D>(kinds.side, hull.cells, hull.points);
        for (const Index c : kinds.side) {
            taker.take(hull.cells[c], scene.side);
            scene.side_patch.push_back(static_cast<PatchNumber>(std::max<std::int64_t>(0, patch[c])));
        }
    }
    if (shows_inside(name, "cap cells", kinds.caps.size(), limits.inside_cells, notes)) {
        for (const Index c : kinds.caps) {
            taker.take(hull.cells[c], scene.inside);
        }
    }
    end_slab(scene);
}

namespace {

/// Angles of simplices: all of a tetrahedron, the smallest of a pentatope.
template<int D>
AngleHistogram angles_of(const Filling<D>& filling) {
    if constexpr (D == 2) {
        return angle_histogram<3, 3>(filling.points, filling.cells);
    } else {
        AngleHistogram bins{};
        constexpr double width = 180.0 / angle_bins;
        for (const Simplex<4>& cell : filling.cells) {
            const double angle = dihedral_angles<4, 4>(corners_of<4, 4>(cell, filling.points)).smallest;
            ++bins[std::min(angle_bins - 1, static_cast<std::size_t>(angle / width))];
        }
        return bins;
    }
}

/// Numbers of the facets on the side.
template<int D>
std::vector<Index> side_facets(const Filling<D>& filling) {
    std::vector<Index> numbers;
    for (std::size_t f = 0; f < filling.facets.size(); ++f) {
        if (filling.facet_attribute[f] > 2) {
            numbers.push_back(static_cast<Index>(f));
        }
    }
    return numbers;
}

Array<std::int64_t> values_of(const IntegerList& list, std::size_t count) {
    return rows_of(list.size() == count ? integer_column(list) : Column<std::int64_t>{}, count, "ids");
}

} // namespace

template<int D>
void add_slab(Scene& scene, const std::string& name, const Filling<D>& filling, const SceneLimits& limits,
              std::vector<std::string>& notes) {
    const std::span<const Point<D + 1>> points{filling.points};
    const TimeSpan span = time_span<D>(columns_of(filling));
    begin_slab<D>(scene, name, span, points, true);
    add_patches(scene, filling.patches);
    add_angles(scene, angles_of(filling));

    const SlabVertices<D> vertices{points, values_of(filling.vertex_ids, points.size()),
                                   values_of(filling.track_ids, points.size())};
    CellTaker<D> taker{scene, vertices};
    std::vector<Index> side = side_facets(filling);
    sort_by_start<D, D + 1>(side, filling.facets, points);
    for (const Index f : side) {
        taker.take(filling.facets[f], scene.side);
        scene.side_patch.push_back(filling.facet_attribute[f] - 2);
    }
    if (shows_inside(name, D == 3 ? "pentatopes" : "tetrahedra", filling.cells.size(), limits.inside_cells,
                     notes)) {
        std::vector<Index> cells(filling.cells.size());
        std::iota(cells.begin(), cells.end(), Index{0});
        sort_by_start<D, D + 2>(cells, filling.cells, points);
        for (const Index c : cells) {
            taker.take(filling.cells[c], scene.inside);
        }
    }
    end_slab(scene);
}

template void add_slab<2>(Scene&, const std::string&, const HullColumns<2>&, const SceneLimits&,
                          std::vector<std::string>&);
template void add_slab<3>(Scene&, const std::string&, const HullColumns<3>&, const SceneLimits&,
                          std::vector<std::string>&);
template void add_slab<2>(Scene&, const std::string&, const Filling<2>&, const SceneLimits&,
                          std::vector<std::string>&);
template void add_slab<3>(Scene&, const std::string&, const Filling<3>&, const SceneLimits&,
                          std::vector<std::string>&);

} // namespace slabhull
