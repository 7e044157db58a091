// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/topology/spatial_mesh.h"
#include "topology/complex/corners.h"
#include "topology/complex/whole_mesh.h"

#include <cstddef>
#include <span>

namespace slabhull {

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

/// Compares facets of a mesh with what is said to be across them: a cell that shares the facet but not all of
/// its vertices, lies on its other side by its orientation, and has the first one as its neighbour there. A
/// facet of four cells passes when they are paired by twos, so this alone does not prove an adjacency. Needs:
/// vertices in range; neighbours may be any numbers.
template<int D, class Mesh>
class FacetPairing {
public:
    explicit FacetPairing(const Mesh& mesh) : mesh_{mesh} {}

    /// How many of the facets of a cell, of those i for which `counts(i)`, are shared, mutually, with cells
    /// that come after it.
    template<class Counts>
    std::size_t pairs_of(Index cell, const Counts& counts) const {
        const Simplex<D>& corners = mesh_.cell(cell);
        const Index all = parity<D>(corners);
        std::size_t pairs = 0;
        for (std::size_t i = 0; i <= D; ++i) {
            const Index across = mesh_.neighbor(cell, i);
            if (across <= cell || across >= mesh_.size() || !counts(i)) {
                continue;
            }
            pairs += agree(cell, i, across, all) ? 1 : 0;
        }
        return pairs;
    }

private:
    /// `all`: the parity of the cell. A cell that shares a facet and has the same parity has the same
    /// vertices.
    bool agree(Index cell, std::size_t i, Index across, Index all) const {
        const Simplex<D>& corners = mesh_.cell(cell);
        const Simplex<D>& others = mesh_.cell(across);
        const Index all_others = parity<D>(others);
        const std::size_t place = place_of<D>(all_others ^ all ^ corners[i], others);
        return all != all_others && mesh_.neighbor(across, place) == cell &&
               are_opposite<D>(outward_facet<D>(corners, static_cast<int>(i)),
                               outward_facet<D>(others, static_cast<int>(place)));
    }

    Mesh mesh_;
};

} // namespace slabhull
