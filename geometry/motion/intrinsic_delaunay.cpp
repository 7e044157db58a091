// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/motion/intrinsic_delaunay.h"

#include "slabhull/core/vector.h"

#include <algorithm>
#include <cmath>

namespace slabhull::detail {

namespace {

/// Cotangent of the angle opposite to side a, between sides b and c. Kahan's order of the sums keeps the area
/// of needles accurate. A triangle that rounding has flattened gets a large, finite value.
double cotangent(double a, double b, double c) {
    std::array<double, 3> sides{a, b, c};
    std::sort(sides.begin(), sides.end());
    const auto [small, middle, large] = sides;
    const double squared = (large + (middle + small)) * (small - (large - middle)) *
                           (small + (large - middle)) * (large + (middle - small));
    const double four_areas = std::max(std::sqrt(std::max(squared, 0.0)), 1e-14 * large * large);
    return (b * b + c * c - a * a) / four_areas;
}

/// A directed copy of an edge, with its triangle on the left.
using HalfEdge = Index;

/// Triangles given by their vertices and edge lengths. A flip of the half-edge h from b to c:
///
///            c                  c
///          / | \              /   \             .
///        a   |   d    -->   a - - - d
///          \ | /              \   /             .
///            b                  b
class IntrinsicTriangulation {
public:
    IntrinsicTriangulation(const Boundary<3>& boundary, std::span<const Index> facets) {
        for (const Index f : facets) {
            const Facet<3>& facet = boundary.facets()[f];
            const auto first = static_cast<HalfEdge>(from_.size());
            for (Index i = 0; i < 3; ++i) {
                from_.push_back(facet[i]);
                next_.push_back(first + (i + 1) % 3);
                length_.push_back(distance(boundary.start()[facet[i]], boundary.start()[facet[(i + 1) % 3]]));
            }
        }
        find_twins(boundary, facets);
    }

    /// The number of flips is bounded, since rounding might flip needles back and forth for ever. Some
    /// weights may then stay slightly negative.
    void make_delaunay() {
        std::vector<HalfEdge> suspects;
        for (HalfEdge h = 0; h < twin_.size(); ++h) {
            if (twin_[h] != no_index && h < twin_[h]) {
                suspects.push_back(h);
            }
        }
        constexpr std::size_t flips_per_edge = 100;
        std::size_t flips_left = flips_per_edge * suspects.size();
        while (!suspects.empty() && flips_left > 0) {
            const HalfEdge h = suspects.back();
            suspects.pop_back();
            if (wants_flip(h)) {
                flip(h);
                --flips_left;
                for (const HalfEdge side : {h, twin_[h]}) {
                    suspects.push_back(next_[side]);
                    suspects.push_back(next_[next_[side]]);
                }
            }
        }
    }

    std::vector<WeightedEdge> edges() const {
        std::vector<WeightedEdge> edges;
        for (HalfEdge h = 0; h < twin_.size(); ++h) {
            if (twin_[h] == no_index || h < twin_[h]) {
                const double other = twin_[h] == no_index ? 0 : cotangent_opposite(twin_[h]);
                edges.push_back({from_[h], to(h), 0.5 * (cotangent_opposite(h) + other)});
            }
        }
        return edges;
    }

private:
    /// Twins as in the boundary: no_index at the rim of the chosen facets.
    void find_twins(const Boundary<3>& boundary, std::span<const Index> facets) {
        std::vector<Index> chosen(boundary.facet_count(), no_index);
        for (Index k = 0; k < facets.size(); ++k) {
            chosen[facets[k]] = k;
        }
        twin_.assign(from_.size(), no_index);
        for (Index k = 0; k < facets.size(); ++k) {
            for (Index i = 0; i < 3; ++i) { // half-edge i + 1 is opposite to corner i
                const TwinFacet twin = boundary.twin(facets[k], i);
                if (chosen[twin.facet] != no_index) {
                    twin_[3 * k + (i + 1) % 3] = 3 * chosen[twin.facet] + (twin.corner + 1u) % 3;
                }
            }
        }
    }

    Index to(HalfEdge h) const { return from_[next_[h]]; }

    double cotangent_opposite(HalfEdge h) const {
        return cotangent(length_[h], length_[next_[h]], length_[next_[next_[h]]]);
    }

    bool wants_flip(HalfEdge h) const {
        if (twin_[h] == no_index) {
            return false;
        }
        constexpr double rounding = 1e-10; // so that the two diagonals of a square count as equal
        const double left = cotangent_opposite(h);
        const double right = cotangent_opposite(twin_[h]);
        return left + right < -rounding * (std::abs(left) + std::abs(right) + 1);
    }

    /// The third corner of a half-edge's triangle unfolded into the plane, where the half-edge runs along the
    /// first axis from the origin.
    Point<2> unfolded_corner(HalfEdge h) const {
        const double base = length_[h];
        const double to_end = length_[next_[h]];
        const double to_start = length_[next_[next_[h]]];
        const double x = (base * base + to_start * to_start - to_end * to_end) / (2 * base);
        return {x, std::sqrt(std::max(to_start * to_start - x * x, 0.0))};
    }

    void make_triangle(HalfEdge h, HalfEdge second, HalfEdge third) {
        next_[h] = second;
        next_[second] = third;
        next_[third] = h;
    }

    /// Needs: a negative weight, which implies that the two triangles form a convex quadrilateral.
    void flip(HalfEdge h) {
        const HalfEdge t = twin_[h];
        const HalfEdge ca = next_[h];
        const HalfEdge ab = next_[ca];
        const HalfEdge bd = next_[t];
        const HalfEdge dc = next_[bd];
        const Point<2> a = unfolded_corner(h);
        const Point<2> d = unfolded_corner(t); // the twin runs in the opposite direction
        length_[h] = length_[t] = std::hypot(a[0] - (length_[h] - d[0]), a[1] + d[1]);
        from_[h] = from_[ab];
        from_[t] = from_[dc];
        make_triangle(h, dc, ca);
        make_triangle(t, ab, bd);
    }

    // Indexed by half-edge.
    std::vector<Index> from_;
    std::vector<HalfEdge> next_; ///< in its triangle, counter-clockwise
    std::vector<HalfEdge> twin_; ///< the opposite half-edge of the same edge; no_index on the rim
    std::vector<double> length_;
};

} // namespace

std::vector<WeightedEdge> cotangent_edges(const Boundary<3>& boundary, std::span<const Index> facets) {
    IntrinsicTriangulation triangulation{boundary, facets};
    triangulation.make_delaunay();
    return triangulation.edges();
}

} // namespace slabhull::detail
