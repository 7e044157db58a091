// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <span>

namespace slabhull {

struct CapMotionOptions {
    /// How exactly inner vertices follow: the residual relative to that of inner vertices at rest. 0.01 keeps
    /// cells as good as the exact solution does; 0.03 lets small ones near a moving body lag behind. Computed
    /// in single precision, so 1e-5 is about the least.
    double tolerance = 0.01;
    int most_iterations = 500; ///< some 20 to 50 are usual
};

/// For what moves in small steps and must not tangle: the smallest cells beside a body follow it, too.
inline constexpr double careful_tolerance = 1e-4;

/// A cap whose vertices have moved; its cells are what they were.
template<int D>
struct MovedCap {
    Array<Point<D>> points;
    double smallest_angle = 0; ///< of all cells, in degrees (D = 3: dihedral), as measure_solid() gives it
    bool sound = false;        ///< all cells are positive, as signed_measure() gives it
    int iterations = 0;
};

/// Moves the inner vertices of a cap with its boundary: vertex boundary[b] goes to targets[b], bit for bit.
/// The others are displaced by an affine map, the one that fits the boundary's displacement best in the sense
/// of least squares, plus a solution of div(kappa grad u) = 0 for what it leaves of that. So a motion that is
/// affine all over is reproduced to rounding, and any other spreads over large, round cells, while small or
/// flat ones near a body go along with it (kappa: geometry/stiffness.h; stiffening by cell size as in
/// Stein, Tezduyar and Benney, Journal of Applied Mechanics 70, 2003).
///
/// Whether the result is good enough is for the caller to say, by `sound` and `smallest_angle`; nothing is
/// assumed about the displacement. A cap that cannot be moved, or is poor to begin with, is unsound or has a
/// small angle; points of a cap that is not sound may be NaN.
///
/// Nothing is remembered between calls: the same cap and targets give the same bytes, with any number of
/// threads.
/// Needs: positive cells; `boundary` all the vertices of their boundary facets, each once (more may be
/// given), as many as `targets`.
/// Throws UsageError for no boundary, for targets of another number and for vertices that do not exist;
/// GeometryError naming an inner vertex around which the cells fill no ball.
/// Cost: near-linear; some 0.35 microseconds per tetrahedron on one thread, a tenth of mesh_cap(), and 60
/// bytes of each.
template<int D>
MovedCap<D> move_cap(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
                     std::span<const Index> boundary, std::span<const Point<D>> targets,
                     const CapMotionOptions& options = {});

} // namespace slabhull
