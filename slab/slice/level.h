// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/index.h"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <span>
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

/// Cut points without repetition, in the order of their edges, and the number of each of the given ones.
struct NumberedCutPoints {
    std::vector<CutPoint> points;
    std::vector<Index> number;
};

inline NumberedCutPoints number_cut_points(std::span<const CutPoint> given) {
    std::vector<std::pair<CutPoint, Index>> sorted;
    sorted.reserve(given.size());
    checked_index(given.size(), "corners of a section");
    for (const CutPoint& point : given) {
        sorted.emplace_back(point, static_cast<Index>(sorted.size()));
    }
    std::sort(sorted.begin(), sorted.end());
    NumberedCutPoints out;
    out.number.resize(given.size());
    for (const auto& [point, place] : sorted) {
        if (out.points.empty() || point != out.points.back()) {
            out.points.push_back(point);
        }
        out.number[place] = static_cast<Index>(out.points.size() - 1);
    }
    return out;
}

} // namespace slabhull
