// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull {

/// Places in the plane along a Z curve (Morton order): what is near in the order is near in the plane.
class ZOrder {
public:
    /// The curve fills the box around `points`, of which there is at least one.
    explicit ZOrder(std::span<const Point<2>> points) : low_{points[0]} {
        Point<2> high = low_;
        for (const Point<2>& p : points) {
            for (std::size_t k = 0; k < 2; ++k) {
                low_[k] = std::min(low_[k], p[k]);
                high[k] = std::max(high[k], p[k]);
            }
        }
        edge_ = std::max(high[0] - low_[0], high[1] - low_[1]);
    }

    std::uint64_t operator()(const Point<2>& p) const {
        return spread(digits(p, 0)) | spread(digits(p, 1)) << 1;
    }

private:
    std::uint64_t digits(const Point<2>& p, std::size_t k) const {
        const double along = edge_ > 0 ? (p[k] - low_[k]) / edge_ : 0.0;
        return static_cast<std::uint64_t>(std::clamp(along, 0.0, 1.0) * 0xffffffffU);
    }

    /// Puts a zero in front of each of 32 bits.
    static std::uint64_t spread(std::uint64_t x) {
        x = (x | (x << 16)) & 0x0000ffff0000ffffU;
        x = (x | (x << 8)) & 0x00ff00ff00ff00ffU;
        x = (x | (x << 4)) & 0x0f0f0f0f0f0f0f0fU;
        x = (x | (x << 2)) & 0x3333333333333333U;
        return (x | (x << 1)) & 0x5555555555555555U;
    }

    Point<2> low_;
    double edge_;
};

} // namespace slabhull
