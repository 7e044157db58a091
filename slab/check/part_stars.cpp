// SPDX-License-Identifier: BSD-3-Clause
#include "slab/check/part_stars.h"

#include "slab/check/part_exchange.h"
#include "slabhull/core/index.h"
#include "slabhull/slab/hull_part.h"

#include <algorithm>

namespace slabhull {

namespace {

/// A cell as another rank is told of it, in the numbers of the hull.
template<int D>
struct GhostCell {
    std::uint64_t number;
    std::array<std::uint64_t, D + 1> vertices;
    std::array<std::uint64_t, D + 1> neighbors;
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
        number_vertices(stars);
        number_cells(stars);
        return stars;
    }

private:
    /// Sends the cells at vertices of other owners there, and receives those at its own.
    void exchange(const Array<std::int32_t>& owners) {
        std::vector<Array<GhostCell<D>>> to(static_cast<std::size_t>(ranks_.size()));
        for (std::size_t c = 0; c < part_.cells.size(); ++c) {
            std::array<std::int32_t, D + 1> owner;
            for (std::size_t i = 0; i <= D; ++i) {
                owner[i] = owners[part_.cells[c][i]];
            }
            for (std::size_t i = 0; i <= D; ++i) {
                if (owner[i] != ranks_.rank() &&
                    std::find(owner.begin(), owner.begin() + i, owner[i]) == owner.begin() + i) {
                    to[static_cast<std::size_t>(owner[i])].push_back(as_ghost(c));
                }
            }
        }
        ghosts_ = joined(ranks_.all_to_all(to)); // ranks are in the order of cells
        checked_index(part_.cells.size() + ghosts_.size(), "cells of a part");
    }

    GhostCell<D> as_ghost(std::size_t c) const {
        GhostCell<D> ghost{};
        ghost.number = part_.range.first + c;
        ghost.region = static_cast<std::uint8_t>(view_.region_of(c));
        for (std::size_t i = 0; i <= D; ++i) {
            ghost.vertices[i] = part_.points_used->member(part_.cells[c][i]);
            ghost.neighbors[i] = part_.in_hull(part_.neighbors[c][i]);
        }
        return ghost;
    }

    /// The vertices that only ghosts have come after the part's.
    void number_vertices(PartStars<D>& stars) {
        for (const GhostCell<D>& ghost : ghosts_) {
            for (const std::uint64_t number : ghost.vertices) {
                if (!part_.points_used->contains(number)) {
                    others_.push_back(number);
                }
            }
        }
        sort_out(others_);
        stars.owned.resize(part_.points.size() + others_.size(), 0);
    }

    Index vertex_here(std::uint64_t number) const {
        if (part_.points_used->contains(number)) {
            return static_cast<Index>(part_.points_used->rank(number));
        }
        const auto place = std::lower_bound(others_.begin(), others_.end(), number) - others_.begin();
        return static_cast<Index>(part_.points.size() + static_cast<std::size_t>(place));
    }

    Index cell_here(std::uint64_t number) const {
        if (number - part_.range.first < part_.range.count) {
            return static_cast<Index>(number - part_.range.first);
        }
        const auto place =
            std::lower_bound(ghosts_.begin(), ghosts_.end(), number,
                             [](const GhostCell<D>& ghost, std::uint64_t n) { return ghost.number < n; });
        return place != ghosts_.end() && place->number == number
                   ? static_cast<Index>(part_.cells.size() +
                                        static_cast<std::size_t>(place - ghosts_.begin()))
                   : no_index;
    }

    void number_cells(PartStars<D>& stars) const {
        stars.outside.resize(part_.outside.size());
        std::transform(part_.outside.begin(), part_.outside.end(), stars.outside.begin(),
                       [&](std::uint64_t number) { return cell_here(number); });
        stars.ghosts.reserve(ghosts_.size());
        stars.ghost_neighbors.reserve(ghosts_.size());
        stars.ghost_region.reserve(ghosts_.size());
        for (const GhostCell<D>& ghost : ghosts_) {
            Simplex<D>& cell = stars.ghosts.emplace_back();
            Neighbors<D>& across = stars.ghost_neighbors.emplace_back();
            for (std::size_t i = 0; i <= D; ++i) {
                cell[i] = vertex_here(ghost.vertices[i]);
                across[i] = cell_here(ghost.neighbors[i]);
            }
            stars.ghost_region.push_back(ghost.region);
        }
    }

    const HullPart<D>& part_;
    const HullView<D>& view_;
    Communicator& ranks_;
    Array<GhostCell<D>> ghosts_;
    Array<std::uint64_t> others_; ///< vertices of ghosts alone
};

} // namespace

template<int D>
PartStars<D> complete_stars(const HullPart<D>& part, const HullView<D>& view, Communicator& ranks) {
    return StarCompletion<D>{part, view, ranks}.run();
}

template PartStars<2> complete_stars<2>(const HullPart<2>&, const HullView<2>&, Communicator&);
template PartStars<3> complete_stars<3>(const HullPart<3>&, const HullView<3>&, Communicator&);

} // namespace slabhull
