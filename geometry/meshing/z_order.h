// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace slabhull {

/// Positions of points, in the plane or in space, along a Z curve (Morton order): points close on the curve
/// are close in space.
template<int D>
class ZOrder {
    static_assert(D == 2 || D == 3);

public:
    /// The curve fills the bounding box of `points`. Needs: at least one point.
    explicit ZOrder(std::span<const Point<D>> points) : low_{points[0]} {
        Point<D> high = low_;
        for (const Point<D>& p : points) {
            for (std::size_t k = 0; k < D; ++k) {
                low_[k] = std::min(low_[k], p[k]);
                high[k] = std::max(high[k], p[k]);
            }
        }
        for (std::size_t k = 0; k < D; ++k) {
            edge_ = std::max(edge_, high[k] - low_[k]);
        }
    }

    std::uint64_t operator()(const Point<D>& p) const {
        std::uint64_t key = 0;
        for (std::size_t k = 0; k < D; ++k) {
            key |= spread(digits(p, k)) << k;
        }
        return key;
    }

private:
    static constexpr int bits = 64 / D;

    std::uint64_t digits(const Point<D>& p, std::size_t k) const {
        const double along = edge_ > 0 ? (p[k] - low_[k]) / edge_ : 0.0;
        constexpr auto last = static_cast<double>((std::uint64_t{1} << bits) - 1);
        return static_cast<std::uint64_t>(std::clamp(along, 0.0, 1.0) * last);
    }

    /// Puts D - 1 zeros in front of each bit.
    static std::uint64_t spread(std::uint64_t x) {
        if constexpr (D == 2) {
            x = (x | (x << 16)) & 0x0000ffff0000ffffU;
            x = (x | (x << 8)) & 0x00ff00ff00ff00ffU;
            x = (x | (x << 4)) & 0x0f0f0f0f0f0f0f0fU;
            x = (x | (x << 2)) & 0x3333333333333333U;
            return (x | (x << 1)) & 0x5555555555555555U;
        } else {
            x = (x | (x << 32)) & 0x001f00000000ffffU;
            x = (x | (x << 16)) & 0x001f0000ff0000ffU;
            x = (x | (x << 8)) & 0x100f00f00f00f00fU;
            x = (x | (x << 4)) & 0x10c30c30c30c30c3U;
            return (x | (x << 2)) & 0x1249249249249249U;
        }
    }

    Point<D> low_;
    double edge_ = 0;
};

} // namespace slabhull
