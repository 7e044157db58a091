// SPDX-License-Identifier: BSD-3-Clause
#include "topology/complex/facet_pairing.h"

#include "slabhull/core/parallel.h"

#include <atomic>

namespace slabhull {

template<int D>
bool pairs_facets(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> claimed) {
    if (claimed.size() != cells.size()) {
        return false;
    }
    const FacetPairing<D, WholeMesh<D>> pairing{{cells, claimed}};
    std::atomic<std::size_t> pairs{0};
    parallel_for(cells.size(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        std::size_t found = 0;
        for (std::size_t c = begin; c < end; ++c) {
            found += pairing.pairs_of(static_cast<Index>(c), [](std::size_t) { return true; });
        }
        pairs += found;
    });
    return 2 * pairs == cells.size() * (D + 1); // no half-facet is in two of them
}

template bool pairs_facets<2>(std::span<const Simplex<2>>, std::span<const Neighbors<2>>);
template bool pairs_facets<3>(std::span<const Simplex<3>>, std::span<const Neighbors<3>>);

} // namespace slabhull
