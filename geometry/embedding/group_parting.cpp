// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/group_parting.h"

#include "geometry/embedding/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slabhull {

namespace {

/// Extent of points along a direction.
struct Span {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();
    std::size_t first = 0; ///< the point with the least value
    std::size_t last = 0;
};

template<int N>
class Parting {
public:
    Parting(const VertexCloud<N>& a, const VertexCloud<N>& b) : a_{a}, b_{b} {}

    bool found() {
        constexpr int most_steps = 60;
        Point<N> h;
        for (std::size_t k = 0; k < N; ++k) {
            h[k] = b_.mean[k] - a_.mean[k];
            reach_[k] = std::max(a_.reach[k], std::abs(h[k]) + b_.reach[k]);
        }
        if (in_range(h) && least_along(h, b_) - most_along(h, a_) > bound(h)) {
            return true;
        }
        h = discriminant();
        for (int step = 0; step < most_steps && in_range(h); ++step) {
            const Span of_a = along(h, a_);
            const Span of_b = along(h, b_);
            if (of_b.least - of_a.most > bound(h)) {
                return true;
            }
            reflect(h, a_.points[of_a.last], b_.points[of_b.first]);
        }
        return false;
    }

private:
    using Matrix = std::array<std::array<double, N>, N>;

    /// Adds the lower half of the covariance matrix.
    static void add_spread(const VertexCloud<N>& cloud, Matrix& m) {
        const double share = 1 / static_cast<double>(cloud.size);
        for (std::size_t p = 0; p < cloud.size; ++p) {
            for (std::size_t i = 0; i < N; ++i) {
                for (std::size_t j = 0; j <= i; ++j) {
                    m[i][j] +=
                        share * (cloud.points[p][i] - cloud.mean[i]) * (cloud.points[p][j] - cloud.mean[j]);
                }
            }
        }
    }

    /// (spread of a + spread of b)^-1 (mean of b - mean of a)
    Point<N> discriminant() const {
        Matrix m{};
        add_spread(a_, m);
        add_spread(b_, m);
        Point<N> h;
        double trace = 0;
        for (std::size_t i = 0; i < N; ++i) {
            trace += m[i][i];
            h[i] = b_.mean[i] - a_.mean[i];
        }
        for (std::size_t j = 0; j < N; ++j) { // Cholesky's method without square roots
            m[j][j] += 1e-3 * trace;          // clouds may be flat
            for (std::size_t i = j + 1; i < N; ++i) {
                const double factor = m[i][j] / m[j][j];
                for (std::size_t k = i; k < N; ++k) {
                    m[k][i] -= factor * m[k][j];
                }
                h[i] -= factor * h[j];
            }
            for (std::size_t i = j + 1; i < N; ++i) {
                m[i][j] /= m[j][j];
            }
        }
        for (std::size_t i = N; i-- > 0;) {
            h[i] /= m[i][i];
            for (std::size_t k = i + 1; k < N; ++k) {
                h[i] -= m[k][i] * h[k];
            }
        }
        return h;
    }

    bool in_range(const Point<N>& h) const {
        bool all = a_.in_range && b_.in_range;
        for (const double x : h) {
            all = all && std::abs(x) < 1e30;
        }
        return all;
    }

    double place_along(const Point<N>& h, const Point<N>& p) const {
        double x = 0;
        for (std::size_t k = 0; k < N; ++k) {
            x += h[k] * (p[k] - a_.mean[k]);
        }
        return x;
    }
    double least_along(const Point<N>& h, const VertexCloud<N>& cloud) const {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < cloud.size; ++i) {
            least = std::min(least, place_along(h, cloud.points[i]));
        }
        return least;
    }
    double most_along(const Point<N>& h, const VertexCloud<N>& cloud) const {
        double most = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < cloud.size; ++i) {
            most = std::max(most, place_along(h, cloud.points[i]));
        }
        return most;
    }

    Span along(const Point<N>& h, const VertexCloud<N>& cloud) const {
        Span span;
        for (std::size_t i = 0; i < cloud.size; ++i) {
            const double x = place_along(h, cloud.points[i]);
            if (x < span.least) {
                span.least = x;
                span.first = i;
            }
            if (x > span.most) {
                span.most = x;
                span.last = i;
            }
        }
        return span;
    }

    /// Each of the two sums compared has at most N + 2 roundings of terms no larger than bounded here, so 16
    /// unit roundoffs cover both, and the few of the bound. The tiny constant covers underflow when
    /// coordinates are scaled.
    double bound(const Point<N>& h) const {
        double terms = 0;
        for (std::size_t k = 0; k < N; ++k) {
            terms += std::abs(h[k]) * reach_[k];
        }
        return 16 * unit_roundoff * terms + 1e-290;
    }

    /// The relaxation method, see cell_separation.cpp, applied to the two worst points.
    static void reflect(Point<N>& h, const Point<N>& p, const Point<N>& q) {
        double along = 0;
        double square = 0;
        double length = 0;
        for (std::size_t k = 0; k < N; ++k) {
            along += h[k] * (q[k] - p[k]);
            square += (q[k] - p[k]) * (q[k] - p[k]);
            length += h[k] * h[k];
        }
        const double factor = (2 * std::abs(along) + 0.05 * std::sqrt(length * square)) / square;
        for (std::size_t k = 0; k < N; ++k) {
            h[k] += factor * (q[k] - p[k]);
        }
    }

    const VertexCloud<N>& a_;
    const VertexCloud<N>& b_;
    Point<N> reach_{}; ///< no point is farther from the mean of a, but for some roundings
};

} // namespace

template<int N>
void VertexCloud<N>::assign(std::span<const Index> vertices, const JoinedSpans<Point<N>>& all,
                            const Point<N>& scale) {
    size = vertices.size();
    mean = {};
    in_range = true;
    const double share = 1 / static_cast<double>(size);
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < N; ++k) {
            points[i][k] = all[vertices[i]][k] * scale[k];
            in_range = in_range && std::abs(points[i][k]) < 1e100;
            mean[k] += share * points[i][k];
        }
    }
    reach = {};
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < N; ++k) {
            reach[k] = std::max(reach[k], std::abs(points[i][k] - mean[k]));
        }
    }
}

template<int N>
bool proven_parted(const VertexCloud<N>& a, const VertexCloud<N>& b) {
    return Parting<N>{a, b}.found();
}

template struct VertexCloud<3>;
template struct VertexCloud<4>;
template bool proven_parted<3>(const VertexCloud<3>&, const VertexCloud<3>&);
template bool proven_parted<4>(const VertexCloud<4>&, const VertexCloud<4>&);

} // namespace slabhull
