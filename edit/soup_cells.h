// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"
#include "slabhull/io/soup.h"

#include <cstddef>
#include <span>

namespace slabhull {

/// Vertices of simplices, one after the other, as a row of them for each; a view.
template<int D>
std::span<const Simplex<D>> as_simplices(std::span<const Index> vertices) {
    return {reinterpret_cast<const Simplex<D>*>(vertices.data()), vertices.size() / (D + 1)};
}

/// The simplices of one dimension of a soup, a view.
template<int D>
std::span<const Simplex<D>> simplices_of(const io::Soup& soup) {
    return as_simplices<D>(soup.simplices[D].vertices);
}

/// The array "t" over the points; nullptr where there is none that fits.
const Array<double>* soup_times(const io::Soup& soup);

} // namespace slabhull
