// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
    bool in_range = true; ///< no coordinate is so large that sums could overflow

    /// `scale`: powers of two by which coordinates are multiplied.
    void assign(std::span<const Index> vertices, std::span<const Point<N>> all, const Point<N>& scale);
};

/// Whether the hulls of two clouds are proven apart: a hyperplane parts them strictly, whatever is rounded.
/// Tried are the line from one mean to the other, Fisher's discriminant, which parts clouds that lie
/// obliquely but alike as well as others, and relaxation from there. False only says that none was found
/// soon.
template<int N>
bool proven_parted(const VertexCloud<N>& a, const VertexCloud<N>& b);

extern template struct VertexCloud<3>;
extern template struct VertexCloud<4>;

} // namespace slabhull
