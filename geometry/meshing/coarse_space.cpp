// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/meshing/coarse_space.h"

#include "slabhull/core/parallel.h"

#include <algorithm>

namespace slabhull::detail {

namespace {

/// Smaller groups save iterations, but cost more than they save: the factors of a matrix of 2,000 rows are as
/// large as a hundred times as many rows of the fine matrix.
constexpr std::size_t smallest_group = 100;
constexpr std::size_t most_groups = 2500;
constexpr std::size_t groups_per_piece = 128;

} // namespace

CoarseSpace::CoarseSpace(const Stiffness& matrix)
    : matrix_{matrix}, group_(matrix.root.size(), no_index), first_{0} {
    const std::size_t size = std::max(smallest_group, group_.size() / most_groups);
    for (Index v = 0; v < group_.size(); ++v) {
        if (matrix_.is_free(v) && group_[v] == no_index) {
            grow_group(v, size);
        }
    }
    const auto groups = static_cast<Index>(first_.size() - 1);
    std::replace(group_.begin(), group_.end(), no_index, groups);
    by_group_.assign(groups + std::size_t{1}, Lanes::Zero());
    right_.resize(groups, 4);
    factorise();
}

/// Breadth first, through free vertices without a group.
void CoarseSpace::grow_group(Index seed, std::size_t size) {
    const auto group = static_cast<Index>(first_.size() - 1);
    const auto add = [&](Index v) {
        const bool wanted = matrix_.is_free(v) && group_[v] == no_index;
        if (wanted && members_.size() - first_.back() < size) {
            group_[v] = group;
            members_.push_back(v);
        }
    };
    add(seed);
    for (std::size_t k = first_.back(); k < members_.size(); ++k) {
        for (const Stiffness::Entry& entry : matrix_.row(members_[k])) {
            add(entry.column);
        }
    }
    first_.push_back(members_.size());
}

/// Entry (I, J) sums K_ij over the members of groups I and J. Rows of K sum to zero, so a diagonal entry is
/// minus the sum of those that leave the group, to fixed vertices, too: computed without cancellation.
void CoarseSpace::factorise() {
    const std::size_t groups = first_.size() - 1;
    std::vector<Eigen::Triplet<double>> triplets;
    std::vector<double> row(groups + 1, 0);
    std::vector<Index> met;
    for (std::size_t g = 0; g < groups; ++g) {
        double leaving = 0;
        for (std::size_t k = first_[g]; k < first_[g + 1]; ++k) {
            for (const Stiffness::Entry& entry : matrix_.row(members_[k])) {
                const Index other = group_[entry.column];
                if (other == g) {
                    continue;
                }
                const double value =
                    double{entry.value} * matrix_.root[members_[k]] * matrix_.root[entry.column];
                leaving -= value;
                if (row[other] == 0) {
                    met.push_back(other);
                }
                row[other] += value;
            }
        }
        const auto at = static_cast<int>(g);
        triplets.emplace_back(at, at, leaving);
        for (const Index other : met) {
            if (other < g) {
                triplets.emplace_back(at, static_cast<int>(other), row[other]);
            }
            row[other] = 0;
        }
        met.clear();
    }
    const auto size = static_cast<Eigen::Index>(groups);
    Eigen::SparseMatrix<double> matrix{size, size};
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    factors_.compute(matrix);
}

Sums CoarseSpace::solve(const Array<Lanes>& residual) {
    const std::size_t groups = first_.size() - 1;
    parallel_for(groups, groups_per_piece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) {
            Lanes sum = Lanes::Zero();
            for (std::size_t k = first_[g]; k < first_[g + 1]; ++k) {
                sum += matrix_.root[members_[k]] * residual[members_[k]];
            }
            right_.row(static_cast<Eigen::Index>(g)) = sum.cast<double>();
        }
    });
    const Eigen::MatrixX4d solution = factors_.solve(right_);
    for (std::size_t g = 0; g < groups; ++g) {
        by_group_[g] = solution.row(static_cast<Eigen::Index>(g)).transpose().cast<float>();
    }
    return right_.cwiseProduct(solution).colwise().sum().transpose();
}

} // namespace slabhull::detail
