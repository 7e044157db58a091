// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"
#include "slabhull/core/point.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace slabhull {

/// Motion of individual boundary vertices, given by track: their positions at a time, independent of the
/// space around them. Immutable; may be called from several threads at once.
template<int D>
class NodalMotion {
public:
    virtual ~NodalMotion() = default;

    /// x[i] = position of track tracks[i] at time t; the spans are equally long.
    /// Throws GeometryError naming the unknown track, or the range of known times.
    virtual void positions(std::span<const TrackId> tracks, double t, std::span<Point<D>> x) const = 0;

    /// As Motion::row_times().
    virtual std::vector<double> row_times() const { return {}; }
};

template<int D>
using NodalMotionPointer = std::shared_ptr<const NodalMotion<D>>;

/// The motion of a function of track and time. Needs: callable from several threads at once.
template<int D>
NodalMotionPointer<D> nodal_motion(std::function<Point<D>(TrackId, double)> position);

} // namespace slabhull
