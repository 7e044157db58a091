// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/delaunay_cavity.h"

#include "geometry/basics/predicates.h"
#include "geometry/meshing/in_circle.h"

#include "slabhull/geometry/measures.h"

#include <algorithm>

namespace slabhull {

DelaunayCavity::DelaunayCavity(CapMesh<2>& mesh) : mesh_{mesh} {
    seen_.assign(mesh.cells.size(), 0);
    starting_.assign(mesh.points.size(), no_index);
}

bool DelaunayCavity::dig(Index start, const Point<2>& p) {
    if (!conflicts(start, p)) {
        return false;
    }
    epoch_ += 2;
    seen_[start] = epoch_;
    cells_.assign(1, start);
    rim_.clear();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Index beyond = mesh_.neighbors[cells_[i]][k];
            if (beyond != no_index && joins(beyond, p)) {
                continue;
            }
            const Simplex<2>& cell = mesh_.cells[cells_[i]];
            const Index from = cell[plane::next(k)];
            const Index to = cell[plane::previous(k)];
            rim_.push_back({from, to, beyond, beyond == no_index ? 0 : side_of(beyond, to)});
        }
    }
    return rim_.size() == cells_.size() + 2 && sees_rim(p);
}

bool DelaunayCavity::conflicts(Index cell, const Point<2>& p) const {
    return exact::in_circle(corners_of<2, 2>(mesh_.cells[cell], mesh_.points), p);
}

/// Whether a cell next to the cavity belongs to it; the answer is cached.
bool DelaunayCavity::joins(Index cell, const Point<2>& p) {
    if (seen_[cell] >= epoch_) {
        return seen_[cell] == epoch_;
    }
    const bool inside = conflicts(cell, p);
    seen_[cell] = inside ? epoch_ : epoch_ + 1;
    if (inside) {
        cells_.push_back(cell);
    }
    return inside;
}

bool DelaunayCavity::sees_rim(const Point<2>& p) const {
    return std::all_of(rim_.begin(), rim_.end(), [&](const Edge& edge) {
        return exact::orientation(mesh_.points[edge.from], mesh_.points[edge.to], p) > 0;
    });
}

/// Local number of the cell's edge that starts, counter-clockwise, at vertex `first`.
std::size_t DelaunayCavity::side_of(Index cell, Index first) const {
    const Simplex<2>& c = mesh_.cells[cell];
    return plane::previous(first == c[0] ? 0 : first == c[1] ? 1 : 2);
}

void DelaunayCavity::add_cells() {
    while (cells_.size() < rim_.size()) {
        cells_.push_back(checked_index(mesh_.cells.size(), "cells of a cap mesh"));
        mesh_.cells.emplace_back();
        mesh_.neighbors.emplace_back();
        seen_.push_back(0);
    }
}

void DelaunayCavity::fill(const Point<2>& p) {
    const Index centre = checked_index(mesh_.points.size(), "points of a cap mesh");
    mesh_.points.push_back(p);
    starting_.push_back(no_index);
    add_cells();
    for (std::size_t i = 0; i < rim_.size(); ++i) {
        starting_[rim_[i].from] = cells_[i];
    }
    for (std::size_t i = 0; i < rim_.size(); ++i) {
        const Edge& edge = rim_[i];
        const Index follower = starting_[edge.to];
        mesh_.cells[cells_[i]] = {edge.from, edge.to, centre};
        mesh_.neighbors[cells_[i]][0] = follower;
        mesh_.neighbors[follower][1] = cells_[i];
        mesh_.neighbors[cells_[i]][2] = edge.beyond;
        if (!edge.boundary()) {
            mesh_.neighbors[edge.beyond][edge.side] = cells_[i];
        }
    }
}

} // namespace slabhull
