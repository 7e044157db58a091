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

/// A cell as another rank is told of it.
template<int D>
struct GhostCell : CellInHull<D> {
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
        stars.owned.resize(owners.size());
        std::transform(owners.begin(), owners.end(), stars.owned.begin(),
                       [&](std::int32_t owner) -> std::uint8_t { return owner == ranks_.rank() ? 1 : 0; });
        exchange(owners);
        number_ghosts(stars);
        return stars;
    }

private:
    /// Sends the cells at vertices of other owners there, and receives those at its own.
    void exchange(const Array<std::int32_t>& owners) {
        std::vector<Array<GhostCell<D>>> to(static_cast<std::size_t>(ranks_.size()));
        for (std::size_t c = 0; c < part_.cells.size(); ++c) {
            each_owner<D>(part_.cells[c], owners, [&](std::int32_t owner) {
                if (owner != ranks_.rank()) {
                    to[static_cast<std::size_t>(owner)].push_back(
                        {cell_in_hull(part_, c), static_cast<std::uint8_t>(view_.region_of(c))});
                }
            });
        }
        ghosts_ = joined(ranks_.all_to_all(to)); // ranks are in the order of cells
        checked_index(part_.cells.size() + ghosts_.size(), "cells of a part");
    }

    LocalNumbering<D> numbering() const {
        Array<std::uint64_t> points;
        Array<std::uint64_t> cells;
        for (const GhostCell<D>& ghost : ghosts_) {
            cells.push_back(ghost.number);
            for (const std::uint64_t number : ghost.vertices) {
                if (!part_.points_used->contains(number)) {
                    points.push_back(number);
                }
            }
        }
        sort_out(points);
        return {part_, std::move(points), std::move(cells), ghosts_.size()};
    }

    void number_ghosts(PartStars<D>& stars) const {
        const LocalNumbering<D> numbers = numbering();
        stars.owned.resize(numbers.point_count(), 0);
        stars.outside = numbers.outside();
        stars.ghosts.reserve(ghosts_.size());
        stars.ghost_neighbors.reserve(ghosts_.size());
        stars.ghost_region.reserve(ghosts_.size());
        for (const GhostCell<D>& ghost : ghosts_) {
            numbers.append(ghost, stars.ghosts, stars.ghost_neighbors);
            stars.ghost_region.push_back(ghost.region);
        }
    }

    const HullPart<D>& part_;
    const HullView<D>& view_;
    Communicator& ranks_;
    Array<GhostCell<D>> ghosts_;
};

} // namespace

template<int D>
PartStars<D> complete_stars(const HullPart<D>& part, const HullView<D>& view, Communicator& ranks) {
    return StarCompletion<D>{part, view, ranks}.run();
}

template PartStars<2> complete_stars<2>(const HullPart<2>&, const HullView<2>&, Communicator&);
template PartStars<3> complete_stars<3>(const HullPart<3>&, const HullView<3>&, Communicator&);

} // namespace slabhull
