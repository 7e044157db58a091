// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/block_interface.h"

#include "geometry/meshing/constrained_delaunay.h"
#include "geometry/meshing/delaunay_refinement.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/geometry/mesh_order.h"

#include <unordered_map>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

/// Smallest angle wanted of the planar triangles: the refinement nearly always reaches it.
constexpr double interface_angle = 30;
/// Least length of an edge's projection, as a fraction of the edge.
constexpr double least_projection = 1.0 / 3;
/// Rounds of averaging. Alternating heights of the rim fade within an edge or two, smooth ones farther
/// inside.
constexpr int rounds = 100;

/// Closed curves in the plane, and the boundary vertex of each of their points.
struct Projection {
    Surface<2> curves;
    std::vector<Index> vertex;
};

Projection project(const Array<Point<3>>& points, const Array<Facet<2>>& rim, const PlaneFrame& plane) {
    Projection result;
    std::unordered_map<Index, Index> fresh;
    for (Facet<2> edge : rim) {
        const Point<3> along = minus(points[edge[1]], points[edge[0]]);
        for (Index& v : edge) {
            const auto [entry, is_new] = fresh.try_emplace(v, static_cast<Index>(result.vertex.size()));
            if (is_new) {
                result.vertex.push_back(v);
                result.curves.points.push_back(plane.project(points[v]));
            }
            v = entry->second;
        }
        const Point<2> seen = minus(result.curves.points[edge[1]], result.curves.points[edge[0]]);
        if (norm(seen) < least_projection * norm(along)) {
            throw GeometryError{"an edge of the rim stands steeply on the plane"};
        }
        result.curves.facets.push_back(edge);
    }
    result.curves.patch.assign(rim.size(), 0);
    return result;
}

/// The neighbours of each vertex along edges: those of v are other[first[v]] .. other[first[v + 1]]. An inner
/// edge counts twice.
struct VertexNeighbors {
    std::vector<std::size_t> first;
    std::vector<Index> other;
};

VertexNeighbors neighbors_of_vertices(const CapMesh<2>& mesh) {
    VertexNeighbors lists;
    lists.first.assign(mesh.points.size() + 1, 0);
    for (const Simplex<2>& cell : mesh.cells) {
        for (const Index v : cell) {
            lists.first[v + 1] += 2;
        }
    }
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        lists.first[v + 1] += lists.first[v];
    }
    lists.other.resize(lists.first.back());
    std::vector<std::size_t> next = lists.first;
    for (const Simplex<2>& cell : mesh.cells) {
        for (std::size_t i = 0; i < 3; ++i) {
            lists.other[next[cell[i]]++] = cell[(i + 1) % 3];
            lists.other[next[cell[i]]++] = cell[(i + 2) % 3];
        }
    }
    return lists;
}

/// Heights: given for the first few vertices, the average of the neighbours' at all others.
std::vector<double> smooth_heights(const CapMesh<2>& mesh, std::vector<double> given) {
    const VertexNeighbors lists = neighbors_of_vertices(mesh);
    const std::size_t fixed = given.size();
    std::vector<double> height = std::move(given);
    height.resize(mesh.points.size(), 0.0);
    for (int round = 0; round < rounds; ++round) {
        for (std::size_t v = fixed; v < height.size(); ++v) {
            double sum = 0;
            for (std::size_t k = lists.first[v]; k < lists.first[v + 1]; ++k) {
                sum += height[lists.other[k]];
            }
            height[v] = sum / static_cast<double>(lists.first[v + 1] - lists.first[v]);
        }
    }
    return height;
}

CapMesh<2> mesh_plane(const Surface<2>& curves, const PlaneFrame& plane, const SizeField<3>& size,
                      double growth) {
    require_domain_boundary<2>(curves, {}, false);
    CapMesh<2> mesh = constrained_delaunay(curves);
    const auto wanted = [&](const Point<2>& p) { return size(plane.at(p, 0)); };
    refine_delaunay(mesh, {curves, wanted, growth}, interface_angle);
    order_along_curve<2>(mesh, curves.points.size());
    return mesh;
}

} // namespace

BlockInterface span_curves(const Array<Point<3>>& points, const Array<Facet<2>>& rim, const PlaneFrame& plane,
                           const SizeField<3>& size, double growth) {
    const Projection flat = project(points, rim, plane);
    const CapMesh<2> mesh = mesh_plane(flat.curves, plane, size, growth);
    std::vector<double> given;
    for (const Index v : flat.vertex) {
        given.push_back(plane.height(points[v]));
    }
    const std::vector<double> height = smooth_heights(mesh, std::move(given));
    BlockInterface result;
    const std::size_t on_rim = flat.vertex.size();
    for (std::size_t v = on_rim; v < mesh.points.size(); ++v) {
        result.points.push_back(plane.at(mesh.points[v], height[v]));
    }
    for (const Simplex<2>& cell : mesh.cells) {
        Facet<3> facet = cell;
        for (Index& v : facet) {
            v = v < on_rim ? flat.vertex[v] : checked_index(points.size() + v - on_rim, "points of a cap");
        }
        result.facets.push_back(facet);
    }
    return result;
}

} // namespace slabhull
