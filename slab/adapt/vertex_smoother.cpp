// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/vertex_smoother.h"

#include "core/pieces.h"
#include "slab/adapt/cell_quality.h"
#include "slab/check/findings.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <array>
#include <limits>

namespace slabhull {

namespace {

constexpr std::size_t cells_per_search = 1 << 14;
constexpr double ample_share = 0.02; ///< of a cell's measure, for the parts of its prism

/// All directions of a grid of 3^D points: to its neighbours.
template<int D>
std::vector<Point<D>> directions() {
    std::vector<Point<D>> result;
    constexpr int count = D == 2 ? 9 : 27;
    for (int code = 0; code < count; ++code) {
        Point<D> direction;
        int rest = code;
        for (double& x : direction) {
            x = rest % 3 - 1;
            rest /= 3;
        }
        if (const double length = norm(direction); length > 0) {
            result.push_back(times(1 / length, direction));
        }
    }
    return result;
}

} // namespace

/// Whether the staircase over a cell has positive volumes. Its m-th simplex has the volume, up to a factor,
/// of the cell in space whose vertices before the m-th are at the layer's start, displaced as the m-th is,
/// and whose others are at its end. `least_share`: of the cell's own measure.
template<int D>
bool VertexSmoother<D>::is_sound(Index cell, double least_share) const {
    const Simplex<D>& corners = mesh_.cells[cell];
    Simplex<D> order = corners;
    std::sort(order.begin(), order.end());
    const double own = signed_measure<D>(corners_of<D, D>(corners, mesh_.now));
    for (std::size_t m = 1; m < D; ++m) {
        const Point<D> shift = minus(mesh_.now[order[m]], mesh_.before[order[m]]);
        std::array<Point<D>, D + 1> mixed;
        for (std::size_t k = 0; k <= D; ++k) {
            const Index v = corners[k];
            mixed[k] = v < order[m] ? plus(mesh_.before[v], shift) : mesh_.now[v];
        }
        if (!(signed_measure<D>(mixed) > least_share * own)) {
            return false;
        }
    }
    return own > 0;
}

template<int D>
double VertexSmoother<D>::value_of(Index cell, double enough) const {
    const double quality = cell_quality(corners_of<D, D>(mesh_.cells[cell], mesh_.now));
    return quality > 0 && quality >= enough && !is_sound(cell, ample_share) ? 0 : quality;
}

template<int D>
double VertexSmoother<D>::around(double enough) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < star_.size(); ++k) {
        least = std::min(least, value_of(star_[k], enough));
        if (least < enough) {
            std::swap(star_[k], star_[k / 2]); // likely to fail at the next place, too
            break;
        }
    }
    return least;
}

template<int D>
std::vector<Index> VertexSmoother<D>::unsound() const {
    constexpr double some_share = 1e-4;
    return select(mesh_.cells.size(),
                  [&](std::size_t c) { return !is_sound(static_cast<Index>(c), some_share); });
}

template<int D>
std::size_t VertexSmoother<D>::run(double wanted) {
    const std::vector<Index> poor =
        parallel_gather<Index>(mesh_.cells.size(), cells_per_search,
                               [&](std::size_t begin, std::size_t end, std::vector<Index>& list) {
                                   for (std::size_t c = begin; c < end; ++c) {
                                       if (value_of(static_cast<Index>(c), 0) < wanted) {
                                           list.push_back(static_cast<Index>(c));
                                       }
                                   }
                               });
    std::vector<Index> vertices;
    for (const Index cell : poor) {
        for (const Index v : mesh_.cells[cell]) {
            if (mesh_.on_boundary[v] == 0) {
                vertices.push_back(v);
            }
        }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::size_t moved = 0;
    for (const Index v : vertices) {
        moved += improve(v, wanted) ? 1 : 0;
    }
    return moved;
}

/// Pattern search: goes to the best of the surrounding places, and shortens the step if none is better.
template<int D>
bool VertexSmoother<D>::improve(Index vertex, double wanted) {
    static const std::vector<Point<D>> around_it = directions<D>();
    constexpr int most_steps = 10;
    constexpr double first_step = 0.15; // of the mean distance to the neighbours
    constexpr double last_step = 0.01;
    constexpr double worthwhile = 1e-6;
    mesh_.gather_star(vertex, star_);
    double sum = 0;
    for (const Index cell : star_) {
        for (const Index v : mesh_.cells[cell]) {
            sum += distance(mesh_.now[v], mesh_.now[vertex]);
        }
    }
    const double spacing = sum / (D * static_cast<double>(star_.size()));
    const Point<D> begin = mesh_.now[vertex];
    double best = around(-2);
    double step = first_step;
    for (int k = 0; k < most_steps && step > last_step && best < wanted; ++k) {
        const Point<D> from = mesh_.now[vertex];
        Point<D> to = from;
        for (const Point<D>& direction : around_it) {
            mesh_.now[vertex] = plus(from, times(step * spacing, direction));
            if (const double value = around(best); value > best + worthwhile) {
                best = value;
                to = mesh_.now[vertex];
            }
        }
        mesh_.now[vertex] = to;
        step = to == from ? step / 2 : step;
    }
    return mesh_.now[vertex] != begin;
}

template class VertexSmoother<2>;
template class VertexSmoother<3>;

} // namespace slabhull
