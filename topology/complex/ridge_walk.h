// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace slabhull {

/// A cell met while turning about a ridge, a face of codimension two: it lies in the two facets `in` and
/// `out` of the cell. For D = 3 ridges are edges, for D = 2 vertices, and for D = 1 there is one, empty:
/// turning about it goes along the curve.
///
///             p              The cell is the ridge with p and q; facet `in` is opposite to p, facet `out` to
///           / | \            q. Through `out`, which is the ridge with p, one comes to the cell of the ridge
///         /   |   \          with p and r. It is entered by the facet opposite to r and left by the one
///        r   out   q         opposite to p.
///         \   |   / in
///           ridge
struct Turn {
    Index cell;
    std::size_t in;
    std::size_t out;

    Turn reversed() const { return {cell, out, in}; }
};

/// Turns about ridges by the adjacency alone. Neighbours must be in range, but need not make sense.
template<int D>
class RidgeWalk {
public:
    RidgeWalk(std::span<const Simplex<D>> cells, std::span<const Neighbors<D>> neighbors)
        : cells_{cells}, neighbors_{neighbors} {}

    /// The same facet as a local number of the neighbour across it.
    std::optional<std::size_t> place_seen_from_across(Index cell, std::size_t facet) const {
        const Index other = neighbors_[cell][facet];
        return other == no_index ? std::nullopt : place_of(neighbors_[other], cell);
    }

    /// Through `out`; nothing on the boundary, or where the neighbours make no sense.
    std::optional<Turn> next(const Turn& at) const {
        const auto in = place_seen_from_across(at.cell, at.out);
        if (!in) {
            return std::nullopt;
        }
        const Index cell = neighbors_[at.cell][at.out];
        const auto out = place_of(cells_[cell], cells_[at.cell][at.in]);
        return out && *out != *in ? std::optional{Turn{cell, *in, *out}} : std::nullopt;
    }

    /// All cells around a ridge in the sense of `start`: from it once around, or from boundary to boundary.
    std::vector<Turn> fan(const Turn& start) const {
        std::vector<Turn> turns{start};
        if (follow(turns)) {
            return turns;
        }
        std::vector<Turn> back{start.reversed()};
        follow(back);
        std::vector<Turn> result;
        for (std::size_t k = back.size(); k-- > 1;) {
            result.push_back(back[k].reversed());
        }
        result.insert(result.end(), turns.begin(), turns.end());
        return result;
    }

    /// Where turning ends on the boundary; nothing when it does not within as many steps as there are cells.
    std::optional<Turn> last(Turn at) const {
        for (std::size_t step = 0; step < cells_.size(); ++step) {
            if (neighbors_[at.cell][at.out] == no_index) {
                return at;
            }
            const auto further = next(at);
            if (!further) {
                return std::nullopt;
            }
            at = *further;
        }
        return std::nullopt;
    }

private:
    template<std::size_t N>
    static std::optional<std::size_t> place_of(const std::array<Index, N>& entries, Index wanted) {
        const auto found = std::find(entries.begin(), entries.end(), wanted);
        return found == entries.end() ? std::nullopt
                                      : std::optional{static_cast<std::size_t>(found - entries.begin())};
    }

    /// Whether it came back to where it started.
    bool follow(std::vector<Turn>& turns) const {
        while (turns.size() <= cells_.size()) {
            const auto further = next(turns.back());
            if (!further) {
                return false;
            }
            if (further->cell == turns.front().cell) {
                return true;
            }
            turns.push_back(*further);
        }
        return true;
    }

    std::span<const Simplex<D>> cells_;
    std::span<const Neighbors<D>> neighbors_;
};

} // namespace slabhull
