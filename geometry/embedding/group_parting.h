// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/joined_spans.h"
#include "slabhull/core/point.h"

#include <array>
#include <cstddef>
#include <span>

namespace slabhull {

/// The vertices of a group of cells, and their mean.
template<int N>
struct VertexCloud {
    static constexpr std::size_t most = N == 3 ? 5 : 10;

    std::array<Point<N>, most> points; ///< scaled
    std::size_t size = 0;
    Point<N> mean{};
    Point<N> reach{};     ///< largest distances of points from the mean, by coordinate
    bool in_range = true; ///< coordinates are small enough that sums cannot overflow

    /// `scale`: powers of two by which coordinates are multiplied.
    void assign(std::span<const Index> vertices, const JoinedSpans<Point<N>>& all, const Point<N>& scale);
};

/// Whether the convex hulls of two clouds are proven apart: a hyperplane separates them strictly, rounding
/// errors included. Tried are the line between the means, Fisher's discriminant, which separates oblong
/// clouds of like orientation as well as others, and relaxation from there. False only says that none was
/// found soon.
template<int N>
bool proven_parted(const VertexCloud<N>& a, const VertexCloud<N>& b);

extern template struct VertexCloud<3>;
extern template struct VertexCloud<4>;

} // namespace slabhull
