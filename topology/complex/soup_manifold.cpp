// SPDX-License-Identifier: BSD-3-Clause
#include "topology/complex/soup_manifold.h"

#include "slabhull/core/parallel.h"
#include "topology/complex/star.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <ranges>
#include <set>
#include <string>
#include <vector>

namespace slabhull {

namespace {

constexpr std::size_t vertices_per_piece = 1 << 13;
constexpr std::size_t defects_told = 3;     ///< in words
constexpr std::size_t entities_listed = 64; ///< as entities

constexpr std::array<const char*, 4> singular{"vertex", "edge", "triangle", "tetrahedron"};
constexpr std::array<const char*, 4> plural{"vertices", "edges", "triangles", "tetrahedra"};

struct SoupDefect {
    std::string text;
    std::vector<Index> cells;
};

template<std::size_t N>
std::string in_words(const std::array<Index, N>& simplex) {
    return N == 1 ? fmt::format("vertex {}", simplex[0])
                  : fmt::format("{} ({})", singular[N - 1], fmt::join(simplex, ", "));
}

template<int D>
class SoupInspection {
public:
    SoupInspection(std::span<const Simplex<D>> cells, std::size_t vertex_count, const SoupDemands& demands)
        : cells_{cells}, vertex_count_{vertex_count}, demands_{demands} {}

    Adjacency<D> run() {
        examine_cells();
        refuse_defects();
        adjacency_ = build_adjacency<D>(cells_, vertex_count_);
        examine_facets();
        examine_doubles();
        refuse_defects();
        if constexpr (D >= 2) {
            examine_vertices();
            refuse_defects();
        }
        return std::move(adjacency_);
    }

private:
    void refuse_defects() const {
        if (defects_.empty()) {
            return;
        }
        std::string message = fmt::format("the {} form no oriented manifold: ", plural[D]);
        std::set<Index> cells;
        for (std::size_t k = 0; k < defects_.size(); ++k) {
            if (k < defects_told) {
                message += (k == 0 ? "" : "; ") + defects_[k].text;
            }
            cells.insert(defects_[k].cells.begin(), defects_[k].cells.end());
        }
        if (defects_.size() > defects_told) {
            message += fmt::format("; and {} more", defects_.size() - defects_told);
        }
        std::vector<Entity> at_fault;
        std::ranges::transform(cells | std::views::take(entities_listed), std::back_inserter(at_fault),
                               demands_.name);
        throw GeometryError{message, std::move(at_fault)};
    }

    void examine_cells() {
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            Simplex<D> sorted = cells_[c];
            std::sort(sorted.begin(), sorted.end());
            if (sorted.back() >= vertex_count_) {
                blame_cell(c, fmt::format("vertex {} of {}", sorted.back(), vertex_count_));
            } else if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
                blame_cell(c, "a vertex twice");
            }
        }
    }

    void blame_cell(std::size_t c, const std::string& what) {
        defects_.push_back(
            {fmt::format("{} {} ({}) names {}", singular[D], c, fmt::join(cells_[c], ", "), what),
             {static_cast<Index>(c)}});
    }

    void examine_facets() {
        using Kind = typename FacetDefect<D>::Kind;
        for (const FacetDefect<D>& defect : adjacency_.defects) {
            if (defect.kind == Kind::open && !demands_.closed) {
                continue;
            }
            const char* fault = defect.kind == Kind::disoriented ? ", which disagree in orientation" : "";
            defects_.push_back(
                {fmt::format("{} is in {} {}: {}{}", in_words(defect.facet), defect.cells.size(),
                             defect.cells.size() == 1 ? singular[D] : plural[D],
                             fmt::join(defect.cells, ", "), fault),
                 defect.cells});
        }
    }

    /// Two cells that share two facets share all vertices.
    void examine_doubles() {
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            const Neighbors<D>& across = adjacency_.neighbors[c];
            if (across[0] == across[1] && across[0] != no_index && c < across[0]) {
                defects_.push_back(
                    {fmt::format("{} {} and {} have the same vertices", plural[D], c, across[0]),
                     {static_cast<Index>(c), across[0]}});
            }
        }
    }

    // --- vertices: the facets are sound, so each link is a manifold, but for pinches

    void examine_vertices() {
        std::vector<Index> uses(vertex_count_, 0);
        std::vector<Index> first(vertex_count_, no_index);
        for (std::size_t c = cells_.size(); c-- > 0;) {
            for (const Index v : cells_[c]) {
                ++uses[v];
                first[v] = static_cast<Index>(c);
            }
        }
        std::vector<char> pinched(vertex_count_, 0);
        parallel_for(vertex_count_, vertices_per_piece, [&](std::size_t begin, std::size_t end) {
            StarWalker<D> walker{cells_, adjacency_.neighbors};
            LocalNumbering link;
            for (std::size_t v = begin; v < end; ++v) {
                const auto vertex = static_cast<Index>(v);
                pinched[v] = uses[v] > 0 && !sound(vertex, walker.walk(vertex, first[v]), uses[v], link);
            }
        });
        blame_pinched(pinched);
    }

    /// One walk meets the whole star, so the link is connected; with V vertices, F triangles and b open edges
    /// its Euler characteristic is V - (F + b) / 2. Among connected surfaces, pinched or not, that of a
    /// sphere is the only one of 2, and a disc the only one with b > 0 of 1.
    bool sound(Index vertex, std::span<const Index> star, std::size_t uses, LocalNumbering& link) const {
        if (star.size() != uses || D == 2) {
            return star.size() == uses;
        }
        link.clear();
        std::size_t open = 0;
        for (const Index c : star) {
            for (std::size_t i = 0; i <= D; ++i) {
                if (cells_[c][i] != vertex) {
                    link.number(cells_[c][i]);
                    open += adjacency_.neighbors[c][i] == no_index;
                }
            }
        }
        return 2 * link.size() == star.size() + open + (open == 0 ? 4 : 2);
    }

    void blame_pinched(const std::vector<char>& pinched) {
        for (std::size_t v = 0; v < vertex_count_; ++v) {
            if (pinched[v] != 0) {
                std::vector<Index> star;
                if (defects_.size() < defects_told) {
                    star = cells_at(static_cast<Index>(v));
                }
                defects_.push_back({fmt::format("the {} at vertex {} do not form a {}", plural[D], v,
                                                D == 2 ? "fan" : "ball"),
                                    std::move(star)});
            }
        }
    }

    std::vector<Index> cells_at(Index vertex) const {
        std::vector<Index> result;
        for (std::size_t c = 0; c < cells_.size(); ++c) {
            if (std::find(cells_[c].begin(), cells_[c].end(), vertex) != cells_[c].end()) {
                result.push_back(static_cast<Index>(c));
            }
        }
        return result;
    }

    std::span<const Simplex<D>> cells_;
    std::size_t vertex_count_;
    const SoupDemands& demands_;
    Adjacency<D> adjacency_;
    std::vector<SoupDefect> defects_;
};

} // namespace

template<int D>
Adjacency<D> manifold_adjacency(std::span<const Simplex<D>> cells, std::size_t vertex_count,
                                const SoupDemands& demands) {
    return SoupInspection<D>{cells, vertex_count, demands}.run();
}

template Adjacency<1> manifold_adjacency<1>(std::span<const Simplex<1>>, std::size_t, const SoupDemands&);
template Adjacency<2> manifold_adjacency<2>(std::span<const Simplex<2>>, std::size_t, const SoupDemands&);
template Adjacency<3> manifold_adjacency<3>(std::span<const Simplex<3>>, std::size_t, const SoupDemands&);

} // namespace slabhull
