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
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

constexpr std::size_t cap_grain = 1 << 14; ///< cells

template<int D>
Point<D> in_space(const Point<D + 1>& p) {
    Point<D> x;
    std::copy_n(p.begin(), D, x.begin());
    return x;
}

template<int D>
int sign_of(const Simplex<D>& cell, std::span<const Point<D + 1>> points) {
    std::array<Point<D>, D + 1> corners;
    for (std::size_t i = 0; i <= D; ++i) {
        corners[i] = in_space<D>(points[cell[i]]);
    }
    return exact::orientation(corners);
}

std::array<Index, 2> edge(Index a, Index b) {
    return {std::min(a, b), std::max(a, b)};
}

/// Whether each point is at a time: a byte of each stays in a cache, where the points do not.
template<int D>
Array<std::uint8_t> points_at(std::span<const Point<D + 1>> points, double time) {
    Array<std::uint8_t> at(points.size());
    parallel_for(points.size(), cap_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            at[v] = points[v][D] == time ? 1 : 0;
        }
    });
    return at;
}

/// How many of a cell's vertices are marked.
template<int D>
int marked_corners(const Simplex<D>& cell, const Array<std::uint8_t>& marks) {
    int count = 0;
    for (const Index v : cell) {
        count += marks[v];
    }
    return count;
}

template<int D>
class SideCheck {
public:
    SideCheck(const CellsInCaps<D>& hull, double time, std::span<const Index> on_boundary,
              std::span<const std::array<Index, 2>> edges)
        : hull_{hull}, at_time_{points_at<D>(hull.points, time)}, on_boundary_{on_boundary}, edges_{edges} {}

    bool holds() const {
        std::atomic<bool> all = true;
        parallel_for(hull_.cells.size(), cap_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                if (marked_corners<D>(hull_.cells[c], at_time_) > 0 && hull_.caps[c] == CapOf::none &&
                    !face_on_boundary(c)) {
                    all = false;
                }
            }
        });
        return all;
    }

private:
    /// Whether the vertices of a side cell at the cap's time span a face of the cap's boundary.
    bool face_on_boundary(std::size_t c) const {
        std::array<Index, D + 1> at{};
        std::size_t count = 0;
        std::size_t off = 0; ///< a local vertex that is not at this time
        for (std::size_t i = 0; i <= D; ++i) {
            if (at_time_[hull_.cells[c][i]] != 0) {
                at[count++] = on_boundary_[hull_.cells[c][i]];
            } else {
                off = i;
            }
        }
        if (std::find(at.begin(), at.begin() + count, no_index) != at.begin() + count) {
            return false;
        }
        if (count == D) {
            const Index across = hull_.neighbors[c][off];
            return across != no_index && hull_.caps[across] != CapOf::none;
        }
        return count < 2 || std::binary_search(edges_.begin(), edges_.end(), edge(at[0], at[1]));
    }

    const CellsInCaps<D>& hull_;
    Array<std::uint8_t> at_time_; ///< of each point, whether it is at the cap's
    std::span<const Index> on_boundary_;
    std::span<const std::array<Index, 2>> edges_;
};

/// Numbers the points of facets in the order of their first use, and lists them.
template<int D>
Array<Point<D>> number_points(Array<Facet<D>>& facets, std::span<const Point<D + 1>> points,
                              Array<Index>& on_boundary) {
    Array<Point<D>> used;
    on_boundary.assign(points.size(), no_index);
    for (Facet<D>& facet : facets) {
        for (Index& v : facet) {
            if (on_boundary[v] == no_index) {
                on_boundary[v] = static_cast<Index>(used.size());
                used.push_back(in_space<D>(points[v]));
            }
            v = on_boundary[v];
        }
    }
    return used;
}

template<int D>
bool cap_is_embedded(const CellsInCaps<D>& hull, CapOf cap, double time) {
    const int sign = signs_of_cap<D>(hull, cap).common();
    if (sign == 0) {
        return false;
    }
    Array<Facet<D>> facets = outer_facets<D>(hull, cap);
    Array<Index> on_boundary;
    Array<Point<D>> points = number_points<D>(facets, hull.points, on_boundary);
    const auto edges = edges_of<D>(facets);
    return bound_a_domain<D>(std::move(facets), std::move(points), sign) &&
           side_keeps_to<D>(hull, time, on_boundary, edges);
}

} // namespace

template<int D>
std::array<double, 2> time_span(const JoinedSpans<Point<D + 1>>& points, std::span<const Simplex<D>> cells) {
    using Span = std::array<double, 2>;
    constexpr Span none{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const auto span_of = [&](std::size_t begin, std::size_t end, Span& span) {
        for (std::size_t c = begin; c < end; ++c) {
            for (const Index v : cells[c]) {
                span = {std::min(span[0], points[v][D]), std::max(span[1], points[v][D])};
            }
        }
    };
    Span all = none;
    for (const Span& piece : parallel_pieces<Span>(cells.size(), cap_grain, span_of, none)) {
        all = {std::min(all[0], piece[0]), std::max(all[1], piece[1])};
    }
    return all;
}

template<int D>
Array<CapOf> find_caps(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                       const std::array<double, 2>& times) {
    const Array<std::uint8_t> first = points_at<D>(points, times[0]);
    const Array<std::uint8_t> last = points_at<D>(points, times[1]);
    Array<CapOf> caps(cells.size());
    parallel_for(cells.size(), cap_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            const bool in_first = marked_corners<D>(cells[c], first) == D + 1;
            const bool in_last = marked_corners<D>(cells[c], last) == D + 1;
            caps[c] = in_first ? CapOf::first : in_last ? CapOf::last : CapOf::none;
        }
    });
    return caps;
}

template<int D>
CapSigns signs_of_cap(const CellsInCaps<D>& hull, CapOf cap) {
    std::atomic<bool> positive = false;
    std::atomic<bool> negative = false;
    std::atomic<bool> flat = false;
    parallel_for(hull.cells.size(), cap_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            if (hull.caps[c] == cap) {
                const int sign = sign_of<D>(hull.cells[c], hull.points);
                (sign > 0 ? positive : sign < 0 ? negative : flat) = true;
            }
        }
    });
    return {positive, negative, flat};
}

template<int D>
Array<Facet<D>> outer_facets(const CellsInCaps<D>& hull, CapOf cap) {
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<Facet<D>>& facets) {
        for (std::size_t c = begin; c < end; ++c) {
            for (std::size_t i = 0; i <= D && hull.caps[c] == cap; ++i) {
                const Index across = hull.neighbors[c][i];
                if (across == no_index || hull.caps[across] != cap) {
                    facets.push_back(outward_facet<D>(hull.cells[c], static_cast<int>(i)));
                }
            }
        }
    };
    const std::vector<Facet<D>> found = parallel_gather<Facet<D>>(hull.cells.size(), cap_grain, find);
    return {found.begin(), found.end()};
}

template<int D>
bool bound_a_domain(Array<Facet<D>> facets, Array<Point<D>> points, int sign) {
    if (sign < 0) {
        for (Facet<D>& facet : facets) {
            std::swap(facet[0], facet[1]);
        }
    }
    Surface<D> surface;
    surface.points = std::move(points);
    surface.facets = std::move(facets);
    try { // the reasons are not needed: the pairs of cells will be reported
        require_domain_boundary(surface, {}, false);
        return true;
    } catch (const GeometryError&) {
        return false;
    }
}

template<int D>
std::vector<std::array<Index, 2>> edges_of(std::span<const Facet<D>> facets) {
    std::vector<std::array<Index, 2>> edges;
    for (const Facet<D>& facet : facets) {
        for (std::size_t i = 0; i < D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                edges.push_back(edge(facet[i], facet[j]));
            }
        }
    }
    sort_out(edges);
    return edges;
}

template<int D>
bool side_keeps_to(const CellsInCaps<D>& hull, double time, std::span<const Index> on_boundary,
                   std::span<const std::array<Index, 2>> edges) {
    return SideCheck<D>{hull, time, on_boundary, edges}.holds();
}

template<int D>
bool caps_are_embedded(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells,
                       const AdjacencyView<D>& adjacency, std::span<const CapOf> caps,
                       const std::array<double, 2>& times) {
    const CellsInCaps<D> hull{points, cells, adjacency.neighbors, caps};
    return adjacency.defects.empty() && cap_is_embedded<D>(hull, CapOf::first, times[0]) &&
           cap_is_embedded<D>(hull, CapOf::last, times[1]);
}

template std::array<double, 2> time_span<2>(const JoinedSpans<Point<3>>&, std::span<const Simplex<2>>);
template Array<CapOf> find_caps<2>(std::span<const Point<3>>, std::span<const Simplex<2>>,
                                   const std::array<double, 2>&);
template bool caps_are_embedded<2>(std::span<const Point<3>>, std::span<const Simplex<2>>,
                                   const AdjacencyView<2>&, std::span<const CapOf>,
                                   const std::array<double, 2>&);
template CapSigns signs_of_cap<2>(const CellsInCaps<2>&, CapOf);
template Array<Facet<2>> outer_facets<2>(const CellsInCaps<2>&, CapOf);
template bool bound_a_domain<2>(Array<Facet<2>>, Array<Point<2>>, int);
template std::vector<std::array<Index, 2>> edges_of<2>(std::span<const Facet<2>>);
template bool side_keeps_to<2>(const CellsInCaps<2>&, double, std::span<const Index>,
                               std::span<const std::array<Index, 2>>);
template std::array<double, 2> time_span<3>(const JoinedSpans<Point<4>>&, std::span<const Simplex<3>>);
template Array<CapOf> find_caps<3>(std::span<const Point<4>>, std::span<const Simplex<3>>,
                                   const std::array<double, 2>&);
template bool caps_are_embedded<3>(std::span<const Point<4>>, std::span<const Simplex<3>>,
                                   const AdjacencyView<3>&, std::span<const CapOf>,
                                   const std::array<double, 2>&);
template CapSigns signs_of_cap<3>(const CellsInCaps<3>&, CapOf);
template Array<Facet<3>> outer_facets<3>(const CellsInCaps<3>&, CapOf);
template bool bound_a_domain<3>(Array<Facet<3>>, Array<Point<3>>, int);
template std::vector<std::array<Index, 2>> edges_of<3>(std::span<const Facet<3>>);
template bool side_keeps_to<3>(const CellsInCaps<3>&, double, std::span<const Index>,
                               std::span<const std::array<Index, 2>>);

} // namespace slabhull
