// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace slabhull {

/// Whether a simplex, given by its vertices, names one of them twice.
template<class Vertices>
bool repeats_a_vertex(const Vertices& simplex) {
    for (std::size_t i = 1; i < simplex.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (simplex[i] == simplex[j]) {
                return true;
            }
        }
    }
    return false;
}

} // namespace slabhull
