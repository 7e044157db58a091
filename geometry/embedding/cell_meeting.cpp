// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/cell_meeting.h"

#include <CGAL/Exact_rational.h>

#include <array>
#include <cstddef>

namespace slabhull {

namespace {

using Rational = CGAL::Exact_rational;

/// Finds weights w >= 0 with A w = (0, .., 0, 1) by the first phase of the simplex method, in exact
/// arithmetic. Nearly all right sides are 0, so Bland's rule (Math. Oper. Res. 2, 1977) is needed to prevent
/// cycling.
template<std::size_t Rows, std::size_t Columns>
class FeasibilityProgram {
public:
    using Column = std::array<Rational, Rows>;
    using Weights = std::array<Rational, Columns>;

    explicit FeasibilityProgram(const std::array<Column, Columns>& a) {
        for (std::size_t i = 0; i < Rows; ++i) {
            for (std::size_t j = 0; j < Columns; ++j) {
                table_[i][j] = a[j][i];
                infeasibility_[j] += a[j][i];
            }
            basis_[i] = Columns + i; // an artificial variable, which has no column
        }
        table_[Rows - 1][Columns] = 1;
        infeasibility_[Columns] = 1;
    }

    std::optional<Weights> solve() {
        while (infeasibility_[Columns] != 0) {
            std::size_t enter = 0;
            while (enter < Columns && infeasibility_[enter] <= 0) {
                ++enter;
            }
            if (enter == Columns) {
                return {};
            }
            pivot(leaving(enter), enter);
        }
        Weights weights{};
        for (std::size_t i = 0; i < Rows; ++i) {
            if (basis_[i] < Columns) {
                weights[basis_[i]] = table_[i][Columns];
            }
        }
        return weights;
    }

private:
    using Row = std::array<Rational, Columns + 1>; ///< the last entry is the right side

    /// The row that limits the entering variable first. It exists, as the infeasibility is bounded below.
    std::size_t leaving(std::size_t enter) const {
        std::size_t best = Rows;
        Rational least;
        for (std::size_t i = 0; i < Rows; ++i) {
            if (table_[i][enter] <= 0) {
                continue;
            }
            const Rational ratio = table_[i][Columns] / table_[i][enter];
            if (best == Rows || ratio < least || (ratio == least && basis_[i] < basis_[best])) {
                best = i;
                least = ratio;
            }
        }
        return best;
    }

    void pivot(std::size_t row, std::size_t enter) {
        const Rational by = table_[row][enter];
        for (Rational& entry : table_[row]) {
            entry /= by;
        }
        for (std::size_t i = 0; i < Rows; ++i) {
            if (i != row) {
                subtract(table_[row], enter, table_[i]);
            }
        }
        subtract(table_[row], enter, infeasibility_);
        basis_[row] = enter;
    }

    static void subtract(const Row& pivot_row, std::size_t enter, Row& from) {
        const Rational factor = from[enter];
        if (factor == 0) {
            return;
        }
        for (std::size_t j = 0; j <= Columns; ++j) {
            if (pivot_row[j] != 0) {
                from[j] -= factor * pivot_row[j];
            }
        }
    }

    std::array<Row, Rows> table_;
    Row infeasibility_; ///< sum of the rows whose artificial variable is in the basis
    std::array<std::size_t, Rows> basis_;
};

/// A vertex in homogeneous coordinates, and whether it is outside the shared face.
template<int N>
std::array<Rational, N + 2> column_of(const Point<N>& p, int sign, bool off) {
    std::array<Rational, N + 2> column;
    for (std::size_t k = 0; k < N; ++k) {
        column[k] = Rational{p[k]} * sign;
    }
    column[N] = sign;
    column[N + 1] = off ? 1 : 0;
    return column;
}

} // namespace

template<int N>
std::optional<Point<N>> common_point(const FacetPair<N>& pair) {
    std::array<std::array<Rational, N + 2>, std::size_t{2} * N> columns;
    for (std::size_t i = 0; i < N; ++i) {
        columns[i] = column_of<N>(pair.f[i], 1, i >= pair.shared);
        columns[N + i] = column_of<N>(pair.g[i], -1, i >= pair.shared);
    }
    const auto weights = FeasibilityProgram<N + 2, std::size_t{2} * N>{columns}.solve();
    if (!weights) {
        return {};
    }
    std::array<Rational, N> sum{};
    Rational total = 0;
    for (std::size_t i = 0; i < N; ++i) {
        total += (*weights)[i];
        for (std::size_t k = 0; k < N; ++k) {
            sum[k] += (*weights)[i] * Rational{pair.f[i][k]};
        }
    }
    Point<N> point;
    for (std::size_t k = 0; k < N; ++k) {
        point[k] = CGAL::to_double(Rational{sum[k] / total});
    }
    return point;
}

template std::optional<Point<4>> common_point<4>(const FacetPair<4>&);

} // namespace slabhull
