// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/facet_pair.h"

#include "geometry/basics/predicates.h"
#include "geometry/basics/vector_algebra.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace slabhull {

namespace {

using exact::orientation;

/// A pair of triangles projected along the axis nearest to the first one's normal. If the projections are
/// apart, so are the triangles. Nearly flat neighbours are well apart in projection, while their orientations
/// in space would need exact arithmetic.
/// well apart there.
class Projected {
public:
    explicit Projected(const FacetPair<3>& pair) {
        const std::size_t first = axis_for(pair.f);
        project(pair, first);
        for (std::size_t k = 1; k < 3 && turn_f_ == 0; ++k) { // rounding misjudged a sliver's normal
            project(pair, (first + k) % 3);
        }
    }

    /// Convex sets in a plane are apart if an edge of one has the other strictly outside.
    bool apart() const {
        for (std::size_t i = 0; i < 3; ++i) {
            if (separates(f_, turn_f_, i, g_) || separates(g_, turn_g_, i, f_)) {
                return true;
            }
        }
        return false;
    }

    /// Two angles at corner 0, each less than half a turn, meet only in their apex if no side of one lies in
    /// the other.
    bool apart_beyond_vertex() const {
        return !in_angle(f_, turn_f_, g_[1]) && !in_angle(f_, turn_f_, g_[2]) &&
               !in_angle(g_, turn_g_, f_[1]);
    }

    /// The third corners are on different sides of the edge of corners 0 and 1.
    bool apart_beyond_edge() const { return turn_f_ * turn_g_ < 0; }

private:
    using Triangle2 = std::array<Point<2>, 3>;

    static std::size_t axis_for(const FacetCorners<3>& t);
    void project(const FacetPair<3>& pair, std::size_t axis);

    static bool separates(const Triangle2& s, int turn, std::size_t i, const Triangle2& t) {
        return turn != 0 && std::all_of(t.begin(), t.end(), [&](const Point<2>& p) {
                   return orientation(s[i], s[(i + 1) % 3], p) == -turn;
               });
    }
    static bool in_angle(const Triangle2& s, int turn, const Point<2>& p) {
        return orientation(s[0], s[1], p) * turn >= 0 && orientation(s[0], p, s[2]) * turn >= 0;
    }

    Triangle2 f_;
    Triangle2 g_;
    int turn_f_ = 0;
    int turn_g_ = 0; ///< 0: the projection is degenerate and separates nothing
};

std::size_t Projected::axis_for(const FacetCorners<3>& t) {
    Point<3> normal;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3;
        const std::size_t j = (k + 2) % 3;
        normal[k] =
            std::abs((t[1][i] - t[0][i]) * (t[2][j] - t[0][j]) - (t[1][j] - t[0][j]) * (t[2][i] - t[0][i]));
    }
    return static_cast<std::size_t>(std::max_element(normal.begin(), normal.end()) - normal.begin());
}

void Projected::project(const FacetPair<3>& pair, std::size_t axis) {
    const auto drop = [axis](const Point<3>& p) { return Point<2>{p[(axis + 1) % 3], p[(axis + 2) % 3]}; };
    for (std::size_t i = 0; i < 3; ++i) {
        f_[i] = drop(pair.f[i]);
        g_[i] = drop(pair.g[i]);
    }
    turn_f_ = orientation(f_[0], f_[1], f_[2]);
    turn_g_ = orientation(g_[0], g_[1], g_[2]);
}

/// Sides of a triangle's corners, from `first` on, relative to the plane of another triangle.
struct Sides {
    Sides(const FacetCorners<3>& plane, const FacetCorners<3>& t, std::size_t first) {
        for (std::size_t i = first; i < 3; ++i) {
            const int side = orientation(plane[0], plane[1], plane[2], t[i]);
            above |= side >= 0;
            below |= side <= 0;
            off |= side != 0;
        }
    }
    bool clear() const { return !(above && below); } ///< all strictly on one side
    bool coplanar() const { return !off; }

    bool above = false;
    bool below = false;
    bool off = false;
};

bool meet_apart(const FacetPair<3>& pair) {
    if (Projected{pair}.apart()) {
        return false;
    }
    const Sides g_to_f{pair.f, pair.g, 0};
    return g_to_f.coplanar() || (!g_to_f.clear() && exact::meet(pair.f, pair.g));
}

/// Triangles that share only corner 0. If they meet elsewhere, they meet along the ray from the shared corner
/// until one triangle ends: on the far edge of that one, inside the other.
bool meet_beyond_vertex(const FacetPair<3>& pair) {
    const auto& [f, g, shared] = pair;
    if (Projected{pair}.apart_beyond_vertex()) {
        return false;
    }
    const Sides g_to_f{f, g, 1};
    if (g_to_f.clear() || g_to_f.coplanar()) {
        return !g_to_f.clear();
    }
    return !Sides{g, f, 1}.clear() &&
           (exact::meet(exact::Segment3{g[1], g[2]}, f) || exact::meet(exact::Segment3{f[1], f[2]}, g));
}

/// Triangles that share corners 0 and 1 overlap only if folded flat onto each other.
bool folded(const FacetPair<3>& pair) {
    return !Projected{pair}.apart_beyond_edge() &&
           orientation(pair.f[0], pair.f[1], pair.f[2], pair.g[2]) == 0;
}

/// Segments that share only end 0 overlap if they leave it in the same direction.
bool overlap(const FacetCorners<2>& f, const FacetCorners<2>& g) {
    if (orientation(f[0], f[1], g[1]) != 0) {
        return false;
    }
    const auto sign = [&](const FacetCorners<2>& s, std::size_t k) {
        return (s[1][k] > s[0][k]) - (s[1][k] < s[0][k]);
    };
    return sign(f, 0) == sign(g, 0) && sign(f, 1) == sign(g, 1);
}

template<std::size_t N>
Point<N> along(const Point<N>& a, const Point<N>& direction, double s) {
    return plus(a, times(s, direction));
}

template<std::size_t N>
Point<N> nearest_on_segment(const Point<N>& a, const Point<N>& b, const Point<N>& x) {
    const Point<N> u = minus(b, a);
    return along(a, u, std::clamp(dot(minus(x, a), u) / dot(u, u), 0.0, 1.0));
}

Point<2> nearest_on(const FacetCorners<2>& s, const Point<2>& x) {
    return nearest_on_segment(s[0], s[1], x);
}

Point<3> nearest_on(const FacetCorners<3>& t, const Point<3>& x) {
    const Point<3> u = minus(t[1], t[0]);
    const Point<3> v = minus(t[2], t[0]);
    const Point<3> w = minus(x, t[0]);
    const double uu = dot(u, u);
    const double uv = dot(u, v);
    const double vv = dot(v, v);
    const double det = uu * vv - uv * uv;
    const double r = (vv * dot(u, w) - uv * dot(v, w)) / det;
    const double s = (uu * dot(v, w) - uv * dot(u, w)) / det;
    if (r >= 0 && s >= 0 && r + s <= 1) {
        return along(along(t[0], u, r), v, s);
    }
    Point<3> best = nearest_on_segment(t[0], t[1], x);
    for (std::size_t i = 1; i < 3; ++i) {
        const Point<3> p = nearest_on_segment(t[i], t[(i + 1) % 3], x);
        best = squared_distance(p, x) < squared_distance(best, x) ? p : best;
    }
    return best;
}

} // namespace

template<int D>
FacetPair<D> pair_of_facets(const Surface<D>& surface, Index first, Index second) {
    Facet<D> f = surface.facets[first];
    Facet<D> g = surface.facets[second];
    FacetPair<D> pair;
    for (std::size_t i = 0; i < D; ++i) {
        const auto twin = std::find(g.begin() + pair.shared, g.end(), f[i]);
        if (twin != g.end()) {
            std::swap(f[i], f[pair.shared]);
            std::swap(*twin, g[pair.shared]);
            ++pair.shared;
        }
    }
    for (std::size_t i = 0; i < D; ++i) {
        pair.f[i] = surface.points[f[i]];
        pair.g[i] = surface.points[g[i]];
    }
    return pair;
}

template<int D>
Array<Box<D>> facet_boxes(const Surface<D>& surface) {
    Array<Box<D>> boxes;
    boxes.assign(surface.facets.size(), Box<D>{});
    parallel_for(boxes.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const FacetCorners<D> corners = corners_of_facet(surface, static_cast<Index>(f));
            if (!std::all_of(corners.begin(), corners.end(), all_finite<D>) || exact::degenerate(corners)) {
                continue;
            }
            for (const Point<D>& p : corners) {
                boxes[f].include(p);
            }
        }
    });
    return boxes;
}

bool meet_elsewhere(const FacetPair<2>& pair) {
    switch (pair.shared) {
    case 0:
        return exact::meet(pair.f, pair.g);
    case 1:
        return overlap(pair.f, pair.g);
    default:
        return true;
    }
}

bool meet_elsewhere(const FacetPair<3>& pair) {
    switch (pair.shared) {
    case 0:
        return meet_apart(pair);
    case 1:
        return meet_beyond_vertex(pair);
    case 2:
        return folded(pair);
    default:
        return true;
    }
}

template<int D>
Point<D> meeting_place(const FacetPair<D>& pair) {
    // Alternating projections onto two convex sets approach a common point. Start away from the shared
    // vertices.
    Point<D> x = times(0.5, plus(pair.f[D - 1], pair.g[D - 1]));
    for (int step = 0; step < 50; ++step) {
        x = nearest_on(pair.g, nearest_on(pair.f, x));
    }
    return x;
}

template Array<Box<2>> facet_boxes<2>(const Surface<2>&);
template Array<Box<3>> facet_boxes<3>(const Surface<3>&);
template FacetPair<2> pair_of_facets<2>(const Surface<2>&, Index, Index);
template FacetPair<3> pair_of_facets<3>(const Surface<3>&, Index, Index);
template Point<2> meeting_place<2>(const FacetPair<2>&);
template Point<3> meeting_place<3>(const FacetPair<3>&);

} // namespace slabhull
