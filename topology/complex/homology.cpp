// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/homology.h"

#include "slabhull/topology/manifold.h"
#include "topology/complex/edge_numbering.h"
#include "topology/complex/union_find.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace slabhull {

namespace {

using Word = std::uint64_t;
constexpr std::size_t word_bits = 64;

/// Rank over Z/2 of a matrix given by rows of words.
std::size_t rank_mod_2(std::vector<std::vector<Word>> rows) {
    std::size_t rank = 0;
    const std::size_t words = rows.empty() ? 0 : rows[0].size();
    for (std::size_t bit = 0; bit < words * word_bits; ++bit) {
        const std::size_t word = bit / word_bits;
        const Word mask = Word{1} << (bit % word_bits);
        const auto pivot =
            std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(rank), rows.end(),
                         [&](const std::vector<Word>& row) { return (row[word] & mask) != 0; });
        if (pivot == rows.end()) {
            continue;
        }
        std::swap(*pivot, rows[rank]);
        for (std::size_t r = rank + 1; r < rows.size(); ++r) {
            if ((rows[r][word] & mask) != 0) {
                for (std::size_t k = word; k < words; ++k) {
                    rows[r][k] ^= rows[rank][k];
                }
            }
        }
        ++rank;
    }
    return rank;
}

/// A triangle as a side of a tetrahedron: 4 * cell + the local vertex opposite to it.
using Triangle = std::uint64_t;

/// The reduction of homology.h. Triangles are known by the side in the smaller of their two cells.
class MorseReduction {
public:
    MorseReduction(std::span<const Simplex<3>> cells, std::size_t vertex_count,
                   std::span<const Neighbors<3>> neighbors)
        : cells_{cells}, neighbors_{neighbors}, vertex_count_{vertex_count}, edges_{number_edges(cells,
                                                                                                 vertex_count,
                                                                                                 neighbors)},
          present_(cells.size(), 0), degree_(edges_.count, 0), triangles_(edges_.count, 0) {}

    /// b_1 = b_2.
    std::size_t first_betti_number() {
        cut_dual_forest();
        collapse_all();
        const std::size_t critical = find_critical_edges();
        return critical - rank_mod_2(boundary_matrix(critical));
    }

private:
    /// Marks of an edge that is in no remaining triangle.
    static constexpr Index collapsed = no_index;
    static constexpr Index seen = no_index - 1;

    std::array<Index, 3> edges_of(Triangle t) const {
        const std::array<Index, 6>& e = edges_.of_cell[t / 4];
        const std::size_t i = t % 4;
        const std::size_t a = (i + 1) % 4, b = (i + 2) % 4, c = (i + 3) % 4;
        return {e[tetrahedron_edge(a, b)], e[tetrahedron_edge(a, c)], e[tetrahedron_edge(b, c)]};
    }

    /// Keeps the triangles that are not crossed by a spanning forest of the dual graph.
    void cut_dual_forest() {
        UnionFind joined{cells_.size()};
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            for (std::size_t i = 0; i < 4; ++i) {
                const Index neighbor = neighbors_[c][i];
                if (c < neighbor && !joined.join(static_cast<Index>(c), neighbor)) {
                    put(4 * c + i);
                }
            }
        }
    }

    void put(Triangle t) {
        present_[t / 4] = static_cast<std::uint8_t>(present_[t / 4] | 1 << t % 4);
        for (const Index e : edges_of(t)) {
            ++degree_[e];
            triangles_[e] ^= t;
        }
    }

    /// Edges that become free are left in `free_`.
    void take(Triangle t) {
        present_[t / 4] = static_cast<std::uint8_t>(present_[t / 4] & ~(1 << t % 4));
        for (const Index e : edges_of(t)) {
            triangles_[e] ^= t;
            if (--degree_[e] == 1) {
                free_.push_back(e);
            }
        }
    }

    void collapse_all() {
        for (std::size_t e = 0; e < edges_.count; ++e) {
            if (degree_[e] == 1) {
                free_.push_back(static_cast<Index>(e));
            }
        }
        collapse_free_edges();
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            while (present_[c] != 0) {
                const Triangle t = 4 * c + static_cast<std::size_t>(std::countr_zero(present_[c]));
                critical_triangles_.push_back(t);
                take(t);
                collapse_free_edges();
            }
        }
    }

    void collapse_free_edges() {
        while (!free_.empty()) {
            const Index e = free_.back();
            free_.pop_back();
            if (degree_[e] != 1) {
                continue; // its last triangle went with another edge
            }
            const Triangle t = triangles_[e];
            take(t);
            degree_[e] = collapsed;
            triangles_[e] = t;
            order_.push_back(e);
        }
    }

    /// The edges left by the collapses form a graph: those outside a spanning forest are critical. They are
    /// numbered in `triangles_`, which no longer serves them.
    std::size_t find_critical_edges() {
        UnionFind joined{vertex_count_};
        std::size_t critical = 0;
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            for (std::size_t k = 0; k < 6; ++k) {
                const Index e = edges_.of_cell[c][k];
                if (degree_[e] != 0) {
                    continue;
                }
                degree_[e] = seen;
                const auto [i, j] = tetrahedron_edges[k];
                triangles_[e] = joined.join(cells_[c][i], cells_[c][j]) ? not_critical : critical++;
            }
        }
        return critical;
    }

    /// Boundaries of the critical triangles in terms of critical edges, 64 of these at a time. An edge that
    /// was collapsed into a triangle stands for the triangle's other two edges, which were collapsed later or
    /// never.
    std::vector<std::vector<Word>> boundary_matrix(std::size_t critical) const {
        const std::size_t words = (critical + word_bits - 1) / word_bits;
        std::vector<std::vector<Word>> rows(critical_triangles_.size(), std::vector<Word>(words, 0));
        std::vector<Word> value(edges_.count);
        for (std::size_t word = 0; word < words; ++word) {
            for (std::size_t e = 0; e < edges_.count; ++e) {
                const bool counts = degree_[e] == seen && triangles_[e] / word_bits == word;
                value[e] = counts ? Word{1} << (triangles_[e] % word_bits) : 0;
            }
            for (std::size_t k = order_.size(); k-- > 0;) {
                value[order_[k]] = boundary(triangles_[order_[k]], value); // its own value is still 0
            }
            for (std::size_t r = 0; r < rows.size(); ++r) {
                rows[r][word] = boundary(critical_triangles_[r], value);
            }
        }
        return rows;
    }

    Word boundary(Triangle t, const std::vector<Word>& value) const {
        const std::array<Index, 3> e = edges_of(t);
        return value[e[0]] ^ value[e[1]] ^ value[e[2]];
    }

    static constexpr Triangle not_critical = ~Triangle{0};

    std::span<const Simplex<3>> cells_;
    std::span<const Neighbors<3>> neighbors_;
    std::size_t vertex_count_;
    EdgeNumbering edges_;
    Array<std::uint8_t> present_; ///< a bit for each remaining triangle
    Array<Index> degree_;         ///< remaining triangles at each edge
    Array<Triangle> triangles_;   ///< exclusive or of these: the triangle itself when there is one
    std::vector<Index> free_;
    std::vector<Index> order_; ///< collapsed edges
    std::vector<Triangle> critical_triangles_;
};

} // namespace

template<>
BettiNumbers<2> betti_numbers<2>(std::span<const Simplex<2>> cells, std::size_t vertex_count,
                                 std::span<const Neighbors<2>> neighbors) {
    std::vector<bool> used(vertex_count, false);
    for (const Simplex<2>& cell : cells) {
        for (const Index v : cell) {
            used[v] = true;
        }
    }
    const auto vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
    const std::size_t components = count_components<2>(neighbors);
    // V - E + F = b0 - b1 + b2 and E = 3 F / 2
    return {components, 2 * components + cells.size() / 2 - vertices, components};
}

template<>
BettiNumbers<3> betti_numbers<3>(std::span<const Simplex<3>> cells, std::size_t vertex_count,
                                 std::span<const Neighbors<3>> neighbors) {
    const std::size_t components = count_components<3>(neighbors);
    const std::size_t first = MorseReduction{cells, vertex_count, neighbors}.first_betti_number();
    return {components, first, first, components};
}

} // namespace slabhull
