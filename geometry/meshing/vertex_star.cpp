// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/vertex_star.h"

#include "geometry/basics/predicates.h"
#include "geometry/meshing/in_circle.h"

#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slabhull {

namespace {

std::size_t place_of(const std::array<Index, 3>& row, Index entry) {
    return static_cast<std::size_t>(std::find(row.begin(), row.end(), entry) - row.begin());
}

} // namespace

bool VertexStar::gather(Index cell, Index vertex) {
    vertex_ = vertex;
    cells_.clear();
    link_.clear();
    Index at = cell;
    do {
        const std::size_t k = place_of(mesh_.cells[at], vertex);
        cells_.push_back(at);
        link_.push_back({mesh_.cells[at][plane::next(k)], mesh_.cells[at][plane::previous(k)]});
        at = mesh_.neighbors[at][plane::next(k)];
    } while (at != cell && at != no_index);
    return at == cell;
}

Point<2> VertexStar::centroid() const {
    Point<2> sum{};
    for (const std::array<Index, 2>& edge : link_) {
        sum[0] += mesh_.points[edge[0]][0];
        sum[1] += mesh_.points[edge[0]][1];
    }
    const auto count = static_cast<double>(link_.size());
    return {sum[0] / count, sum[1] / count};
}

plane::Corners VertexStar::corners(Index cell) const {
    return corners_of<2, 2>(mesh_.cells[cell], mesh_.points);
}

plane::Corners VertexStar::moved(std::size_t i, const Point<2>& p) const {
    return {p, mesh_.points[link_[i][0]], mesh_.points[link_[i][1]]};
}

double VertexStar::least_sine(const Point<2>& p) const {
    double least = 1;
    for (std::size_t i = 0; i < link_.size(); ++i) {
        const plane::Corners triangle = moved(i, p);
        if (exact::orientation(triangle) <= 0) {
            return 0;
        }
        least = std::min(least, plane::Shape{triangle}.sine());
    }
    return least;
}

double VertexStar::clearance(const Point<2>& p) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::array<Index, 2>& edge : link_) {
        nearest = std::min(nearest, squared_distance(mesh_.points[edge[0]], p));
    }
    return std::sqrt(nearest);
}

void VertexStar::move(const Point<2>& p) {
    mesh_.points[vertex_] = p;
    changed_ = cells_;
    while (!changed_.empty()) {
        const Index cell = changed_.back();
        changed_.pop_back();
        if (flip_one_edge_of(cell)) {
            cells_.insert(cells_.end(), changed_.end() - 2, changed_.end());
        }
    }
    std::sort(cells_.begin(), cells_.end());
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
}

/// Flips an edge of the cell that is not Delaunay, if there is one, and pushes both triangles onto the stack
/// again.
bool VertexStar::flip_one_edge_of(Index cell) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Index other = mesh_.neighbors[cell][k];
        if (other == no_index) {
            continue;
        }
        const std::size_t opposite = place_of(mesh_.neighbors[other], cell);
        if (exact::in_circle(corners(cell), mesh_.points[mesh_.cells[other][opposite]])) {
            flip(cell, k);
            changed_.push_back(cell);
            changed_.push_back(other);
            return true;
        }
    }
    return false;
}

/// Flips the edge between a cell and its neighbor k.
///
///        y                y
///      / | \            /   \      .
///     p  |  q   ---->  p --- q     .
///      \ | /            \   /      .
///        x                x
void VertexStar::flip(Index cell, std::size_t k) {
    const Index other = mesh_.neighbors[cell][k];
    const std::size_t j = place_of(mesh_.neighbors[other], cell);
    const Simplex<2> left = mesh_.cells[cell];
    const Simplex<2> right = mesh_.cells[other];
    const Neighbors<2> beyond_left = mesh_.neighbors[cell];
    const Neighbors<2> beyond_right = mesh_.neighbors[other];
    const Index p = left[k];
    const Index x = left[plane::next(k)];
    const Index y = left[plane::previous(k)];
    const Index q = right[j];
    const Index across_xq = beyond_right[plane::next(j)]; // opposite to y
    const Index across_qy = beyond_right[plane::previous(j)];
    const Index across_yp = beyond_left[plane::next(k)];
    const Index across_px = beyond_left[plane::previous(k)];
    mesh_.cells[cell] = {p, x, q};
    mesh_.neighbors[cell] = {across_xq, other, across_px};
    mesh_.cells[other] = {p, q, y};
    mesh_.neighbors[other] = {across_qy, across_yp, cell};
    tell(across_xq, other, cell);
    tell(across_yp, cell, other);
}

/// Replaces a neighbor in a cell's list.
void VertexStar::tell(Index cell, Index before, Index now) {
    if (cell != no_index) {
        mesh_.neighbors[cell][place_of(mesh_.neighbors[cell], before)] = now;
    }
}

} // namespace slabhull
