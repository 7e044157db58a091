// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/geometry/motion.h"

#include <span>
#include <string_view>

namespace slabhull {

/// Integration scheme for dx/dt = v(x, t). Orders 1, 2, 4 with fixed substeps; order 5 with adaptive
/// substeps; the closed form.
enum class Scheme { euler, heun, rk4, dopri5, exact };

/// The scheme called `name`. Throws UsageError that lists the valid names.
Scheme scheme_from_name(std::string_view name);
std::string_view scheme_name(Scheme scheme);

struct TrajectoryOptions {
    Scheme scheme = Scheme::rk4;
    int substeps = 8;         ///< positive; dopri5 uses it for its first guess only, exact ignores it
    double tolerance = 1e-10; ///< of a substep of dopri5, relative to the extent of all points together
};

/// Moves the points from time `from` to time `to` (which may be earlier), in place.
/// Throws UsageError for invalid options and for `exact` without a closed form; GeometryError, naming the
/// point, if a path becomes infinite or NaN, or if dopri5 needs more than 10,000 substeps. The points are
/// then invalid. Cost: linear in points and substeps. The result does not depend on the number of threads.
template<int D>
void advance(const Motion<D>& motion, std::span<Point<D>> x, double from, double to,
             const TrajectoryOptions& options);

} // namespace slabhull
