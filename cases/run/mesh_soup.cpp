// SPDX-License-Identifier: BSD-3-Clause
#include "cases/run/mesh_soup.h"

#include "slabhull/core/error.h"

#include <algorithm>
#include <fmt/format.h>

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

/// The facets of a soup whose points all belong to cells, with their groups as patches.
template<int D>
void take_facets(const io::Soup& soup, const std::vector<Index>& number, DomainInput<D>& input) {
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
}

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
Domain<D> domain_of_soup(const io::Soup& soup, const IdCounter& ids, const Listener& listener) {
    const io::SimplexBlock& block = soup.simplices[D];
    UsedPoints<D> used{soup, block.vertices};
    DomainInput<D> input;
    input.where = soup.path;
    input.points = std::move(used.points);
    input.cells = renumbered<D>(block, used.number);
    input.cell_group = block.entity;
    for (std::size_t c = 0; c < input.cells.size(); ++c) {
        input.cell_numbers.push_back(block.tag(c));
    }
    take_facets(soup, used.number, input);
    Domain<D> domain = make_domain<D>(std::move(input), ids);
    if (domain.facets_without_patch > 0) {
        listener.warning(
            fmt::format("{}: {} of {} boundary facets are in no physical group; they become the patch "
                        "\"boundary\"",
                        soup.path, domain.facets_without_patch, domain.mesh.boundary_patch.size()));
    }
    return domain;
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
template Domain<2> domain_of_soup<2>(const io::Soup&, const IdCounter&, const Listener&);
template Domain<3> domain_of_soup<3>(const io::Soup&, const IdCounter&, const Listener&);
template Point<2> point_in_space<2>(const io::Soup&, std::size_t);
template Point<3> point_in_space<3>(const io::Soup&, std::size_t);

} // namespace slabhull
