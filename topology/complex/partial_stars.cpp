// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/topology/partial_stars.h"

#include "topology/complex/star_confirmation.h"

namespace slabhull {

template<int D>
std::optional<StarCounts> confirm_stars(const PartialMesh<D>& mesh) {
    if (mesh.own_neighbors.size() != mesh.own.size() || mesh.ghost_neighbors.size() != mesh.ghosts.size()) {
        return std::nullopt;
    }
    return StarConfirmation<D, PartialMesh<D>>{mesh}.run();
}

template std::optional<StarCounts> confirm_stars<2>(const PartialMesh<2>&);
template std::optional<StarCounts> confirm_stars<3>(const PartialMesh<3>&);

} // namespace slabhull
