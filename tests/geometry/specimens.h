// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/topology/spatial_mesh.h"

#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <string>
#include <utility>

/// Named surfaces for tests. Each is closed and points outwards of the set it surrounds; turn it inside out
/// to make it the boundary of a body in a domain.
namespace slabhull::specimens {

inline void name_patch(auto& surface, PatchNumber number, const std::string& name) {
    surface.patch.assign(surface.facets.size(), number);
    surface.patches = {{number, name}};
}

template<int D>
Surface<D> turned_inside_out(Surface<D> surface) {
    for (Facet<D>& facet : surface.facets) {
        std::swap(facet[0], facet[1]);
    }
    return surface;
}

/// Applies `map` to every point.
template<int D, class Map>
Surface<D> mapped(Surface<D> surface, Map&& map) {
    for (Point<D>& p : surface.points) {
        p = map(p);
    }
    return surface;
}

/// Both surfaces in one, those of `b` numbered after those of `a`.
template<int D>
Surface<D> together(Surface<D> a, const Surface<D>& b) {
    const auto offset = static_cast<Index>(a.points.size());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    for (Facet<D> facet : b.facets) {
        for (Index& v : facet) {
            v += offset;
        }
        a.facets.push_back(facet);
    }
    a.patch.insert(a.patch.end(), b.patch.begin(), b.patch.end());
    a.patches.insert(a.patches.end(), b.patches.begin(), b.patches.end());
    return a;
}

template<int D>
Surface<D> shifted(const Surface<D>& surface, const Point<D>& by) {
    return mapped(surface, [&](Point<D> p) {
        for (std::size_t k = 0; k < D; ++k) {
            p[k] += by[k];
        }
        return p;
    });
}

/// A closed grid of m x n quadrilaterals, both directions periodic, each split in two.
template<class At>
Surface<3> torus_grid(Index m, Index n, At&& at) {
    Surface<3> s;
    for (Index i = 0; i < m; ++i) {
        for (Index j = 0; j < n; ++j) {
            s.points.push_back(at(2 * std::numbers::pi * i / m, 2 * std::numbers::pi * j / n));
            const Index a = i * n + j;
            const Index b = (i + 1) % m * n + j;
            const Index c = (i + 1) % m * n + (j + 1) % n;
            const Index d = i * n + (j + 1) % n;
            s.facets.push_back({a, b, c});
            s.facets.push_back({a, c, d});
        }
    }
    return s;
}

/// Circle of `big` swept by one of `small`; m x n quadrilaterals.
inline Surface<3> torus(double big, double small, Index m, Index n) {
    Surface<3> s = torus_grid(m, n, [&](double u, double v) {
        const double r = big + small * std::cos(v);
        return Point<3>{r * std::cos(u), r * std::sin(u), small * std::sin(v)};
    });
    name_patch(s, 7, "torus");
    return s;
}

/// A cube's surface of edge 2 about the origin, n x n squares a side, each split in two: 12 n^2 triangles.
inline Surface<3> cube_grid(Index n) {
    Surface<3> s;
    std::map<std::array<Index, 3>, Index> numbers;
    const auto vertex = [&](std::array<Index, 3> place) {
        const auto [entry, fresh] = numbers.try_emplace(place, static_cast<Index>(s.points.size()));
        if (fresh) {
            const auto coordinate = [&](std::size_t k) { return 2.0 * place[k] / n - 1; };
            s.points.push_back({coordinate(0), coordinate(1), coordinate(2)});
        }
        return entry->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const bool upper : {false, true}) {
            const auto at = [&](Index i, Index j) {
                std::array<Index, 3> place{};
                place[axis] = upper ? n : 0;
                place[(axis + 1) % 3] = upper ? i : j;
                place[(axis + 2) % 3] = upper ? j : i;
                return vertex(place);
            };
            for (Index i = 0; i < n; ++i) {
                for (Index j = 0; j < n; ++j) {
                    s.facets.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                    s.facets.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
                }
            }
        }
    }
    name_patch(s, 1, "cube");
    return s;
}

inline Surface<3> box(const Point<3>& low, const Point<3>& high, Index n) {
    Surface<3> s = mapped(cube_grid(n), [&](Point<3> p) {
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = p[k] < 1 ? low[k] + 0.5 * (p[k] + 1) * (high[k] - low[k]) : high[k];
        }
        return p;
    });
    name_patch(s, 1, "box");
    return s;
}

/// Sphere as a blown-up cube grid: 12 n^2 triangles, all of about one size.
inline Surface<3> ball(const Point<3>& centre, double radius, Index n) {
    Surface<3> s = mapped(cube_grid(n), [&](Point<3> p) {
        for (double& x : p) {
            x = std::tan(x * std::numbers::pi / 4);
        }
        const double length = std::hypot(p[0], p[1], p[2]);
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = centre[k] + radius * p[k] / length;
        }
        return p;
    });
    name_patch(s, 2, "ball");
    return s;
}

/// Closed polygon inscribed in a circle, the set to the right of each edge (clockwise).
inline Surface<2> disc(const Point<2>& centre, double radius, Index n) {
    Surface<2> s;
    for (Index i = 0; i < n; ++i) {
        const double angle = -2 * std::numbers::pi * i / n;
        s.points.push_back({centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)});
        s.facets.push_back({i, (i + 1) % n});
    }
    name_patch(s, 3, "disc");
    return s;
}

} // namespace slabhull::specimens
