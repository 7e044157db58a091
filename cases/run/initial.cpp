// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"

#include "cases/run/bodies.h"
#include "cases/run/mesh_soup.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/io/files.h"
#include "slabhull/slab/cap_cells.h"

#include <utility>

namespace slabhull {

namespace {

std::vector<std::string> patches_with_motions(const Case& the_case) {
    std::vector<std::string> names;
    for (const auto& [patch, motion] : the_case.motions) {
        names.push_back(patch);
    }
    return names;
}

template<int D>
Domain<D> mesh_bodies(const InitialBodies& bodies, const CapOptions& options, const IdCounter& ids,
                      const Listener& listener, StageClock& clock,
                      const std::function<void(const SpatialMesh<D>&)>& on_boundary) {
    FacetNaming naming;
    Surface<D> surface = boundary_of_bodies<D>(bodies, listener, naming);
    clock.book("initial boundary");
    require_domain_boundary(surface, naming, true);
    clock.book(boundary_check_stage);
    if (on_boundary) {
        on_boundary(boundary_alone<D>(surface));
    }
    CapMesh<D> cap = mesh_cap<D>(surface, options);
    clock.book(cap_meshing_stage);
    return make_domain<D>(std::move(cap), std::move(surface), ids);
}

} // namespace

template<int D>
Domain<D> initial_domain(const Case& the_case, const IdCounter& ids, const Listener& listener,
                         StageClock& clock, const std::function<void(const SpatialMesh<D>&)>& on_boundary,
                         Communicator* ranks) {
    if (const auto* file = std::get_if<InitialMesh>(&the_case.initial)) {
        const io::Soup soup = io::read_mesh(file->file, file->reading);
        clock.book("reading");
        for (const std::string& remark : soup.remarks) {
            listener.warning(remark);
        }
        Domain<D> domain =
            domain_of_soup<D>(soup, {file->regions, patches_with_motions(the_case)}, ids, listener);
        clock.book("initial boundary");
        if (ranks != nullptr) {
            leave_cells_on_first(domain.mesh, *ranks);
        }
        return domain;
    }
    CapOptions options = cap_options(the_case);
    options.ranks = ranks;
    return mesh_bodies<D>(std::get<InitialBodies>(the_case.initial), options, ids, listener, clock,
                          on_boundary);
}

template<int D>
SpatialMesh<D> initial_cap(const Case& the_case, IdCounter& ids, const Listener& listener,
                           StageClock& clock) {
    Domain<D> domain = initial_domain<D>(the_case, ids, listener, clock);
    ids = domain.ids;
    return std::move(domain.mesh);
}

template Domain<2> initial_domain<2>(const Case&, const IdCounter&, const Listener&, StageClock&,
                                     const std::function<void(const SpatialMesh<2>&)>&, Communicator*);
template Domain<3> initial_domain<3>(const Case&, const IdCounter&, const Listener&, StageClock&,
                                     const std::function<void(const SpatialMesh<3>&)>&, Communicator*);
template SpatialMesh<2> initial_cap<2>(const Case&, IdCounter&, const Listener&, StageClock&);
template SpatialMesh<3> initial_cap<3>(const Case&, IdCounter&, const Listener&, StageClock&);

} // namespace slabhull
