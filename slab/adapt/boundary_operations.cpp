// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/boundary_operations.h"

#include "geometry/projection/closest_on_facet.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

namespace slabhull {

namespace {

template<int D>
bool facet_has(const Facet<D>& facet, Index vertex) {
    return std::find(facet.begin(), facet.end(), vertex) != facet.end();
}

template<int D>
Facet<D> with_instead(Facet<D> facet, Index before, Index after) {
    std::replace(facet.begin(), facet.end(), before, after);
    return facet;
}

double cosine_of(double degrees) {
    return std::cos(degrees * std::numbers::pi / 180);
}

} // namespace

template<int D>
BoundaryOperations<D>::BoundaryOperations(const AdaptMesh<D>& mesh, const Boundary<D>& boundary,
                                          std::span<const double> spacing, const PatchSurfaces<D>& surfaces,
                                          const std::array<double, 2>& times, const AdaptOptions& options)
    : mesh_{mesh}, boundary_{boundary}, spacing_{spacing}, surfaces_{surfaces}, times_{times},
      options_{options}, sharp_{cosine_of(options.feature_angle)}, half_sharp_{cosine_of(
                                                                       options.feature_angle / 2)},
      number_(mesh.now.size(), no_index), facet_of_(boundary.vertex_count()) {
    for (Index v = 0; v < mesh.boundary.size(); ++v) {
        number_[mesh.boundary[v]] = v;
    }
    for (Index f = 0; f < boundary.facet_count(); ++f) {
        for (const Index v : boundary.facets()[f]) {
            facet_of_[v] = f;
        }
    }
}

template<int D>
double BoundaryOperations<D>::length_ratio(Index a, Index b) const {
    return 2 * distance(mesh_.now[a], mesh_.now[b]) / (spacing_[own(a)] + spacing_[own(b)]);
}

template<int D>
double BoundaryOperations<D>::length_ratio(Index a, Index b, const Cavity<D>& cavity) const {
    const double new_spacing =
        cavity.has_new_vertex ? 0.5 * (spacing_[own(cavity.edge[0])] + spacing_[own(cavity.edge[1])]) : 0;
    const auto place = [&](Index v) { return v == Cavity<D>::new_vertex ? cavity.new_place : mesh_.now[v]; };
    const auto spacing = [&](Index v) { return v == Cavity<D>::new_vertex ? new_spacing : spacing_[own(v)]; };
    return 2 * distance(place(a), place(b)) / (spacing(a) + spacing(b));
}

template<int D>
bool BoundaryOperations<D>::wants_flip(Index first, Index second) const {
    constexpr double most = 185; // degrees
    if constexpr (D == 3) {
        const Index a = own(first);
        const Index b = own(second);
        double sum = 0;
        for (const Index f : facets_at_edge(a, b)) {
            const Facet<D>& facet = boundary_.facets()[f];
            const Index c =
                *std::find_if(facet.begin(), facet.end(), [&](Index v) { return v != a && v != b; });
            const Point<D> to_a = minus(now(a), now(c));
            const Point<D> to_b = minus(now(b), now(c));
            sum += std::atan2(norm(cross(to_a, to_b)), dot(to_a, to_b)) * 180 / std::numbers::pi;
        }
        return sum > most;
    } else {
        return false;
    }
}

template<int D>
Point<D> BoundaryOperations<D>::at_half_time(Index v) const {
    const Index vertex = mesh_.boundary[v];
    return times(0.5, plus(mesh_.before[vertex], mesh_.now[vertex]));
}

template<int D>
Point<D + 1> BoundaryOperations<D>::apex(PatchNumber patch, const Point<D>& place) const {
    const double time = 0.5 * (times_[0] + times_[1]);
    const Point<D> projected = surfaces_.project(patch, place, time);
    Point<D + 1> point;
    std::copy(projected.begin(), projected.end(), point.begin());
    point[D] = time;
    return point;
}

template<int D>
void BoundaryOperations<D>::gather_star(Index v, std::vector<Index>& star) const {
    star.assign(1, facet_of_[v]);
    for (std::size_t next = 0; next < star.size(); ++next) {
        const Index facet = star[next];
        for (std::size_t i = 0; i < D; ++i) {
            const Index across = boundary_.neighbors()[facet][i];
            if (boundary_.facets()[facet][i] != v &&
                std::find(star.begin(), star.end(), across) == star.end()) {
                star.push_back(across);
            }
        }
    }
}

template<int D>
std::vector<Index> BoundaryOperations<D>::facets_at_edge(Index a, Index b) const {
    std::vector<Index> facets;
    gather_star(a, facets);
    std::erase_if(facets, [&](Index f) { return !facet_has<D>(boundary_.facets()[f], b); });
    return facets;
}

template<int D>
std::vector<Index> BoundaryOperations<D>::neighbors_of(const std::vector<Index>& star, Index v) const {
    std::vector<Index> around;
    for (const Index f : star) {
        for (const Index w : boundary_.facets()[f]) {
            if (w != v) {
                around.push_back(w);
            }
        }
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    return around;
}

template<int D>
std::optional<PatchNumber> BoundaryOperations<D>::patch_of(const std::vector<Index>& facets) const {
    if (facets.empty()) {
        return std::nullopt;
    }
    const PatchNumber patch = boundary_.patch()[facets.front()];
    const auto found = options_.patches.find(patch);
    const bool fixed = found != options_.patches.end() && found->second.fixed;
    const bool same =
        std::all_of(facets.begin(), facets.end(), [&](Index f) { return boundary_.patch()[f] == patch; });
    return same && !fixed && !surfaces_.has_fixed_vertices(patch) ? std::optional{patch} : std::nullopt;
}

/// Cosine of the angle between the normals of two facets at the layer's end; -1 if one has none.
template<int D>
double BoundaryOperations<D>::cosine(const Facet<D>& a, const Facet<D>& b) const {
    const auto normal = [&](const Facet<D>& facet) {
        std::array<Point<D>, D> corners;
        std::transform(facet.begin(), facet.end(), corners.begin(), [&](Index v) { return now(v); });
        return simplex_normal<D - 1>(corners);
    };
    const Point<D> first = normal(a);
    const Point<D> second = normal(b);
    const double lengths = norm(first) * norm(second);
    return lengths > 0 ? dot(first, second) / lengths : -1;
}

/// Whether pulling a vertex along an edge keeps the edges of the patch that are sharper than the feature
/// angle: it has none, or (D = 3) two, and is pulled along one of them.
template<int D>
bool BoundaryOperations<D>::keeps_sharp_edges(const std::vector<Index>& star, Index ending,
                                              Index kept) const {
    std::size_t sharp = 0;
    bool along = false;
    for (const Index f : star) {
        for (std::size_t i = 0; i < D; ++i) {
            const Index across = boundary_.neighbors()[f][i];
            const Facet<D>& facet = boundary_.facets()[f];
            if (facet[i] != ending && boundary_.owns(f, i) &&
                cosine(facet, boundary_.facets()[across]) < sharp_) {
                ++sharp;
                along = along || (facet_has<D>(facet, kept) && facet[i] != kept);
            }
        }
    }
    return sharp == 0 || (D == 3 && sharp == 2 && along);
}

/// Whether a place that leaves the boundary is near the new facets; where the patch has a surface of its own,
/// they are near that.
template<int D>
bool BoundaryOperations<D>::stays_near(const Point<D>& place, const std::vector<Facet<D>>& facets,
                                       PatchNumber patch, double spacing) const {
    if (surfaces_.has(patch)) {
        return true;
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (const Facet<D>& facet : facets) {
        detail::FacetCorners<D> corners;
        std::transform(facet.begin(), facet.end(), corners.begin(), [&](Index v) { return now(v); });
        nearest = std::min(nearest, detail::closest_on_facet(place, corners).distance);
    }
    return nearest <= options_.distance * spacing;
}

template<int D>
void BoundaryOperations<D>::set_side(const std::vector<Index>& removed, const std::vector<Facet<D>>& added,
                                     PatchNumber patch, const Point<D + 1>& apex, Cavity<D>& cavity) const {
    const auto of_mesh = [&](Facet<D> facet) {
        for (Index& v : facet) {
            v = v == Cavity<D>::new_vertex ? v : mesh_.boundary[v];
        }
        return facet;
    };
    cavity.side = {removed, {}, patch, apex};
    cavity.side_removed.clear();
    for (const Index f : removed) {
        cavity.side_removed.push_back(of_mesh(boundary_.facets()[f]));
    }
    std::transform(added.begin(), added.end(), std::back_inserter(cavity.side.added), of_mesh);
}

template<int D>
bool BoundaryOperations<D>::split(Index first, Index second, Cavity<D>& cavity) const {
    constexpr double most_moved = 0.25; // of the edge, by projection
    const Index a = own(first);
    const Index b = own(second);
    const std::vector<Index> removed = facets_at_edge(a, b);
    const auto patch = patch_of(removed);
    if (!patch) {
        return false;
    }
    const Point<D> middle = times(0.5, plus(now(a), now(b)));
    cavity.new_place = surfaces_.project(*patch, middle, times_[1]);
    if (distance(cavity.new_place, middle) > most_moved * distance(now(a), now(b))) {
        return false;
    }
    std::vector<Facet<D>> added;
    for (const Index f : removed) {
        for (const Index end : {a, b}) {
            added.push_back(with_instead<D>(boundary_.facets()[f], end, Cavity<D>::new_vertex));
        }
    }
    set_side(removed, added, *patch, apex(*patch, times(0.5, plus(at_half_time(a), at_half_time(b)))),
             cavity);
    return true;
}

template<int D>
bool BoundaryOperations<D>::collapse(Index first, Index second, Cavity<D>& cavity) const {
    const Index ending = own(first);
    const Index kept = own(second);
    std::vector<Index> removed;
    gather_star(ending, removed);
    const auto patch = patch_of(removed);
    const std::vector<Index> around = neighbors_of(removed, ending);
    if (!patch || !std::binary_search(around.begin(), around.end(), kept) ||
        !keeps_sharp_edges(removed, ending, kept)) {
        return false;
    }
    std::vector<Index> other_star;
    gather_star(kept, other_star);
    const std::vector<Index> around_kept = neighbors_of(other_star, kept);
    std::vector<Index> common;
    std::set_intersection(around.begin(), around.end(), around_kept.begin(), around_kept.end(),
                          std::back_inserter(common));
    constexpr std::size_t allowed = D == 3 ? 2 : 0; // the link condition
    if (common.size() != allowed) {
        return false;
    }
    std::vector<Facet<D>> added;
    for (const Index f : removed) {
        const Facet<D>& facet = boundary_.facets()[f];
        if (!facet_has<D>(facet, kept)) {
            added.push_back(with_instead<D>(facet, ending, kept));
            if (cosine(facet, added.back()) < sharp_) {
                return false;
            }
        }
    }
    if (!stays_near(now(ending), added, *patch, spacing_[ending])) {
        return false;
    }
    set_side(removed, added, *patch, apex(*patch, at_half_time(ending)), cavity);
    return true;
}

/// How far edges from a place to some vertices are from what is wanted: the largest of their ratios or their
/// inverses.
template<int D>
double BoundaryOperations<D>::worst_ratio(const std::vector<Index>& around, const Point<D>& place,
                                          double spacing) const {
    double worst = 1;
    for (const Index v : around) {
        const double ratio = 2 * distance(place, now(v)) / (spacing + spacing_[v]);
        worst = std::max({worst, ratio, 1 / ratio});
    }
    return worst;
}

/// The point of the boundary, within a vertex's star, next to the mean of its neighbours.
template<int D>
std::optional<Point<D>> BoundaryOperations<D>::middle_of(const std::vector<Index>& around,
                                                         const std::vector<Index>& star,
                                                         PatchNumber patch) const {
    Point<D> mean{};
    for (const Index v : around) {
        mean = plus(mean, times(1.0 / static_cast<double>(around.size()), now(v)));
    }
    if (surfaces_.has(patch)) {
        return surfaces_.project(patch, mean, times_[1]);
    }
    double nearest = std::numeric_limits<double>::infinity();
    std::optional<Point<D>> foot;
    for (const Index f : star) {
        detail::FacetCorners<D> corners;
        const Facet<D>& facet = boundary_.facets()[f];
        std::transform(facet.begin(), facet.end(), corners.begin(), [&](Index v) { return now(v); });
        if (const auto found = detail::closest_on_facet(mean, corners); found.distance < nearest) {
            nearest = found.distance;
            foot = found.point;
        }
    }
    return foot;
}

template<int D>
bool BoundaryOperations<D>::shift(Index vertex, Cavity<D>& cavity) const {
    constexpr double notably = 0.97;
    const Index ending = own(vertex);
    std::vector<Index> removed;
    gather_star(ending, removed);
    const auto patch = patch_of(removed);
    if (!patch || !keeps_sharp_edges(removed, ending, no_index)) {
        return false;
    }
    const std::vector<Index> around = neighbors_of(removed, ending);
    const auto place = middle_of(around, removed, *patch);
    if (!place || worst_ratio(around, *place, spacing_[ending]) >
                      notably * worst_ratio(around, now(ending), spacing_[ending])) {
        return false;
    }
    cavity.new_place = *place;
    std::vector<Facet<D>> added;
    for (const Index f : removed) {
        added.push_back(with_instead<D>(boundary_.facets()[f], ending, Cavity<D>::new_vertex));
    }
    set_side(removed, added, *patch, apex(*patch, at_half_time(ending)), cavity);
    return true;
}

template<int D>
bool BoundaryOperations<D>::flip(Index first, Index second, Cavity<D>& cavity) const {
    if constexpr (D == 3) {
        const Index a = own(first);
        const Index b = own(second);
        const std::vector<Index> removed = facets_at_edge(a, b);
        const auto patch = patch_of(removed);
        if (!patch) {
            return false;
        }
        const Facet<D>& facet = boundary_.facets()[removed[0]];
        const Facet<D>& beyond = boundary_.facets()[removed[1]];
        std::size_t k = 0;
        while (facet[k] == a || facet[k] == b) {
            ++k;
        }
        const Index c = facet[k];
        const Index from = facet[(k + 1) % 3];
        const Index to = facet[(k + 2) % 3];
        const Index d =
            *std::find_if(beyond.begin(), beyond.end(), [&](Index v) { return v != a && v != b; });
        const std::vector<Facet<D>> added{{from, d, c}, {d, to, c}};
        const bool flat = cosine(facet, beyond) > half_sharp_ && cosine(added[0], added[1]) > half_sharp_ &&
                          cosine(facet, added[0]) > half_sharp_ && cosine(beyond, added[0]) > half_sharp_;
        if (!flat || !facets_at_edge(c, d).empty() ||
            !stays_near(times(0.5, plus(now(a), now(b))), added, *patch, 0.5 * (spacing_[a] + spacing_[b]))) {
            return false;
        }
        set_side(removed, added, *patch, apex(*patch, times(0.5, plus(at_half_time(a), at_half_time(b)))),
                 cavity);
        return true;
    } else {
        return false;
    }
}

template class BoundaryOperations<2>;
template class BoundaryOperations<3>;

} // namespace slabhull
