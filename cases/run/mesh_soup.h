// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/message.h"
#include "slabhull/io/soup.h"
#include "slabhull/slab/domain.h"
#include "slabhull/topology/spatial_mesh.h"

#include <span>

namespace slabhull {

/// A point of a soup; throws InputError where D = 2 and the soup leaves the plane.
template<int D>
Point<D> point_in_space(const io::Soup& soup, std::size_t v);

/// The facets of a soup as one patch; used points only. Throws InputError when it has no facets or, for D =
/// 2, leaves the plane z = 0.
template<int D>
Surface<D> surface_of_soup(const io::Soup& soup, const Patch& patch);

struct DomainOptions {
    std::vector<std::string> regions; ///< groups of cells that are the domain; empty: all cells
    std::vector<std::string> moving;  ///< patches that a case has tables for
};

/// The D-simplices of a soup, or those of some regions, as a domain, see make_domain(): in the file's order,
/// used points only, patches from the physical groups of the boundary facets. Warnings: facets in no group,
/// which become the patch "boundary"; facets in several groups, of which the first counts; groups on facets
/// inside the domain, which are no boundary. Errors name cells and facets by the file's numbers. Throws
/// UsageError, too, for an unknown region and for a moving patch that lies inside.
template<int D>
Domain<D> domain_of_soup(const io::Soup& soup, const DomainOptions& options, const IdCounter& ids,
                         const Listener& listener);

} // namespace slabhull
