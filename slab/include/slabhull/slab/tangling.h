// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/slab/sweep.h"

namespace slabhull {

class Communicator;

/// The motion makes the boundary cross itself, leave its box or collapse within a slab. `entities` are the
/// facets, by their numbers in the boundary.
class TangledBoundary : public GeometryError {
public:
    TangledBoundary(const std::string& what, const std::string& advice, std::vector<Entity> facets,
                    double good, double bad)
        : GeometryError{what + ": " + advice, std::move(facets)}, without_advice{what}, good_until{good},
          tangled_at{bad} {}

    std::string without_advice; ///< what(), for those who have ended slabs earlier already

    double good_until; ///< the boundary is sound at this time; no earlier level is tangled ...
    double tangled_at; ///< ... and here it is not: at most 1e-3 of the slab later
};

/// Checks the boundary on every level after the first, which is the initial cap's own. Between the first
/// tangled level and the one before, the time is bracketed by bisection. Needs: what the sweep was made with.
/// Throws TangledBoundary naming patches, facets, time and place. Cost: that of require_domain_boundary() for
/// each level, and ten times more when it throws. In ranks, all call it with the same arguments, each has and
/// checks its share of the levels, and what one process would throw is thrown on all.
template<int D>
void require_embedded_levels(const Sweep<D>& sweep, const PatchMotions<D>& motions, double motion_start,
                             const TrajectoryOptions& options, Communicator* ranks = nullptr);

} // namespace slabhull
