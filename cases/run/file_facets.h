// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cases/run/mesh_soup.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace slabhull {

/// A group's name or, where it has none, its number.
std::string group_name(const PatchList& groups, PatchNumber number);

/// The cells of some groups, by name or number. Throws UsageError for one that the soup has not.
template<int D>
io::SimplexBlock cells_of_regions(const io::Soup& soup, const std::vector<std::string>& regions);

/// The facets that a file lists, to be looked up by their vertices.
template<int D>
class FileFacets {
public:
    /// `number` gives the vertices' numbers in the domain; no_index for those that it has not.
    FileFacets(const io::Soup& soup, const std::vector<Index>& number);

    /// The facet with these vertices, which is known for the boundary's from now on.
    std::optional<std::size_t> take(Facet<D> vertices);
    PatchNumber group(std::size_t facet) const {
        return soup_.simplices[D - 1].physical.empty() ? 0 : soup_.simplices[D - 1].physical[facet];
    }
    /// The facet with these vertices if it is in a group and no one's boundary.
    std::optional<std::size_t> find_left(Facet<D> vertices) const;
    bool any_left() const;
    /// Facets that are listed for several groups count for the first.
    void warn_of_repeated(const Listener& listener) const;

private:
    const io::Soup& soup_;
    std::map<Facet<D>, std::size_t> facets_;
    std::vector<bool> taken_;
    std::map<std::pair<PatchNumber, PatchNumber>, std::size_t> repeated_; ///< facets by both groups
};

/// The groups on facets that lie inside a domain.
template<int D>
class InnerFacets {
public:
    InnerFacets(const io::Soup& soup, const io::SimplexBlock& cells, const SpatialMesh<D>& mesh)
        : soup_{soup}, cells_{cells}, mesh_{mesh} {}

    /// Warns of them; throws UsageError where one is to move.
    void tell(const FileFacets<D>& facets, const DomainOptions& options, const Listener& listener);

private:
    struct Interface {
        std::size_t facets = 0;
        std::set<PatchNumber> regions; ///< on either side
    };

    void collect(const FileFacets<D>& facets);
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
