// SPDX-License-Identifier: BSD-3-Clause
#include "topology/prism/greedy_matching.h"

#include <array>
#include <cstdint>
#include <deque>

namespace slabhull {

namespace {

class GreedyMatcher {
public:
    explicit GreedyMatcher(std::span<const Neighbors<2>> neighbors) : neighbors_{neighbors} {
        mate_.assign(neighbors.size(), no_index);
        degree_.resize(neighbors.size());
        for (Index f = 0; f < neighbors.size(); ++f) {
            degree_[f] = 0;
            each_free_neighbor(f, [&](Index) { ++degree_[f]; });
        }
    }

    Array<Index> run() {
        for (Index f = 0; f < neighbors_.size(); ++f) {
            match(f);
            match_waiting();
        }
        return std::move(mate_);
    }

private:
    template<class Visit>
    void each_free_neighbor(Index f, const Visit& visit) const {
        for (const Index across : neighbors_[f]) {
            if (across != no_index && across != f && mate_[across] == no_index) {
                visit(across);
            }
        }
    }

    /// Those with one free neighbour first, then those with two; the oldest first, so that the matched part
    /// grows evenly (the newest first leaves a hundred times as many free). Entries go out of date when the
    /// number changes.
    void match_waiting() {
        while (!waiting_[1].empty() || !waiting_[2].empty()) {
            const std::uint8_t degree = waiting_[1].empty() ? 2 : 1;
            const Index f = waiting_[degree].front();
            waiting_[degree].pop_front();
            if (degree_[f] == degree) {
                match(f);
            }
        }
    }

    void match(Index f) {
        if (mate_[f] != no_index) {
            return;
        }
        Index best = no_index;
        each_free_neighbor(f, [&](Index across) {
            if (best == no_index || degree_[across] < degree_[best]) {
                best = across;
            }
        });
        if (best != no_index) {
            mate_[f] = best;
            mate_[best] = f;
            leave(f);
            leave(best);
        }
    }

    /// f is no longer free: its neighbours have one free neighbour less.
    void leave(Index f) {
        each_free_neighbor(f, [&](Index across) {
            --degree_[across];
            if (degree_[across] > 0) {
                waiting_[degree_[across]].push_back(across);
            }
        });
    }

    std::span<const Neighbors<2>> neighbors_;
    Array<Index> mate_;
    Array<std::uint8_t> degree_;               ///< how many neighbours are free
    std::array<std::deque<Index>, 3> waiting_; ///< triangles by degree
};

} // namespace

Array<Index> greedy_matching(std::span<const Neighbors<2>> neighbors) {
    return GreedyMatcher{neighbors}.run();
}

} // namespace slabhull
