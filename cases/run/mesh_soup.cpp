// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/mesh_soup.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/geometry/measures.h"
#include "slabhull/slab/sweep.h"
#include "slabhull/topology/adjacency.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace slabhull {

namespace {

/// The points that some simplices use, in their order, and the way from the soup's numbers to theirs.
template<int D>
struct UsedPoints {
    Array<Point<D>> points;
    std::vector<Index> number; ///< of each soup point; no_index when unused

    UsedPoints(const io::Soup& soup, std::span<const Index> vertices) : number(soup.points.size(), no_index) {
        for (const Index v : vertices) {
            number[v] = 0;
        }
        for (std::size_t v = 0; v < number.size(); ++v) {
            if (number[v] == 0) {
                number[v] = static_cast<Index>(points.size());
                points.push_back(point_in_space<D>(soup, v));
            }
        }
    }
};

template<int K>
Array<Simplex<K>> renumbered(const io::SimplexBlock& block, const std::vector<Index>& number) {
    Array<Simplex<K>> simplices(block.size(K));
    for (std::size_t i = 0; i < simplices.size(); ++i) {
        for (std::size_t k = 0; k <= K; ++k) {
            simplices[i][k] = number[block.vertices[i * (K + 1) + k]];
        }
    }
    return simplices;
}

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
    DomainBuilder(const io::Soup& soup, const Listener& listener)
        : soup_{soup}, listener_{listener}, block_{soup.simplices[D]} {}

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

    /// The facets of the file by their vertices, to look up groups and numbers.
    std::map<Facet<D>, std::size_t> facets_by_vertices(const std::vector<Index>& number) const {
        std::map<Facet<D>, std::size_t> facets;
        const auto listed_facets = renumbered<D - 1>(soup_.simplices[D - 1], number);
        for (std::size_t f = 0; f < listed_facets.size(); ++f) {
            Facet<D> key = listed_facets[f];
            std::sort(key.begin(), key.end());
            facets.emplace(key, f);
        }
        return facets;
    }

    void find_patches(const std::vector<Index>& number) {
        const auto facets = facets_by_vertices(number);
        const io::SimplexBlock& block = soup_.simplices[D - 1];
        for (Index c = 0; c < mesh_.cells.size(); ++c) {
            for (int i = 0; i <= D; ++i) {
                if (mesh_.neighbors[c][static_cast<std::size_t>(i)] != no_index) {
                    continue;
                }
                const Facet<D> facet = outward_facet<D>(mesh_.cells[c], i);
                Facet<D> key = facet;
                std::sort(key.begin(), key.end());
                const auto found = facets.find(key);
                const bool grouped = found != facets.end() && !block.physical.empty();
                mesh_.boundary_facets.push_back(facet);
                mesh_.boundary_patch.push_back(grouped ? block.physical[found->second] : 0);
                facet_tags_.push_back(found != facets.end() ? block.tag(found->second) : -1);
            }
        }
        name_patches();
    }

    void name_patches() {
        std::map<PatchNumber, std::string> names;
        PatchNumber largest = 0;
        for (const PatchNumber number : mesh_.boundary_patch) {
            if (number > 0) {
                names.emplace(number, fmt::format("{}", number)); // a group without a name goes by its number
                largest = std::max(largest, number);
            }
        }
        for (const Patch& group : soup_.groups[D - 1]) {
            const auto found = names.find(group.number);
            if (found != names.end() && !group.name.empty()) {
                found->second = group.name;
            }
        }
        const auto without = std::count(mesh_.boundary_patch.begin(), mesh_.boundary_patch.end(), 0);
        if (without > 0) {
            std::replace(mesh_.boundary_patch.begin(), mesh_.boundary_patch.end(), 0, largest + 1);
            names.emplace(largest + 1, "boundary");
            listener_.warning(
                fmt::format("{}: {} of {} boundary facets are in no physical group; they become the patch "
                            "\"boundary\"",
                            soup_.path, without, mesh_.boundary_patch.size()));
        }
        for (const auto& [number, name] : names) {
            mesh_.patches.push_back({number, name});
        }
    }

    /// Facets by the file's numbers, if it lists them all.
    FacetNaming facet_naming() const {
        const bool all_listed = std::find(facet_tags_.begin(), facet_tags_.end(), -1) == facet_tags_.end();
        return {soup_.path, all_listed ? facet_tags_ : std::vector<std::int64_t>{}};
    }

    const io::Soup& soup_;
    const Listener& listener_;
    const io::SimplexBlock& block_;
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
SpatialMesh<D> domain_of_soup(const io::Soup& soup, const Listener& listener) {
    return DomainBuilder<D>{soup, listener}.run();
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
template SpatialMesh<2> domain_of_soup<2>(const io::Soup&, const Listener&);
template SpatialMesh<3> domain_of_soup<3>(const io::Soup&, const Listener&);
template Point<2> point_in_space<2>(const io::Soup&, std::size_t);
template Point<3> point_in_space<3>(const io::Soup&, std::size_t);

} // namespace slabhull
