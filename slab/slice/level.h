// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"
#include "slabhull/core/point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace slabhull {

/// The point where a level crosses an edge, given by the vertices below and above. A vertex at the level is
/// both ends. Comparison by vertices makes cells share the points of a section.
struct CutPoint {
    Index lower = no_index;
    Index upper = no_index;
    friend auto operator<=>(const CutPoint&, const CutPoint&) = default;
};

/// An instant, and from which side it is approached.
struct Level {
    double time;
    double tolerance;
    bool from_above;

    bool above(double t) const { return from_above ? t > time + tolerance : t >= time - tolerance; }
    bool at(double t) const { return t >= time - tolerance && t <= time + tolerance; }

    /// `time_of` gives the time of a vertex.
    template<class TimeOf>
    CutPoint cut_edge(Index lower, Index upper, const TimeOf& time_of) const {
        if (at(time_of(lower))) {
            return {lower, lower};
        }
        return at(time_of(upper)) ? CutPoint{upper, upper} : CutPoint{lower, upper};
    }
};

/// Whether a simplex of cut points has lost dimension: cut points of edges at a vertex at the level are that
/// vertex.
template<class Corners>
bool collapsed(const Corners& corners) {
    for (auto i = corners.begin(); i != corners.end(); ++i) {
        if (std::find(corners.begin(), i, *i) != i) {
            return true;
        }
    }
    return false;
}

/// Where a cut point lies, and how far along its edge: 0 at the lower vertex.
template<int D>
struct PlacedCut {
    Point<D> point;
    double share;
};

template<int D>
PlacedCut<D> place_cut(const Level& level, const CutPoint& cut, std::span<const Point<D + 1>> points) {
    const Point<D + 1>& a = points[cut.lower];
    const Point<D + 1>& b = points[cut.upper];
    PlacedCut<D> placed{{}, cut.lower == cut.upper ? 0.0 : (level.time - a[D]) / (b[D] - a[D])};
    for (std::size_t k = 0; k < D; ++k) {
        placed.point[k] = std::lerp(a[k], b[k], placed.share); // what stands still stays exactly where it is
    }
    return placed;
}

/// Cut points without repetition, in the order of their edges, and the number of each of the given ones.
struct NumberedCutPoints {
    std::vector<CutPoint> points;
    std::vector<Index> number;
};

/// The corners of simplices of cut points, one simplex after the other.
template<class Piece>
NumberedCutPoints number_corners(const std::vector<Piece>& pieces) {
    constexpr std::size_t corners = std::tuple_size_v<decltype(Piece::corners)>;
    checked_index(pieces.size() * corners, "corners of a section");
    std::vector<std::pair<CutPoint, Index>> sorted;
    sorted.reserve(pieces.size() * corners);
    for (const Piece& piece : pieces) {
        for (const CutPoint& corner : piece.corners) {
            sorted.emplace_back(corner, static_cast<Index>(sorted.size()));
        }
    }
    std::sort(sorted.begin(), sorted.end());
    NumberedCutPoints out;
    out.number.resize(sorted.size());
    for (const auto& [point, place] : sorted) {
        if (out.points.empty() || point != out.points.back()) {
            out.points.push_back(point);
        }
        out.number[place] = static_cast<Index>(out.points.size() - 1);
    }
    return out;
}

} // namespace slabhull
