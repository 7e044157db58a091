// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/core/index.h"

#include <array>
#include <cstddef>

namespace slabhull {

/// The vertices that some simplices of a mesh use, and their numbers in a mesh of these simplices alone.
struct UsedVertices {
    Array<Index> vertices; ///< the used ones, ascending
    Array<Index> number;   ///< of each vertex of the mesh in that list; no_index for unused ones

    /// `simplices`: lists of simplices, or of vertices. Needs: vertices below `vertex_count`. Cost: linear.
    template<class... Simplices>
    explicit UsedVertices(std::size_t vertex_count, const Simplices&... simplices) {
        number.assign(vertex_count, no_index);
        (mark(simplices), ...);
        for (std::size_t v = 0; v < vertex_count; ++v) {
            if (number[v] != no_index) {
                number[v] = static_cast<Index>(vertices.size());
                vertices.push_back(static_cast<Index>(v));
            }
        }
    }

    /// Gives the simplices the new numbers of their vertices.
    template<class Simplices>
    void renumber(Simplices& simplices) const {
        for (auto& simplex : simplices) {
            for (Index& v : simplex) {
                v = number[v];
            }
        }
    }

private:
    void mark(Index v) { number[v] = 0; }
    template<class List>
    void mark(const List& list) {
        for (const auto& entry : list) {
            mark(entry);
        }
    }
};

} // namespace slabhull
