// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/slab/slab.h"

#include "slabhull/core/error.h"
#include "slabhull/geometry/embedding.h"

#include "numbers.h"
#include "projection_file.h"

#include <algorithm>
#include <fmt/format.h>

namespace slabhull {

namespace {

template<int D>
MotionPointer<D> motion_of(const MotionSpec& spec, double start) {
    switch (spec.kind) {
    case MotionSpec::Kind::rotation:
        return rotation<D>(as_point<D>(spec.axis), as_point<D>(spec.centre), spec.rate);
    case MotionSpec::Kind::translation:
        return translation<D>(as_point<D>(spec.velocity));
    case MotionSpec::Kind::expansion:
        return expansion<D>(as_point<D>(spec.centre), spec.rate, start);
    case MotionSpec::Kind::velocity:
        break;
    }
    std::array<std::string, D> formulas;
    std::copy_n(spec.formula.begin(), D, formulas.begin());
    return formula_velocity<D>(formulas, spec.constants);
}

template<int D>
ProjectionSurfacePointer<D> projection_of(const ProjectionSpec& spec) {
    switch (spec.kind) {
    case ProjectionSpec::Kind::sphere:
        return sphere_surface<D>(as_point<D>(spec.centre), spec.semi_axes.front());
    case ProjectionSpec::Kind::ellipsoid:
        return ellipsoid_surface<D>(as_point<D>(spec.centre), as_point<D>(spec.semi_axes));
    case ProjectionSpec::Kind::cylinder:
        if constexpr (D == 3) {
            return cylinder_surface(as_point<3>(spec.centre), as_point<3>(spec.direction), spec.radius);
        }
        break;
    case ProjectionSpec::Kind::file:
        return surface_from_file<D>(spec.file);
    case ProjectionSpec::Kind::plane:
        break;
    }
    return plane_surface<D>(as_point<D>(spec.centre), as_point<D>(spec.direction));
}

PatchNumber number_of(const PatchList& patches, const std::string& name, const char* table) {
    const PatchNumber number = patch_number(patches, name);
    if (number == 0) {
        std::string known;
        for (const Patch& patch : patches) {
            known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", patch.name);
        }
        throw UsageError(
            fmt::format("[{}.{}]: the domain has no patch \"{}\"; it has {}", table, name, name, known));
    }
    return number;
}

/// Checks the boundary on every level after the first, which is the initial cap's own.
template<int D>
void require_embedded_levels(const Sweep<D>& sweep) {
    for (std::size_t level = 1; level < sweep.times.size(); ++level) {
        require_domain_boundary(sweep.at(level),
                                {fmt::format("moved boundary at t = {:.9g}", sweep.times[level]), {}}, false);
    }
}

} // namespace

CapOptions cap_options(const Case& the_case) {
    CapOptions options;
    options.grading = {the_case.cap_growth, the_case.cap_size};
    options.radius_edge = the_case.cap_quality;
    options.curve_order = the_case.cap_curve_order;
    return options;
}

template<int D>
SlabSettings<D> settings_of(const Case& the_case, const PatchList& patches) {
    SlabSettings<D> settings;
    settings.motion_start = the_case.start;
    settings.trajectory = the_case.trajectory;
    settings.side = {the_case.split, the_case.diagonals};
    settings.cap = cap_options(the_case);
    for (const auto& [patch, spec] : the_case.motions) {
        settings.motions[number_of(patches, patch, "motion")].motion = motion_of<D>(spec, the_case.start);
    }
    for (const auto& [patch, spec] : the_case.projections) {
        MovingPatch<D>& moving = settings.motions[number_of(patches, patch, "project")];
        if (moving.motion == nullptr) {
            moving.motion = standing<D>();
        }
        moving.surface = projection_of<D>(spec);
        if (!moving.motion->map(the_case.start, the_case.end)) {
            throw UsageError(
                fmt::format("[project.{}]: a projection surface moves with its patch's motion, and a "
                            "velocity formula does not say how a surface moves",
                            patch));
        }
    }
    return settings;
}

template<int D>
Slab<D> build_slab(const SpatialMesh<D>& initial, int number, std::vector<double> times,
                   const SlabSettings<D>& settings, IdCounter& ids, StageClock& clock) {
    Slab<D> slab;
    Sweep<D> sweep = sweep_boundary<D>(initial, settings.motions, settings.motion_start, std::move(times),
                                       settings.trajectory);
    clock.book("trajectories");
    require_embedded_levels(sweep);
    clock.book("boundary check");
    CapMesh<D> mesh = mesh_cap<D>(sweep.at(sweep.layers()), settings.cap);
    clock.book("cap meshing");
    slab.terminating = terminating_cap<D>(initial, sweep, std::move(mesh), ids);
    slab.hull = stitch<D>(initial, sweep, slab.terminating, settings.side, ids);
    slab.hull.slab = number;
    slab.projected = std::move(sweep.projected);
    clock.book("stitching");
    return slab;
}

template SlabSettings<2> settings_of<2>(const Case&, const PatchList&);
template SlabSettings<3> settings_of<3>(const Case&, const PatchList&);
template Slab<2> build_slab<2>(const SpatialMesh<2>&, int, std::vector<double>, const SlabSettings<2>&,
                               IdCounter&, StageClock&);
template Slab<3> build_slab<3>(const SpatialMesh<3>&, int, std::vector<double>, const SlabSettings<3>&,
                               IdCounter&, StageClock&);

} // namespace slabhull
