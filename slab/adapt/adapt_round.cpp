// SPDX-License-Identifier: BSD-3-Clause
#include "slab/adapt/adapt_round.h"

#include "core/pieces.h"
#include "slab/adapt/cavity_apex.h"
#include "slab/adapt/cavity_maker.h"
#include "slab/adapt/cell_quality.h"
#include "slabhull/core/parallel.h"
#include "slabhull/core/vector.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace slabhull {

namespace {

constexpr std::size_t items_per_scan = 1 << 13;
// Lengths of edges on the boundary at which they ask for an operation. They are to stay from 0.6 to 1.6, and
// not all that ask can be served in a round.
constexpr double boundary_shortest = 0.75;
constexpr double boundary_longest = 1.35;

/// Shortest edge that the split of an edge may make: 0.72, falling to 0.55 for an edge of 1.6.
double least_after_split(double ratio) {
    return 0.72 - 0.7 * (ratio - boundary_longest);
}
/// Longest edge that the collapse of an edge may make: 1.3, rising to 1.6 for an edge of 0.6.
double most_after_collapse(double ratio) {
    return std::min(1.6, 1.3 + 2 * (boundary_shortest - ratio));
}

/// What asks for an operation: an edge of the wrong length, or a cell of small angles.
struct Wish {
    double urgency; ///< above 1
    Index first;    ///< the edge's vertices, ascending; or the cell and no_index
    Index second;
    double ratio;             ///< the edge's length over its target; 0 of an edge to be flipped
    bool on_boundary = false; ///< the edge is

    bool of_cell() const { return second == no_index; }
};

template<int D>
class RoundChooser {
public:
    RoundChooser(const AdaptMesh<D>& mesh, const BoundaryOperations<D>* boundary,
                 const std::array<double, 2>& times, const AdaptOptions& options, AdaptReport& report)
        : mesh_{mesh}, boundary_{boundary}, times_{times}, options_{options}, report_{report},
          taken_(mesh.cells.size(), 0), maker_{mesh, &taken_, boundary}, wanted_{quality_of_angle(
                                                                             1.8 * options.angle)},
          wanted_at_least_{quality_of_angle(options.angle)}, bearable_{quality_of_angle(0.8 * options.angle)},
          bearable_at_most_{quality_of_angle(0.4 * options.angle)} {}

    std::vector<Cavity<D>> run() {
        touched_.assign(boundary_ != nullptr ? mesh_.now.size() : 0, untouched);
        for (const Wish& wish : wishes()) {
            if (std::optional<Cavity<D>> cavity = best_for(wish)) {
                take(std::move(*cavity));
            }
        }
        return std::move(chosen_);
    }

private:
    std::vector<Wish> wishes() const {
        std::vector<Wish> all =
            parallel_gather<Wish>(mesh_.cells.size(), items_per_scan,
                                  [&](std::size_t begin, std::size_t end, std::vector<Wish>& list) {
                                      for (std::size_t c = begin; c < end; ++c) {
                                          add_wishes(static_cast<Index>(c), list);
                                      }
                                  });
        std::sort(all.begin(), all.end(), [](const Wish& a, const Wish& b) {
            return a.urgency != b.urgency ? a.urgency > b.urgency
                                          : std::pair{a.first, a.second} < std::pair{b.first, b.second};
        });
        const auto same = [](const Wish& a, const Wish& b) {
            return a.first == b.first && a.second == b.second;
        };
        all.erase(std::unique(all.begin(), all.end(), same), all.end());
        return all;
    }

    void add_wishes(Index c, std::vector<Wish>& list) const {
        const Simplex<D>& cell = mesh_.cells[c];
        for (std::size_t i = 0; i <= D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                const Index a = std::min(cell[i], cell[j]);
                const Index b = std::max(cell[i], cell[j]);
                if (boundary_ != nullptr && on_boundary_facet(c, i, j)) {
                    add_boundary_wish(a, b, list);
                    continue;
                }
                const double ratio = mesh_.length_ratio(a, b);
                const double urgency = std::max(ratio / options_.longest, options_.shortest / ratio);
                if (urgency > 1) {
                    list.push_back({urgency, a, b, ratio});
                }
            }
        }
        if (const double quality = quality_of(c); quality < wanted_) {
            list.push_back({wanted_ / std::max(quality, 1e-3 * wanted_), c, no_index, 0});
        }
    }

    void add_boundary_wish(Index a, Index b, std::vector<Wish>& list) const {
        constexpr double least_urgency = 1.0001;
        const double ratio = boundary_->length_ratio(a, b);
        const double urgency = std::max(ratio / boundary_longest, boundary_shortest / ratio);
        if (urgency > 1) {
            list.push_back({urgency, a, b, ratio, true});
        } else if (boundary_->wants_flip(a, b)) {
            list.push_back({least_urgency, a, b, 0, true});
        }
    }

    /// Whether a cell has a facet on the boundary with its corners i and j.
    bool on_boundary_facet(Index cell, std::size_t i, std::size_t j) const {
        for (std::size_t k = 0; k <= D; ++k) {
            if (k != i && k != j && mesh_.neighbors[cell][k] == no_index) {
                return true;
            }
        }
        return false;
    }

    double quality_of(Index cell) const {
        return cell_quality(corners_of<D, D>(mesh_.cells[cell], mesh_.now));
    }

    std::optional<Cavity<D>> best_for(const Wish& wish) {
        constexpr double notably = 1.1;
        if (wish.of_cell()) {
            maker_.demand(notably, 1); // the worst cell must become better
            return taken_[wish.first] != 0 ? std::nullopt : better_cells(wish.first);
        }
        // no smaller angles than there were, unless these are bearable
        const bool urgent = wish.on_boundary && wish.urgency > 1.2;
        maker_.demand(1, urgent ? bearable_at_most_ : bearable_);
        if (wish.ratio == 0) {
            return admitted(maker_.remove_edge(wish.first, wish.second));
        }
        if (wish.on_boundary) {
            return better_boundary_edge(wish);
        }
        if (wish.ratio > 1) {
            return admitted(maker_.split(wish.first, wish.second));
        }
        for (const auto& [ending, kept] : {std::pair{wish.second, wish.first}, {wish.first, wish.second}}) {
            if (auto cavity = admitted(maker_.collapse(ending, kept))) {
                return cavity;
            }
        }
        return std::nullopt;
    }

    /// Splits or collapses an edge of the boundary; if that cannot be, shifts one of its vertices.
    std::optional<Cavity<D>> better_boundary_edge(const Wish& wish) {
        constexpr double urgent = 1.05;
        if (wish.ratio > 1) {
            if (auto cavity = admitted(maker_.split_boundary(wish.first, wish.second))) {
                return cavity;
            }
        } else {
            for (const auto& [ending, kept] :
                 {std::pair{wish.second, wish.first}, {wish.first, wish.second}}) {
                if (auto cavity = admitted(maker_.collapse_boundary(ending, kept))) {
                    return cavity;
                }
            }
        }
        for (const Index vertex : {wish.second, wish.first}) {
            if (wish.urgency > urgent) {
                if (auto cavity = admitted(maker_.shift_boundary(vertex))) {
                    return cavity;
                }
            }
        }
        return std::nullopt;
    }

    /// The operation at a cell of small angles whose new cells are best: a flip if one helps.
    std::optional<Cavity<D>> better_cells(Index c) {
        std::optional<Cavity<D>> best;
        const auto consider = [&](std::optional<Cavity<D>>&& cavity) {
            if (cavity && (!best || cavity->quality > best->quality)) {
                if (auto admissible = admitted(std::move(cavity))) {
                    best = std::move(admissible);
                }
            }
        };
        const Simplex<D> cell = mesh_.cells[c];
        for (std::size_t i = 0; i <= D; ++i) {
            consider(maker_.flip_facet(c, i));
            for (std::size_t j = 0; D == 3 && j < i; ++j) {
                consider(maker_.remove_edge(cell[i], cell[j]));
            }
        }
        if (best || !(quality_of(c) < wanted_at_least_)) {
            return best;
        }
        for (std::size_t i = 0; i <= D; ++i) {
            for (std::size_t j = 0; j <= D; ++j) {
                if (j != i) {
                    consider(maker_.collapse(cell[i], cell[j]));
                }
                if (j < i) {
                    consider(maker_.split(cell[i], cell[j]));
                }
            }
        }
        return best;
    }

    /// The cavity if it keeps lengths and can be coned.
    std::optional<Cavity<D>> admitted(std::optional<Cavity<D>>&& cavity) {
        if (!cavity || !keeps_lengths(*cavity) || !is_free(*cavity)) {
            return std::nullopt;
        }
        if (!find_apex(mesh_, times_, *cavity)) {
            ++report_.refused;
            return std::nullopt;
        }
        return std::move(cavity);
    }

    // On the boundary, where edges begin and end may be told only for one operation at a time: vertices
    // around a collapse or a flip take part in no other, those around splits only in splits.
    enum : std::uint8_t { untouched = 0, at_split = 1, at_other = 2 };

    bool is_free(const Cavity<D>& cavity) const {
        const bool split = cavity.kind == OperationKind::split;
        return std::none_of(
            cavity.side_removed.begin(), cavity.side_removed.end(), [&](const Facet<D>& facet) {
                return std::any_of(facet.begin(), facet.end(),
                                   [&](Index v) { return touched_[v] > (split ? at_split : untouched); });
            });
    }

    /// Whether no new edge has a wrong length. Of operations on the boundary, only edges there count: those
    /// inside are mended by the next rounds.
    bool keeps_lengths(const Cavity<D>& cavity) const {
        if (cavity.on_boundary()) {
            return keeps_boundary_lengths(cavity);
        }
        const double longest = std::max(
            options_.longest, cavity.kind == OperationKind::flip ? longest_of(cavity) : options_.longest);
        for (const Simplex<D>& cell : cavity.added) {
            for (std::size_t i = 0; i <= D; ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    if (!keeps_length(cavity, cell[i], cell[j], longest)) {
                        return false;
                    }
                }
            }
        }
        return true;
    }

    /// The more urgent an operation is, the longer and the shorter the edges may be that it makes.
    bool keeps_boundary_lengths(const Cavity<D>& cavity) const {
        double shortest = 0;
        double longest = std::numeric_limits<double>::infinity();
        switch (cavity.kind) {
        case OperationKind::split:
            shortest = least_after_split(boundary_->length_ratio(cavity.edge[0], cavity.edge[1]));
            break;
        case OperationKind::collapse:
            longest = most_after_collapse(boundary_->length_ratio(cavity.edge[0], cavity.edge[1]));
            break;
        case OperationKind::flip:
            longest = options_.longest;
            break;
        case OperationKind::shift:
            return true; // it is made only if it improves them
        }
        for (const Facet<D>& facet : cavity.side.added) {
            for (std::size_t i = 0; i < D; ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    const double made = boundary_->length_ratio(facet[i], facet[j], cavity);
                    if (made < shortest || made > longest) {
                        return false;
                    }
                }
            }
        }
        return true;
    }

    bool keeps_length(const Cavity<D>& cavity, Index a, Index b, double longest) const {
        constexpr Index made = Cavity<D>::new_vertex;
        if (a == made || b == made) {
            constexpr double share = 0.5; // of the shortest: the next rounds do the rest
            return ratio_to_new(cavity, a == made ? b : a) > share * options_.shortest;
        }
        return cavity.kind == OperationKind::split || !(mesh_.length_ratio(a, b) > longest) ||
               was_edge(cavity, a, b);
    }

    double ratio_to_new(const Cavity<D>& cavity, Index v) const {
        return 2 * distance(mesh_.now[v], cavity.new_place) / (mesh_.target[v] + cavity.new_target);
    }

    double longest_of(const Cavity<D>& cavity) const {
        double longest = 0;
        for (const Index c : cavity.removed) {
            for (std::size_t i = 0; i <= D; ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    longest = std::max(longest, mesh_.length_ratio(mesh_.cells[c][i], mesh_.cells[c][j]));
                }
            }
        }
        return longest;
    }

    bool was_edge(const Cavity<D>& cavity, Index a, Index b) const {
        return std::any_of(cavity.removed.begin(), cavity.removed.end(), [&](Index c) {
            return place_in<D>(mesh_.cells[c], a) <= D && place_in<D>(mesh_.cells[c], b) <= D;
        });
    }

    std::size_t& count_of(OperationKind kind) {
        switch (kind) {
        case OperationKind::split:
            return report_.splits;
        case OperationKind::collapse:
            return report_.collapses;
        case OperationKind::flip:
            return report_.flips;
        case OperationKind::shift:
            break;
        }
        return report_.shifts;
    }

    void take(Cavity<D>&& cavity) {
        for (const Index cell : cavity.removed) {
            taken_[cell] = 1;
        }
        count_of(cavity.kind) += 1;
        report_.on_boundary += cavity.on_boundary() ? 1 : 0;
        for (const Facet<D>& facet : cavity.side_removed) {
            for (const Index v : facet) {
                touched_[v] = cavity.kind == OperationKind::split ? at_split : at_other;
            }
        }
        chosen_.push_back(std::move(cavity));
    }

    const AdaptMesh<D>& mesh_;
    const BoundaryOperations<D>* boundary_;
    std::array<double, 2> times_;
    const AdaptOptions& options_;
    AdaptReport& report_;
    std::vector<std::uint8_t> taken_; ///< of each cell: whether a chosen operation removes it
    CavityMaker<D> maker_;
    double wanted_;           ///< quality below which a cell asks for a flip
    double wanted_at_least_;  ///< ... or for any operation
    double bearable_;         ///< quality that an operation for lengths may leave ...
    double bearable_at_most_; ///< ... and an urgent one on the boundary
    std::vector<Cavity<D>> chosen_;
    std::vector<std::uint8_t> touched_; ///< of each vertex on an adapted boundary
};

} // namespace

template<int D>
std::vector<Cavity<D>> choose_operations(const AdaptMesh<D>& mesh, const BoundaryOperations<D>* boundary,
                                         const std::array<double, 2>& times, const AdaptOptions& options,
                                         AdaptReport& report) {
    return RoundChooser<D>{mesh, boundary, times, options, report}.run();
}

template<int D>
std::array<double, 2> length_ratios(const AdaptMesh<D>& mesh) {
    std::array<double, 2> found{std::numeric_limits<double>::infinity(), 0};
    for (const Simplex<D>& cell : mesh.cells) {
        for (std::size_t i = 0; i <= D; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                if (mesh.on_boundary[cell[i]] == 0 || mesh.on_boundary[cell[j]] == 0) {
                    const double ratio = mesh.length_ratio(cell[i], cell[j]);
                    found = {std::min(found[0], ratio), std::max(found[1], ratio)};
                }
            }
        }
    }
    return found;
}

template std::vector<Cavity<2>> choose_operations<2>(const AdaptMesh<2>&, const BoundaryOperations<2>*,
                                                     const std::array<double, 2>&, const AdaptOptions&,
                                                     AdaptReport&);
template std::vector<Cavity<3>> choose_operations<3>(const AdaptMesh<3>&, const BoundaryOperations<3>*,
                                                     const std::array<double, 2>&, const AdaptOptions&,
                                                     AdaptReport&);
template std::array<double, 2> length_ratios<2>(const AdaptMesh<2>&);
template std::array<double, 2> length_ratios<3>(const AdaptMesh<3>&);

} // namespace slabhull
