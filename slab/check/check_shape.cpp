// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/check_shape.h"
#include "slab/check/may_repeat.h"
#include "slabhull/core/vector.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cmath>

namespace slabhull {

namespace {

/// A cell whose measure is below this times its measure_scale() has no reliable orientation.
constexpr double degenerate = 1e-14;

template<int D, int N>
double squared_distance_in_space(const Point<N>& p, const Point<N>& q) {
    double square = 0;
    for (std::size_t k = 0; k < D; ++k) {
        square += (p[k] - q[k]) * (p[k] - q[k]);
    }
    return square;
}

template<int D, int N>
double time_between(const Point<N>& p, const Point<N>& q) {
    return N > D ? std::abs(p[N - 1] - q[N - 1]) : 0;
}

/// Bounds the products of lengths that a measure sums up, by which its rounding is judged: D differences in
/// space, or D - 1 of them and one in time.
template<int D>
double measure_scale(double length, double last) {
    double scale = last;
    for (int k = 1; k < D; ++k) {
        scale *= length;
    }
    return scale;
}

/// The largest distance between corners in space, and in time.
struct CellExtent {
    double length;
    double time;
};

template<int D, int N>
CellExtent extent_of(const std::array<Point<N>, D + 1>& corners) {
    double square = 0;
    double time = 0;
    for (std::size_t i = 0; i <= D; ++i) {
        for (std::size_t j = i + 1; j <= D; ++j) {
            square = std::max(square, squared_distance_in_space<D, N>(corners[i], corners[j]));
            time = std::max(time, time_between<D, N>(corners[i], corners[j]));
        }
    }
    return {std::sqrt(square), time};
}

/// A quick bound: no edge is longer than twice the longest at the first corner (5 instead of 4 allows for
/// rounding).
template<int D, int N>
bool is_far_from_degenerate(double measure, const std::array<Point<N>, D + 1>& corners) {
    double square = 0;
    double time = 0;
    for (std::size_t i = 1; i <= D; ++i) {
        square = std::max(square, squared_distance_in_space<D, N>(corners[0], corners[i]));
        time = std::max(time, time_between<D, N>(corners[0], corners[i]));
    }
    return measure * measure >
           degenerate * degenerate * measure_scale<D>(5 * square, 5 * std::max(square, time * time));
}

/// Pairs of a vertex and the first one with the same coordinates, ascending.
template<int N>
std::vector<std::array<Index, 2>> coincident_pairs(std::span<const Point<N>> points) {
    Array<std::pair<std::uint64_t, Index>> order; // an Array: the heap would keep the memory
    for (const Index v :
         may_repeat(points.size(), [&](std::size_t each) { return fingerprint(points[each]); })) {
        order.emplace_back(fingerprint(points[v]), v);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::array<Index, 2>> pairs;
    for (std::size_t first = 0, k = 1; k < order.size(); ++k) {
        if (order[k].first != order[first].first || points[order[k].second] != points[order[first].second]) {
            first = k;
        } else {
            pairs.push_back({order[first].second, order[k].second});
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

Defect defect_of(ManifoldDefect what) {
    switch (what) {
    case ManifoldDefect::repeated_vertex:
        return Defect::repeated_vertex;
    case ManifoldDefect::duplicate_cell:
        return Defect::duplicate_cell;
    case ManifoldDefect::unused_vertex:
        return Defect::unused_vertex;
    case ManifoldDefect::open_facet:
        return Defect::open_facet;
    case ManifoldDefect::overfull_facet:
        return Defect::overfull_facet;
    case ManifoldDefect::disoriented_facet:
        return Defect::disoriented_facet;
    case ManifoldDefect::singular_edge:
        return Defect::singular_edge;
    case ManifoldDefect::singular_vertex:
        return Defect::singular_vertex;
    }
    return Defect::singular_vertex;
}

} // namespace

template<int D>
bool check_indices(std::span<const Simplex<D>> cells, std::size_t vertex_count, Findings& findings) {
    if (cells.empty()) {
        findings.other(Defect::no_cells, {}, "there are no cells");
        return false;
    }
    const auto bad = select(cells.size(), [&](std::size_t c) {
        return std::any_of(cells[c].begin(), cells[c].end(), [&](Index v) { return v >= vertex_count; });
    });
    for (const Index c : bad) {
        findings.cell(Defect::index_out_of_range, c,
                      fmt::format("names a vertex that does not exist (there are {})", vertex_count));
    }
    return bad.empty();
}

template<int N>
bool check_finite(std::span<const Point<N>> points, Findings& findings) {
    const auto bad = select(points.size(), [&](std::size_t v) {
        return std::any_of(points[v].begin(), points[v].end(), [](double x) { return !std::isfinite(x); });
    });
    for (const Index v : bad) {
        findings.vertex(Defect::non_finite_coordinate, v, "a coordinate is not a finite number");
    }
    return bad.empty();
}

template<int N>
void check_coincident(std::span<const Point<N>> points, Findings& findings) {
    for (const std::array<Index, 2>& pair : coincident_pairs<N>(points)) {
        const std::vector<Entity> names = findings.vertex_entities(pair);
        findings.other(Defect::coincident_vertices, names,
                       fmt::format("vertices {} and {}: same coordinates", names[0].number, names[1].number));
    }
}

template<int D, int N>
bool is_degenerate(const std::array<Point<N>, D + 1>& corners) {
    return is_degenerate<D, N>(corners, simplex_measure<D, N>(corners));
}

template<int D, int N>
bool is_degenerate(const std::array<Point<N>, D + 1>& corners, double measure) {
    if (is_far_from_degenerate<D, N>(measure, corners)) {
        return false;
    }
    const auto [length, time] = extent_of<D, N>(corners);
    const double in_space = degenerate * measure_scale<D>(length, length);
    if constexpr (N == D) {
        return measure <= in_space;
    } else {
        // Times and lengths have units of their own, so each part of the normal is judged in its own.
        const Point<N> normal = simplex_normal<D>(corners);
        double square = 0;
        for (std::size_t k = 0; k < D; ++k) {
            square += normal[k] * normal[k];
        }
        return std::sqrt(square) <= degenerate * measure_scale<D>(length, time) &&
               std::abs(normal[D]) <= in_space;
    }
}

template<int D, int N>
void report_degenerate(std::span<const Point<N>> points, std::span<const Simplex<D>> cells,
                       std::span<const Index> degenerate, Findings& findings) {
    for (const Index c : degenerate) {
        findings.cell(
            Defect::degenerate_cell, c,
            fmt::format("its measure is {:.3g}", simplex_measure<D, N>(corners_of<D, N>(cells[c], points))));
    }
}

template<int D, int N>
void check_degenerate(std::span<const Point<N>> points, std::span<const Simplex<D>> cells,
                      Findings& findings) {
    const auto bad = select(cells.size(), [&](std::size_t c) {
        return is_degenerate<D, N>(corners_of<D, N>(cells[c], points)) && !repeats_a_vertex(cells[c]);
    });
    report_degenerate<D, N>(points, cells, bad, findings);
}

void translate(const ManifoldReport& report, std::initializer_list<ManifoldDefect> except,
               Findings& findings) {
    const auto wanted = [&](ManifoldDefect what) {
        return std::find(except.begin(), except.end(), what) == except.end();
    };
    for (const ManifoldFinding& found : report.findings) {
        if (!wanted(found.what)) {
            continue;
        }
        const Defect what = defect_of(found.what);
        if (found.what == ManifoldDefect::repeated_vertex || found.what == ManifoldDefect::duplicate_cell) {
            findings.cells(what, found.cells, found.detail);
        } else {
            findings.vertices(what, found.vertices, found.cells, found.detail);
        }
    }
    for (std::size_t kind = 0; kind < manifold_defect_kinds; ++kind) {
        const auto what = static_cast<ManifoldDefect>(kind);
        if (wanted(what)) {
            findings.set_count(defect_of(what), report.count(what));
        }
    }
}

template bool check_indices<2>(std::span<const Simplex<2>>, std::size_t, Findings&);
template bool check_indices<3>(std::span<const Simplex<3>>, std::size_t, Findings&);
template bool check_indices<4>(std::span<const Simplex<4>>, std::size_t, Findings&);
template bool check_finite<2>(std::span<const Point<2>>, Findings&);
template bool check_finite<3>(std::span<const Point<3>>, Findings&);
template bool check_finite<4>(std::span<const Point<4>>, Findings&);
template void check_coincident<2>(std::span<const Point<2>>, Findings&);
template void check_coincident<3>(std::span<const Point<3>>, Findings&);
template void check_coincident<4>(std::span<const Point<4>>, Findings&);
template bool is_degenerate<2, 2>(const std::array<Point<2>, 3>&);
template bool is_degenerate<3, 3>(const std::array<Point<3>, 4>&);
template bool is_degenerate<2, 3>(const std::array<Point<3>, 3>&, double);
template bool is_degenerate<3, 4>(const std::array<Point<4>, 4>&, double);
template void report_degenerate<2, 3>(std::span<const Point<3>>, std::span<const Simplex<2>>,
                                      std::span<const Index>, Findings&);
template void report_degenerate<3, 4>(std::span<const Point<4>>, std::span<const Simplex<3>>,
                                      std::span<const Index>, Findings&);
template void check_degenerate<2, 2>(std::span<const Point<2>>, std::span<const Simplex<2>>, Findings&);
template void check_degenerate<3, 3>(std::span<const Point<3>>, std::span<const Simplex<3>>, Findings&);

} // namespace slabhull
