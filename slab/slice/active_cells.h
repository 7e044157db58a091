// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/array.h"
#include "slabhull/slab/check.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace slabhull {

/// The cells that may meet a time, for one time after the other. Cap cells, which have no duration, are left
/// out.
template<int D>
class ActiveCells {
public:
    ActiveCells(const HullColumns<D>& hull, std::span<const double> times, double tolerance)
        : hull_{hull}, times_{times}, tolerance_{tolerance}, begin_(times.size() + 1, 0) {
        each_lasting_cell([&](std::size_t first, Index) { ++begin_[first + 1]; });
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        starting_.resize(begin_.back());
        std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
        each_lasting_cell([&](std::size_t first, Index cell) { starting_[next[first]++] = cell; });
    }

    /// The cells at time `k`, ascending. `k` must be one after that of the call before.
    std::span<const Index> at(std::size_t k) {
        std::erase_if(active_, [&](Index cell) { return span_of(cell)[1] < times_[k] - tolerance_; });
        const auto old = static_cast<std::ptrdiff_t>(active_.size());
        active_.insert(active_.end(), starting_.begin() + static_cast<std::ptrdiff_t>(begin_[k]),
                       starting_.begin() + static_cast<std::ptrdiff_t>(begin_[k + 1]));
        std::inplace_merge(active_.begin(), active_.begin() + old, active_.end());
        return active_;
    }

private:
    std::array<double, 2> span_of(std::size_t cell) const {
        const Simplex<D>& vertices = hull_.cells[cell];
        const auto [first, last] =
            std::minmax_element(vertices.begin(), vertices.end(),
                                [this](Index a, Index b) { return hull_.points[a][D] < hull_.points[b][D]; });
        return {hull_.points[*first][D], hull_.points[*last][D]};
    }

    /// Calls visit(number of the first time that the cell meets, cell).
    template<class Visit>
    void each_lasting_cell(const Visit& visit) const {
        for (std::size_t cell = 0; cell < hull_.cells.size(); ++cell) {
            const auto [begin, end] = span_of(cell);
            const auto first = std::lower_bound(times_.begin(), times_.end(), begin - tolerance_);
            if (begin < end && first != times_.end() && *first <= end + tolerance_) {
                visit(static_cast<std::size_t>(first - times_.begin()), static_cast<Index>(cell));
            }
        }
    }

    const HullColumns<D>& hull_;
    std::span<const double> times_;
    double tolerance_;
    std::vector<std::size_t> begin_; ///< where each time begins in starting_
    Array<Index> starting_;          ///< cells by the first time that they meet, ascending for each
    std::vector<Index> active_;
};

} // namespace slabhull
