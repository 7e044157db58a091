// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/cases/case.h"
#include "slabhull/cases/displacement_match.h"
#include "slabhull/slab/slab.h"

#include <map>
#include <string>
#include <vector>

namespace slabhull {

/// The settings of a march, and how the displacement files fitted the boundary.
template<int D>
struct CaseSettings {
    SlabSettings<D> slab;
    std::map<PatchNumber, DisplacementMatch>
        matches; ///< of names that move by displacement files, by the first patch
    std::vector<std::string>
        remarks; ///< of the readers of projection files; for a user to read, with the path
};

/// How a case wants its caps meshed.
CapOptions cap_options(const Case& the_case);

/// The settings that a case gives, for a domain with the given boundary when its motion starts. The
/// boundary's vertices have the tracks 0, 1 .. in order; a patch's name stands for all that have it. Throws
/// UsageError for a motion or projection of a patch that does not exist, UsageError and InputError for what
/// is wrong with the files of motions, FormatLimit for patches that the case's formats cannot hold.
template<int D>
CaseSettings<D> case_settings(const Case& the_case, const Boundary<D>& boundary);

/// The same without the report about files.
template<int D>
SlabSettings<D> settings_of(const Case& the_case, const Boundary<D>& boundary) {
    return case_settings<D>(the_case, boundary).slab;
}

} // namespace slabhull
