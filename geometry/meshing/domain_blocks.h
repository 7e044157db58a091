// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/domain_load.h"

#include "slabhull/geometry/size_field.h"
#include "slabhull/topology/boundary.h"

#include <vector>

namespace slabhull {

/// A domain cut into blocks, each bounded by facets of the domain's boundary and of interfaces.
struct DomainBlocks {
    Array<Point<3>> points; ///< the boundary's, then those inside interfaces
    /// Of each block, outward: an interface's facets are in two blocks, with opposite orientations.
    std::vector<Array<Facet<3>>> facets;
};

/// Cuts the domain bounded by `boundary`, with the positions of `surface`, into `count` blocks with about
/// equal numbers of cells, by repeated halving: along the shortest curves on the boundary near a plane, and
/// between them across the domain. Interfaces have the wanted spacing and good angles, meet the boundary at
/// right angles where possible, avoid boundary facets that lie along them, and cross nothing (exactly). A
/// block that no plane cuts so stays whole: there may be fewer. `load` is the domain's. Deterministic. Needs:
/// the boundary of a domain, see require_domain_boundary().
DomainBlocks cut_domain(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                        double growth, std::vector<LoadSample> load, int count);

/// The surface of one block, and for each of its points the number in the whole, ascending.
struct BlockSurface {
    Surface<3> surface;
    Array<Index> vertex;
};
BlockSurface surface_of_block(const Array<Point<3>>& points, const Array<Facet<3>>& facets);

} // namespace slabhull
