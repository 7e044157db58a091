// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/cavity_maker.h"

#include "slab/adapt/cell_quality.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/topology/spatial_mesh.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace slabhull {

template<int D>
double CavityMaker<D>::quality_of(const Simplex<D>& cell, const Cavity<D>& cavity) const {
    std::array<Point<D>, D + 1> corners;
    for (std::size_t k = 0; k <= D; ++k) {
        corners[k] = cell[k] == Cavity<D>::new_vertex ? cavity.new_place : mesh_.now[cell[k]];
    }
    return cell_quality(corners);
}

template<int D>
bool CavityMaker<D>::examine_removed(Cavity<D>& cavity) const {
    if (taken_ != nullptr && std::any_of(cavity.removed.begin(), cavity.removed.end(),
                                         [&](Index cell) { return (*taken_)[cell] != 0; })) {
        return false;
    }
    cavity.quality_before = std::numeric_limits<double>::infinity();
    for (const Index cell : cavity.removed) {
        cavity.quality_before =
            std::min(cavity.quality_before, cell_quality(corners_of<D, D>(mesh_.cells[cell], mesh_.now)));
    }
    return true;
}

template<int D>
double CavityMaker<D>::demanded(const Cavity<D>& cavity) const {
    constexpr double flat = 1e-4; // below it, rounding may have made a cell positive
    return std::max(flat, std::min(factor_ * cavity.quality_before, ceiling_));
}

template<int D>
std::optional<Cavity<D>> CavityMaker<D>::finished(Cavity<D>&& cavity) const {
    const double least = demanded(cavity);
    cavity.quality = least_quality(cavity, least);
    return cavity.quality >= least ? std::optional{std::move(cavity)} : std::nullopt;
}

template<int D>
Point<D> CavityMaker<D>::half_way(Index v) const {
    return times(0.5, plus(mesh_.before[v], mesh_.now[v]));
}

/// Makes the cells of a split, whose new place and cells removed are known.
template<int D>
void CavityMaker<D>::divide(Index a, Index b, Cavity<D>& cavity) const {
    cavity.kind = OperationKind::split;
    cavity.new_target = 0.5 * (mesh_.target[a] + mesh_.target[b]);
    cavity.has_new_vertex = true;
    cavity.edge = {a, b};
    cavity.kernel = times(0.5, plus(half_way(a), half_way(b)));
    for (const Index cell : cavity.removed) {
        for (const Index end : {a, b}) {
            cavity.added.push_back(mesh_.cells[cell]);
            cavity.added.back()[place_in<D>(mesh_.cells[cell], end)] = Cavity<D>::new_vertex;
        }
    }
}

template<int D>
std::optional<Cavity<D>> CavityMaker<D>::split(Index a, Index b) {
    Cavity<D> cavity;
    if (!mesh_.gather_edge_star(a, b, cavity.removed) || !examine_removed(cavity)) {
        return std::nullopt;
    }
    cavity.new_place = times(0.5, plus(mesh_.now[a], mesh_.now[b]));
    divide(a, b, cavity);
    improve_new_place(a, b, cavity);
    return finished(std::move(cavity));
}

template<int D>
std::optional<Cavity<D>> CavityMaker<D>::split_boundary(Index a, Index b) {
    Cavity<D> cavity;
    if (mesh_.gather_edge_star(a, b, cavity.removed) || !boundary_->split(a, b, cavity) ||
        !examine_removed(cavity)) {
        return std::nullopt;
    }
    divide(a, b, cavity);
    return finished(std::move(cavity));
}

/// Moves the new vertex to raise the smallest quality of the new cells.
template<int D>
void CavityMaker<D>::improve_new_place(Index a, Index b, Cavity<D>& cavity) const {
    constexpr double last_step = 0.02;
    const double length = distance(mesh_.now[a], mesh_.now[b]);
    double best = least_quality(cavity, -1);
    for (double step = 0.1; step > last_step && best < demanded(cavity);) {
        const Point<D> from = cavity.new_place;
        Point<D> to = from;
        for (std::size_t k = 0; k < std::size_t{2} * D; ++k) {
            cavity.new_place = from;
            cavity.new_place[k / 2] += (k % 2 == 0 ? step : -step) * length;
            if (const double value = least_quality(cavity, best); value > best) {
                best = value;
                to = cavity.new_place;
            }
        }
        cavity.new_place = to;
        step = to == from ? step / 2 : step;
    }
}

/// The smallest quality of the new cells; if it is below `enough`, any value below that.
template<int D>
double CavityMaker<D>::least_quality(const Cavity<D>& cavity, double enough) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Simplex<D>& cell : cavity.added) {
        least = std::min(least, quality_of(cell, cavity));
        if (least < enough) {
            break;
        }
    }
    return least;
}

/// Makes the cells of a collapse, whose cells removed are known.
template<int D>
void CavityMaker<D>::pull(Index ending, Index kept, Cavity<D>& cavity) const {
    cavity.kind = OperationKind::collapse;
    cavity.ended = ending;
    cavity.edge = {ending, kept};
    cavity.kernel = half_way(ending);
    for (const Index cell : cavity.removed) {
        if (place_in<D>(mesh_.cells[cell], kept) > D) {
            cavity.added.push_back(mesh_.cells[cell]);
            cavity.added.back()[place_in<D>(mesh_.cells[cell], ending)] = kept;
        }
    }
}

template<int D>
std::optional<Cavity<D>> CavityMaker<D>::collapse(Index ending, Index kept) {
    Cavity<D> cavity;
    if (mesh_.on_boundary[ending] != 0) {
        return std::nullopt;
    }
    mesh_.gather_star(ending, cavity.removed);
    if (!examine_removed(cavity)) {
        return std::nullopt;
    }
    pull(ending, kept, cavity);
    return finished(std::move(cavity));
}

template<int D>
std::optional<Cavity<D>> CavityMaker<D>::collapse_boundary(Index ending, Index kept) {
    Cavity<D> cavity;
    mesh_.gather_star(ending, cavity.removed);
    if (!examine_removed(cavity) || !boundary_->collapse(ending, kept, cavity)) {
        return std::nullopt;
    }
    pull(ending, kept, cavity);
    return finished(std::move(cavity));
}

template<int D>
std::optional<Cavity<D>> CavityMaker<D>::shift_boundary(Index vertex) {
    Cavity<D> cavity;
    mesh_.gather_star(vertex, cavity.removed);
    if (!examine_removed(cavity) || !boundary_->shift(vertex, cavity)) {
        return std::nullopt;
    }
    cavity.kind = OperationKind::shift;
    cavity.ended = vertex;
    cavity.has_new_vertex = true;
    cavity.new_target = mesh_.target[vertex];
    cavity.edge = {vertex, vertex};
    cavity.kernel = half_way(vertex);
    for (const Index cell : cavity.removed) {
        cavity.added.push_back(mesh_.cells[cell]);
        cavity.added.back()[place_in<D>(mesh_.cells[cell], vertex)] = Cavity<D>::new_vertex;
    }
    return finished(std::move(cavity));
}

template<int D>
std::optional<Cavity<D>> CavityMaker<D>::flip_facet(Index cell, std::size_t i) {
    const Index across = mesh_.neighbors[cell][i];
    if (across == no_index) {
        return std::nullopt;
    }
    const Simplex<D>& corners = mesh_.cells[cell];
    const Index beyond = mesh_.cells[across][place_in<D>(mesh_.neighbors[across], cell)];
    Cavity<D> cavity;
    cavity.kind = OperationKind::flip;
    cavity.removed = {cell, across};
    if (!examine_removed(cavity)) {
        return std::nullopt;
    }
    for (std::size_t k = 0; k <= D; ++k) {
        if (k != i) { // the cell with corner k moved across the facet
            cavity.added.push_back(corners);
            cavity.added.back()[k] = beyond;
            cavity.kernel = plus(cavity.kernel, times(1.0 / D, half_way(corners[k])));
        }
    }
    return finished(std::move(cavity));
}

/// The vertices around an edge, in order: each cell of its star has the edge and two that follow one another,
/// and (a, b, ring[k], ring[k + 1]) is positive. Around an edge on the boundary, the last one is not followed
/// by the first.
template<int D>
bool CavityMaker<D>::order_ring(Index a, Index b, const std::vector<Index>& star,
                                std::vector<Index>& ring) const {
    std::vector<std::array<Index, 2>> steps;
    for (const Index cell : star) {
        const Simplex<D>& corners = mesh_.cells[cell];
        std::array<std::size_t, D + 1> order{place_in<D>(corners, a), place_in<D>(corners, b)};
        std::size_t n = 2;
        for (std::size_t k = 0; k <= D; ++k) {
            if (k != order[0] && k != order[1]) {
                order[n++] = k;
            }
        }
        bool odd = false;
        for (std::size_t i = 0; i <= D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                odd = odd != (order[j] > order[i]);
            }
        }
        steps.push_back({corners[order[odd ? D : D - 1]], corners[order[odd ? D - 1 : D]]});
    }
    const auto from = [&](Index v) {
        return std::find_if(steps.begin(), steps.end(), [&](const auto& s) { return s[0] == v; });
    };
    const auto first = std::find_if(steps.begin(), steps.end(), [&](const auto& step) {
        return std::none_of(steps.begin(), steps.end(), [&](const auto& s) { return s[1] == step[0]; });
    });
    const bool open = first != steps.end();
    ring.assign(1, open ? (*first)[0] : steps.front()[0]);
    for (auto step = from(ring[0]); step != steps.end() && ring.size() <= steps.size();
         step = from(ring.back())) {
        ring.push_back((*step)[1]);
    }
    if (!open && ring.back() == ring.front()) {
        ring.pop_back();
    }
    return ring.size() == steps.size() + (open ? 1 : 0);
}

template<int D>
std::optional<Cavity<D>> CavityMaker<D>::remove_edge(Index a, Index b) {
    if constexpr (D == 3) {
        Cavity<D> cavity;
        std::vector<Index> ring;
        const bool inside = mesh_.gather_edge_star(a, b, cavity.removed);
        if (cavity.removed.size() > most_around_edge - (inside ? 0 : 1) ||
            cavity.removed.size() < (inside ? 3 : 2) || !examine_removed(cavity) ||
            !order_ring(a, b, cavity.removed, ring) ||
            (!inside && (boundary_ == nullptr || !boundary_->flip(a, b, cavity)))) {
            return std::nullopt;
        }
        cavity.kind = OperationKind::flip;
        cavity.kernel = times(0.5, plus(half_way(a), half_way(b)));
        const std::size_t n = ring.size();
        const double least = demanded(cavity);
        // best[i][j]: the largest least quality over triangulations of the polygon ring[i] .. ring[j]
        std::array<std::array<double, most_around_edge>, most_around_edge> best{};
        std::array<std::array<std::size_t, most_around_edge>, most_around_edge> middle{};
        const auto pair_over = [&](std::size_t i, std::size_t k, std::size_t j) {
            return std::array<Simplex<D>, 2>{Simplex<D>{ring[i], ring[k], ring[j], b},
                                             Simplex<D>{ring[i], ring[j], ring[k], a}};
        };
        for (std::size_t length = 1; length < n; ++length) {
            for (std::size_t i = 0; i + length < n; ++i) {
                const std::size_t j = i + length;
                best[i][j] = length == 1 ? std::numeric_limits<double>::infinity() : least;
                for (std::size_t k = i + 1; k < j; ++k) {
                    double quality = std::min(best[i][k], best[k][j]);
                    for (const Simplex<D>& cell : pair_over(i, k, j)) {
                        quality =
                            quality > best[i][j] ? std::min(quality, quality_of(cell, cavity)) : quality;
                    }
                    if (quality > best[i][j]) {
                        best[i][j] = quality;
                        middle[i][j] = k;
                    }
                }
            }
        }
        if (!(best[0][n - 1] > least)) {
            return std::nullopt;
        }
        std::vector<std::array<std::size_t, 2>> parts{{0, n - 1}};
        while (!parts.empty()) {
            const auto [i, j] = parts.back();
            parts.pop_back();
            if (j - i > 1) {
                const std::size_t k = middle[i][j];
                for (const Simplex<D>& cell : pair_over(i, k, j)) {
                    cavity.added.push_back(cell);
                }
                parts.push_back({i, k});
                parts.push_back({k, j});
            }
        }
        return finished(std::move(cavity));
    } else {
        return std::nullopt;
    }
}

template class CavityMaker<2>;
template class CavityMaker<3>;

} // namespace slabhull
