// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/measures.h"

#include "core/pieces.h"

#include "slabhull/core/parallel.h"

#include "geometry/basics/vector_algebra.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace slabhull {

namespace {

constexpr std::size_t cells_per_piece = 1 << 15;

using detail::CosineRange;

/// The cross product of R^4: det[a, b, c, result] > 0. Its components share the 2 x 2 minors of a and b.
Point<4> cross(const Point<4>& a, const Point<4>& b, const Point<4>& c) {
    const auto minor = [&](std::size_t i, std::size_t j) { return a[i] * b[j] - a[j] * b[i]; };
    const double xy = minor(0, 1), xz = minor(0, 2), xt = minor(0, 3);
    const double yz = minor(1, 2), yt = minor(1, 3), zt = minor(2, 3);
    return {-(yz * c[3] - yt * c[2] + zt * c[1]), xz * c[3] - xt * c[2] + zt * c[0],
            -(xy * c[3] - xt * c[1] + yt * c[0]), xy * c[2] - xz * c[1] + yz * c[0]};
}

/// The angle in degrees, from s = cos |cos|.
double degrees(double s) {
    const double cosine = std::copysign(std::sqrt(std::min(1.0, std::abs(s))), s);
    return std::acos(cosine) * (180 / std::numbers::pi);
}

/// Gram matrix of the gradients of the barycentric coordinates, up to a positive factor: the adjugate of the
/// Gram matrix of the edges from corner 0, extended by a row that makes all rows sum to zero.
template<int D>
using GradientGram = std::array<std::array<double, D + 1>, D + 1>;

template<int D, std::size_t N>
GradientGram<D> gradient_gram_of_edges(const std::array<std::array<double, N>, D + 1>& corners) {
    GradientGram<D> a{};
    const auto u = minus(corners[1], corners[0]);
    const auto v = minus(corners[2], corners[0]);
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
    if constexpr (D == 2) {
        a[1] = {0, vv, -uv};
        a[2] = {0, -uv, uu};
    } else {
        const auto w = minus(corners[3], corners[0]);
        const double uw = dot(u, w), vw = dot(v, w), ww = dot(w, w);
        const double a12 = uw * vw - uv * ww, a13 = uv * vw - uw * vv, a23 = uv * uw - uu * vw;
        a[1] = {0, vv * ww - vw * vw, a12, a13};
        a[2] = {0, a12, uu * ww - uw * uw, a23};
        a[3] = {0, a13, a23, uu * vv - uv * uv};
    }
    for (std::size_t i = 1; i <= D; ++i) {
        for (std::size_t j = 1; j <= D; ++j) {
            a[0][i] -= a[j][i];
        }
        a[i][0] = a[0][i];
        a[0][0] -= a[0][i];
    }
    return a;
}

template<int D, std::size_t N>
GradientGram<D> gradient_gram(const std::array<std::array<double, N>, D + 1>& corners) {
    GradientGram<D> a{};
    if constexpr (D == 4) {
        std::array<Point<4>, 5> normals;
        for (std::size_t i = 0; i <= D; ++i) {
            const Facet<4> facet = outward_facet<4>({0, 1, 2, 3, 4}, static_cast<int>(i));
            normals[i] = simplex_normal<3>(corners_of<3, 4>(facet, corners));
            for (std::size_t j = 0; j <= i; ++j) {
                a[i][j] = a[j][i] = dot(normals[i], normals[j]);
            }
        }
        return a;
    } else {
        return gradient_gram_of_edges<D>(corners);
    }
}

/// Calls use() with cos |cos| of the dihedral angle between each two facets, from the gradients, which are
/// the inward normals; rounding may take it slightly beyond 1 or -1. False if a facet has measure zero,
/// perhaps after some angles.
template<int D, std::size_t N, class Use>
bool for_each_cosine(const std::array<std::array<double, N>, D + 1>& corners, const Use& use) {
    const GradientGram<D> a = gradient_gram<D>(corners);
    for (std::size_t i = 0; i <= D; ++i) {
        for (std::size_t j = i + 1; j <= D; ++j) {
            const double square = a[i][i] * a[j][j];
            if (!(square > 0)) {
                return false;
            }
            use(-a[i][j] * std::abs(a[i][j]) / square);
        }
    }
    return true;
}

template<int D, std::size_t N>
CosineRange cosines(const std::array<std::array<double, N>, D + 1>& corners) {
    CosineRange range;
    return for_each_cosine<D>(corners, [&range](double s) { range.add(s); }) ? range : CosineRange{-1, 1};
}

/// Sums `add(c, sums)` over cells in fixed pieces, then the pieces in order.
template<class Sums, class Add>
Sums sum_by_pieces(std::size_t count, const Sums& zero, const Add& add) {
    const auto sum_of = [&](std::size_t begin, std::size_t end, Sums& piece) {
        Sums sums = zero;
        for (std::size_t c = begin; c < end; ++c) {
            add(c, sums);
        }
        piece = sums;
    };
    Sums total = zero;
    for (const Sums& piece : parallel_pieces<Sums>(count, cells_per_piece, sum_of, zero)) {
        for (std::size_t g = 0; g < total.size(); ++g) {
            total[g].add(piece[g]);
        }
    }
    return total;
}

class AngleCounts {
public:
    template<int D, std::size_t N>
    void add(const std::array<std::array<double, N>, D + 1>& corners) {
        AngleHistogram counts{};
        if (for_each_cosine<D>(corners, [&counts](double s) { ++counts[bin(s)]; })) {
            add(AngleCounts{counts});
        }
    }
    void add(const AngleCounts& other) {
        for (std::size_t k = 0; k < counts_.size(); ++k) {
            counts_[k] += other.counts_[k];
        }
    }
    AngleCounts() = default;
    const AngleHistogram& value() const { return counts_; }

private:
    explicit AngleCounts(const AngleHistogram& counts) : counts_{counts} {}
    /// cos |cos| at the limits between bins, so that angles need not be computed. Limits are raised slightly:
    /// angles of 60 and 90 degrees are frequent, and rounding must not spread them over two bins.
    static std::array<double, angle_bins - 1> make_edges() {
        std::array<double, angle_bins - 1> edges;
        for (std::size_t k = 1; k < angle_bins; ++k) {
            const double cosine = std::cos(static_cast<double>(k) * std::numbers::pi / angle_bins);
            edges[k - 1] = cosine * std::abs(cosine) + 1e-14;
        }
        return edges;
    }
    static std::size_t bin(double s) {
        std::size_t below = 0;
        for (const double edge : edges_) {
            below += s <= edge ? 1 : 0;
        }
        return below;
    }

    static inline const std::array<double, angle_bins - 1> edges_ = make_edges();
    AngleHistogram counts_{};
};

class AspectSums {
public:
    void add(double ratio) {
        sum_.add(ratio);
        largest_ = std::max(largest_, ratio);
    }
    void add(const AspectSums& other) {
        sum_.add(other.sum_);
        largest_ = std::max(largest_, other.largest_);
    }
    AspectRatios over(std::size_t count) const {
        return {count == 0 ? 0 : sum_.value() / static_cast<double>(count), largest_};
    }

private:
    detail::CompensatedSum sum_;
    double largest_ = 0;
};

class SolidSums {
public:
    void add(double measure, const CosineRange& range) {
        measure_.add(measure);
        smallest_ = std::min(smallest_, measure);
        cosines_.add(range);
    }
    void add(const SolidSums& other) {
        measure_.add(other.measure_);
        smallest_ = std::min(smallest_, other.smallest_);
        cosines_.add(other.cosines_);
    }
    SolidMeasures value() const { return {measure_.value(), smallest_, cosines_.angles()}; }

private:
    detail::CompensatedSum measure_;
    double smallest_ = std::numeric_limits<double>::infinity();
    CosineRange cosines_;
};

} // namespace

AngleRange detail::CosineRange::angles() const {
    return {degrees(largest), degrees(smallest)};
}

template<int D>
Point<D + 1> MeasureSums<D>::add(const std::array<Point<D + 1>, D + 1>& corners, const Point<D + 1>& origin) {
    const Point<D + 1> normal = simplex_normal<D>(corners);
    measure_.add(norm(normal));
    enclosed_.add(dot(minus(corners[0], origin), normal)); // x.N is constant on the simplex
    for (std::size_t k = 0; k <= D; ++k) {
        closure_[k].add(normal[k]);
    }
    cosines_.add(cosines<D>(corners));
    ++cells_;
    return normal;
}

template<int D>
void MeasureSums<D>::add(const MeasureSums& other) {
    measure_.add(other.measure_);
    enclosed_.add(other.enclosed_);
    for (std::size_t k = 0; k <= D; ++k) {
        closure_[k].add(other.closure_[k]);
    }
    cosines_.add(other.cosines_);
    cells_ += other.cells_;
}

template<int D>
Measures<D> MeasureSums<D>::value() const {
    Measures<D> result{measure_.value(), {}, enclosed_.value() / (D + 1), cosines_.angles(), cells_};
    for (std::size_t k = 0; k <= D; ++k) {
        result.closure[k] = closure_[k].value();
    }
    return result;
}

template<int D>
Point<D + 1> simplex_normal(const std::array<Point<D + 1>, D + 1>& corners) {
    const auto u = minus(corners[1], corners[0]);
    if constexpr (D == 1) {
        return {-u[1], u[0]};
    } else {
        const auto v = minus(corners[2], corners[0]);
        if constexpr (D == 2) {
            return times(1.0 / 2, cross(u, v));
        } else {
            return times(1.0 / 6, cross(u, v, minus(corners[3], corners[0])));
        }
    }
}

template<int D>
double signed_measure(const std::array<Point<D>, D + 1>& corners) {
    const auto u = minus(corners[1], corners[0]);
    if constexpr (D == 1) {
        return u[0];
    } else {
        const auto v = minus(corners[2], corners[0]);
        if constexpr (D == 2) {
            return (u[0] * v[1] - u[1] * v[0]) / 2;
        } else if constexpr (D == 3) {
            return dot(cross(u, v), minus(corners[3], corners[0])) / 6;
        } else {
            const auto base = simplex_normal<3>({corners[0], corners[1], corners[2], corners[3]});
            return dot(base, minus(corners[4], corners[0])) / 4;
        }
    }
}

template<int D, int N>
AngleRange dihedral_angles(const std::array<Point<N>, D + 1>& corners) {
    return cosines<D>(corners).angles();
}

template<int D>
Measures<D> measure_cells(std::span<const Point<D + 1>> points, std::span<const Simplex<D>> cells) {
    const Point<D + 1> origin = points.empty() ? Point<D + 1>{} : points.front();
    return sum_by_pieces(cells.size(), std::array<MeasureSums<D>, 1>{},
                         [&](std::size_t c, std::array<MeasureSums<D>, 1>& to) {
                             to[0].add(corners_of<D, D + 1>(cells[c], points), origin);
                         })[0]
        .value();
}

template<int D>
SolidMeasures measure_solid(std::span<const Point<D>> points, std::span<const Simplex<D>> cells) {
    return sum_by_pieces(cells.size(), std::array<SolidSums, 1>{},
                         [&](std::size_t c, std::array<SolidSums, 1>& to) {
                             const auto corners = corners_of<D, D>(cells[c], points);
                             to[0].add(signed_measure<D>(corners), cosines<D>(corners));
                         })[0]
        .value();
}

template<int D, int N>
AngleHistogram angle_histogram(std::span<const Point<N>> points, std::span<const Simplex<D>> cells) {
    return sum_by_pieces(cells.size(), std::array<AngleCounts, 1>{},
                         [&](std::size_t c, std::array<AngleCounts, 1>& to) {
                             to[0].add<D>(corners_of<D, N>(cells[c], points));
                         })[0]
        .value();
}

template<int D, int N>
double aspect_ratio(const std::array<Point<N>, D + 1>& corners) {
    double longest = 0;
    for (std::size_t i = 0; i <= D; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const auto edge = minus(corners[i], corners[j]);
            longest = std::max(longest, dot(edge, edge));
        }
    }
    // Heights are 1 / |gradient| of the barycentric coordinates, the inradius is 1 / (sum of the
    // |gradients|).
    const GradientGram<D> gram = gradient_gram<D>(corners);
    const auto first = minus(corners[1], corners[0]);
    double determinant = 0; // of the edges' Gram matrix, expanded by its first row
    for (std::size_t j = 1; j <= D; ++j) {
        determinant += dot(first, minus(corners[j], corners[0])) * gram[1][j];
    }
    if (!(determinant > 0)) {
        return std::numeric_limits<double>::infinity();
    }
    double inverse_radius = 0;
    for (std::size_t i = 0; i <= D; ++i) {
        inverse_radius += std::sqrt(std::max(0.0, gram[i][i]) / determinant);
    }
    return std::sqrt(longest) * inverse_radius / std::sqrt(2.0 * D * (D + 1));
}

template<int D, int N>
AspectRatios aspect_ratios(std::span<const Point<N>> points, std::span<const Simplex<D>> cells) {
    return sum_by_pieces(cells.size(), std::array<AspectSums, 1>{},
                         [&](std::size_t c, std::array<AspectSums, 1>& to) {
                             to[0].add(aspect_ratio<D, N>(corners_of<D, N>(cells[c], points)));
                         })[0]
        .over(cells.size());
}

template<int D>
double enclosed_by(const Surface<D>& surface, std::span<const Index> facets) {
    const Point<D>& origin = surface.points[surface.facets[facets.front()][0]];
    double sum = 0;
    for (const Index f : facets) {
        std::array<Point<D>, D + 1> corners;
        corners[D] = origin;
        for (std::size_t i = 0; i < D; ++i) {
            corners[i] = surface.points[surface.facets[f][i]];
        }
        sum -= signed_measure<D>(corners); // a facet and a point on its inner side form a negative simplex
    }
    return sum;
}

template double aspect_ratio<2, 3>(const std::array<Point<3>, 3>&);
template double aspect_ratio<3, 4>(const std::array<Point<4>, 4>&);
template AspectRatios aspect_ratios<2, 3>(std::span<const Point<3>>, std::span<const Simplex<2>>);
template AspectRatios aspect_ratios<3, 4>(std::span<const Point<4>>, std::span<const Simplex<3>>);
template Point<2> simplex_normal<1>(const std::array<Point<2>, 2>&);
template Point<3> simplex_normal<2>(const std::array<Point<3>, 3>&);
template Point<4> simplex_normal<3>(const std::array<Point<4>, 4>&);
template double signed_measure<1>(const std::array<Point<1>, 2>&);
template double signed_measure<2>(const std::array<Point<2>, 3>&);
template double signed_measure<3>(const std::array<Point<3>, 4>&);
template double signed_measure<4>(const std::array<Point<4>, 5>&);
template AngleRange dihedral_angles<2, 2>(const std::array<Point<2>, 3>&);
template AngleRange dihedral_angles<2, 3>(const std::array<Point<3>, 3>&);
template AngleRange dihedral_angles<3, 3>(const std::array<Point<3>, 4>&);
template AngleRange dihedral_angles<3, 4>(const std::array<Point<4>, 4>&);
template AngleRange dihedral_angles<4, 4>(const std::array<Point<4>, 5>&);
template AngleHistogram angle_histogram<2, 3>(std::span<const Point<3>>, std::span<const Simplex<2>>);
template AngleHistogram angle_histogram<3, 3>(std::span<const Point<3>>, std::span<const Simplex<3>>);
template AngleHistogram angle_histogram<3, 4>(std::span<const Point<4>>, std::span<const Simplex<3>>);
template Measures<2> measure_cells<2>(std::span<const Point<3>>, std::span<const Simplex<2>>);
template Measures<3> measure_cells<3>(std::span<const Point<4>>, std::span<const Simplex<3>>);
template class MeasureSums<2>;
template class MeasureSums<3>;
template SolidMeasures measure_solid<2>(std::span<const Point<2>>, std::span<const Simplex<2>>);
template SolidMeasures measure_solid<3>(std::span<const Point<3>>, std::span<const Simplex<3>>);
template double enclosed_by<2>(const Surface<2>&, std::span<const Index>);
template double enclosed_by<3>(const Surface<3>&, std::span<const Index>);

} // namespace slabhull
