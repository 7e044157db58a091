// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/filling_links.h"

#include "core/used_vertices.h"
#include "slab/check/check_shape.h"
#include "slabhull/core/array.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/geometry/simplex_sign.h"
#include "slabhull/topology/adjacency.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

namespace slabhull {

namespace {

constexpr std::size_t cells_per_round = 1 << 12;

/// In place of the number of cells around a ray: the ray touched a facet.
constexpr std::uint8_t unsure = 255;

/// Casts a ray from each vertex, and again with another aim if it touched a facet, for a few rounds.
template<int D>
class LinkCheck {
public:
    LinkCheck(std::span<const Point<D + 1>> points, std::span<const Simplex<D + 1>> cells,
              const OpenFacets<D>& open)
        : points_{points}, cells_{cells}, open_{open}, own_(points.size(), no_index),
          facet_(points.size(), no_index), met_(points.size(), unsure), ray_(points.size()) {
        for (std::size_t c = cells.size(); c-- > 0;) {
            for (const Index v : cells[c]) {
                own_[v] = static_cast<Index>(c);
            }
        }
        for (std::size_t f = open.facets.size(); f-- > 0;) {
            for (const Index v : open.facets[f]) {
                own_[v] = open.cells[f];
                facet_[v] = static_cast<Index>(f);
            }
        }
    }

    void run() {
        for (int round = 0; round < rounds; ++round) {
            const std::vector<Index> waiting =
                select(points_.size(), [&](std::size_t v) { return own_[v] != no_index && !settled(v); });
            if (waiting.empty()) {
                break;
            }
            for (const Index v : waiting) {
                ray_[v] = aim(v, round);
                met_[v] = 0;
            }
            asked_.assign(round == 0 ? 0 : points_.size(), 0);
            for (std::size_t k = 0; !asked_.empty() && k < waiting.size(); ++k) {
                asked_[waiting[k]] = 1;
            }
            meet_all();
        }
    }

    /// Used vertices whose ray is not inside exactly one cell.
    std::vector<Index> at_fault() const {
        return select(points_.size(), [&](std::size_t v) { return own_[v] != no_index && met_[v] != 1; });
    }
    std::uint8_t met(Index v) const { return met_[v]; }

private:
    static constexpr int rounds = 4;

    /// A ray inside no cell left its own by rounding, so it is cast again.
    bool settled(std::size_t v) const { return met_[v] != unsure && met_[v] != 0; }

    /// A point of the facet opposite to the vertex in its own cell, close to the boundary facet if there is
    /// one. Weights are irregular, so that no pattern of a mesh shares them.
    Point<D + 1> aim(Index v, int round) const {
        constexpr std::array<double, 4> beside{1e-8, 1e-6, 1e-3, 0.1};
        constexpr std::array<double, 5> usual{0.2718, 0.1618, 0.3141, 0.2236, 0.1414};
        const Simplex<D + 1>& cell = cells_[own_[v]];
        double sum = 0;
        Point<D + 1> place{};
        for (std::size_t i = 0; i <= D + 1; ++i) {
            if (cell[i] == v) {
                continue;
            }
            const double weight = is_apex(v, cell[i]) ? beside[static_cast<std::size_t>(round)]
                                                      : usual[(i + static_cast<std::size_t>(round)) % 5];
            sum += weight;
            for (std::size_t k = 0; k <= D; ++k) {
                place[k] += weight * points_[cell[i]][k];
            }
        }
        for (double& coordinate : place) {
            coordinate /= sum;
        }
        return place;
    }

    /// Whether a corner of a vertex's own cell is the one opposite to the boundary facet.
    bool is_apex(Index v, Index corner) const {
        if (facet_[v] == no_index) {
            return false;
        }
        const Simplex<D>& facet = open_.facets[facet_[v]];
        return std::find(facet.begin(), facet.end(), corner) == facet.end();
    }

    void meet_all() {
        parallel_for(cells_.size(), cells_per_round, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                for (std::size_t j = 0; j <= D + 1; ++j) {
                    if (asked_.empty() || asked_[cells_[c][j]] != 0) {
                        meet(c, j);
                    }
                }
            }
        });
    }

    /// The ray is inside a cell if replacing any other corner by the ray's end leaves the cell positive.
    void meet(std::size_t c, std::size_t j) {
        const Index v = cells_[c][j];
        auto corners = corners_of<D + 1, D + 1>(cells_[c], points_);
        int least = 1;
        for (std::size_t i = 0; i <= D + 1 && least >= 0; ++i) {
            if (i != j) {
                const Point<D + 1> corner = std::exchange(corners[i], ray_[v]);
                least = std::min(least, simplex_sign<D + 1>(corners));
                corners[i] = corner;
            }
        }
        if (least >= 0) {
            add(v, least == 0);
        }
    }

    void add(Index v, bool touched) {
        const std::atomic_ref met{met_[v]};
        std::uint8_t now = met.load(std::memory_order_relaxed);
        std::uint8_t next = 0;
        do {
            next = touched || now == unsure ? unsure : static_cast<std::uint8_t>(std::min(now + 1, 254));
        } while (!met.compare_exchange_weak(now, next, std::memory_order_relaxed));
    }

    std::span<const Point<D + 1>> points_;
    std::span<const Simplex<D + 1>> cells_;
    OpenFacets<D> open_;
    Array<Index> own_;   ///< the cell that each vertex's ray starts in
    Array<Index> facet_; ///< boundary facet beside the ray
    Array<std::uint8_t> met_;
    Array<Point<D + 1>> ray_;         ///< a point on each vertex's ray
    std::vector<std::uint8_t> asked_; ///< whether each vertex's ray is cast in this round; empty: all
};

/// Translates a defect of the boundary into one of the filling. The boundary of paired cells has no open
/// ridges.
std::optional<Defect> on_boundary(ManifoldDefect what) {
    switch (what) {
    case ManifoldDefect::overfull_facet:
        return Defect::singular_boundary_ridge;
    case ManifoldDefect::singular_edge:
        return Defect::singular_edge;
    case ManifoldDefect::singular_vertex:
        return Defect::singular_boundary_vertex;
    default:
        return std::nullopt;
    }
}

} // namespace

template<int D>
void check_links(std::span<const Point<D + 1>> points, std::span<const Simplex<D + 1>> cells,
                 const OpenFacets<D>& open, Findings& findings) {
    LinkCheck<D> check{points, cells, open};
    check.run();
    for (const Index v : check.at_fault()) {
        const std::uint8_t met = check.met(v);
        findings.vertex(Defect::singular_vertex, v,
                        met == unsure ? "no ray from it is clear of the facets around it"
                                      : fmt::format("the cells at it lie around it {} times, not once", met));
    }
}

template<int D>
void check_boundary(std::size_t vertex_count, std::span<const Simplex<D>> facets, Findings& findings) {
    Array<Simplex<D>> cells(facets.begin(), facets.end());
    const UsedVertices used{vertex_count, cells};
    used.renumber(cells);
    const Adjacency<D> adjacency = build_adjacency<D>(cells, used.vertices.size());
    const ManifoldReport report = examine_manifold<D>(cells, used.vertices.size(), adjacency);
    for (const ManifoldFinding& found : report.findings) {
        std::vector<Index> at;
        for (const Index v : found.vertices) {
            at.push_back(used.vertices[v]);
        }
        std::sort(at.begin(), at.end());
        if (const std::optional<Defect> what = on_boundary(found.what)) {
            findings.vertices(*what, at, {}, "of the boundary: " + found.detail);
        }
    }
    for (std::size_t kind = 0; kind < manifold_defect_kinds; ++kind) {
        const auto what = static_cast<ManifoldDefect>(kind);
        if (on_boundary(what) && report.count(what) > 0) {
            findings.set_count(*on_boundary(what), report.count(what));
        }
    }
}

template void check_links<2>(std::span<const Point<3>>, std::span<const Simplex<3>>, const OpenFacets<2>&,
                             Findings&);
template void check_links<3>(std::span<const Point<4>>, std::span<const Simplex<4>>, const OpenFacets<3>&,
                             Findings&);
template void check_boundary<2>(std::size_t, std::span<const Simplex<2>>, Findings&);
template void check_boundary<3>(std::size_t, std::span<const Simplex<3>>, Findings&);

} // namespace slabhull
