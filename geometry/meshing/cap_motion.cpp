// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/cap_motion.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/geometry/affine.h"
#include "slabhull/geometry/measures.h"

#include "geometry/basics/vector_algebra.h"
#include "geometry/meshing/conjugate_gradients.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <vector>

namespace slabhull {

namespace {

using detail::Lanes;
using detail::Stiffness;

constexpr std::size_t vertices_per_piece = 1 << 14;

/// Displacements of vertices.
template<int D>
struct Displacements {
    std::span<const Index> vertices;
    std::vector<Point<D>> vectors; ///< of each

    double largest() const {
        double result = 0;
        for (const Point<D>& vector : vectors) {
            result = std::max(result, norm(vector));
        }
        return result;
    }
};

template<int D>
Displacements<D> displacements(std::span<const Point<D>> points, std::span<const Index> vertices,
                               std::span<const Point<D>> targets) {
    Displacements<D> result{vertices, {}};
    result.vectors.reserve(vertices.size());
    for (std::size_t b = 0; b < vertices.size(); ++b) {
        result.vectors.push_back(minus(targets[b], points[vertices[b]]));
    }
    return result;
}

/// The affine displacement x -> A x + b that is the least-squares fit to the given ones.
template<int D>
AffineMap<D> nearest_affine(std::span<const Point<D>> points, const Displacements<D>& given) {
    using Row = Eigen::Matrix<double, D + 1, 1>;
    const Point<D> origin = points[given.vertices.front()]; // near the others: less cancellation
    Eigen::Matrix<double, D + 1, D + 1> left = Eigen::Matrix<double, D + 1, D + 1>::Zero();
    Eigen::Matrix<double, D + 1, D> right = Eigen::Matrix<double, D + 1, D>::Zero();
    for (std::size_t b = 0; b < given.vertices.size(); ++b) {
        const Point<D> place = minus(points[given.vertices[b]], origin);
        Row row = Row::Ones();
        row.template head<D>() = Eigen::Map<const Eigen::Matrix<double, D, 1>>(place.data());
        left += row * row.transpose();
        right += row * Eigen::Map<const Eigen::Matrix<double, 1, D>>(given.vectors[b].data());
    }
    const Eigen::Matrix<double, D + 1, D> fit = left.fullPivLu().solve(right);
    AffineMap<D> map;
    for (std::size_t i = 0; i < D; ++i) {
        const auto column = fit.col(static_cast<Eigen::Index>(i));
        std::copy_n(column.data(), D, map.rows[i].begin());
        map.shift[i] = column[D];
    }
    map.shift = minus(map.shift, map.linear(origin));
    return map;
}

/// Moves one cap.
template<int D>
class CapMover {
public:
    CapMover(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
             const Displacements<D>& boundary)
        : points_{points}, cells_{cells}, boundary_{boundary}, affine_{nearest_affine<D>(points, boundary)},
          unit_{std::max(boundary.largest(), std::numeric_limits<double>::min())},
          rest_(points.size(), Lanes::Zero()) {}

    /// Returns the number of iterations.
    int solve(const CapMotionOptions& options) {
        std::vector<std::uint8_t> fixed(points_.size(), 0);
        bool moves = false;
        for (std::size_t b = 0; b < boundary_.vertices.size(); ++b) {
            const Index v = boundary_.vertices[b];
            fixed[v] = 1;
            const Point<D> rest = minus(boundary_.vectors[b], affine_(points_[v]));
            for (std::size_t k = 0; k < D; ++k) {
                rest_[v][static_cast<Eigen::Index>(k)] = static_cast<float>(rest[k] / unit_);
            }
            moves = moves || norm(rest) > smallest_rest * unit_;
        }
        if (!moves) {
            return 0;
        }
        const Stiffness matrix = detail::assemble_stiffness<D>(points_, cells_, fixed);
        const int iterations =
            detail::solve_for_free(matrix, rest_, options.tolerance, options.most_iterations);
        for (std::size_t v = 0; v < rest_.size(); ++v) {
            rest_[v] /= matrix.root[v];
        }
        return iterations;
    }

    Array<Point<D>> moved(std::span<const Point<D>> targets) const {
        Array<Point<D>> result(points_.size());
        parallel_for(points_.size(), vertices_per_piece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                const Point<D> shift = affine_(points_[v]);
                for (std::size_t k = 0; k < D; ++k) {
                    const double rest = rest_[v][static_cast<Eigen::Index>(k)];
                    result[v][k] = points_[v][k] + (shift[k] + unit_ * rest);
                }
            }
        });
        for (std::size_t b = 0; b < targets.size(); ++b) {
            result[boundary_.vertices[b]] = targets[b];
        }
        return result;
    }

private:
    /// Least remainder after the affine part, relative to the motion, that is solved for: below it single
    /// precision cannot tell.
    static constexpr double smallest_rest = 1e-8;

    std::span<const Point<D>> points_;
    std::span<const Simplex<D>> cells_;
    const Displacements<D>& boundary_;
    AffineMap<D> affine_;
    double unit_;       ///< largest displacement of the boundary
    Array<Lanes> rest_; ///< displacement without the affine part, in this unit
};

void require_targets(std::size_t points, std::span<const Index> boundary, std::size_t targets) {
    if (boundary.empty() || boundary.size() != targets) {
        throw UsageError{
            fmt::format("{} boundary vertices of a cap were given {} targets", boundary.size(), targets)};
    }
    const auto beyond =
        std::find_if(boundary.begin(), boundary.end(), [points](Index v) { return v >= points; });
    if (beyond != boundary.end()) {
        throw UsageError{
            fmt::format("a boundary vertex of a cap is {}, but it has {} points", *beyond, points),
            {{"vertex", *beyond, ""}}};
    }
}

} // namespace

template<int D>
MovedCap<D> move_cap(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
                     std::span<const Index> boundary, std::span<const Point<D>> targets,
                     const CapMotionOptions& options) {
    require_targets(points.size(), boundary, targets.size());
    const Displacements<D> wanted = displacements<D>(points, boundary, targets);
    CapMover<D> mover{points, cells, wanted};
    MovedCap<D> result;
    result.iterations = mover.solve(options);
    result.points = mover.moved(targets);
    const SolidMeasures measures = measure_solid<D>(result.points, cells);
    result.smallest_angle = measures.angles.smallest;
    result.sound = measures.smallest > 0 && std::isfinite(measures.measure);
    return result;
}

template MovedCap<2> move_cap<2>(std::span<const Point<2>>, std::span<const Simplex<2>>,
                                 std::span<const Index>, std::span<const Point<2>>, const CapMotionOptions&);
template MovedCap<3> move_cap<3>(std::span<const Point<3>>, std::span<const Simplex<3>>,
                                 std::span<const Index>, std::span<const Point<3>>, const CapMotionOptions&);

} // namespace slabhull
