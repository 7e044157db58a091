// SPDX-License-Identifier: BSD-3-Clause
#include "cases/case/patch_motions.h"

#include "cases/case/numbers.h"
#include "cases/tables/motion_tables.h"
#include "cases/tables/projection_file.h"

#include <algorithm>
#include <stdexcept>

namespace slabhull {

namespace {

template<int D>
MotionPointer<D> formula_of(const MotionSpec& spec) {
    std::array<std::string, D> formulas;
    std::copy_n(spec.formula.begin(), D, formulas.begin());
    return formula_velocity<D>(formulas, spec.constants);
}

template<int D>
MotionPointer<D> rotation_of(const MotionSpec& spec, const Case& the_case) {
    const auto axis = as_point<D>(spec.axis);
    const auto centre = as_point<D>(spec.centre);
    if (spec.table.empty()) {
        return rotation<D>(axis, centre, spec.rate);
    }
    return rotation_from_file<D>(spec.table, axis, centre, {the_case.start, the_case.end});
}

template<int D>
MotionPointer<D> sequence_of(const MotionSpec& spec, const Case& the_case) {
    std::vector<MotionPointer<D>> steps;
    for (const MotionSpec& step : spec.steps) {
        steps.push_back(motion_of<D>(step, the_case));
    }
    return sequence<D>(std::move(steps), the_case.start);
}

} // namespace

template<int D>
MotionPointer<D> motion_of(const MotionSpec& spec, const Case& the_case) {
    switch (spec.kind) {
    case MotionSpec::Kind::rotation:
        return rotation_of<D>(spec, the_case);
    case MotionSpec::Kind::translation:
        return translation<D>(as_point<D>(spec.velocity));
    case MotionSpec::Kind::expansion:
        return expansion<D>(as_point<D>(spec.centre), spec.rate, the_case.start);
    case MotionSpec::Kind::rigid_table:
        return rigid_table_from_file<D>(spec.table, as_point<D>(spec.centre), {the_case.start, the_case.end});
    case MotionSpec::Kind::sequence:
        return sequence_of<D>(spec, the_case);
    case MotionSpec::Kind::velocity:
        return formula_of<D>(spec);
    case MotionSpec::Kind::displacement_series:
    case MotionSpec::Kind::stretch:
        break;
    }
    throw std::invalid_argument("displacement series and stretching patches are no fields of velocities");
}

template<int D>
ProjectionSurfacePointer<D> projection_of(const ProjectionSpec& spec, std::vector<std::string>& remarks) {
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
        return surface_from_file<D>(spec.file, remarks);
    case ProjectionSpec::Kind::plane:
        break;
    }
    return plane_surface<D>(as_point<D>(spec.centre), as_point<D>(spec.direction));
}

template MotionPointer<2> motion_of<2>(const MotionSpec&, const Case&);
template MotionPointer<3> motion_of<3>(const MotionSpec&, const Case&);
template ProjectionSurfacePointer<2> projection_of<2>(const ProjectionSpec&, std::vector<std::string>&);
template ProjectionSurfacePointer<3> projection_of<3>(const ProjectionSpec&, std::vector<std::string>&);

} // namespace slabhull
