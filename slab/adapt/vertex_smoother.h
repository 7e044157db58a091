// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slab/adapt/adapt_mesh.h"

#include <cstddef>
#include <vector>

namespace slabhull {

/// Moves inner vertices at the layer's end to raise the smallest quality of the cells around them.
template<int D>
class VertexSmoother {
public:
    explicit VertexSmoother(AdaptMesh<D>& mesh) : mesh_{mesh} {}

    /// Treats the vertices of cells whose quality is below `wanted`, or whose prism over the layer would have
    /// simplices without positive volume. Returns the number of vertices moved. Vertices are taken in order.
    std::size_t run(double wanted);

    /// Cells whose prism over the layer has simplices without positive volume.
    std::vector<Index> unsound() const;

private:
    bool improve(Index vertex, double wanted);
    /// The smallest value around a vertex, or any value below `enough` if it is.
    double around(double enough);
    double value_of(Index cell, double enough) const;
    bool is_sound(Index cell, double least_share) const;

    AdaptMesh<D>& mesh_;
    std::vector<Index> star_;
};

extern template class VertexSmoother<2>;
extern template class VertexSmoother<3>;

} // namespace slabhull
