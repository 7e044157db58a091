// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/geometry/motion.h"
#include "slabhull/geometry/projection.h"

namespace slabhull {

/// The motion that a case specifies, from the case's start; reads the tables that it names.
/// Needs: spec.is_field().
/// Throws UsageError for keys that make no motion, InputError for an unsuitable table.
template<int D>
MotionPointer<D> motion_of(const MotionSpec& spec, const Case& the_case);

template<int D>
ProjectionSurfacePointer<D> projection_of(const ProjectionSpec& spec, std::vector<std::string>& remarks);

} // namespace slabhull
