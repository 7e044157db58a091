// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/motion/cubic_spline.h"

#include "geometry/basics/vector_algebra.h"

#include <algorithm>
#include <cstddef>

namespace slabhull::detail {

namespace {

/// A row of the tridiagonal system for the slopes: below s[i-1] + diagonal s[i] + above s[i+1] = right.
template<int N>
struct Equation {
    double below;
    double diagonal;
    double above;
    Point<N> right;
};

/// Intervals between rows: their lengths h and the slopes c of their chords.
template<int N>
struct Pieces {
    std::vector<double> h;
    std::vector<Point<N>> c;
};

template<int N>
Pieces<N> pieces_of(const std::vector<double>& times, const std::vector<Point<N>>& values) {
    Pieces<N> pieces;
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        pieces.h.push_back(times[i + 1] - times[i]);
        pieces.c.push_back(slabhull::times(1 / pieces.h[i], minus(values[i + 1], values[i])));
    }
    return pieces;
}

/// Equation of an end: the third derivatives of its two pieces agree; `outer` is the piece at the end.
template<int N>
Point<N> not_a_knot(double outer, double inner, const Point<N>& outer_chord, const Point<N>& inner_chord) {
    const double both = outer + inner;
    return times(1 / both,
                 plus(times((outer + 2 * both) * inner, outer_chord), times(outer * outer, inner_chord)));
}

/// Equation of an inner row: the second derivatives agree.
template<int N>
std::vector<Equation<N>> equations(const Pieces<N>& pieces) {
    const auto& [h, c] = pieces;
    const std::size_t last = h.size();
    std::vector<Equation<N>> lines(last + 1);
    for (std::size_t i = 1; i < last; ++i) {
        lines[i] = {h[i], 2 * (h[i - 1] + h[i]), h[i - 1],
                    times(3, plus(times(h[i], c[i - 1]), times(h[i - 1], c[i])))};
    }
    if (last == 2) { // a parabola through three rows
        lines[0] = {0, 1, 1, times(2, c[0])};
        lines[2] = {1, 1, 0, times(2, c[1])};
    } else {
        lines[0] = {0, h[1], h[0] + h[1], not_a_knot<N>(h[0], h[1], c[0], c[1])};
        lines[last] = {h[last - 2] + h[last - 1], h[last - 2], 0,
                       not_a_knot<N>(h[last - 1], h[last - 2], c[last - 1], c[last - 2])};
    }
    return lines;
}

/// Elimination without pivoting, which is never singular for these equations.
template<int N>
std::vector<Point<N>> solve(std::vector<Equation<N>> lines) {
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const double factor = lines[i].below / lines[i - 1].diagonal;
        lines[i].diagonal -= factor * lines[i - 1].above;
        lines[i].right = minus(lines[i].right, times(factor, lines[i - 1].right));
    }
    std::vector<Point<N>> x(lines.size());
    for (std::size_t i = lines.size(); i-- > 0;) {
        const Point<N> known = i + 1 < lines.size() ? times(lines[i].above, x[i + 1]) : Point<N>{};
        x[i] = times(1 / lines[i].diagonal, minus(lines[i].right, known));
    }
    return x;
}

} // namespace

template<int N>
CubicSpline<N>::CubicSpline(std::vector<double> times, std::vector<Point<N>> values)
    : times_{std::move(times)}, values_{std::move(values)} {
    const Pieces<N> pieces = pieces_of<N>(times_, values_);
    slopes_ = pieces.h.size() == 1 ? std::vector<Point<N>>(2, pieces.c[0]) : solve<N>(equations<N>(pieces));
}

template<int N>
Sample<N> CubicSpline<N>::at(double t) const {
    const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
    const auto i = static_cast<std::size_t>(next - times_.begin()) - 1;
    const double h = times_[i + 1] - times_[i];
    const double u = (t - times_[i]) / h;
    const double w = 1 - u;
    Sample<N> sample;
    for (std::size_t k = 0; k < N; ++k) { // Hermite's form, exact at the rows
        const double rise = values_[i + 1][k] - values_[i][k];
        sample.value[k] = w * w * (1 + 2 * u) * values_[i][k] + u * u * (1 + 2 * w) * values_[i + 1][k] +
                          h * u * w * (w * slopes_[i][k] - u * slopes_[i + 1][k]);
        sample.rate[k] =
            6 * u * w * rise / h + w * (w - 2 * u) * slopes_[i][k] + u * (u - 2 * w) * slopes_[i + 1][k];
    }
    return sample;
}

template class CubicSpline<1>;
template class CubicSpline<2>;
template class CubicSpline<3>;
template class CubicSpline<4>;

} // namespace slabhull::detail
