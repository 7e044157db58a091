// SPDX-License-Identifier: BSD-3-Clause
#include "topology/complex/link.h"

#include "topology/complex/star.h"
#include "topology/complex/union_find.h"

#include <algorithm>

namespace slabhull {

namespace {

/// The link as cells of dimension D - 1 with corners: corner (c, i) is vertex i of star cell c. Corners are
/// joined when they are the same vertex of neighbouring cells, so a vertex in which k cycles meet keeps k
/// sets of corners: it is cut apart.
template<int D>
class LinkAnalysis {
public:
    LinkAnalysis(Index vertex, std::span<const Index> star, std::span<const Simplex<D>> cells,
                 std::span<const Neighbors<D>> neighbors)
        : vertex_{vertex}, star_{star}, cells_{cells},
          neighbors_{neighbors}, corners_{star.size() * (D + 1)}, pieces_{star.size()} {
        for (const Index c : star) {
            local_.number(c);
        }
        for (Index c = 0; c < star.size(); ++c) {
            join_across_facets(c);
        }
    }

    LinkFaults faults() {
        LinkFaults result;
        number_link_vertices();
        result.link_vertices = link_vertices_.size();
        if constexpr (D == 3) {
            result.pinches = pinches();
            result.euler = first_wrong_euler();
        }
        join_pieces_that_touch();
        result.pieces = pieces_.count_sets();
        return result;
    }

private:
    Index vertex_of(Index c, std::size_t i) const { return cells_[star_[c]][i]; }
    static Index corner(Index c, std::size_t i) { return static_cast<Index>(std::size_t{c} * (D + 1) + i); }

    void join_across_facets(Index c) {
        for (std::size_t i = 0; i <= D; ++i) {
            const Index neighbor = neighbors_[star_[c]][i];
            if (vertex_of(c, i) == vertex_ || neighbor == no_index) {
                continue;
            }
            const Index other = local_.number(neighbor);
            if (other >= star_.size()) {
                continue; // only where a cell names a vertex twice
            }
            pieces_.join(c, other);
            join_corners(c, i, other);
        }
    }

    void join_corners(Index c, std::size_t facet, Index other) {
        for (std::size_t i = 0; i <= D; ++i) {
            for (std::size_t j = 0; i != facet && j <= D; ++j) {
                if (vertex_of(c, i) == vertex_of(other, j)) {
                    corners_.join(corner(c, i), corner(other, j));
                }
            }
        }
    }

    void number_link_vertices() {
        for (Index c = 0; c < star_.size(); ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                if (vertex_of(c, i) != vertex_) {
                    link_vertices_.number(vertex_of(c, i));
                }
            }
        }
    }

    template<class Visit>
    void each_cut_vertex(const Visit& visit) {
        for (Index c = 0; c < star_.size(); ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                if (vertex_of(c, i) != vertex_ && corners_.is_root(corner(c, i))) {
                    visit(c, vertex_of(c, i));
                }
            }
        }
    }

    std::vector<Index> pinches() {
        std::vector<Index> parts(link_vertices_.size(), 0);
        each_cut_vertex([&](Index, Index w) { ++parts[link_vertices_.number(w)]; });
        std::vector<Index> result;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            if (parts[k] > 1) {
                result.push_back(link_vertices_.keys()[k]);
            }
        }
        std::sort(result.begin(), result.end());
        return result;
    }

    /// V - E + F of each piece, cut apart; E = 3 F / 2 because it is closed.
    long first_wrong_euler() {
        std::vector<long> twice_euler(star_.size(), 0);
        for (Index c = 0; c < star_.size(); ++c) {
            --twice_euler[pieces_.find(c)];
        }
        each_cut_vertex([&](Index c, Index) { twice_euler[pieces_.find(c)] += 2; });
        for (Index c = 0; c < star_.size(); ++c) {
            if (pieces_.is_root(c) && twice_euler[c] != 4) {
                return twice_euler[c] / 2;
            }
        }
        return 2;
    }

    void join_pieces_that_touch() {
        std::vector<Index> first_cell(link_vertices_.size(), no_index);
        for (Index c = 0; c < star_.size(); ++c) {
            for (std::size_t i = 0; i <= D; ++i) {
                if (vertex_of(c, i) == vertex_) {
                    continue;
                }
                Index& first = first_cell[link_vertices_.number(vertex_of(c, i))];
                first = std::min(first, c);
                pieces_.join(first, c);
            }
        }
    }

    Index vertex_;
    std::span<const Index> star_;
    std::span<const Simplex<D>> cells_;
    std::span<const Neighbors<D>> neighbors_;
    UnionFind corners_;
    UnionFind pieces_; ///< of star cells joined through facets
    LocalNumbering local_;
    LocalNumbering link_vertices_;
};

} // namespace

template<int D>
LinkFaults examine_link(Index vertex, std::span<const Index> star, std::span<const Simplex<D>> cells,
                        std::span<const Neighbors<D>> neighbors) {
    return LinkAnalysis<D>{vertex, star, cells, neighbors}.faults();
}

template LinkFaults examine_link<2>(Index, std::span<const Index>, std::span<const Simplex<2>>,
                                    std::span<const Neighbors<2>>);
template LinkFaults examine_link<3>(Index, std::span<const Index>, std::span<const Simplex<3>>,
                                    std::span<const Neighbors<3>>);

} // namespace slabhull
