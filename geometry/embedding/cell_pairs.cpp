// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/embedding/cell_pairs.h"

#include "geometry/basics/predicates.h"
#include "geometry/embedding/cell_meeting.h"
#include "geometry/embedding/cell_separation.h"

#include "slabhull/geometry/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace slabhull {

namespace {

std::optional<Point<3>> meeting(const FacetPair<3>& pair, const Point<3>&, PairTally<2>&) {
    return meet_elsewhere(pair) ? std::optional{meeting_place(pair)} : std::nullopt;
}

std::optional<Point<4>> meeting(const FacetPair<4>& pair, const Point<4>& scale, PairTally<3>& tally) {
    if (pair.shared == 4) {
        return pair.f[0];
    }
    if (proven_apart(pair, scale)) {
        return {};
    }
    ++tally.exact;
    return common_point(pair);
}

} // namespace

bool degenerate(const std::array<Point<3>, 3>& triangle) {
    return exact::degenerate(triangle);
}

/// A tetrahedron in R^4 is degenerate if its projections along all four axes are. The projection along the
/// axis nearest to its normal nearly always suffices.
bool degenerate(const std::array<Point<4>, 4>& tetrahedron) {
    const Point<4> normal = simplex_normal<3>(tetrahedron);
    const auto steeper = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const auto nearest =
        static_cast<std::size_t>(std::max_element(normal.begin(), normal.end(), steeper) - normal.begin());
    for (std::size_t turn = 0; turn < 4; ++turn) {
        const std::size_t axis = (nearest + turn) % 4;
        std::array<Point<3>, 4> image;
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                image[i][k] = tetrahedron[i][(axis + 1 + k) % 4];
            }
        }
        if (exact::orientation(image) != 0) {
            return false;
        }
    }
    return true;
}

template<int D>
Point<D + 1> scale_of_cells(const JoinedSpans<Point<D + 1>>& points, std::span<const Simplex<D>> cells) {
    constexpr std::size_t samples = 10000; // however large the mesh
    const std::size_t stride = std::max<std::size_t>(1, cells.size() / samples);
    Point<D + 1> sum{};
    std::size_t count = 0;
    for (std::size_t c = 0; c < cells.size(); c += stride, ++count) {
        const Box<D + 1> box = box_of<D>(cells[c], points);
        for (std::size_t k = 0; k <= D; ++k) {
            sum[k] += box.high[k] - box.low[k];
        }
    }
    Point<D + 1> scale;
    for (std::size_t k = 0; k <= D; ++k) {
        const double mean = sum[k] / static_cast<double>(count);
        const int exponent = std::isfinite(mean) && mean > 0 ? std::ilogb(mean) : 0;
        scale[k] = std::ldexp(1.0, std::clamp(-exponent, -500, 500));
    }
    return scale;
}

/// Puts the shared vertices first, in the same order in both cells.
template<int D>
FacetPair<D + 1> CellPairs<D>::pair_of(Index first, Index second) const {
    Simplex<D> f = cells_[first];
    Simplex<D> g = cells_[second];
    FacetPair<D + 1> pair;
    for (std::size_t i = 0; i <= D; ++i) {
        const auto twin = std::find(g.begin() + pair.shared, g.end(), f[i]);
        if (twin != g.end()) {
            std::swap(f[i], f[pair.shared]);
            std::swap(*twin, g[pair.shared]);
            ++pair.shared;
        }
    }
    pair.f = corners_of<D, D + 1>(f, points_);
    pair.g = corners_of<D, D + 1>(g, points_);
    return pair;
}

template<int D>
void CellPairs<D>::decide(Index first, Index second, PairTally<D>& tally) const {
    if (second < first) {
        std::swap(first, second);
    }
    ++tally.tested;
    if (const auto place = meeting(pair_of(first, second), scale_, tally)) {
        tally.crossings.push_back({first, second, *place});
    }
}

template Point<3> scale_of_cells<2>(const JoinedSpans<Point<3>>&, std::span<const Simplex<2>>);
template Point<4> scale_of_cells<3>(const JoinedSpans<Point<4>>&, std::span<const Simplex<3>>);
template class CellPairs<2>;
template class CellPairs<3>;

} // namespace slabhull
