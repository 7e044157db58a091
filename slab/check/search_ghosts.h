// SPDX-License-Identifier: BSD-3-Clause
// What a rank needs of others to prove its part of a hull to be embedded.
#pragma once

#include "core/pieces.h"
#include "geometry/embedding/box_tree.h"
#include "geometry/embedding/cell_groups.h"
#include "geometry/embedding/embedded_caps.h"
#include "slab/check/ghost_cells.h"
#include "slab/check/part_exchange.h"
#include "slabhull/core/array.h"
#include "slabhull/core/communicator.h"
#include "slabhull/core/index.h"
#include "slabhull/core/point_set.h"
#include "slabhull/slab/hull_part.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace slabhull {

/// What one rank sends to another: groups of tested cells, in order, and cells that are not tested but touch
/// tested ones. `Cell`: GhostCell, or before that a cell's number in the part.
template<int D, class Cell>
struct CellsForRank {
    Array<std::uint8_t> sizes; ///< of the groups
    Array<Cell> tested;
    Array<Cell> touching;
    Array<std::uint64_t> points; ///< of the cells, in the hull
    Array<Point<D + 1>> places;  ///< of these points
};

/// The same from all ranks, each list in their order.
template<int D>
struct CellsFromRanks {
    std::vector<Array<std::uint8_t>> sizes;
    std::vector<Array<GhostCell<D>>> tested;
    std::vector<Array<GhostCell<D>>> touching;
    std::vector<Array<std::uint64_t>> points;
    std::vector<Array<Point<D + 1>>> places;
};

/// What one rank's search needs beside its part: the tested cells of later ranks that may meet its own, and
/// cells that are not tested but touch these.
template<int D>
struct GhostsOfSearch {
    GhostNumbering<D> numbers;
    Array<std::uint8_t> sizes;  ///< of the groups of tested ghosts, which come first
    Array<Point<D + 1>> points; ///< that are not the part's
    Array<Simplex<D>> cells;    ///< in the part's points, then `points`
    Array<Neighbors<D>> neighbors;
    PointSet touching; ///< the part's cells that are not tested, but complete a star of this rank's
    Array<std::uint8_t> complete; ///< of the part's points, whether it is this rank that proves their stars
};

/// Brings together the cells that each rank's search needs.
template<int D>
class SearchAssembly {
public:
    /// `groups`: of the part's cells.
    SearchAssembly(const HullPart<D>& part, Communicator& ranks, std::span<const CapOf> caps,
                   const CellGroups<D>& groups)
        : part_{part}, ranks_{ranks}, caps_{caps}, groups_{groups}, touching_{part.cells.size()},
          owners_{lowest_at_points<std::int32_t>(part, ranks, ranks_of_tested_points())} {}

    GhostsOfSearch<D> run() {
        CellsFromRanks<D> sent = exchange();
        GhostsOfSearch<D> ghosts{numbering(sent),      joined(std::move(sent.sizes)), {}, {}, {},
                                 std::move(touching_), owned_by(owners_, ranks_)};
        list_ghosts(sent, ghosts);
        return ghosts;
    }

private:
    static constexpr std::int32_t no_rank = std::numeric_limits<std::int32_t>::max();

    bool is_tested(std::size_t cell) const { return caps_[cell] == CapOf::none; }

    Array<std::int32_t> ranks_of_tested_points() const {
        Array<std::int32_t> result;
        result.assign(part_.points.size(), no_rank);
        for (std::size_t c = 0; c < caps_.size(); ++c) {
            for (const Index v : part_.cells[c]) {
                result[v] = is_tested(c) ? ranks_.rank() : result[v];
            }
        }
        return result;
    }

    // --- what is sent

    Box<D + 1> group_box(std::size_t group) const {
        Box<D + 1> box;
        for (const Index v : groups_.vertices(group)) {
            box.include(part_.points[v]);
        }
        return box;
    }

    /// A box around all tested cells of each later rank that has some.
    Array<Box<D + 1>> boxes_of_later_ranks() const {
        Box<D + 1> own;
        for (std::size_t g = 0; g < groups_.own(); ++g) {
            own.include(group_box(g));
        }
        Array<Box<D + 1>> later;
        const std::vector<Box<D + 1>> all = ranks_.gather(own);
        for (auto r = static_cast<std::size_t>(ranks_.rank()) + 1; r < all.size(); ++r) {
            if (!all[r].empty()) {
                later.push_back(all[r]);
            }
        }
        return later;
    }

    /// Boxes around those of the part's tested cells that later ranks' may meet.
    Array<Box<D + 1>> boxes_for_later_ranks() const {
        constexpr std::size_t most = 1 << 13; // half a megabyte
        const Array<Box<D + 1>> later = boxes_of_later_ranks();
        Array<Box<D + 1>> boxes;
        if (later.empty()) {
            return boxes;
        }
        const BoxTree<D + 1> tree{later};
        for (std::size_t g = 0; g < groups_.own(); ++g) {
            const Box<D + 1> box = group_box(g);
            bool meets = false;
            tree.find(box, [&](Index) { meets = true; });
            if (meets) {
                boxes.push_back(box);
            }
        }
        return boxes.size() <= most ? boxes : BoxTree<D + 1>{boxes}.at_most(most);
    }

    CellsFromRanks<D> exchange() {
        std::vector<CellsForRank<D, Index>> cells(static_cast<std::size_t>(ranks_.size()));
        list_groups_for_others(cells);
        list_touching_cells(cells);
        std::vector<CellsForRank<D, GhostCell<D>>> to(cells.size());
        for (std::size_t r = 0; r < cells.size(); ++r) {
            to[r] = for_rank(std::exchange(cells[r], {}));
        }
        CellsFromRanks<D> received;
        received.sizes = passed(to, &CellsForRank<D, GhostCell<D>>::sizes);
        received.tested = passed(to, &CellsForRank<D, GhostCell<D>>::tested);
        received.touching = passed(to, &CellsForRank<D, GhostCell<D>>::touching);
        received.points = passed(to, &CellsForRank<D, GhostCell<D>>::points);
        received.places = passed(to, &CellsForRank<D, GhostCell<D>>::places);
        return received;
    }

    /// Sends one of the lists to each rank and releases it.
    template<class T>
    std::vector<Array<T>> passed(std::vector<CellsForRank<D, GhostCell<D>>>& to,
                                 Array<T> CellsForRank<D, GhostCell<D>>::*list) const {
        std::vector<Array<T>> lists(to.size());
        for (std::size_t r = 0; r < to.size(); ++r) {
            lists[r] = std::move(to[r].*list);
        }
        return ranks_.all_to_all(lists);
    }

    /// Groups go to the earlier ranks near whose cells they are.
    void list_groups_for_others(std::vector<CellsForRank<D, Index>>& to) const {
        const auto near = ranks_.all_gather<Box<D + 1>>(boxes_for_later_ranks());
        Array<Box<D + 1>> earlier;
        std::vector<std::size_t> rank_of;
        for (std::size_t r = 0; r < static_cast<std::size_t>(ranks_.rank()); ++r) {
            earlier.insert(earlier.end(), near[r].begin(), near[r].end());
            rank_of.resize(earlier.size(), r);
        }
        if (earlier.empty()) {
            return;
        }
        const BoxTree<D + 1> tree{earlier};
        std::vector<std::size_t> targets;
        for (std::size_t g = 0; g < groups_.own(); ++g) {
            targets.clear();
            tree.find(group_box(g), [&](Index box) { targets.push_back(rank_of[box]); });
            sort_out(targets);
            for (const std::size_t r : targets) {
                to[r].sizes.push_back(static_cast<std::uint8_t>(groups_.cell_count(g)));
                for (std::size_t k = 0; k < groups_.cell_count(g); ++k) {
                    to[r].tested.push_back(static_cast<Index>(groups_.first_cell(g) + k));
                }
            }
        }
    }

    /// Cells that are not tested go to the owners of their vertices, which prove the stars.
    void list_touching_cells(std::vector<CellsForRank<D, Index>>& to) {
        for (std::size_t c = 0; c < caps_.size(); ++c) {
            if (is_tested(c)) {
                continue;
            }
            each_owner<D>(part_.cells[c], owners_, [&](std::int32_t owner) {
                if (owner == ranks_.rank()) {
                    touching_.insert(c);
                } else if (owner != no_rank) {
                    to[static_cast<std::size_t>(owner)].touching.push_back(static_cast<Index>(c));
                }
            });
        }
        touching_.count();
    }

    CellsForRank<D, GhostCell<D>> for_rank(CellsForRank<D, Index> cells) const {
        CellsForRank<D, GhostCell<D>> sent{std::move(cells.sizes), {}, {}, {}, {}};
        if (cells.tested.empty() && cells.touching.empty()) {
            return sent;
        }
        PointSet points{part_.points.size()};
        insert_points_of<D>(part_, cells.tested, points);
        insert_points_of<D>(part_, cells.touching, points);
        points.count();
        sent.points = numbers_of(part_, points);
        each_point_in(points.words(),
                      [&](std::size_t, std::size_t v) { sent.places.push_back(part_.points[v]); });
        sent.tested = ghost_cells<D>(part_, cells.tested, points);
        sent.touching = ghost_cells<D>(part_, cells.touching, points);
        return sent;
    }

    // --- what is here

    GhostNumbering<D> numbering(const CellsFromRanks<D>& sent) const {
        GhostNumbering<D> numbers{part_, joined(sent.points), numbers_of_ghosts(sent.tested),
                                  numbers_of_ghosts(sent.touching)};
        checked_index(numbers.cell_count(), "cells of a part");
        return numbers;
    }

    void list_ghosts(const CellsFromRanks<D>& sent, GhostsOfSearch<D>& ghosts) const {
        const GhostNumbering<D>& numbers = ghosts.numbers;
        ghosts.points.resize(numbers.point_count() - part_.points.size());
        ghosts.cells.reserve(numbers.cell_count() - part_.cells.size());
        ghosts.neighbors.reserve(numbers.cell_count() - part_.cells.size());
        std::vector<Array<Index>> points;
        for (std::size_t r = 0; r < sent.points.size(); ++r) {
            points.push_back(numbers.points(sent.points[r]));
            for (std::size_t k = 0; k < points[r].size(); ++k) {
                if (points[r][k] >= part_.points.size()) {
                    ghosts.points[points[r][k] - part_.points.size()] = sent.places[r][k];
                }
            }
        }
        for (const auto* lists : {&sent.tested, &sent.touching}) {
            for (std::size_t r = 0; r < lists->size(); ++r) {
                for (const GhostCell<D>& ghost : (*lists)[r]) {
                    numbers.append(ghost, points[r], ghosts.cells, ghosts.neighbors);
                }
            }
        }
    }

    const HullPart<D>& part_;
    Communicator& ranks_;
    std::span<const CapOf> caps_; ///< of the cells of the part; those in none are tested
    const CellGroups<D>& groups_;
    PointSet touching_;
    Array<std::int32_t>
        owners_; ///< the lowest rank that has a tested cell at each point; no_rank where none has
};

} // namespace slabhull
