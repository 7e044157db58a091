// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/vector.h"
#include "slabhull/topology/spatial_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace slabhull {

/// Normal N of a D-simplex in R^(D+1): det[e_1 .. e_D, N] > 0 and |N| is the simplex's measure (D = 1, 2, 3).
template<int D>
Point<D + 1> simplex_normal(const std::array<Point<D + 1>, D + 1>& corners);

/// Signed measure of a D-simplex in R^D: det[e_1 .. e_D] / D! (D = 1 to 4).
template<int D>
double signed_measure(const std::array<Point<D>, D + 1>& corners);

/// Smallest and largest dihedral angle of a D-simplex in R^N, N >= D, in degrees (D = 2: the angles).
struct AngleRange {
    double smallest;
    double largest;
};
/// For (D, N) = (2, 2), (2, 3), (3, 3), (3, 4), (4, 4). From the Gram matrix of the edges (D = 4: from the
/// facets' normals): accurate to about 1e-6 degrees near 0 and 180. A simplex with a facet of measure zero
/// has no dihedral angle there: its range is 0 to 180.
template<int D, int N>
AngleRange dihedral_angles(const std::array<Point<N>, D + 1>& corners);

/// How many dihedral angles lie in [0, 10), [10, 20) .. [170, 180] degrees.
inline constexpr std::size_t angle_bins = 18;
using AngleHistogram = std::array<std::size_t, angle_bins>;
/// All dihedral angles of simplices (D = 2: the angles), except simplices with a facet of measure zero.
/// For (D, N) = (2, 3), (3, 3), (3, 4).
template<int D, int N>
AngleHistogram angle_histogram(std::span<const Point<N>> points, std::span<const Simplex<D>> cells);

/// Longest edge over diameter of the inscribed ball, relative to the regular simplex: 1 for that, larger for
/// flatter ones, infinite for a simplex without measure. Time counts like a length.
/// For (D, N) = (2, 3), (3, 4).
template<int D, int N>
double aspect_ratio(const std::array<Point<N>, D + 1>& corners);

struct AspectRatios {
    double mean = 0;
    double largest = 0;
};
/// Over all simplices; zeros if there are none. The same for any number of threads.
template<int D, int N>
AspectRatios aspect_ratios(std::span<const Point<N>> points, std::span<const Simplex<D>> cells);

/// The corners of a cell; `points` is any list of Point<N>.
template<int D, int N, class Points>
std::array<Point<N>, D + 1> corners_of(const Simplex<D>& cell, const Points& points) {
    std::array<Point<N>, D + 1> corners;
    for (std::size_t i = 0; i <= D; ++i) {
        corners[i] = points[cell[i]];
    }
    return corners;
}

namespace detail {

/// Sum with Neumaier's correction (Zeitschrift fuer angewandte Mathematik und Mechanik 54, 1974). The
/// rounding error of each step is found by Knuth's method, without branching on which term is larger.
class CompensatedSum {
public:
    void add(double x) {
        const double next = sum_ + x;
        const double added = next - sum_;
        lost_ += (sum_ - (next - added)) + (x - added);
        sum_ = next;
    }
    void add(const CompensatedSum& other) {
        add(other.sum_);
        lost_ += other.lost_;
    }
    double value() const { return sum_ + lost_; }

private:
    double sum_ = 0;
    double lost_ = 0;
};

/// The extreme cosines of dihedral angles, as cos |cos|: monotone in the cosine, and needs no square root.
struct CosineRange {
    double smallest = 1;
    double largest = -1;

    void add(double s) {
        smallest = std::min(smallest, s);
        largest = std::max(largest, s);
    }
    void add(const CosineRange& other) { // may be empty: smallest 1, largest -1
        smallest = std::min(smallest, other.smallest);
        largest = std::max(largest, other.largest);
    }
    /// The smallest cosine belongs to the largest angle.
    AngleRange angles() const;
};

} // namespace detail

/// Sums over a range of oriented D-simplices in R^(D+1).
template<int D>
struct Measures {
    double measure = 0;        ///< sum of |N|
    Point<D + 1> closure{};    ///< sum of N: zero over a closed hull
    double enclosed = 0;       ///< sum of x.N / (D+1): the measure that a closed hull encloses
    AngleRange angles{180, 0}; ///< over all simplices, in degrees
    std::size_t cells = 0;
};

/// Compensated sums in a fixed order of pieces: the same for any number of threads. x is relative to the
/// first point, which does not affect a closed hull and loses fewer digits.
template<int D>
Measures<D> measure_cells(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells);

/// Accumulates the sums of measure_cells() simplex by simplex, for callers that visit each one anyway.
template<int D>
class MeasureSums {
public:
    /// Returns the normal of the simplex. x is taken relative to `origin`.
    Point<D + 1> add(const std::array<Point<D + 1>, D + 1>& corners, const Point<D + 1>& origin);
    void add(const MeasureSums& other);
    Measures<D> value() const;

private:
    detail::CompensatedSum measure_;
    detail::CompensatedSum enclosed_;
    std::array<detail::CompensatedSum, D + 1> closure_;
    detail::CosineRange cosines_;
    std::size_t cells_ = 0;
};

/// Sums over D-simplices in R^D.
struct SolidMeasures {
    double measure = 0;        ///< sum of the signed measures
    double smallest = 0;       ///< least signed measure of a simplex; infinite if there are none
    AngleRange angles{180, 0}; ///< over all simplices, in degrees
};
template<int D>
SolidMeasures measure_solid(std::span<const Point<D>> points, std::span<const Simplex<D>> cells);

extern template class MeasureSums<2>;
extern template class MeasureSums<3>;

/// Measure of a D-simplex in R^N; N is D or D + 1, any N for edges.
template<int D, int N>
double simplex_measure(const std::array<Point<N>, D + 1>& corners) {
    if constexpr (N == D) {
        return std::abs(signed_measure<D>(corners));
    } else {
        Point<N> normal{};
        if constexpr (D == 1) {
            for (std::size_t k = 0; k < N; ++k) {
                normal[k] = corners[1][k] - corners[0][k]; // an edge's measure is that of its vector
            }
        } else {
            normal = simplex_normal<D>(corners);
        }
        return norm(normal);
    }
}

/// Signed measure enclosed by some facets of a surface: positive if their normals point outward.
template<int D>
double enclosed_by(const Surface<D>& surface, std::span<const Index> facets);

} // namespace slabhull
