// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"

#include "cases/run/bodies.h"
#include "cases/run/mesh_soup.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/io/files.h"
#include "slabhull/slab/slab.h"

#include <algorithm>
#include <numeric>

namespace slabhull {

namespace {

/// Boundary facets in the order of their patches, so that the side's cells of one patch stand together.
template<int D>
void sort_boundary_by_patch(SpatialMesh<D>& mesh) {
    std::vector<std::size_t> order(mesh.boundary_facets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&mesh](std::size_t a, std::size_t b) {
        return mesh.boundary_patch[a] < mesh.boundary_patch[b];
    });
    Array<Facet<D>> facets;
    std::vector<PatchNumber> patch;
    for (const std::size_t f : order) {
        facets.push_back(mesh.boundary_facets[f]);
        patch.push_back(mesh.boundary_patch[f]);
    }
    mesh.boundary_facets = std::move(facets);
    mesh.boundary_patch = std::move(patch);
}

template<int D>
void number_vertices(SpatialMesh<D>& mesh, IdCounter& ids) {
    mesh.vertex_ids.resize(mesh.points.size());
    std::iota(mesh.vertex_ids.begin(), mesh.vertex_ids.end(), ids.take(mesh.points.size()));
    mesh.track_ids.assign(mesh.points.size(), no_track);
    for (const auto& facet : mesh.boundary_facets) {
        for (const Index v : facet) {
            mesh.track_ids[v] = 0;
        }
    }
    TrackId track = 0;
    for (TrackId& given : mesh.track_ids) {
        if (given != no_track) {
            given = track++;
        }
    }
}

std::vector<std::string> patches_with_motions(const Case& the_case) {
    std::vector<std::string> names;
    for (const auto& [patch, motion] : the_case.motions) {
        names.push_back(patch);
    }
    return names;
}

template<int D>
SpatialMesh<D> mesh_bodies(const InitialBodies& bodies, const CapOptions& options, const Listener& listener,
                           StageClock& clock) {
    Surface<D> surface = boundary_of_bodies<D>(bodies, listener);
    clock.book("initial boundary");
    require_domain_boundary(surface, {"initial boundary", {}}, true);
    clock.book("boundary check");
    CapMesh<D> cap = mesh_cap<D>(surface, options);
    clock.book("cap meshing");
    SpatialMesh<D> mesh;
    mesh.points = std::move(cap.points);
    mesh.cells = std::move(cap.cells);
    mesh.neighbors = std::move(cap.neighbors);
    mesh.boundary_facets = std::move(surface.facets);
    mesh.boundary_patch = std::move(surface.patch);
    mesh.patches = std::move(surface.patches);
    return mesh;
}

} // namespace

template<int D>
SpatialMesh<D> initial_cap(const Case& the_case, IdCounter& ids, const Listener& listener,
                           StageClock& clock) {
    SpatialMesh<D> mesh;
    if (const auto* file = std::get_if<InitialMesh>(&the_case.initial)) {
        const io::Soup soup = io::read_mesh(file->file, file->reading);
        clock.book("reading");
        for (const std::string& remark : soup.remarks) {
            listener.warning(remark);
        }
        mesh = domain_of_soup<D>(soup, {file->regions, patches_with_motions(the_case)}, listener);
        clock.book("initial boundary");
    } else {
        mesh =
            mesh_bodies<D>(std::get<InitialBodies>(the_case.initial), cap_options(the_case), listener, clock);
    }
    sort_boundary_by_patch(mesh);
    number_vertices(mesh, ids);
    return mesh;
}

template SpatialMesh<2> initial_cap<2>(const Case&, IdCounter&, const Listener&, StageClock&);
template SpatialMesh<3> initial_cap<3>(const Case&, IdCounter&, const Listener&, StageClock&);

} // namespace slabhull
