// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/mesh_soup.h"

#include "cases/case/patch_names.h"
#include "cases/run/file_facets.h"
#include "cases/run/used_points.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/slab/sweep.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <set>

namespace slabhull {

namespace {

std::string listed(const std::vector<std::int64_t>& numbers) {
    const std::size_t shown = std::min<std::size_t>(numbers.size(), 8);
    return fmt::format("{}{}",
                       fmt::join(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                       shown < numbers.size() ? ", ..." : "");
}

[[noreturn]] void refuse_cells(const io::Soup& soup, const std::vector<std::int64_t>& cells,
                               const std::string& what) {
    std::vector<Entity> entities;
    for (const std::int64_t cell : cells) {
        entities.push_back({"cell", cell, ""});
    }
    throw InputError(fmt::format("{}: {} {}: {}", soup.path, cells.size(), what, listed(cells)),
                     std::move(entities));
}

template<int D>
class DomainBuilder {
public:
    DomainBuilder(const io::Soup& soup, const DomainOptions& options, const Listener& listener)
        : soup_{soup}, options_{options}, listener_{listener},
          chosen_{options.regions.empty() ? io::SimplexBlock{} : cells_of_regions<D>(soup, options.regions)},
          block_{options.regions.empty() ? soup.simplices[D] : chosen_} {}

    SpatialMesh<D> run() {
        if (block_.size(D) == 0) {
            throw InputError(fmt::format("{}: has no {}, which a domain of dimension {} is made of",
                                         soup_.path, D == 3 ? "tetrahedra" : "triangles", D));
        }
        UsedPoints<D> used{soup_, block_.vertices};
        mesh_.points = std::move(used.points);
        mesh_.cells = renumbered<D>(block_, used.number);
        orient_cells();
        connect();
        find_patches(used.number);
        Array<Index> vertices;
        require_domain_boundary(boundary_surface(mesh_, vertices), facet_naming(), true);
        return std::move(mesh_);
    }

private:
    /// Each geometric entity may be oriented either way, but all its cells the same way.
    void orient_cells() {
        std::map<std::int32_t, std::int64_t> balance; // positive minus negative cells of each entity
        std::vector<std::int64_t> flat;
        std::vector<signed char> sign(mesh_.cells.size());
        for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
            const double measure = signed_measure<D>(corners_of<D, D>(mesh_.cells[c], mesh_.points));
            sign[c] = measure > 0 ? 1 : -1;
            balance[entity(c)] += sign[c];
            if (!(measure != 0)) {
                flat.push_back(block_.tag(c));
            }
        }
        if (!flat.empty()) {
            refuse_cells(soup_, flat, "degenerate cells (of measure zero)");
        }
        std::vector<std::int64_t> inverted;
        for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
            if ((balance[entity(c)] >= 0) != (sign[c] > 0)) {
                inverted.push_back(block_.tag(c));
            } else if (sign[c] < 0) {
                std::swap(mesh_.cells[c][0], mesh_.cells[c][1]);
            }
        }
        if (!inverted.empty()) {
            refuse_cells(soup_, inverted, "inverted cells (oriented against the others of their entity)");
        }
    }

    std::int32_t entity(std::size_t cell) const { return block_.entity.empty() ? 0 : block_.entity[cell]; }

    void connect() {
        Adjacency<D> adjacency = build_adjacency<D>(mesh_.cells, mesh_.points.size());
        std::vector<std::int64_t> overfull;
        std::vector<std::int64_t> folded;
        for (const FacetDefect<D>& defect : adjacency.defects) {
            for (const Index cell : defect.cells) {
                if (defect.kind == FacetDefect<D>::Kind::overfull) {
                    overfull.push_back(block_.tag(cell));
                } else if (defect.kind == FacetDefect<D>::Kind::disoriented) {
                    folded.push_back(block_.tag(cell));
                }
            }
        }
        if (!overfull.empty()) {
            refuse_cells(soup_, overfull, "cells meet in a facet of three or more");
        }
        if (!folded.empty()) { // both cells are positive, so they lie on the same side of their facet
            refuse_cells(soup_, folded,
                         "cells overlap a neighbour (both lie on the same side of their facet)");
        }
        mesh_.neighbors = std::move(adjacency.neighbors);
    }

    void find_patches(const std::vector<Index>& number) {
        FileFacets<D> facets{soup_, number};
        const io::SimplexBlock& block = soup_.simplices[D - 1];
        for (Index c = 0; c < mesh_.cells.size(); ++c) {
            for (int i = 0; i <= D; ++i) {
                if (mesh_.neighbors[c][static_cast<std::size_t>(i)] != no_index) {
                    continue;
                }
                const Facet<D> facet = outward_facet<D>(mesh_.cells[c], i);
                const auto found = facets.take(facet);
                mesh_.boundary_facets.push_back(facet);
                mesh_.boundary_patch.push_back(found ? facets.group(*found) : 0);
                facet_tags_.push_back(found ? block.tag(*found) : -1);
            }
        }
        facets.warn_of_repeated(listener_);
        InnerFacets<D>{soup_, block_, mesh_}.tell(facets, options_, listener_);
        name_patches();
    }

    void name_patches() {
        std::map<PatchNumber, std::string> names;
        for (const PatchNumber number : mesh_.boundary_patch) {
            if (number > 0 && !names.contains(number)) {
                names.emplace(number, group_name(soup_.groups[D - 1], number));
                require_patch_name(names.at(number), soup_.path);
            }
        }
        const auto without = std::count(mesh_.boundary_patch.begin(), mesh_.boundary_patch.end(), 0);
        if (without > 0) {
            const PatchNumber number = number_of_rest(names);
            std::replace(mesh_.boundary_patch.begin(), mesh_.boundary_patch.end(), 0, number);
            names.emplace(number, rest_name);
            listener_.warning(
                fmt::format("{}: {} of {} boundary facets are in no physical group; they become the patch "
                            "\"{}\"",
                            soup_.path, without, mesh_.boundary_patch.size(), rest_name));
        }
        for (const auto& [number, name] : names) {
            mesh_.patches.push_back({number, name});
        }
        warn_of_empty_groups();
    }

    void warn_of_empty_groups() const {
        const auto& physical = soup_.simplices[D - 1].physical;
        const std::set<PatchNumber> used(physical.begin(), physical.end());
        std::string empty;
        for (const Patch& group : soup_.groups[D - 1]) {
            if (!used.contains(group.number) && !group.name.empty()) {
                empty += fmt::format("{}\"{}\"", empty.empty() ? "" : ", ", group.name);
            }
        }
        if (!empty.empty()) {
            listener_.warning(fmt::format("{}: groups that have a name, but no {}: {}", soup_.path,
                                          D == 3 ? "triangles" : "lines", empty));
        }
    }

    /// That of the group called so, else the one after the last.
    static PatchNumber number_of_rest(const std::map<PatchNumber, std::string>& names) {
        const auto called = std::find_if(names.begin(), names.end(),
                                         [](const auto& each) { return each.second == rest_name; });
        if (called != names.end()) {
            return called->first;
        }
        PatchNumber number = names.empty() ? 1 : names.rbegin()->first;
        while (names.contains(number)) {
            number = number == std::numeric_limits<PatchNumber>::max() ? 1 : number + 1;
        }
        return number;
    }

    /// Facets by the file's numbers, if it lists them all.
    FacetNaming facet_naming() const {
        const bool all_listed = std::find(facet_tags_.begin(), facet_tags_.end(), -1) == facet_tags_.end();
        return {soup_.path, all_listed ? facet_tags_ : std::vector<std::int64_t>{}};
    }

    static constexpr const char* rest_name = "boundary";

    const io::Soup& soup_;
    const DomainOptions& options_;
    const Listener& listener_;
    const io::SimplexBlock chosen_; ///< cells of the regions, where some are
    const io::SimplexBlock& block_; ///< cells of the domain
    SpatialMesh<D> mesh_;
    std::vector<std::int64_t> facet_tags_; ///< -1: not in the file
};

} // namespace

template<int D>
Surface<D> surface_of_soup(const io::Soup& soup, const Patch& patch) {
    const io::SimplexBlock& block = soup.simplices[D - 1];
    if (block.vertices.empty()) {
        throw InputError(fmt::format("{}: has no {}", soup.path, D == 3 ? "triangles" : "edges"));
    }
    UsedPoints<D> used{soup, block.vertices};
    Surface<D> surface;
    surface.points = std::move(used.points);
    surface.facets = renumbered<D - 1>(block, used.number);
    surface.patch.assign(surface.facets.size(), patch.number);
    surface.patches = {patch};
    return surface;
}

template<int D>
SpatialMesh<D> domain_of_soup(const io::Soup& soup, const DomainOptions& options, const Listener& listener) {
    return DomainBuilder<D>{soup, options, listener}.run();
}

template<int D>
Point<D> point_in_space(const io::Soup& soup, std::size_t v) {
    const Point<3>& x = soup.points[v];
    if constexpr (D == 2) {
        if (x[2] != soup.points[0][2]) {
            throw InputError(
                fmt::format("{}: point {} has z = {}, but a plane mesh (dimension = 2) has one z", soup.path,
                            soup.point_tag(v), x[2]),
                {{"vertex", soup.point_tag(v), ""}});
        }
        return {x[0], x[1]};
    } else {
        return x;
    }
}

template Surface<2> surface_of_soup<2>(const io::Soup&, const Patch&);
template Surface<3> surface_of_soup<3>(const io::Soup&, const Patch&);
template SpatialMesh<2> domain_of_soup<2>(const io::Soup&, const DomainOptions&, const Listener&);
template SpatialMesh<3> domain_of_soup<3>(const io::Soup&, const DomainOptions&, const Listener&);
template Point<2> point_in_space<2>(const io::Soup&, std::size_t);
template Point<3> point_in_space<3>(const io::Soup&, std::size_t);

} // namespace slabhull
