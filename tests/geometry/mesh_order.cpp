// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/cap_mesher.h"
#include "slabhull/geometry/shapes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

using namespace slabhull;

namespace {

template<int D>
Surface<D> hollow_box() {
    Point<D> low;
    Point<D> high;
    Point<D> axes;
    low.fill(-2);
    high.fill(2);
    axes.fill(1);
    const std::array<Surface<D>, 2> pieces{ellipsoid_body<D>({}, axes, D == 2 ? 20 : 3, {1, "body"}),
                                           box_surface<D>(low, high, 0.5, {2, "walls"})};
    return join<D>(pieces);
}

/// Cells as sorted corner positions: what a mesh is, whatever its numbering.
template<int D>
std::multiset<std::set<Point<D>>> shapes_of(const CapMesh<D>& mesh) {
    std::multiset<std::set<Point<D>>> shapes;
    for (const Simplex<D>& cell : mesh.cells) {
        std::set<Point<D>> corners;
        for (const Index v : cell) {
            corners.insert(mesh.points[v]);
        }
        shapes.insert(corners);
    }
    return shapes;
}

/// Mean distance in memory of cells that are neighbours.
template<int D>
double mean_jump(const CapMesh<D>& mesh) {
    double sum = 0;
    double count = 0;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        for (const Index n : mesh.neighbors[c]) {
            if (n != no_index) {
                sum += std::abs(static_cast<double>(n) - static_cast<double>(c));
                ++count;
            }
        }
    }
    return sum / count;
}

} // namespace

TEMPLATE_TEST_CASE_SIG("the order along a curve renumbers a mesh and leaves it the same", "[order]",
                       ((int D), D), 2, 3) {
    const Surface<D> surface = hollow_box<D>();
    CapOptions options;
    options.grading.largest = D == 2 ? 0.05 : 0.2;
    options.along_curve = false;
    const CapMesh<D> plain = mesh_cap<D>(surface, options);
    options.along_curve = true;
    const CapMesh<D> ordered = mesh_cap<D>(surface, options);
    CHECK(shapes_of(plain) == shapes_of(ordered));
    CHECK(std::equal(surface.points.begin(), surface.points.end(), ordered.points.begin()));
    CHECK_NOTHROW(verify_cap(ordered, surface)); // neighbours, too
    CHECK(mean_jump(ordered) < 0.5 * mean_jump(plain));
}
