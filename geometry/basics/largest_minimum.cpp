// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/basics/largest_minimum.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace slabhull {

namespace {

template<std::size_t M>
using SquareMatrix = std::array<std::array<double, M>, M>;

/// Solves matrix x = right by elimination with pivoting; false if the matrix is singular.
template<std::size_t M>
bool solve(SquareMatrix<M> matrix, std::array<double, M>& right) {
    for (std::size_t k = 0; k < M; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < M; ++i) {
            pivot = std::abs(matrix[i][k]) > std::abs(matrix[pivot][k]) ? i : pivot;
        }
        if (!(std::abs(matrix[pivot][k]) > 0)) {
            return false;
        }
        std::swap(matrix[k], matrix[pivot]);
        std::swap(right[k], right[pivot]);
        for (std::size_t i = k + 1; i < M; ++i) {
            const double factor = matrix[i][k] / matrix[k][k];
            for (std::size_t j = k; j < M; ++j) {
                matrix[i][j] -= factor * matrix[k][j];
            }
            right[i] -= factor * right[k];
        }
    }
    for (std::size_t k = M; k-- > 0;) {
        for (std::size_t j = k + 1; j < M; ++j) {
            right[k] -= matrix[k][j] * right[j];
        }
        right[k] /= matrix[k][k];
    }
    return true;
}

/// The active set: N + 1 functions that are equal at the current point. A convex combination of their
/// gradients is zero; its weights are kept.
template<int N>
class Reference {
public:
    /// Starts from artificial functions that do not affect the minimum near the origin.
    Reference() {
        constexpr double reach = 100;
        constexpr double height = 1000;
        for (std::size_t i = 0; i <= N; ++i) {
            functions_[i].value = height;
            functions_[i].gradient = {};
            for (std::size_t k = 0; k < N; ++k) {
                const double slope = i == N ? -1 : i == k ? 1 : 0; // slopes sum to zero
                functions_[i].gradient[k] = slope * height / (reach * N);
            }
        }
        weights_.fill(1.0 / (N + 1));
        place();
    }

    const Point<N>& point() const { return point_; }
    double minimum() const { return minimum_; }

    /// Takes in a function that is below the minimum and drops another; false at the limits of precision.
    bool exchange(const AffineFunction<N>& next) {
        SquareMatrix<N + 1> matrix;
        std::array<double, N + 1> share;
        for (std::size_t k = 0; k <= N; ++k) {
            for (std::size_t i = 0; i <= N; ++i) {
                matrix[k][i] = k < N ? functions_[i].gradient[k] : 1;
            }
            share[k] = k < N ? next.gradient[k] : 1;
        }
        if (!solve<N + 1>(matrix, share)) {
            return false;
        }
        std::size_t out = N + 1;
        double step = 0;
        for (std::size_t i = 0; i <= N; ++i) {
            if (share[i] > 1e-12 && (out > N || weights_[i] < step * share[i])) {
                out = i;
                step = weights_[i] / share[i];
            }
        }
        if (out > N) {
            return false;
        }
        for (std::size_t i = 0; i <= N; ++i) {
            weights_[i] -= step * share[i];
        }
        weights_[out] = step;
        functions_[out] = next;
        return place();
    }

private:
    bool place() {
        SquareMatrix<N + 1> matrix;
        std::array<double, N + 1> right;
        for (std::size_t i = 0; i <= N; ++i) {
            for (std::size_t k = 0; k < N; ++k) {
                matrix[i][k] = functions_[i].gradient[k];
            }
            matrix[i][N] = -1;
            right[i] = -functions_[i].value;
        }
        if (!solve<N + 1>(matrix, right)) {
            return false;
        }
        for (std::size_t k = 0; k < N; ++k) {
            point_[k] = right[k];
        }
        minimum_ = right[N];
        return true;
    }

    std::array<AffineFunction<N>, N + 1> functions_;
    std::array<double, N + 1> weights_;
    Point<N> point_{};
    double minimum_ = 0;
};

} // namespace

template<int N>
Point<N> largest_minimum(std::span<const AffineFunction<N>> functions) {
    constexpr int most_exchanges = 200;
    constexpr double precision = 1e-10;
    Reference<N> reference;
    for (int k = 0; k < most_exchanges; ++k) {
        const AffineFunction<N>* lowest = nullptr;
        double least = reference.minimum() - precision * (1 + std::abs(reference.minimum()));
        for (const AffineFunction<N>& function : functions) {
            const double value = function.at(reference.point());
            if (value < least) {
                least = value;
                lowest = &function;
            }
        }
        if (lowest == nullptr || !reference.exchange(*lowest)) {
            break;
        }
    }
    return reference.point();
}

template Point<2> largest_minimum<2>(std::span<const AffineFunction<2>>);
template Point<3> largest_minimum<3>(std::span<const AffineFunction<3>>);
template Point<4> largest_minimum<4>(std::span<const AffineFunction<4>>);

} // namespace slabhull
