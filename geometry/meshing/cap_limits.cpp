// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/cap_limits.h"

#include "core/hash.h"
#include "geometry/embedding/facet_names.h"

#include "slabhull/core/error.h"
#include "slabhull/core/memory.h"
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

/// What a cell takes at least while caps are made and joined to a hull.
constexpr double bytes_per_cell = 100;
/// TetGen's tolerance, by the diagonal of the box around all points.
constexpr double tetgen_tolerance = 1e-8;

// --- points that are too near to each other

/// Points in cubes much larger than the distance looked for, so that few of them are near a cube's side.
class NearPoints {
public:
    NearPoints(std::span<const Point<3>> points, double distance)
        : points_{points}, origin_{points[0]}, distance_{distance}, edge_{64 * distance} {
        for (Index v = 0; v < points.size(); ++v) {
            filed_.emplace_back(hash(cube_of(points[v])), v);
        }
        std::sort(filed_.begin(), filed_.end());
    }

    /// The nearest one of a larger number that is within the distance.
    std::optional<Index> partner(Index v) const {
        std::optional<Index> nearest;
        double least = distance_;
        const auto look = [&](const Cube& cube) {
            const std::uint64_t key = hash(cube);
            auto at = std::lower_bound(filed_.begin(), filed_.end(), std::pair{key, v + 1});
            for (; at != filed_.end() && at->first == key; ++at) {
                const double apart = distance(points_[v], points_[at->second]);
                if (apart < least) {
                    least = apart;
                    nearest = at->second;
                }
            }
        };
        visit_cubes_around(points_[v], look);
        return nearest;
    }

    static double distance(const Point<3>& a, const Point<3>& b) {
        return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    }

private:
    using Cube = std::array<std::int64_t, 3>;

    Cube cube_of(const Point<3>& p) const {
        Cube cube{};
        for (std::size_t k = 0; k < 3; ++k) {
            cube[k] = static_cast<std::int64_t>(std::floor((p[k] - origin_[k]) / edge_));
        }
        return cube;
    }

    static std::uint64_t hash(const Cube& cube) {
        std::uint64_t value = 0;
        for (const std::int64_t each : cube) {
            value = combined_hash(value, static_cast<std::uint64_t>(each));
        }
        return value;
    }

    /// Calls look(cube) for the cubes that a ball of the distance around p touches.
    template<class Look>
    void visit_cubes_around(const Point<3>& p, const Look& look) const {
        Point<3> corner = p;
        for (double& x : corner) {
            x -= distance_;
        }
        const Cube low = cube_of(corner);
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = p[k] + distance_;
        }
        const Cube high = cube_of(corner);
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
            for (std::int64_t y = low[1]; y <= high[1]; ++y) {
                for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                    look({x, y, z});
                }
            }
        }
    }

    std::span<const Point<3>> points_;
    Point<3> origin_; ///< near them
    double distance_;
    double edge_;
    std::vector<std::pair<std::uint64_t, Index>> filed_; ///< by cube
};

double diagonal_of(std::span<const Point<3>> points) {
    Point<3> low = points[0];
    Point<3> high = points[0];
    for (const Point<3>& p : points) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    return NearPoints::distance(low, high);
}

/// A facet that has the point.
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
            NearPoints::distance(surface.points[a], surface.points[b]), place_in_words(surface.points[a]),
            tolerance),
        {names.entity(at_a), names.entity(at_b)}};
}

} // namespace

void require_resolvable(const Surface<3>& surface) {
    const double tolerance = tetgen_tolerance * diagonal_of(surface.points);
    if (!(tolerance > std::numeric_limits<double>::min())) {
        return;
    }
    const NearPoints near{surface.points, tolerance};
    for (Index v = 0; v < surface.points.size(); ++v) {
        if (const auto partner = near.partner(v)) {
            refuse_pair(surface, v, *partner, tolerance);
        }
    }
}

template<int D>
void require_attainable(const Surface<D>& surface, double largest) {
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
    throw LimitError{fmt::format("cells no longer than {:.3g} (cap.size) in a domain of measure {:.4g} are "
                                 "some {:.2g}: {}. A size from {:.2g} "
                                 "on would do",
                                 largest, volume, cells,
                                 cells > most_indices
                                     ? fmt::format("indices count up to {:.2g}", most_indices)
                                     : fmt::format("they take {:.3g} GB at least, and {:.3g} GB are free",
                                                   1e-9 * bytes_per_cell * cells, 1e-9 * free),
                                 1.05 * std::pow(cells_per_cube<D> * volume / most, 1.0 / D))};
}

template void require_attainable<2>(const Surface<2>&, double);
template void require_attainable<3>(const Surface<3>&, double);

} // namespace slabhull
