// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/embedding_search.h"

#include "core/pieces.h"
#include "geometry/embedding/box_tree.h"
#include "geometry/embedding/cell_pairs.h"
#include "geometry/embedding/group_parting.h"
#include "geometry/embedding/group_stars.h"

#include "slabhull/core/parallel.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

namespace slabhull {

namespace {

/// Result of the search in one range of the groups.
template<int D>
struct Piece {
    PairTally<D> pairs;
    std::size_t group_pairs = 0;
};

/// Decides the remaining pairs of groups: those in unproven stars, and groups that do not touch.
template<int D>
class EmbeddingSearch {
public:
    EmbeddingSearch(const GroupsToPair<D>& all, std::size_t limit)
        : all_{all}, points_{all.points}, cells_{all.mesh.own, all.mesh.ghosts}, groups_{all.groups},
          limit_{limit}, scale_{scale_of_cells<D>(points_, all.mesh.own)}, cell_pairs_{points_, cells_,
                                                                                       scale_} {}

    HullEmbedding<D> run() {
        prove_stars();
        find_degenerate();
        pair_within_stars();
        pair_apart();
        finish();
        return std::move(result_);
    }

private:
    void prove_stars() {
        centres_ = star_centres<D>(groups_, points_.size());
        star_of_.assign(points_.size(), StarState::none);
        for (const Index v : centres_) {
            star_of_[v] = StarState::open;
        }
        all_.complete_groups(centres_);
        std::erase_if(centres_, [&](Index v) { return !all_.is_complete(v); });
        std::vector<char> proven(centres_.size());
        if (!all_.mesh.own_neighbors.empty()) {
            proven = GroupStars<D>{points_, all_.mesh, groups_, scale_}.prove(centres_);
        }
        for (std::size_t k = 0; k < centres_.size(); ++k) {
            if (proven[k] != 0) {
                star_of_[centres_[k]] = StarState::proven;
            }
            result_.proven_stars += proven[k];
        }
        result_.stars = centres_.size();
        all_.complete_stars(star_of_);
        list_open_stars();
    }

    void list_open_stars() {
        centres_.clear();
        for (std::size_t v = 0; v < star_of_.size(); ++v) {
            if (star_of_[v] == StarState::open) {
                centres_.push_back(static_cast<Index>(v));
            }
        }
    }

    bool in_proven_star(std::size_t group) const {
        const auto around = groups_.vertices(group);
        return std::any_of(around.begin(), around.end(),
                           [&](Index v) { return star_of_[v] == StarState::proven; });
    }

    /// Finds cells without extent, which are not paired but reported. Proven stars have none.
    void find_degenerate() {
        degenerate_ = degenerate_cells(0, groups_.own());
        for (const Index c : degenerate_) {
            result_.crossings.push_back({c, c, points_[cells_[c][0]]});
        }
        const std::vector<Index> others = degenerate_cells(groups_.own(), groups_.tested());
        degenerate_.insert(degenerate_.end(), others.begin(), others.end());
        std::sort(degenerate_.begin(), degenerate_.end());
    }

    std::vector<Index> degenerate_cells(std::size_t first_group, std::size_t end_group) const {
        const auto find = [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
            for (std::size_t g = first_group + begin; g < first_group + end; ++g) {
                const std::size_t cells = in_proven_star(g) ? 0 : groups_.cell_count(g);
                for (std::size_t k = 0; k < cells; ++k) {
                    const auto c = static_cast<Index>(groups_.first_cell(g) + k);
                    if (degenerate(corners_of<D, D + 1>(cells_[c], points_))) {
                        found.push_back(c);
                    }
                }
            }
        };
        return parallel_gather<Index>(end_group - first_group, 1 << 12, find);
    }

    /// Calls work(item, piece) for all items. The rounds grow, so that a hull with crossings everywhere ends
    /// soon, with the same result for any number of threads.
    void in_rounds(std::size_t count, const std::function<void(std::size_t item, Piece<D>&)>& work) {
        std::size_t round = 2;
        for (std::size_t first = 0; first < count && result_.crossings.size() <= limit_; first += round) {
            round = first == 0 ? round : std::min<std::size_t>(2 * round, 1 << 14);
            const std::size_t grain = std::max<std::size_t>(1, round / 1024);
            const std::size_t items = std::min(round, count - first);
            const auto work_on = [&](std::size_t begin, std::size_t end, Piece<D>& piece) {
                for (std::size_t k = begin; k < end && piece.pairs.crossings.size() <= limit_; ++k) {
                    work(first + k, piece);
                }
            };
            for (const Piece<D>& piece : parallel_pieces<Piece<D>>(items, grain, work_on)) {
                add(piece);
            }
        }
    }

    void add(const Piece<D>& piece) {
        const auto& found = piece.pairs.crossings;
        result_.crossings.insert(result_.crossings.end(), found.begin(), found.end());
        result_.group_pairs += piece.group_pairs;
        result_.tested_pairs += piece.pairs.tested;
        result_.exact_pairs += piece.pairs.exact;
    }

    void pair_within_stars() {
        in_rounds(centres_.size(), [&](std::size_t k, Piece<D>& piece) {
            const auto groups = groups_.tested_groups_of(centres_[k]);
            for (std::size_t i = 0; i < groups.size() && is_own(groups[i]); ++i) {
                for (std::size_t j = i; j < groups.size(); ++j) {
                    if (is_due(groups[i], groups[j], centres_[k])) {
                        pair_cells(groups[i], groups[j], piece);
                    }
                }
            }
        });
    }

    /// Whether this search decides a pair, of which the first is the lower one.
    bool is_own(Index first) const { return first < groups_.own(); }

    /// Whether two groups are in no common proven star, and `centre` is that of their first common star.
    bool is_due(Index first, Index second, Index centre) const {
        const auto f = groups_.vertices(first);
        const auto g = groups_.vertices(second);
        return std::all_of(f.begin(), f.end(), [&](Index v) {
            return star_of_[v] == StarState::none || (star_of_[v] == StarState::open && v >= centre) ||
                   !std::binary_search(g.begin(), g.end(), v);
        });
    }

    /// Decides pairs of cells whose boxes meet, of two groups or within one.
    void pair_cells(Index first, Index second, Piece<D>& piece) const {
        std::array<Box<D + 1>, CellGroups<D>::most_cells> boxes;
        const Index f = groups_.first_cell(first);
        const Index g = groups_.first_cell(second);
        const std::size_t of_f = groups_.cell_count(first);
        for (std::size_t i = 0; i < of_f; ++i) {
            boxes[i] = extended_box(static_cast<Index>(f + i));
        }
        for (std::size_t j = 0; j < groups_.cell_count(second); ++j) {
            const auto other = static_cast<Index>(g + j);
            const Box<D + 1> box = extended_box(other);
            for (std::size_t i = 0; i < (first == second ? j : of_f); ++i) {
                if (boxes[i].meets(box) && piece.pairs.crossings.size() <= limit_) {
                    cell_pairs_.decide(static_cast<Index>(f + i), other, piece.pairs);
                }
            }
        }
    }

    /// The box of a cell; empty, so that it meets nothing, for a cell without extent.
    Box<D + 1> extended_box(Index cell) const {
        const bool none = std::binary_search(degenerate_.begin(), degenerate_.end(), cell);
        return none ? Box<D + 1>{} : box_of<D>(cells_[cell], points_);
    }

    Box<D + 1> group_box(std::size_t group) const {
        Box<D + 1> box;
        for (const Index v : groups_.vertices(group)) {
            box.include(points_[v]);
        }
        return box;
    }

    /// A cache of the clouds used last.
    struct Clouds {
        static constexpr std::size_t kept = 2 * BoxTree<D + 1>::block;
        std::array<VertexCloud<D + 1>, kept> clouds;
        std::array<Index, kept> groups;
        std::size_t next = 0;

        Clouds() { groups.fill(no_index); }
        const VertexCloud<D + 1>& of(Index group, const EmbeddingSearch& search) {
            const auto found = std::find(groups.begin(), groups.end(), group) - groups.begin();
            if (found < static_cast<std::ptrdiff_t>(kept)) {
                return clouds[static_cast<std::size_t>(found)];
            }
            const std::size_t place = next++ % kept;
            groups[place] = group;
            clouds[place].assign(search.groups_.vertices(group), search.points_, search.scale_);
            return clouds[place];
        }
    };

    /// Pairs of groups that do not touch. Those that touch are in a common star.
    void pair_apart() {
        const BoxTree<D + 1> tree{groups_.tested(), [&](std::size_t group) { return group_box(group); }};
        in_rounds(tree.blocks(), [&](std::size_t block, Piece<D>& piece) {
            Clouds clouds;
            tree.find_pairs(block, [&](Index first, Index second) {
                if (piece.pairs.crossings.size() > limit_ || !is_own(std::min(first, second)) ||
                    touch(first, second)) {
                    return;
                }
                ++piece.group_pairs;
                if (!proven_parted(clouds.of(first, *this), clouds.of(second, *this))) {
                    pair_cells(first, second, piece);
                }
            });
        });
    }

    bool touch(Index first, Index second) const {
        const auto f = groups_.vertices(first);
        const auto g = groups_.vertices(second);
        for (std::size_t i = 0, j = 0; i < f.size() && j < g.size();) {
            if (f[i] == g[j]) {
                return true;
            }
            f[i] < g[j] ? ++i : ++j;
        }
        return false;
    }

    void finish() {
        auto& crossings = result_.crossings;
        std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) {
            return std::tie(a.first, a.second) < std::tie(b.first, b.second);
        });
        if (crossings.size() > limit_) {
            crossings.resize(limit_);
            result_.all_listed = false;
        }
    }

    const GroupsToPair<D>& all_;
    JoinedSpans<Point<D + 1>> points_;
    JoinedSpans<Simplex<D>> cells_;
    const CellGroups<D>& groups_;
    std::size_t limit_;
    Point<D + 1> scale_;
    CellPairs<D> cell_pairs_;
    HullEmbedding<D> result_;
    std::vector<Index> centres_; ///< centres of stars; later only of those that are open
    Array<StarState> star_of_;   ///< by vertex
    std::vector<Index> degenerate_;
};

} // namespace

template<int D>
HullEmbedding<D> search_crossings(const GroupsToPair<D>& all, std::size_t limit) {
    return EmbeddingSearch<D>{all, limit}.run();
}

template HullEmbedding<2> search_crossings<2>(const GroupsToPair<2>&, std::size_t);
template HullEmbedding<3> search_crossings<3>(const GroupsToPair<3>&, std::size_t);

} // namespace slabhull
