// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/embedded_caps.h"

#include "core/pieces.h"
#include "geometry/basics/predicates.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/topology/spatial_mesh.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

constexpr std::size_t cap_grain = 1 << 14; ///< cells

/// The earliest and the latest time of the cells' vertices.
template<int D>
std::array<double, 2> time_range(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells) {
    using Range = std::array<double, 2>;
    constexpr Range none{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto range_of = [&](std::size_t begin, std::size_t end, Range& range) {
        for (std::size_t c = begin; c < end; ++c) {
            for (const Index v : cells[c]) {
                range = {std::min(range[0], points[v][D]), std::max(range[1], points[v][D])};
            }
        }
    };
    Range all = none;
    for (const Range& piece : parallel_pieces<Range>(cells.size(), cap_grain, range_of, none)) {
        all = {std::min(all[0], piece[0]), std::max(all[1], piece[1])};
    }
    return all;
}

template<int D>
Point<D> in_space(const Point<D + 1>& p) {
    Point<D> x;
    std::copy_n(p.begin(), D, x.begin());
    return x;
}

template<int D>
class CapProof {
public:
    CapProof(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
             const AdjacencyView<D>& adjacency, std::span<const CapOf> caps)
        : points_{points}, cells_{cells}, neighbors_{adjacency.neighbors}, caps_{caps} {}

    bool holds(CapOf cap) {
        const int sign = common_sign(cap);
        return sign != 0 && bounds_domain(cap, sign) && side_keeps_to_boundary(cap);
    }

private:
    /// Common sign of all cells of the cap in space; 0 if signs differ, a cell is flat or there is none.
    int common_sign(CapOf cap) const {
        std::atomic<bool> positive = false;
        std::atomic<bool> negative = false;
        std::atomic<bool> flat = false;
        parallel_for(cells_.size(), cap_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                if (caps_[c] == cap) {
                    const int sign = sign_of(cells_[c]);
                    (sign > 0 ? positive : sign < 0 ? negative : flat) = true;
                }
            }
        });
        return flat ? 0 : int{positive} - int{negative};
    }

    int sign_of(const Simplex<D>& cell) const {
        std::array<Point<D>, D + 1> corners;
        for (std::size_t i = 0; i <= D; ++i) {
            corners[i] = in_space<D>(points_[cell[i]]);
        }
        return exact::orientation(corners);
    }

    bool outer(std::size_t c, std::size_t i, CapOf cap) const {
        const Index across = neighbors_[c][i];
        return across == no_index || caps_[across] != cap;
    }

    bool bounds_domain(CapOf cap, int sign) {
        Surface<D> surface;
        on_boundary_.assign(points_.size(), no_index);
        for (const Facet<D>& facet : outer_facets(cap, sign)) {
            surface.facets.push_back(numbered(facet, surface));
        }
        find_edges(surface);
        try { // the reasons are not needed: the pairs of cells will be reported
            require_domain_boundary(surface, {}, false);
            return true;
        } catch (const GeometryError&) {
            return false;
        }
    }

    std::vector<Facet<D>> outer_facets(CapOf cap, int sign) const {
        const auto find = [&](std::size_t begin, std::size_t end, std::vector<Facet<D>>& facets) {
            for (std::size_t c = begin; c < end; ++c) {
                for (std::size_t i = 0; i <= D && caps_[c] == cap; ++i) {
                    if (outer(c, i, cap)) {
                        facets.push_back(outward_facet<D>(cells_[c], static_cast<int>(i)));
                        if (sign < 0) {
                            std::swap(facets.back()[0], facets.back()[1]);
                        }
                    }
                }
            }
        };
        return parallel_gather<Facet<D>>(cells_.size(), cap_grain, find);
    }

    Facet<D> numbered(Facet<D> facet, Surface<D>& surface) {
        for (Index& v : facet) {
            if (on_boundary_[v] == no_index) {
                on_boundary_[v] = static_cast<Index>(surface.points.size());
                surface.points.push_back(in_space<D>(points_[v]));
            }
            v = on_boundary_[v];
        }
        return facet;
    }

    static std::array<Index, 2> edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

    /// For D = 2 the facets are the edges.
    void find_edges(const Surface<D>& surface) {
        edges_.clear();
        for (const Facet<D>& facet : surface.facets) {
            for (std::size_t i = 0; i < D; ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    edges_.push_back(edge(facet[i], facet[j]));
                }
            }
        }
        std::sort(edges_.begin(), edges_.end());
        edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    }

    bool side_keeps_to_boundary(CapOf cap) const {
        const double time = time_of(cap);
        std::atomic<bool> all = true;
        parallel_for(cells_.size(), cap_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                if (caps_[c] == CapOf::none && !face_on_boundary(c, time)) {
                    all = false;
                }
            }
        });
        return all;
    }

    double time_of(CapOf cap) const {
        const auto cell = std::find(caps_.begin(), caps_.end(), cap) - caps_.begin();
        return points_[cells_[static_cast<std::size_t>(cell)][0]][D];
    }

    /// Whether the vertices of a side cell at the cap's time span a face of the cap's boundary.
    bool face_on_boundary(std::size_t c, double time) const {
        std::array<Index, D + 1> at{};
        std::size_t count = 0;
        std::size_t off = 0; ///< a local vertex that is not at this time
        for (std::size_t i = 0; i <= D; ++i) {
            if (points_[cells_[c][i]][D] == time) {
                at[count++] = on_boundary_[cells_[c][i]];
            } else {
                off = i;
            }
        }
        if (std::find(at.begin(), at.begin() + count, no_index) != at.begin() + count) {
            return false;
        }
        if (count == D) {
            const Index across = neighbors_[c][off];
            return across != no_index && caps_[across] != CapOf::none;
        }
        return count < 2 || std::binary_search(edges_.begin(), edges_.end(), edge(at[0], at[1]));
    }

    std::span<const Point<D + 1>> points_;
    std::span<const Simplex<D>> cells_;
    std::span<const Neighbors<D>> neighbors_;
    std::span<const CapOf> caps_;
    std::vector<Index> on_boundary_; ///< number of each vertex in the cap's boundary, no_index off it
    std::vector<std::array<Index, 2>> edges_; ///< of the cap's boundary, sorted
};

} // namespace

template<int D>
Array<CapOf> find_caps(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells) {
    const std::array<double, 2> times = time_range<D>(points, cells);
    Array<CapOf> caps(cells.size());
    parallel_for(cells.size(), cap_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            const auto all_at = [&](double time) {
                return std::all_of(cells[c].begin(), cells[c].end(),
                                   [&](Index v) { return points[v][D] == time; });
            };
            caps[c] = all_at(times[0]) ? CapOf::first : all_at(times[1]) ? CapOf::last : CapOf::none;
        }
    });
    return caps;
}

template<int D>
bool caps_are_embedded(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                       const AdjacencyView<D>& adjacency, std::span<const CapOf> caps) {
    CapProof<D> proof{points, cells, adjacency, caps};
    return adjacency.defects.empty() && proof.holds(CapOf::first) && proof.holds(CapOf::last);
}

template Array<CapOf> find_caps<2>(std::span<const Point<3>>, std::span<const Simplex<2>>);
template Array<CapOf> find_caps<3>(std::span<const Point<4>>, std::span<const Simplex<3>>);
template bool caps_are_embedded<2>(std::span<const Point<3>>, std::span<const Simplex<2>>,
                                   const AdjacencyView<2>&, std::span<const CapOf>);
template bool caps_are_embedded<3>(std::span<const Point<4>>, std::span<const Simplex<3>>,
                                   const AdjacencyView<3>&, std::span<const CapOf>);

} // namespace slabhull
