// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"
#include "slabhull/core/point.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace slabhull {

/// How boundary vertices move that are told apart by their tracks: where each of them is at a time, whatever
/// the space around it does. Immutable; may be called from several threads at once.
template<int D>
class NodalMotion {
public:
    virtual ~NodalMotion() = default;

    /// x[i] = where track tracks[i] is at time t; the spans are equally long.
    /// Throws GeometryError naming the track that is not known, or the times that are.
    virtual void positions(std::span<const TrackId> tracks, double t, std::span<Point<D>> x) const = 0;

    /// As Motion::row_times().
    virtual std::vector<double> row_times() const { return {}; }
};

template<int D>
using NodalMotionPointer = std::shared_ptr<const NodalMotion<D>>;

/// Any function of track and time that may be called from several threads at once.
template<int D>
NodalMotionPointer<D> nodal_motion(std::function<Point<D>(TrackId, double)> position);

} // namespace slabhull
