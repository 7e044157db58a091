// SPDX-License-Identifier: BSD-3-Clause
#include "slab/fill/side_walls.h"

#include "slab/fill/staircase.h"
#include "slabhull/core/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace slabhull {

namespace {

template<std::size_t N>
std::array<Index, N> sorted(std::array<Index, N> vertices) {
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

template<std::size_t N>
bool has(const std::array<Index, N>& cell, Index vertex) {
    return std::find(cell.begin(), cell.end(), vertex) != cell.end();
}

} // namespace

template<int D>
SideWalls<D>::SideWalls(const Hull<D>& hull, const SlabColumns<D>& columns)
    : hull_{hull}, columns_{columns}, staircase_(hull.facet_patch.size(), 1) {
    for (std::size_t c = 0; c < columns_.cells.size(); ++c) {
        for (std::size_t k = 0; k <= D; ++k) {
            if (columns_.swept_facet[c][k] != no_index) {
                read_wall(c, k);
            }
        }
    }
    if constexpr (D == 3) {
        collect_edges();
        for (std::size_t layer = 0; layer < columns_.layers(); ++layer) {
            for (const auto& [facet, corners] : others_) {
                for (std::size_t i = 0; i < 3; ++i) {
                    read_quad(layer, facet, {corners[i == 0 ? 1 : 0], corners[i == 2 ? 1 : 2]});
                }
            }
        }
        require_alike();
    }
}

template<int D>
void SideWalls<D>::read_wall(std::size_t cell, std::size_t k) {
    const Index facet = columns_.swept_facet[cell][k];
    const Facet<D> corners = without<D>(columns_.cells[cell], k);
    for (std::size_t layer = 0; layer < columns_.layers(); ++layer) {
        if (!is_staircase(layer, facet, corners)) {
            staircase_[facet] = 0;
        }
    }
    if (staircase_[facet] == 0) {
        others_.emplace_back(facet, corners);
    }
}

/// Checks that each quadrilateral has a centre in all layers or in none, so that all layers have the same
/// cells.
template<int D>
void SideWalls<D>::require_alike() const {
    for (std::size_t k = edges_.size(); k < splits_.size(); ++k) {
        if (splits_[k].pieces() != splits_[k % edges_.size()].pieces()) {
            throw GeometryError{fmt::format("layers {} and 0 of the side are split in different ways, which "
                                            "cannot be filled",
                                            k / edges_.size()),
                                {{"layer", static_cast<std::int64_t>(k / edges_.size()), {}}}};
        }
    }
}

template<int D>
bool SideWalls<D>::is_staircase(std::size_t layer, Index facet, const Facet<D>& corners) const {
    if (hull_.cells_per_prism != D) {
        return false;
    }
    const Index first = first_cell(layer, facet);
    std::array<Simplex<D>, D> there;
    std::array<Simplex<D>, D> expected;
    for (std::size_t m = 0; m < D; ++m) {
        there[m] = sorted(hull_.cells[first + m]);
        expected[m] = sorted(staircase_piece<D>(columns_, layer, corners, m));
    }
    std::sort(there.begin(), there.end());
    std::sort(expected.begin(), expected.end());
    return there == expected;
}

template<int D>
void SideWalls<D>::collect_edges() {
    for (const auto& [facet, corners] : others_) {
        for (std::size_t i = 0; i < D; ++i) {
            for (std::size_t j = i + 1; j < D; ++j) {
                edges_.push_back({corners[i], corners[j]});
            }
        }
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    splits_.resize(columns_.layers() * edges_.size());
}

/// Reads the split of the quadrilateral over `edge`, an edge of the facet.
template<int D>
void SideWalls<D>::read_quad(std::size_t layer, Index facet, const std::array<Index, 2>& edge) {
    const std::array<Index, 2> below{columns_.at(layer, edge[0]), columns_.at(layer, edge[1])};
    const std::array<Index, 2> above{columns_.at(layer + 1, edge[0]), columns_.at(layer + 1, edge[1])};
    const Index first = first_cell(layer, facet);
    bool rising = false;
    bool falling = false;
    for (Index c = first; c < first + cells_per_wall(); ++c) {
        rising = rising || (has(hull_.cells[c], below[0]) && has(hull_.cells[c], above[1]));
        falling = falling || (has(hull_.cells[c], below[1]) && has(hull_.cells[c], above[0]));
    }
    QuadSplit& split = splits_[layer * edges_.size() + quad(edge[0], edge[1])];
    split.rising = rising;
    split.centre = rising || falling ? no_index : centre_of(layer, facet, below);
}

/// The centre of a quadrilateral: the third corner of the triangle with the bottom edge on the wall's
/// outside.
template<int D>
Index SideWalls<D>::centre_of(std::size_t layer, Index facet, const std::array<Index, 2>& bottom) const {
    const Index first = first_cell(layer, facet);
    const auto here = [&](Index c) { return first <= c && c < first + cells_per_wall(); };
    for (Index c = first; c < first + cells_per_wall(); ++c) {
        if (!has(hull_.cells[c], bottom[0]) || !has(hull_.cells[c], bottom[1])) {
            continue;
        }
        for (std::size_t i = 0; i <= D; ++i) { // facet i is opposite to vertex i
            for (const Index v : hull_.cells[c]) {
                if (!here(hull_.neighbors[c][i]) && !has(bottom, hull_.cells[c][i]) && !has(bottom, v) &&
                    v != hull_.cells[c][i] && hull_.track_ids[v] == no_track) {
                    return v;
                }
            }
        }
    }
    throw GeometryError{fmt::format("the hull's side over swept facet {} in layer {} is split neither by a "
                                    "diagonal nor by a centre above vertices {} and {}; check the hull first",
                                    facet, layer, bottom[0], bottom[1]),
                        {{"cell", first, {}}}};
}

template<int D>
Index SideWalls<D>::quad(Index a, Index b) const {
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), std::array{a, b});
    return found != edges_.end() && *found == std::array{a, b} ? static_cast<Index>(found - edges_.begin())
                                                               : no_index;
}

template class SideWalls<2>;
template class SideWalls<3>;

} // namespace slabhull
