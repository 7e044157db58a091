// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/cap_motion.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/affine.h"
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/geometry/shapes.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

using namespace slabhull;
using Catch::Matchers::Contains;

namespace {

/// A box around an ellipsoid, meshed; the vertices of the ellipsoid come first, then those of the box.
template<int D>
struct Room {
    CapMesh<D> mesh;
    std::vector<Index> boundary;
    std::size_t body = 0; ///< vertices of the ellipsoid
};

template<int D>
Room<D> make_room(double size) {
    Point<D> axes{1, 1.5};
    Point<D> corner;
    corner.fill(4);
    if constexpr (D == 3) {
        axes[2] = 0.8;
    }
    const auto body = ellipsoid_body<D>({}, axes, ellipsoid_divisions<D>(axes, size), {1, "body"});
    Point<D> opposite;
    opposite.fill(-4);
    const auto box = box_surface<D>(opposite, corner, 3 * size, {2, "box"});
    const auto surface = join<D>(std::array{body, box});
    Room<D> room{mesh_cap<D>(surface, {}), std::vector<Index>(surface.points.size()), body.points.size()};
    std::iota(room.boundary.begin(), room.boundary.end(), Index{0});
    return room;
}

template<int D>
const Room<D>& small_room() {
    static const Room<D> room = make_room<D>(D == 2 ? 0.2 : 0.5);
    return room;
}

template<int D>
using Points = std::vector<Point<D>>;

template<int D>
Points<D> boundary_points(const Room<D>& room) {
    return {room.mesh.points.begin(),
            room.mesh.points.begin() + static_cast<std::ptrdiff_t>(room.boundary.size())};
}

/// The body turned about the last axis by an angle, the box where it was.
template<int D>
Points<D> turned(const Room<D>& room, double angle) {
    Points<D> targets = boundary_points(room);
    for (std::size_t v = 0; v < room.body; ++v) {
        const auto [x, y] = std::pair{targets[v][0], targets[v][1]};
        targets[v][0] = std::cos(angle) * x - std::sin(angle) * y;
        targets[v][1] = std::sin(angle) * x + std::cos(angle) * y;
    }
    return targets;
}

template<int D>
MovedCap<D> move_room(const Room<D>& room, const std::type_identity_t<Points<D>>& targets,
                      const CapMotionOptions& options = {}) {
    return move_cap<D>(room.mesh.points, room.mesh.cells, room.boundary, targets, options);
}

template<int D>
double largest_distance(const Array<Point<D>>& a, const Array<Point<D>>& b) {
    double result = 0;
    for (std::size_t v = 0; v < a.size(); ++v) {
        result = std::max(result, distance(a[v], b[v]));
    }
    return result;
}

/// What move_cap() says of the cells, found cell by cell.
template<int D>
void require_truth(const Room<D>& room, const MovedCap<D>& moved) {
    double smallest = 180;
    bool positive = true;
    for (const Simplex<D>& cell : room.mesh.cells) {
        const auto corners = corners_of<D, D>(cell, moved.points);
        smallest = std::min(smallest, dihedral_angles<D, D>(corners).smallest);
        positive = positive && signed_measure<D>(corners) > 0;
    }
    CHECK(moved.sound == positive);
    CHECK(moved.smallest_angle == Approx(smallest).margin(1e-9));
}

template<int D>
using Rows = Eigen::Matrix<double, Eigen::Dynamic, D>;

/// kappa V times the products of the gradients of the barycentric coordinates, which are the rows of the
/// inverse of the matrix with the rows (1, corner).
template<int D>
Eigen::Matrix<double, D + 1, D + 1> reference_cell(const std::array<Point<D>, D + 1>& corners) {
    Eigen::Matrix<double, D + 1, D + 1> matrix;
    for (int i = 0; i <= D; ++i) {
        matrix(i, 0) = 1;
        for (int k = 0; k < D; ++k) {
            matrix(i, k + 1) = corners[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
        }
    }
    const Eigen::Matrix<double, D + 1, D> gradients = matrix.inverse().template bottomRows<D>().transpose();
    const double kappa = std::pow(gradients.squaredNorm(), 2);
    return kappa * std::abs(matrix.determinant()) * gradients * gradients.transpose();
}

/// Displacements by Eigen's Cholesky factorisation, from those of the first `fixed` vertices.
template<int D>
Rows<D> reference_solution(const Room<D>& room, const Rows<D>& given) {
    const auto fixed = given.rows();
    const auto free = static_cast<Eigen::Index>(room.mesh.points.size()) - fixed;
    std::vector<Eigen::Triplet<double>> triplets;
    Rows<D> right = Rows<D>::Zero(free, D);
    for (const Simplex<D>& cell : room.mesh.cells) {
        const auto local = reference_cell<D>(corners_of<D, D>(cell, room.mesh.points));
        for (int i = 0; i <= D; ++i) {
            for (int j = 0; j <= D; ++j) {
                const auto row = static_cast<Eigen::Index>(cell[static_cast<std::size_t>(i)]) - fixed;
                const auto column = static_cast<Eigen::Index>(cell[static_cast<std::size_t>(j)]);
                if (row >= 0 && column < fixed) {
                    right.row(row) -= local(i, j) * given.row(column);
                } else if (row >= 0) {
                    triplets.emplace_back(static_cast<int>(row), static_cast<int>(column - fixed),
                                          local(i, j));
                }
            }
        }
    }
    Eigen::SparseMatrix<double> matrix{free, free};
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>{matrix}.solve(right);
}

template<int D>
Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, D, Eigen::RowMajor>>
as_rows(std::span<const Point<D>> points) {
    return {points.front().data(), static_cast<Eigen::Index>(points.size()), D};
}

/// Where the inner vertices go: the nearest affine displacement (by a QR factorisation) and the reference
/// solution for the rest.
template<int D>
Array<Point<D>> reference_points(const Room<D>& room, const Points<D>& targets) {
    const auto all = as_rows<D>(room.mesh.points);
    Eigen::Matrix<double, Eigen::Dynamic, D + 1> affine{all.rows(), D + 1};
    affine << all, Eigen::VectorXd::Ones(all.rows());
    const auto fixed = static_cast<Eigen::Index>(targets.size());
    const Rows<D> given = as_rows<D>(targets) - all.topRows(fixed);
    const Eigen::Matrix<double, D + 1, D> fit = affine.topRows(fixed).colPivHouseholderQr().solve(given);
    Rows<D> result = all + affine * fit;
    result.topRows(fixed) = as_rows<D>(targets);
    result.bottomRows(all.rows() - fixed) += reference_solution<D>(room, given - affine.topRows(fixed) * fit);
    Array<Point<D>> points(room.mesh.points.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
        for (std::size_t k = 0; k < D; ++k) {
            points[v][k] = result(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(k));
        }
    }
    return points;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a boundary that stays leaves the cap bit for bit", "", ((int D), D), 2, 3) {
    const Room<D>& room = small_room<D>();
    const MovedCap<D> moved = move_room(room, boundary_points(room));
    CHECK(moved.points == room.mesh.points);
    CHECK(moved.sound);
    CHECK(moved.iterations == 0);
    require_truth(room, moved);
}

TEMPLATE_TEST_CASE_SIG("an affine motion of the boundary is that of the whole cap", "", ((int D), D), 2, 3) {
    const Room<D>& room = small_room<D>();
    AffineMap<D> map; // 1.2 times larger, sheared and shifted
    for (std::size_t k = 0; k < D; ++k) {
        map.rows[k][k] = 1.2;
        map.rows[k][(k + 1) % D] += 0.3;
        map.shift[k] = 2.0 - static_cast<double>(k);
    }
    Points<D> targets = boundary_points(room);
    std::transform(targets.begin(), targets.end(), targets.begin(), map);
    Array<Point<D>> expected = room.mesh.points;
    std::transform(expected.begin(), expected.end(), expected.begin(), map);
    const MovedCap<D> moved = move_room(room, targets);
    CHECK(moved.sound);
    CHECK(largest_distance<D>(moved.points, expected) < 1e-13);
}

TEMPLATE_TEST_CASE_SIG("inner vertices go where a direct solver puts them", "", ((int D), D), 2, 3) {
    const Room<D>& room = small_room<D>();
    const Points<D> targets = turned(room, 0.05);
    const Array<Point<D>> expected = reference_points<D>(room, targets);
    const double motion = largest_distance<D>(expected, room.mesh.points);
    const MovedCap<D> exact = move_room(room, targets, {1e-5, 1000});
    CHECK(largest_distance<D>(exact.points, expected) < 1e-4 * motion);
    const MovedCap<D> usual = move_room(room, targets);
    CHECK(largest_distance<D>(usual.points, expected) < 0.05 * motion);
    CHECK(usual.iterations < exact.iterations);
}

TEMPLATE_TEST_CASE_SIG("a body that turns a little takes the cells around it along", "", ((int D), D), 2, 3) {
    const Room<D>& room = small_room<D>();
    const MovedCap<D> moved = move_room(room, turned(room, 0.05));
    require_truth(room, moved);
    CHECK(moved.sound);
    CHECK(moved.smallest_angle > 0.9 * measure_solid<D>(room.mesh.points, room.mesh.cells).angles.smallest);
}

TEMPLATE_TEST_CASE_SIG("many small turns keep cells good that one large turn inverts", "", ((int D), D), 2,
                       3) {
    Room<D> room = small_room<D>();
    const MovedCap<D> at_once = move_room(room, turned(room, 2.5));
    require_truth(room, at_once);
    CHECK_FALSE(at_once.sound);
    const double before = measure_solid<D>(room.mesh.points, room.mesh.cells).angles.smallest;
    for (int slab = 0; slab < 15; ++slab) {
        const MovedCap<D> moved = move_room(room, turned(room, 0.02));
        REQUIRE(moved.sound);
        CHECK(moved.smallest_angle > 0.7 * before);
        room.mesh.points = moved.points;
    }
}

TEMPLATE_TEST_CASE_SIG("boundary vertices end at their targets bit for bit, whatever their numbers and order",
                       "", ((int D), D), 2, 3) {
    Room<D> room = small_room<D>();
    Points<D> targets = turned(room, 0.03);
    const CapMotionOptions exact{1e-5, 1000};
    const Array<Point<D>> plain = move_room(room, targets, exact).points;
    std::mt19937 random{7};
    std::vector<Index> number(room.mesh.points.size());
    std::iota(number.begin(), number.end(), Index{0});
    std::shuffle(number.begin(), number.end(), random);
    const CapMesh<D> mesh = room.mesh;
    for (std::size_t v = 0; v < number.size(); ++v) {
        room.mesh.points[number[v]] = mesh.points[v];
    }
    for (Simplex<D>& cell : room.mesh.cells) {
        std::transform(cell.begin(), cell.end(), cell.begin(), [&](Index v) { return number[v]; });
    }
    std::copy_n(number.begin(), room.boundary.size(), room.boundary.begin());
    std::reverse(room.boundary.begin(), room.boundary.end());
    std::reverse(targets.begin(), targets.end());
    const MovedCap<D> moved = move_room(room, targets, exact);
    for (std::size_t b = 0; b < targets.size(); ++b) {
        CHECK(moved.points[room.boundary[b]] == targets[b]);
    }
    double apart = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        apart = std::max(apart, distance(moved.points[number[v]], plain[v]));
    }
    CHECK(apart < 1e-5);
}

TEMPLATE_TEST_CASE_SIG("lengths have no unit", "", ((int D), D), 2, 3) {
    Room<D> room = small_room<D>();
    Points<D> targets = turned(room, 0.05);
    const double angle = move_room(room, targets).smallest_angle;
    const double unit = GENERATE(1e-9, 1e9);
    const auto scale = [unit](Point<D>& point) {
        std::for_each(point.begin(), point.end(), [unit](double& x) { x *= unit; });
    };
    std::for_each(room.mesh.points.begin(), room.mesh.points.end(), scale);
    std::for_each(targets.begin(), targets.end(), scale);
    const MovedCap<D> moved = move_room(room, targets);
    CHECK(moved.sound);
    CHECK(moved.smallest_angle == Approx(angle).epsilon(1e-4));
}

TEMPLATE_TEST_CASE_SIG("the same bytes come out with one thread and with two", "", ((int D), D), 2, 3) {
    const Room<D> room = make_room<D>(D == 2 ? 0.015 : 0.16); // several pieces of work
    REQUIRE(room.mesh.points.size() > 4096);
    const Points<D> targets = turned(room, 0.02);
    set_thread_count(1);
    const MovedCap<D> one = move_room(room, targets);
    set_thread_count(2);
    const MovedCap<D> two = move_room(room, targets);
    set_thread_count(0);
    CHECK(one.points == two.points);
    CHECK(one.smallest_angle == two.smallest_angle);
    CHECK(one.iterations == two.iterations);
}

TEMPLATE_TEST_CASE_SIG("a cap that is flattened, or goes nowhere known, is unsound", "", ((int D), D), 2, 3) {
    const Room<D>& room = small_room<D>();
    Points<D> targets = boundary_points(room);
    SECTION("flat") {
        for (Point<D>& target : targets) {
            target[0] = 0;
        }
    }
    SECTION("one coordinate is no number") {
        targets[3][1] = std::numeric_limits<double>::quiet_NaN();
    }
    CHECK_FALSE(move_room(room, targets).sound);
}

TEMPLATE_TEST_CASE_SIG("a boundary vertex that was left out is named", "", ((int D), D), 2, 3) {
    Room<D> room = small_room<D>();
    Points<D> targets = turned(room, 0.05);
    const auto at = static_cast<std::ptrdiff_t>(5);
    room.boundary.erase(room.boundary.begin() + at);
    targets.erase(targets.begin() + at);
    CHECK_THROWS_AS(move_room(room, targets), GeometryError);
    CHECK_THROWS_WITH(move_room(room, targets), Contains("vertex 5"));
}

TEST_CASE("what move_cap() cannot take is an error", "[bad-input]") {
    const Array<Point<2>> points{{0, 0}, {1, 0}, {0, 1}};
    const Array<Simplex<2>> cells{{0, 1, 2}};
    const Array<Index> boundary{0, 1, 2};
    CHECK_NOTHROW(move_cap<2>(points, cells, boundary, points));
    CHECK_THROWS_AS(move_cap<2>(points, cells, {}, {}), UsageError);
    CHECK_THROWS_AS(move_cap<2>(points, cells, std::span{boundary}.first(2), points), UsageError);
    const Array<Index> beyond{0, 1, 3};
    CHECK_THROWS_WITH(move_cap<2>(points, cells, beyond, points),
                      Catch::Matchers::Contains("is 3, but it has 3 points"));
}
