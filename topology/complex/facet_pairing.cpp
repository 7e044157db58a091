// SPDX-License-Identifier: BSD-3-Clause
#include "topology/complex/facet_pairing.h"

#include "slabhull/core/parallel.h"
#include "slabhull/topology/spatial_mesh.h"
#include "topology/complex/corners.h"

#include <atomic>

namespace slabhull {

namespace {

/// Whether two facets are the same with opposite orientations: the second is a rotation of the first
/// reversed.
template<int D>
bool are_opposite(const Facet<D>& a, const Facet<D>& b) {
    bool any = false;
    for (std::size_t shift = D == 2 ? 1 : 0; shift < D; ++shift) {
        bool same = true;
        for (std::size_t k = 0; k < D; ++k) {
            same &= a[k] == b[(shift + D - k) % D];
        }
        any |= same;
    }
    return any;
}

template<int D>
class Pairing {
public:
    Pairing(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> claimed)
        : cells_{cells}, claimed_{claimed} {}

    /// How many facets of a cell are shared, mutually, with cells that come after it.
    std::size_t pairs_of(Index cell) const {
        const Simplex<D>& corners = cells_[cell];
        const Index all = parity<D>(corners);
        std::size_t pairs = 0;
        for (std::size_t i = 0; i <= D; ++i) {
            const Index across = claimed_[cell][i];
            if (across <= cell || across >= cells_.size()) {
                continue;
            }
            pairs += agree(cell, i, across, all) ? 1 : 0;
        }
        return pairs;
    }

    bool is_paired(Index cell, std::size_t i) const {
        const Index across = claimed_[cell][i];
        return across < cells_.size() && across != cell && agree(cell, i, across, parity<D>(cells_[cell]));
    }

private:
    /// `all`: the parity of the cell.
    bool agree(Index cell, std::size_t i, Index across, Index all) const {
        const Simplex<D>& corners = cells_[cell];
        const Simplex<D>& others = cells_[across];
        const std::size_t place = place_of<D>(parity<D>(others) ^ all ^ corners[i], others);
        return claimed_[across][place] == cell &&
               are_opposite<D>(outward_facet<D>(corners, static_cast<int>(i)),
                               outward_facet<D>(others, static_cast<int>(place)));
    }

    std::span<const Simplex<D>> cells_;
    std::span<const Neighbors<D>> claimed_;
};

} // namespace

template<int D>
bool pairs_facets(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> claimed) {
    if (claimed.size() != cells.size()) {
        return false;
    }
    const Pairing<D> pairing{cells, claimed};
    std::atomic<std::size_t> pairs{0};
    parallel_for(cells.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        std::size_t found = 0;
        for (std::size_t c = begin; c < end; ++c) {
            found += pairing.pairs_of(static_cast<Index>(c));
        }
        pairs += found;
    });
    return 2 * pairs == cells.size() * (D + 1); // no half-facet is in two of them
}

template<int D>
bool is_paired(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> claimed, Index cell,
               std::size_t i) {
    return Pairing<D>{cells, claimed}.is_paired(cell, i);
}

template bool is_paired<2>(std::span<const Simplex<2>>, std::span<const Neighbors<2>>, Index, std::size_t);
template bool is_paired<3>(std::span<const Simplex<3>>, std::span<const Neighbors<3>>, Index, std::size_t);
template bool pairs_facets<2>(std::span<const Simplex<2>>, std::span<const Neighbors<2>>);
template bool pairs_facets<3>(std::span<const Simplex<3>>, std::span<const Neighbors<3>>);

} // namespace slabhull
