// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/cap_blocks.h"
#include "geometry/meshing/cap_in_ranks.h"
#include "geometry/meshing/cap_limits.h"
#include "geometry/meshing/solid_mesher.h"

#include "slabhull/core/communicator.h"
#include "slabhull/core/error.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/geometry/mesh_order.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace slabhull {

namespace {

/// The meshers' indices are ints.
void require_fits(const Surface<3>& surface) {
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<int>::max());
    if (surface.points.size() > most || surface.facets.size() > most / 3) {
        throw LimitError{fmt::format("the 3D mesher cannot number {} points and {} facets",
                                     surface.points.size(), surface.facets.size())};
    }
}

void require_meshable(const Surface<3>& surface, const CapOptions& options) {
    require_fits(surface);
    require_attainable<3>(surface, options.grading.largest);
    if (options.mesher == SolidMesher::tetgen) {
        require_resolvable(surface);
    }
}

void require_sane(const CapOptions& options) {
    if (!(options.radius_edge >= 1 && options.radius_edge <= 100)) {
        throw UsageError{
            fmt::format("the radius-edge bound must be between 1 and 100, not {}", options.radius_edge)};
    }
    if (!(options.min_dihedral >= 0 && options.min_dihedral <= 20)) {
        throw UsageError{fmt::format("the wanted dihedral angle must be between 0 and 20 degrees, not {}",
                                     options.min_dihedral)};
    }
    if (options.blocks < 0 || options.blocks > most_blocks) {
        throw UsageError{
            fmt::format("a cap is meshed in 1 to {} blocks, or 0 to choose them by memory, not {}",
                        most_blocks, options.blocks)};
    }
}

CapMesh<3> finished(CapMesh<3> mesh, const Surface<3>& surface, const CapOptions& options) {
    if (options.curve_order) {
        order_along_curve<3>(mesh, surface.points.size());
    }
    verify_cap(mesh, surface);
    return mesh;
}

} // namespace

template<>
CapMesh<3> mesh_cap<3>(const Surface<3>& surface, const CapOptions& options) {
    require_sane(options);
    require_domain_boundary(surface, {}, false); // meshers crash, or never end, on anything else
    return mesh_cap<3>(Boundary<3>{surface}, surface, options);
}

template<>
CapMesh<3> mesh_cap<3>(const Boundary<3>& boundary, const Surface<3>& surface, const CapOptions& options) {
    require_sane(options);
    const auto mesh = [&] {
        require_meshable(surface, options);
        return finished(mesh_in_blocks(boundary, surface, options), surface, options);
    };
    if (options.ranks == nullptr) {
        return mesh();
    }
    Communicator& ranks = *options.ranks;
    if (options.blocks == 0) {
        throw UsageError{"ranks mesh a cap in a given number of blocks, as their memory may differ"};
    }
    return together(ranks, [&] {
        if (options.blocks == 1) {
            return with_shared_points(ranks.first() ? mesh() : CapMesh<3>{}, ranks);
        }
        if (ranks.first()) {
            require_meshable(surface, options);
        }
        return mesh_in_ranks(boundary, surface, options);
    });
}

} // namespace slabhull
