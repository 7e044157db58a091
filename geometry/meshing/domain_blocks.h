// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/meshing/domain_load.h"

#include "slabhull/geometry/size_field.h"
#include "slabhull/topology/boundary.h"

#include <vector>

namespace slabhull {

/// A domain cut in blocks, each of which is bounded by facets of its boundary and of interfaces.
struct DomainBlocks {
    Array<Point<3>> points; ///< the boundary's, then those inside interfaces
    /// Of each block, outward: an interface's facets are in two, once either way round.
    std::vector<Array<Facet<3>>> facets;
};

/// Cuts the domain inside a boundary that lies as in `surface` in `count` blocks that want about as many
/// cells each, halving by halving: along the shortest curves on the boundary near a plane, and between them
/// across the domain. Interfaces have the wanted spacing and good angles, run square to the boundary where
/// that can be had, keep off what lies along them, and cross nothing (exactly). A block that no plane cuts so
/// is left whole: there may be fewer. `load` is that of the domain. Deterministic. Needs: the boundary of a
/// domain, see require_domain_boundary().
DomainBlocks cut_domain(const Boundary<3>& boundary, const Surface<3>& surface, const SizeField<3>& size,
                        double growth, std::vector<LoadSample> load, int count);

/// A block by itself, and which of the points each of its is, ascending.
struct BlockSurface {
    Surface<3> surface;
    Array<Index> vertex;
};
BlockSurface surface_of_block(const Array<Point<3>>& points, const Array<Facet<3>>& facets);

} // namespace slabhull
