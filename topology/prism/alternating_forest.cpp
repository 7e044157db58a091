// SPDX-License-Identifier: BSD-3-Clause
#include "topology/prism/alternating_forest.h"

namespace slabhull {

AlternatingForest::AlternatingForest(std::span<const Neighbors<2>> neighbors, std::span<Index> mate)
    : neighbors_{neighbors}, mate_{mate}, root_(neighbors.size()), parent_(neighbors.size()) {}

std::size_t AlternatingForest::augment() {
    plant();
    std::size_t paths = 0;
    for (std::size_t k = 0; k < even_.size(); ++k) {
        if (!root_done_[root_[even_[k]]]) {
            paths += extend(even_[k]) ? 1 : 0;
        }
    }
    return paths;
}

/// Every free triangle is a root.
void AlternatingForest::plant() {
    label_.assign(mate_.size(), Label::unreached);
    root_done_.assign(mate_.size(), false);
    even_.clear();
    for (Index f = 0; f < mate_.size(); ++f) {
        if (mate_[f] == no_index) {
            label_[f] = Label::even;
            root_[f] = f;
            parent_[f] = no_index;
            even_.push_back(f);
        }
    }
}

/// Looks at the neighbours of an even triangle. Returns whether one of them ended a path.
bool AlternatingForest::extend(Index even) {
    for (const Index across : neighbors_[even]) {
        if (across == no_index) {
            continue;
        }
        if (label_[across] == Label::unreached) {
            reach(across, even);
        } else if (label_[across] == Label::even && root_[across] != root_[even] &&
                   !root_done_[root_[across]]) {
            join(even, across);
            return true;
        }
    }
    return false;
}

void AlternatingForest::reach(Index odd, Index from) {
    const Index next = mate_[odd];
    label_[odd] = Label::odd;
    label_[next] = Label::even;
    root_[next] = root_[from];
    parent_[next] = from;
    even_.push_back(next);
}

void AlternatingForest::join(Index even, Index other) {
    root_done_[root_[even]] = true;
    root_done_[root_[other]] = true;
    release(even);
    release(other);
    mate_[even] = other;
    mate_[other] = even;
}

/// Pairs the triangles on the way from `even` to its root anew, so that `even` becomes free instead of the
/// root.
void AlternatingForest::release(Index even) {
    Index odd = mate_[even];
    for (Index next = parent_[even]; next != no_index; next = parent_[next]) {
        const Index released = mate_[next];
        mate_[next] = odd;
        mate_[odd] = next;
        odd = released;
    }
}

} // namespace slabhull
