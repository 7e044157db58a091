// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <array>
#include <span>

namespace slabhull {

/// Normal N of a D-simplex in R^(D+1): det[e_1 .. e_D, N] > 0 and |N| is the simplex's measure.
template<int D>
Point<D + 1> simplex_normal(const std::array<Point<D + 1>, D + 1>& corners);

/// Signed measure of a D-simplex in R^D: det[e_1 .. e_D] / D!.
template<int D>
double signed_measure(const std::array<Point<D>, D + 1>& corners);

/// Smallest and largest dihedral angle of a D-simplex in R^N, N >= D, in degrees (D = 2: the angles).
struct AngleRange {
    double smallest;
    double largest;
};
template<int D, int N>
AngleRange dihedral_angles(const std::array<Point<N>, D + 1>& corners);

/// The corners of a cell.
template<int D, int N>
std::array<Point<N>, D + 1> corners_of(const Simplex<D>& cell, std::span<const Point<N>> points) {
    std::array<Point<N>, D + 1> corners;
    for (std::size_t i = 0; i <= D; ++i) {
        corners[i] = points[cell[i]];
    }
    return corners;
}

/// Sums over a range of oriented D-simplices in R^(D+1).
template<int D>
struct Measures {
    double measure = 0;        ///< sum of |N|
    Point<D + 1> closure{};    ///< sum of N: zero over a closed hull
    double enclosed = 0;       ///< sum of x.N / (D+1): the measure that a closed hull encloses
    AngleRange angles{180, 0}; ///< over all simplices, in degrees
};

/// Compensated sums in a fixed order of pieces: the same for any number of threads. x is taken relative to the first
/// point, which changes nothing for a closed hull and loses fewer digits.
template<int D>
Measures<D> measure_cells(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells);

} // namespace slabhull
