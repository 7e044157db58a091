// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/cap_limits.h"

#include "geometry/basics/point_finder.h"
#include "geometry/embedding/box_tree.h"
#include "geometry/embedding/facet_names.h"

#include "slabhull/core/error.h"
#include "slabhull/core/memory.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// Least memory per cell while caps are made and joined to a hull.
constexpr double bytes_per_cell = 100;
/// TetGen's tolerance, relative to the diagonal of the bounding box.
constexpr double tetgen_tolerance = 1e-8;

double diagonal_of(std::span<const Point<3>> points) {
    Box<3> box;
    for (const Point<3>& p : points) {
        box.include(p);
    }
    return distance(box.low, box.high);
}

/// A facet at the point.
Index facet_at(const Surface<3>& surface, Index v) {
    const auto found = std::find_if(surface.facets.begin(), surface.facets.end(), [v](const Facet<3>& facet) {
        return std::find(facet.begin(), facet.end(), v) != facet.end();
    });
    return static_cast<Index>(found - surface.facets.begin());
}

[[noreturn]] void refuse_pair(const Surface<3>& surface, Index a, Index b, double tolerance) {
    const FacetNaming as_given;
    const FacetNames<3> names{surface, as_given};
    const Index at_a = facet_at(surface, a);
    const Index at_b = facet_at(surface, b);
    const bool one_patch = names.patch(at_a) == names.patch(at_b);
    throw GeometryError{
        fmt::format(
            "{} are {:.3g} apart at {}: the 3D mesher takes points within {:.3g} (1e-8 of the domain's "
            "diagonal) for one. Join them, or leave a wider gap",
            one_patch ? fmt::format("two points of the patch \"{}\"", names.patch(at_a))
                      : fmt::format("the patches \"{}\" and \"{}\"", names.patch(at_a), names.patch(at_b)),
            distance(surface.points[a], surface.points[b]), place_in_words(surface.points[a]), tolerance),
        {names.entity(at_a), names.entity(at_b)}};
}

} // namespace

void require_resolvable(const Surface<3>& surface) {
    const double tolerance = tetgen_tolerance * diagonal_of(surface.points);
    if (!(tolerance > std::numeric_limits<double>::min())) {
        return;
    }
    const PointFinder<3> finder{surface.points};
    for (Index v = 0; v < surface.points.size(); ++v) {
        for (const std::size_t other : finder.within(surface.points[v], tolerance)) {
            if (other > v) {
                refuse_pair(surface, v, static_cast<Index>(other), tolerance);
            }
        }
    }
}

template<int D>
void require_attainable(const Surface<D>& surface, double largest, const char* key) {
    std::vector<Index> all(surface.facets.size());
    std::iota(all.begin(), all.end(), Index{0});
    const double volume = enclosed_by<D>(surface, all);
    const double cells = cells_per_cube<D> * volume / std::pow(largest, D);
    constexpr auto most_indices = static_cast<double>(no_index);
    const auto free = static_cast<double>(available_memory());
    const double most = std::min(most_indices, free / bytes_per_cell);
    if (!(cells > most)) {
        return;
    }
    throw LimitError{fmt::format("cells no longer than {:.3g} ({}) in a domain of measure {:.4g} are "
                                 "some {:.2g}: {}. A size from {:.2g} "
                                 "on would do",
                                 largest, key, volume, cells,
                                 cells > most_indices
                                     ? fmt::format("indices count up to {:.2g}", most_indices)
                                     : fmt::format("they take {:.3g} GB at least, and {:.3g} GB are free",
                                                   1e-9 * bytes_per_cell * cells, 1e-9 * free),
                                 1.05 * std::pow(cells_per_cube<D> * volume / most, 1.0 / D))};
}

template<int D>
double most_cap_cells(const Boundary<D>& boundary, std::span<const Point<D>> places, const Grading& grading) {
    const std::vector<double> spacing = boundary.mean_edges(places);
    return cells_per_cube<D> * SizeField<D>{places, spacing, grading}.cube_count();
}

template double most_cap_cells<2>(const Boundary<2>&, std::span<const Point<2>>, const Grading&);
template double most_cap_cells<3>(const Boundary<3>&, std::span<const Point<3>>, const Grading&);
template void require_attainable<2>(const Surface<2>&, double, const char*);
template void require_attainable<3>(const Surface<3>&, double, const char*);

} // namespace slabhull
