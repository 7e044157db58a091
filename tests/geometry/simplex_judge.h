// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

/// A slow judge of pairs of D-simplices in R^(D+1) with whole coordinates, in whole numbers.
namespace slabhull::tests {

/// Wide enough for determinants of six rows with entries up to some thousands.
__extension__ using Wide = __int128;

/// Rows of a linear system, the right side last.
template<std::size_t Rows>
using System = std::array<std::array<Wide, Rows + 1>, Rows>;

/// Solves a system of as many rows or more than `unknowns`, by Bareiss' elimination, which stays in whole
/// numbers: unknown j is solution[j] / solution[unknowns]. False unless there is exactly one solution.
template<std::size_t Rows>
bool solve(System<Rows> rows, std::size_t unknowns, std::array<Wide, Rows + 1>& solution) {
    Wide last = 1;
    for (std::size_t j = 0; j < unknowns; ++j) {
        const auto from = rows.begin() + j;
        const auto pivot = std::find_if(from, rows.end(), [&](const auto& row) { return row[j] != 0; });
        if (pivot == rows.end()) {
            return false;
        }
        std::iter_swap(from, pivot);
        for (std::size_t i = 0; i < Rows; ++i) {
            const Wide factor = rows[i][j];
            for (std::size_t k = 0; k <= unknowns && i != j; ++k) {
                rows[i][k] = (rows[j][j] * rows[i][k] - factor * rows[j][k]) / last;
            }
        }
        last = rows[j][j];
    }
    solution[unknowns] = last;
    for (std::size_t j = 0; j < unknowns; ++j) {
        solution[j] = rows[j][unknowns];
    }
    return std::all_of(rows.begin() + unknowns, rows.end(),
                       [&](const auto& row) { return row[unknowns] == 0; });
}

template<int D>
class SimplexJudge {
public:
    SimplexJudge(std::span<const Point<D + 1>> points, const Simplex<D>& f, const Simplex<D>& g)
        : points_{points}, f_{f}, g_{g} {}

    /// Whether they have a point in common off the face of the vertices that they share. What they have in
    /// common is the convex hull of its corners, and each corner is the only common point of the planes of a
    /// face of one and a face of the other. So all pairs of faces are intersected.
    bool meet_elsewhere() const {
        for (unsigned a = 1; a < (2U << D); ++a) {
            for (unsigned b = 1; b < (2U << D); ++b) {
                if (cross_off_shared(chosen(f_, a), chosen(g_, b))) {
                    return true;
                }
            }
        }
        return false;
    }

private:
    static std::vector<Index> chosen(const Simplex<D>& cell, unsigned mask) {
        std::vector<Index> face;
        for (std::size_t i = 0; i <= D; ++i) {
            if ((mask >> i & 1U) != 0) {
                face.push_back(cell[i]);
            }
        }
        return face;
    }

    Wide coordinate(Index v, std::size_t k) const { return std::llround(points_[v][k]); }

    bool cross_off_shared(const std::vector<Index>& a, const std::vector<Index>& b) const {
        const std::size_t unknowns = a.size() + b.size();
        if (unknowns > D + 3) { // the planes meet in more than a point, or corners of theirs will do
            return false;
        }
        System<D + 3> rows{};
        for (std::size_t j = 0; j < unknowns; ++j) {
            const bool of_a = j < a.size();
            for (std::size_t k = 0; k <= D; ++k) {
                rows[k][j] = of_a ? coordinate(a[j], k) : -coordinate(b[j - a.size()], k);
            }
            rows[of_a ? D + 1 : D + 2][j] = 1;
        }
        rows[D + 1][unknowns] = 1;
        rows[D + 2][unknowns] = 1;
        std::array<Wide, D + 4> weights{};
        if (!solve(rows, unknowns, weights)) {
            return false;
        }
        const auto sign = [&](std::size_t j) { return (weights[j] > 0) - (weights[j] < 0); };
        bool inside = true;
        bool off = false;
        for (std::size_t j = 0; j < unknowns; ++j) {
            inside = inside && sign(j) * sign(unknowns) >= 0;
            off = off || (j < a.size() && sign(j) != 0 && std::find(g_.begin(), g_.end(), a[j]) == g_.end());
        }
        return inside && off;
    }

    std::span<const Point<D + 1>> points_;
    const Simplex<D>& f_;
    const Simplex<D>& g_;
};

/// Every pair of cells that meet elsewhere than in the face that they share. Slow: all pairs whose boxes
/// meet.
template<int D>
std::set<std::pair<Index, Index>> judged_crossings(std::span<const Point<D + 1>> points,
                                                   std::span<const Simplex<D>> cells) {
    const auto apart = [&](const Simplex<D>& f, const Simplex<D>& g, std::size_t k) {
        const auto less = [&](Index a, Index b) { return points[a][k] < points[b][k]; };
        const auto [f_low, f_high] = std::minmax_element(f.begin(), f.end(), less);
        const auto [g_low, g_high] = std::minmax_element(g.begin(), g.end(), less);
        return less(*f_high, *g_low) || less(*g_high, *f_low);
    };
    std::set<std::pair<Index, Index>> found;
    for (Index c = 0; c < cells.size(); ++c) {
        for (Index d = c + 1; d < cells.size(); ++d) {
            bool boxes_meet = true;
            for (std::size_t k = 0; k <= D; ++k) {
                boxes_meet = boxes_meet && !apart(cells[c], cells[d], k);
            }
            if (boxes_meet && SimplexJudge<D>{points, cells[c], cells[d]}.meet_elsewhere()) {
                found.emplace(c, d);
            }
        }
    }
    return found;
}

} // namespace slabhull::tests
