// SPDX-License-Identifier: BSD-3-Clause
#include "slab/require_found.h"
#include "slab/specimens.h"
#include "slabhull/slab/check.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace slabhull;
using specimens::Grid;

namespace {

template<int D>
MeshReport check(const Grid<D>& mesh) {
    return check_mesh<D>(mesh.points, mesh.cells);
}

/// A vertex inside the mesh.
template<int D>
Index inner_vertex(const Grid<D>& mesh) {
    const auto found = std::find_if(mesh.points.begin(), mesh.points.end(), [](const Point<D>& point) {
        return std::all_of(point.begin(), point.end(), [](double x) { return x == 1; });
    });
    return static_cast<Index>(found - mesh.points.begin());
}

} // namespace

TEMPLATE_TEST_CASE_SIG("sound meshes pass, with their counts", "", ((int D), D), 2, 3) {
    const auto mesh = specimens::full_box<D>(3);
    const MeshReport report = check(mesh);
    require_found(report, {});
    CHECK(report.cells == mesh.cells.size());
    CHECK(report.vertices == mesh.points.size());
    CHECK(report.boundary_facets == (D == 2 ? 12 : 108));
    CHECK(report.measure == Approx(std::pow(3, D)));
    CHECK(report.components == 1);
    CHECK(report.orientation == 1);
    require_found(check(specimens::box_with_body<D>()), {});
    require_found(check(specimens::box_with_two_bodies<D>()), {});
}

TEMPLATE_TEST_CASE_SIG("a mesh turned over as a whole is sound, and says so", "", ((int D), D), 2, 3) {
    auto mesh = specimens::full_box<D>(2);
    for (Simplex<D>& cell : mesh.cells) {
        std::swap(cell[0], cell[1]);
    }
    const MeshReport report = check(mesh);
    require_found(report, {});
    CHECK(report.orientation == -1);
    CHECK(report.measure == Approx(std::pow(2, D)));
}

TEMPLATE_TEST_CASE_SIG("a mesh that closes on itself has no boundary", "", ((int D), D), 2, 3) {
    Grid<D> mesh;
    for (Index v = 0; v < D + 2; ++v) { // the facets of a simplex of dimension D + 1
        Point<D> point{};
        if (v < D) {
            point[v] = 1;
        } else if (v == D) {
            point.fill(-0.5);
        }
        mesh.points.push_back(point);
        Simplex<D> cell{};
        for (Index k = 0; k <= D; ++k) {
            cell[k] = k < v ? k : k + 1;
        }
        if (v % 2 == 1) {
            std::swap(cell[0], cell[1]);
        }
        mesh.cells.push_back(cell);
    }
    const MeshReport report = check(mesh);
    CHECK(report.boundary_facets == 0);
    CHECK(report.count(Defect::open_facet) == 0);
    CHECK(report.count(Defect::inverted_cell) == 1); // around the last point, and over it
}

TEMPLATE_TEST_CASE_SIG("cells in the reverse order of the others", "", ((int D), D), 2, 3) {
    auto mesh = specimens::full_box<D>(3);
    std::swap(mesh.cells[4][0], mesh.cells[4][1]);
    const MeshReport report = check(mesh);
    require_found(report, {{Defect::inverted_cell, "cell", {4}}});
}

TEMPLATE_TEST_CASE_SIG("a vertex pushed through its neighbours", "", ((int D), D), 2, 3) {
    auto mesh = specimens::full_box<D>(4);
    mesh.points[inner_vertex(mesh)][0] += 1.3;
    require_found(check(mesh), {Defect::inverted_cell});
}

TEMPLATE_TEST_CASE_SIG("two cells on the same side of a facet", "", ((int D), D), 2, 3) {
    Grid<D> mesh;
    for (int corner = 0; corner <= D; ++corner) {
        Point<D> point{};
        if (corner > 0) {
            point[static_cast<std::size_t>(corner - 1)] = 1;
        }
        mesh.points.push_back(point);
    }
    Point<D> inside;
    inside.fill(0.2);
    mesh.points.push_back(inside);
    Simplex<D> cell{};
    std::iota(cell.begin(), cell.end(), Index{0});
    mesh.cells.push_back(cell);
    cell[0] = D + 1; // above the same facet
    mesh.cells.push_back(cell);
    require_found(check(mesh), {{Defect::folded_facet, "cell", {0, 1}}});
}

TEMPLATE_TEST_CASE_SIG("broken numbers and coordinates", "", ((int D), D), 2, 3) {
    auto mesh = specimens::full_box<D>(2);
    mesh.cells[3][0] = static_cast<Index>(mesh.points.size());
    require_found(check(mesh), {{Defect::index_out_of_range, "cell", {3}}});
    mesh = specimens::full_box<D>(2);
    mesh.points[2][1] = std::numeric_limits<double>::quiet_NaN();
    require_found(check(mesh), {{Defect::non_finite_coordinate, "vertex", {2}}});
    mesh.cells.clear();
    require_found(check(mesh), {Defect::no_cells});
}

TEMPLATE_TEST_CASE_SIG("repeated vertices, duplicated cells, unused and coincident vertices", "",
                       ((int D), D), 2, 3) {
    auto mesh = specimens::full_box<D>(2);
    mesh.cells.push_back(mesh.cells[5]);
    const auto last_cell = static_cast<std::int64_t>(mesh.cells.size() - 1);
    require_found(check(mesh), {{Defect::duplicate_cell, "cell", {5, last_cell}}});

    mesh = specimens::full_box<D>(3);
    Point<D> far;
    far.fill(9);
    mesh.points.push_back(far);
    const auto last_point = static_cast<std::int64_t>(mesh.points.size() - 1);
    require_found(check(mesh), {{Defect::unused_vertex, "vertex", {last_point}}});
    mesh.points.back() = mesh.points[inner_vertex(mesh)];
    require_found(check(mesh), {{Defect::unused_vertex, "vertex", {last_point}},
                                {Defect::coincident_vertices, "vertex", {inner_vertex(mesh), last_point}}});

    mesh = specimens::full_box<D>(2);
    mesh.cells[1][0] = mesh.cells[1][1];
    CHECK(check(mesh).count(Defect::repeated_vertex) == 1);
}

TEMPLATE_TEST_CASE_SIG("a cell of a mesh without a measure", "", ((int D), D), 2, 3) {
    auto mesh = specimens::full_box<D>(1);
    Simplex<D> flat = mesh.cells[0]; // on a facet of the boundary, with a new vertex in its plane
    Point<D> middle{};
    for (std::size_t x = 0; x < D; ++x) {
        for (std::size_t i = 1; i <= D; ++i) {
            middle[x] += 0.5 * mesh.points[flat[i]][x];
        }
    }
    const auto adjacency = build_adjacency<D>(mesh.cells, mesh.points.size());
    std::size_t open = 0;
    while (adjacency.neighbors[0][open] != no_index) {
        ++open;
    }
    for (std::size_t x = 0; x < D; ++x) {
        middle[x] = 0;
        for (std::size_t i = 0; i <= D; ++i) {
            middle[x] += i == open ? 0 : mesh.points[mesh.cells[0][i]][x] / D;
        }
    }
    mesh.points.push_back(middle);
    flat[open] = static_cast<Index>(mesh.points.size() - 1);
    std::swap(flat[0], flat[1]);
    mesh.cells.push_back(flat);
    require_found(check(mesh),
                  {{Defect::degenerate_cell, "cell", {static_cast<std::int64_t>(mesh.cells.size() - 1)}}});
}

TEMPLATE_TEST_CASE_SIG("three cells on a facet", "", ((int D), D), 2, 3) {
    auto mesh = specimens::full_box<D>(1);
    Point<D> far;
    far.fill(7);
    far[0] = 3;
    mesh.points.push_back(far);
    const auto adjacency = build_adjacency<D>(mesh.cells, mesh.points.size());
    Simplex<D> fin = mesh.cells[0];
    std::size_t shared = 0;
    while (adjacency.neighbors[0][shared] == no_index) {
        ++shared;
    }
    fin[shared] = static_cast<Index>(mesh.points.size() - 1);
    if (signed_measure<D>(corners_of<D, D>(fin, mesh.points)) < 0) {
        std::swap(fin[0], fin[1]);
    }
    mesh.cells.push_back(fin);
    CHECK(check(mesh).count(Defect::overfull_facet) == 1);
}

TEST_CASE("boundaries that touch themselves") {
    // Squares of a checkerboard meet in a vertex, cubes in an edge or in a vertex.
    const auto diagonal_squares = specimens::grid<2>(2, [](const auto& at) { return at[0] == at[1]; });
    require_found(check(diagonal_squares), {Defect::singular_boundary_ridge});
    const auto diagonal_cubes =
        specimens::grid<3>(2, [](const auto& at) { return at[0] == at[1] && at[2] == 0; });
    require_found(check(diagonal_cubes), {Defect::singular_boundary_ridge});
    const auto opposite_cubes =
        specimens::grid<3>(2, [](const auto& at) { return at[0] == at[1] && at[1] == at[2]; });
    require_found(check(opposite_cubes), {Defect::singular_boundary_vertex});
}
