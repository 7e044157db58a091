// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/measures.h"

#include "slabhull/core/array.h"
#include "slabhull/core/parallel.h"
#include "topology/specimens.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace slabhull;

namespace {

std::vector<Measures<3>> measure_groups(std::span<const Point<4>> points, std::span<const Simplex<3>> cells,
                                        std::span<const std::uint8_t> group, std::size_t group_count) {
    std::vector<MeasureSums<3>> sums(group_count);
    for (std::size_t c = 0; c < cells.size(); ++c) {
        sums[group[c]].add(corners_of<3, 4>(cells[c], points), points.front());
    }
    std::vector<Measures<3>> groups;
    for (const MeasureSums<3>& sum : sums) {
        groups.push_back(sum.value());
    }
    return groups;
}

/// Determinant by elimination with pivoting: another way than the cofactors under test.
template<std::size_t N>
double determinant(std::array<std::array<double, N>, N> rows) {
    double result = 1;
    for (std::size_t c = 0; c < N; ++c) {
        std::size_t pivot = c;
        for (std::size_t r = c; r < N; ++r) {
            pivot = std::abs(rows[r][c]) > std::abs(rows[pivot][c]) ? r : pivot;
        }
        if (rows[pivot][c] == 0) {
            return 0;
        }
        if (pivot != c) {
            std::swap(rows[pivot], rows[c]);
            result = -result;
        }
        result *= rows[c][c];
        for (std::size_t r = c + 1; r < N; ++r) {
            const double factor = rows[r][c] / rows[c][c];
            for (std::size_t k = c; k < N; ++k) {
                rows[r][k] -= factor * rows[c][k];
            }
        }
    }
    return result;
}

template<std::size_t N>
double heron(const std::array<std::array<double, N>, 3>& p) {
    const double a = distance(p[1], p[2]), b = distance(p[2], p[0]), c = distance(p[0], p[1]);
    const double s = (a + b + c) / 2;
    return std::sqrt(s * (s - a) * (s - b) * (s - c));
}

template<std::size_t N>
double cayley_menger(const std::array<std::array<double, N>, 4>& p) {
    std::array<std::array<double, 5>, 5> rows{};
    for (std::size_t i = 0; i < 4; ++i) {
        rows[i][4] = rows[4][i] = 1;
        for (std::size_t j = 0; j < 4; ++j) {
            rows[i][j] = std::pow(distance(p[i], p[j]), 2);
        }
    }
    return std::sqrt(determinant(rows) / 288);
}

template<int D>
double reference_measure(const std::array<Point<D + 1>, D + 1>& p) {
    if constexpr (D == 1) {
        return distance(p[0], p[1]);
    } else if constexpr (D == 2) {
        return heron(p);
    } else {
        return cayley_menger(p);
    }
}

template<int N, int D>
std::array<Point<N>, D + 1> random_corners(std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate{-1, 1};
    std::array<Point<N>, D + 1> corners;
    for (Point<N>& corner : corners) {
        for (double& x : corner) {
            x = coordinate(random);
        }
    }
    return corners;
}

template<int D>
void check_normals() {
    std::mt19937 random{D};
    for (int k = 0; k < 200; ++k) {
        const auto corners = random_corners<D + 1, D>(random);
        const Point<D + 1> normal = simplex_normal<D>(corners);
        std::array<Point<D + 1>, D + 1> rows;
        for (std::size_t i = 0; i < D; ++i) {
            double along = 0;
            for (std::size_t x = 0; x <= D; ++x) {
                rows[i][x] = corners[i + 1][x] - corners[0][x];
                along += rows[i][x] * normal[x];
            }
            CHECK(along == Approx(0).margin(1e-12));
        }
        rows[D] = normal;
        CHECK(determinant(rows) > 0);
        CHECK(distance(normal, Point<D + 1>{}) == Approx(reference_measure<D>(corners)).epsilon(1e-6));
    }
}

constexpr double degrees = 180 / 3.14159265358979323846;

} // namespace

TEST_CASE("the normal is perpendicular, on the positive side, and as long as Heron and Cayley-Menger say") {
    check_normals<1>();
    check_normals<2>();
    check_normals<3>();
}

TEST_CASE("in a cap, the normal is the signed measure along time") {
    std::mt19937 random{4};
    for (int k = 0; k < 50; ++k) {
        const auto flat = random_corners<3, 3>(random);
        std::array<Point<4>, 4> cap;
        for (std::size_t i = 0; i < 4; ++i) {
            cap[i] = {flat[i][0], flat[i][1], flat[i][2], 0.5};
        }
        const Point<4> normal = simplex_normal<3>(cap);
        CHECK(normal[0] == 0);
        CHECK(normal[1] == 0);
        CHECK(normal[2] == 0);
        CHECK(normal[3] == Approx(signed_measure<3>(flat)).epsilon(1e-12));
    }
}

TEST_CASE("signed measures are those of the unit simplices, and swap sign with two corners") {
    CHECK(signed_measure<1>({{{1.0}, {3.5}}}) == 2.5);
    CHECK(signed_measure<2>({{{0, 0}, {1, 0}, {0, 1}}}) == 0.5);
    CHECK(signed_measure<2>({{{0, 0}, {0, 1}, {1, 0}}}) == -0.5);
    CHECK(signed_measure<3>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}) == Approx(1.0 / 6));
    CHECK(signed_measure<3>({{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}}}) == Approx(-1.0 / 6));
}

TEST_CASE("angles of known simplices") {
    const auto right = dihedral_angles<2, 2>({{{0, 0}, {1, 0}, {0, std::sqrt(3.0)}}});
    CHECK(right.smallest == Approx(30));
    CHECK(right.largest == Approx(90));
    const auto regular = dihedral_angles<3, 3>({{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}});
    CHECK(regular.smallest == Approx(std::acos(1.0 / 3) * degrees));
    CHECK(regular.largest == Approx(std::acos(1.0 / 3) * degrees));
    const auto corner = dihedral_angles<3, 3>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    CHECK(corner.smallest == Approx(std::acos(1 / std::sqrt(3.0)) * degrees));
    CHECK(corner.largest == Approx(90));
    const auto sliver = dihedral_angles<3, 3>({{{1, 0, 1e-3}, {-1, 0, 1e-3}, {0, 1, 0}, {0, -1, 0}}});
    CHECK(sliver.smallest < 0.2);
    CHECK(sliver.largest == Approx(180 - 2 * std::atan(1e-3) * degrees).epsilon(1e-9));
    const double base = -std::sqrt(0.2); // of a pentatope over a tetrahedron, its tip at height 4 / sqrt(5)
    const auto pentatope = dihedral_angles<4, 4>(
        {{{1, 1, 1, base}, {1, -1, -1, base}, {-1, 1, -1, base}, {-1, -1, 1, base}, {0, 0, 0, -4 * base}}});
    CHECK(pentatope.smallest == Approx(std::acos(1.0 / 4) * degrees));
    CHECK(pentatope.largest == Approx(std::acos(1.0 / 4) * degrees));
    const auto path = dihedral_angles<4, 4>( // Kuhn's: along the edges of a cube
        {{{0, 0, 0, 0}, {1, 0, 0, 0}, {1, 1, 0, 0}, {1, 1, 1, 0}, {1, 1, 1, 1}}});
    CHECK(path.smallest == Approx(45));
    CHECK(path.largest == Approx(90));
    const auto axes =
        dihedral_angles<4, 4>({{{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
    CHECK(axes.smallest == Approx(60)); // cos = 1 / sqrt(4)
    CHECK(axes.largest == Approx(90));
}

TEST_CASE("angles do not change when a simplex is moved into a space of more dimensions") {
    std::mt19937 random{9};
    for (int k = 0; k < 100; ++k) {
        const auto flat = random_corners<3, 3>(random);
        const double turn = 0.1 * k;
        std::array<Point<4>, 4> turned;
        for (std::size_t i = 0; i < 4; ++i) {
            turned[i] = {flat[i][0], flat[i][1], std::cos(turn) * flat[i][2], std::sin(turn) * flat[i][2]};
        }
        const AngleRange a = dihedral_angles<3, 3>(flat);
        const AngleRange b = dihedral_angles<3, 4>(turned);
        CHECK(a.smallest == Approx(b.smallest).epsilon(1e-6));
        CHECK(a.largest == Approx(b.largest).epsilon(1e-6));
    }
}

TEST_CASE("the angles of a triangle in space are by the law of cosines") {
    std::mt19937 random{10};
    for (int k = 0; k < 100; ++k) {
        const auto p = random_corners<3, 2>(random);
        std::array<double, 3> angles{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double a = distance(p[(i + 1) % 3], p[(i + 2) % 3]);
            const double b = distance(p[i], p[(i + 1) % 3]), c = distance(p[i], p[(i + 2) % 3]);
            angles[i] = std::acos((b * b + c * c - a * a) / (2 * b * c)) * degrees;
        }
        const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
        CHECK(dihedral_angles<2, 3>(p).smallest == Approx(*low).epsilon(1e-6));
        CHECK(dihedral_angles<2, 3>(p).largest == Approx(*high).epsilon(1e-6));
    }
}

TEST_CASE("flat and empty simplices have an angle range, not a NaN") {
    const auto point = dihedral_angles<3, 3>({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}});
    CHECK(point.smallest == 0);
    CHECK(point.largest == 180);
    const auto flat = dihedral_angles<3, 3>({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}});
    CHECK(flat.smallest == Approx(0).margin(1e-5));
    CHECK(flat.largest == Approx(180));
}

TEST_CASE("the boundary of a simplex closes and encloses its volume, wherever it lies") {
    std::mt19937 random{12};
    for (const double shift : {0.0, 1000.0}) {
        auto corners = random_corners<4, 4>(random);
        std::array<std::array<double, 4>, 4> edges;
        for (Point<4>& corner : corners) {
            corner[3] += shift;
        }
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t x = 0; x < 4; ++x) {
                edges[i][x] = corners[i + 1][x] - corners[0][x];
            }
        }
        const Array<Point<4>> points(corners.begin(), corners.end());
        const auto sphere = specimens::sphere<3>();
        const Measures<3> sums = measure_cells<3>(points, sphere.cells);
        CHECK(std::abs(sums.enclosed) == Approx(std::abs(determinant(edges)) / 24).epsilon(1e-9));
        for (const double x : sums.closure) {
            CHECK(x == Approx(0).margin(1e-12));
        }
    }
}

TEST_CASE("sums are the same bits for any number of threads, and add up over groups") {
    const auto complex = specimens::torus<3>(25); // several pieces
    std::mt19937 random{3};
    Array<Point<4>> points(complex.vertices);
    for (Point<4>& point : points) {
        for (double& x : point) {
            x = std::generate_canonical<double, 53>(random);
        }
    }
    std::vector<std::uint8_t> group(complex.cells.size());
    for (std::uint8_t& g : group) {
        g = static_cast<std::uint8_t>(random() % 3);
    }
    set_thread_count(1);
    const Measures<3> alone = measure_cells<3>(points, complex.cells);
    set_thread_count(3);
    const Measures<3> together = measure_cells<3>(points, complex.cells);
    const auto groups = measure_groups(points, complex.cells, group, 3);
    set_thread_count(0);
    CHECK(std::memcmp(&alone, &together, sizeof(alone)) == 0);
    CHECK(groups[0].measure + groups[1].measure + groups[2].measure == Approx(alone.measure).epsilon(1e-14));
    CHECK(groups[0].enclosed + groups[1].enclosed + groups[2].enclosed ==
          Approx(alone.enclosed).epsilon(1e-12));
    CHECK(std::min({groups[0].angles.smallest, groups[1].angles.smallest, groups[2].angles.smallest}) ==
          alone.angles.smallest);
    CHECK(groups[0].cells + groups[1].cells + groups[2].cells == complex.cells.size());
}

TEST_CASE("sums that are put together are those of all simplices, and a normal is that of its simplex") {
    const Array<Point<4>> points{{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 3}};
    const std::array<Simplex<3>, 2> cells{{{0, 1, 2, 3}, {4, 1, 2, 3}}};
    std::array<MeasureSums<3>, 2> sums;
    for (std::size_t c = 0; c < 2; ++c) {
        const auto corners = corners_of<3, 4>(cells[c], points);
        CHECK(sums[c].add(corners, points[0]) == simplex_normal<3>(corners));
    }
    const Measures<3> first = sums[0].value();
    sums[0].add(sums[1]);
    const Measures<3> both = sums[0].value();
    const Measures<3> expected = measure_cells<3>(points, cells);
    CHECK(first.cells == 1);
    CHECK(both.cells == 2);
    CHECK(both.measure == expected.measure);
    CHECK(both.closure == expected.closure);
    CHECK(both.enclosed == expected.enclosed);
    CHECK(both.angles.smallest == expected.angles.smallest);
}

TEST_CASE("a group without cells in some of the pieces has the angles of its own cells only") {
    const auto complex = specimens::torus<3>(25); // several pieces
    Array<Point<4>> points(complex.vertices);
    std::mt19937 random{5};
    for (Point<4>& point : points) {
        for (double& x : point) {
            x = std::generate_canonical<double, 53>(random);
        }
    }
    std::vector<std::uint8_t> group(complex.cells.size(), 0);
    group.front() = 1;
    const auto groups = measure_groups(points, complex.cells, group, 2);
    const AngleRange own = dihedral_angles<3, 4>(corners_of<3, 4>(complex.cells.front(), points));
    CHECK(groups[1].angles.smallest == own.smallest);
    CHECK(groups[1].angles.largest == own.largest);
}

TEST_CASE("compensation keeps small simplices that stand beside huge ones") {
    // 1e16 + 1 + 1 .. loses every 1 in plain summation.
    Array<Point<2>> points{{0, 0}, {2e16, 0}, {0, 1}, {0, 0}, {2, 0}, {0, 1}};
    Array<Simplex<2>> cells{{0, 1, 2}};
    for (int k = 0; k < 1000; ++k) {
        cells.push_back({3, 4, 5});
    }
    CHECK(measure_solid<2>(points, cells).measure == 1e16 + 1000);
}

TEST_CASE("the smallest signed measure is that of the one inverted simplex") {
    const Array<Point<2>> points{{0, 0}, {4, 0}, {0, 1}, {2, 0}};
    CHECK(measure_solid<2>(points, Array<Simplex<2>>{{0, 1, 2}, {0, 3, 2}}).smallest == 1);
    CHECK(measure_solid<2>(points, Array<Simplex<2>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 2}}).smallest == -1);
    CHECK(measure_solid<2>(points, Array<Simplex<2>>{}).smallest == std::numeric_limits<double>::infinity());
}

TEST_CASE("The histogram of angles counts each angle of each simplex, in its bin", "[geometry]") {
    const std::vector<Point<3>> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<Simplex<3>> cells{{0, 1, 2, 3}};
    AngleHistogram expected{};
    expected[9] = 3; // right angles at the edges of the corner
    expected[5] = 3; // acos(1 / sqrt(3)) = 54.7 degrees at the others
    CHECK(angle_histogram<3, 3>(corner, cells) == expected);

    const std::vector<Point<3>> flat{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {8, 0, 0}};
    const std::vector<Simplex<2>> triangles{{0, 1, 2}, {0, 1, 3}}; // the second one has angles 0, 0 and 180
    AngleHistogram of_triangles{};
    of_triangles[9] = of_triangles[3] = of_triangles[5] = 1;
    of_triangles[0] = 2;
    of_triangles[17] = 1;
    CHECK(angle_histogram<2, 3>(flat, triangles) == of_triangles);
}

TEST_CASE("the aspect ratio is 1 for regular simplices and longest edge over inscribed ball for others",
          "[measures]") {
    const double h = std::sqrt(3.0) / 2;
    CHECK(aspect_ratio<2, 3>({Point<3>{0, 0, 7}, {1, 0, 7}, {0.5, h, 7}}) == Approx(1).epsilon(1e-14));
    // 3, 4, 5: the inscribed circle has radius 1, that of the equilateral triangle is edge / (2 sqrt 3).
    CHECK(aspect_ratio<2, 3>({Point<3>{0, 0, 0}, {0, 3, 0}, {0, 0, 4}}) ==
          Approx(5 / (2 * std::sqrt(3.0))).epsilon(1e-14));
    // Alternate corners of a cube of edge 1, one direction of which is turned into time.
    CHECK(aspect_ratio<3, 4>({Point<4>{0, 0, 0, 0}, {1, 1, 0, 0}, {1, 0, 0, 1}, {0, 1, 0, 1}}) ==
          Approx(1).epsilon(1e-14));
    // The corner of a cube: inscribed radius 1 / (3 + sqrt 3), longest edge sqrt 2.
    const std::vector<Point<4>> corner{{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}, {9, 9, 9, 9}};
    const double expected = std::sqrt(2.0) * (3 + std::sqrt(3.0)) / (2 * std::sqrt(6.0));
    CHECK(aspect_ratio<3, 4>({corner[0], corner[1], corner[2], corner[3]}) ==
          Approx(expected).epsilon(1e-14));
    CHECK(std::isinf(aspect_ratio<2, 3>({Point<3>{0, 0, 0}, {1, 1, 1}, {2, 2, 2}})));

    const std::vector<Simplex<3>> cells{{0, 1, 2, 3}, {0, 1, 2, 4}};
    const double other = aspect_ratio<3, 4>({corner[0], corner[1], corner[2], corner[4]});
    const AspectRatios ratios = aspect_ratios<3, 4>(corner, cells);
    CHECK(ratios.mean == Approx((expected + other) / 2));
    CHECK(ratios.largest == Approx(std::max(expected, other)));
    CHECK(aspect_ratios<3, 4>(corner, {}).largest == 0);
}
