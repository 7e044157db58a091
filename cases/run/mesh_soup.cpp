// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/mesh_soup.h"

#include "cases/case/patch_names.h"
#include "cases/run/file_facets.h"
#include "core/used_vertices.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <set>

namespace slabhull {

namespace {

const char* simplices_called(int dimension) {
    constexpr std::array<const char*, 4> names{"points", "lines", "triangles", "tetrahedra"};
    return names.at(static_cast<std::size_t>(dimension));
}

template<int D>
Array<Point<D>> points_in_space(const io::Soup& soup, const Array<Index>& vertices) {
    Array<Point<D>> points;
    points.reserve(vertices.size());
    for (const Index v : vertices) {
        points.push_back(point_in_space<D>(soup, v));
    }
    return points;
}

/// The K-simplices of a block, with new numbers of their vertices.
template<int K>
Array<Simplex<K>> renumbered(const io::SimplexBlock& block, const Array<Index>& number) {
    Array<Simplex<K>> simplices(block.size(K));
    for (std::size_t i = 0; i < simplices.size(); ++i) {
        for (std::size_t k = 0; k <= K; ++k) {
            simplices[i][k] = number[block.vertices[i * (K + 1) + k]];
        }
    }
    return simplices;
}

/// The facets of a soup whose points all belong to cells, with their groups as patches.
template<int D>
void take_facets(const io::Soup& soup, const Array<Index>& number, DomainInput<D>& input) {
    const io::SimplexBlock& block = soup.simplices[D - 1];
    const Array<Facet<D>> facets = renumbered<D - 1>(block, number);
    for (std::size_t f = 0; f < facets.size(); ++f) {
        if (std::find(facets[f].begin(), facets[f].end(), no_index) == facets[f].end()) {
            input.facets.push_back(facets[f]);
            input.facet_patch.push_back(block.physical.empty() ? 0 : block.physical[f]);
            input.facet_numbers.push_back(block.tag(f));
        }
    }
    input.patches = soup.groups[D - 1];
    input.facets_of_more = true; // a file may have more cells than the domain
}

/// Warns of groups of facets that the domain cannot hold.
template<int D>
void warn_of_facets(const io::Soup& soup, const io::SimplexBlock& cells, const FileFacets<D>& facets,
                    const Domain<D>& domain, const DomainOptions& options, const Listener& listener) {
    warn_of_repeated(soup, facets, domain, listener);
    InnerFacets<D>{soup, cells, domain.mesh}.tell(facets, domain.inner_facets, options, listener);
    if (domain.facets_without_patch > 0) {
        listener.warning(
            fmt::format("{}: {} of {} boundary facets are in no physical group; they become the patch "
                        "\"boundary\"; to move some of them by themselves, put them into a group",
                        soup.path, domain.facets_without_patch, domain.mesh.boundary_patch.size()));
    }
}

/// Refuses hulls, and meshes that have no cells of the domain's dimension, with what they have.
template<int D>
void require_domain(const io::Soup& soup, const io::SimplexBlock& cells) {
    if (soup.find_field_data("slab") != nullptr && soup.find_point_data("t") != nullptr) {
        throw InputError(fmt::format(
            "{}: this is the hull of a slab; give a mesh in space, such as a cap (cap_0001.vtu)", soup.path));
    }
    if (cells.size(D) > 0) {
        return;
    }
    const std::string wants = fmt::format("{}: has no {}, which a domain of dimension {} is made of, but ",
                                          soup.path, simplices_called(D), D);
    if (D == 2 && !soup.simplices[3].vertices.empty()) {
        throw InputError(fmt::format("{}{} tetrahedra; set dimension = 3", wants, soup.simplices[3].size(3)));
    }
    const std::size_t facets = soup.simplices[D - 1].size(D - 1);
    if (facets == 0) {
        throw InputError(fmt::format("{}no {} either; mesh the domain anew", wants, simplices_called(D - 1)));
    }
    throw InputError(fmt::format(
        "{}{} {}; {}. If the {} is meant to be there: Gmsh saves what is in physical groups only, "
        "so give it one, too",
        wants, facets, simplices_called(D - 1),
        D == 3 ? "set dimension = 2 if they are a plane domain, or give them under "
                 "initial.surfaces if they are the surface of a body"
               : "give them under initial.curves if they are the outline of a body",
        D == 3 ? "volume" : "surface"));
}

template<int D>
void warn_of_empty_groups(const io::Soup& soup, const Listener& listener) {
    const auto& physical = soup.simplices[D - 1].physical;
    const std::set<PatchNumber> used(physical.begin(), physical.end());
    std::string empty;
    for (const Patch& group : soup.groups[D - 1]) {
        if (!used.contains(group.number) && !group.name.empty()) {
            empty += fmt::format("{}\"{}\"", empty.empty() ? "" : ", ", group.name);
        }
    }
    if (!empty.empty()) {
        listener.warning(fmt::format("{}: groups that have a name, but no {}: {}", soup.path,
                                     D == 3 ? "triangles" : "lines", empty));
    }
}

} // namespace

template<int D>
Surface<D> surface_of_soup(const io::Soup& soup, const Patch& patch) {
    const io::SimplexBlock& block = soup.simplices[D - 1];
    if (block.vertices.empty()) {
        throw InputError(fmt::format("{}: has no {}", soup.path, D == 3 ? "triangles" : "edges"));
    }
    const UsedVertices used{soup.points.size(), block.vertices};
    Surface<D> surface;
    surface.points = points_in_space<D>(soup, used.vertices);
    surface.facets = renumbered<D - 1>(block, used.number);
    surface.patch.assign(surface.facets.size(), patch.number);
    surface.patches = {patch};
    return surface;
}

template<int D>
Domain<D> domain_of_soup(const io::Soup& soup, const DomainOptions& options, const IdCounter& ids,
                         const Listener& listener) {
    const io::SimplexBlock chosen =
        options.regions.empty() ? io::SimplexBlock{} : cells_of_regions<D>(soup, options.regions);
    const io::SimplexBlock& block = options.regions.empty() ? soup.simplices[D] : chosen;
    require_domain<D>(soup, block);
    const UsedVertices used{soup.points.size(), block.vertices};
    DomainInput<D> input;
    input.where = soup.path;
    input.points = points_in_space<D>(soup, used.vertices);
    input.cells = renumbered<D>(block, used.number);
    input.cell_group = block.entity;
    for (std::size_t c = 0; c < input.cells.size(); ++c) {
        input.cell_numbers.push_back(block.tag(c));
    }
    take_facets(soup, used.number, input);
    const FileFacets<D> facets{input.facets, input.facet_patch};
    Domain<D> domain = make_domain<D>(std::move(input), ids);
    for (const Patch& patch : domain.mesh.patches) {
        require_patch_name(patch.name, soup.path);
    }
    warn_of_facets(soup, block, facets, domain, options, listener);
    warn_of_empty_groups<D>(soup, listener);
    return domain;
}

template<int D>
Point<D> point_in_space(const io::Soup& soup, std::size_t v) {
    const Point<3>& x = soup.points[v];
    if constexpr (D == 2) {
        if (x[2] != soup.points[0][2]) {
            throw InputError(
                fmt::format("{}: point {} has z = {}, but a plane mesh (dimension = 2) has one z, here {}; "
                            "put the mesh "
                            "into the plane of x and y, or set dimension = 3 for a mesh of tetrahedra",
                            soup.path, soup.point_tag(v), x[2], soup.points[0][2]),
                {{"vertex", soup.point_tag(v), ""}});
        }
        return {x[0], x[1]};
    } else {
        return x;
    }
}

template Surface<2> surface_of_soup<2>(const io::Soup&, const Patch&);
template Surface<3> surface_of_soup<3>(const io::Soup&, const Patch&);
template Domain<2> domain_of_soup<2>(const io::Soup&, const DomainOptions&, const IdCounter&,
                                     const Listener&);
template Domain<3> domain_of_soup<3>(const io::Soup&, const DomainOptions&, const IdCounter&,
                                     const Listener&);
template Point<2> point_in_space<2>(const io::Soup&, std::size_t);
template Point<3> point_in_space<3>(const io::Soup&, std::size_t);

} // namespace slabhull
