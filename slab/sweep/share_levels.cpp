// SPDX-License-Identifier: BSD-3-Clause
#include "slab/sweep/share_levels.h"

#include "slabhull/core/communicator.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace slabhull {

namespace {

/// What a rank has of a level.
enum class Held : std::uint8_t { here, wanted, neither };

template<int D>
Array<Held> levels_held(const Sweep<D>& sweep, const HullRange& wanted) {
    Array<Held> held;
    for (std::size_t level = 0; level < sweep.positions.size(); ++level) {
        held.push_back(sweep.has(level) ? Held::here : wanted.contains(level) ? Held::wanted : Held::neither);
    }
    return held;
}

/// For each level the lowest rank that has it.
std::vector<std::size_t> senders(const std::vector<Array<Held>>& held) {
    std::vector<std::size_t> lowest;
    for (std::size_t level = 0; level < held.front().size(); ++level) {
        const auto sender = std::find_if(held.begin(), held.end(), [level](const Array<Held>& of_rank) {
            return of_rank[level] == Held::here;
        });
        lowest.push_back(static_cast<std::size_t>(sender - held.begin()));
    }
    return lowest;
}

} // namespace

HullRange levels_of(const HullRange& layers) {
    return {layers.first, layers.count + 1};
}

HullRange levels_of_rank(std::size_t layers, const Communicator& ranks) {
    return levels_of(range_of_rank(layers, ranks));
}

template<int D>
void keep_levels(Sweep<D>& sweep, const HullRange& kept) {
    for (std::size_t level = 1; level < sweep.layers(); ++level) {
        if (!kept.contains(level)) {
            sweep.release(level);
        }
    }
}

template<int D>
void share_levels(Sweep<D>& sweep, const HullRange& wanted, Communicator& ranks) {
    const auto here = static_cast<std::size_t>(ranks.rank());
    const std::vector<Array<Held>> held = ranks.all_gather<Held>(levels_held(sweep, wanted));
    const std::vector<std::size_t> sender = senders(held);
    std::vector<Array<Point<D>>> to(held.size());
    for (std::size_t level = 0; level < sender.size(); ++level) {
        for (std::size_t rank = 0; rank < to.size() && sender[level] == here; ++rank) {
            if (held[rank][level] == Held::wanted) {
                const Array<Point<D>>& places = sweep.places(level);
                to[rank].insert(to[rank].end(), places.begin(), places.end());
            }
        }
    }
    keep_levels(sweep, wanted);
    const std::vector<Array<Point<D>>> from = ranks.all_to_all(to);
    std::vector<const Point<D>*> next; // of what each rank has sent
    for (const Array<Point<D>>& list : from) {
        next.push_back(list.data());
    }
    for (std::size_t level = 0; level < sender.size(); ++level) {
        if (held[here][level] == Held::wanted) {
            const Point<D>*& first = next.at(sender[level]);
            sweep.positions[level].assign(first, first + sweep.boundary.vertex_count());
            first += sweep.boundary.vertex_count();
        }
    }
}

template void keep_levels<2>(Sweep<2>&, const HullRange&);
template void keep_levels<3>(Sweep<3>&, const HullRange&);
template void share_levels<2>(Sweep<2>&, const HullRange&, Communicator&);
template void share_levels<3>(Sweep<3>&, const HullRange&, Communicator&);

} // namespace slabhull
