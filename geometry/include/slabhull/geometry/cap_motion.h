// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/point.h"

#include <span>

namespace slabhull {

struct CapMotionOptions {
    /// Accuracy of the inner vertices' displacement: residual relative to that of inner vertices at rest.
    /// 0.01 keeps cells as good as the exact solution does; with 0.03 small cells near a moving body lag
    /// behind. Computed in single precision, so 1e-5 is about the least.
    double tolerance = 0.01;
    int most_iterations = 500; ///< usually 20 to 50 suffice
};

/// For motions in small steps that must not tangle: the smallest cells beside a body follow it, too.
inline constexpr double careful_tolerance = 1e-4;

/// A cap whose vertices have moved; its cells are unchanged.
template<int D>
struct MovedCap {
    Array<Point<D>> points;
    double smallest_angle = 0; ///< of all cells, in degrees (D = 3: dihedral), as measure_solid() gives it
    bool sound = false;        ///< all cells are positive, as signed_measure() gives it
    int iterations = 0;
};

/// Moves the inner vertices of a cap with its boundary: vertex boundary[b] goes to targets[b], bit for bit.
/// The others are displaced by the affine map that is the least-squares fit to the boundary's displacement,
/// plus a solution of div(kappa grad u) = 0 for the remainder. So an affine motion is reproduced to rounding.
/// Any other motion deforms large, round cells, while small or flat ones near a body move with it (kappa:
/// geometry/meshing/stiffness.h; stiffening by cell size as in Stein, Tezduyar and Benney, Journal of Applied
/// Mechanics 70, 2003).
///
/// The caller judges the result, by `sound` and `smallest_angle`; nothing is assumed about the displacement.
/// A cap that cannot be moved, or is poor to begin with, comes out unsound or with a small angle; points of
/// an unsound cap may be NaN.
///
/// Calls keep no state: the same cap and targets give the same bytes, with any number of threads.
/// Needs: positive cells; `boundary` has all vertices of their boundary facets, each once (more are allowed),
/// as many as `targets`.
/// Throws UsageError for no boundary, for targets of another number and for vertices out of range;
/// GeometryError naming an inner vertex around which the cells do not fill a ball.
/// Cost: near-linear; some 0.35 microseconds per tetrahedron on one thread, a tenth of mesh_cap(), and 60
/// bytes of each.
template<int D>
MovedCap<D> move_cap(std::span<const Point<D>> points, std::span<const Simplex<D>> cells,
                     std::span<const Index> boundary, std::span<const Point<D>> targets,
                     const CapMotionOptions& options = {});

} // namespace slabhull
