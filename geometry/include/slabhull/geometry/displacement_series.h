// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/geometry/nodal_motion.h"

#include <vector>

namespace slabhull {

/// Displacements of tracks from their start, at given times.
template<int D>
struct DisplacementRows {
    std::vector<double> times;                  ///< strictly ascending, one or more
    std::vector<TrackId> tracks;                ///< strictly ascending
    Array<Point<D>> start;                      ///< of each track: where its displacement is zero
    std::vector<Array<Point<D>>> displacements; ///< by time, then as the tracks
};

/// Interpolation of displacements between rows; both kinds are exact at the rows.
enum class TimeInterpolation {
    linear, ///< order 2 in the spacing of the rows, continuous
    /// Order 4, with a continuous derivative: Hermite's cubic between two rows, whose slope at a row is that
    /// of the polynomial through the nearest five rows (de Boor, "A Practical Guide to Splines" (1978),
    /// chapter IV, with five for Bessel's three). It uses at most six rows, so a row has no effect farther
    /// than three rows away. With fewer than five rows, the polynomial is through all of them.
    cubic
};

/// A motion through the rows: track i is at start[i] + displacement(t). A single row is valid at its time
/// only. Stores the rows: 8 D bytes per track and time. positions() reads two of them (linear) or at most six
/// (cubic).
/// Throws UsageError, with the entity "row" (counted from 0) if one is at fault: no rows, times or tracks not
/// strictly ascending, a value not finite, different lengths. positions() throws GeometryError for a track
/// without displacements, and, naming the times of the rows, at times outside them by more than a billionth
/// of their range.
template<int D>
NodalMotionPointer<D> displacement_series(DisplacementRows<D> rows, TimeInterpolation interpolation);

} // namespace slabhull
