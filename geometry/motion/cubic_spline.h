// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <vector>

namespace slabhull::detail {

/// A value and its time derivative.
template<int N>
struct Sample {
    Point<N> value;
    Point<N> rate;
};

/// The cubic spline with two continuous derivatives through rows of N values each, exact at the rows.
/// "Not-a-knot" ends: the first two pieces are one cubic, and so are the last two; three rows give a
/// parabola, two a line. Order 4 in the spacing of the rows, its derivative order 3. De Boor, "A Practical
/// Guide to Splines" (1978), chapter IV.
template<int N>
class CubicSpline {
public:
    /// Needs: at least two times, strictly ascending, one value per time; all finite.
    CubicSpline(std::vector<double> times, std::vector<Point<N>> values);

    double first() const { return times_.front(); }
    double last() const { return times_.back(); }

    /// The value at a time in [first(), last()].
    Sample<N> at(double t) const;

private:
    std::vector<double> times_;
    std::vector<Point<N>> values_;
    std::vector<Point<N>> slopes_; ///< at the rows
};

extern template class CubicSpline<1>;
extern template class CubicSpline<2>;
extern template class CubicSpline<3>;
extern template class CubicSpline<4>;

} // namespace slabhull::detail
