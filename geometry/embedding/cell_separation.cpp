// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/cell_separation.h"

#include "geometry/embedding/rounding.h"
#include "slabhull/core/vector.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace slabhull {

namespace {

/// Above the error of any operation here whose result underflows.
constexpr double underflow = std::numeric_limits<double>::min();

/// A computed value and a bound on its error. The bounds are rounded themselves, by less than a part in 10^13
/// over a whole computation: add one per cent before relying on them.
struct Bounded {
    double value = 0;
    double error = 0;
};

Bounded difference(double a, double b) {
    return {a - b, unit_roundoff * std::abs(a - b)};
}

Bounded operator-(const Bounded& a, const Bounded& b) {
    const double value = a.value - b.value;
    return {value, a.error + b.error + unit_roundoff * std::abs(value)};
}

Bounded operator*(const Bounded& a, const Bounded& b) {
    const double value = a.value * b.value;
    return {value, std::abs(a.value) * b.error + a.error * (std::abs(b.value) + b.error) +
                       unit_roundoff * std::abs(value) + underflow};
}

/// If b may be zero, the error is infinite or NaN, which proves nothing.
Bounded operator/(const Bounded& a, const Bounded& b) {
    const double value = a.value / b.value;
    const double least = std::max(0.0, std::abs(b.value) - 1.01 * b.error);
    return {value,
            (a.error + std::abs(value) * b.error) / least + unit_roundoff * std::abs(value) + underflow};
}

/// Two simplices of R^N that share K vertices, modulo the span of these: a linear map takes the span to 0 and
/// hyperplanes that contain the shared vertices to hyperplanes through the origin of the quotient. The
/// columns are the images of the other vertices, with opposite sign for the second simplex, so a functional
/// that is positive on every column is a separating hyperplane.
template<int N, std::size_t K>
class Columns {
public:
    static constexpr std::size_t each = N - K;
    static constexpr std::size_t count = 2 * each;
    static constexpr std::size_t width = each + 1;
    using Functional = std::array<double, width>;

    Columns(const FacetPair<N>& pair, const Point<N>& scale) {
        const Point<N> origin = K > 0 ? pair.f[0] : centre(pair);
        for (std::size_t i = 0; i < each; ++i) {
            place(i, pair.f[K + i], origin, scale);
            place(each + i, pair.g[K + i], origin, scale);
        }
        if constexpr (K == 0) {
            add_constants();
        } else {
            eliminate_shared(pair, scale);
        }
        for (std::size_t i = each; i < count; ++i) {
            for (Bounded& entry : entry_[i]) {
                entry.value = -entry.value;
            }
        }
    }

    /// Columns of unit length, for the search.
    std::array<Functional, count> directions() const {
        std::array<Functional, count> unit;
        for (std::size_t i = 0; i < count; ++i) {
            double square = 0;
            for (std::size_t k = 0; k < width; ++k) {
                square += entry_[i][k].value * entry_[i][k].value;
            }
            const double factor = 1 / std::sqrt(square);
            for (std::size_t k = 0; k < width; ++k) {
                unit[i][k] = factor * entry_[i][k].value;
            }
        }
        return unit;
    }

    /// Whether the functional is positive on every column, rounding errors included.
    bool proven_positive(const Functional& h) const {
        for (std::size_t i = 0; i < count; ++i) {
            double value = 0;
            double rounding = 0;
            for (std::size_t k = 0; k < width; ++k) {
                const double term = h[k] * entry_[i][k].value;
                value += term;
                rounding +=
                    width * unit_roundoff * std::abs(term) + std::abs(h[k]) * entry_[i][k].error + underflow;
            }
            if (!(value > 1.01 * rounding)) { // NaN proves nothing either
                return false;
            }
        }
        return true;
    }

private:
    /// Elimination of one coordinate by a shared vertex.
    struct Step {
        std::size_t pivot = 0;
        std::array<Bounded, N> ratio; ///< of the vertex's coordinates to the pivot's
    };
    static constexpr std::size_t stored = std::max<std::size_t>(N, width);

    static Point<N> centre(const FacetPair<N>& pair) {
        Point<N> sum{};
        for (std::size_t i = 0; i < N; ++i) {
            for (std::size_t k = 0; k < N; ++k) {
                sum[k] += (pair.f[i][k] + pair.g[i][k]) / (2 * N);
            }
        }
        return sum;
    }

    static std::array<Bounded, N> shifted(const Point<N>& p, const Point<N>& origin, const Point<N>& scale) {
        std::array<Bounded, N> v;
        for (std::size_t k = 0; k < N; ++k) {
            v[k] = difference(p[k], origin[k]);
            v[k].value *= scale[k]; // exact: a power of two
            v[k].error = v[k].error * scale[k] + underflow;
        }
        return v;
    }

    void place(std::size_t i, const Point<N>& p, const Point<N>& origin, const Point<N>& scale) {
        const std::array<Bounded, N> v = shifted(p, origin, scale);
        std::copy(v.begin(), v.end(), entry_[i].begin());
    }

    /// Adds the constant term of an affine functional, scaled to the size of the pair so that no coordinate
    /// dominates.
    void add_constants() {
        double largest = 0;
        for (const auto& column : entry_) {
            for (std::size_t k = 0; k < N; ++k) {
                largest = std::max(largest, std::abs(column[k].value));
            }
        }
        for (auto& column : entry_) {
            column[width - 1] = {largest, 0};
        }
    }

    /// The first shared vertex is the origin; each other one eliminates a coordinate.
    void eliminate_shared(const FacetPair<N>& pair, const Point<N>& scale) {
        for (std::size_t s = 1; s < K; ++s) {
            std::array<Bounded, N> shared = shifted(pair.f[s], pair.f[0], scale);
            for (std::size_t done = 0; done + 1 < s; ++done) {
                eliminate_by(steps_[done], shared, N - done);
            }
            add_step(shared, s - 1);
        }
    }

    template<std::size_t M>
    static void eliminate_by(const Step& step, std::array<Bounded, M>& v, std::size_t active) {
        const Bounded at_pivot = v[step.pivot];
        std::swap(v[step.pivot], v[active - 1]);
        for (std::size_t k = 0; k + 1 < active; ++k) {
            v[k] = v[k] - at_pivot * step.ratio[k];
        }
    }

    void add_step(std::array<Bounded, N> shared, std::size_t done) {
        const std::size_t active = N - done;
        Step& step = steps_[done];
        for (std::size_t k = 1; k < active; ++k) {
            if (std::abs(shared[k].value) > std::abs(shared[step.pivot].value)) {
                step.pivot = k;
            }
        }
        const Bounded by = shared[step.pivot];
        std::swap(shared[step.pivot], shared[active - 1]);
        for (std::size_t k = 0; k + 1 < active; ++k) {
            step.ratio[k] = shared[k] / by;
        }
        for (auto& column : entry_) {
            eliminate_by(step, column, active);
        }
    }

    std::array<std::array<Bounded, stored>, count> entry_;
    std::array<Step, N> steps_; ///< K - 1 of them
};

/// Solves rows x = (1, .., 1) by elimination. For singular rows the result is meaningless, but harmless.
template<std::size_t W>
std::array<double, W> solve_for_ones(std::array<std::array<double, W + 1>, W> rows) {
    for (std::size_t j = 0; j < W; ++j) {
        std::size_t pivot = j;
        for (std::size_t i = j + 1; i < W; ++i) {
            pivot = std::abs(rows[i][j]) > std::abs(rows[pivot][j]) ? i : pivot;
        }
        std::swap(rows[j], rows[pivot]);
        for (std::size_t i = 0; i < W; ++i) {
            const double factor = i == j ? 0 : rows[i][j] / rows[j][j];
            for (std::size_t k = j; k <= W; ++k) {
                rows[i][k] -= factor * rows[j][k];
            }
        }
    }
    std::array<double, W> x;
    for (std::size_t j = 0; j < W; ++j) {
        x[j] = rows[j][W] / rows[j][j];
    }
    return x;
}

/// The functionals that are 1 or more on every column form a polyhedron. If the columns span the space, it
/// has a vertex, where as many columns as there are dimensions have the value 1. There are at most 56
/// candidates, so thin gaps cost no more than wide ones; the relaxation method takes more steps the thinner
/// the gap.
template<class C>
bool separable_at_vertex(const C& columns, const std::array<typename C::Functional, C::count>& unit) {
    for (unsigned chosen = 0; chosen < 1u << C::count; ++chosen) {
        if (std::popcount(chosen) != static_cast<int>(C::width)) {
            continue;
        }
        std::array<std::array<double, C::width + 1>, C::width> rows;
        std::size_t row = 0;
        for (std::size_t i = 0; i < C::count; ++i) {
            if ((chosen >> i & 1u) != 0) {
                std::copy(unit[i].begin(), unit[i].end(), rows[row].begin());
                rows[row++][C::width] = 1;
            }
        }
        if (columns.proven_positive(solve_for_ones<C::width>(rows))) {
            return true;
        }
    }
    return false;
}

/// Looks for a functional that is positive on every column by the relaxation method (Motzkin and Schoenberg,
/// Canad. J. Math. 6, 1954): reflect it at the column where it is most negative, until none is.
template<int N, std::size_t K>
bool separable(const FacetPair<N>& pair, const Point<N>& scale) {
    using C = Columns<N, K>;
    constexpr int most_steps = 50;
    const C columns{pair, scale};
    const auto unit = columns.directions();
    typename C::Functional h{};
    for (const auto& column : unit) {
        for (std::size_t k = 0; k < C::width; ++k) {
            h[k] += column[k];
        }
    }
    for (int step = 0; step < most_steps; ++step) {
        std::size_t worst = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < C::count; ++i) {
            const double along = dot(h, unit[i]);
            if (along < least) {
                least = along;
                worst = i;
            }
        }
        if (least > 0 && columns.proven_positive(h)) {
            return true;
        }
        for (std::size_t k = 0; k < C::width; ++k) {
            h[k] += 2 * std::abs(least) * unit[worst][k];
        }
    }
    return separable_at_vertex(columns, unit);
}

} // namespace

bool proven_apart(const FacetPair<4>& pair, const Point<4>& scale) {
    switch (pair.shared) {
    case 0:
        return separable<4, 0>(pair, scale);
    case 1:
        return separable<4, 1>(pair, scale);
    case 2:
        return separable<4, 2>(pair, scale);
    case 3:
        return separable<4, 3>(pair, scale);
    default:
        return false;
    }
}

} // namespace slabhull
