// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/cases/plan.h"

#include "cases/run/bodies.h"
#include "cases/run/case_checks.h"
#include "cases/run/cost.h"
#include "geometry/meshing/cap_limits.h"
#include "slabhull/cases/initial.h"
#include "slabhull/cases/settings.h"
#include "slabhull/geometry/embedding.h"
#include "slabhull/slab/layers.h"
#include "slabhull/slab/stitch.h"

#include <algorithm>
#include <utility>

namespace slabhull {

namespace {

/// The domain at the start as far as its boundary goes; `cells` are there if a file has them.
template<int D>
SpatialMesh<D> starting_boundary(const Case& the_case, const Listener& listener) {
    if (std::holds_alternative<InitialMesh>(the_case.initial)) {
        StageClock clock;
        return initial_domain<D>(the_case, {}, listener, clock).mesh;
    }
    FacetNaming naming;
    Surface<D> surface = boundary_of_bodies<D>(std::get<InitialBodies>(the_case.initial), listener, naming);
    require_domain_boundary(surface, naming, true);
    return boundary_alone<D>(std::move(surface));
}

template<int D>
class Planner {
public:
    Planner(const Case& the_case, const Listener& listener)
        : case_{the_case}, mesh_{starting_boundary<D>(the_case, listener)}, boundary_{boundary_of(mesh_)},
          settings_{settings_of<D>(the_case, boundary_)} {}

    CasePlan run() {
        require_attainable<D>(boundary_.start_surface(), case_.cap_size);
        plan_.facets = boundary_.facet_count();
        list_patches();
        estimate_cap();
        for (int slab = 0; slab < case_.slabs; ++slab) {
            plan_slab(slab);
        }
        estimate_cost();
        return std::move(plan_);
    }

private:
    void list_patches() {
        const auto patches = boundary_.patch();
        for (const Patch& patch : boundary_.patches()) {
            const auto facets = std::count(patches.begin(), patches.end(), patch.number);
            plan_.patches.push_back(
                {patch.name, static_cast<std::size_t>(facets), settings_.motions.contains(patch.number)});
        }
    }

    void estimate_cap() {
        if (!mesh_.cells.empty()) {
            plan_.cap_simplices = static_cast<double>(mesh_.cells.size());
            return;
        }
        plan_.cap_simplices =
            most_cap_cells<D>(boundary_, boundary_.start(), {case_.cap_growth, case_.cap_size});
    }

    /// Moves the boundary to the slab's end.
    void plan_slab(int slab) {
        const std::vector<double> times = case_.level_times(slab);
        const MeasuredSweep<D> swept =
            settings_.layers.automatic
                ? sweep_in_layers<D>(boundary_, mesh_, settings_.motions, settings_.motion_start,
                                     {times.front(), times.back()}, settings_.trajectory, settings_.layers)
                : sweep_measured<D>(boundary_, mesh_, settings_.motions, settings_.motion_start, times,
                                    settings_.trajectory, settings_.layers);
        for (std::size_t b = 0; b < boundary_.vertex_count(); ++b) {
            mesh_.points[boundary_.mesh_vertices()[b]] = swept.sweep.positions.back()[b];
        }
        const std::size_t layers = swept.sweep.layers();
        plan_.slabs.push_back({times.front(), times.back(), layers,
                               side_simplex_count(plan_.facets, layers, settings_.side.split)});
    }

    void estimate_cost() {
        for (const SlabPlan& slab : plan_.slabs) {
            const double simplices = slab.side_simplices + 2 * plan_.cap_simplices;
            plan_.bytes = std::max(plan_.bytes, bytes_per_simplex(case_) * simplices);
            plan_.seconds += simplices / simplices_per_second;
        }
    }

    const Case& case_;
    SpatialMesh<D> mesh_;
    Boundary<D> boundary_;
    SlabSettings<D> settings_;
    CasePlan plan_;
};

} // namespace

CasePlan plan_case(const Case& the_case, const Listener& listener) {
    require_files(the_case);
    warn_of_turns(the_case, listener);
    return the_case.dimension == 2 ? Planner<2>{the_case, listener}.run()
                                   : Planner<3>{the_case, listener}.run();
}

} // namespace slabhull
