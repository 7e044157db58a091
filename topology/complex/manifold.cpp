// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/manifold.h"

#include "core/pieces.h"
#include "core/scratch_pool.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/progress.h"
#include "slabhull/topology/cell_stretches.h"
#include "topology/complex/cell_lists.h"
#include "topology/complex/link.h"
#include "topology/complex/repeated_vertex.h"
#include "topology/complex/sorted_cell.h"
#include "topology/complex/star_confirmation.h"
#include "topology/complex/star_counter.h"
#include "topology/complex/union_find.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <utility>

namespace slabhull {

namespace {

constexpr std::size_t vertices_per_walk = 1 << 11;
constexpr std::size_t cells_per_piece = 1 << 16;

/// What each piece of a parallel loop found, put together in the order of the pieces.
template<class T>
class PieceLists {
public:
    PieceLists(std::size_t count, std::size_t grain) : grain_{grain}, lists_((count + grain - 1) / grain) {}
    std::vector<T>& at(std::size_t begin) { return lists_[begin / grain_]; }
    std::vector<T> joined() { return slabhull::joined(std::move(lists_)); }

private:
    std::size_t grain_;
    std::vector<std::vector<T>> lists_;
};

/// Calls visit(vertex) for each distinct vertex of a cell.
template<std::size_t N, class Visit>
void each_vertex(const std::array<Index, N>& cell, const Visit& visit) {
    for (std::size_t i = 0; i < N; ++i) {
        if (std::find(cell.begin(), cell.begin() + i, cell[i]) == cell.begin() + i) {
            visit(cell[i]);
        }
    }
}

template<std::size_t N>
std::vector<Index> list_of(const std::array<Index, N>& indices) {
    return {indices.begin(), indices.end()};
}

/// A duplicated cell meets its double across two facets at least, or has a facet in three cells.
template<int D>
bool may_be_duplicate(const Neighbors<D>& neighbors) {
    for (std::size_t i = 0; i <= D; ++i) {
        for (std::size_t j = i + 1; j <= D; ++j) {
            if (neighbors[i] == neighbors[j]) {
                return true;
            }
        }
    }
    return std::find(neighbors.begin(), neighbors.end(), no_index) != neighbors.end();
}

template<int D>
class Examination {
public:
    Examination(std::span<const Simplex<D>> cells, std::size_t vertex_count,
                const AdjacencyView<D>& adjacency, const ManifoldOptions& options)
        : cells_{cells}, vertex_count_{vertex_count}, adjacency_{adjacency}, options_{options} {}

    ManifoldReport run() {
        report_.counts.cells = cells_.size();
        examine_cells();
        examine_facets();
        examine_vertices();
        report_.counts.components = components();
        report_.counts.euler = euler_of<D>(report_.counts);
        std::stable_sort(report_.findings.begin(), report_.findings.end(),
                         [](const ManifoldFinding& a, const ManifoldFinding& b) { return a.what < b.what; });
        return std::move(report_);
    }

private:
    // --- cells
    // ---------------------------------------------------------------------------------------------------

    void examine_cells() {
        PieceLists<Index> repeated(cells_.size(), cells_per_piece);
        PieceLists<Index> suspects(cells_.size(), cells_per_piece);
        parallel_for(cells_.size(), cells_per_piece, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                if (repeats_a_vertex(cells_[c])) {
                    repeated.at(begin).push_back(static_cast<Index>(c));
                } else if (may_be_duplicate<D>(adjacency_.neighbors[c])) {
                    suspects.at(begin).push_back(static_cast<Index>(c));
                }
            }
        });
        for (const Index c : repeated.joined()) {
            discredit(c);
            report(ManifoldDefect::repeated_vertex, [&] {
                return ManifoldFinding{{}, list_of(cells_[c]), {c}, "names a vertex twice"};
            });
        }
        report_duplicates(suspects.joined());
        std::sort(discredited_.begin(), discredited_.end());
    }

    void report_duplicates(std::vector<Index> suspects) {
        const auto vertices = [&](Index c) { return sort_cell<D>(cells_[c]).vertices; };
        std::sort(suspects.begin(), suspects.end(), [&](Index a, Index b) {
            return std::pair{vertices(a), a} < std::pair{vertices(b), b};
        });
        std::vector<std::pair<Index, Index>> doubles; // duplicate, original
        for (std::size_t k = 1, original = 0; k < suspects.size(); ++k) {
            if (vertices(suspects[k]) == vertices(suspects[original])) {
                doubles.emplace_back(suspects[k], suspects[original]);
            } else {
                original = k;
            }
        }
        std::sort(doubles.begin(), doubles.end());
        for (const auto& [c, original] : doubles) {
            discredit(c);
            report(ManifoldDefect::duplicate_cell, [&, c = c, first = original] {
                return ManifoldFinding{
                    {}, list_of(cells_[c]), {c, first}, "has the vertices of an earlier one"};
            });
        }
    }

    /// The facets of a cell that is at fault itself are not blamed, nor are its vertices.
    void discredit(Index c) {
        discredited_.push_back(c);
        taint(cells_[c]);
    }

    template<std::size_t N>
    void taint(const std::array<Index, N>& vertices) {
        tainted_.resize(vertex_count_, false);
        for (const Index v : vertices) {
            tainted_[v] = true;
        }
    }

    bool tainted(Index v) const { return !tainted_.empty() && tainted_[v]; }

    // --- facets
    // --------------------------------------------------------------------------------------------------

    void examine_facets() {
        using Kind = typename FacetDefect<D>::Kind;
        std::size_t sides = cells_.size() * (D + 1);
        for (const FacetDefect<D>& defect : adjacency_.defects) {
            if (defect.kind != Kind::disoriented) {
                sides -= defect.cells.size();
                ++report_.counts.facets;
                taint(defect.facet);
            }
            examine_facet(defect);
        }
        report_.counts.facets += sides / 2;
    }

    void examine_facet(const FacetDefect<D>& defect) {
        std::vector<Index> cells = defect.cells;
        std::erase_if(
            cells, [&](Index c) { return std::binary_search(discredited_.begin(), discredited_.end(), c); });
        if (cells.empty() || (cells.size() == 2 && agree(defect.facet, cells[0], cells[1]))) {
            return; // nothing is wrong with it but the discredited cells
        }
        const ManifoldDefect what = cells.size() == 1   ? ManifoldDefect::open_facet
                                    : cells.size() == 2 ? ManifoldDefect::disoriented_facet
                                                        : ManifoldDefect::overfull_facet;
        report(what, [&] {
            return ManifoldFinding{{}, list_of(defect.facet), cells, facet_detail(what, cells.size())};
        });
    }

    static std::string facet_detail(ManifoldDefect what, std::size_t cells) {
        switch (what) {
        case ManifoldDefect::open_facet:
            return "in one cell only";
        case ManifoldDefect::disoriented_facet:
            return "its cells give it the same orientation";
        default:
            return fmt::format("in {} cells", cells);
        }
    }

    bool agree(const Facet<D>& facet, Index a, Index b) const { return side(facet, a) != side(facet, b); }

    bool side(const Facet<D>& facet, Index c) const {
        const SortedCell<D> cell = sort_cell<D>(cells_[c]);
        std::size_t k = 0;
        while (k < D && cell.vertices[k] == facet[k]) {
            ++k;
        }
        return cell.facet_odd(k);
    }

    // --- vertices
    // ------------------------------------------------------------------------------------------------

    /// How consecutive vertices are used.
    struct Usage {
        Array<Index> one;   ///< a cell that uses each vertex
        Array<Index> cells; ///< the number of such cells, if counted
    };

    Usage find_usage(const CellStretches<D>& stretches, std::size_t begin, std::size_t end,
                     bool counted) const {
        Usage usage;
        usage.one.assign(end - begin, no_index);
        usage.cells.assign(counted ? end - begin : 0, 0);
        const std::vector<Index> some = stretches.using_vertices(begin, end);
        const auto file = [&](std::size_t c) {
            for (const Index v : cells_[c]) {
                if (begin <= v && v < end) {
                    std::atomic_ref{usage.one[v - begin]}.store(static_cast<Index>(c),
                                                                std::memory_order_relaxed);
                }
            }
        };
        const auto count = [&](std::size_t c) {
            each_vertex(cells_[c], [&](Index v) {
                if (begin <= v && v < end) {
                    std::atomic_ref{usage.cells[v - begin]}.fetch_add(1, std::memory_order_relaxed);
                }
            });
        };
        parallel_for(some.size(), 16, [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k) {
                stretches.each_cell(some[k], file);
                if (counted) {
                    stretches.each_cell(some[k], count);
                }
            }
        });
        return usage;
    }

    /// What was found of the stars of all vertices.
    struct Survey {
        PieceLists<Index> unused;
        PieceLists<Index> suspects;
        std::size_t cells = 0;         ///< over all stars
        std::size_t link_vertices = 0; ///< over those of sound vertices

        explicit Survey(std::size_t vertex_count)
            : unused(vertex_count, vertices_per_walk), suspects(vertex_count, vertices_per_walk) {}
    };

    /// If every star is walked whole, their cells add up to the corners of all cells. Only if they do not,
    /// the cells at each vertex are counted, to find which star is incomplete.
    void examine_vertices() {
        Survey survey = survey_stars(false);
        if (survey.cells != cells_.size() * (D + 1)) {
            survey = survey_stars(true);
        }
        report_unused(survey.unused.joined());
        const std::vector<Index> to_examine = survey.suspects.joined();
        sound_ = to_examine.empty();
        const std::size_t link_vertices = survey.link_vertices + examine_suspects(to_examine);
        report_.counts.edges = D == 2 ? report_.counts.facets : link_vertices / 2;
    }

    Survey survey_stars(bool counted) {
        constexpr std::size_t passes = 4;
        const std::size_t at_once = vertices_at_once(vertex_count_, passes);
        const CellStretches<D> stretches{cells_, vertex_count_, at_once};
        Survey survey{vertex_count_};
        for (std::size_t begin = 0; begin < vertex_count_; begin += at_once) {
            const std::size_t end = std::min(vertex_count_, begin + at_once);
            survey_stars(begin, end, find_usage(stretches, begin, end, counted), survey);
        }
        return survey;
    }

    void survey_stars(std::size_t first, std::size_t last, const Usage& usage, Survey& survey) {
        constexpr std::size_t ahead = 4;
        std::atomic<std::size_t> cells{0};
        std::atomic<std::size_t> link_vertices{0};
        parallel_for(last - first, vertices_per_walk, [&](std::size_t begin, std::size_t end) {
            auto stars = counters_.take([&] { return StarCounter<D>{{cells_, adjacency_.neighbors}}; });
            std::size_t in_stars = 0;
            std::size_t in_links = 0;
            for (std::size_t k = begin; k < end; ++k) {
                const auto vertex = static_cast<Index>(first + k);
                const Index soon = usage.one[std::min(k + ahead, end - 1)];
                if (soon != no_index) {
                    stars->prefetch(soon);
                }
                if (usage.one[k] == no_index) {
                    survey.unused.at(first + begin).push_back(vertex);
                    continue;
                }
                const auto star = stars->count(vertex, usage.one[k]);
                in_stars += star.cells;
                if (is_sound(star, usage.cells.empty() ? star.cells : usage.cells[k])) {
                    in_links += star.vertices;
                } else {
                    survey.suspects.at(first + begin).push_back(vertex);
                }
            }
            cells += in_stars;
            link_vertices += in_links;
            counters_.give_back(std::move(stars));
            work_done(end - begin);
        });
        survey.cells += cells;
        survey.link_vertices += link_vertices;
    }

    /// May doubt a sound vertex of an open manifold, never trusts a bad one.
    static bool is_sound(const typename StarCounter<D>::Count& star, std::size_t uses) {
        return star.cells == uses && !star.facet_twice && (D == 2 || 2 * star.vertices == star.cells + 4);
    }

    void report_unused(const std::vector<Index>& unused) {
        report_.counts.vertices = vertex_count_ - unused.size();
        for (const Index v : unused) {
            report(ManifoldDefect::unused_vertex, [&] { return ManifoldFinding{{}, {v}, {}, "in no cell"}; });
        }
    }

    /// Returns the number of vertices in their links.
    std::size_t examine_suspects(const std::vector<Index>& suspects) {
        if (suspects.empty()) {
            return 0;
        }
        std::vector<Index> place(vertex_count_, no_index);
        for (std::size_t k = 0; k < suspects.size(); ++k) {
            place[suspects[k]] = static_cast<Index>(k);
        }
        const CellLists stars =
            list_cells(cells_.size(), suspects.size(), [&](std::size_t c, const auto& file) {
                each_vertex(cells_[c], [&](Index v) {
                    if (place[v] != no_index) {
                        file(place[v]);
                    }
                });
            });
        std::vector<LinkFaults> faults(suspects.size());
        parallel_for(suspects.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                faults[k] = examine_link<D>(suspects[k], stars.of(k), cells_, adjacency_.neighbors);
            }
        });
        std::size_t link_vertices = 0;
        for (std::size_t k = 0; k < suspects.size(); ++k) {
            link_vertices += faults[k].link_vertices;
            if (!tainted(suspects[k])) {
                report_vertex(suspects[k], faults[k], stars.of(k));
            }
        }
        return link_vertices;
    }

    void report_vertex(Index v, const LinkFaults& faults, std::span<const Index> star) {
        for (const Index w : faults.pinches) {
            if (v < w || tainted(w)) { // the other end sees it, too
                report(ManifoldDefect::singular_edge, [&] { return pinched_edge(v, w, star); });
            }
        }
        if (faults.singular_vertex()) {
            report(ManifoldDefect::singular_vertex, [&] {
                return ManifoldFinding{{}, {v}, {star.begin(), star.end()}, vertex_detail(faults)};
            });
        }
    }

    ManifoldFinding pinched_edge(Index v, Index w, std::span<const Index> star) const {
        ManifoldFinding finding{
            {}, {std::min(v, w), std::max(v, w)}, {}, "its cells are more than one cycle"};
        std::copy_if(star.begin(), star.end(), std::back_inserter(finding.cells), [&](Index c) {
            return std::find(cells_[c].begin(), cells_[c].end(), w) != cells_[c].end();
        });
        return finding;
    }

    static std::string vertex_detail(const LinkFaults& faults) {
        if (faults.pieces > 1) {
            return fmt::format("the cells around it fall into {} parts that meet only there", faults.pieces);
        }
        return fmt::format("its link has Euler characteristic {}, a sphere has 2", faults.euler);
    }

    // --- the report
    // ----------------------------------------------------------------------------------------------

    /// Counts a finding; makes it only when it is kept.
    template<class Make>
    void report(ManifoldDefect what, const Make& make) {
        std::size_t& found = report_.found[static_cast<std::size_t>(what)];
        if (found++ < options_.most_findings) {
            report_.findings.push_back(make());
            report_.findings.back().what = what;
        }
    }

    /// If every star is joined through facets, components by shared vertices are those by shared facets, and
    /// vertices are fewer than cells.
    std::size_t components() const {
        if (!adjacency_.defects.empty() || !discredited_.empty() || !sound_) {
            return count_components<D>(adjacency_.neighbors);
        }
        return joined_vertices<D + 1>(cells_, vertex_count_).count_sets() -
               (vertex_count_ - report_.counts.vertices);
    }

    std::span<const Simplex<D>> cells_;
    std::size_t vertex_count_;
    AdjacencyView<D> adjacency_;
    ManifoldOptions options_;
    ManifoldReport report_;
    std::vector<Index> discredited_; ///< cells at fault themselves, ascending
    ScratchPool<StarCounter<D>> counters_;
    bool sound_ = false;        ///< the star and the link of every used vertex are
    std::vector<bool> tainted_; ///< vertices of facets and cells at fault; empty when there are none
};

} // namespace

template<int D>
ManifoldReport examine_manifold(std::span<const Simplex<D>> cells, std::size_t vertex_count,
                                const AdjacencyView<D>& adjacency, const ManifoldOptions& options) {
    return Examination<D>{cells, vertex_count, adjacency, options}.run();
}

template<int D>
std::optional<ManifoldReport> confirm_manifold(std::span<const Simplex<D>> cells, std::size_t vertex_count,
                                               std::span<const Neighbors<D>> claimed) {
    if (claimed.size() != cells.size()) {
        return std::nullopt;
    }
    const WholeMesh<D> mesh{cells, claimed, vertex_count};
    const std::optional<StarCounts> stars = StarConfirmation<D, WholeMesh<D>>{mesh}.run();
    if (!stars) {
        return std::nullopt;
    }
    ManifoldReport report;
    report.counts = closed_counts<D>(cells.size(), *stars);
    report.counts.components = joined_vertices<D + 1>(cells, vertex_count).count_sets();
    return report;
}

template<int D>
std::size_t count_components(std::span<const Neighbors<D>> neighbors) {
    UnionFind components{neighbors.size()};
    for (std::size_t c = 0; c < neighbors.size(); ++c) {
        for (const Index neighbor : neighbors[c]) {
            if (neighbor < c) {
                components.join(static_cast<Index>(c), neighbor);
            }
        }
    }
    return components.count_sets();
}

template ManifoldReport examine_manifold<2>(std::span<const Simplex<2>>, std::size_t, const AdjacencyView<2>&,
                                            const ManifoldOptions&);
template ManifoldReport examine_manifold<3>(std::span<const Simplex<3>>, std::size_t, const AdjacencyView<3>&,
                                            const ManifoldOptions&);
template std::optional<ManifoldReport> confirm_manifold<2>(std::span<const Simplex<2>>, std::size_t,
                                                           std::span<const Neighbors<2>>);
template std::optional<ManifoldReport> confirm_manifold<3>(std::span<const Simplex<3>>, std::size_t,
                                                           std::span<const Neighbors<3>>);
template std::size_t count_components<1>(std::span<const Neighbors<1>>);
template std::size_t count_components<2>(std::span<const Neighbors<2>>);
template std::size_t count_components<3>(std::span<const Neighbors<3>>);

} // namespace slabhull
