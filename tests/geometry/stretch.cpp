// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/stretch.h"

#include "geometry/random_points.h"
#include "geometry/specimens.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/shapes.h"

#include <catch2/catch.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <vector>

using namespace slabhull;
using tests::not_a_number;
using tests::random_points;

namespace {

/// Numbers the facets of a surface by `patch_of(mean of their corners)`.
template<int D, class PatchOf>
void set_patches(Surface<D>& surface, PatchOf&& patch_of) {
    std::map<PatchNumber, std::string> names;
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
        Point<D> centre{};
        for (const Index v : surface.facets[f]) {
            for (std::size_t k = 0; k < D; ++k) {
                centre[k] += surface.points[v][k] / D;
            }
        }
        surface.patch[f] = patch_of(centre);
        names[surface.patch[f]] = "side " + std::to_string(surface.patch[f]);
    }
    surface.patches.clear();
    for (const auto& [number, name] : names) {
        surface.patches.push_back({number, name});
    }
}

/// A cube of edge 2 whose sides are patches 1 to 6: -x, x, -y, y, -z, z.
Surface<3> cube_of_patches(Index n) {
    Surface<3> cube = specimens::cube_grid(n);
    set_patches(cube, [](const Point<3>& centre) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (std::abs(std::abs(centre[k]) - 1) < 1e-9) {
                return static_cast<PatchNumber>(2 * k + (centre[k] > 0 ? 2 : 1));
            }
        }
        return PatchNumber{7};
    });
    return cube;
}

constexpr PatchNumber top = 6;

/// The cube with its top sheared within itself, so that triangles of it become obtuse, but none is folded.
Surface<3> cube_with_obtuse_top(Index n) {
    return specimens::mapped(cube_of_patches(n), [](Point<3> p) {
        if (p[2] == 1) {
            const double bump = (1 - p[0] * p[0]) * (1 - p[1] * p[1]);
            p[0] += 0.7 * bump * std::sin(3 * p[1]);
            p[1] += 0.2 * bump * p[0];
        }
        return p;
    });
}

/// A cylinder of radius 1 about z with n generators and m rows; patches 1 bottom, 2 top, 3 wall. Vertices of
/// the wall are moved along their generators by `jitter`, so that the wall stays developable.
Surface<3> cylinder(Index n, Index m, double height, double jitter) {
    Surface<3> s;
    const auto shifts = random_points<2>(n * m, jitter * height / m);
    for (Index row = 0; row <= m; ++row) {
        for (Index i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * i / n;
            const double shift = row == 0 || row == m ? 0 : shifts[row * n + i][0];
            s.points.push_back({std::cos(angle), std::sin(angle), height * row / m + shift});
        }
    }
    const Index below = (m + 1) * n;
    s.points.push_back({0, 0, 0});
    s.points.push_back({0, 0, height});
    const auto add = [&](const Facet<3>& facet, PatchNumber patch) {
        s.facets.push_back(facet);
        s.patch.push_back(patch);
    };
    for (Index i = 0; i < n; ++i) {
        const Index j = (i + 1) % n;
        add({below, j, i}, 1);
        add({below + 1, m * n + i, m * n + j}, 2);
        for (Index row = 0; row < m; ++row) {
            const Index a = row * n;
            add({a + i, a + j, a + n + j}, 3);
            add({a + i, a + n + j, a + n + i}, 3);
        }
    }
    s.patches = {{1, "bottom"}, {2, "piston"}, {3, "wall"}};
    return s;
}

/// The vertices of a surface that only facets of `patches` use.
template<int D>
std::vector<bool> following(const Surface<D>& surface, const std::set<PatchNumber>& patches) {
    std::vector<bool> follows(surface.points.size(), true);
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
        if (!patches.contains(surface.patch[f])) {
            for (const Index v : surface.facets[f]) {
                follows[v] = false;
            }
        }
    }
    return follows;
}

/// Where the surface comes when its leading vertices are moved; the others are forgotten before.
template<int D, class Move>
std::vector<Point<D>> stretched(const Surface<D>& surface, const std::set<PatchNumber>& patches,
                                Move&& move) {
    const std::vector<bool> follows = following(surface, patches);
    std::vector<Point<D>> x(surface.points.size());
    for (std::size_t v = 0; v < x.size(); ++v) {
        x[v].fill(not_a_number);
        if (!follows[v]) {
            x[v] = move(surface.points[v]);
        }
    }
    harmonic_stretch(Boundary<D>{surface}, patches)->follow(x);
    return x;
}

template<int D, class Move>
double farthest_from(const std::vector<Point<D>>& x, const Surface<D>& surface, Move&& move) {
    double worst = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
        const double off = distance(x[v], move(surface.points[v]));
        worst = off <= worst ? worst : off; // NaN stays
    }
    return worst;
}

double cotangent_at(const Point<3>& apex, const Point<3>& p, const Point<3>& q) {
    const Eigen::Vector3d a{apex.data()};
    const Eigen::Vector3d u = Eigen::Vector3d{p.data()} - a;
    const Eigen::Vector3d v = Eigen::Vector3d{q.data()} - a;
    return u.dot(v) / u.cross(v).norm();
}

using EdgeWeights = std::map<std::pair<Index, Index>, double>;

/// Cotangent weights of some triangles as they are.
EdgeWeights plain_weights(const Surface<3>& surface, const std::vector<Facet<3>>& facets) {
    EdgeWeights weights;
    for (const Facet<3>& facet : facets) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Index a = facet[i], b = facet[(i + 1) % 3], c = facet[(i + 2) % 3];
            weights[std::minmax(b, c)] +=
                0.5 * cotangent_at(surface.points[a], surface.points[b], surface.points[c]);
        }
    }
    return weights;
}

std::vector<Facet<3>> facets_of(const Surface<3>& surface, const std::set<PatchNumber>& patches) {
    std::vector<Facet<3>> facets;
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
        if (patches.contains(surface.patch[f])) {
            facets.push_back(surface.facets[f]);
        }
    }
    return facets;
}

/// Solves for all vertices at once, those that lead by equations of their own, with a dense matrix.
std::vector<Point<3>> dense_solution(const Surface<3>& surface, const std::vector<bool>& follows,
                                     const EdgeWeights& weights, const std::vector<Point<3>>& led) {
    const auto count = static_cast<Eigen::Index>(surface.points.size());
    Eigen::MatrixXd system = Eigen::MatrixXd::Identity(count, count);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, 3);
    for (Eigen::Index v = 0; v < count; ++v) {
        const auto i = static_cast<std::size_t>(v);
        if (follows[i]) {
            system(v, v) = 0;
        }
        for (Eigen::Index k = 0; k < 3 && !follows[i]; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            right(v, k) = led[i][axis] - surface.points[i][axis];
        }
    }
    for (const auto& [edge, weight] : weights) {
        for (const auto& [v, w] : {edge, std::pair{edge.second, edge.first}}) {
            if (follows[v]) {
                system(v, v) += weight;
                system(v, w) -= weight;
            }
        }
    }
    const Eigen::MatrixXd u = system.fullPivLu().solve(right);
    std::vector<Point<3>> x(surface.points.begin(), surface.points.end());
    for (std::size_t v = 0; v < x.size(); ++v) {
        for (std::size_t k = 0; k < 3; ++k) {
            x[v][k] += u(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(k));
        }
    }
    return x;
}

/// Delaunay's triangles of the vertices of a flat, convex patch at z = 1, by trying all circles.
std::vector<Facet<3>> delaunay_of_top(const Surface<3>& surface) {
    std::set<Index> on_top;
    for (const Facet<3>& facet : facets_of(surface, {top})) {
        on_top.insert(facet.begin(), facet.end());
    }
    const std::vector<Index> vertices(on_top.begin(), on_top.end());
    const auto in_circle = [&](Index a, Index b, Index c, Index d) {
        Eigen::Matrix3d m;
        Eigen::Index row = 0;
        for (const Index v : {a, b, c}) {
            const double x = surface.points[v][0] - surface.points[d][0];
            const double y = surface.points[v][1] - surface.points[d][1];
            m.row(row++) << x, y, x * x + y * y;
        }
        return m.determinant();
    };
    std::vector<Facet<3>> facets;
    for (const Index a : vertices) {
        for (const Index b : vertices) {
            for (const Index c : vertices) {
                const Point<3>&p = surface.points[a], &q = surface.points[b], &r = surface.points[c];
                const double area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
                if (!(a < b && a < c && area > 1e-9)) {
                    continue;
                }
                if (std::none_of(vertices.begin(), vertices.end(), [&](Index d) {
                        return d != a && d != b && d != c && in_circle(a, b, c, d) > 0;
                    })) {
                    facets.push_back({a, b, c});
                }
            }
        }
    }
    return facets;
}

double smallest(const EdgeWeights& weights) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [edge, weight] : weights) {
        least = std::min(least, weight);
    }
    return least;
}

Point<3> affine(const Point<3>& p) {
    return {0.3 + 1.2 * p[0] - 0.4 * p[1], 0.5 * p[0] + 0.9 * p[1] - 0.2 * p[2],
            2 * p[0] - p[1] + 0.7 * p[2] - 1};
}

/// Displaces along x by 0 or 1, without order.
Point<3> shaken(const Point<3>& p) {
    return {p[0] + (std::sin(40 * (p[0] + 2 * p[1])) > 0 ? 1 : 0), p[1], p[2]};
}

} // namespace

TEST_CASE("a linear displacement of the rim is reproduced on a flat wall, however obtuse its triangles") {
    for (const Surface<3>& cube : {cube_of_patches(7), cube_with_obtuse_top(7)}) {
        CHECK(farthest_from<3>(stretched<3>(cube, {top}, affine), cube, affine) < 1e-13);
    }
    // The second cube is as obtuse as that.
    CHECK(smallest(plain_weights(cube_with_obtuse_top(7), facets_of(cube_with_obtuse_top(7), {top}))) < -0.3);
}

TEST_CASE("the wall of a cylinder stretches linearly behind its piston") {
    for (const double jitter : {0.0, 0.45}) {
        const Surface<3> s = cylinder(12, 9, 3, jitter);
        const auto piston = [](Point<3> p) {
            p[2] += -0.8 * p[2] / 3;
            return p;
        };
        CHECK(farthest_from<3>(stretched<3>(s, {3}, piston), s, piston) < 1e-13);
    }
}

TEST_CASE("several patches stretch together: the four sides of a box behind its top") {
    const Surface<3> cube = cube_of_patches(6);
    const auto piston = [](Point<3> p) {
        p[2] += 0.5 * (p[2] + 1);
        return p;
    };
    CHECK(farthest_from<3>(stretched<3>(cube, {1, 2, 3, 4}, piston), cube, piston) < 1e-13);
}

TEST_CASE("in the plane a stretching side follows linearly in its arc length, whatever its spacing") {
    Surface<2> square;
    for (const Point<2>& p :
         {Point<2>{0, 0}, {0, 0.5}, {0, 1}, {0.1, 1}, {0.35, 1}, {0.4, 1}, {0.9, 1}, {1, 1}, {1, 0}}) {
        square.points.push_back(p);
    }
    for (Index i = 0; i < 9; ++i) {
        square.facets.push_back({i, (i + 1) % 9});
        square.patch.push_back(i >= 2 && i < 7 ? 2 : i == 7 ? 3 : 1);
    }
    square.patches = {{1, "still"}, {2, "wall"}, {3, "piston"}};
    const auto piston = [](Point<2> p) { return Point<2>{1.4 * p[0], p[1] - 0.2 * p[0]}; };
    CHECK(farthest_from<2>(stretched<2>(square, {2}, piston), square, piston) < 1e-15);
}

TEST_CASE("where nothing moves the vertices are put back bit for bit") {
    const Surface<3> cube = cube_with_obtuse_top(5);
    const auto x = stretched<3>(cube, {top, 2}, [](const Point<3>& p) { return p; });
    CHECK(std::equal(x.begin(), x.end(), cube.points.begin(), cube.points.end()));
}

TEST_CASE("only vertices that follow are moved, and only those that lead decide: not the way there") {
    const Surface<3> cube = cube_with_obtuse_top(5);
    const auto stretch = harmonic_stretch(Boundary<3>{cube}, {top});
    const std::vector<bool> follows = following(cube, {top});
    std::vector<Point<3>> x(cube.points.begin(), cube.points.end());
    const auto lead = [&](double factor) {
        for (std::size_t v = 0; v < x.size(); ++v) {
            if (!follows[v]) {
                x[v] = cube.points[v];
                x[v][0] += factor * std::sin(7 * cube.points[v][1]);
            }
        }
    };
    lead(1);
    const auto before = x;
    stretch->follow(x);
    const auto direct = x;
    for (std::size_t v = 0; v < x.size(); ++v) {
        CHECK((x[v] == before[v]) == (!follows[v]));
    }
    for (const double factor : {-3.0, 0.2, 1.0}) {
        lead(factor);
        stretch->follow(x);
    }
    CHECK(x == direct);
}

TEST_CASE("curved walls: the same as a dense solve with the cotangents of the triangles, all of them acute "
          "enough") {
    Surface<3> ball = ellipsoid_body<3>({1, 2, 3}, {2, 2, 2.5}, 8, {1, "ball"});
    set_patches(ball, [](const Point<3>& centre) { return centre[2] > 3.5 ? 2 : centre[2] > 2.2 ? 3 : 1; });
    const std::set<PatchNumber> patches{3};
    const auto weights = plain_weights(ball, facets_of(ball, patches));
    REQUIRE(smallest(weights) > 0);
    const auto move = [](Point<3> p) {
        return Point<3>{p[0] + std::sin(p[1]), p[1] * p[2], p[2] + (p[2] > 3 ? 1 : 0)};
    };
    const auto x = stretched<3>(ball, patches, move);
    const auto dense = dense_solution(ball, following(ball, patches), weights, x);
    for (std::size_t v = 0; v < x.size(); ++v) {
        CHECK(distance(x[v], dense[v]) < 1e-12);
    }
}

TEST_CASE("obtuse triangles: the same as a dense solve on Delaunay's triangles of the flat wall") {
    const Surface<3> cube = cube_with_obtuse_top(7);
    const auto x = stretched<3>(cube, {top}, shaken);
    const auto follows = following(cube, {top});
    const auto dense = dense_solution(cube, follows, plain_weights(cube, delaunay_of_top(cube)), x);
    const auto plain = dense_solution(cube, follows, plain_weights(cube, facets_of(cube, {top})), x);
    double from_dense = 0;
    double from_plain = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
        from_dense = std::max(from_dense, distance(x[v], dense[v]));
        from_plain = std::max(from_plain, distance(x[v], plain[v]));
    }
    CHECK(from_dense < 1e-12);
    CHECK(from_plain > 1e-3); // the given triangles are others
}

TEST_CASE("what follows stays between what leads, which the given triangles alone would not grant") {
    const Surface<3> cube = cube_with_obtuse_top(9);
    const auto follows = following(cube, {top});
    const auto moved_by = [&](const std::vector<Point<3>>& x) {
        std::pair<double, double> range{1, 0};
        for (std::size_t v = 0; v < x.size(); ++v) {
            const double by = x[v][0] - cube.points[v][0];
            range = {std::min(range.first, by), std::max(range.second, by)};
        }
        return range;
    };
    const auto x = stretched<3>(cube, {top}, [&](const Point<3>& p) {
        return Point<3>{p[0] + (p[0] == 1 && std::abs(p[1]) < 0.3 ? 1 : 0), p[1], p[2]};
    });
    const auto [least, most] = moved_by(x);
    CHECK(least >= 0);
    CHECK(most <= 1);
    const auto plain = dense_solution(cube, follows, plain_weights(cube, facets_of(cube, {top})), x);
    CHECK(moved_by(plain).first < 0);
}

TEST_CASE("needles do not keep the flips from ending, and lines stay lines") {
    for (const double aspect : {1e-3, 1e-5}) {
        const Surface<3> cube = specimens::mapped(cube_with_obtuse_top(8), [aspect](Point<3> p) {
            p[1] *= aspect;
            p[0] += 5 * p[1];
            return p;
        });
        const auto move = [](Point<3> p) {
            p[2] += p[0];
            return p;
        };
        CHECK(farthest_from<3>(stretched<3>(cube, {top}, move), cube, move) < 1e-6);
    }
}

TEST_CASE("a patch that no other leads is refused by name") {
    Surface<3> both = specimens::together(specimens::box({-4, -4, -4}, {4, 4, 4}, 3),
                                          specimens::turned_inside_out(specimens::ball({0, 0, 0}, 1, 3)));
    CHECK_NOTHROW(harmonic_stretch(Boundary<3>{both}, {}));
    CHECK_NOTHROW(harmonic_stretch(Boundary<3>{both}, {5}));
    for (const auto& patches : {std::set<PatchNumber>{2}, {1, 2}}) {
        try {
            harmonic_stretch(Boundary<3>{both}, patches);
            FAIL("accepted");
        } catch (const UsageError& error) {
            REQUIRE(error.entities.size() == 1);
            CHECK(error.entities[0].patch == (patches.contains(1) ? "box" : "ball"));
            CHECK(std::string{error.what()}.find(error.entities[0].patch) != std::string::npos);
        }
    }
    // One part of a patch led, another not.
    std::fill(both.patch.begin(), both.patch.end(), 1);
    both.patch[0] = 3;
    CHECK_THROWS_AS(harmonic_stretch(Boundary<3>{both}, {1}), UsageError);
    CHECK_THROWS_AS(harmonic_stretch(Boundary<2>{specimens::disc({0, 0}, 1, 9)}, {3}), UsageError);
}
