// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cases/run/mesh_soup.h"

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace slabhull {

/// The cells of all groups that are called so, as group_name() has it. Throws UsageError for one that the
/// soup does not have.
template<int D>
io::SimplexBlock cells_of_regions(const io::Soup& soup, const std::vector<std::string>& regions);

/// The facets that a file lists, as make_domain() has them.
template<int D>
struct FileFacets {
    Array<Facet<D>> vertices;
    std::vector<PatchNumber> group; ///< 0: none
};

/// Warns of facets that are listed for several groups.
template<int D>
void warn_of_repeated(const io::Soup& soup, const FileFacets<D>& facets, const Domain<D>& domain,
                      const Listener& listener);

/// The groups on facets that lie inside a domain.
template<int D>
class InnerFacets {
public:
    InnerFacets(const io::Soup& soup, const io::SimplexBlock& cells, const SpatialMesh<D>& mesh)
        : soup_{soup}, cells_{cells}, mesh_{mesh} {}

    /// Warns of the facets `inner`; throws UsageError where one is to move.
    void tell(const FileFacets<D>& facets, std::span<const std::size_t> inner, const DomainOptions& options,
              const Listener& listener);

private:
    struct Interface {
        std::size_t facets = 0;
        std::set<PatchNumber> regions; ///< on either side
    };

    void collect(const FileFacets<D>& facets, std::span<const std::size_t> inner);
    void require_still(const DomainOptions& options) const;
    std::string sides(const Interface& interface) const;
    std::string way_out() const;
    PatchNumber region(Index cell) const { return cells_.physical.empty() ? 0 : cells_.physical[cell]; }

    const io::Soup& soup_;
    const io::SimplexBlock& cells_;
    const SpatialMesh<D>& mesh_;
    std::map<PatchNumber, Interface> interfaces_;
};

} // namespace slabhull
