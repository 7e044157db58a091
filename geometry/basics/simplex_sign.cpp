// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/simplex_sign.h"

#include <CGAL/Exact_rational.h>

#include <cmath>
#include <cstddef>
#include <limits>

namespace slabhull {

namespace {

template<class Number, std::size_t N>
using Rows = std::array<std::array<Number, N>, N>;

/// Minor of the leading K rows in the given columns, by expansion along row K - 1.
template<std::size_t K, class Number, std::size_t N, class Combine>
Number expanded(const Rows<Number, N>& rows, const std::array<std::size_t, K>& columns,
                const Combine& combine) {
    if constexpr (K == 1) {
        return rows[0][columns[0]];
    } else {
        Number sum(0);
        for (std::size_t k = 0; k < K; ++k) {
            std::array<std::size_t, K - 1> others{};
            for (std::size_t j = 0; j + 1 < K; ++j) {
                others[j] = columns[j < k ? j : j + 1];
            }
            const Number term = rows[K - 1][columns[k]] * expanded<K - 1, Number, N>(rows, others, combine);
            sum = combine(sum, term, (K - 1 + k) % 2 == 0);
        }
        return sum;
    }
}

template<std::size_t N>
constexpr std::array<std::size_t, N> all_columns() {
    std::array<std::size_t, N> columns{};
    for (std::size_t k = 0; k < N; ++k) {
        columns[k] = k;
    }
    return columns;
}

template<class Number, std::size_t N>
Number determinant(const Rows<Number, N>& rows) {
    return expanded<N, Number, N>(rows, all_columns<N>(),
                                  [](const Number& sum, const Number& term, bool plus) {
                                      return plus ? Number(sum + term) : Number(sum - term);
                                  });
}

/// The determinant with every sign taken as plus: the scale of its rounding errors.
template<std::size_t N>
double permanent(Rows<double, N> rows) {
    for (auto& row : rows) {
        for (double& entry : row) {
            entry = std::abs(entry);
        }
    }
    return expanded<N, double, N>(rows, all_columns<N>(),
                                  [](double sum, double term, bool) { return sum + term; });
}

template<class Number, int N>
Rows<Number, N> edges(const std::array<Point<N>, N + 1>& corners) {
    Rows<Number, N> rows;
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t k = 0; k < N; ++k) {
            rows[i][k] = Number(corners[i + 1][k]) - Number(corners[0][k]);
        }
    }
    return rows;
}

int sign_of(double value) {
    return (value > 0) - (value < 0);
}

} // namespace

template<int N>
int simplex_sign(const std::array<Point<N>, N + 1>& corners) {
    // A term is a product of N differences, rounded 2 N - 1 times, and takes part in N levels of sums of at
    // most N terms: less than N^2 + N roundings each, and twice as many allow for those of the bound itself.
    constexpr double roundings = 2 * (N * N + N);
    constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
    constexpr double underflow = std::numeric_limits<double>::min() * 1e6;
    const auto rows = edges<double, N>(corners);
    const double value = determinant(rows);
    const double error = roundings * unit_roundoff * permanent(rows);
    // If a product underflows early, its later factors may be large, so tiny bounds are not trusted. Neither
    // is NaN.
    if (error > underflow && std::abs(value) > error && std::isfinite(value)) {
        return sign_of(value);
    }
    return static_cast<int>(CGAL::sign(determinant(edges<CGAL::Exact_rational, N>(corners))));
}

template int simplex_sign<2>(const std::array<Point<2>, 3>&);
template int simplex_sign<3>(const std::array<Point<3>, 4>&);
template int simplex_sign<4>(const std::array<Point<4>, 5>&);

} // namespace slabhull
