// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/geometry/nodal_motion.h"

#include <vector>

namespace slabhull {

/// Where tracks are at instants, as displacements from where they started.
template<int D>
struct DisplacementRows {
    std::vector<double> times;                  ///< strictly ascending, one or more
    std::vector<TrackId> tracks;                ///< strictly ascending
    Array<Point<D>> start;                      ///< of each track: what its displacements count from
    std::vector<Array<Point<D>>> displacements; ///< by time, then as the tracks
};

/// What displacements do between their rows; both are exact at the rows.
enum class TimeInterpolation {
    linear, ///< order 2 in the spacing of the rows, continuous
    /// Order 4, with a continuous derivative: Hermite's cubic between two rows, whose slope at a row is that
    /// of the polynomial through the nearest five rows (de Boor, "A Practical Guide to Splines" (1978),
    /// chapter IV, with five for Bessel's three). It looks at six rows at most, so that a row is felt no
    /// farther than three rows away. With fewer than five rows, the polynomial is through all of them.
    cubic
};

/// Goes through the rows: track i is at start[i] + displacement(t). A single row holds at its time only.
/// Holds the rows: 8 D bytes per track and time. positions() reads two of them (linear), six at most (cubic).
/// Throws UsageError, with the entity "row" (counted from 0) where one is at fault: no rows, times or tracks
/// not strictly ascending, a value not finite, lengths that differ. positions() throws GeometryError for a
/// track that has no displacements, and, naming the times of the rows, at times outside them by more than a
/// billionth of their range.
template<int D>
NodalMotionPointer<D> displacement_series(DisplacementRows<D> rows, TimeInterpolation interpolation);

} // namespace slabhull
