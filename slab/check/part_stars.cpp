// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/part_stars.h"

#include "slab/check/ghost_cells.h"
#include "slab/check/part_exchange.h"
#include "slabhull/core/index.h"
#include "slabhull/slab/hull_part.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace slabhull {

namespace {

template<int D>
struct GhostOfCheck : GhostCell<D> {
    std::uint8_t region;
};

template<int D>
class StarCompletion {
public:
    StarCompletion(const HullPart<D>& part, const HullView<D>& view, Communicator& ranks)
        : part_{part}, view_{view}, ranks_{ranks} {}

    PartStars<D> run() {
        Array<std::int32_t> owners;
        owners.assign(part_.points.size(), ranks_.rank());
        owners = lowest_at_points<std::int32_t>(part_, ranks_, owners);
        PartStars<D> stars;
        stars.owned = owned_by(owners, ranks_);
        exchange(cells_of_others(owners));
        number_ghosts(stars);
        return stars;
    }

private:
    /// The part's cells at vertices of each other owner.
    std::vector<Array<Index>> cells_of_others(const Array<std::int32_t>& owners) const {
        std::vector<Array<Index>> cells(static_cast<std::size_t>(ranks_.size()));
        for (std::size_t c = 0; c < part_.cells.size(); ++c) {
            each_owner<D>(part_.cells[c], owners, [&](std::int32_t owner) {
                if (owner != ranks_.rank()) {
                    cells[static_cast<std::size_t>(owner)].push_back(static_cast<Index>(c));
                }
            });
        }
        return cells;
    }

    /// Sends cells to the owners of their vertices, and receives those at its own.
    void exchange(const std::vector<Array<Index>>& cells) {
        std::vector<Array<GhostOfCheck<D>>> ghosts(cells.size());
        std::vector<Array<std::uint64_t>> points(cells.size());
        for (std::size_t r = 0; r < cells.size(); ++r) {
            if (cells[r].empty()) {
                continue;
            }
            PointSet sent{part_.points.size()};
            insert_points_of<D>(part_, cells[r], sent);
            sent.count();
            points[r] = numbers_of(part_, sent);
            for (const Index c : cells[r]) {
                ghosts[r].push_back(
                    {ghost_cell<D>(part_, c, sent), static_cast<std::uint8_t>(view_.region_of(c))});
            }
        }
        ghosts_ = ranks_.all_to_all(ghosts);
        points_ = ranks_.all_to_all(points);
    }

    /// Ranks are in the order of cells.
    GhostNumbering<D> numbering() const {
        GhostNumbering<D> numbers{part_, joined(points_), numbers_of_ghosts(ghosts_), {}};
        checked_index(numbers.cell_count(), "cells of a part");
        return numbers;
    }

    void number_ghosts(PartStars<D>& stars) const {
        const GhostNumbering<D> numbers = numbering();
        stars.owned.resize(numbers.point_count(), 0);
        stars.outside = numbers.outside();
        const std::size_t count = numbers.cell_count() - part_.cells.size();
        stars.ghosts.reserve(count);
        stars.ghost_neighbors.reserve(count);
        stars.ghost_region.reserve(count);
        for (std::size_t r = 0; r < ghosts_.size(); ++r) {
            const Array<Index> points = numbers.points(points_[r]);
            for (const GhostOfCheck<D>& ghost : ghosts_[r]) {
                numbers.append(ghost, points, stars.ghosts, stars.ghost_neighbors);
                stars.ghost_region.push_back(ghost.region);
            }
        }
    }

    const HullPart<D>& part_;
    const HullView<D>& view_;
    Communicator& ranks_;
    std::vector<Array<GhostOfCheck<D>>> ghosts_; ///< from each rank
    std::vector<Array<std::uint64_t>> points_;   ///< theirs
};

} // namespace

template<int D>
PartStars<D> complete_stars(const HullPart<D>& part, const HullView<D>& view, Communicator& ranks) {
    return StarCompletion<D>{part, view, ranks}.run();
}

template PartStars<2> complete_stars<2>(const HullPart<2>&, const HullView<2>&, Communicator&);
template PartStars<3> complete_stars<3>(const HullPart<3>&, const HullView<3>&, Communicator&);

} // namespace slabhull
