// SPDX-License-Identifier: BSD-3-Clause
#include "slabhull/geometry/nodal_motion.h"

#include "geometry/basics/vector_algebra.h"

#include "slabhull/core/error.h"
#include "slabhull/core/parallel.h"

#include <fmt/core.h>

namespace slabhull {

namespace {

using namespace detail;

template<int D>
class CallableMotion final : public NodalMotion<D> {
public:
    explicit CallableMotion(std::function<Point<D>(TrackId, double)> position)
        : position_{std::move(position)} {
        if (!position_) {
            throw UsageError{"a nodal motion needs a function of track and time"};
        }
    }

    void positions(std::span<const TrackId> tracks, double t, std::span<Point<D>> x) const override {
        constexpr std::size_t grain = 1024;
        parallel_for(tracks.size(), grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                x[i] = position_(tracks[i], t);
                if (!all_finite(x[i])) {
                    throw GeometryError{fmt::format("the nodal motion takes track {} to {} at t = {}",
                                                    tracks[i], to_text(x[i]), t),
                                        {{"track", tracks[i], ""}}};
                }
            }
        });
    }

private:
    std::function<Point<D>(TrackId, double)> position_;
};

} // namespace

template<int D>
NodalMotionPointer<D> nodal_motion(std::function<Point<D>(TrackId, double)> position) {
    return std::make_shared<CallableMotion<D>>(std::move(position));
}

template NodalMotionPointer<2> nodal_motion<2>(std::function<Point<2>(TrackId, double)>);
template NodalMotionPointer<3> nodal_motion<3>(std::function<Point<3>(TrackId, double)>);

} // namespace slabhull
