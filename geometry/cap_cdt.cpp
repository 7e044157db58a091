// SPDX-License-Identifier: BSD-3-Clause
#include "cap_spacing.h"
#include "constrained_delaunay.h"
#include "delaunay_refinement.h"
#include "z_order.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/cap_mesher.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

namespace slabhull {

namespace {

/// Numbers with their places along a curve.
using Keyed = std::vector<std::pair<std::uint64_t, Index>>;

/// Puts the interior points, from `given` on, in the order of the curve.
void reorder_points(CapMesh<2>& mesh, std::size_t given, const ZOrder& curve) {
    Keyed order;
    order.reserve(mesh.points.size() - given);
    for (std::size_t v = given; v < mesh.points.size(); ++v) {
        order.emplace_back(curve(mesh.points[v]), static_cast<Index>(v));
    }
    std::sort(order.begin(), order.end());
    Array<Point<2>> points(mesh.points.begin(), mesh.points.begin() + static_cast<std::ptrdiff_t>(given));
    Array<Index> fresh(mesh.points.size());
    for (std::size_t v = 0; v < given; ++v) {
        fresh[v] = static_cast<Index>(v);
    }
    points.reserve(mesh.points.size());
    for (const auto& [key, old] : order) {
        fresh[old] = static_cast<Index>(points.size());
        points.push_back(mesh.points[old]);
    }
    mesh.points = std::move(points);
    for (Simplex<2>& cell : mesh.cells) {
        for (Index& v : cell) {
            v = fresh[v];
        }
    }
}

/// Puts the cells in the order of their centres.
void reorder_cells(CapMesh<2>& mesh, const ZOrder& curve) {
    Keyed order;
    order.reserve(mesh.cells.size());
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        Point<2> centre{};
        for (const Index v : mesh.cells[c]) {
            for (std::size_t k = 0; k < 2; ++k) {
                centre[k] += mesh.points[v][k] / 3;
            }
        }
        order.emplace_back(curve(centre), static_cast<Index>(c));
    }
    std::sort(order.begin(), order.end());
    Array<Index> fresh(mesh.cells.size());
    for (std::size_t c = 0; c < order.size(); ++c) {
        fresh[order[c].second] = static_cast<Index>(c);
    }
    CapMesh<2> sorted;
    sorted.cells.reserve(order.size());
    sorted.neighbors.reserve(order.size());
    for (const auto& [key, old] : order) {
        Neighbors<2> neighbors = mesh.neighbors[old];
        for (Index& n : neighbors) {
            n = n == no_index ? no_index : fresh[n];
        }
        sorted.cells.push_back(mesh.cells[old]);
        sorted.neighbors.push_back(neighbors);
    }
    mesh.cells = std::move(sorted.cells);
    mesh.neighbors = std::move(sorted.neighbors);
}

/// A tiny edge and no growth would ask for triangles until the memory is full.
void require_countable(const SizeField<2>& field) {
    const double wanted = field.cube_count() * 4 / std::numbers::sqrt3;
    if (!(wanted < static_cast<double>(no_index))) {
        throw LimitError{
            fmt::format("the spacing of the boundary and its growth ask for about {:.2g} triangles; allow "
                        "a larger growth or remove the shortest edges",
                        wanted)};
    }
}

} // namespace

template<>
CapMesh<2> mesh_cap<2>(const Surface<2>& surface, const CapOptions& options) {
    CapMesh<2> mesh = constrained_delaunay(surface);
    const CapSpacing field{surface, options.grading};
    require_countable(field.wanted());
    refine_delaunay(mesh, field, options.min_angle);

    const ZOrder curve{surface.points};
    reorder_points(mesh, surface.points.size(), curve);
    reorder_cells(mesh, curve);
    verify_cap<2>(mesh, surface);
    return mesh;
}

} // namespace slabhull
