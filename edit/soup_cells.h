// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/io/soup.h"

#include <cstddef>

namespace slabhull {

/// The simplices of one dimension of a soup, a row of vertices for each.
template<int D>
Array<Simplex<D>> simplices_of(const io::Soup& soup) {
    const Array<Index>& vertices = soup.simplices[D].vertices;
    Array<Simplex<D>> cells(vertices.size() / (D + 1));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        cells[i / (D + 1)][i % (D + 1)] = vertices[i];
    }
    return cells;
}

/// The array "t" over the points; nullptr where there is none that fits.
const Array<double>* soup_times(const io::Soup& soup);

} // namespace slabhull
