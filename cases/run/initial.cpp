// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/geometry/shapes.h"
#include "slabhull/io/files.h"
#include "slabhull/topology/adjacency.h"

#include "cases/case/numbers.h"
#include "cases/run/mesh_soup.h"
#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull {

namespace {

/// Gives every patch name a number, in the order in which they come.
class PatchNumbers {
public:
    Patch operator()(const std::string& name) {
        const PatchNumber known = patch_number(patches_, name);
        if (known != 0) {
            return {known, name};
        }
        patches_.push_back({static_cast<PatchNumber>(patches_.size() + 1), name});
        return patches_.back();
    }

private:
    PatchList patches_;
};

/// Turns each connected component of a body, or of the outer boundary, so that its normals leave the domain.
/// Components that are not consistently oriented are left as they are, for the check that follows.
template<int D>
void turn_outward(Surface<D>& surface, bool encloses_domain) {
    const auto adjacency = build_adjacency<D - 1>(surface.facets, surface.points.size());
    std::vector<std::vector<Index>> components;
    std::vector<bool> reached(surface.facets.size(), false);
    for (Index start = 0; start < surface.facets.size(); ++start) {
        if (reached[start]) {
            continue;
        }
        std::vector<Index>& component = components.emplace_back(1, start);
        reached[start] = true;
        for (std::size_t next = 0; next < component.size(); ++next) {
            for (const Index across : adjacency.neighbors[component[next]]) {
                if (across != no_index && !reached[across]) {
                    reached[across] = true;
                    component.push_back(across);
                }
            }
        }
    }
    for (const std::vector<Index>& component : components) {
        if ((enclosed_by<D>(surface, component) > 0) != encloses_domain) {
            for (const Index f : component) {
                std::swap(surface.facets[f][0], surface.facets[f][1]);
            }
        }
    }
}

template<int D>
Surface<D> read_body(const BodyFile& body, bool encloses_domain, const Patch& patch) {
    const io::Soup soup = D == 3 ? io::read_surface(body.file) : io::read_curve(body.file);
    Surface<D> surface = surface_of_soup<D>(soup, patch);
    turn_outward(surface, encloses_domain);
    FacetNaming naming{body.file.string(), {}};
    const io::SimplexBlock& block = soup.simplices[D - 1];
    for (std::size_t f = 0; f < surface.facets.size(); ++f) {
        naming.numbers.push_back(block.tag(f));
    }
    if (!encloses_domain) { // on its own, a body is the boundary of the domain inside it
        Surface<D> alone = surface;
        for (auto& facet : alone.facets) {
            std::swap(facet[0], facet[1]);
        }
        require_domain_boundary(alone, naming, true);
    } else {
        require_domain_boundary(surface, naming, true);
    }
    return surface;
}

template<int D>
Surface<D> boundary_of_bodies(const InitialBodies& bodies) {
    PatchNumbers number;
    std::vector<Surface<D>> pieces;
    for (const BodyFile& body : bodies.files) {
        pieces.push_back(read_body<D>(body, false, number(body.patch)));
    }
    for (const EllipsoidBody& body : bodies.ellipsoids) {
        pieces.push_back(ellipsoid_body<D>(as_point<D>(body.centre), as_point<D>(body.semi_axes),
                                           body.frequency, number(body.patch)));
    }
    if (const auto* box = std::get_if<BoxSpec>(&bodies.outer)) {
        pieces.push_back(
            box_surface<D>(as_point<D>(box->min), as_point<D>(box->max), box->size, number(box->patch)));
    } else {
        const auto& outer = std::get<BodyFile>(bodies.outer);
        pieces.push_back(read_body<D>(outer, true, number(outer.patch)));
    }
    return join<D>(pieces);
}

template<int D>
Domain<D> mesh_bodies(const InitialBodies& bodies, const CapOptions& options, const IdCounter& ids,
                      StageClock& clock) {
    Surface<D> surface = boundary_of_bodies<D>(bodies);
    clock.book("initial boundary");
    require_domain_boundary(surface, {"initial boundary", {}}, true);
    clock.book("boundary check");
    CapMesh<D> cap = mesh_cap<D>(surface, options);
    clock.book("cap meshing");
    return make_domain<D>(std::move(cap), std::move(surface), ids);
}

} // namespace

template<int D>
Domain<D> initial_domain(const Case& the_case, const IdCounter& ids, const Listener& listener,
                         StageClock& clock) {
    if (const auto* file = std::get_if<InitialMesh>(&the_case.initial)) {
        const io::Soup soup = io::read_mesh(file->file);
        clock.book("reading");
        Domain<D> domain = domain_of_soup<D>(soup, ids, listener);
        clock.book("initial boundary");
        return domain;
    }
    return mesh_bodies<D>(std::get<InitialBodies>(the_case.initial), cap_options(the_case), ids, clock);
}

template<int D>
SpatialMesh<D> initial_cap(const Case& the_case, IdCounter& ids, const Listener& listener,
                           StageClock& clock) {
    Domain<D> domain = initial_domain<D>(the_case, ids, listener, clock);
    ids = domain.ids;
    return std::move(domain.mesh);
}

template Domain<2> initial_domain<2>(const Case&, const IdCounter&, const Listener&, StageClock&);
template Domain<3> initial_domain<3>(const Case&, const IdCounter&, const Listener&, StageClock&);
template SpatialMesh<2> initial_cap<2>(const Case&, IdCounter&, const Listener&, StageClock&);
template SpatialMesh<3> initial_cap<3>(const Case&, IdCounter&, const Listener&, StageClock&);

} // namespace slabhull
