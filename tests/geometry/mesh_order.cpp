// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/mesh_order.h"

#include "slabhull/geometry/shapes.h"
#include "slabhull/topology/adjacency.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

using namespace slabhull;

namespace {

/// n^D cubes of edge 1 / n, each cut into D! simplices along its diagonal, points bent a little; the corners
/// come first.
template<int D>
CapMesh<D> grid(Index n) {
    CapMesh<D> mesh;
    std::map<std::array<Index, D>, Index> numbers;
    const auto vertex = [&](const std::array<Index, D>& at) {
        const auto [entry, fresh] = numbers.try_emplace(at, static_cast<Index>(mesh.points.size()));
        if (fresh) {
            Point<D> p{};
            for (std::size_t k = 0; k < D; ++k) {
                p[k] = at[k] / double(n) + 0.01 / n * std::sin(at[0] + 2.0 * at[1] + 3.0 * at[D - 1]);
            }
            mesh.points.push_back(p);
        }
        return entry->second;
    };
    Index cubes = 1;
    for (int k = 0; k < D; ++k) {
        cubes *= n;
    }
    for (Index cube = 0; cube < cubes; ++cube) {
        std::array<Index, D> order{};
        std::iota(order.begin(), order.end(), Index{0});
        do {
            std::array<Index, D> at{};
            for (Index k = 0, rest = cube; k < D; ++k, rest /= n) {
                at[k] = rest % n;
            }
            Simplex<D> cell{vertex(at)};
            for (std::size_t k = 0; k < D; ++k) {
                ++at[order[k]];
                cell[k + 1] = vertex(at);
            }
            mesh.cells.push_back(cell);
        } while (std::next_permutation(order.begin(), order.end()));
    }
    mesh.neighbors = build_adjacency<D>(mesh.cells, mesh.points.size()).neighbors;
    return mesh;
}

/// Other numbers for the points after the fixed ones, and for the cells.
template<int D>
CapMesh<D> shuffled(const CapMesh<D>& mesh, std::size_t fixed, unsigned seed) {
    std::mt19937 random{seed};
    std::vector<Index> fresh(mesh.points.size());
    std::iota(fresh.begin(), fresh.end(), Index{0});
    std::shuffle(fresh.begin() + static_cast<std::ptrdiff_t>(fixed), fresh.end(), random);
    CapMesh<D> result = mesh;
    for (std::size_t v = 0; v < fresh.size(); ++v) {
        result.points[fresh[v]] = mesh.points[v];
    }
    for (auto& cell : result.cells) {
        for (Index& v : cell) {
            v = fresh[v];
        }
    }
    std::shuffle(result.cells.begin(), result.cells.end(), random);
    result.neighbors = build_adjacency<D>(result.cells, result.points.size()).neighbors;
    return result;
}

template<int D>
std::multiset<std::array<Point<D>, D + 1>> shapes(const CapMesh<D>& mesh) {
    std::multiset<std::array<Point<D>, D + 1>> result;
    for (const auto& cell : mesh.cells) {
        std::array<Point<D>, D + 1> corners{};
        std::transform(cell.begin(), cell.end(), corners.begin(), [&](Index v) { return mesh.points[v]; });
        result.insert(corners);
    }
    return result;
}

/// Mean difference of the numbers of neighbouring cells.
template<int D>
double spread(const CapMesh<D>& mesh) {
    double sum = 0;
    std::size_t pairs = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        for (const Index n : mesh.neighbors[c]) {
            if (n != no_index) {
                sum += std::abs(static_cast<double>(c) - n);
                ++pairs;
            }
        }
    }
    return sum / static_cast<double>(pairs);
}

template<int D>
bool same(const CapMesh<D>& a, const CapMesh<D>& b) {
    return a.points == b.points && a.cells == b.cells && a.neighbors == b.neighbors;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("a mesh in the order of a curve is the same mesh", "", ((int D), D), 2, 3) {
    for (const std::size_t fixed : {0, 7, 30}) {
        const CapMesh<D> given = shuffled(grid<D>(D == 2 ? 20 : 6), fixed, 1);
        CapMesh<D> mesh = given;
        order_along_curve<D>(mesh, fixed);
        CHECK(std::equal(mesh.points.begin(), mesh.points.begin() + static_cast<std::ptrdiff_t>(fixed),
                         given.points.begin()));
        CHECK(shapes(mesh) == shapes(given));
        CHECK(mesh.neighbors == build_adjacency<D>(mesh.cells, mesh.points.size()).neighbors);
        CHECK(spread(mesh) < 0.3 * spread(given));
    }
}

TEMPLATE_TEST_CASE_SIG("the order does not depend on the one before, and ordering twice changes nothing", "",
                       ((int D), D), 2, 3) {
    const CapMesh<D> given = grid<D>(D == 2 ? 20 : 6);
    CapMesh<D> mesh = given;
    order_along_curve<D>(mesh, 12);
    CapMesh<D> twice = mesh;
    order_along_curve<D>(twice, 12);
    CHECK(same(mesh, twice));
    for (const unsigned seed : {1, 2}) {
        CapMesh<D> other = shuffled(given, 12, seed);
        order_along_curve<D>(other, 12);
        CHECK(same(mesh, other));
    }
}

TEST_CASE("nothing to order is left as it is") {
    CapMesh<3> empty;
    order_along_curve<3>(empty, 0);
    CHECK(empty.points.empty());
    CapMesh<2> triangle{{{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}, {{no_index, no_index, no_index}}};
    const CapMesh<2> before = triangle;
    order_along_curve<2>(triangle, 3);
    CHECK(same(triangle, before));
}

TEST_CASE("caps are meshed in the order of the curve unless the mesher's own is asked for") {
    const Surface<3> box = box_surface<3>({0, 0, 0}, {1, 1, 1}, 0.15, {1, "walls"});
    CapOptions options;
    options.curve_order = false;
    const CapMesh<3> plain = mesh_cap<3>(box, options);
    options.curve_order = true;
    const CapMesh<3> ordered = mesh_cap<3>(box, options); // verified as always
    CHECK(shapes(ordered) == shapes(plain));
    CapMesh<3> expected = plain;
    order_along_curve<3>(expected, box.points.size());
    CHECK(same(ordered, expected));
}
